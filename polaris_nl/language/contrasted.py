"""What is wanted in the place of what was asked for, both named: "give it to Anna instead of the host"."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import Edit, SetGoals
from polaris_nl.language.changes import Changes
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.exchange import exchanged
from polaris_nl.language.generate import goals_in_words
from polaris_nl.language.goal_relations import flat
from polaris_nl.language.mention import Mention
from polaris_nl.language.protocol import Language
from polaris_nl.language.scope import Misfit, Unclear
from polaris_nl.language.tokens import BREAK, COMMA, PhraseSet, words
from polaris_nl.model.domain import KIND
from polaris_nl.model.formula import Goal, Imply, Literal, Quantified, bind

_ONLY = ("only", "just")
_AROUND = (BREAK, COMMA, "actually", "really", "please", "no", "sorry")
_MAKE_IT = frozenset(("make", "let", "'s", "us", "it", "that", "this", "please"))
"""Words before it."""


def put_instead(
    language: Language,
    changes: Changes,
    words: Sequence[str],
    touched: Sequence[str],
    program: Automaton,
    dialogue: Dialogue,
) -> tuple[list[Edit], str] | None:
    """The edits that put a goal in the place of one that differs from it in what is not wanted.

    Args:
        language: its other parts.
        changes: reads what is wanted.
        words: what was said, without marks.
        touched: the steps of the latest edit, which come before the rest.
        program: the program.
        dialogue: what was said before.

    Returns:
        The edits and what they do in words; None where nothing of the kind was asked for before.
    """
    contrast = PhraseSet(language.grammar.common.contrast)
    at = next((i for i in range(1, len(words)) if contrast.length_at(words, i)), None)
    if at is None:
        return None
    start = at + contrast.length_at(words, at)
    mentions = language.mentions(words)
    # "... not in the sink" says the preposition again.
    named = [m for there in mentions[start : start + 2] for m in there]
    whole = [m for m in named if m.end == len(words)]
    old = {c.entity for m in whole for c in m.candidates}
    for mention in whole:
        if mention.pronoun and not mention.candidates:
            old.update(_spoken_of(language, mention, dialogue))
    if not old:
        return None
    try:
        steps = changes.steps(_plain(words[:at]), dialogue)
    except Unclear:
        return None
    if len(steps) != 1 or steps[0].when or steps[0].forbidden or not steps[0].goals:
        return None
    wanted = steps[0].goals
    if len(wanted) == 1 and isinstance(wanted[0], Quantified):
        return _all_of_them(language, wanted[0], old, program)
    new = dict.fromkeys(a for g in flat(wanted) for a in g.args if a not in old)
    for checkpoint in (*reversed(touched), *reversed(list(program.checkpoints))):
        for before, after in ((b, a) for b in sorted(old) for a in new if checkpoint != START):
            edits = _exchanged_only(language, wanted, checkpoint, (before, after), program)
            if edits:
                return edits, f"{goals_in_words(wanted, language.wording)} instead"
    return None


def only_these(
    language: Language,
    utterance: str,
    touched: Sequence[str],
    program: Automaton,
    dialogue: Dialogue,
) -> tuple[list[Edit], str] | None:
    """Some things in the place of all of their kind: "just the fork", "only the fork, not all the cutlery".

    Args:
        language: its other parts.
        utterance: what was said.
        touched: the steps of the latest edit, which come before the rest.
        program: the program.
        dialogue: what was said before.

    Raises:
        Unclear: a question has to be asked.
    """
    spoken = [w for w in words(utterance) if w not in _AROUND]
    start = next((i for i, word in enumerate(spoken[:6]) if word in _ONLY), None)
    if start is None or not set(spoken[:start]) <= _MAKE_IT:
        return None
    contrast = PhraseSet(language.grammar.common.contrast)
    ends = (i for i in range(start + 1, len(spoken)) if contrast.length_at(spoken, i))
    said = spoken[start + 1 : next(ends, len(spoken))]
    whole = [m for m in language.mentions(said)[0] if m.end == len(said)] if said else []
    if not whole:
        return None
    try:
        named = language.resolver.meant(whole[0], (), dialogue.scope).entities
    except Misfit:
        return None
    for checkpoint in (*reversed(touched), *reversed(list(program.checkpoints))):
        there = program.checkpoints[checkpoint].goals
        for goal in there:
            if isinstance(goal, Quantified) and (some := _of_its_kind(goal, named, language)):
                kept = (some if g is goal else (g,) for g in there)
                goals = tuple(dict.fromkeys(g for group in kept for g in group))
                edits: list[Edit] = [SetGoals(checkpoint, goals)]
                return edits, f"only {goals_in_words(some, language.wording)}"
    return None


def _of_its_kind(goal: Quantified, named: Sequence[str], language: Language) -> tuple[Goal, ...]:
    """What a goal asks of all of a kind, of some that are of that kind; () where one isn't."""
    body = goal.body
    if not isinstance(body, Imply) or len(goal.variables) != 1:
        return ()
    one = goal.variables[0].name
    conditions = [bind(body.condition, {one: thing}) for thing in named]
    fitting = all(
        isinstance(c, Literal) and c.predicate == KIND and language.world.is_kind(*c.args)
        for c in conditions
    )
    found = [bind(body.conclusion, {one: thing}) for thing in named] if fitting else []
    return tuple(goal for goal in found if isinstance(goal, Literal))


def _spoken_of(language: Language, pronoun: Mention, dialogue: Dialogue) -> Sequence[str]:
    """Whom "me" means."""
    try:
        return language.resolver.meant(pronoun, ("person",), dialogue.scope).entities
    except (Misfit, Unclear):
        return ()


def _all_of_them(
    language: Language, wanted: Quantified, old: Collection[str], program: Automaton
) -> tuple[list[Edit], str] | None:
    """All of a kind in the place of one of it: "all the laundry on the desk, not just the towel"."""
    body = wanted.body
    if not isinstance(body, Imply) or len(wanted.variables) != 1:
        return None
    of = {bind(body.conclusion, {wanted.variables[0].name: thing}) for thing in old}
    for checkpoint in program.checkpoints.values():
        if of.intersection(checkpoint.goals):
            goals = tuple(dict.fromkeys(wanted if g in of else g for g in checkpoint.goals))
            edits: list[Edit] = [SetGoals(checkpoint.id, goals)]
            return edits, f"{goals_in_words([wanted], language.wording)} instead"
    return None


def _plain(words: Sequence[str]) -> list[str]:
    """`it is the cup that goes there` as "the cup goes there"."""
    joints = [i for i, word in enumerate(words) if word in ("that", "who")]
    if tuple(words[:2]) in (("it", "is"), ("it", "was")) and joints:
        return [*words[2 : joints[0]], *words[joints[0] + 1 :]]
    return list(words)


def _exchanged_only(
    language: Language,
    wanted: Sequence[Goal],
    checkpoint: str,
    pair: tuple[str, str],
    program: Automaton,
) -> list[Edit]:
    """The edits that put one entity in another's place where that makes what is wanted, and nothing else."""
    there = program.checkpoints[checkpoint].goals
    incoming = program.incoming(checkpoint)
    exchange = ((g, bind(g, {pair[0]: pair[1]})) for g in there)
    goals = tuple(new if new in wanted else old for old, new in exchange)
    if set(wanted) <= set(goals) and goals != there:
        renamed = language.names.renamed(
            program, checkpoint, goals, incoming.when if incoming else ()
        )
        return [SetGoals(checkpoint, goals), *renamed]
    # Another sort of place: in the sink instead of the cupboard.
    new = [pair[1]]
    edits = list(
        exchanged(program, [checkpoint], pair[0], new, None, language.world, language.names)
    )
    changed = [set(e.goals) for e in edits if isinstance(e, SetGoals)]
    return edits if changed and changed[0] - set(there) == set(wanted) else []
