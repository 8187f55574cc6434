"""The line mode: the same sentences, actions and menus, one line at a time.

For screen readers, very slow lines and terminals that can't be drawn on: nothing is ever drawn over, and
every answer is a few sentences. Actions are named after a colon (`:add`, `:plan`); menus are numbered.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from textual.message import Message

from polaris_nl.answers import change_in_words
from polaris_nl.automaton.automaton import START
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.execution.state import HumanCommand
from polaris_nl.model.errors import PolarisError, did_you_mean
from polaris_nl.model.text import capital
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import offers
from polaris_nl.render.layout import Row, wrapped
from polaris_nl.render.timeline import branch_stops
from polaris_nl.session import Session
from polaris_nl.snapshot import Snapshot
from polaris_tui import authoring, offering, stepping
from polaris_tui.actions import ACTIONS, BY_ID, Situation
from polaris_tui.choosing import Choosing
from polaris_tui.desk import Desk
from polaris_tui.menus import Ask, Change, Menu, Note, Perform, Step
from polaris_tui.messages import Happened, RunOver
from polaris_tui.minutes import Minutes
from polaris_tui.panels import expectation_rows, map_rows, told_rows
from polaris_tui.phrases import action_asked, order_in
from polaris_tui.progress import Progress, advanced
from polaris_tui.reviewing import detail_rows, review_rows
from polaris_tui.running import Running
from polaris_tui.scene import Reading, Scene
from polaris_tui.transcript import answer_entries, event_entry
from polaris_tui.views import outline_rows, status, trouble_rows

HINT = "Say what the robot should achieve. A colon lists what else can be done; help tells more."
NOT_HERE = "That is about the screen, and there is none here."


class Plain:
    """The line mode on one session.

    Args:
        session: program, language and planner.
        show: prints a line.
        scene: an empty scene, with glyphs and keys.
        width: columns of a line.
        live: runs go in real time.
        logs: the folder for the logs of runs; the usual one by default.
        profile: the robot that runs move; None for the simulated world.
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
    ) -> None:
        self._session = session
        self._show = show
        self._scene = scene
        self._width = width
        self._live = live
        self._logs = logs
        self._profile = profile
        self._minutes = Minutes()
        session.report_to(self._minutes.take)
        self._choosing = Choosing()
        self._picked = START
        self._current: Running | None = None
        self._over = threading.Event()
        self._leaving = False
        self._do: dict[str, Callable[[str], None]] = {
            "mend": lambda about: self._mend(),
            "pick": self._pick,
            "why": lambda about: self._why(),
            "undo": lambda about: self._travel(int(about or 1)),
            "redo": lambda about: self._travel(-int(about or 1)),
            "history": lambda about: self._history(),
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
        if self._current is not None:
            self._current.end()

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

    def _program(self) -> None:
        self._scene = replace(self._scene, reading=None)
        now = self._now()
        self._say(f"{status(now)[0]}. You are at {self._desk().here.name}.")
        self._rows(outline_rows(now, self._width, True))
        self._rows(trouble_rows(now, self._width))

    # The plan

    def _plan(self) -> None:
        leaf = stepping.first_leaf(self._session.snapshot.automaton, self._picked)
        self._scene = replace(self._scene, steps=stepping.Steps(leaf, 0))
        self._step(0)

    def _step(self, by: int) -> None:
        steps, plan = self._scene.steps, self._session.snapshot.plan
        if plan is None:
            return
        stops = branch_stops(
            self._session.snapshot.automaton, plan, steps.leaf, self._session.wording
        )
        self._scene = replace(self._scene, steps=stepping.moved(steps, stops, by))
        self._rows(told_rows(self._now(), stops, self._scene.steps.at, self._width))

    def _way(self, by: int) -> None:
        stops = self._now().stops()
        automaton = self._session.snapshot.automaton
        steps = stepping.other_way(self._scene.steps, stops, automaton, by)
        self._scene = replace(self._scene, steps=steps)
        self._step(0)

    # Runs

    def _start(self, snapshot: Snapshot, plan: BranchingPlan) -> None:
        self._scene = replace(self._scene, progress=Progress(self._session.world.initial))
        log = None
        if self._logs is not None:
            from polaris_nl.logs.paths import new_log_path

            log = new_log_path(self._session.world.name, self._logs)
        self._over.clear()
        self._session.running = True
        self._current = Running(
            self._session,
            snapshot,
            plan,
            self._happened,
            self._live,
            log,
            self._minutes.events(),
            self._profile,
        )
        if self._profile is not None:
            self._say(f"I'm looking for {self._profile.title}. Nothing has been told to move.")
        self._current.start()

    def _happened(self, message: Message) -> None:
        """In the run's thread: prints what happens."""
        current = self._current
        if isinstance(message, Happened) and current is not None:
            progress = advanced(self._scene.progress, message.event, current.plan)
            self._scene = replace(self._scene, progress=progress)
            seconds = message.event.time - (progress.started or message.event.time)
            entry = event_entry(message.event, seconds, self._scene.glyphs)
            if entry is not None:
                self._say(entry.text, entry.lead)
        elif isinstance(message, RunOver):
            self._current = None
            self._session.running = False
            for entry in message.entries:
                self._say(entry.text, entry.lead)
            self._over.set()

    def _order(self, order: str) -> None:
        if self._current is None:
            self._sentence(order)
        elif order == "pause" and self._scene.progress.activity == "paused":
            self._current.command(HumanCommand("resume"))
        elif order == "pause":
            self._current.command(HumanCommand("pause"))
        else:
            self._current.command(HumanCommand("resume" if order == "resume" else "stop"))

    def _watch(self) -> None:
        now = self._now()
        self._say(status(now)[0])
        self._rows(expectation_rows(now, now.progress, self._width))

    def _tell(self, about: str) -> None:
        waiting, wording = self._scene.progress.waiting, self._session.wording
        if about and self._current is not None:
            self._current.command(HumanCommand("happened", waiting[int(about) - 1]))
            return
        self._follow(offering.tell_menu(waiting, wording))

    # Logs

    def _log(self, about: str) -> None:
        if not about:
            self._follow(offering.log_menu(self._logs))
            return
        from polaris_tui.replay import open_replay

        replay = open_replay(Path(about).expanduser(), self._session.world)
        self._scene = replace(self._scene, reading=Reading(replay), world=replay.world)
        self._rows(review_rows(self._now(), self._width))
        self._say("Say :next-problem, :filter, :compare or :chain; :program goes back.")

    def _problem(self, step: int) -> None:
        reading = self._scene.reading
        found = reading.replay.problem(reading.number, step) if reading else None
        if reading is None or found is None:
            self._say("There is no further problem.")
            return
        self._scene = replace(self._scene, reading=replace(reading, number=found, below="event"))
        self._rows(detail_rows(self._now(), self._width))

    def _filter(self) -> None:
        def filtered(words: str) -> Step:
            reading = self._scene.reading
            if reading is not None:
                wanted = "" if words == "*" else words
                self._scene = replace(self._scene, reading=replace(reading, words=wanted))
                self._rows(review_rows(self._now(), self._width))
            return Note("")

        self._follow(Ask("Only events with these words (* for all)", filtered))

    def _below(self, what: str) -> None:
        if self._scene.reading is not None:
            self._scene = replace(self._scene, reading=replace(self._scene.reading, below=what))
            self._rows(detail_rows(self._now(), self._width))

    # Parts

    def _leave(self) -> None:
        self._leaving = True

    def _say(self, text: str, lead: str = "") -> None:
        self._rows(wrapped(text, self._width, lead))

    def _rows(self, rows: Iterable[Row]) -> None:
        for row in rows:
            self._show(row.text.rstrip())

    def _desk(self) -> Desk:
        automaton = self._session.snapshot.automaton
        names = self._session.understanding.names
        picked = self._picked if self._picked in automaton.checkpoints else START
        return Desk(
            self._session.world,
            self._session.wording,
            automaton,
            picked,
            names.checkpoint,
            names.renamed,
        )

    def _now(self) -> Scene:
        """The scene as it is."""
        scene, reading = self._scene, self._scene.reading
        if reading is not None:
            snapshot = Snapshot(0, reading.replay.automaton, reading.replay.plan, "planned")
            progress = reading.replay.progress(reading.number)
            return replace(
                scene, snapshot=snapshot, progress=progress, wording=self._session.wording
            )
        snapshot = self._session.wait()
        return replace(
            scene,
            world=self._session.world,
            snapshot=snapshot,
            wording=self._session.wording,
            mutexes=self._session.planner.mutexes,
        )

    def _situation(self) -> Situation:
        snapshot = self._session.snapshot
        automaton, plan = snapshot.automaton, snapshot.plan
        reading, current = self._scene.reading, self._current
        return Situation(
            view="review" if reading else "plan" if self._scene.steps.leaf != START else "program",
            checkpoint=self._picked if self._picked in automaton.checkpoints else START,
            empty=len(automaton.checkpoints) == 1,
            running=current is not None,
            waiting=len(self._scene.progress.waiting),
            undoable=bool(snapshot.undoable),
            redoable=bool(snapshot.redoable),
            repairs=len(offers(plan)) if plan else 0,
            planned=plan is not None and bool(plan.segments),
            loose=len(automaton.transitions) < len(automaton.checkpoints) - 1,
        )


def typed_lines(prompt: str = "> ") -> Iterator[str]:
    """What is typed, line by line; with editing and a history where there is a terminal."""
    import sys

    if sys.stdin.isatty():
        import readline  # noqa: F401 - makes `input` a line editor with a history
    while True:
        try:
            yield input(prompt if sys.stdin.isatty() else "")
        except (EOFError, KeyboardInterrupt):
            return
