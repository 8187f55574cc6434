"""What waits for something from now on, or no longer, and what is done where something else holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import Edit, SetConditional, SetGoals, apply, apply_all
from polaris_nl.language.changes import NOTHING_CHANGES, Changes, MeantThen
from polaris_nl.language.cores import DO_NOT, Core
from polaris_nl.language.dialogue import Dialogue, Latest
from polaris_nl.language.exchange import used_in
from polaris_nl.language.generate import goals_in_words, steps_in_words
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.protocol import Language
from polaris_nl.language.reshaping import removed
from polaris_nl.language.retractions import never_then, waits
from polaris_nl.language.scope import Unclear
from polaris_nl.language.structure import Builder, Step
from polaris_nl.language.tokens import BREAK, COMMA, PhraseSet, words
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import sentence

_OR = (("or", "else"), ("or",), ("alternatively",), ("or", "alternatively"))
"""Words that lead to another way on."""
_ANYWAY = (
    ("wherever",), ("whatever",), ("regardless",), ("whether", "or", "not"), ("in", "any", "case"),
    ("either", "way"), ("no", "matter"), ("anyway",),
)  # fmt: skip
"""Words by which what is there waits for nothing any more."""
_NEXT = frozenset(("then", "afterwards", "next", "after", "later"))
"""Words that something is begun with that comes on top of what is there."""
_OTHERWISE_THEN = frozenset(("not", "rather", "instead", "sooner"))
"""Words by which something else is to be done where something holds."""
_SURELY = ("actually", "really", "also", "still", "indeed", "definitely", "certainly")
"""Words that stress a condition."""
_LIMITING = frozenset(("only", "wait"))
"""Words by which what is there waits for something."""


class Waiting:
    """Reads changes of conditions for the language side of one world."""

    def __init__(self, language: Language, changes: Changes) -> None:
        self._language = language
        self._changes = changes

    def limited(
        self, utterance: str, core: Core, program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        """`only go home if she dismisses it`, where going home was asked for already: now it waits for that."""
        spoken = words(utterance)
        if not _LIMITING.intersection(spoken) or _NEXT.intersection(spoken[:2]):
            return None
        said = [w for w in core.tokens if w not in _SURELY]
        if said[-1:] in (["mind"], ["though"]) and "never" not in said:
            said = said[:-1]
        steps = self._changes.steps(said, dialogue)
        if not steps or not (steps[0].when and steps[0].goals):
            return None
        first, *rest = steps
        if any(step.role != "else" for step in rest):
            return None
        alike = [c for c, x in program.checkpoints.items() if set(x.goals) == set(first.goals)]
        others = [c for c in alike if never_then(program, c, first.when)]
        if others and any(waits(program, c, first.when) for c in alike):
            say = f"{goals_in_words(first.goals, self._language.wording)} only then"
            edits = [edit for c in others for edit in removed(program, c)]
            return applied(self._language, utterance, edits, say, program, dialogue, ())
        for arrow in reversed(list(program.transitions.values())):
            there = set(program.checkpoints[arrow.target].goals)
            if there == set(first.goals) and arrow.conditional < set(first.when):
                limit: Edit = SetConditional(arrow.id, first.when)
                builder = self._builder(apply(program, limit), arrow.target, arrow.source)
                for step in rest:
                    builder.add(step)
                say = steps_in_words(steps, self._language.wording)
                edits = [limit, *builder.edits]
                touched = [arrow.target, *builder.touched]
                return applied(self._language, utterance, edits, say, program, dialogue, touched)
        return None

    def anyway(
        self, utterance: str, core: Core, program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        """`give it to her wherever she is`, where that waits for something: now it doesn't."""
        said = self._said_anyway(core.tokens)
        try:
            steps = self._changes.steps(said, dialogue) if said else []
        except Unclear:
            return None
        if len(steps) != 1 or steps[0].when or not steps[0].goals:
            return None
        for arrow in reversed(list(program.transitions.values())):
            there = set(program.checkpoints[arrow.target].goals)
            if arrow.when and there == set(steps[0].goals):
                say = f"{goals_in_words(steps[0].goals, self._language.wording)} in any case"
                edits = [SetConditional(arrow.id, ())]
                return applied(
                    self._language, utterance, edits, say, program, dialogue, [arrow.target]
                )
        return None

    def _said_anyway(self, tokens: tuple[str, ...]) -> tuple[str, ...]:
        """What is to be done without waiting any more, or () where nothing is."""
        if tokens[:2] == DO_NOT and tokens[2:3] in (("wait",), ("check",)):
            # "Don't wait for her answer, fill it straight away."
            plain = [t for t in tokens if t not in (BREAK, COMMA, "just")]
            plain = plain[:-2] if plain[-2:] in (["straight", "away"], ["right", "away"]) else plain
            rests = (plain[at:] for at in range(3, len(plain) - 1))
            return next((tuple(rest) for rest in rests if self._language.asks_for(rest)), ())
        for at in range(2, len(tokens)):
            if any(tokens[at : at + len(phrase)] == phrase for phrase in _ANYWAY):
                return tokens[:at]
            if tokens[at] == "whether" and tokens[-2:] == ("or", "not"):
                return tokens[:at]
        return ()

    def done_then(
        self, utterance: str, core: Core, program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        """`if she dismisses it don't go home, go to the hall`, where going home was asked for then."""
        spoken = words(utterance)
        if core.tokens[:2] == DO_NOT or not _OTHERWISE_THEN.intersection(spoken):
            return None
        steps = self._changes.steps(core.tokens, dialogue)
        if len(steps) == 1 and steps[0].when and steps[0].goals and "not" not in spoken:
            return self._then_instead(utterance, steps[0], program, dialogue)
        if len(steps) != 2 or not (steps[0].when and steps[1].goals):
            return None
        denied = [g for g in steps[0].goals if isinstance(g, Literal) and not g.positive]
        wrong = {g.negation for g in denied}
        for arrow in program.transitions.values():
            there = program.checkpoints[arrow.target].goals
            if arrow.conditional == set(steps[0].when) and wrong & set(there):
                goals = (*(g for g in there if g not in wrong), *steps[1].goals)
                names = self._language.names.renamed(program, arrow.target, goals, arrow.when)
                say = f"{goals_in_words(steps[1].goals, self._language.wording)} instead"
                edits: list[Edit] = [SetGoals(arrow.target, goals), *names]
                return applied(
                    self._language, utterance, edits, say, program, dialogue, [arrow.target]
                )
        return None

    def _then_instead(
        self, utterance: str, step: Step, program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        for arrow in program.transitions.values():
            if arrow.when and arrow.conditional == set(step.when):
                names = self._language.names.renamed(program, arrow.target, step.goals, arrow.when)
                say = f"{goals_in_words(step.goals, self._language.wording)} instead"
                edits: list[Edit] = [SetGoals(arrow.target, step.goals), *names]
                return applied(
                    self._language, utterance, edits, say, program, dialogue, [arrow.target]
                )
        return None

    def other_way(
        self,
        utterance: str,
        words: Sequence[str],
        touched: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> MeantThen | None:
        """`or if she's in, ...`, `if she's in, go to the hall instead of home`: beside what is done else."""
        start = next((len(w) for w in _OR if tuple(words[: len(w)]) == w), 0)
        contrast = PhraseSet(self._language.grammar.common.contrast)
        end = next((i for i in range(1, len(words)) if contrast.length_at(words, i)), len(words))
        if not touched or not (start or end < len(words)):
            return None
        steps = self._changes.steps(words[start:end], dialogue)
        if len(steps) != 1 or not (steps[0].when and steps[0].goals):
            return None
        wanted = set(steps[0].when)
        if any(arrow.conditional == wanted for arrow in program.transitions.values()):
            return None
        named = {
            c.entity for m in self._language.mentions(words[end:]) for x in m for c in x.candidates
        }
        made = (*reversed(touched), *reversed([c for c in program.checkpoints if c != START]))
        place = next(
            (c for c in made if end == len(words) or named & set(used_in(program, [c]))), None
        )
        incoming = program.incoming(place) if place is not None else None
        if incoming is None or (incoming.when and not start):
            return None
        return self.beside(utterance, steps[0], incoming.source, program, dialogue)

    def beside(
        self, utterance: str, step: Step, source: str, program: Automaton, dialogue: Dialogue
    ) -> MeantThen:
        """Another way on from a checkpoint: "if it's open, take it to the sink instead"."""
        builder = self._builder(program, source)
        builder.add(step)
        say = steps_in_words([step], self._language.wording)
        meant, after = applied(
            self._language, utterance, builder.edits, say, program, dialogue, builder.touched
        )
        return meant, replace(after, here=builder.here, anchor=builder.anchor)

    def _builder(self, program: Automaton, here: str, anchor: str | None = None) -> Builder:
        return Builder(self._language.world, self._language.names, program, here, anchor)


def applied(
    language: Language,
    utterance: str,
    edits: Sequence[Edit],
    say: str,
    program: Automaton,
    dialogue: Dialogue,
    touched: Sequence[str],
) -> MeantThen:
    """What edits of what is there come to, and the dialogue after them.

    Args:
        language: names of things.
        utterance: what was said.
        edits: the edits; none for what is like that already.
        say: what they do in words.
        program: what is there.
        dialogue: what was said before.
        touched: the checkpoints that what is said next may be about.
    """
    if not edits:
        return Interpretation(utterance, "answer", say), dialogue
    changed = apply_all(program, edits)
    if changed == program:
        return Interpretation(utterance, "answer", NOTHING_CHANGES), dialogue
    corrected = {e.checkpoint for e in edits if isinstance(e, SetGoals)}
    known = [a for c in corrected for a in used_in(changed, [c])]
    entities = language.world.entities
    scope = dialogue.scope
    for name in (k for k in reversed(known) if k in entities and k not in scope.referents[-1:]):
        scope = scope.after((name,)) if name not in used_in(program, corrected) else scope
    kept = tuple(c for c in touched if c in changed.checkpoints) or tuple(corrected)
    latest = Latest((), program, changed, replace(dialogue, latest=None), "correct")
    after = replace(dialogue, scope=scope, touched=kept, latest=latest)
    return Interpretation(utterance, "applied", sentence(say), tuple(edits)), after
