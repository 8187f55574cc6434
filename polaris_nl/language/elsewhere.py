"""Where a thing should be, said of one that a step takes elsewhere: "the wine can go on the table"."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import Edit, SetGoals
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.generate import goals_in_words
from polaris_nl.language.goal_relations import says_a_place, thing_placed
from polaris_nl.language.protocol import Language
from polaris_nl.language.requests import BE_OR_DO, SUBJECTS
from polaris_nl.language.reshaping import Reshaped, removed
from polaris_nl.language.segment import Cut
from polaris_nl.language.structure import Step
from polaris_nl.language.tokens import BREAK, COMMA, words
from polaris_nl.model.formula import Formula, Goal, Imply, Literal, Quantified

_NEXT = frozenset((
    "then", "next", "after", "afterwards", "later", "finally", "again", "too", "also", "first", "last",
    "before", "eventually", "besides", "as", "once"
))  # fmt: skip
"""Words of what is to be done on top of what is there."""
_VERBS_TOLD = BE_OR_DO - {"can", "could", "would", "do", "will", "want", "need", "get", "keep"} | {
    "not",
    "might",
}
"""Verbs by which a reason is told."""
_TO = frozenset(("to", "into", "onto", "in", "on", "at"))
"""Words that a place begins with."""
_TAKING = ("bring", "put")
"""Verbs by which a thing is taken to a place."""
_LEFT = frozenset(("leave", "keep"))
"""Verbs by which something stays as it is."""


def put_elsewhere(
    language: Language, cut: Cut, steps: Sequence[Step], program: Automaton, utterance: str
) -> Reshaped | None:
    """The edits that put goals in the place of those that take the same things elsewhere.

    Only what is said of things ("the wine goes on the table"), or for a reason ("she isn't drinking, so bring
    it to me"), not what is to be done ("put the wine on the table"): that is dictated in a row.

    Args:
        language: its verbs, and names for checkpoints.
        cut: the utterance, cut into clauses.
        steps: what it asks for.
        program: what is there.
        utterance: all that was said, of which some may have been passed over.

    Returns:
        None where something is new, or said as something to be done.
    """
    said = [w for item in cut.items for w in item.text.split()]
    if _NEXT.intersection(said) or said[:1] == ["and"]:
        return None
    if _LEFT.intersection(said) and len(steps) == 1 and not steps[0].when:
        return _left_so(steps[0].goals, program)
    aside = (i.text.split() for i in cut.items if i.role in ("fact", "topic"))
    reasoned = any(map(_VERBS_TOLD.intersection, aside)) or _tells_more(utterance, said)
    if not reasoned and not _says_how_it_should_be(cut, language):
        return None
    if any(s.when or s.forbidden or s.role != "then" or not s.goals for s in steps):
        return None
    changed: dict[str, tuple[Goal, ...]] = {}
    wanted = [goal for step in steps for goal in step.goals]
    for goal in wanted:
        thing = moved(goal)
        made = [c.id for c in program.checkpoints.values() if c.id != START]
        places = {c: changed.get(c, program.checkpoints[c].goals) for c in made}
        there = [c for c, goals in places.items() if thing in map(moved, goals)]
        if thing is None or len(there) != 1 or goal in places[there[0]]:
            return None
        changed[there[0]] = tuple(goal if moved(g) == thing else g for g in places[there[0]])
    edits: list[Edit] = []
    for checkpoint, goals in changed.items():
        incoming = program.incoming(checkpoint)
        edits.append(SetGoals(checkpoint, goals))
        when = incoming.when if incoming is not None else ()
        edits += language.names.renamed(program, checkpoint, goals, when)
    return edits, f"{goals_in_words(wanted, language.wording)} instead", list(changed)


def exchanged_places(wanted: Sequence[Goal], there: Sequence[Goal]) -> tuple[Goal, ...]:
    """What is wanted of some things in the place of what was, with what was wanted of others there."""
    by_thing = {moved(goal): goal for goal in wanted}
    things = {moved(goal) for goal in there}
    if None in by_thing or len(by_thing) < len(wanted) or not set(by_thing) <= things:
        return tuple(wanted)
    return tuple(by_thing.get(moved(goal), goal) for goal in there)


def taken_there(
    read: Callable[[Sequence[str], Dialogue], Sequence[Step]],
    tokens: Sequence[str],
    goals: tuple[Goal, ...],
    there: Sequence[Goal],
    dialogue: Dialogue,
) -> tuple[Goal, ...]:
    """`to the kitchen`, in the place of "bring it to the desk": the thing is to be there, not the robot.

    Args:
        read: reads steps.
        tokens: what was said.
        goals: what it asks for by itself.
        there: what was asked for.
        dialogue: what was said before.
    """
    things = [thing for thing in map(moved, there) if isinstance(thing, str)]
    if tokens[0] not in _TO or len(things) != 1 or any(map(moved, goals)):
        return goals
    dialogue = replace(dialogue, scope=dialogue.scope.after(things))
    for verb in _TAKING:
        steps = read((verb, "it", *tokens), dialogue)
        if len(steps) == 1 and [moved(goal) for goal in steps[0].goals] == things:
            return steps[0].goals
    return goals


def _left_so(goals: Sequence[Goal], program: Automaton) -> Reshaped | None:
    """Without what would change a thing that is to be left as it is: "leave the wardrobe open"."""
    wrong = {goal.negation for goal in goals if isinstance(goal, Literal)}
    for checkpoint in reversed(list(program.checkpoints.values())):
        if set(goals).intersection(checkpoint.goals):
            return None  # So it is in the end.
        kept = tuple(goal for goal in checkpoint.goals if goal not in wrong)
        if kept != checkpoint.goals:
            if kept:
                say = f"{checkpoint.name} is without that now"
                return [SetGoals(checkpoint.id, kept)], say, [checkpoint.id]
            return removed(program, checkpoint.id), f"{checkpoint.name} is gone", []
    return None


def _tells_more(utterance: str, said: Sequence[str]) -> bool:
    """Whether something was told around what was asked for: "she isn't drinking, so ..."."""
    passed = Counter(w for w in words(utterance) if w not in (BREAK, COMMA)) - Counter(said)
    return passed.total() > 2 and bool(_VERBS_TOLD.intersection(passed))


def _says_how_it_should_be(cut: Cut, language: Language) -> bool:
    firsts = [item.text.split()[0] for item in cut.items if item.role == "goal"]
    return bool(firsts) and not (language.verbs.imperatives - SUBJECTS).intersection(firsts)


def moved(goal: Formula) -> object:
    """What a goal takes to a place: a thing, or all of a kind; None where it does nothing of the sort."""
    if isinstance(goal, Quantified) and isinstance(goal.body, Imply):
        end = goal.body.conclusion
        places = isinstance(end, Literal) and end.positive and says_a_place(end)
        return (goal.quantifier, goal.variables, goal.body.condition) if places else None
    if isinstance(goal, Literal) and goal.positive and says_a_place(goal):
        return thing_placed(goal)
    return None
