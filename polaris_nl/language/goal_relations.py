"""How goals relate: which are steps of their own, and which say what others were only the way to."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.language.structure import Step
from polaris_nl.model.formula import Formula, Goal, Literal

SEPARATE = ("robot-at", "alerted-to", "person-in", "holding", "has")
"""Goals that are steps of their own when joined by "and": where the robot is, and what happens to people."""
ONE_AT_A_TIME = ("robot-at",)
"""Goals of which one rules the next out: "go to the kitchen and the office" is a sequence."""
SOUGHT = ("found",)
"""Goals after which "it should be on the desk" is a hint."""


def one_at_a_time(goals: Sequence[Goal]) -> bool:
    """Whether each of some goals rules the others out, so that they are a sequence."""
    return all(
        isinstance(g, Literal) and g.positive and g.predicate in ONE_AT_A_TIME for g in goals
    )


def superseded(step: Step, goals: Sequence[Goal]) -> bool:
    """Whether goals say what a step was only the way to, or what is wanted in its place.

    "Don't go to the kitchen, go to the laundry" asks for one thing; "get the cup and take it to the
    desk", "take it off the table and put it in the sink" are about where the cup ends up.
    """
    old, new = flat(step.goals), flat(goals)
    if step.when or step.role != "then" or len(old) != len(step.goals) or not old or not new:
        return False
    if step.forbidden:
        denied = flat(step.forbidden)
        return all(
            n.positive and n.predicate == d.predicate and n.args != d.args
            for d in denied
            for n in new
        )
    moved = {thing_placed(n) for n in new if n.positive and says_a_place(n)}
    taken = [o for o in old if o.predicate == "holding" or says_a_place(o)]
    return len(taken) == len(old) and all(thing_placed(o) in moved for o in taken)


def says_a_place(literal: Literal) -> bool:
    """Whether a literal says where a thing is."""
    return literal.predicate in ("at", "in", "has") and len(literal.args) == 2


def thing_placed(literal: Literal) -> str:
    """The thing whose place a literal says."""
    return literal.args[-1 if literal.predicate == "has" else 0]


def flat(goals: Sequence[Formula]) -> tuple[Literal, ...]:
    """The goals that are literals."""
    return tuple(goal for goal in goals if isinstance(goal, Literal))
