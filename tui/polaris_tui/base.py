"""The application's base: what it remembers, and the scene that is drawn from it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import ClassVar

from textual.app import App, ComposeResult
from textual.message import Message
from textual.widget import Widget

from polaris_nl.automaton.automaton import START
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.model.state import Mutexes
from polaris_nl.model.wording import PlainWording
from polaris_nl.render.explanation import offers
from polaris_nl.render.timeline import Stop, branch_stops
from polaris_nl.session import Session
from polaris_nl.snapshot import Snapshot
from polaris_tui import stepping, styles
from polaris_tui.actions import Keymap
from polaris_tui.board import Board
from polaris_tui.conversation import Conversation
from polaris_tui.desk import Desk
from polaris_tui.editor import editor
from polaris_tui.keeping import Leftover
from polaris_tui.layout import TREE
from polaris_tui.progress import Progress
from polaris_tui.reasons import Situation
from polaris_tui.running import Current
from polaris_tui.scene import Scene
from polaris_tui.settings import Settings
from polaris_tui.state import State
from polaris_tui.styles import LOOKS
from polaris_tui.talking import Talking, Tell

MakeTalking = Callable[[Session, AbstractContextManager[object], Tell, Current], Talking]


class BaseApp(App[int]):
    """What the application remembers.

    Args:
        session: program, language and planner; it belongs to the caller.
        settings: the user's.
        live: runs go in real time; otherwise as fast as the machine can.
        logs: the folder for the logs of runs; the usual one by default.
        kept: the program's file is not the user's, but one that keeps it until it has a name.
        leftovers: what earlier sessions left unsaved.
        log: a log to be opened at once.
        listens_at: the folder where runs listen to other terminals; None for nowhere.
        elsewhere: where runs of this world listen that go on already.
        talk: makes what listens to speech; None where nothing can.
        profile: the robot that runs move; None for the simulated world.
        settings_file: where settings are, for what is said about them.
    """

    ENABLE_COMMAND_PALETTE = False
    CSS = styles.CSS
    HORIZONTAL_BREAKPOINTS = styles.BREAKPOINTS
    BINDINGS: ClassVar = []

    def __init__(
        self,
        session: Session,
        settings: Settings = Settings(),
        *,
        live: bool = True,
        logs: Path | None = None,
        kept: bool = False,
        leftovers: Iterable[Leftover] = (),
        log: Path | None = None,
        listens_at: Path | None = None,
        elsewhere: Iterable[Path] = (),
        talk: MakeTalking | None = None,
        profile: Profile | None = None,
        settings_file: str = "the settings",
    ) -> None:
        super().__init__()
        self.session = session
        self.settings = settings
        self.settings_file = settings_file
        self.keymap: Keymap = settings.keymap
        self.logs = logs
        self.leftovers = tuple(leftovers)
        self.animation_level = "none"
        self._live = live
        self._first_log = log
        self._profile = profile
        self._patient = False  # a timer is set to show that a plan is still being made
        self._listens_at = listens_at
        self._elsewhere = tuple(elsewhere)
        glyphs = settings.glyphs_for_terminal()
        self.state = State(
            glyphs,
            LOOKS[settings.theme],
            PlainWording(session.world),
            Progress(session.world.initial, activity="loading"),
            tree={"always": True, "never": False}.get(settings.tree),
            kept=kept,
            robot=profile.title if profile is not None else "",
        )
        for theme in styles.themes():
            self.register_theme(theme)
        self.theme = self.state.look.theme
        self._unsubscribe: Callable[[], None] = lambda: None
        self._focused_before: Widget | None = None
        self._conversation = Conversation(session, self.tell)
        self.talking: Talking | None = None
        if talk is not None:
            self.talking = talk(
                session, self._conversation.turn, self.tell, lambda: self.state.current
            )
        self.board = self.make_board()
        for action in self.keymap.actions:
            if action.keys:
                self._bindings.bind(
                    ",".join(action.keys), f"do('{action.id}')", show=False, priority=action.first
                )

    def make_board(self) -> Board:
        """The panes, which tell the whole application of keys."""
        raise NotImplementedError

    def compose(self) -> ComposeResult:
        """One screen."""
        yield self.board

    def tell(self, message: Message) -> None:
        """Sends a message from any thread; a screen that is gone already needs none."""
        with contextlib.suppress(RuntimeError):
            self.post_message(message)

    @property
    def as_tree(self) -> bool:
        """Whether the program is drawn as a tree."""
        return self.size.width >= TREE if self.state.tree is None else self.state.tree

    def stops(self, leaf: str) -> tuple[Stop, ...]:
        """The stops of a branch of the present plan."""
        snapshot = self.session.snapshot
        if snapshot.plan is None or leaf not in snapshot.automaton.checkpoints:
            return ()
        return branch_stops(snapshot.automaton, snapshot.plan, leaf, self.state.wording)

    def stop(self) -> Stop | None:
        """The step of the plan that is picked."""
        stops = self.stops(self.state.steps.leaf)
        return stops[min(self.state.steps.at, len(stops) - 1)] if stops else None

    def desk(self) -> Desk:
        """What is edited."""
        automaton = self.session.snapshot.automaton
        picked = self.state.picked if self.state.picked in automaton.checkpoints else START
        return Desk(
            self.session.world,
            self.state.wording,
            automaton,
            picked,
            self.session.understanding.names.checkpoint,
            self.session.understanding.names.renamed,
        )

    def situation(self) -> Situation:
        """What can be done now."""
        state, snapshot = self.state, self.session.snapshot
        automaton, plan = snapshot.automaton, snapshot.plan
        ways_out = offers(plan) if plan else ()
        return Situation(
            view=state.view,
            checkpoint=state.picked if state.picked in automaton.checkpoints else START,
            empty=len(automaton.checkpoints) == 1,
            running=state.current is not None,
            waiting=len(state.progress.waiting),
            undoable=bool(snapshot.undoable),
            redoable=bool(snapshot.redoable),
            repairs=len(ways_out),
            planned=plan is not None and bool(plan.segments or plan.problems),
            loose=len(automaton.transitions) < len(automaton.checkpoints) - 1,
            elsewhere=bool(self._elsewhere),
            leftover=bool(self.leftovers),
            listens=self.talking is not None,
            editor=bool(editor()),
        )

    def scene(self) -> Scene:
        """All that the panes show."""
        state, session = self.state, self.session
        running, path, reading = state.current, session.path, state.reading
        snapshot = running.snapshot if running else session.snapshot
        if state.view == "run":
            snapshot = state.ran or snapshot
        world, wording, progress = session.world, state.wording, state.progress
        file = "(no name)" if state.kept else path.name if path else "(no file)"
        if reading is not None:
            replay = reading.replay
            world, wording, file = replay.world, state.read_wording or wording, replay.path.name
            snapshot = Snapshot(0, replay.automaton, replay.plan, "planned")
            progress = replay.progress(reading.number)
        else:
            state.steps = stepping.kept(state.steps, snapshot.automaton, snapshot.plan)
        stop = self.stop() if state.view == "plan" else None
        place = (snapshot.revision, stop.number or 0) if stop else (0, 0)
        loaded = "planner" in session.__dict__
        return Scene(
            world,
            file,
            snapshot,
            wording,
            progress,
            state.glyphs,
            self.keymap,
            self.situation(),
            session.planner.mutexes if loaded else Mutexes(),
            self.as_tree and state.view == "program",
            state.actions,
            state.picked,
            state.steps,
            state.purposes.get(place, ""),
            reading,
            state.slow,
            state.view == "map" and state.before_view == "plan" and reading is None,
            state.attached,
            state.ran_on if state.view == "run" else state.robot,
            state.voice,
        )

    def draw(self) -> None:
        """Shows how things are now."""
        if self.is_running:
            self.board.show(
                self.scene(), self.state.view, self.state.transcript, self.state.choosing
            )
