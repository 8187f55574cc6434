"""What people and disks do wrong: each gets one sentence, exit code 1 or 2, and nothing is lost."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from polaris_nl.automaton.program import read_program
from tests.cli.conftest import Command, one_sentence, process


@pytest.mark.parametrize(
    ("utterance", "named"),
    [
        ("bring the zeppelin to the kitchen", "zeppelin"),
        ("put the kitchen on the cup", "kitchen"),
        ("\x1b[2J\x07", ""),
    ],
)
def test_unknown_things_wrong_types_and_control_characters(
    command: Command, tmp_path: Path, utterance: str, named: str
) -> None:
    path = tmp_path / "p.json"
    command("say", "--world", "care-home", "--program", path, "go home")
    before = path.read_bytes()
    result = command("say", "--world", "care-home", "--program", path, utterance)
    assert result.code == 1
    assert named in one_sentence(result.err)
    assert "\x1b" not in result.err
    assert path.read_bytes() == before


@pytest.mark.parametrize("kept", [0, 1, 60, 400])
def test_a_cut_off_program_file(command: Command, lunch: Path, kept: int) -> None:
    cut = lunch.read_bytes()[:kept]
    lunch.write_bytes(cut)
    for arguments in (
        ("plan", lunch),
        ("say", "--program", lunch, "go home"),
        ("run", lunch),
        ("check", lunch),
    ):
        result = command(*arguments)
        assert result.code == 1
        assert lunch.name in one_sentence(result.err)
    assert lunch.read_bytes() == cut


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("this is no PDDL", ""),
        ("(define (problem x))", ""),
        ("(define (domain d) (:predicates (at ?x - thing)", ""),
    ],
)
def test_a_domain_that_is_none(command: Command, tmp_path: Path, content: str, reason: str) -> None:
    (tmp_path / "d.pddl").write_text(content)
    (tmp_path / "w.yaml").write_text(
        "schema: polaris-world/1\nname: w\ndomain: d.pddl\nentities: []\n"
    )
    for arguments in (("check", "d.pddl"), ("say", "--world", "w.yaml", "go home")):
        result = command(*arguments)
        assert result.code == 1
        assert "d.pddl" in one_sentence(result.err)


def test_a_world_with_a_fault_is_named_with_its_line(command: Command, tmp_path: Path) -> None:
    (tmp_path / "w.yaml").write_text(
        "schema: polaris-world/1\nname: w\ndomain: caregiving\nentities:\n  - {name: hall, type: regoin}\n"
    )
    assert "line 5" in one_sentence(command("check", "w.yaml").err)
    assert "Did you mean region?" in one_sentence(
        command("say", "--world", "./w.yaml", "go home").err
    )


@pytest.mark.parametrize(
    "arguments", [("plan", "gone.json"), ("review", "gone.mcap"), ("say", "--world", "mars", "x")]
)
def test_missing_files(command: Command, arguments: tuple[str, ...]) -> None:
    result = command(*arguments)
    assert result.code == 1
    one_sentence(result.err)


def test_bad_recordings(command: Command, tmp_path: Path) -> None:
    (tmp_path / "empty.wav").write_bytes(b"")
    (tmp_path / "text.wav").write_text("not a sound at all\n" * 100)
    result = command("transcribe", "--world", "care-home", "empty.wav", "text.wav", "gone.wav")
    assert result.code == 1
    assert [line.split(":")[0] for line in result.err.splitlines()] == ["polaris-nl"] * 3
    assert "Traceback" not in result.err


def test_ten_megabytes_of_text(tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    flood = b"bring the tray to the kitchen and " * 300_000
    result = process(
        "dialogue",
        "--json",
        "--world",
        "care-home",
        "--program",
        path,
        stdin=b"go home\n" + flood + b"\nread it back\n",
    )
    first, second, third = (json.loads(line) for line in result.stdout.splitlines())
    assert (first["outcome"], second["outcome"], third["outcome"]) == (
        "applied",
        "refused",
        "command",
    )
    assert len(second["utterance"]) < 2_100
    assert read_program(path).automaton.checkpoints.keys() == {"c0", "c1"}
    said = process("say", "--world", "care-home", "-", stdin=flood)
    assert said.returncode == 1
    one_sentence(said.stderr)


def test_bytes_that_are_no_text(tmp_path: Path) -> None:
    result = process(
        "dialogue", "--json", "--world", "care-home", stdin=b"\xff\xfe\x00go home\n\x80\n"
    )
    assert result.returncode == 0
    assert len(result.stdout.splitlines()) == 2


def test_a_full_disk_loses_nothing(lunch: Path) -> None:
    before = lunch.read_bytes()
    with Path("/dev/full").open("wb") as full:
        result = process("plan", "--json", lunch, stdout=full)
    assert result.returncode == 1
    assert "No space left" in one_sentence(result.stderr)
    assert lunch.read_bytes() == before


def test_a_program_that_cannot_be_saved(
    command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import tempfile

    path = tmp_path / "p.json"
    command("say", "--world", "care-home", "--program", path, "go home")
    before = path.read_bytes()

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tempfile, "NamedTemporaryFile", full)
    result = command("say", "--world", "care-home", "--program", path, "then go to the kitchen")
    assert result.code == 1
    assert "No space left on device" in one_sentence(result.err)
    assert path.read_bytes() == before


def test_a_reader_that_goes_away_is_no_error(lunch: Path) -> None:
    result = process("plan", lunch)
    assert result.returncode == 0
    from tests.cli.conftest import ROOT

    script = (
        f"{{ '{Path(__import__('sys').executable)}' -m polaris_nl.cli plan '{lunch}'; }} | true"
    )
    shell = subprocess.run(
        ["bash", "-c", script], cwd=ROOT, capture_output=True, timeout=60, check=False
    )
    assert b"Traceback" not in shell.stderr


@pytest.mark.parametrize(
    ("options", "code", "reason"),
    [
        (("--mic", "tcp://192.0.2.1:10700"), 2, "another machine"),
        (("--mic", "nowhere.wav"), 1, "There is no recording nowhere.wav"),
        (("--record",), 2, "name one with --log"),
    ],
)
def test_listening_to_what_can_t_be_heard(
    command: Command, options: tuple[str, ...], code: int, reason: str
) -> None:
    result = command("listen", "--world", "care-home", *options)
    assert result.code == code
    assert reason in result.err
