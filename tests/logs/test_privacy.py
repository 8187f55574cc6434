"""What is left out of a log isn't in its bytes, compressed or not."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from mcap.reader import make_reader

from polaris_nl.execution.events import (
    Edited,
    Event,
    GoalSent,
    Halted,
    Heard,
    Interpreted,
    Said,
    Understood,
)
from polaris_nl.logs import rosout
from polaris_nl.logs.paths import parts_of
from polaris_nl.logs.privacy import LEFT_OUT, Privacy, privacy_of
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.redacting import found_words, redact
from polaris_nl.logs.writer import LogSettings, LogWriter, RawKind
from polaris_nl.model.errors import LogError
from polaris_nl.replays import replayed
from polaris_nl.runs import RunOrder, run_simulated
from tests.execution.story import Case

SECRET = "Zanzibar"
EVENTS: list[Event] = [
    Heard(time=1.0, utterance=f"bring {SECRET} to me", alternatives=[f"sing {SECRET}"]),
    Interpreted(time=1.1, utterance=f"bring {SECRET}", outcome="applied",
                readings=[{"text": SECRET, "score": 1.0, "why": [SECRET]}]),
    Edited(time=1.2, text=f"Bring {SECRET}.", revision=1, label=f"bring {SECRET}",
           program={"schema": "polaris-program/1", "checkpoints": []}),
    Understood(time=1.3, text=f"I bring {SECRET}.", utterance=SECRET, outcome="applied",
               interpretation={"say": SECRET, "edits": [{"name": SECRET}], "outcome": "applied"}),
    Said(time=1.4, text=f"I said {SECRET}."),
    GoalSent(time=2.0, text="I go home.", goal=1, action="(move hall home)", literals=[], checkpoint="c1"),
]  # fmt: skip
RAW = RawKind("std_msgs/msg/String", "string data\n")


def write(path: Path, privacy: Privacy) -> Path:
    texts = {"program.polaris.json": json.dumps({"name": SECRET}), "world.yaml": "name: x"}
    with LogWriter(path, texts, LogSettings(privacy=privacy)) as log:
        for event in EVENTS:
            log.write(event)
        log.attach("speech-0001.wav", "audio/wav", b"RIFF-sound", 1.0)
        log.write_raw("/names", RAW, 3.0, f"\0\1\0\0{SECRET}".encode())
        log.write_raw("/others", RAW, 3.0, b"\0\1\0\0nothing")
    return path


def kept(path: Path) -> list[str]:
    """The texts for ROS tools."""
    with path.open("rb") as file:
        found = make_reader(file).iter_messages(topics=["/rosout"])
        return [rosout.parsed(message.data)[1] for _, _, message in found]


def test_the_search_finds_what_is_there(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", privacy_of([]))
    assert found_words(path, [SECRET, "zanzibar", "Timbuktu"]) == [SECRET, "zanzibar"]
    assert SECRET.encode() in path.read_bytes() or found_words(path, [SECRET])
    assert set(read_log(path).sounds) == {"speech-0001.wav"}


@pytest.mark.parametrize("afterwards", [False, True])
def test_what_people_said_is_left_out(afterwards: bool, tmp_path: Path) -> None:
    privacy = privacy_of(["text", "audio"])
    if afterwards:
        path = tmp_path / "redacted.mcap"
        found = redact(write(tmp_path / "a.mcap", privacy_of([])), path, privacy)
        assert found.changed >= 5
    else:
        path = write(tmp_path / "a.mcap", privacy)
    log = read_log(path)
    assert log.sounds == {}
    said = [e for e in log.events if not isinstance(e, GoalSent)]
    assert len(said) == 5
    assert not any(SECRET in str(e) for e in said)
    assert log.events[-1].text == "I go home."
    assert kept(path) == [LEFT_OUT] * 3 + ["I go home."]
    assert [e.id for e in log.events] == [1, 2, 3, 4, 5, 6]
    assert log.events[1].causes == [1]
    assert log.metadata["left_out"] == "audio, text"


@pytest.mark.parametrize("afterwards", [False, True])
def test_a_word_is_nowhere(afterwards: bool, tmp_path: Path) -> None:
    privacy = privacy_of([SECRET])
    path = tmp_path / "redacted.mcap"
    if afterwards:
        found = redact(write(tmp_path / "a.mcap", privacy_of([])), path, privacy)
        assert found.left_out == 2, (
            "a robot's message with the word, and sound, which can't be searched"
        )
    else:
        write(path, privacy)
    assert found_words(path, [SECRET]) == []
    assert read_log(path).sounds == {}
    log = read_log(path)
    assert SECRET not in str(log.events)
    assert json.loads(log.attachments["program.polaris.json"]) == {"name": "left-out-1"}
    assert log.events[0].utterance == "bring left-out-1 to me"
    said = ["Bring left-out-1.", "I bring left-out-1.", "I said left-out-1.", "I go home."]
    assert kept(path) == said


@pytest.mark.parametrize("afterwards", [False, True])
@pytest.mark.parametrize(
    ("word", "written"),
    [
        ("Ünal", "ünal"),
        ("ünal", "U\u0308NAL"),
        ("ms green", "ms-green"),
        ("Ms Green", "ms  green"),
        ('5" cup', '5" CUP'),
        ("c:\\x", "C:\\X"),
    ],
)
def test_a_word_is_nowhere_however_it_is_written(
    word: str, written: str, afterwards: bool, tmp_path: Path
) -> None:
    text = f"bring {written} here"
    texts = {
        "program.polaris.json": json.dumps({"name": text}),
        "world.yaml": f"name: {written}",
        "other.json": json.dumps({text: [text]}, ensure_ascii=False),
        "broken.json": f"no json: {written}",
    }
    privacy, path = privacy_of([word]), tmp_path / "a.mcap"
    settings = LogSettings(privacy=privacy_of([]) if afterwards else privacy)
    with LogWriter(path, texts, settings) as log:
        log.write(Heard(time=1.0, utterance=text, alternatives=[text]))
        log.write(Said(time=2.0, text=text))
        log.write_raw("/names", RAW, 3.0, f"\0\1\0\0{written}".encode())
        log.write_raw("/wide", RAW, 3.0, written.encode("utf-16-le"))
    if afterwards:
        assert found_words(path, [word]) == [word]
        path = tmp_path / "redacted.mcap"
        assert redact(tmp_path / "a.mcap", path, privacy).left_out == 2
    found = read_log(path)
    assert found.events[0].utterance == "bring left-out-1 here"
    assert json.loads(found.attachments["program.polaris.json"]) == {
        "name": "bring left-out-1 here"
    }
    everything = "".join((*map(str, found.events), *found.attachments.values(), *kept(path)))
    assert written not in everything
    with path.open("rb") as file:
        assert [
            c.topic for _, c, _ in make_reader(file).iter_messages(topics=["/names", "/wide"])
        ] == []


def test_all_parts_of_a_long_log_are_redacted(tmp_path: Path) -> None:
    path, copy = tmp_path / "a.mcap", tmp_path / "copy.mcap"
    with LogWriter(path, settings=LogSettings(part_bytes=20_000)) as log:
        for number in range(200):
            log.write(Said(time=float(number), text=f"I said {SECRET}."))
    assert len(parts_of(path)) > 1
    found = redact(path, copy, privacy_of([SECRET]))
    assert len(parts_of(copy)) == len(parts_of(path))
    assert found.changed >= 400, "each event, and its line for ROS tools"
    assert [e.id for e in read_log(copy).events] == list(range(1, 201))
    assert all(found_words(part, [SECRET]) == [] for part in parts_of(copy))


def test_a_redacted_copy_is_a_sound_log(tmp_path: Path) -> None:
    path = tmp_path / "redacted.mcap"
    redact(write(tmp_path / "a.mcap", privacy_of([])), path, privacy_of(["text", SECRET]))
    assert read_log(path).complete
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            if channel.message_encoding == "json":
                assert schema is not None
                Draft202012Validator(json.loads(schema.data)).validate(json.loads(message.data))


def test_a_copy_never_takes_the_place_of_another_file(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", privacy_of([]))
    with pytest.raises(LogError, match="already"):
        redact(path, path, privacy_of(["text"]))


@pytest.mark.parametrize("afterwards", [False, True])
def test_a_run_without_a_name_is_still_read_and_replayed(
    afterwards: bool, hasty_dishes: Case, tmp_path: Path
) -> None:
    path, privacy = tmp_path / "run.mcap", privacy_of(["host", "drying rack"])
    order = RunOrder(
        hasty_dishes.automaton, hasty_dishes.plan, hasty_dishes.planner, log=path,
        privacy=privacy_of([]) if afterwards else privacy,
    )  # fmt: skip
    run_simulated(order, confirmed=True)
    if afterwards:
        path = tmp_path / "redacted.mcap"
        redact(tmp_path / "run.mcap", path, privacy)
    assert found_words(path, privacy.never) == []
    assert [r.difference for r in replayed(path)] == [None]
    halted = next(e for e in read_log(path).events if isinstance(e, Halted))
    assert halted.observed == ["(at cup left-out-2)"]
