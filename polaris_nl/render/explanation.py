"""The plan in words: what the robot will do on each branch, and why not where it can't."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import zip_longest

from polaris_nl.automaton.automaton import START, Automaton, Transition
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.planning.reasons import Purpose, Reasons, Step
from polaris_nl.planning.result import BranchingPlan, Problem, Repair, Segment, Warning
from polaris_nl.render.layout import Row, wrapped

SPOKEN_ACTIONS = 8
"""Actions of a segment that are said one by one; more are summed up."""
SPOKEN_PURPOSES = 4
"""Actions that an action is for, said one by one; of more, the first ones and the last."""


def branches_in_words(
    automaton: Automaton, plan: BranchingPlan, wording: Wording, start: str = START
) -> list[str]:
    """What happens after a checkpoint: a sentence a segment, and each way named where they part."""
    said: list[str] = []
    waiting = [(segment, "") for segment in reversed(_ways(automaton, plan, start))]
    several = len(waiting) > 1
    waiting = [(s, _way(s, wording, several)) for s, _ in waiting]
    while waiting:
        segment, lead = waiting.pop()
        said.append(segment_in_words(segment, wording, lead))
        ways = _ways(automaton, plan, segment.target)
        several = len(ways) > 1
        waiting.extend((way, _way(way, wording, several) or "then ") for way in reversed(ways))
    return said


def _ways(automaton: Automaton, plan: BranchingPlan, checkpoint: str) -> list[Segment]:
    found = [
        plan.segments[t.target] for t in automaton.outgoing(checkpoint) if t.target in plan.segments
    ]
    return sorted(found, key=lambda s: not s.when)


def _way(segment: Segment, wording: Wording, several: bool) -> str:
    if segment.when:
        return f"once {wording.events(segment.when)}, "
    return "otherwise " if several else ""


def segment_in_words(segment: Segment, wording: Wording, lead: str = "") -> str:
    """One segment as a sentence."""
    steps = f"I {steps_in_words(segment, wording)}" if segment.actions else "there is nothing to do"
    return sentence(f"{lead}{steps}")


def steps_in_words(segment: Segment, wording: Wording) -> str:
    """The actions of a segment, as a list of imperatives."""
    actions = [wording.action(a) for a in segment.actions]
    if len(actions) > SPOKEN_ACTIONS:
        middle = len(actions) - SPOKEN_ACTIONS + 1
        actions = [*actions[: SPOKEN_ACTIONS - 2], f"do {middle} more things", actions[-1]]
    return listed(actions) or "do nothing"


def purpose_in_words(reasons: Reasons, step: Step, wording: Wording) -> str:
    """What an action is for: the later actions that need it, and the goals at the end.

    "I pick up the tray, so that I can fill it at the food station, as you asked me to fill the tray."
    """
    action = reasons.plan.segments[step.checkpoint].actions[step.at]
    purposes = reasons.purposes(step)
    done = f"I {wording.action(action)}"
    if not purposes:
        return sentence(f"{done}{_without_purpose(reasons, step, wording)}")
    places = _steps(reasons, purposes)
    steps = [wording.action(a) for a in places.values()]
    ways = [place.checkpoint for place in places][-2:]
    parted = len(ways) == 2 and ways[1] not in reasons.automaton.subtree(ways[0])
    way = f", so that I can {_shortened(steps, 'or' if parted else 'and')}" if steps else ""
    asked = _asked(reasons, step, purposes, wording)
    if asked == f" to {(steps or [wording.action(action)])[-1]}":
        asked = " to"
    return sentence(f"{done}{way}, as you asked me{asked}")


def _without_purpose(reasons: Reasons, step: Step, wording: Wording) -> str:
    """What is said of an action that no goal needs: what it lets the robot do next, if anything."""
    insisted = reasons.automaton.checkpoints[step.checkpoint].action
    if insisted is not None and step.at == len(reasons.plan.segments[step.checkpoint].actions) - 1:
        return ", as you told me to do just that"
    needed = [r.needed_by for r in reasons.links(step) if r.needed_by is not None]
    if needed:
        return f", so that I can {wording.action(needed[0])}"
    name = reasons.automaton.checkpoints[step.checkpoint].name
    return f' on the way to "{name}", but nothing that you asked for needs it'


def _steps(reasons: Reasons, purposes: Sequence[Purpose]) -> dict[Step, Action]:
    """The actions of all chains in the order of the plan; of several moves in a row, the last."""
    order = {c: n for n, c in enumerate(reasons.plan.segments)}
    places: dict[Step, Action] = {}
    for purpose in purposes:
        chain = [(r.step, r.needed_by) for r in purpose.chain if r.step and r.needed_by]
        following = [action.operator for _, action in chain[1:]]
        for (place, action), then in zip_longest(chain, following):
            if action.operator != then:
                places[place] = action
    return dict(sorted(places.items(), key=lambda p: (order[p[0].checkpoint], p[0].at)))


def _shortened(steps: list[str], word: str) -> str:
    """Few actions as a list, of many the first ones and the last."""
    if len(steps) <= SPOKEN_PURPOSES:
        return listed(steps, word)
    return f"{', '.join(steps[: SPOKEN_PURPOSES - 1])} and in the end {steps[-1]}"


def _asked(reasons: Reasons, step: Step, purposes: Sequence[Purpose], wording: Wording) -> str:
    """The goals, those of a checkpoint together, with the condition that leads there."""
    by_checkpoint: dict[str, list[Literal]] = {}
    for purpose in purposes:
        by_checkpoint.setdefault(purpose.checkpoint, []).append(purpose.goal)
    here = {t.id for t in reasons.automaton.path(step.checkpoint)}
    said = []
    for checkpoint, goals in by_checkpoint.items():
        onward = [t for t in reasons.automaton.path(checkpoint) if t.id not in here]
        cases = [c for t in onward if (c := _case(reasons.automaton, t, wording))]
        once = cases[-1] if cases else ""
        said.append(f"{once} to {wording.goals(goals)}")
    return " and".join(said)


def _case(automaton: Automaton, transition: Transition, wording: Wording) -> str:
    if transition.when:
        return f", once {wording.events(transition.when)},"
    return " otherwise" if automaton.is_else(transition.id) else ""


def offers(plan: BranchingPlan) -> tuple[tuple[Problem | Warning, Repair], ...]:
    """All ways out, with what each is a way out of, in the order in which `problem_rows` counts them."""
    troubles: tuple[Problem | Warning, ...] = (*plan.problems, *plan.warnings)
    return tuple((trouble, repair) for trouble in troubles for repair in trouble.repairs)


def problem_rows(plan: BranchingPlan, automaton: Automaton, width: int) -> list[Row]:
    """Every problem with its ways out, then every warning with its own; ways out are counted from 1."""
    rows: list[Row] = []
    number = 0
    troubles: tuple[Problem | Warning, ...] = (*plan.problems, *plan.warnings)
    for trouble in troubles:
        checkpoint = _place(trouble, automaton)
        if isinstance(trouble, Problem):
            here = automaton.checkpoints.get(checkpoint or "")
            lead = f"{here.name}: " if here else ""
            rows.extend(wrapped(f"{lead}{trouble.text}", width, "", "  ", "bad", checkpoint))
        else:
            rows.extend(wrapped(trouble.text, width, "Note: ", checkpoint=checkpoint))
        for repair in trouble.repairs:
            number += 1
            found = wrapped(repair.text, width, "  Way out: ", checkpoint=checkpoint)
            rows.extend(replace(row, repair=number) for row in found)
    return rows


def _place(trouble: Problem | Warning, automaton: Automaton) -> str | None:
    if isinstance(trouble, Problem):
        return trouble.checkpoint
    way = automaton.transitions.get(trouble.transition or "")
    return way.target if way else None
