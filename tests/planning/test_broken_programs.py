"""Broken programs: the right cause, all conflicting sets, tried ways out, and words that read well.

The programs are in `broken/*.yaml`, their texts in `tests/golden/planning/broken_programs.txt`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edit_json import edit_json, edit_of
from polaris_nl.automaton.edits import apply_all
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.world_file import load_world, read_world
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan, Problem
from polaris_nl.planning.segments import SegmentResult, Segments
from tests.golden.files import check_golden

from .conftest import core_texts, facts, program

FOLDER = Path(__file__).parent / "broken"
SOLVER_WORDS = ("unsolvable", "mutex", "core", "literal", "precondition", "solver", "axiom")
"""Words of the trade, which a carer never hears."""


@dataclass(frozen=True)
class Broken:
    """One broken program, and what has to be found out about it."""

    name: str
    world: str
    program: tuple[str, ...]
    wanted: dict[str, Any]


def _read() -> list[Broken]:
    found = []
    for path in sorted(FOLDER.glob("*.yaml")):
        value = yaml.safe_load(path.read_text(encoding="utf-8"))
        for case in value["programs"]:
            name, lines = case.pop("name"), tuple(case.pop("program"))
            found.append(Broken(name, value["world"], lines, case))
    return found


BROKEN = _read()
each = pytest.mark.parametrize("broken", BROKEN, ids=lambda b: b.name)


@cache
def planner_of(world: str) -> Planner:
    """A planner that speaks as the session's does."""
    known = load_world(world) if world in shipped_worlds() else read_world(FOLDER / world)
    return Planner(known, Understanding(known).wording)


def compiled(
    broken: Broken, automaton: Automaton, monkeypatch: pytest.MonkeyPatch
) -> BranchingPlan:
    """The plan of a program, where sets of more goals than the case says are too hard to decide."""
    planner, limit = planner_of(broken.world), broken.wanted.get("too_hard_above")
    if limit is not None:
        solve = Segments.solve

        def hard(self: Segments, state: Any, goals: Sequence[Any], *rest: Any, **more: Any) -> Any:
            if len(goals) > limit:
                reason = "No plan was found in 5 seconds, and none was ruled out."
                return SegmentResult("undecided", reason=reason)
            return solve(self, state, goals, *rest, **more)

        monkeypatch.setattr(Segments, "solve", hard)
        planner = Planner(planner.world, planner.wording)
    plan = planner.compile(automaton)
    monkeypatch.undo()
    return plan


def problem_of(broken: Broken, plan: BranchingPlan) -> Problem:
    """The problem at the checkpoint that the case names."""
    (found,) = [p for p in plan.problems if p.cause != "inside"]
    assert found.checkpoint == broken.wanted["at"]
    return found


def test_there_are_enough_of_all_sorts() -> None:
    assert len(BROKEN) >= 40
    assert {b.wanted["cause"] for b in BROKEN} == {
        "conflict",
        "unreachable",
        "invalid",
        "undecided",
        "underspecified",
    }
    sizes = {len(facts(c)) for b in BROKEN if b.wanted["cores"] != "any" for c in b.wanted["cores"]}
    assert sizes == {1, 2, 3}
    kinds = {b.wanted["repair"] for b in BROKEN}
    assert kinds == {"split", "drop", "wait", "reorder", "change", "condition"}


@each
def test_the_cause_the_conflicts_and_the_way_out(
    broken: Broken, monkeypatch: pytest.MonkeyPatch
) -> None:
    automaton = program(*broken.program)
    problem = problem_of(broken, compiled(broken, automaton, monkeypatch))
    assert problem.cause == broken.wanted["cause"], problem.text
    if broken.wanted["cores"] != "any":
        wanted = {frozenset(map(str, facts(core))) for core in broken.wanted["cores"]}
        assert core_texts(problem) == wanted
    assert [r.kind for r in problem.repairs][:1] == [broken.wanted["repair"]], [
        r.text for r in problem.repairs
    ]
    for words in broken.wanted.get("says", ()):
        assert words in problem.text
    assert [str(x) for x in problem.start] == [
        str(x) for x in facts(broken.wanted.get("start", str(" ".join(map(str, problem.start)))))
    ]


@each
def test_every_way_out_leads_out(broken: Broken, monkeypatch: pytest.MonkeyPatch) -> None:
    automaton = program(*broken.program)
    before = compiled(broken, automaton, monkeypatch)
    problem = problem_of(broken, before)
    for repair in problem.repairs:
        edits = [edit_of(edit_json(edit)) for edit in repair.edits]
        after = compiled(broken, apply_all(automaton, edits), monkeypatch)
        assert after.status == "ok", repair.text
        assert set(before.segments) <= set(after.segments)


@each
def test_what_is_said_is_for_people(broken: Broken, monkeypatch: pytest.MonkeyPatch) -> None:
    problem = problem_of(broken, compiled(broken, program(*broken.program), monkeypatch))
    said = [problem.text, *(r.text for r in problem.repairs)]
    for text in said:
        assert not any(word in text.lower() for word in SOLVER_WORDS), text
        assert "?d" not in text
    assert problem.text.endswith((".", "?"))
    if problem.cause in ("conflict", "unreachable"):
        assert problem.text.startswith("I can't do \"")


def test_the_texts_are_as_they_were_read(monkeypatch: pytest.MonkeyPatch) -> None:
    lines: list[str] = []
    for broken in BROKEN:
        plan = compiled(broken, program(*broken.program), monkeypatch)
        problem = problem_of(broken, plan)
        lines += [f"{broken.name} ({broken.world})", *(f"    {x}" for x in broken.program)]
        lines += [problem.text, *(f"  - {r.kind}: {r.text}" for r in problem.repairs)]
        lines += [*(f"  note: {w.text}" for w in plan.warnings), ""]
    check_golden("planning/broken_programs.txt", "\n".join(lines))
