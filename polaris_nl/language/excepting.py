"""What was asked for isn't to be done where something holds: "don't go home if she dismisses it"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import Edit, RemoveCheckpoint, SetGoals
from polaris_nl.language.afterthoughts import limited, narrowed, spared
from polaris_nl.language.changes import NOTHING_OF_THAT, Changes, MeantThen, steps_there
from polaris_nl.language.conditions import condition_in
from polaris_nl.language.cores import DO_NOT, Cores, trimmed
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.generate import steps_in_words
from polaris_nl.language.protocol import Language
from polaris_nl.language.reshaping import Reshaped, removed
from polaris_nl.language.retractions import never_then, waits
from polaris_nl.language.scope import Misfit, Unclear
from polaris_nl.language.structure import Step
from polaris_nl.language.tokens import words
from polaris_nl.language.verbs import gerund
from polaris_nl.language.waiting import applied
from polaris_nl.model.errors import EditError
from polaris_nl.model.formula import Goal, Literal

NOT_THEN = "That isn't done then anyway; nothing changes."
_IF = (("if",), ("when",), ("once",), ("whenever",), ("in", "case"), ("as", "long", "as"))
"""Words in front of a condition."""
_SKIP = ("skip",)
"""What a step is named behind to be left out."""
_LEFT_OUT = (
    (*DO_NOT, "bother", "with"), (*DO_NOT, "bother"), DO_NOT, _SKIP, ("leave", "out"), ("omit",),
    ("need", "for"),  # "No need for the glasses if ...", of which "no" is known to be a correction.
)  # fmt: skip
"""Words in front of what isn't to be done."""
_UNLESS, _ONLY = "unless", "only"
_STATES = frozenset(("leave", "let", "be", "keep", "have", "hold", "stay", "remain"))
"""What isn't to be so is a goal: "if the fridge is open, don't leave it open"."""
_SAID = frozenset(("not", "need", "leave", "omit", *_SKIP, _UNLESS))
"""Of these words, one is said with each exception."""


@dataclass(frozen=True, slots=True)
class _Unwanted:
    """A step of the program, and which of its goals are not wanted where something holds."""

    checkpoint: str
    goals: frozenset[Goal]


class Excepting:
    """Reads exceptions for the language side of one world.

    Args:
        language: the whole of it.
        changes: reads steps.
        cores: finds what is said not to be done, however that is put.
    """

    def __init__(self, language: Language, changes: Changes, cores: Cores) -> None:
        self._language = language
        self._changes = changes
        self._cores = cores

    def excepted(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        """A step that is there, but not where something holds.

        Within what is done then, it is left out; elsewhere, there is a way on without it; and where it isn't
        done then anyway, nothing changes.

        Raises:
            EditError: it asks for more than what isn't wanted, or what happens then is said already.
        """
        only = _ONLY in words(utterance)  # It may be passed over in front.
        if not only and not _SAID.intersection(tokens):
            return None
        if tuple(tokens[:2]) == DO_NOT and _UNLESS in tokens:
            # "Don't go home unless she dismisses it."
            limit = [_ONLY, *tokens[2:]]
            limit[limit.index(_UNLESS)] = "if"
            meant, after = self._language.interpret(" ".join(limit), program, dialogue)
            return replace(meant, utterance=utterance), after
        for condition, rest in self._limits(tokens) if only else ():
            whole = (0, len(condition))
            when = condition_in(self._language, condition, whole, dialogue.scope)
            named = self._named(rest, program, dialogue) if when else None
            if named is not None:
                incoming = program.incoming(named)
                when = narrowed(incoming.when if incoming is not None else (), when)
                step = Step(program.checkpoints[named].goals, when, "condition")
                say = steps_in_words([step], self._language.wording)
                edits, say, touched = limited(program, named, when, say)
                return applied(self._language, utterance, edits, say, program, dialogue, touched)
        for when, unwanted in self._read(tokens, program, dialogue):
            found = unwanted or []
            inside = [u for u in found if waits(program, u.checkpoint, when)]
            beside = [u for u in found if never_then(program, u.checkpoint, when)]
            free = [u for u in found if u not in (*inside, *beside)]
            if inside or free:
                this = (inside or free)[0]
                try:
                    edits, say, touched = (
                        self._without(program, this, when)
                        if inside
                        else self._spared(program, this, when)
                    )
                except Misfit:
                    continue
                return applied(self._language, utterance, edits, say, program, dialogue, touched)
            if beside:
                return applied(self._language, utterance, (), NOT_THEN, program, dialogue, ())
            if unwanted is not None and len(program.checkpoints) > 1:
                raise EditError(f"{NOTHING_OF_THAT} {steps_there(program)}")
        return None

    def _limits(self, tokens: Sequence[str]) -> Iterator[tuple[Sequence[str], Sequence[str]]]:
        """`bring the tray only if she is in`, of which too little is said to be steps, parted."""
        for condition, rest in _parted(tokens):
            bare = [word for word in rest if word != _ONLY]
            if bare and not self._steps(bare, Dialogue()):
                yield condition, bare

    def _read(
        self, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> Iterator[tuple[tuple[Literal, ...], list[_Unwanted] | None]]:
        """Conditions, and the steps that are unwanted on them; None where something else may be meant."""
        if _UNLESS in tokens:
            steps = self._steps(tokens, dialogue)
            if len(steps) == 2 and steps[1].role == "else" and not steps[0].goals:
                yield steps[0].when, _asked_for(program, steps[1].goals) or None
            return
        for condition, said in _parted(tokens):
            rest = self._left_out(said)
            whole = (0, len(condition))
            when = condition_in(self._language, condition, whole, dialogue.scope) if rest else ()
            if when:
                yield when, self._unwanted(rest, program, dialogue)

    def _left_out(self, tokens: Sequence[str]) -> Sequence[str]:
        """What isn't to be done, without "do not" and the like; () where that isn't said."""
        for said in (tuple(trimmed(tokens)), self._cores.core(trimmed(tokens)).tokens):
            size = next((len(x) for x in _LEFT_OUT if said[: len(x)] == x), 0)
            if size:
                return said[size:]
        return ()

    def _unwanted(
        self, rest: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> list[_Unwanted] | None:
        steps = self._steps((*DO_NOT, *rest), dialogue)
        if len(steps) > 1 or (steps and steps[0].when):
            return None  # "If he dismisses it, don't go home, bring him the newspaper."
        asked_for = _asked_for(program, steps[0].forbidden) if steps else []
        if asked_for:
            return asked_for
        named = self._named(rest, program, dialogue)
        if named is not None:
            return [_Unwanted(named, frozenset(program.checkpoints[named].goals))]
        return None if rest[0] in _STATES else []

    def _named(self, said: Sequence[str], program: Automaton, dialogue: Dialogue) -> str | None:
        """The step that words name which don't say all of it: "bring the tray", wherever to."""
        for named in ((gerund(said[0]), *said[1:]), tuple(said)):
            text = " ".join((*_SKIP, *named))
            meant, _ = self._language.interpret(text, program, dialogue)
            gone = [e.checkpoint for e in meant.edits if isinstance(e, RemoveCheckpoint)]
            if len(gone) == 1:
                return gone[0]
        return None

    def _steps(self, tokens: Sequence[str], dialogue: Dialogue) -> Sequence[Step]:
        try:
            return self._changes.steps(tokens, dialogue)
        except Unclear:
            return []

    def _without(self, program: Automaton, this: _Unwanted, when: tuple[Literal, ...]) -> Reshaped:
        checkpoint, name = this.checkpoint, program.checkpoints[this.checkpoint].name
        there = program.checkpoints[checkpoint].goals
        kept = tuple(g for g in there if g not in this.goals)
        if kept:
            return [SetGoals(checkpoint, kept)], f"{name} is without that now", [checkpoint]
        incoming = program.incoming(checkpoint)
        if incoming is not None and incoming.when and not program.outgoing(checkpoint):
            # Nothing is done then; without a step there, what is would be waited for in vain.
            edits: list[Edit] = [SetGoals(checkpoint, ())]
            edits += self._language.names.renamed(program, checkpoint, (), incoming.when)
            return edits, "nothing is done then", [checkpoint]
        return removed(program, checkpoint), f"{name} is gone", []

    def _spared(self, program: Automaton, this: _Unwanted, when: tuple[Literal, ...]) -> Reshaped:
        found = program.checkpoints[this.checkpoint]
        if set(found.goals) - this.goals:
            raise EditError(
                f"{found.name} asks for more than that; say what should be done then instead."
            )
        return spared(program, this.checkpoint, when, self._language.names)


def _parted(tokens: Sequence[str]) -> Iterator[tuple[Sequence[str], Sequence[str]]]:
    """Ways to part a condition from the rest."""
    for at in range(len(tokens)):
        size = next((len(w) for w in _IF if tuple(tokens[at : at + len(w)]) == w), 0)
        if size and at:
            yield trimmed(tokens[at + size :]), tokens[:at]
        elif size:
            for end in range(size + 1, len(tokens) - 1):
                yield trimmed(tokens[size:end]), tokens[end:]


def _asked_for(program: Automaton, goals: Sequence[Goal]) -> list[_Unwanted]:
    """Where some goals are asked for, the latest step first."""
    wanted = frozenset(goals)
    made = [c for c in reversed(list(program.checkpoints)) if c != START]
    return [
        _Unwanted(c, wanted) for c in made if wanted and wanted <= set(program.checkpoints[c].goals)
    ]
