"""The command line of DESIGN section 6, as outside programs use it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from polaris_nl.commands.parser import make_parser
from tests.cli.conftest import LUNCH, TIDY, Command, one_sentence, process

ANSWER = {
    "utterance",
    "outcome",
    "edits",
    "say",
    "command",
    "question",
    "refusal",
    "program",
    "plan",
    "ms",
}


def names(program: dict[str, list[dict[str, str]]]) -> list[str]:
    return [c["name"] for c in program["checkpoints"]]


def test_say_applies_saves_and_prints_the_object(command: Command, tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    result = command("say", "--json", "--world", "care-home", "--program", path, LUNCH)
    value = result.json
    assert result.code == 0
    assert set(value) == ANSWER
    assert (value["outcome"], value["command"], value["question"], value["refusal"]) == (
        "applied",
        None,
        None,
        None,
    )
    assert value["plan"] == {"status": "ok", "omitted": [], "actions": 14}
    assert json.loads(path.read_text()) == value["program"]
    goals = {c["name"]: set(c["goals"]) for c in value["program"]["checkpoints"]}
    assert goals == {
        "start": set(),
        "alerted": {"(alerted-to resident lunchtime)"},
        "fetched": {"(at tray table)", "(is-full tray)"},
        "home": {"(robot-at home)"},
        "cancelled": {"(robot-at home)"},
    }
    ids = {c["id"]: c["name"] for c in value["program"]["checkpoints"]}
    ways = {(ids[t["from"]], ids[t["to"]], *t["when"]) for t in value["program"]["transitions"]}
    assert ways == {
        ("start", "alerted"),
        ("alerted", "fetched", "(acknowledged lunchtime)"),
        ("fetched", "home"),
        ("alerted", "cancelled", "(dismissed lunchtime)"),
    }


def test_say_without_a_program_changes_no_file(command: Command, tmp_path: Path) -> None:
    assert command("say", "--world", "care-home", "go home").code == 0
    assert list(tmp_path.iterdir()) == []


def test_dialogue_prints_one_object_a_line_and_ignores_blank_ones(tmp_path: Path) -> None:
    path = tmp_path / "tidy.json"
    said = "\n\n".join(
        (*TIDY, "what will you do?", "run it", "yes", "save", "frobnicate the plate")
    )
    result = process(
        "dialogue", "--json", "--world", "dinner-party", "--program", path, stdin=said.encode()
    )
    answers = [json.loads(line) for line in result.stdout.splitlines()]
    assert result.returncode == 0
    assert result.stderr == b""
    assert [a["outcome"] for a in answers] == [
        "applied", "applied", "applied", "command", "command", "command", "command", "refused",
    ]  # fmt: skip
    assert [a["command"] for a in answers][4:7] == ["run", "yes", "save"]
    assert "Shall I start?" in answers[4]["say"]
    assert answers[-1]["program"] == json.loads(path.read_text())
    assert answers[-1]["refusal"]["unknown"] == ["frobnicate"]


def test_dialogue_without_a_program_refuses_to_save(tmp_path: Path) -> None:
    result = process("dialogue", "--json", "--world", "care-home", stdin=b"save\nyes\n")
    save, yes = (json.loads(line) for line in result.stdout.splitlines())
    assert save["outcome"] == "refused"
    assert "--program" in save["refusal"]["reason"]
    assert (yes["outcome"], yes["command"]) == ("command", "yes")


def test_plan_as_json_and_as_text(command: Command, lunch: Path) -> None:
    value = command("plan", "--json", lunch).json
    assert set(value) >= {"status", "ms", "segments", "branches", "tree", "problems", "warnings"}
    assert (value["status"], [b["actions"] for b in value["branches"]]) == ("ok", [12, 5])
    assert all(s["optimal"] for s in value["segments"])
    text = command("plan", lunch)
    assert text.code == 0
    assert "3 tell the resident that lunch is ready" in text.out
    assert "Once lunch is dismissed, I go to the hall and go home." in text.out


def test_a_plan_with_a_problem_ends_with_1(command: Command, tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    command("say", "--world", "care-home", "--program", path, "Hold the cup and the plate.")
    result = command("plan", path)
    assert result.code == 1
    assert "conflict" in result.out
    assert command("plan", "--json", path).json["problems"][0]["cause"] == "conflict"


def test_why(command: Command, lunch: Path) -> None:
    told = command("why", lunch, "--action", 2).out.replace("\n", " ")
    assert "so that I can tell the resident that lunch is ready, as you asked me to." in told
    value = command("why", "--json", lunch, "--action", 2).json
    assert set(value) >= {"text", "possible", "action", "checkpoint", "reasons", "purposes"}
    assert [p["goal"] for p in value["purposes"]] == ["(alerted-to resident lunchtime)"]
    assert "the aim is that" in command(
        "why", lunch, "--checkpoint", "fetched"
    ).out.lower().replace("\n", " ")
    assert command("why", "--json", lunch, "--not", "(at cup desk)").json["possible"] is True
    impossible = command("why", lunch, "--not", "the resident is in the office")
    assert impossible.code == 1
    one_sentence(command("why", lunch, "--action", 99).err)
    assert command("why", lunch, "--checkpoint", "nowhere").code == 2
    assert command("why", lunch).code == 0


def test_run_and_review(command: Command, lunch: Path, tmp_path: Path) -> None:
    log = tmp_path / "run.mcap"
    result = command("run", "--json", lunch, "--log", log)
    assert (result.code, result.json["outcome"], result.json["checkpoints"]) == (
        0,
        "done",
        ["alerted", "fetched", "home"],
    )
    assert [o["met"] for o in result.json["objectives"]] == [True, True, True]
    other = tmp_path / "other.mcap"
    dismissed = command("run", lunch, "--people", "dismiss", "--log", other)
    assert "Reached cancelled." in dismissed.out
    short = command("review", "--json", log).json
    assert (short["outcome"], short["goals_done"]) == ("done", 12)
    assert "End: done" in command("review", log).out
    waits = command("review", log, "--filter", "topic=waiting").out
    assert waits.count("\n") >= 1
    assert "wait until" in waits
    assert command("review", log, "--diff", other).code == 1
    assert command("review", log, "--diff", log).code == 0
    assert len(command("review", log, "--export", "csv").out.splitlines()) > 30
    assert command("review", "--json", log, "--step", 1).json["number"] == 1
    assert command("review", log, "--recover").code == 0
    one_sentence(command("run", lunch, "--log", log).err)  # a log is never written over


def test_a_run_that_halts_ends_with_1(command: Command, lunch: Path, tmp_path: Path) -> None:
    result = command("run", "--json", lunch, "--people", "none", "--log", tmp_path / "x.mcap")
    assert (result.code, result.json["outcome"]) == (1, "halted")
    assert "acknowledged" in result.json["reason"]


def test_a_run_that_halts_says_how_it_goes_on_and_so_it_does(
    command: Command, lunch: Path, tmp_path: Path
) -> None:
    log = tmp_path / "halted.mcap"
    halted = " ".join(command("run", lunch, "--people", "none", "--log", log).out.split())
    _, _, offered = halted.partition("it goes on with: polaris-nl ")
    result = command(*offered.split(), "--log", tmp_path / "rest.mcap", "--json")
    assert (result.code, result.json["outcome"]) == (0, "done")
    assert result.json["checkpoints"] == ["alerted", "fetched", "home"]


def test_score_counts_objectives(command: Command, tmp_path: Path) -> None:
    path = tmp_path / "t.json"
    for sentence in TIDY:
        command("say", "--world", "dinner-party", "--program", path, sentence)
    result = command("score", "--json", path)
    value = result.json
    assert (result.code, value["met"], value["of"]) == (0, 4, 4)
    assert (value["feasibility"], value["human_effort"], value["settled"]) == (4, 2, True)
    assert [d["name"] for d in value["effort_actions"]] == ["wash the cup", "wash the plate"]
    assert value["objectives"][2] == {
        "name": "clean cup in the cupboard",
        "goal": "(and (is-clean cup) (in cup cupboard))",
        "met": True,
        "feasible": True,
    }
    text = command("score", path).out
    assert "Feasibility: 4 of 4 objectives could be met" in text
    assert "2 human actions at the least for all objectives, the same." in " ".join(text.split())


def test_a_run_that_is_refused_leaves_no_log(command: Command, tmp_path: Path) -> None:
    empty = tmp_path / "empty.polaris.json"
    start = {"id": "c0", "name": "start", "goals": []}
    program = {"schema": "polaris-program/1", "domain": "caregiving", "world": "care-home",
               "checkpoints": [start], "transitions": []}  # fmt: skip
    empty.write_text(json.dumps(program))
    log = tmp_path / "none.mcap"
    refused = command("run", empty, "--log", log)
    assert (refused.code, log.exists()) == (1, False)
    assert "nothing to run" in one_sentence(refused.err)


def test_score_of_a_log_counts_what_its_run_met(command: Command, tmp_path: Path) -> None:
    path, log = tmp_path / "t.json", tmp_path / "t.mcap"
    for sentence in TIDY:
        command("say", "--world", "dinner-party", "--program", path, sentence)
    command("run", path, "--people", "none", "--log", log)
    path.unlink()  # The log says all of it.
    result = command("score", "--json", log)
    value = result.json
    assert (result.code, value["met"], value["feasibility"], value["human_effort"]) == (1, 0, 4, 2)
    assert (value["outcome"], value["log"]) == ("halted", str(log))
    assert "Runtime: 0 of 4 were met in the run of t.mcap." in command("score", log).out
    bad = tmp_path / "no.mcap"
    bad.write_bytes(b"no log")
    assert command("score", bad).code == 1


def test_transcribe(command: Command, tmp_path: Path) -> None:
    from polaris_nl.model.data import data_folder

    recordings = sorted((data_folder("domains") / "caregiving/recordings").glob("*.flac"))
    result = command("transcribe", "--json", "--world", "care-home", *recordings)
    assert result.code == 0
    assert [Path(v["file"]).name for v in result.lines] == [p.name for p in recordings]
    for value in result.lines:
        assert set(value) == {*ANSWER, "file", "heard", "accepted", "audio_s"}
        assert value["accepted"]
        assert names(value["program"]) == ["start", "alerted", "fetched", "home", "cancelled"]


def test_listen_to_a_recording(command: Command, tmp_path: Path) -> None:
    from polaris_nl.model.data import data_folder

    recording = data_folder("domains") / "caregiving/recordings/lunch.flac"
    path = tmp_path / "p.json"
    result = command(
        "listen", "--json", "--world", "care-home", "--program", path, "--mic", recording
    )
    assert result.code == 0
    assert [v["outcome"] for v in result.lines] == ["applied"] * 3
    assert names(json.loads(path.read_text())) == [
        "start",
        "alerted",
        "fetched",
        "home",
        "cancelled",
    ]


def test_a_program_in_a_world_of_ones_own(command: Command, tmp_path: Path) -> None:
    from polaris_nl.model.data import world_path

    text = world_path("care-home").read_text().replace("name: care-home", "name: my-home")
    (tmp_path / "mine.yaml").write_text(text.replace("map: care-home.map.yaml\n", ""))
    path = tmp_path / "p.json"
    assert command("say", "--world", tmp_path / "mine.yaml", "--program", path, "go home").code == 0
    assert command("plan", path).code == 0
    assert "belongs to the world my-home" in one_sentence(
        command("plan", path, "--world", "care-home").err
    )


def test_catalogue_check_doctor_and_models(command: Command, lunch: Path) -> None:
    assert [w["name"] for w in command("worlds", "--json").json] == ["care-home", "dinner-party"]
    assert [d["name"] for d in command("domains", "--json").json] == ["caregiving", "tidying"]
    assert "caregiving: " in command("domains").out
    root = Path(__file__).parents[2]
    files = [*root.glob("grammars/en/*.yaml"), *root.glob("domains/*/domain.pddl")]
    files += [p for p in root.glob("domains/*/worlds/*.yaml") if not p.name.endswith(".map.yaml")]
    result = command("check", *files, lunch)
    assert result.code == 0, result.err
    assert " ".join(result.out.split()).count("all right") == len(files) + 1
    assert command("doctor").code == 0
    assert command("models", "--json").json["fetched"] is False


def test_export(command: Command, lunch: Path) -> None:
    assert command("export", lunch).out.startswith("flowchart TD\n")
    dot = command("export", lunch, "--to", "dot").out
    assert dot.startswith("digraph")
    assert 'label="lunch is acknowledged"' in dot
    assert command("export", lunch, "--to", "isl").out.startswith("import pddl.caregiving\n")


def test_every_command_has_help_with_an_example(command: Command) -> None:
    commands = next(a for a in make_parser()._actions if a.dest == "command").choices
    assert commands is not None
    assert set(commands) == {
        "say", "dialogue", "plan", "why", "score", "run", "transcribe", "listen", "tui", "review", "domains",
        "worlds", "check", "doctor", "models", "demo", "import", "export", "durations", "stretch-sim",
    }  # fmt: skip
    for name in commands:
        shown = command(name, "--help")
        assert shown.code == 0
        assert f"example:\n  polaris-nl {name}" in shown.out


@pytest.mark.parametrize("arguments", [(), ("fly",), ("plan",), ("say", "--wrold", "x", "y")])
def test_wrong_usage_ends_with_2(command: Command, arguments: tuple[str, ...]) -> None:
    result = command(*arguments)
    assert result.code == 2
    one_sentence(result.err)
