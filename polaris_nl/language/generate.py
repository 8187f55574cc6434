"""Says programs and edits back in plain English that can be said in again."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.narration import narrated
from polaris_nl.language.structure import Step
from polaris_nl.language.telling import NOTHING, Teller, Told
from polaris_nl.language.wording import GrammarWording
from polaris_nl.model.formula import Goal, Literal

EMPTY = "The program is empty: say what the robot should achieve."


def read_back(program: Automaton, wording: GrammarWording) -> str:
    """A program in words, branch by branch."""
    return narrated(program, wording) or EMPTY


def steps_in_words(steps: Sequence[Step], wording: GrammarWording) -> str:
    """What was understood, in a sentence or a few."""
    teller = Teller(wording)
    addressees: dict[str, str] = {}
    refused: Step | None = None
    branched = False
    for step in steps:
        told = Told(step.goals, step.when, None, dict(addressees))
        if refused is not None:
            unless = Told(step.goals, refused.when, None, dict(addressees))
            teller.sentence("", "unless ", unless)
            refused = None
        elif step.when and not step.goals:
            following = steps[steps.index(step) + 1 :][:1]
            if following and following[0].role == "else":
                refused = step
            elif not step.sequel:
                teller.sentence("", "if " if branched else "once ", told)
            else:
                teller.sentence("", "wait until ", told, alone=True)
        elif step.when:
            opening = "if " if branched else "once "
            teller.sentence("", f"then {opening}" if branched and step.sequel else opening, told)
        elif step.role == "else":
            teller.sentence("", "otherwise ", told)
        else:
            teller.then(told)
        branched = branched or bool(step.when)
        for goal in step.goals:
            if isinstance(goal, Literal) and goal.predicate == "alerted-to" and goal.positive:
                addressees[goal.args[-1]] = goal.args[0]
    return teller.text


def goals_in_words(goals: Sequence[Goal], wording: GrammarWording) -> str:
    """Goals as an imperative: "fill the tray and bring it to the table"."""
    return wording.goals(goals) or NOTHING
