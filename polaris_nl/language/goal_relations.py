"""How goals relate: which are steps of their own, and which say what others were only the way to."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.language.structure import Step
from polaris_nl.model.formula import Formula, Goal, Imply, Literal, Quantified

ROBOT_AT = "robot-at"
SEPARATE = (ROBOT_AT, "alerted-to", "person-in", "holding", "has")
"""Goals that are steps of their own when joined by "and": where the robot is, and what happens to people."""
ONE_AT_A_TIME = (ROBOT_AT,)
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


def placed_all(step: Step, goals: Sequence[Goal]) -> Goal | None:
    """What is wanted of all that was only to be picked up: "gather up the dishes and put them in the sink".

    Args:
        step: the step before.
        goals: where "it" or "them" should be, said of each thing or of the latest.

    Returns:
        The same of everything that the step is about; None where it isn't only to be picked up.
    """
    all_of_it = step.goals[0] if len(step.goals) == 1 else None
    if step.forbidden or not isinstance(all_of_it, Quantified):
        return None
    body, new = all_of_it.body, flat(goals)
    if not isinstance(body, Imply) or len(new) != len(goals) or not new:
        return None
    held = body.conclusion
    if not isinstance(held, Literal) or held.predicate != "holding" or not held.positive:
        return None
    every = {g.bind({thing_placed(g): held.args[0]}) for g in new if says_a_place(g) and g.positive}
    if len(every) != 1 or not all(says_a_place(g) for g in new):
        return None
    return Quantified("forall", all_of_it.variables, Imply(body.condition, every.pop()))


def says_a_place(literal: Literal) -> bool:
    """Whether a literal says where a thing is."""
    return literal.predicate in ("at", "in", "has") and len(literal.args) == 2


def thing_placed(literal: Literal) -> str:
    """The thing whose place a literal says."""
    return literal.args[-1 if literal.predicate == "has" else 0]


def flat(goals: Sequence[Formula]) -> tuple[Literal, ...]:
    """The goals that are literals."""
    return tuple(goal for goal in goals if isinstance(goal, Literal))
