"""What an utterance amounts to, as one line of text: what was meant and what was understood can be compared."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import apply_all
from polaris_nl.hands_free.weight import weight_of
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.interpretation import Query
from polaris_nl.language.understanding import Understanding
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

    def weigh(self, utterance: str) -> Weight | None:
        """What an utterance would weigh here; None if it wouldn't be understood."""
        meant, _ = self._understanding.interpret(utterance, self._programs[-1], self._dialogue)
        return weight_of(meant, awaits_yes=True)

    def meaning(self, utterance: str) -> str:
        """The program that an utterance leads to, or the question, command or answer."""
        program = self._programs[-1]
        meant, _ = self._understanding.interpret(utterance, program, self._dialogue)
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
