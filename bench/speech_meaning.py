"""What an utterance amounts to, as one line of text: what was meant and what was understood can be compared."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path

from bench.speech_voices import FOLDER
from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import apply_all
from polaris_nl.hands_free.weight import weight_of
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.interpretation import Interpretation, Query
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world
from polaris_nl.speech.weight import Weight


class Context:
    """A program after some typed sentences, in which one more utterance is understood; never changes.

    Args:
        understanding: the language side of a world.
        after: what was typed before.
    """

    def __init__(self, understanding: Understanding, after: Sequence[str] = ()) -> None:
        self._understanding = understanding
        self._programs = [Automaton()]
        self._dialogue: Dialogue | None = None
        for said in after:
            meant, self._dialogue = understanding.interpret(
                said, self._programs[-1], self._dialogue
            )
            if meant.edits:
                self._programs.append(apply_all(self._programs[-1], meant.edits))

    def understood(self, utterance: str) -> tuple[int | None, str]:
        """What an utterance would weigh here, and what it would lead to; the weight is None for a refusal."""
        meant, _ = self._understanding.interpret(utterance, self._programs[-1], self._dialogue)
        weight = weight_of(meant, awaits_yes=True)
        return (None if weight is None else int(weight)), self._meaning(meant)

    def _meaning(self, meant: Interpretation) -> str:
        """The program that an utterance leads to, or the question, command or answer."""
        program = self._programs[-1]
        if meant.outcome == "refused":
            return "refused"
        if meant.outcome == "question":
            return "question: " + ", ".join(meant.question.options if meant.question else ())
        if meant.query is not None:
            return f"answer: {_asked(meant.query)}"
        match meant.command:
            case "undo":
                return program_line(self._programs[-2] if len(self._programs) > 1 else program)
            case "redo" | None:
                return program_line(apply_all(program, meant.edits))
            case "new":
                return program_line(Automaton())
        return f"command: {meant.command}"


class Remembered:
    """Contexts that remember what was understood, on disk, until the language side changes.

    Args:
        world: the world's name.
        after: what was typed before.
    """

    def __init__(self, world: str, after: tuple[str, ...]) -> None:
        self._make = lambda: Context(_understanding(world), after)
        self._context: Context | None = None
        key = hashlib.sha256(repr((_language(), world, after)).encode()).hexdigest()[:16]
        self._path = FOLDER / "meanings" / f"{key}.jsonl"
        self._path.parent.mkdir(parents=True, exist_ok=True)
        lines = self._path.read_text(encoding="utf-8").splitlines() if self._path.exists() else []
        self._known: dict[str, tuple[int | None, str]] = {
            text: (weight, meaning) for text, weight, meaning in map(json.loads, lines)
        }

    def weigh(self, utterance: str) -> Weight | None:
        """What an utterance would weigh here; None if it wouldn't be understood."""
        weight = self._understood(utterance)[0]
        return None if weight is None else Weight(weight)

    def meaning(self, utterance: str) -> str:
        """What an utterance would lead to here."""
        return self._understood(utterance)[1]

    def _understood(self, utterance: str) -> tuple[int | None, str]:
        if utterance not in self._known:
            self._context = self._context or self._make()
            found = self._known[utterance] = self._context.understood(utterance)
            with self._path.open("a", encoding="utf-8") as file:
                file.write(json.dumps([utterance, *found]) + "\n")
        return self._known[utterance]


@cache
def _understanding(world: str) -> Understanding:
    return Understanding(load_world(world))


@cache
def _language() -> str:
    """A hash of all that decides what is understood."""
    root = Path(__file__).parent.parent
    places = ("polaris_nl/language", "polaris_nl/model", "grammars", "domains")
    files = sorted(
        f for p in places for f in (root / p).rglob("*") if f.suffix in (".py", ".yaml", ".pddl")
    )
    digest = hashlib.sha256()
    for file in (*files, Path(__file__), root / "polaris_nl/hands_free/weight.py"):
        digest.update(file.read_bytes())
    return digest.hexdigest()


def is_meant(meaning: str, expected: str, said: str) -> bool:
    """Whether an utterance led to what was meant by it.

    "A and B" may be one checkpoint or a sequence (DESIGN 5.10), unless words of order are said, too.
    """
    words = said.split()
    either = "and" in words and not any(word in _ORDER for word in words)
    return meaning == expected or (either and _joined(meaning) == _joined(expected))


_ORDER = (
    "then",
    "after",
    "before",
    "first",
    "next",
    "finally",
    "last",
    "afterwards",
    "once",
    "when",
)
_STEP = re.compile(r"\[((?!when |else)[^\[\]]*) \[((?!when |else)[^\[\]]*)\]\]")


def _joined(line: str) -> str:
    """A program line with steps that simply follow each other put into one, goals in order."""
    joined = _STEP.sub(lambda m: f"[{m[1]} & {m[2]}]", line)
    if joined != line:
        return _joined(joined)
    return re.sub(r"\[([^\[\]]*)\]", lambda m: f"[{' & '.join(sorted(m[1].split(' & ')))}]", line)


def program_line(automaton: Automaton) -> str:
    """A program without the names of its checkpoints.

    Example: `start [goal & goal [when literal: goal] [goal]]`; an empty checkpoint is `-`.
    """
    return "start" + _following(automaton, START)


def _following(automaton: Automaton, checkpoint: str) -> str:
    found = sorted(
        f"[{_when(t.when)}{_sorted(automaton.checkpoint(t.target).goals) or '-'}"
        f"{_following(automaton, t.target)}]"
        for t in automaton.outgoing(checkpoint)
    )
    return "".join(f" {one}" for one in found)


def _when(literals: Iterable[object]) -> str:
    text = _sorted(literals)
    return f"when {text}: " if text else ""


def _sorted(goals: Iterable[object]) -> str:
    return " & ".join(sorted(str(g) for g in goals))


def _asked(query: Query) -> str:
    parts = [
        query.kind, query.checkpoint or "", query.entity, str(query.literal or ""),
        *map(str, (*query.when, *query.entities, *query.literals, *query.goals, *query.others)),
    ]  # fmt: skip
    return " ".join(p for p in parts if p)
