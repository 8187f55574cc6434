"""The session's answers in words: what a change did, what a run will do, and questions by the user.

Pure functions of the program, the plan and the words of the world. Feedback is proactive (DESIGN
section 1): a change is answered with its echo and with what it did to the plan, problems first.
"""

from __future__ import annotations

import re

from polaris_nl.answers.about_plan import AboutPlan
from polaris_nl.answers.about_world import AboutWorld
from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.interpretation import Query
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan

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
    return _capitals(_answer(query, automaton, plan, world, wording, read_back))


def _answer(
    query: Query,
    automaton: Automaton,
    plan: BranchingPlan | None,
    world: World,
    wording: Wording,
    read_back: str,
) -> str:
    if query.kind == "program":
        return read_back
    if query.kind in ("problems", "status"):
        return _problems(automaton, plan)
    about_world = AboutWorld(world, wording).answer(query)
    if about_world and query.checkpoint is None:
        return about_world
    if query.kind in _ABOUT_PLAN:
        if len(automaton.checkpoints) == 1 and not query.when:
            return NO_PLAN
        if plan is None or plan.root is None or not plan.segments:
            return plan.problems[0].text if plan and plan.problems else NO_PLAN
        about_plan = AboutPlan(automaton, plan, world, wording).answer(query)
        return f"{about_world} {about_plan}".strip()
    return 'You can say what the robot should achieve, or ask "what will you do?".'


def _capitals(text: str) -> str:
    """Names with a title as they are written: "Mr Brown"."""
    return re.sub(
        r"\b(mr|mrs|ms|miss|dr) \w+", lambda name: name[0].title(), text, flags=re.IGNORECASE
    )


_ABOUT_PLAN = (
    "plan", "checkpoint", "why", "first", "last", "next", "after-step", "before-step", "length", "use", "when",
    "will",
)  # fmt: skip


def _problems(automaton: Automaton, plan: BranchingPlan | None) -> str:
    if len(automaton.checkpoints) == 1:
        return NO_PLAN
    if plan is None:
        return STILL_PLANNING
    if plan.problems:
        return plan.problems[0].text
    return f"All of the program can be done, in {_actions(plan.action_count)}."
