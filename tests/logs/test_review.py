"""What `review` says of logs: views, filters, questions; on the command line, at 80 columns."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from polaris_nl.cli import main
from polaris_nl.execution.events import (
    Edited,
    Event,
    GoalSent,
    Halted,
    Heard,
    Observed,
    PersonActed,
    TransitionTaken,
)
from polaris_nl.logs.asking import ask
from polaris_nl.logs.chain import chain
from polaris_nl.logs.expected import beliefs_at, expectations
from polaris_nl.logs.filters import check, matcher
from polaris_nl.logs.paths import parts_of
from polaris_nl.logs.reader import filtered, read_log
from polaris_nl.logs.sayings import said
from polaris_nl.logs.spans import spans
from polaris_nl.logs.writer import LogSettings
from polaris_nl.model.errors import UsageError
from polaris_nl.render.glyphs import ASCII, UNICODE
from polaris_nl.render.run_timeline import timeline_rows
from polaris_nl.runs import RunOrder, run_simulated
from polaris_nl.session import Session
from tests.execution.story import Case, case
from tests.logs.conftest import Carrying
from tests.logs.decoding import decoded
from tests.logs.writing import goal, goals, write

WIDTH = 80
Review = Callable[..., tuple[int, str]]


@pytest.fixture
def review(capsys: pytest.CaptureFixture[str]) -> Review:
    """Calls `review`; gives the exit code and what it printed, no line of it too long."""

    def call(*arguments: object) -> tuple[int, str]:
        code = main(["review", *map(str, arguments)])
        out = capsys.readouterr().out
        if "--json" not in arguments and "--export" not in arguments:
            assert [line for line in out.splitlines() if len(line) > WIDTH] == []
        return code, out

    return call


@pytest.fixture(scope="session")
def told(lunch: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run with all that led to it, from the first word on."""
    path = tmp_path_factory.mktemp("told") / "lunch.mcap"
    before: list[Event] = []
    with Session(lunch.world, sink=before.append) as session:
        session.say("Tell the resident that lunch is ready.")
        session.say("Once she acknowledges, bring a full tray to her table.")
        session.say("If she dismisses it, just go home.")
        snapshot = session.wait()
        assert snapshot.plan is not None
        order = RunOrder(
            snapshot.automaton, snapshot.plan, session.planner, log=path, before=tuple(before)
        )
        assert run_simulated(order, confirmed=True).result.outcome == "done"
    return path


@pytest.fixture
def otherwise(lunch: Case, tmp_path: Path) -> Path:
    """A run that takes an else branch."""
    made = case(
        lunch.planner,
        ("start", "alerted", (), ("(alerted-to resident lunchtime)",)),
        ("alerted", "fetched", ("(acknowledged lunchtime)",), ("(at tray table)",)),
        ("alerted", "home", (), ("(robot-at home)",)),
    )
    order = RunOrder(made.automaton, made.plan, made.planner, people=(), log=tmp_path / "else.mcap")
    return run_simulated(order, confirmed=True).log


# Events and what led to them


def test_a_decision_goes_back_to_the_words_and_to_what_was_seen(told: Path) -> None:
    events = read_log(told).events
    taken = [e for e in events if isinstance(e, TransitionTaken) and e.when]
    found = chain(events, taken[0].id)
    heard = [e.utterance for e in found if isinstance(e, Heard)]
    assert heard[-1] == "Once she acknowledges, bring a full tray to her table."
    assert [e.id for e in found] == sorted(e.id for e in found)
    acted = next(n for n, e in enumerate(found) if isinstance(e, PersonActed))
    assert isinstance(found[acted + 1], Observed)
    assert found[acted + 1].causes == [found[acted].id]
    assert found[-1] == taken[0]
    edits = [e for e in found if isinstance(e, Edited)]
    assert edits[-1].id in taken[0].causes


def test_every_event_of_a_run_follows_from_another(told: Path) -> None:
    events = read_log(told).events
    assert [e.id for e in events] == list(range(1, len(events) + 1))
    without = [type(e).__name__ for e in events if not e.causes]
    assert set(without) == {"Heard", "PersonActed"}
    assert all(cause < e.id for e in events for cause in e.causes)


def test_the_whole_chain_has_every_step(told: Path) -> None:
    events = read_log(told).events
    last = events[-2]
    assert len(chain(events, last.id, whole=True)) > len(chain(events, last.id))
    assert chain(events, 10_000) == []


def test_others_decode_every_channel_of_a_session_and_its_run(told: Path) -> None:
    found = decoded(told)
    assert {"/rosout", "/polaris/heard", "/polaris/edited", "/polaris/inputs"} <= set(found)
    assert len(found) >= 16


# Filters


def test_filters(told: Path) -> None:
    events = read_log(told).events

    def found(*filters: str) -> list[Event]:
        return [e for _, e in filtered(events, matcher(filters, events))]

    assert all("goal-sent" in e.topic for e in found("topic=goal-sent"))
    assert found("severity=warning") == []
    fill = found("goal=fill")
    assert len({getattr(e, "goal", 0) for e in fill}) == 1
    assert len(fill) >= 4, "what was sent, reported and confirmed"
    assert found(f"goal={fill[0].goal}") == fill
    about = found("entity=tray")
    assert any(isinstance(e, Observed) for e in about)
    assert found("entity=tra") == []
    start = next(e.time for e in events if e.topic == "/polaris/run")
    span = found("time=10..15")
    assert span
    assert all(10 <= e.time - start <= 15 for e in span)
    assert found("time=..15", "time=10..") == span
    assert found("time=12.2") == [e for e in events if 11.7 <= e.time - start <= 12.7]
    assert found("entity=tray", "topic=beliefs") == [e for e in about if isinstance(e, Observed)]


def test_filters_that_make_no_sense_are_text_or_an_error() -> None:
    events = goals(3)
    assert list(filtered(events, matcher(["severity=terrible"], events))) == []
    for text in ("severity=terrible", "time=noon"):
        with pytest.raises(UsageError):
            check([text])


# Time


def test_the_timeline_of_a_run(told: Path) -> None:
    found = spans(read_log(told).events)
    assert [s.label for s in found if s.kind == "segment"] == ["alerted", "fetched"]
    assert all(s.done for s in found)
    wait = next(s for s in found if s.kind == "wait")
    assert wait.label == "wait until lunch is acknowledged or lunch is dismissed"
    actions = [s for s in found if s.kind == "action"]
    assert sum(s.seconds for s in actions) > 30
    for glyphs in (UNICODE, ASCII):
        for width in (60, 80, 100):
            rows = timeline_rows(found, glyphs, width)
            assert len(rows) == len(found) + 1
            assert all(len(row.text) <= width for row in rows)
    assert all(row.text.isascii() for row in timeline_rows(found, ASCII, WIDTH))


def test_what_was_not_finished_is_marked(scenario_log: Carrying, tmp_path: Path) -> None:
    events = read_log(scenario_log("goal never ends", tmp_path)).events
    last = spans(events)[-1]
    assert (last.kind, last.done) == ("action", False)
    assert ASCII.bad in timeline_rows(spans(events), ASCII, WIDTH)[-1].text


# Expected and seen


def test_what_was_expected_beside_what_was_seen(
    scenario_log: Carrying, tmp_path: Path, review: Review
) -> None:
    path = scenario_log("forgotten wait", tmp_path)
    events = read_log(path).events
    halted = next(e for e in events if isinstance(e, Halted))
    found = {x.literal: x for x in expectations(events, halted.id)}
    cup = found["(at cup countertop)"]
    assert (cup.holds, cup.why, cup.instead) == (False, "plan", ("(at cup drying-rack)",))
    facts, stale = beliefs_at(events, halted.id)
    assert "(at cup drying-rack)" in facts
    assert stale == set()
    _, out = review(path, "--expected", halted.id)
    assert "Expected: the cup is on the countertop." in " ".join(out.split())
    assert "Seen: the cup is on the drying rack." in " ".join(out.split())


# Questions


def answer(path: Path, question: str) -> str:
    return ask(read_log(path).events, question).text


def test_questions_about_a_run(told: Path) -> None:
    assert "carried out to its end" in answer(told, "Why did it halt?")
    assert answer(told, "why did it go to the cafeteria").startswith("I go to the cafeteria.")
    assert "no else branch" in answer(told, "why did it take the else branch?")
    assert "I wait until lunch is acknowledged" in answer(told, "what did it wait for?")
    assert "fill the tray at the food station: 2.5 s" in answer(
        told, "how long did it take to fill the tray?"
    )
    assert answer(told, "how long did it take?").startswith("The run took")
    reply = ask(read_log(told).events, "what happened to the tray?")
    assert all("tray" in str(e) for e in reply.chain)
    assert len(reply.chain) >= 5
    said_then = ask(read_log(told).events, "what did we say?")
    assert next(e.utterance for e in said_then.chain if isinstance(e, Heard)).startswith("Tell")
    seen = ask(read_log(told).events, "what did it see after 12 s?")
    assert isinstance(seen.chain[-1], Observed)
    with pytest.raises(UsageError, match="Ask, for instance"):
        answer(told, "what is love?")
    with pytest.raises(UsageError, match="no event 9999"):
        answer(told, "why event 9999?")


def test_why_the_else_branch_was_taken(otherwise: Path) -> None:
    reply = ask(read_log(otherwise).events, "why did it take the else branch?")
    assert "That is the else branch" in reply.text
    assert "(acknowledged lunchtime)" in reply.text
    assert isinstance(reply.chain[-1], TransitionTaken)
    assert reply.chain[-1].when == []


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("run-stop pressed", "run-stop button is pressed"),
        ("forgotten wait", "let the program wait until the cup is on the drying rack"),
        ("nobody answers", "Nobody did what the program waited for"),
        ("executor killed in the middle of a goal", "ends in the middle of the run"),
    ],
)
def test_why_it_halted(name: str, words: str, scenario_log: Carrying, tmp_path: Path) -> None:
    assert words in answer(scenario_log(name, tmp_path), "why did it halt?")


def test_why_something_was_not_done(
    otherwise: Path, scenario_log: Carrying, tmp_path: Path
) -> None:
    other = answer(otherwise, "Why didn't it bring the tray?")
    assert 'From "alerted" it went another way: On to home. That is the else branch' in other
    assert answer(otherwise, "why did it go home?").startswith("I go home.")
    over = answer(scenario_log("forgotten wait", tmp_path), "why didn't it put the plate away?")
    assert "The run was over before." in over
    assert "the cup is on the drying rack" in over
    with pytest.raises(UsageError, match="fits"):
        answer(otherwise, "why didn't it water the flowers?")
    assert answer(otherwise, "why did it not go to the hall?").startswith("It did.")


def test_more_questions(otherwise: Path, scenario_log: Carrying, tmp_path: Path) -> None:
    halted = scenario_log("forgotten wait", tmp_path)
    assert "(at cup countertop)" in answer(halted, "what did it expect?")
    assert answer(halted, "did it finish?").startswith("No: it was halted.")
    assert answer(otherwise, "did it finish?").startswith("Yes: it was done.")
    assert re.match(r"At 31\.\d s, that is at \d", answer(halted, "when did it reach fetched?"))
    assert answer(halted, "why did it stop waiting?") == "It waited for nobody."
    assert answer(halted, "why is the cup on the drying rack?").startswith("Seen: ")
    turns = ask(read_log(halted).events, "what happened?").chain
    assert isinstance(turns[-2], Halted)
    assert any(isinstance(e, PersonActed) for e in turns)


def test_a_session_with_two_runs(
    told: Path, otherwise: Path, tmp_path: Path, review: Review
) -> None:
    path = tmp_path / "session.mcap"
    events = [*read_log(told).events, *read_log(otherwise).events]
    write(path, [replace(e, time=float(n)) for n, e in enumerate(events)])
    out = review(path)[1]
    assert re.search(r"^Run 1 of 2, from \d", out, re.MULTILINE)
    assert out.count("End: done") == 2
    assert out.index("on to fetched") < out.index("Run 2 of 2") < out.index("the else branch")
    question = "why did it take the else branch"
    assert "That is the else branch" in answer(path, question)
    assert "no else branch" in answer(path, f"{question} in the first run?")
    assert "That is the else branch" in answer(path, f"{question} in run 2?")
    both, one = (
        {d["what"]: d["count"] for d in json.loads(review(x, "--durations", "--json")[1])}
        for x in (path, told)
    )
    assert both["move"] > one["move"]
    first = re.findall(r"^(?:alerted|fetched|home) ", review(path, "--timeline")[1], re.MULTILINE)
    assert first == ["alerted ", "fetched ", "alerted ", "home "]


def test_what_the_run_was_told_is_told_with_the_time(
    scenario_log: Carrying, tmp_path: Path, review: Review
) -> None:
    out = review(scenario_log("an answer by word of mouth", tmp_path))[1]
    assert "Told: that lunch has been dismissed, at 11.3 s (voice)." in out.splitlines()
    assert "Decided: Lunch is dismissed: on to cancelled." in out.splitlines()


def test_a_person_who_stops_a_run_is_no_problem(
    scenario_log: Carrying, tmp_path: Path, review: Review
) -> None:
    out = review(scenario_log("cancel ignored", tmp_path))[1]
    assert "A person stopped the run at the keyboard." in out
    assert "Problem" not in out


def test_the_else_branch_is_a_decision(otherwise: Path, review: Review) -> None:
    out = review(otherwise)[1]
    assert "Decided: On to home, the else branch." in out.splitlines()
    assert "Program: Tell the resident that lunch is ready." in out


def test_events_are_listed_with_what_was_said(told: Path, review: Review) -> None:
    out = review(told, "--events")[1]
    assert 'Typed: "Tell the resident that lunch is ready."' in " ".join(out.split())
    assert "The robot says that it has done it." in out


def test_why_it_went_another_way(scenario_log: Carrying, tmp_path: Path) -> None:
    path = scenario_log("object moved elsewhere", tmp_path)
    text = answer(path, "why did it go another way?")
    assert "I plan anew, since the tray is on the dining table" in text


# The command


def test_the_summary_tells_the_whole_story(told: Path, review: Review) -> None:
    code, out = review(told)
    assert code == 0
    lines = out.splitlines()
    assert lines[0].startswith("lunch.mcap; ")
    assert 'Typed: "Tell the resident that lunch is ready."' in lines
    assert any(line.startswith("Answer: Once lunch is acknowledged") for line in lines)
    assert any(line.startswith("Planned: 10 actions") for line in lines)
    assert any(line.startswith("Decided: Lunch is acknowledged") for line in lines)
    assert any(line.startswith("End: done") for line in lines)
    assert len(lines) <= 24


@pytest.mark.parametrize(
    "option",
    [
        ("--events",), ("--timeline",), ("--step", "20"), ("--next",), ("--chain", "40"),
        ("--expected", "40"), ("--durations",), ("--replay",), ("--page", "2"), ("--score",),
        ("--ask", "why did it go to the hall?"), ("--filter", "entity=tray"),
    ],
)  # fmt: skip
def test_every_view_in_words_and_as_json(
    option: tuple[str, ...], told: Path, review: Review
) -> None:
    words, as_json = review(told, *option), review(told, *option, "--json")
    assert words[0] == as_json[0]
    assert words[1].strip()
    for line in as_json[1].splitlines():
        json.loads(line)
    assert words[0] == (1 if option == ("--score",) else 0), "nobody has brought the robot home"


def test_exports(told: Path, review: Review) -> None:
    events = read_log(told).events
    table = list(csv.DictReader(io.StringIO(review(told, "--export", "csv")[1])))
    assert [int(row["number"]) for row in table] == [e.id for e in events]
    assert table[0]["text"] == '"Tell the resident that lunch is ready."'
    assert [row["causes"].split() for row in table] == [list(map(str, e.causes)) for e in events]
    lines = review(told, "--export", "jsonl", "--filter", "topic=goal-sent")[1].splitlines()
    sent = [json.loads(line)["action"] for line in lines]
    assert sent == [e.action for e in events if isinstance(e, GoalSent)]
    whole: dict[str, Any] = json.loads(review(told, "--export", "json")[1])
    assert len(whole["events"]) == len(events)
    assert whole["metadata"]["schema"] == "polaris-log/1"
    report = review(told, "--export", "markdown")[1]
    for heading in ("## What was said", "## What happened", "## Timeline", "## Events"):
        assert heading in report
    assert "Nothing went wrong." in report


def test_next_problem_goes_through_them_all(
    scenario_log: Carrying, tmp_path: Path, review: Review
) -> None:
    path = scenario_log("forgotten wait", tmp_path)
    first = json.loads(review(path, "--next", "--json")[1])["number"]
    second = json.loads(review(path, "--next", first, "--json")[1])["number"]
    assert first < second
    assert json.loads(review(path, "--next", second, "--json")[1])["number"] is None


def test_two_runs_compared(told: Path, otherwise: Path, review: Review) -> None:
    assert review(told, "--diff", told)[0] == 0
    code, out = review(told, "--diff", otherwise)
    assert code == 1
    lines = [(line[0], line[14:]) for line in out.splitlines()]
    assert ("-", "Reached fetched.") in lines
    assert ("+", "Reached home.") in lines
    found = json.loads(review(told, "--diff", otherwise, "--json")[1])
    assert {"-checkpoint fetched", "+checkpoint home"} <= {
        x["sign"] + x["line"] for x in found["diff"]
    }


def test_a_folder_of_logs_is_a_table(
    told: Path, scenario_log: Carrying, tmp_path: Path, review: Review
) -> None:
    scenario_log("nobody answers", tmp_path)
    (tmp_path / "lunch.mcap").write_bytes(told.read_bytes())
    code, out = review(tmp_path)
    lines = out.splitlines()
    assert code == 0
    assert lines[0].split() == ["log", "when", "s", "end", "problem"]
    assert "done" in lines[1]
    assert "halted" in lines[2]
    assert lines[2].endswith("nobody came")
    (tmp_path / "zz.mcap").write_bytes(b"no log at all")
    code, out = review(tmp_path, "--json")
    assert code == 1
    assert [bool(x["error"]) for x in json.loads(out)] == [False, False, True]
    table = review(tmp_path, "--durations")[1].splitlines()
    assert table[1].split()[0] == "move"


def test_a_cut_off_log_is_mended_beside_the_original(
    told: Path, tmp_path: Path, review: Review, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "cut.mcap"
    whole = told.read_bytes()
    path.write_bytes(whole[: len(whole) * 2 // 3])
    assert main(["review", str(path)]) == 1
    printed = capsys.readouterr()
    assert "cut off while writing" in printed.err
    assert path.read_bytes() == whole[: len(whole) * 2 // 3]
    mended = tmp_path / "cut.recovered.mcap"
    assert read_log(mended).events == read_log(path).events
    assert read_log(mended).complete


def test_of_a_log_in_parts_only_the_one_that_was_cut_off_is_mended(
    tmp_path: Path, review: Review
) -> None:
    path = write(tmp_path / "a.mcap", goals(400), LogSettings(part_bytes=20_000))
    last = parts_of(path)[-1]
    last.write_bytes(last.read_bytes()[:-30])
    assert review(path)[0] == 1
    assert [p.name for p in tmp_path.glob("*.recovered.mcap")] == [f"{last.stem}.recovered.mcap"]
    out = review(path, "--page", 20)[1]
    assert out.splitlines()[-1] == "Page 20 of 20."


@pytest.mark.parametrize(
    "arguments",
    [("--step", "9999"), ("--page", "0"), ("--page", "9999"), ("--filter", "severity=bad")],
)
def test_what_there_is_not(arguments: tuple[str, ...], told: Path, review: Review) -> None:
    assert review(told, *arguments)[0] == 2


def test_a_redacted_copy_on_the_command_line(told: Path, tmp_path: Path, review: Review) -> None:
    target = tmp_path / "copy.mcap"
    code, out = review(told, "--redact", "text", "--out", target)
    assert code == 0
    assert "without text" in out
    assert not any(
        "lunch is ready" in str(e) for e in read_log(target).events if isinstance(e, Heard)
    )


def test_every_event_says_something(told: Path) -> None:
    assert all(said(e).strip() for e in read_log(told).events)


def test_pages_of_an_older_log_without_numbers(tmp_path: Path, review: Review) -> None:
    path = write(tmp_path / "a.mcap", [goal(n, "I go.") for n in range(45)])
    out = review(path, "--page", 3)[1]
    assert "Page 3 of 3." in out
    assert out.count("I go.") == 5
