"""What an utterance was taken to mean."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal as OneOf

from polaris_nl.automaton.edits import Edit
from polaris_nl.model.formula import Literal

Outcome = OneOf["applied", "question", "answer", "command", "refused"]
Command = OneOf[
    "new", "undo", "redo", "run", "stop", "pause", "resume", "yes", "no", "help", "read-program", "read-plan",
    "status", "repeat", "quit", "save", "load",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Question:
    """One specific question, with what may be answered.

    Attributes:
        about: what is unclear, such as the words that have several meanings.
        options: what can be answered, in the order spoken, so that "the second" is defined.
    """

    about: str
    options: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why an utterance changes nothing.

    Attributes:
        reason: a sentence that names what is missing and what can be said instead.
        unknown: the words that were not understood.
    """

    reason: str
    unknown: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Query:
    """A question by the user that only the session can answer: it needs the plan or the state.

    Attributes:
        kind: what is asked: the plan (of a branch), the program, a checkpoint, where an entity is,
            why an action is there, what can be said.
        checkpoint: the checkpoint that it is about, or None.
        when: the conditional that it is about ("what will you do if she dismisses it").
        entity: the entity that it is about, or "".
        literal: the fact that it is about ("is the cupboard open"), or None.
    """

    kind: OneOf[
        "plan",
        "program",
        "checkpoint",
        "where",
        "is-it",
        "why",
        "help",
        "problems",
        "world",
        "status",
    ]
    checkpoint: str | None = None
    when: tuple[Literal, ...] = ()
    entity: str = ""
    literal: Literal | None = None


@dataclass(frozen=True, slots=True)
class Reading:
    """One way to understand an utterance, kept for `--explain` and the log.

    Attributes:
        text: the reading in words.
        score: higher is more likely.
        why: what spoke for and against it.
    """

    text: str
    score: float
    why: tuple[str, ...] = ()


@dataclass(frozen=True)
class Interpretation:
    """The meaning of one utterance.

    Attributes:
        outcome: what is to be done with it.
        edits: the change to the program, for `applied` (and for `question` where the clear part is
            kept).
        say: what to answer, one sentence or two; for a query the session says the answer.
        partial: the clear part of the utterance is applied although a question is open.
        readings: all readings, the winner first.
    """

    utterance: str
    outcome: Outcome
    say: str = ""
    edits: tuple[Edit, ...] = ()
    command: Command | None = None
    question: Question | None = None
    refusal: Refusal | None = None
    query: Query | None = None
    partial: bool = False
    readings: tuple[Reading, ...] = field(default=(), repr=False)
