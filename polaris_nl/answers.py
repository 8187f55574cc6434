"""The session's answers in words: what a change did, what a run will do, and questions by the user.

Pure functions of the program, the plan and the words of the world. Feedback is proactive (DESIGN
section 1): a change is answered with its echo and with what it did to the plan, problems first.
"""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.interpretation import Query
from polaris_nl.model.evaluate import holds
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import branches_in_words, segment_in_words, steps_in_words

NO_PLAN = "There is no plan yet: say what the robot should achieve."
STILL_PLANNING = "I'm still working out the plan."


def change_in_words(
    echo: str,
    before: BranchingPlan | None,
    after: BranchingPlan | None,
    pending: bool,
    failure: str,
) -> str:
    """The answer to a change: what was understood, then what it did to the plan."""
    if failure:
        return f"{echo} {failure}"
    if pending or after is None:
        return f"{echo} {STILL_PLANNING}"
    known = {(p.cause, p.checkpoint, p.text) for p in before.problems} if before else set()
    news = [
        p
        for p in after.problems
        if (p.cause, p.checkpoint, p.text) not in known and p.cause != "inside"
    ]
    if news:
        return f"{echo} {news[0].text}"
    warnings = [w.text for w in after.warnings if before is None or w not in before.warnings]
    if warnings:
        return f"{echo} {warnings[0]}"
    return f"{echo} {_size(before, after)}".strip()


def _size(before: BranchingPlan | None, after: BranchingPlan) -> str:
    if after.problems:
        return sentence(f"still open: {after.problems[0].text}")
    if not after.segments:
        return "The program is empty now."
    count = after.action_count
    if before is not None and before.problems:
        return f"That mends it: the whole program can be done, in {_actions(count)}."
    return f"The plan takes {_actions(count)}." if count else ""


def _actions(count: int) -> str:
    return "one action" if count == 1 else f"{count} actions"


def run_in_words(automaton: Automaton, plan: BranchingPlan | None, read_back: str) -> str:
    """What a run will do, and the request for the yes (motion never starts without one)."""
    if plan is None or not plan.segments:
        reason = plan.problems[0].text if plan and plan.problems else NO_PLAN
        return f"There is nothing I can run. {reason}"
    left_out = [automaton.checkpoints[c].name for c in plan.omitted if c in automaton.checkpoints]
    gap = f" I can't do {listed(left_out)}, and will halt before it." if left_out else ""
    return f"{read_back}{gap} Shall I start? Say yes or no."


def answer_query(
    query: Query,
    automaton: Automaton,
    plan: BranchingPlan | None,
    world: World,
    wording: Wording,
    read_back: str,
) -> str:
    """The answer to a question about plan, program or world, in a sentence or two.

    Args:
        query: the question.
        automaton: the program it is asked of.
        plan: its plan, or None while there is none.
        world: entities and facts at the start.
        wording: words for them.
        read_back: the program in words.
    """
    match query.kind:
        case "program":
            return read_back
        case "plan" | "checkpoint" | "why":
            return _about_plan(query, automaton, plan, wording)
        case "problems" | "status":
            return _problems(automaton, plan)
        case "where":
            return _where(query.entity, world.initial, world, wording)
        case "is-it" if query.literal is not None:
            return _is_it(query.literal, world, wording)
        case "world":
            return _world(world, wording)
    return 'You can say what the robot should achieve, or ask "what will you do?".'


def _about_plan(
    query: Query, automaton: Automaton, plan: BranchingPlan | None, wording: Wording
) -> str:
    if plan is None or plan.root is None or not plan.segments:
        return plan.problems[0].text if plan and plan.problems else NO_PLAN
    start = _asked_transition(query, automaton)
    if query.when and start is None:
        events = listed([wording.event(x) for x in query.when])
        return (
            f"The program says nothing about what happens when {events}. Tell me what to do then."
        )
    if start is None:
        return " ".join(branches_in_words(automaton, plan, wording)) or NO_PLAN
    transition = automaton.transitions[start]
    target = automaton.checkpoints[transition.target]
    segment = plan.segments.get(target.id)
    if segment is None:
        problem = plan.problem_at(target.id)
        return problem.text if problem else NO_PLAN
    if query.kind == "why":
        goals = listed([wording.fact(goal) for goal in segment.goals]) or "it comes next"
        return sentence(f"to {steps_in_words(segment, wording)} is how I make sure that {goals}")
    lead = f"once {listed([wording.event(x) for x in segment.when])}, " if segment.when else ""
    rest = branches_in_words(automaton, plan, wording, target.id)
    return " ".join([segment_in_words(segment, wording, lead), *rest])


def _asked_transition(query: Query, automaton: Automaton) -> str | None:
    if query.when:
        wanted = frozenset(query.when)
        found = (t.id for t in automaton.transitions.values() if wanted <= t.conditional)
        return next(found, None)
    incoming = automaton.incoming(query.checkpoint) if query.checkpoint else None
    return incoming.id if incoming else None


def _problems(automaton: Automaton, plan: BranchingPlan | None) -> str:
    if len(automaton.checkpoints) == 1:
        return NO_PLAN
    if plan is None:
        return STILL_PLANNING
    if plan.problems:
        return plan.problems[0].text
    return f"All of the program can be done, in {_actions(plan.action_count)}."


_PLACES = ("at", "in", "holding", "has", "person-in", "located", "robot-at")


def _where(entity: str, state: State, world: World, wording: Wording) -> str:
    facts: Sequence[Literal] = sorted(
        (
            f
            for f in state.facts
            if f.predicate in _PLACES and entity in f.args and _tells_place(f, entity)
        ),
        key=lambda f: _PLACES.index(f.predicate),
    )
    if facts:
        said = sentence(wording.fact(facts[0]))
        region = world.place_of(entity, state)
        shown = region is None or region in facts[0].args
        return said if shown else f"{said[:-1]}, in {wording.entity(str(region))}."
    return sentence(f"I don't know where {wording.entity(entity)} is")


def _tells_place(fact: Literal, entity: str) -> bool:
    if fact.predicate == "has":
        return fact.args[-1] == entity
    return fact.predicate == "robot-at" or fact.args[0] == entity


def _is_it(literal: Literal, world: World, wording: Wording) -> str:
    true = holds(literal, world.initial, world)
    fact = literal if true else literal.negation
    return sentence(f"{'yes' if true else 'no'}: {wording.fact(fact)}")


def _world(world: World, wording: Wording) -> str:
    parts = []
    for kind in ("region", "surface", "container", "object", "person", "message"):
        names = (
            [wording.entity(e.name) for e in world.of_type(kind)]
            if kind in world.domain.parents
            else []
        )
        if names:
            more = f" and {len(names) - 4} more" if len(names) > 5 else ""
            shown = names[:4] if more else names
            parts.append(f"{kind}s: {', '.join(shown)}{more}")
    return sentence("; ".join(parts))
