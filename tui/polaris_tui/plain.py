"""The line mode: the same sentences, actions and menus, one line at a time.

For screen readers, very slow lines and terminals that can't be drawn on: nothing is ever drawn over, and
every answer is a few sentences. Actions are named after a colon (`:add`, `:plan`); menus are numbered.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from polaris_nl.answers import change_in_words
from polaris_nl.automaton.edits import ReplaceProgram
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.model.errors import PolarisError, did_you_mean
from polaris_nl.model.text import capital
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import offers
from polaris_nl.session import Session
from polaris_tui import authoring, offering
from polaris_tui.actions import ACTIONS, BY_ID
from polaris_tui.choosing import Choosing
from polaris_tui.commanding import Commanding
from polaris_tui.editor import edited
from polaris_tui.keeping import saved_as
from polaris_tui.lines import Places
from polaris_tui.menus import Ask, Change, Menu, Perform, Step
from polaris_tui.panels import map_rows
from polaris_tui.phrases import action_asked, order_in
from polaris_tui.scene import Scene
from polaris_tui.transcript import answer_entries

HINT = "Say what the robot should achieve. A colon lists what else can be done; help tells more."
NOT_HERE = "That is about the screen, and there is none here."
ON_SCREEN = frozenset(
    {
        *(
            "shape",
            "answers",
            "copy",
            "theme",
            "open",
            "talk",
            "prompt",
            "next-pane",
            "previous-pane",
        ),
        *("up", "down", "left", "right", "top", "bottom", "page-up", "page-down"),
    }
)
"""The actions that move about on a screen, or want one; all others can be done line by line."""


class Plain(Commanding):
    """The line mode on one session.

    Args:
        session: program, language and planner.
        show: prints a line.
        scene: an empty scene, with glyphs and keys.
        width: columns of a line.
        live: runs go in real time.
        logs: the folder for the logs of runs; the usual one by default.
        profile: the robot that runs move; None for the simulated world.
        places: what other sessions have left behind, and where runs listen.
    """

    def __init__(
        self,
        session: Session,
        show: Callable[[str], None],
        scene: Scene,
        width: int = 78,
        live: bool = True,
        logs: Path | None = None,
        profile: Profile | None = None,
        places: Places = Places(),
    ) -> None:
        super().__init__(session, show, scene, width, live, logs, profile, places)
        self._over = threading.Event()
        self._leaving = False
        self.hung_up = False
        self._do: dict[str, Callable[[str], None]] = {
            "mend": lambda about: self._mend(),
            "pick": self._pick,
            "why": lambda about: self._why(),
            "undo": lambda about: self._travel(int(about or 1)),
            "redo": lambda about: self._travel(-int(about or 1)),
            "history": lambda about: self._history(),
            "recover": self._recover,
            "editor": lambda about: self._edit_file(),
            "save-as": self._save_as,
            "plan": lambda about: self._plan(),
            "next": lambda about: self._step(1),
            "previous": lambda about: self._step(-1),
            "next-way": lambda about: self._way(1),
            "other-way": lambda about: self._way(-1),
            "first-step": lambda about: self._step(-1_000_000),
            "last-step": lambda about: self._step(1_000_000),
            "run": lambda about: self._sentence("run it"),
            "watch": lambda about: self._watch(),
            "pause": lambda about: self._order("pause"),
            "stop": lambda about: self._order("stop"),
            "tell": self._tell,
            "attach": lambda about: self._attach(),
            "log": self._log,
            "next-problem": lambda about: self._problem(1),
            "last-problem": lambda about: self._problem(-1),
            "filter": lambda about: self._filter(),
            "compare": lambda about: self._below("compare"),
            "chain": lambda about: self._below("chain"),
            "help": lambda about: self._sentence("help"),
            "program": lambda about: self._program(),
            "map": lambda about: self._rows(map_rows(self._now(), self._width, 40)),
            "actions": lambda about: self._actions(),
            "quit": lambda about: self._leave(),
        }

    def open_log(self, path: Path) -> None:
        """Opens a log."""
        self._perform("log", str(path))

    def work(self, lines: Iterable[str]) -> None:
        """Takes lines until the user quits or there are no more; a run is stopped then."""
        self._say(f"World: {self._session.world.name}. {HINT}")
        for line in lines:
            try:
                self._take(line.strip())
            except PolarisError as error:
                self._say(f"! {error}")
            if self._leaving:
                break
        current = self._current
        if current is not None and current.ours and self.hung_up:
            current.wait(None)  # The line is gone; the run goes on, and listens to other terminals.
        elif current is not None:
            current.end()

    def _leave(self) -> None:
        self._leaving = True

    def _take(self, line: str) -> None:
        if self._choosing.last is not None:
            self._choose(line)
        elif (action := action_asked(line)) is not None:
            self._perform(action)
        elif (order := order_in(line)) and self._current is not None:
            self._order(order)
        elif line:
            self._sentence(line)

    # Sentences

    def _sentence(self, line: str) -> None:
        current = self._current
        if current is not None and current.active:
            from polaris_nl.commands.run import command_in

            command = command_in(line, self._session.understanding, current.snapshot.automaton)
            if command is not None:
                current.command(command)
                return
        answer = self._session.say(line)
        if self._profile is not None and self._session.awaits_yes:
            self._say(f"{capital(self._profile.title)} will move.", "! ")
        for entry in answer_entries(answer):
            self._say(entry.text, entry.lead)
        plan = answer.snapshot.plan
        if answer.interpretation.command == "quit":
            self._leave()
        elif answer.confirmed and plan is not None and current is None:
            self._start(answer.snapshot, plan)

    # Actions

    def _perform(self, id: str, about: str = "") -> None:
        if id not in BY_ID:
            known = ", ".join(a.id for a in ACTIONS if a.id in self._do)
            self._say(f"There is no action {id}.{did_you_mean(id, BY_ID)} There are: {known}.")
            return
        reason = BY_ID[id].reason(self._situation())
        steps = authoring.steps(self._desk())
        if reason:
            self._say(reason)
        elif id in self._do:
            self._do[id](about)
        elif id in steps:
            self._follow(steps[id]())
        else:
            self._say(NOT_HERE)

    def _follow(self, step: Step) -> None:
        if isinstance(step, Menu | Ask):
            self._choosing = self._choosing.asked(step)
            self._offer()
            return
        self._choosing = Choosing()
        if isinstance(step, Change):
            self._edit(step)
        elif isinstance(step, Perform):
            self._perform(step.action, step.about)
        elif step.text:
            self._say(step.text)

    def _offer(self) -> None:
        self._say(self._choosing.heading())
        self._rows(self._choosing.rows(self._width, self._scene.glyphs))
        if isinstance(self._choosing.last, Menu):
            self._say("Type a number, or words of it; an empty line goes back.")

    def _choose(self, line: str) -> None:
        last = self._choosing.last
        if not line:
            self._choosing = self._choosing.back()
            if self._choosing.last is None:
                self._say("Left as it was.")
            else:
                self._offer()
        elif isinstance(last, Ask):
            self._follow(last.then(line))
        else:
            found = self._choosing.filtered(line)
            if len(found.options) == 1 and found.picked is not None:
                if found.picked.reason:
                    self._say(found.picked.reason)
                else:
                    self._follow(found.picked.step())
            elif found.options:
                self._rows(found.rows(self._width, self._scene.glyphs))
            else:
                self._say("None of them; type a number, or an empty line to go back.")

    def _actions(self) -> None:
        now = self._situation()
        for action in ACTIONS:
            if action.id in (*self._do, *authoring.steps(self._desk())):
                reason = action.reason(now)
                self._say(
                    f":{action.id} {action.does}" + (f" (not now: {reason})" if reason else "")
                )

    def _edit(self, change: Change) -> None:
        before = self._session.snapshot.plan
        failure = self._session.edit(change.edits, change.label)
        self._news(before, f"Done: {change.label}.", failure)
        self._picked = change.focus or self._picked

    def _news(self, before: BranchingPlan | None, echo: str, failure: str = "") -> None:
        after = self._session.wait()
        pending = after.planning == "planning"
        self._say(change_in_words(echo, before, after.plan, pending, after.failure or failure))

    def _travel(self, steps: int) -> None:
        before = self._session.snapshot.plan
        go = self._session.undo if steps > 0 else self._session.redo
        labels = [go() for _ in range(abs(steps))]
        word = "Undone" if steps > 0 else "Done again"
        self._news(before, f"{word}: {labels[-1]}.")

    def _mend(self) -> None:
        plan = self._session.snapshot.plan
        found = offers(plan) if plan else ()
        self._follow(offering.mend_menu([("", r.text, r.edits) for _, r in found]))

    def _pick(self, about: str) -> None:
        if not about:
            self._follow(offering.pick_menu(self._desk()))
            return
        self._picked = about
        self._say(f"You are at {self._desk().here.name}.")

    def _why(self) -> None:
        from polaris_nl.commands.why import Asker

        snapshot = self._session.wait()
        if snapshot.plan is not None:
            asker = Asker(self._session, snapshot.automaton, snapshot.plan)
            self._say(asker.checkpoint(self._desk().here.id)["text"])

    def _history(self) -> None:
        snapshot = self._session.snapshot
        self._follow(offering.history_menu(snapshot.undoable, snapshot.redoable))

    def _recover(self, about: str) -> None:
        left = self._places.leftovers
        if not about:
            back = self._session.understanding.read_back
            self._follow(offering.leftover_menu(left, back))
            return
        self._edit(offering.recovered(Path(about)))

    def _edit_file(self) -> None:
        try:
            program = edited(self._session.program, contextlib.nullcontext())
        except (PolarisError, OSError) as error:
            self._say(f"The program stays as it was. {error}", "! ")
            return
        if program == self._session.snapshot.automaton:
            self._say("Nothing was changed.")
        else:
            self._edit(Change("edit the file", (ReplaceProgram(program),)))

    def _save_as(self, about: str) -> None:
        if about:
            self._say(saved_as(self._session, Path(about).expanduser()))
        else:
            self._follow(offering.save_menu(self._session.world.name))


def typed_lines(prompt: str = "> ") -> Iterator[str]:
    """What is typed, line by line; with editing and a history where there is a terminal."""
    import sys

    if sys.stdin.isatty():
        import readline  # noqa: F401 - makes `input` a line editor with a history
    while True:
        try:
            yield input(prompt if sys.stdin.isatty() else "")
        except (EOFError, KeyboardInterrupt, OSError):
            return
