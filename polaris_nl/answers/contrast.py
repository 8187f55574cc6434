"""Answers to "why don't you ... first?", "why ... before ...?", "what if she never ...?" and the like."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.execution.settings import RunSettings
from polaris_nl.language.interpretation import Query
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.planning.contrast import achieved, contrast
from polaris_nl.planning.foils import Contrast, Foil, Way
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.planning.waiting import Waiting, waits
from polaris_nl.render.explanation import steps_in_words

if TYPE_CHECKING:
    from polaris_nl.planning.planner import Planner

CONTRASTS: dict[str, Way | None] = {
    "why-first": "first",
    "why-before": "before",
    "why-instead": "instead",
    "what-if-never": None,
}
"""The kinds of questions that are answered here, with how their foil goes."""
_SPOKEN_EXTRAS = 3
"""Actions that only one of two plans has, said one by one; more are only counted."""
_UNDECIDED = "I couldn't find that out in time; ask me again."


def answer_contrast(
    query: Query,
    automaton: Automaton,
    plan: BranchingPlan | None,
    planner: Callable[[], Planner],
    wording: Wording,
    wait_s: float | None = RunSettings().wait_s,
) -> str:
    """The answer to a question of one of the kinds in `CONTRASTS`.

    Args:
        query: the question.
        automaton: the program that it is asked of.
        plan: its plan, or None while there is none.
        planner: makes the planner of the program's world, where it is needed.
        wording: words for it.
        wait_s: how long a run waits for a conditional, in seconds; None waits for ever.
    """
    if plan is None or not plan.segments:
        problem = plan.problems[0].text if plan and plan.problems else ""
        return problem or "There is no plan yet: say what the robot should achieve."
    way = CONTRASTS[query.kind]
    if way is None:
        return never_in_words(query.when, automaton, plan, wording, wait_s)
    foil = Foil(way, query.goals, query.others)
    found = contrast(planner(), automaton, plan, foil)
    in_order = way == "before" and _asked_in_order(foil, automaton, planner(), plan)
    return contrast_in_words(found, foil, automaton, wording, in_order)


def _asked_in_order(
    foil: Foil, automaton: Automaton, planner: Planner, plan: BranchingPlan
) -> bool:
    """Whether the user's own steps say that the plan's facts come before the wanted ones."""
    first = achieved(planner, automaton, plan, foil.fact)
    second = achieved(planner, automaton, plan, foil.wanted)
    if first is None or second is None or first.checkpoint == second.checkpoint:
        return False
    asked = plan.segments[first.checkpoint], plan.segments[second.checkpoint]
    goals = set(foil.fact) <= set(asked[0].goals) and set(foil.wanted) <= set(asked[1].goals)
    return goals and second.checkpoint in automaton.subtree(first.checkpoint)


def contrast_in_words(
    found: Contrast, foil: Foil, automaton: Automaton, wording: Wording, in_order: bool = False
) -> str:
    """What came of trying a foil, in a sentence or two.

    Args:
        found: the plan beside the foil.
        foil: what was tried.
        automaton: the program.
        wording: words for it.
        in_order: whether the user asked for the order that the plan has.
    """
    wanted, own = wording.goals(foil.wanted), wording.goals(foil.fact)
    ahead = f"{wanted} first" if foil.way == "first" else f"{wanted} before I {own}"
    if foil.way == "instead":
        ahead = f"{wanted} instead"
    match found.outcome:
        case "absent":
            return sentence(f"I don't {own} at all: that isn't in the plan")
        case "already":
            return sentence(f"but I do: I {ahead}")
        case "holds":
            facts = listed([wording.fact(x) for x in foil.wanted])
            return sentence(f"there is nothing to do for that: {facts} by then")
        case "needed":
            way = f"I have to {own} first" if foil.way == "before" else f"I have to {own}"
            return sentence(f"{way}: without that there is no way to {wanted}")
        case "asked":
            return sentence(f"because you asked me to {own}, not to {wanted}")
        case "impossible":
            return found.reason or sentence(f"I can't {wanted} then")
        case "undecided":
            return _UNDECIDED
    asked = "you asked for it in that order. " if in_order else ""
    return f"{sentence(asked)}{' ' if asked else ''}{_possible(found, foil, ahead, automaton, wording)}"


def _possible(
    found: Contrast, foil: Foil, ahead: str, automaton: Automaton, wording: Wording
) -> str:
    if found.lost:
        names = listed([f'"{automaton.checkpoints[c].name}"' for c in found.lost])
        return sentence(f"if I {ahead}, I can't do {names} any more")
    could = f"I could {ahead}"
    if found.still:
        could += f", but I would still have to {wording.goals(foil.fact)}"
    if found.extra > 0:
        length = f"take {_more(found.extra, 'more')}{_also(found, wording)}"
        it = "it" if found.exact else "the way that I found"
        return sentence(f"{could}, {'and' if found.still else 'but'} {it} would {length}")
    length = f"be {_more(-found.extra, 'shorter')}" if found.extra < 0 else "be as short"
    return sentence(f"{could}, and it would {length}{_to_have_it(found, foil, automaton, wording)}")


def _also(found: Contrast, wording: Wording) -> str:
    """What only one of the two plans has, where that is little."""
    # The same way there from two places is said the same: it is no difference to a person.
    theirs = Counter(wording.action(a) for a in found.more)
    ours = Counter(wording.action(a) for a in found.less)
    more, less = list((theirs - ours).elements()), list((ours - theirs).elements())
    if not more or len(more) + len(less) > _SPOKEN_EXTRAS:
        return ""
    if not less:
        return f": I would have to {listed(more)} besides"
    return f": I would {listed(more)}, but not {listed(less)}"


def _more(count: int, word: str) -> str:
    actions = "one action" if count == 1 else f"{count} actions"
    if word == "more":
        return "one more action" if count == 1 else f"{count} more actions"
    return f"{actions} {word}"


def _to_have_it(found: Contrast, foil: Foil, automaton: Automaton, wording: Wording) -> str:
    """What to say to have the foil, where that has been tried."""
    if not found.offered:
        return ""
    wanted = wording.goals(foil.wanted)
    if foil.way == "first":
        return f'; say "{wanted} before anything else" to have it so'
    if foil.way == "before" and found.checkpoint is not None:
        name = automaton.checkpoints[found.checkpoint].name
        return f'; say "before {name}, {wanted}" to have it so'
    return ""


def never_in_words(
    never: Sequence[Literal],
    automaton: Automaton,
    plan: BranchingPlan,
    wording: Wording,
    wait_s: float | None,
) -> str:
    """What a run does if facts never come about, as the executor does it (DESIGN section 5 point 8).

    Args:
        never: the facts; none means that nobody does anything.
        automaton: the program.
        plan: its plan.
        wording: words for it.
        wait_s: how long a run waits for a conditional, in seconds; None waits for ever.
    """
    found = waits(automaton, never)
    if not found:
        if never:
            return sentence(
                f"that changes nothing: the program doesn't wait until {wording.events(never)}"
            )
        return "That changes nothing: the program waits for nobody."
    return " ".join(_waiting(here, automaton, plan, wording, wait_s) for here in found)


def _waiting(
    here: Waiting, automaton: Automaton, plan: BranchingPlan, wording: Wording, wait_s: float | None
) -> str:
    name = automaton.checkpoints[here.checkpoint].name
    where = "at the start" if here.checkpoint == START else f'after "{name}"'
    missing = listed([wording.events(t.when) for t in here.missing], "or")
    others = listed([wording.events(t.when) for t in here.others], "or")
    if here.otherwise is not None:
        onward = _onward(here.otherwise.target, automaton, plan, wording)
        any_of = listed([x for x in (missing, others) if x], "or")
        return sentence(f"{where} I don't wait: unless {any_of} by then, I {onward} at once")
    if wait_s is None:
        any_of = listed([x for x in (missing, others) if x], "or")
        return sentence(f"{where} I wait for as long as it takes, until {any_of}")
    in_case = f", in case {others}" if others else ""
    return (
        f"{sentence(f'{where} I wait for {_time(wait_s)}{in_case}')} Then I stop where I am and say "
        'that nothing came. Say "otherwise" and what to do, and I do that instead of waiting.'
    )


def _onward(target: str, automaton: Automaton, plan: BranchingPlan, wording: Wording) -> str:
    segment = plan.segments.get(target)
    if segment is None:
        return f'go on to "{automaton.checkpoints[target].name}", which I can\'t do, and stop,'
    return steps_in_words(segment, wording) if segment.actions else "go on"


def _time(seconds: float) -> str:
    minutes = seconds / 60
    if minutes >= 1 and minutes == int(minutes):
        return "one minute" if minutes == 1 else f"{int(minutes)} minutes"
    return f"{seconds:g} seconds"
