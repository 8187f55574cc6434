"""The dialogues are as they should be, and the reader plays them; it is not said here how well they go."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.model.formula import parse_formula, parse_literal

from .dialogues_reader import (
    FOLDERS,
    FORMS,
    all_dialogues,
    dialogues_of,
    in_form,
    play,
    program_faults,
)

GO_HOME = """
- name: go home
  world: care-home
  turns:
    - say: Go home.
      expect: applied
      checkpoints: [["(robot-at home)"]]
      transitions: [{from: start, to: ["(robot-at home)"]}]
    - say: Undo.
      expect: command
      command: undo
      checkpoints: []
      transitions: []
- name: nothing to undo
  world: dinner-party
  turns:
    - {say: Undo., expect: command, command: undo, unchanged: true, says: [nothing]}
"""


@pytest.mark.parametrize("folder", FOLDERS)
def test_the_dialogues_are_as_they_should_be(folder: str) -> None:
    dialogues = all_dialogues(folder)
    assert dialogues
    assert len({d.name for d in dialogues}) == len(dialogues)
    assert all(3 <= len(d.turns) <= 10 for d in dialogues)


def test_no_dialogue_is_in_both_folders() -> None:
    shown, held_out = (
        {tuple(t.say for t in d.turns) for d in all_dialogues(folder)} for folder in FOLDERS
    )
    assert not shown & held_out


@pytest.mark.parametrize("form", FORMS)
def test_dialogues_are_played(form: str) -> None:
    for dialogue in dialogues_of(yaml.safe_load(GO_HOME)):
        assert [turn.differences for turn in play(dialogue, form)] == [()] * len(dialogue.turns)


def test_it_says_what_differs() -> None:
    items = yaml.safe_load(GO_HOME)[:1]
    turns = items[0]["turns"]
    turns[0]["checkpoints"] = [["(robot-at office)"]]
    turns[0]["transitions"] = [{"from": "start", "to": ["(robot-at office)"]}]
    turns[1] |= {"command": "redo", "unchanged": True, "says": ["nonsense"]}
    del turns[1]["checkpoints"], turns[1]["transitions"]
    first, second = play(dialogues_of(items)[0])
    assert not first.ok
    assert "(robot-at office)" in first.differences[0]
    assert [text.split()[0] for text in second.differences] == ["command", "the", "the"]


def test_one_of_several_programs_will_do() -> None:
    items = yaml.safe_load(GO_HOME)[:1]
    turn = items[0]["turns"][0]
    right = {key: turn.pop(key) for key in ("checkpoints", "transitions")}
    turn["either"] = [{"unchanged": True}, right]
    assert play(dialogues_of(items)[0])[0].ok
    turn["either"] = [{"unchanged": True}]
    assert not play(dialogues_of(items)[0])[0].ok
    turn["expect"] = ["applied", "question"]
    turn["either"] = [{"expect": "question", "unchanged": True}, {"expect": "applied", **right}]
    assert play(dialogues_of(items)[0])[0].ok


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"wants": 1}, "unknown fields wants"),
        ({"say": ""}, "what is said"),
        ({"expect": "done"}, "expect is one"),
        ({"command": "run"}, "expects a command"),
        ({"options": ["cup"]}, "only a question"),
        ({"unchanged": True}, "unchanged is true"),
        ({"transitions": []}, "one transition leads"),
        ({"checkpoints": [["(robot-at desk)"]]}, "there is no checkpoint"),
        ({"either": []}, "either several programs"),
    ],
)
def test_what_is_wrong_is_named(change: dict[str, Any], fault: str) -> None:
    items = yaml.safe_load(GO_HOME)
    items[0]["turns"][0] |= change
    with pytest.raises(ValueError, match=fault):
        dialogues_of(items, "inline")


@pytest.mark.parametrize(
    "goal", ["(robot-at desk)", "(robot-on home)", "(robot-at <1>)", "(robot-at"]
)
def test_literals_are_checked_against_the_world(goal: str) -> None:
    items = yaml.safe_load(GO_HOME)
    items[0]["turns"][0] |= {
        "checkpoints": [[goal]],
        "transitions": [{"from": "start", "to": [goal]}],
    }
    with pytest.raises(ValueError, match="go home"):
        dialogues_of(items, "inline")


def program_of(*steps: tuple[str, str, str]) -> Automaton:
    """A chain of steps, each with a name, a conditional or "", and a goal."""
    program = Automaton()
    checkpoints, transitions, last = dict(program.checkpoints), {}, next(iter(program.checkpoints))
    for number, (name, when, goal) in enumerate(steps, 1):
        checkpoints[f"c{number}"] = Checkpoint(f"c{number}", name, (parse_formula(goal),))
        literals = (parse_literal(when),) if when else ()
        transitions[f"t{number}"] = Transition(f"t{number}", last, f"c{number}", literals)
        last = f"c{number}"
    return Automaton(checkpoints, transitions)


SUPPER = program_of(
    ("supper", "", "(at green-bowl sink)"),
    ("home", "(open fridge)", "(robot-at home)"),
)
SUPPER_WANTED: dict[str, Any] = {
    "checkpoints": [["(robot-at home)"], {"name": "supper", "goals": ["(at <2> sink)"]}],
    "transitions": [
        {"from": "supper", "to": ["(robot-at home)"], "when": ["(open fridge)"]},
        {"from": "start", "to": "supper"},
    ],
}


def faults(wanted: dict[str, Any], after: Automaton, *options: str) -> list[str]:
    return list(program_faults(wanted, after, Automaton(), options))


def test_a_program_is_compared_by_goals_names_and_options() -> None:
    assert not faults(SUPPER_WANTED, SUPPER, "white bowl", "green bowl")
    assert faults(SUPPER_WANTED, SUPPER, "green bowl", "white bowl")
    assert faults(SUPPER_WANTED, Automaton(), "white bowl", "green bowl")
    assert faults({"unchanged": True}, SUPPER)
    assert faults({"checkpoints": [], "transitions": []}, SUPPER)
    unconditional = [
        {"from": "supper", "to": ["(robot-at home)"]},
        *SUPPER_WANTED["transitions"][1:],
    ]
    other = {**SUPPER_WANTED, "transitions": unconditional}
    assert faults(other, SUPPER, "white bowl", "green bowl")


def test_the_names_of_variables_do_not_matter() -> None:
    goal = "(forall (?d - object) (imply (kind ?d dish) (at ?d sink)))"
    other = goal.replace("?d", "?x")
    wanted = {"checkpoints": [[other]], "transitions": [{"from": "start", "to": [other]}]}
    assert not faults(wanted, program_of(("fetched", "", goal)))


def test_digits_are_spoken_as_words() -> None:
    assert in_form("Go to room 2.", "typed") == "Go to room 2."
    assert in_form("Go to room 2.", "spoken") == "go to room two"
    assert in_form("2", "spoken") == "two"


def test_the_folders_are_there() -> None:
    assert all((Path(__file__).parent / folder).is_dir() for folder in FOLDERS)
