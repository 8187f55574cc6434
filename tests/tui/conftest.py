"""The application on a stage: real sessions, keys pressed, conditions waited for."""

from __future__ import annotations

import asyncio
import os
import threading
import time
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from textual.pilot import Pilot

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.language.understanding import Understanding
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.writer import LogWriter
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.compile import Draft
from polaris_nl.runs import RunOrder, run_simulated
from polaris_nl.session import Session
from polaris_tui.app import PolarisApp
from polaris_tui.base import MakeTalking
from polaris_tui.pane import Pane
from polaris_tui.prompt import Prompt
from polaris_tui.settings import Settings
from tests.replayed_logs import OF_RUNS

LIMIT_S = float(os.environ.get("T1_LIMIT", "20"))
"""How long a test waits for something that comes at once: only a fault makes it wait."""
LUNCH = (
    "Tell the resident that lunch is ready. Once she acknowledges, bring a full tray to her table "
    "and then go home. If she dismisses it, just go home."
)
DISHES = (
    "Put the cup and the plate on the countertop.",
    "Wait until both are on the drying rack.",
    "Open the cupboard, then put both dishes in the cupboard.",
)


class Stage:
    """The application while it runs, and a user before it."""

    def __init__(self, app: PolarisApp, pilot: Pilot[int], session: Session) -> None:
        self.app = app
        self.pilot = pilot
        self.session = session

    @property
    def prompt(self) -> Prompt:
        return self.app.board.prompt

    def screen(self) -> str:
        """What a person sees."""
        strips = self.app.screen._compositor.render_strips()
        return "\n".join(strip.text.rstrip() for strip in strips)

    def pane(self, name: str) -> str:
        """All rows of a pane, seen or not."""
        return "\n".join(row.text for row in self.app.query_one(f"#{name}", Pane).rows)

    async def press(self, *keys: str) -> None:
        await self.pilot.press(*keys)

    async def enter(self, line: str) -> None:
        """Types a line and does not wait for its answer."""
        self.prompt.focus()
        self.prompt.value = line
        await self.pilot.press("enter")

    async def say(self, line: str) -> None:
        """Types a line and waits for its answer, and for the plan."""
        await self.enter(line)
        await self.answered()

    async def answered(self) -> None:
        """Waits until nothing that was said is without an answer."""

        def done() -> bool:
            exchanges = self.app.state.transcript.exchanges.values()
            return all(e.entries for e in exchanges) and self.planned()

        await self.until(done)

    def planned(self) -> bool:
        return self.session.snapshot.planning != "planning"

    async def until(self, come: Callable[[], bool]) -> None:
        deadline = time.monotonic() + LIMIT_S
        while not come():
            assert time.monotonic() < deadline, self.screen()
            await self.pilot.pause(0.01)
        await self.pilot.pause()

    async def see(self, *texts: str) -> None:
        """Waits until texts are on the screen."""
        await self.until(lambda: all(text in self.screen() for text in texts))


Script = Callable[[Stage], Awaitable[None]]
Play = Callable[..., None]


@pytest.fixture(scope="session")
def care_home() -> World:
    return load_world("care-home")


@pytest.fixture(scope="session")
def understanding(care_home: World) -> Understanding:
    """The language side of the care home: it remembers nothing, so that sessions can share it."""
    return Understanding(care_home)


@pytest.fixture(scope="session")
def log(tmp_path_factory: pytest.TempPathFactory, care_home: World) -> Path:
    """The log of a lunch, with times that are the same whenever it is made."""
    folder = tmp_path_factory.mktemp("log")
    with Session(care_home) as session:
        plan = session.say(LUNCH).snapshot.plan
        assert plan is not None
        order = RunOrder(
            session.snapshot.automaton, plan, session.planner, log=folder / "made.mcap"
        )
        run_simulated(order, confirmed=True)
    made = read_log(folder / "made.mcap")
    start = made.events[0].time
    # What each step was given isn't in it, so it is no log of a run to be replayed.
    texts = {name: text for name, text in made.attachments.items() if name != OF_RUNS}
    with LogWriter(folder / "lunch.mcap", texts) as writer:
        for event in made.events:
            writer.write(replace(event, time=1000 + round(event.time - start, 2)))
    return folder / "lunch.mcap"


@pytest.fixture(autouse=True)
def _no_color(monkeypatch: pytest.MonkeyPatch) -> None:
    """Textual takes NO_COLOR out of the environment; it is put back after each test."""
    monkeypatch.setenv("NO_COLOR", "1")


@pytest.fixture(autouse=True)
def _no_threads() -> Iterator[None]:
    """Neither a conversation nor a run outlives its screen."""
    yield
    left = [t.name for t in threading.enumerate() if t.name in ("conversation", "run", "talking")]
    assert not left


@pytest.fixture
def play(care_home: World, understanding: Understanding, tmp_path: Path) -> Iterator[Play]:
    """Plays a script before the application in a session of its own."""
    opened: list[Session] = []

    def run(
        script: Script,
        *,
        size: tuple[int, int] = (80, 24),
        world: World | None = None,
        program: Automaton | None = None,
        path: Path | None = None,
        live: bool = False,
        planner: object = None,
        settings: Settings = Settings(),
        profile: Profile | None = None,
        talk: MakeTalking | None = None,
    ) -> Session:
        session = Session(world or care_home, program, path)
        opened.append(session)
        if world is None:
            session.__dict__["understanding"] = understanding
        if planner is not None:
            session.__dict__["planner"] = planner
        app = PolarisApp(
            session, settings, live=live, logs=tmp_path / "logs", profile=profile, talk=talk
        )

        async def act() -> None:
            async with app.run_test(size=size) as pilot:
                stage = Stage(app, pilot, session)
                await stage.until(lambda: "loading" not in stage.screen() and stage.planned())
                await script(stage)

        asyncio.run(act())
        return session

    yield run
    for session in opened:
        session.close()


class GatedPlanner:
    """A planner that goes on only when it is let."""

    def __init__(self, planner: object) -> None:
        self._planner = planner
        self.mutexes = planner.mutexes
        self.gate = threading.Event()
        self.gate.set()

    def drafts(self, automaton: Automaton, stale: Callable[[], bool]) -> Iterator[Draft]:
        assert self.gate.wait(LIMIT_S)
        yield from self._planner.drafts(automaton, stale)
