"""The suite's files are as they should be, and its reader judges as it says. The suite is not played here."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest

from polaris_nl.model.formula import parse_formula

from .phenomena_judging import judge, judge_all, tally
from .phenomena_reader import PhenomenonCase, all_phenomena, cases_in, world_of
from .phenomena_steps import normal, same

HOME = {"name": "home", "world": "care-home", "wordings": ["Go home."]}
TO_HOME = {**HOME, "checkpoints": [["(robot-at home)"]]}
ALL_DISHES = "(forall (?x - object) (imply (kind ?x dish) (at ?x countertop)))"
DIRTY = "(forall (?d - object) (imply (and (kind ?d dish) (not (is-clean ?d))) (at ?d sink)))"


def one(**item: Any) -> PhenomenonCase:
    (case,) = cases_in({"cases": [item]}, "inline")
    return case


def test_every_file_is_as_it_should_be() -> None:
    cases = all_phenomena()
    assert sum(len(case.wordings) for case in cases) >= 640
    assert {case.world for case in cases} == {"care-home", "dinner-party"}


def test_a_third_of_every_phenomenon_is_held_out() -> None:
    said = Counter((c.phenomenon, c.held_out) for c in all_phenomena() for _ in c.wordings)
    for phenomenon in {c.phenomenon for c in all_phenomena()}:
        held, shown = said[phenomenon, True], said[phenomenon, False]
        assert held + shown >= 20, phenomenon
        assert abs(held - (held + shown) / 3) < 1, phenomenon


@pytest.mark.parametrize(
    ("item", "fault"),
    [
        ({**TO_HOME, "say": "Go home."}, "unknown fields say"),
        ({**TO_HOME, "wordings": []}, "no wordings"),
        ({**TO_HOME, "world": "moon"}, "which world"),
        ({**TO_HOME, "expect": "perhaps"}, "expect is one of"),
        ({**TO_HOME, "forms": ["sung"]}, "forms are"),
        ({**TO_HOME, "options": ["one"]}, "options goes with question"),
        ({**TO_HOME, "expect": "refused"}, "a program goes with applied"),
        (HOME, "a program goes with applied"),
        ({**HOME, "checkpoints": [["(robot-at moon)"]]}, "nothing called moon"),
        ({**HOME, "checkpoints": [["(robot-at tray)"]]}, "tray is an object"),
        ({**HOME, "checkpoints": [["(is-clean tray)"]]}, "no predicate is-clean"),
        ({**HOME, "checkpoints": [["(hand-empty)"], ["(hand-empty)"]]}, "give them labels"),
        ({**TO_HOME, "transitions": []}, "no tree"),
        ({**TO_HOME, "transitions": [{"from": "start", "to": "moon"}]}, "no checkpoint moon"),
        (
            {**HOME, "expect": "answer", "query": {"kind": "where", "entity": "moon"}},
            "there is no moon",
        ),
    ],
)
def test_a_faulty_case_is_named(item: dict[str, Any], fault: str) -> None:
    with pytest.raises(ValueError, match=f"inline: home: .*{fault}"):
        one(**item)


def test_a_name_is_there_once() -> None:
    with pytest.raises(ValueError, match="a name of its own"):
        list(cases_in({"cases": [TO_HOME, TO_HOME]}, "inline"))


@pytest.mark.parametrize("form", ["typed", "spoken"])
@pytest.mark.parametrize(
    ("item", "verdict"),
    [
        (TO_HOME, "right"),
        ({**HOME, "checkpoints": [{"name": "home", "goals": ["(robot-at home)"]}]}, "right"),
        ({**HOME, "checkpoints": [{"name": "away", "goals": ["(robot-at home)"]}]}, "wrong"),
        ({**HOME, "checkpoints": [["(robot-at hall)"]]}, "wrong"),
        ({**HOME, "checkpoints": [["(robot-at home)"], ["(hand-empty)"]]}, "wrong"),
        ({**HOME, "expect": ["question", "refused"]}, "wrong"),
        ({**HOME, "wordings": ["Undo."], "expect": "command", "command": "undo"}, "right"),
        ({**HOME, "wordings": ["Undo."], "expect": "command", "command": "redo"}, "wrong"),
        ({**HOME, "wordings": ["Undo."], "expect": "refused"}, "wrong"),
        ({**TO_HOME, "wordings": ["Go to the bedroom."]}, "asked"),
        ({**TO_HOME, "wordings": ["Go to the moon."]}, "refused"),
        (
            {**HOME, "wordings": ["Go to the moon."], "expect": "refused", "unknown": ["moon"]},
            "right",
        ),
    ],
)
def test_a_wording_is_judged(item: dict[str, Any], verdict: str, form: str) -> None:
    found = judge(one(**item), item["wordings"][0], form)
    assert found.verdict == verdict, found.why


def test_the_options_of_a_question_are_compared_in_any_order() -> None:
    bedroom = {**HOME, "wordings": ["Go to the bedroom."], "expect": "question"}
    for options, verdict in ((["room 2", "room 1"], "right"), (["room 1", "office"], "asked")):
        case = one(**bedroom, options=options)
        assert judge(case, "Go to the bedroom.", "typed").verdict == verdict


def test_what_was_given_is_a_part_of_the_program() -> None:
    goals = [["(robot-at kitchen)"], ["(robot-at home)"]]
    case = one(**HOME, given=["Go to the kitchen."], checkpoints=goals)
    verdicts = list(judge_all([case]))
    assert [(v.form, v.verdict) for v in verdicts] == [("typed", "right"), ("spoken", "right")]
    assert tally(verdicts) == {"inline": Counter(right=2)}


def test_a_checkpoint_may_be_split_anywhere_but_in_order() -> None:
    goals = ["(is-full tray)", "(at tray table)", "(robot-at home)"]
    case = one(**HOME, checkpoints=[{"goals": goals, "may_split": True}])
    assert [len(list(chain(p[0]))) for p in case.programs] == [1, 2, 2, 3]
    in_turn = one(**HOME, checkpoints=[[goal] for goal in goals])
    reverse = one(**HOME, checkpoints=[[goal] for goal in reversed(goals)])
    assert any(same(p, in_turn.programs[0]) for p in case.programs)
    assert not any(same(p, reverse.programs[0]) for p in case.programs)


def test_branches_have_no_order_but_conditionals_count() -> None:
    def program(*ends: tuple[str, str]) -> Any:
        checkpoints = [{"label": g, "goals": [g]} for g, _ in ends]
        transitions = [{"from": "start", "to": g, "when": [w]} for g, w in ends]
        return one(**HOME, checkpoints=checkpoints, transitions=transitions).programs[0]

    one_way = program(("(robot-at hall)", "(open fridge)"), ("(hand-empty)", "(open cupboard)"))
    other = program(("(hand-empty)", "(open cupboard)"), ("(robot-at hall)", "(open fridge)"))
    crossed = program(("(robot-at hall)", "(open cupboard)"), ("(hand-empty)", "(open fridge)"))
    assert same(one_way, other)
    assert not same(one_way, crossed)


def test_for_all_is_its_members_one_by_one() -> None:
    world = world_of("dinner-party")
    ground = ["(at plate countertop)", "(at cup countertop)"]
    assert normal([parse_formula(ALL_DISHES)], world) == normal(map(parse_formula, ground), world)


def test_a_condition_that_depends_on_facts_stays() -> None:
    world = world_of("dinner-party")
    renamed = DIRTY.replace("?d", "?x").replace(
        "(kind ?x dish) (not (is-clean ?x))", "(not (is-clean ?x)) (kind ?x dish)"
    )
    assert normal([parse_formula(DIRTY)], world) == normal([parse_formula(renamed)], world)
    assert "(at cup sink)" not in normal([parse_formula(DIRTY)], world)


def chain(step: Any) -> Any:
    yield step
    for after in step.then:
        yield from chain(after)
