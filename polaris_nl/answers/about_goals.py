"""Answers to "are you able to ..." and "why don't you ...": a goal is tried out at the end of the program."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, apply
from polaris_nl.language.interpretation import Query
from polaris_nl.model.formula import Literal, literals_in
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import steps_in_words


def problem_of(goals: Sequence[Literal], automaton: Automaton, plan: BranchingPlan) -> str:
    """The problem of a checkpoint of the program that has these goals, or ""."""
    for problem in plan.problems:
        checkpoint = automaton.checkpoints.get(problem.checkpoint or "")
        has = [x for g in checkpoint.goals for x in literals_in(g)] if checkpoint else []
        if has and set(goals) & set(has):
            return problem.text
    return ""


def with_goals(
    goals: Sequence[Literal], automaton: Automaton, plan: BranchingPlan | None
) -> tuple[Automaton, str]:
    """The program with the goals at the end of one branch, and the id of their checkpoint."""
    planned = [c for c in automaton.checkpoints if c == START or (plan and c in plan.segments)]
    leaves = [c for c in planned if not automaton.outgoing(c)]
    at = leaves[-1] if leaves else planned[-1]
    asked = Checkpoint(automaton.fresh_checkpoint_id(), "asked", tuple(goals))
    onward = Transition(automaton.fresh_transition_id(), at, asked.id)
    return apply(automaton, AddCheckpoint(asked, onward)), asked.id


def possible_in_words(
    query: Query, tried: Automaton, asked: str, plan: BranchingPlan, wording: Wording
) -> str:
    """Whether the goals that were tried can be reached, and how or why not.

    Args:
        query: the question.
        tried: the program with the goals.
        asked: the checkpoint of the goals.
        plan: the plan of that program.
        wording: words for it.
    """
    segment = plan.segments.get(asked)
    if segment is None:
        problem = plan.problem_at(asked) or next(iter(plan.problems), None)
        reason = problem.text if problem else "I found no way."
        return f"No. {reason}" if query.kind == "able" else reason
    others = [c for c in tried.checkpoints.values() if c.id != asked]
    told = any(set(query.goals) <= {x for g in c.goals for x in literals_in(g)} for c in others)
    goals = listed([wording.goal(g) for g in query.goals])
    if query.kind == "why-not":
        if told:
            return sentence(f"but I do: you asked me to {goals}")
        return sentence(f"you haven't asked me to {goals}, but I could")
    how = steps_in_words(segment, wording)
    if not segment.actions or how == goals:
        return sentence(f"yes, I can {goals}")
    return sentence(f"yes, I can {goals}: I {how}")
