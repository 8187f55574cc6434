"""`import`, `export` and PDDL files on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.wording import PlainWording
from polaris_nl.model.world_file import load_world
from polaris_nl.render.graphs import dot, mermaid
from tests.cli.conftest import Command, one_sentence
from tests.planning.test_pddl_shapes import OFFICE, STAFF, UNTYPED

VISIT = """import pddl.office
labels
    served: [predicate: carries, params: [ann, cup]],
    come: [predicate: agent_at, params: [ann, desk]]
endlabels
module
    st: [0: init, 1: served];
    guard: [0: come];
    [] 0 & guard=0 -> 1;
endmodule
"""


def test_lunch_goes_to_isl_and_comes_back(command: Command, lunch: Path, tmp_path: Path) -> None:
    isl, back = tmp_path / "lunch.isl", tmp_path / "back.json"
    isl.write_text(command("export", lunch, "--to", "isl").out, encoding="utf-8")
    assert " ".join(command("check", isl).out.split()).endswith("all right.")
    result = command("import", isl, "--program", back)
    assert (result.code, result.err) == (0, "")
    assert "polaris-nl plan back.json" in result.out
    assert json.loads(back.read_text()) == json.loads(lunch.read_text())
    assert "is there already" in one_sentence(command("import", isl, "--program", back).err)
    value = command("import", "--json", isl).json
    assert value["program"] == json.loads(lunch.read_text())
    assert set(value["properties"].values()) == {True}
    assert value["against"] == {}
    assert json.loads(command("import", isl).out) == value["program"]


def test_a_problem_and_isl_with_their_conventions(command: Command, tmp_path: Path) -> None:
    (tmp_path / "office.pddl").write_text(OFFICE, encoding="utf-8")
    (tmp_path / "floor.pddl").write_text(STAFF, encoding="utf-8")
    (tmp_path / "visit.isl").write_text(VISIT, encoding="utf-8")
    checked = command("check", "office.pddl", "floor.pddl").out
    assert "type robot can be commanded and type person can't" in " ".join(checked.split())
    assert "floor.pddl: a problem, usable as a world" in checked
    one_sentence(command("import", "visit.isl").err)  # No world of that domain is shipped.
    result = command("import", "visit.isl", "--world", "floor.pddl", "--program", "v.json")
    assert result.code == 0
    assert "note: Type robot can be commanded, and type person can't." in result.err
    plan = command("plan", "v.json", "--json").json  # Its world is found beside it.
    assert plan["segments"][0]["actions"] == [
        "(move_to stretch hall desk)", "(pick_up stretch cup desk)", "(give stretch ann cup desk)",
    ]  # fmt: skip
    said = command("say", "--json", "--world", "floor.pddl", "have the cup at the hall").json
    assert said["outcome"] in ("applied", "question", "refused")


def test_faults_are_named_by_file_and_line(command: Command, tmp_path: Path) -> None:
    (tmp_path / "office.pddl").write_text(OFFICE, encoding="utf-8")
    (tmp_path / "floor.pddl").write_text(STAFF, encoding="utf-8")
    path = tmp_path / "visit.isl"
    path.write_text(VISIT.replace("carries", "carry").replace("desk]", "dek]"), encoding="utf-8")
    result = command("import", path, "--world", "floor.pddl", "--program", "v.json")
    assert result.code == 1
    first, second = result.err.splitlines()
    assert first.startswith(f"polaris-nl: {path}, line 3: In the label served: ")
    assert "Did you mean carries?" in first
    assert "line 4" in second
    assert not (tmp_path / "v.json").exists()
    assert len(command("import", "--json", path, "--world", "floor.pddl").json["faults"]) == 2
    path.write_text(VISIT.replace("0: init", "0 init"), encoding="utf-8")
    assert f"{path}, line 7: " in one_sentence(command("import", path).err)


def test_a_loop_is_read_and_named(command: Command, lunch: Path, tmp_path: Path) -> None:
    text = command("export", lunch, "--to", "isl").out.replace(
        "endmodule", "    [] 2 -> 1;\nendmodule"
    )
    path = tmp_path / "loop.isl"
    path.write_text(text, encoding="utf-8")
    result = command("import", path)
    assert result.code == 1
    assert 'not loop-free: "alerted" and "fetched" come after one another in a loop.' in result.err
    assert "to be mended: " in result.err
    assert len(json.loads(result.out)["transitions"]) == 5
    value = command("import", "--json", path).json
    assert value["properties"]["loop_free"] is False
    assert value["problems"]


def test_what_isl_cannot_say_is_named(command: Command, tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    goal = "(forall (?d - object) (imply (kind ?d dish) (at ?d countertop)))"
    value = {
        "schema": "polaris-program/1", "domain": "tidying", "world": "dinner-party",
        "checkpoints": [{"id": "c0", "name": "start", "goals": []},
                        {"id": "c1", "name": "all", "goals": [goal]}],
        "transitions": [{"id": "t1", "from": "c0", "to": "c1", "when": []}],
    }  # fmt: skip
    path.write_text(json.dumps(value), encoding="utf-8")
    result = command("export", path, "--to", "isl")
    assert (result.code, result.out) == (1, "")
    assert goal in one_sentence(result.err)
    assert command("export", "--json", path, "--to", "isl").json["missing"]


def test_score_counts_a_problems_goal(command: Command, tmp_path: Path) -> None:
    (tmp_path / "stacks.pddl").write_text(UNTYPED[0], encoding="utf-8")
    (tmp_path / "tower.pddl").write_text(UNTYPED[1], encoding="utf-8")
    value = {
        "schema": "polaris-program/1", "domain": "stacks", "world": "tower",
        "checkpoints": [{"id": "c0", "name": "start", "goals": []},
                        {"id": "c1", "name": "low", "goals": ["(on b c)"]}],
        "transitions": [{"id": "t1", "from": "c0", "to": "c1", "when": []}],
    }  # fmt: skip
    (tmp_path / "p.json").write_text(json.dumps(value), encoding="utf-8")
    found = command("score", "--json", "p.json").json
    assert (found["met"], found["of"], found["feasibility"], found["human_effort"]) == (
        1,
        2,
        1,
        None,
    )


HOSTILE = '"]; drop # <b>&\\ `x`\n\x1b[31m'


@pytest.mark.parametrize("draw", [mermaid, dot])
def test_drawings_escape_what_they_cannot_take(draw: object) -> None:
    world = load_world("care-home")
    automaton = (
        Automaton()
        .with_checkpoint(Checkpoint("end", HOSTILE, (parse_literal("(robot-at home)"),)))
        .with_checkpoint(Checkpoint("c2", "plain"))
        .with_transition(Transition("t1", START, "end"))
        .with_transition(Transition("t2", "end", "c2", on="failure"))
    )
    text = draw(automaton, PlainWording(world))
    assert "\x1b" not in text
    lines = text.splitlines()
    if draw is mermaid:
        assert lines == [
            "flowchart TD",
            '  c0(["start"])',
            '  n1["#34;]; drop #35; #60;b#62;#38;#92; #96;x#96; [31m<br/>make sure that robot at the home"]',
            '  c2["plain"]',
            "  c0 --> n1",
            '  n1 -->|"it can\'t be done"| c2',
        ]  # fmt: skip
    else:
        assert lines[3] == (
            '  n1 [label="\\"]; drop # <b>&\\\\ `x` [31m\\nmake sure that robot at the home"];'
        )
        assert lines[6] == '  n1 -> c2 [label="it can\'t be done"];'
