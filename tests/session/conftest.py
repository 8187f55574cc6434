"""Sessions, and what they tell."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint
from polaris_nl.execution.events import Event
from polaris_nl.model.formula import Literal, parse_formula
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.compile import Draft
from polaris_nl.planning.planner import Planner
from polaris_nl.session import Session
from polaris_nl.snapshot import Snapshot

LIMIT_S = 20.0
"""How long a test waits for something that comes at once: only a fault makes it wait."""


CUP = "Put the cup on the desk."
HOME = "Then go home."
TABLE = "(at cup desk)"


@pytest.fixture(scope="session")
def world() -> World:
    return load_world("care-home")


@pytest.fixture(scope="session")
def planner(world: World) -> Planner:
    return Planner(world)


class Watched(Session):
    """A session that keeps its events and the snapshots it told."""

    def __init__(self, world: World, path: Path | None = None) -> None:
        self.events: list[Event] = []
        self.told: list[Snapshot] = []
        self._news = threading.Condition()
        super().__init__(world, path=path, sink=self._keep, now=lambda: 12.5)
        self.subscribe(self._hear)

    def _keep(self, event: Event) -> None:
        self.events.append(event)

    def _hear(self, snapshot: Snapshot) -> None:
        with self._news:
            self.told.append(snapshot)
            self._news.notify_all()

    def kinds(self) -> list[str]:
        return [type(e).__name__ for e in self.events]

    def until_told(self, revision: int) -> Snapshot:
        """Waits until the plan of a revision was told."""

        def come() -> bool:
            return any(s.revision == revision and s.planning != "planning" for s in self.told)

        with self._news:
            assert self._news.wait_for(come, LIMIT_S), self.told
            return self.told[-1]


Open = Callable[..., Watched]


@pytest.fixture
def open_session(world: World) -> Iterator[Open]:
    """Opens sessions that are closed at the end."""
    opened: list[Watched] = []

    def make(path: Path | None = None) -> Watched:
        opened.append(Watched(world, path))
        return opened[-1]

    yield make
    for session in opened:
        session.close()


@pytest.fixture
def session(open_session: Open) -> Watched:
    return open_session()


class GatedPlanner:
    """A planner that goes on only when it is let."""

    def __init__(self, planner: Planner) -> None:
        self._planner = planner
        self.entered = threading.Semaphore(0)
        self.gate = threading.Event()
        self.asked: list[Automaton] = []
        self.stale: list[bool] = []

    def drafts(self, automaton: Automaton, stale: Callable[[], bool]) -> Iterator[Draft]:
        self.asked.append(automaton)
        self.entered.release()
        assert self.gate.wait(LIMIT_S)
        self.stale.append(stale())
        yield Draft(self._planner.compile(automaton), True)


def goal(text: str) -> Literal:
    parsed = parse_formula(text)
    assert isinstance(parsed, Literal)
    return parsed


def add(session: Session, text: str) -> str:
    """Adds a checkpoint with one goal at the end."""
    automaton = session.snapshot.automaton
    name = automaton.fresh_checkpoint_id()
    checkpoint = Checkpoint(name, name, (goal(text),))
    arrow = Transition(automaton.fresh_transition_id(), list(automaton.checkpoints)[-1], name)
    return session.edit([AddCheckpoint(checkpoint, arrow)], f"add {name}")


def goals(automaton: Automaton) -> list[list[str]]:
    """What holds at each checkpoint but the start."""
    return [[str(g) for g in c.goals] for c in automaton.checkpoints.values()][1:]
