"""What the line mode is made of: where the user is, and how rows are printed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from polaris_nl.automaton.automaton import START
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.render.explanation import offers
from polaris_nl.render.layout import Row, wrapped
from polaris_nl.session import Session
from polaris_nl.snapshot import Snapshot
from polaris_tui.choosing import Choosing
from polaris_tui.desk import Desk
from polaris_tui.editor import editor
from polaris_tui.keeping import Leftover
from polaris_tui.menus import Step
from polaris_tui.reasons import Situation
from polaris_tui.running import Run
from polaris_tui.scene import Scene


@dataclass(frozen=True)
class Places:
    """What lies outside of a session.

    Attributes:
        leftovers: what earlier sessions left unsaved.
        elsewhere: where runs of this world listen that go on already.
        listens_at: the folder where runs listen to other terminals; None for nowhere.
    """

    leftovers: tuple[Leftover, ...] = ()
    elsewhere: tuple[Path, ...] = ()
    listens_at: Path | None = None


class Lines:
    """Where the user is, and what is printed.

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
        self._session = session
        self._show = show
        self._scene = scene
        self._width = width
        self._live = live
        self._logs = logs
        self._profile = profile
        self._choosing = Choosing()
        self._picked = START
        self._places = places
        self._current: Run | None = None

    def _follow(self, step: Step) -> None:
        """Goes on with what a menu or an action led to."""
        raise NotImplementedError

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
            elsewhere=bool(self._places.elsewhere),
            leftover=bool(self._places.leftovers),
            editor=bool(editor()),
        )
