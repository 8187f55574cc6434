"""One step made to follow another: "connect filled to home if she dismisses it"."""

from __future__ import annotations

from polaris_nl.automaton.automaton import Automaton, Transition
from polaris_nl.automaton.edits import Connect, MoveCheckpoint, SetConditional
from polaris_nl.language.conditions import condition_in
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.patterns import Match
from polaris_nl.language.protocol import Language
from polaris_nl.language.reshaping import Reshaped
from polaris_nl.language.scope import Misfit
from polaris_nl.model.formula import Literal


def connected(
    language: Language,
    match: Match,
    source: str,
    target: str,
    program: Automaton,
    dialogue: Dialogue,
) -> Reshaped:
    """A checkpoint after another one, and what is waited for between them.

    Raises:
        Misfit: what is waited for is no condition.
    """
    when: tuple[Literal, ...] = ()
    if "f" in match.slots:
        when = _event(language, match, source, program, dialogue)
    one, two = program.checkpoints[source].name, program.checkpoints[target].name
    incoming = program.incoming(target)
    say = f"{two} comes after {one} now"
    if incoming is None:
        arrow = Transition(program.fresh_transition_id(), source, target, when)
        return [Connect(arrow)], say, [target]
    if incoming.source == source:
        return [SetConditional(incoming.id, when)], say, [target]
    return [MoveCheckpoint(target, source, when)], say, [target]


def _event(
    language: Language, match: Match, source: str, program: Automaton, dialogue: Dialogue
) -> tuple[Literal, ...]:
    """The condition of a connection: "she dismisses it", or "dismissed" alone, of what was said there."""
    span = match.slots["f"]
    when = condition_in(language, match.tokens, span, dialogue.scope)
    if when:
        return when
    assert isinstance(span, tuple)
    word = " ".join(match.tokens[span[0] : span[1]])
    predicate = language.world.domain.predicates.get(word)
    if predicate is None or len(predicate.parameters) != 1:
        raise Misfit("")
    way = [source, *(t.source for t in reversed(program.path(source)))]
    for checkpoint in way:
        for goal in program.checkpoints[checkpoint].goals:
            for arg in reversed(goal.args if isinstance(goal, Literal) else ()):
                if language.world.entities[arg].type in predicate.parameters[0].types:
                    return (Literal(word, (arg,)),)
    raise Misfit("")
