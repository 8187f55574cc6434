"""Plays every case below `cases/`; the README there says how to add one."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint

from .reader import Case, Talk, all_cases, play, play_before

CASES = [
    pytest.param(case, form, id=f"{stem}/{case.name} ({form})")
    for stem, case in all_cases()
    for form in case.forms
]


@pytest.mark.parametrize(("case", "form"), CASES)
def test_case(case: Case, form: str) -> None:
    check(case, form)


def check(case: Case, form: str) -> None:
    """Fails where a case in a form does not come out as it should."""
    talk = play(case, form)
    wanted = case.wanted
    last = talk.last
    assert last is not None
    heard = f"{last.utterance!r}: {last.say}"
    assert last.outcome == wanted["expect"], heard
    if wanted["expect"] == "applied":
        assert set(talk.outcomes) == {"applied"} or "program" not in wanted, talk.outcomes
    if "checkpoints" in wanted:
        check_checkpoints(talk.program, wanted["checkpoints"], talk)
    if "transitions" in wanted:
        check_transitions(talk.program, wanted["transitions"])
    if wanted["expect"] != "applied":
        assert last.partial or not last.edits, heard
        if "checkpoints" not in wanted:
            assert talk.program == play_before(case, form).program, heard
    assert last.partial == wanted.get("partial", False)
    check_answer(talk, wanted)


def check_answer(talk: Talk, wanted: dict[str, Any]) -> None:
    last = talk.last
    assert last is not None
    assert last.command == wanted.get("command"), last.say
    assert (last.question is not None) == (last.outcome == "question")
    assert (last.refusal is not None) == (last.outcome == "refused")
    if "options" in wanted:
        assert last.question is not None
        assert list(last.question.options) == wanted["options"], last.say
    if "unknown" in wanted:
        assert last.refusal is not None
        assert set(wanted["unknown"]) <= set(last.refusal.unknown), last.refusal
    if last.refusal is not None:
        assert last.refusal.reason
    for part in wanted.get("says", ()):
        assert part in last.say
    if "query" in wanted:
        assert last.query is not None, last.say
        for key, value in wanted["query"].items():
            check_query(talk, key, value)


def check_query(talk: Talk, key: str, value: Any) -> None:
    assert talk.last is not None
    query = talk.last.query
    if key == "when":
        assert {str(x) for x in query.when} == set(value)
    elif key == "literal":
        assert str(query.literal) == value
    elif key == "checkpoint":
        assert query.checkpoint is not None
        assert talk.program.checkpoints[query.checkpoint].name == value
    else:
        assert getattr(query, key) == value


def check_checkpoints(program: Automaton, wanted: list[Any], talk: Talk) -> None:
    """Every checkpoint but the start, each once, with its goals and, where it is given, its name."""
    there = [c for c in program.checkpoints.values() if c.id != START]
    found = sorted(sorted(goals_of(c)) for c in there)
    assert found == sorted(sorted(goals_wanted(w)) for w in wanted), talk.last
    for item in wanted:
        if isinstance(item, dict) and "name" in item:
            assert any(c.name == item["name"] and fits(c, item) for c in there), [
                (c.name, sorted(goals_of(c))) for c in there
            ]


def check_transitions(program: Automaton, wanted: list[dict[str, Any]]) -> None:
    """Every transition, each once: `from` and `to` are names or goals."""
    left = list(program.transitions.values())
    for item in wanted:
        for transition in left:
            if (
                fits(program.checkpoints[transition.source], item["from"])
                and fits(program.checkpoints[transition.target], item["to"])
                and {str(x) for x in transition.when} == set(item.get("when", ()))
            ):
                left.remove(transition)
                break
        else:
            pytest.fail(f"no transition {item}, but {list(described(program))}")
    assert not left, list(described(program))


def fits(checkpoint: Checkpoint, item: Any) -> bool:
    if isinstance(item, str):
        return checkpoint.name == item
    return goals_of(checkpoint) == goals_wanted(item)


def goals_of(checkpoint: Checkpoint) -> set[str]:
    return {str(goal) for goal in checkpoint.goals}


def goals_wanted(item: Any) -> set[str]:
    return set(item["goals"] if isinstance(item, dict) else item)


def described(program: Automaton) -> Iterable[str]:
    for t in program.transitions.values():
        ends = (program.checkpoints[t.source], program.checkpoints[t.target])
        one, two = (f"{c.name} {sorted(goals_of(c))}" for c in ends)
        yield f"{one} -> {two} when {sorted(map(str, t.when))}"
