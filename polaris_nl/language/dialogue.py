"""What a dialogue remembers between utterances."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.scope import Scope
from polaris_nl.model.formula import literals_in


@dataclass(frozen=True, slots=True)
class Pending:
    """A question that waits for its answer.

    Attributes:
        utterance: what was said, to be read again with the answer.
        phrase: the words that were unclear, or the parameter that was missing, as `?s`.
        options: the answers offered, as spoken, with the entity or checkpoint each means.
        types: what an answer may be where nothing was offered; empty for anything.
        number: how many are wanted, or 0 for any number.
        kind: what is asked for: a thing, a step of the program, what to do then, or whether what was
            understood, a part of what was said, was meant.
    """

    utterance: str
    phrase: str
    options: tuple[tuple[str, str], ...] = ()
    types: tuple[str, ...] = ()
    number: int = 0
    kind: OneOf["thing", "step", "then", "part"] = "thing"


@dataclass(frozen=True, slots=True)
class Latest:
    """The latest change, for corrections that read it again.

    Attributes:
        tokens: what was said.
        before: the program that it changed.
        after: the program that it made.
        dialogue: the dialogue before it.
        intent: the edit that it was, or "" where it said steps.
        spans: where the tokens name checkpoints, by slot.
    """

    tokens: tuple[str, ...]
    before: Automaton
    after: Automaton
    dialogue: Dialogue
    intent: str = ""
    spans: Mapping[str, tuple[int, int]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Dialogue:
    """The state of a dialogue.

    Attributes:
        here: the checkpoint edited last, or None for "the last one there is".
        touched: the checkpoints that the last edit made or changed, for corrections.
        anchor: where the latest branch began, for "otherwise".
        scope: what was talked about.
        pending: the open question, or None.
        latest: the latest change, or None.
        asked: the checkpoint that the latest utterance asked about, or None.
        missed: the latest utterance was refused, so that "I meant ..." says it anew.
    """

    here: str | None = None
    touched: tuple[str, ...] = ()
    anchor: str | None = None
    scope: Scope = Scope()
    pending: Pending | None = None
    latest: Latest | None = None
    asked: str | None = None
    missed: bool = False


ALERTED = "alerted-to"


def recalled(program: Automaton) -> Dialogue:
    """The dialogue that a program read from a file suggests: what it is about was talked about."""
    scope = Scope()
    for checkpoint in program.checkpoints.values():
        literals = [x for goal in checkpoint.goals for x in literals_in(goal)]
        places = dict.fromkeys(arg for x in literals for arg in x.args[1:])
        things = dict.fromkeys(arg for x in literals for arg in x.args[:1])
        for place in places:
            scope = scope.after((place,))
        scope = scope.after(tuple(thing for thing in things if not thing.startswith("?")))
        told = tuple((x.args[0], x.args[1]) for x in literals if x.predicate == ALERTED)
        scope = replace(scope, told=(*scope.told, *told))
    return Dialogue(scope=scope)
