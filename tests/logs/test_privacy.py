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
    Heard,
    Interpreted,
    Said,
    Understood,
)
from polaris_nl.logs import rosout
from polaris_nl.logs.privacy import Privacy, privacy_of
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.redacting import found_words, redact
from polaris_nl.logs.writer import LogSettings, LogWriter, RawKind
from polaris_nl.model.errors import LogError

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
    assert not any(SECRET in text for text in kept(path))
    assert "I go home." in kept(path)
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
    assert log.attachments["program.polaris.json"] == '{"name": "[left out]"}'
    assert log.events[0].utterance == "bring [left out] to me"
    assert not any(SECRET in text for text in kept(path))


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
