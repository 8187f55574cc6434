"""The object that `plan --json` prints is a contract (DESIGN section 6)."""

from __future__ import annotations

import json
from typing import Any

import pytest

from polaris_nl.automaton.edit_json import edit_of
from polaris_nl.automaton.edits import apply_all
from polaris_nl.model.formula import parse_literal
from polaris_nl.planning.plan_json import plan_json
from polaris_nl.planning.planner import Planner

from .conftest import LUNCH, MakeWorld, balls_world, program

CAREGIVING = (
    LUNCH,
    "fetched [(acknowledged lunchtime)]: (holding tray) (is-full tray)",
    "home: (robot-at home)",
    "alerted -> cancelled [(dismissed lunchtime)]: (robot-at home)",
)
BROKEN = (
    "start -> both [(open fridge)]: (holding cup) (holding tray)",
    "next: (robot-at home)",
    "start -> told [(acknowledged bingo)]: (acknowledged lunchtime)",
    "start -> fine: (holding cup)",
    "wait [(holding cup)]: (robot-at hall)",
)
STATUS = {"ok", "partial", "underspecified", "invalid", "undecided"}
CAUSES = {
    "conflict",
    "unreachable",
    "invalid",
    "undecided",
    "inside",
    "underspecified",
    "structure",
}


def value_of(planner: Planner, *lines: str) -> dict[str, Any]:
    automaton = program(*lines)
    value = plan_json(planner.compile(automaton), automaton)
    check(value)
    # What is printed is what was meant: no tuple, no number for a key, nothing that JSON lacks.
    assert json.loads(json.dumps(value)) == value
    return value


def nodes(value: dict[str, Any]) -> list[dict[str, Any]]:
    found = [value["tree"]] if value["tree"] else []
    for node in found:
        found.extend(edge["node"] for edge in node["children"])
    return found


def check(value: dict[str, Any]) -> None:
    """The fields of the contract and their types, no more and no fewer."""
    assert set(value) == {
        "status",
        "ms",
        "segments",
        "branches",
        "tree",
        "problems",
        "warnings",
    }
    assert value["status"] in STATUS
    assert isinstance(value["ms"], int)
    for segment in value["segments"]:
        assert set(segment) == {"transition", "from", "to", "when", "optimal", "actions"}
        assert isinstance(segment["optimal"], bool)
        check_facts(segment["when"])
        check_facts(segment["actions"])
    for branch in value["branches"]:
        assert set(branch) == {"checkpoints", "actions"}
        assert isinstance(branch["actions"], int)
    for node in nodes(value):
        assert set(node) - {"checkpoint"} == {"id", "action", "added", "removed", "children"}
        assert node["action"] is None or node["action"].startswith("(")
        check_facts(node["added"])
        check_facts(node["removed"])
        for edge in node["children"]:
            assert set(edge) == {"transition", "when", "node"}
            check_facts(edge["when"])
    for problem in value["problems"]:
        assert set(problem) == {"checkpoint", "transition", "cause", "text", "cores", "repairs"}
        assert problem["cause"] in CAUSES
        assert problem["text"].endswith((".", "?"))
        for core in problem["cores"]:
            check_facts(core)
        for repair in problem["repairs"]:
            assert set(repair) == {"text", "edits"}
    for warning in value["warnings"]:
        assert set(warning) == {"transition", "text"}


def check_facts(texts: object) -> None:
    assert isinstance(texts, list)
    for text in texts:
        assert str(parse_literal(text)) == text
        assert text == text.lower()


def test_segments_are_in_order_with_parents_before_children(care_home: Planner) -> None:
    value = value_of(care_home, *CAREGIVING)
    assert value["status"] == "ok"
    assert value["segments"][0] == {
        "transition": "t1",
        "from": "c0",
        "to": "c1",
        "when": [],
        "optimal": True,
        "actions": [
            "(move home hall)",
            "(move hall recreation-area)",
            "(alert resident lunchtime recreation-area)",
        ],
    }
    assert [(s["transition"], s["from"], s["to"], s["when"]) for s in value["segments"]] == [
        ("t1", "c0", "c1", []),
        ("t2", "c1", "c2", ["(acknowledged lunchtime)"]),
        ("t3", "c2", "c3", []),
        ("t4", "c1", "c4", ["(dismissed lunchtime)"]),
    ]


def test_branches_lead_to_the_leaves_and_count_their_actions(care_home: Planner) -> None:
    value = value_of(care_home, *CAREGIVING)
    assert value["branches"] == [
        {"checkpoints": ["c0", "c1", "c2", "c3"], "actions": 9},
        {"checkpoints": ["c0", "c1", "c4"], "actions": 5},
    ]


def test_the_tree_holds_every_action_once_and_every_checkpoint_once(care_home: Planner) -> None:
    value = value_of(care_home, *CAREGIVING)
    tree = nodes(value)
    root = tree[0]
    assert (root["id"], root["action"], root["checkpoint"]) == ("a0", None, "c0")
    assert (root["added"], root["removed"]) == ([], [])
    assert len({n["id"] for n in tree}) == len(tree)
    assert {n["id"] for n in tree} == {f"a{number}" for number in range(len(tree))}
    reached = [n["checkpoint"] for n in tree if "checkpoint" in n]
    assert sorted(reached) == ["c0", "c1", "c2", "c3", "c4"]
    in_segments = [a for s in value["segments"] for a in s["actions"]]
    assert sorted(n["action"] for n in tree[1:]) == sorted(in_segments)


def test_an_edge_names_its_transition_where_a_segment_begins(care_home: Planner) -> None:
    value = value_of(care_home, *CAREGIVING)
    (first,) = value["tree"]["children"]
    assert (first["transition"], first["when"]) == ("t1", [])
    assert (first["node"]["id"], first["node"]["action"]) == ("a1", "(move home hall)")
    assert first["node"]["added"] == ["(robot-at hall)"]
    assert first["node"]["removed"] == ["(robot-at home)"]
    (second,) = first["node"]["children"]
    assert (second["transition"], second["when"]) == (None, [])
    alerted = next(n for n in nodes(value) if n.get("checkpoint") == "c1")
    assert [(e["transition"], e["when"]) for e in alerted["children"]] == [
        ("t2", ["(acknowledged lunchtime)"]),
        ("t4", ["(dismissed lunchtime)"]),
    ]
    assert "(acknowledged lunchtime)" in alerted["children"][0]["node"]["added"]


def test_a_checkpoint_that_costs_nothing_has_a_node_without_an_action(care_home: Planner) -> None:
    value = value_of(care_home, "here: (robot-at home)", "waited [(acknowledged lunchtime)]:")
    assert [(n["action"], n.get("checkpoint")) for n in nodes(value)] == [
        (None, "c0"),
        (None, "c1"),
        (None, "c2"),
    ]
    assert value["branches"] == [{"checkpoints": ["c0", "c1", "c2"], "actions": 0}]
    assert [s["actions"] for s in value["segments"]] == [[], []]


def test_an_empty_program_is_a_plan_of_nothing(care_home: Planner) -> None:
    value = value_of(care_home)
    assert value["status"] == "ok"
    assert value["tree"]["checkpoint"] == "c0"
    assert value["tree"]["children"] == []
    assert value["branches"] == [{"checkpoints": ["c0"], "actions": 0}]


def test_problems_carry_cores_and_ways_out(care_home: Planner) -> None:
    value = value_of(care_home, *BROKEN)
    assert value["status"] == "partial"
    found = {p["checkpoint"]: p for p in value["problems"]}
    assert {k: (p["cause"], p["transition"]) for k, p in found.items()} == {
        "c1": ("conflict", "t1"),
        "c2": ("inside", "t2"),
        "c3": ("unreachable", "t3"),
    }
    assert found["c1"]["cores"] == [["(holding cup)", "(holding tray)"]]
    assert found["c2"]["cores"] == []
    assert found["c2"]["repairs"] == []
    assert [w["transition"] for w in value["warnings"]] == ["t5"]
    assert value["branches"] == [{"checkpoints": ["c0", "c4", "c5"], "actions": 4}]
    assert {s["to"] for s in value["segments"]} == {"c4", "c5"}


def test_the_edits_of_a_way_out_can_be_sent_back(care_home: Planner) -> None:
    automaton = program(*BROKEN)
    for problem in value_of(care_home, *BROKEN)["problems"]:
        for repair in problem["repairs"]:
            edits = [edit_of(json.loads(json.dumps(e))) for e in repair["edits"]]
            mended = care_home.compile(apply_all(automaton, edits))
            assert problem["checkpoint"] in mended.segments
    assert sum(len(p["repairs"]) for p in value_of(care_home, *BROKEN)["problems"]) >= 3


@pytest.mark.parametrize(
    ("lines", "status", "cause", "place"),
    [
        (("a:", "start -> b:"), "underspecified", "underspecified", ("c2", "t2")),
        (("a: (holding cpu)",), "invalid", "invalid", ("c1", None)),
        (("a [(acknowledged lunch)]:",), "invalid", "invalid", (None, "t1")),
        (("a [(open fridge)]:", "start -> a:"), "invalid", "structure", (None, None)),
    ],
)
def test_a_program_that_does_not_compile_has_no_tree(
    care_home: Planner,
    lines: tuple[str, ...],
    status: str,
    cause: str,
    place: tuple[str | None, str | None],
) -> None:
    value = value_of(care_home, *lines)
    assert (value["status"], value["tree"]) == (status, None)
    assert (value["segments"], value["branches"]) == ([], [])
    (problem,) = value["problems"]
    assert (problem["cause"], (problem["checkpoint"], problem["transition"])) == (cause, place)


def test_a_stale_compile_is_undecided(care_home: Planner) -> None:
    automaton = program(*CAREGIVING)
    value = plan_json(care_home.compile(automaton, lambda: True), automaton)
    check(value)
    assert (value["status"], value["problems"], value["segments"]) == ("undecided", [], [])


def test_the_value_of_a_branch_of_thousands_of_actions_is_made(make_world: MakeWorld) -> None:
    lines = [f"s{n}: ({'held' if n % 2 else 'on-floor'} b0)" for n in range(3000)]
    automaton = program(*lines)
    value = plan_json(Planner(balls_world(make_world, 1)).compile(automaton), automaton)
    assert value["branches"][0]["actions"] == 2999
    assert len(nodes(value)) == 3001


def test_a_program_of_sixty_checkpoints_can_be_printed(care_home: Planner) -> None:
    places = ["worktop", "desk"]
    value = value_of(care_home, *(f"s{n}: (at cup {places[n % 2]})" for n in range(61)))
    assert value["status"] == "ok"
    assert value["branches"][0]["actions"] > 200
