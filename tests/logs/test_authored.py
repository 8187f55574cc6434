"""From a session to the log of a run: one file answers down to the words, said before the run or in it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from polaris_nl.cli import main
from polaris_nl.execution.events import (
    CommandGiven,
    Edited,
    Event,
    Heard,
    Planned,
    RunEnded,
    RunStarted,
    TransitionTaken,
    Understood,
    Waiting,
)
from polaris_nl.execution.state import HumanCommand
from polaris_nl.logs.asking import ask
from polaris_nl.logs.chain import chain, origin
from polaris_nl.logs.reader import read_log
from polaris_nl.model.formula import parse_literal
from polaris_nl.past import Past, authored
from polaris_nl.runs import RunOrder, run_simulated
from polaris_nl.session import Session
from tests.execution.story import Case

TOLD = "Tell the resident that lunch is ready."
ONCE = "Once she acknowledges, go home."
ELSE = "If she acknowledges, bring a tray to her table, otherwise go home."


@pytest.fixture
def session(lunch: Case) -> Iterator[Session]:
    with Session(lunch.world) as opened:
        yield opened


def order_of(session: Session, log: Path) -> RunOrder:
    snapshot = session.wait()
    assert snapshot.plan is not None
    return RunOrder(
        snapshot.automaton, snapshot.plan, session.planner, (), log=log, before=session.past
    )


def words(events: list[Event]) -> list[str]:
    return [e.utterance for e in events if isinstance(e, Heard)]


def test_what_is_told_in_a_run_is_answered_by_the_words(session: Session, tmp_path: Path) -> None:
    for text in (TOLD, ONCE, "run it", "yes"):
        session.say(text)
    shown: list[Event] = []
    heard = Heard(time=1.0, utterance="she has acknowledged it", source="voice")
    told = HumanCommand("happened", (parse_literal("(acknowledged lunchtime)"),), "voice", heard)

    def commands() -> list[HumanCommand]:
        waits = bool(shown) and isinstance(shown[-1], Waiting)
        return [told] if waits else []

    log = order_of(session, tmp_path / "run.mcap")
    run_simulated(log, confirmed=True, show=shown.append, commands=commands)
    events = read_log(tmp_path / "run.mcap").events
    taken = next(e for e in events if isinstance(e, TransitionTaken) and e.when)
    assert set(words(origin(events, taken.id))) >= {ONCE, heard.utterance}
    command = next(e for e in events if isinstance(e, CommandGiven))
    assert words(chain(events, command.id)) == [heard.utterance]
    assert heard not in shown, "faces have shown it already"
    started = next(e for e in events if isinstance(e, RunStarted))
    assert "yes" in words(origin(events, started.id))


def test_why_the_else_branch_from_one_log(session: Session, tmp_path: Path) -> None:
    session.say(TOLD)
    session.say(ELSE)
    path = tmp_path / "run.mcap"
    run_simulated(order_of(session, path), confirmed=True)
    events = read_log(path).events
    reply = ask(events, "why did it take the else branch?")
    assert words(list(reply.chain))[-1:] == [ELSE]
    again = ask(events, "why did it end?")
    assert isinstance(again.chain[-1], RunEnded)


def test_a_stop_by_a_key_is_not_put_down_to_earlier_words(session: Session, tmp_path: Path) -> None:
    session.say(TOLD)
    session.say(ONCE)
    shown: list[Event] = []
    orders = [
        HumanCommand("pause", said=Heard(time=1.0, utterance="hold on")),
        HumanCommand("stop"),
    ]

    def commands() -> list[HumanCommand]:
        return [orders.pop(0)] if len(shown) > 5 and orders else []

    path = tmp_path / "run.mcap"
    run_simulated(order_of(session, path), confirmed=True, show=shown.append, commands=commands)
    events = read_log(path).events
    pause, stop = (e for e in events if isinstance(e, CommandGiven))
    assert words(origin(events, pause.id)) == ["hold on"]
    assert origin(events, stop.id) == []
    ended = next(e for e in events if isinstance(e, RunEnded))
    assert ended.causes[0] == stop.id


def test_of_plans_only_the_last_is_remembered() -> None:
    def edit(revision: int) -> Edited:
        return Edited(time=0.0, revision=revision, label="x")

    def plan(revision: int) -> Planned:
        return Planned(time=0.0, revision=revision, status="ok")

    past = Past()
    for event in (plan(0), edit(1), plan(1), edit(2), plan(2), plan(2)):
        past.add(event)
    past.add(RunEnded(time=0.0, outcome="done"))
    assert past.events() == (edit(1), edit(2), plan(2))
    assert authored((plan(1), edit(2))) == (edit(2),)


def test_the_commands_keep_what_was_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    program, run = (
        ("--world", "care-home", "--program", "a.polaris.json"),
        ("run", "a.polaris.json"),
    )
    assert main(["say", *program, "--log", "said.mcap", TOLD]) == 0
    assert main([*run, "--said", "said.mcap", "--log", "run.mcap"]) == 0
    found = read_log(Path("run.mcap"))
    assert words(found.events) == [TOLD]
    assert '"grammar"' in read_log(Path("said.mcap")).attachments["settings.json"]
    assert any(isinstance(e, Understood) for e in found.events)
    assert main(["say", *program, ONCE]) == 0
    capsys.readouterr()
    assert main([*run, "--said", "said.mcap", "--log", "other.mcap"]) == 1
    assert "led to another program" in capsys.readouterr().err
    assert main(["say", *program, "--log", "bare.mcap", "--leave-out", "text", "undo"]) == 0
    assert "undo" not in words(read_log(Path("bare.mcap")).events)
