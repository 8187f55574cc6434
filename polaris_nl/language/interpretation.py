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

QueryKind = OneOf[
    "plan", "program", "checkpoint", "where", "is-it", "why", "help", "problems", "world", "status",
    "where-robot", "people", "contents", "inside", "any-inside", "list", "which", "any",
    "meaning", "owner", "first", "last", "next", "after-step", "before-step",
    "length", "use", "when", "will", "able", "why-not",
    "why-first", "why-before", "why-instead", "what-if-never",
]  # fmt: skip
"""What a question asks for, mostly the name of its intent; `which` asks for those things of which a
fact holds, `any` whether there is one."""


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
        kind: what is asked.
        checkpoint: the checkpoint that it is about, or None.
        when: the conditional that it is about ("what will you do if she dismisses it").
        entity: the entity that it is about, or "".
        literal: the fact that it is about ("is the cupboard open"), or None.
        entities: the entities that it is about, where they are several.
        literals: the facts that it is about, where they are several: one for each thing that "which
            dishes are dirty" may mean.
        goals: the goals that it is about ("why do you go to the kitchen"); where two ways are held
            against each other, those of the way that the plan doesn't go.
        others: the goals that they are held against ("why do you fill the tray before ...").
        counted: how many is asked, too.
        noun: what is asked for ("dishes"), or "".
    """

    kind: QueryKind
    checkpoint: str | None = None
    when: tuple[Literal, ...] = ()
    entity: str = ""
    literal: Literal | None = None
    entities: tuple[str, ...] = ()
    literals: tuple[Literal, ...] = ()
    goals: tuple[Literal, ...] = ()
    others: tuple[Literal, ...] = ()
    counted: bool = False
    noun: str = ""


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
        aside: words of it that ask for nothing themselves: a remark, or a thing that is only named, to be
            spoken of.
        partial: the clear part of the utterance is applied although a question is open.
        agrees: a command that says yes, too: "yes, run it".
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
    aside: tuple[str, ...] = ()
    partial: bool = False
    agrees: bool = False
    readings: tuple[Reading, ...] = field(default=(), repr=False)
