"""Runs on a robot, begun and stopped by voice alone: the simulated Stretch, over ROS 2."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from rosbags.highlevel import AnyReader

from polaris_nl.execution.clock import RealClock
from polaris_nl.execution.events import RunEnded
from polaris_nl.execution.ros.profile import profile_for
from polaris_nl.speech.ears import EarMaker
from polaris_nl.speech.trouble import Trouble
from tests.execution.ros.processes import Onlooker, Process, new_domain
from tests.hands_free.talking import Talk
from tests.speech.speaking import SILENCE, Saying, blocks_of, silence, spoken

PATIENCE_S = 30.0
STILL_S, LATE_S = 0.7, 0.35
"""For so long after a run it is watched that nothing moves, from so long after its end."""
SIM = profile_for("stretch-sim")


class StopOnceItMoves(Saying):
    """Says "stop" once the robot drives."""

    def __init__(self, onlooker: Onlooker, *sentences: str) -> None:
        super().__init__(*sentences)
        self._onlooker = onlooker

    def sound(self) -> Iterator[bytes | Trouble]:
        yield from super().sound()
        until = self._onlooker.clock.now() + PATIENCE_S
        while not self._onlooker.moved_at:
            assert self._onlooker.clock.now() < until, "the robot never moved"
            yield SILENCE
        yield from blocks_of(spoken("stop"))
        yield from silence(1)


@pytest.fixture(scope="module")
def maker() -> EarMaker:
    return EarMaker()


@pytest.fixture
def domain(monkeypatch: pytest.MonkeyPatch) -> str:
    """A network of the test's own."""
    found = new_domain()
    monkeypatch.setenv("ROS_DOMAIN_ID", found)
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    return found


@pytest.fixture
def onlooker(domain: str) -> Iterator[Onlooker]:
    """Watches a simulated robot of its own."""
    robot = Process(
        "polaris_nl.execution.ros.stretch_sim",
        "--world",
        "care-home",
        "--kinematic",
        "--speed",
        "2",
    )
    robot.wait_for("ready")
    watching = Onlooker(RealClock(), "/polaris/sim/fault")
    watching.ready()
    yield watching
    watching.close()
    robot.close()


def test_a_robot_is_started_and_stopped_by_voice(
    maker: EarMaker, onlooker: Onlooker, tmp_path: Path
) -> None:
    with Talk("care-home", maker, tmp_path / "talk.mcap", SIM) as talk:
        face = talk.hold(StopOnceItMoves(onlooker, "go to the office", "run it", "yes"))
        assert talk.conversation.running is not None
        assert talk.conversation.running.join(PATIENCE_S)
        ended_at = onlooker.clock.now()
    assert face.texts[1].startswith("The simulated Stretch will move. ")
    assert face.texts[1].endswith("Shall I start? Say yes or no.")
    assert "Stopped." in face.told
    (end,) = (e for e in talk.events if isinstance(e, RunEnded))
    assert end.outcome == "stopped"
    heard_at = onlooker.odometry_at
    onlooker.wait(lambda: onlooker.odometry_at > max(heard_at, ended_at) + STILL_S)
    assert [at for at in onlooker.moved_at if at > ended_at + LATE_S] == []
    assert "/odom" in topics(tmp_path / "talk-run-1.mcap")


def topics(log: Path) -> set[str]:
    """What a log has messages of, read by another program's library."""
    with AnyReader([log]) as reader:
        return {c.topic for c in reader.connections if c.msgcount}


def test_a_robot_that_is_not_there_is_told_and_the_conversation_goes_on(
    maker: EarMaker, domain: str
) -> None:
    impatient = replace(SIM, times=replace(SIM.times, ready=0.5))
    with Talk("care-home", maker, robot=impatient) as talk:
        talk.hold(Saying("go to the office", "run it", "yes"))
        assert talk.conversation.running is not None
        assert talk.conversation.running.join(PATIENCE_S)
        face = talk.hold(Saying("where are you"))
    assert any("start it with: polaris-nl stretch-sim --world care-home" in t for t in face.told)
    assert face.texts[-1] == "I'm at home."
