"""The plan as text in other forms than the outline: short, full, and the state after an action."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.reasons import Reasons, Step
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import purpose_in_words
from polaris_nl.render.layout import Row, wrapped


def short_rows(
    automaton: Automaton, plan: BranchingPlan, wording: Wording, width: int
) -> list[Row]:
    """A line for each branch: when it is taken, its checkpoints, and how many actions it takes."""
    rows: list[Row] = []
    for leaf in automaton.leaves():
        path = [t.target for t in automaton.path(leaf)]
        names = ", ".join(automaton.checkpoints[c].name for c in path) or "nothing to do"
        left_out = next((c for c in path if c not in plan.segments), None)
        if left_out is None:
            cost = _actions(sum(len(plan.segments[c].actions) for c in path))
        else:
            cost = f"can't be done from {automaton.checkpoints[left_out].name} on"
        lead = case_in_words(automaton, leaf, wording)
        text = f"{lead}: {names} ({cost})" if lead else f"{names} ({cost})"
        rows.extend(wrapped(sentence(text), width, rest="  ", checkpoint=leaf))
    return rows


def case_in_words(automaton: Automaton, checkpoint: str, wording: Wording) -> str:
    """When a checkpoint is reached: "once lunch is acknowledged", or "" where always."""
    cases = []
    for transition in automaton.path(checkpoint):
        if transition.when:
            cases.append(f"once {wording.events(transition.when)}")
        elif automaton.is_else(transition.id):
            ways = [t.when for t in automaton.outgoing(transition.source) if t.when]
            cases.append(f"unless {listed([wording.events(w) for w in ways], 'or')}")
    return " and then ".join(cases)


def full_rows(
    reasons: Reasons,
    wording: Wording,
    mutexes: Mutexes,
    width: int,
    numbers: Mapping[str, int],
) -> list[Row]:
    """Every action with what it is for and what is different after it.

    Args:
        reasons: what the actions of the plan are for.
        wording: words for them.
        mutexes: what excludes what: that a thing has left its old place goes without saying.
        width: characters in a row.
        numbers: the number of each segment's first action.
    """
    rows: list[Row] = []
    automaton, plan = reasons.automaton, reasons.plan
    for checkpoint in automaton.subtree(START):
        segment = plan.segments.get(checkpoint)
        if segment is None:
            continue
        name = automaton.checkpoints[checkpoint].name
        case = case_in_words(automaton, checkpoint, wording)
        head = f"{name}, {case}:" if case else f"{name}:"
        rows.extend(wrapped(head, width, tone="strong", checkpoint=checkpoint))
        if not segment.actions:
            rows.extend(wrapped("There is nothing to do.", width, "     ", checkpoint=checkpoint))
        for at in range(len(segment.actions)):
            number = numbers[checkpoint] + at
            text = purpose_in_words(reasons, Step(checkpoint, at), wording)
            states = reasons.states[checkpoint]
            changed = listed(changes_in_words(states[at], states[at + 1], wording, mutexes))
            lead = f"  {number:>2} "
            for said, first in ((text, lead), (sentence(f"then {changed}"), " " * len(lead))):
                rows.extend(wrapped(said, width, first, checkpoint=checkpoint, action=number))
    return rows


def changes_in_words(before: State, after: State, wording: Wording, mutexes: Mutexes) -> list[str]:
    """What is true in the later state and wasn't, then what isn't any more and nothing takes the place of."""
    removed, added = before.difference(after)
    gone = [x for x in removed if not any(mutexes.exclusive(x, new) for new in added)]
    return [wording.fact(x) for x in (*added, *(x.negation for x in gone))]


def state_in_words(
    state: State, world: World, wording: Wording, mutexes: Mutexes
) -> tuple[str, str]:
    """A state as two texts: what is different from the world's start, and what is as it was then.

    Where rooms and furniture are, which nothing changes, is left out.
    """
    changed = changes_in_words(world.initial, state, wording, mutexes)
    same: dict[str, list[Literal]] = {}
    for fact in sorted(state.facts & world.initial.facts):
        domain = world.domain
        if domain.robot_can_change(fact.predicate) or domain.people_can_change(fact.predicate):
            same.setdefault(fact.predicate, []).append(fact)
    ordered = [same[p] for p in world.domain.predicates if p in same]
    unchanged = [sentence(listed([wording.fact(f) for f in facts])) for facts in ordered]
    return " ".join(map(sentence, changed)), " ".join(unchanged)


def state_rows_after(
    title: str, state: State, world: World, wording: Wording, mutexes: Mutexes, width: int
) -> Iterator[Row]:
    """The state below a title."""
    changed, same = state_in_words(state, world, wording, mutexes)
    yield from wrapped(title, width, tone="strong")
    if changed:
        yield from wrapped(changed, width, "  Changed: ", "  ")
    yield from wrapped(same or "Nothing.", width, "  As at the start: ", "  ")


def _actions(count: int) -> str:
    return "1 action" if count == 1 else f"{count} actions"
