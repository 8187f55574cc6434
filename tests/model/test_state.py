"""States, mutex groups, events and actions."""

from __future__ import annotations

import itertools

import pytest

from polaris_nl.model.domain import Action
from polaris_nl.model.errors import FormatError
from polaris_nl.model.evaluate import after, applicable, effects, holds
from polaris_nl.model.formula import Literal, parse_formula, parse_literal
from polaris_nl.model.goals import ground_goals
from polaris_nl.model.state import Mutexes, MutexGroup, State
from polaris_nl.model.world import World


def literals(*texts: str) -> tuple[Literal, ...]:
    return tuple(parse_literal(t) for t in texts)


def state(*texts: str) -> State:
    return State(frozenset(literals(*texts)))


MUTEXES = Mutexes(
    (
        MutexGroup(literals("(at ?o _)", "(in ?o _)", "(holding ?o)")),
        MutexGroup(literals("(hand-empty)", "(holding _)")),
        MutexGroup(literals("(acknowledged ?m)", "(dismissed ?m)")),
        MutexGroup(literals("(person-in ?p _)")),
    ),
    frozenset({"hand-empty"}),
)


@pytest.mark.parametrize(
    ("before", "event", "expected"),
    [
        (["(at cup table)"], ["(at cup rack)"], ["(at cup rack)"]),
        (["(holding cup)"], ["(at cup rack)"], ["(at cup rack)", "(hand-empty)"]),
        (["(hand-empty)", "(at cup table)"], ["(holding cup)"], ["(holding cup)"]),
        (
            ["(at cup table)", "(at plate table)"],
            ["(in cup box)"],
            ["(in cup box)", "(at plate table)"],
        ),
        (["(acknowledged lunch)"], ["(dismissed lunch)"], ["(dismissed lunch)"]),
        (
            ["(acknowledged lunch)"],
            ["(dismissed tea)"],
            ["(acknowledged lunch)", "(dismissed tea)"],
        ),
        (["(person-in ann hall)"], ["(person-in ann room)"], ["(person-in ann room)"]),
        (["(holding cup)"], ["(not (holding cup))"], ["(hand-empty)"]),
        (["(open box)"], ["(not (open box))"], []),
        (["(holding cup)"], ["(holding cup)"], ["(holding cup)"]),
        ([], [], []),
    ],
)
def test_an_event_displaces_what_it_excludes(
    before: list[str], event: list[str], expected: list[str]
) -> None:
    assert state(*before).after_event(literals(*event), MUTEXES) == state(*expected)


def test_two_atoms_exclude_each_other_only_within_one_instance_of_a_group() -> None:
    here, there, plate = literals("(at cup table)", "(at cup rack)", "(at plate rack)")
    assert MUTEXES.exclusive(here, there) is MUTEXES.groups[0]
    assert MUTEXES.exclusive(here, plate) is None
    assert MUTEXES.exclusive(here, here) is None


def test_differences_are_sorted() -> None:
    removed, added = state("(b)", "(a)").difference(state("(c)", "(a)", "(d)"))
    assert (removed, added) == (literals("(b)"), literals("(c)", "(d)"))


def test_actions_change_states_as_pddl_says(flat: World) -> None:
    pick = Action("pick", ("red-cup", "shelf", "kitchen"))
    operator = flat.domain.operators["pick"]
    assert applicable(pick, operator, flat.initial, flat)
    held = after(pick, operator, flat.initial, flat)
    assert parse_literal("(holding red-cup)") in held
    assert parse_literal("(hand-empty)") not in held
    assert not applicable(pick, operator, held, flat)
    drop = Action("drop-all", ("shelf",))
    dropped = after(drop, flat.domain.operators["drop-all"], held, flat)
    assert dropped == flat.initial


def test_an_effect_that_is_deleted_and_added_stays(flat: World) -> None:
    stay = Action("go", ("kitchen", "kitchen"))
    assert effects(stay, flat.domain.operators["go"], flat.initial, flat) == literals(
        "(robot-at kitchen)"
    )


@pytest.mark.parametrize(
    ("text", "true"),
    [
        ("(and (hand-empty) (not (holding red-cup)))", True),
        ("(or (holding plate) (holding red-cup))", False),
        ("(forall (?d - object) (kind ?d dish))", True),
        ("(exists (?d - object) (at ?d shelf))", True),
        ("(forall (?d - object) (imply (at ?d shelf) (= ?d red-cup)))", True),
        ("(not (exists (?d - object) (holding ?d)))", True),
    ],
)
def test_formulas_are_evaluated_in_the_closed_world(flat: World, text: str, true: bool) -> None:
    assert holds(parse_formula(text), flat.initial, flat) is true


def test_for_all_expands_over_the_entities_that_meet_its_condition(flat: World) -> None:
    goal = parse_formula(
        "(forall (?d - object) (imply (and (kind ?d dish) (at ?d shelf)) (holding ?d)))"
    )
    assert ground_goals((goal,), flat.initial, flat) == literals("(holding red-cup)")
    assert ground_goals((goal,), state(), flat) == ()


def test_an_alternative_is_no_goal(flat: World) -> None:
    with pytest.raises(FormatError, match="is no goal"):
        ground_goals((parse_formula("(or (a) (b))"),), flat.initial, flat)


def test_the_pairs_that_exclude_each_other_are_those_of_every_two() -> None:
    asked = literals(
        "(at a x)", "(at a y)", "(holding a)", "(at b x)", "(not (holding b))", "(holding c)",
        "(hand-empty)", "(person-in p x)", "(open x)", "(at a x)", "(person-in p y)", "(person-in q y)",
    )  # fmt: skip
    wanted = [
        (a, b)
        for a, b in itertools.combinations(asked, 2)
        if a.positive and b.positive and MUTEXES.exclusive(a, b)
    ]
    assert list(MUTEXES.pairs(asked)) == wanted
    assert len(wanted) > 8
