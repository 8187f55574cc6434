"""Reads utterances that ask for steps: tries the cheapest ways to cut them, and says why none can be."""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.language.cores import DO_NOT
from polaris_nl.language.dialogue import Dialogue, Pending
from polaris_nl.language.elsewhere import put_elsewhere
from polaris_nl.language.generate import steps_in_words
from polaris_nl.language.interpretation import Interpretation, Question, Reading
from polaris_nl.language.protocol import Language
from polaris_nl.language.reading import steps_of
from polaris_nl.language.refusals import Refusals
from polaris_nl.language.reordering import asked_anew, in_front_of, says_order, there_already
from polaris_nl.language.repair import Repairs
from polaris_nl.language.scope import Misfit, Scope, Unclear
from polaris_nl.language.segment import Cut, Item
from polaris_nl.language.structure import Builder, Step
from polaris_nl.language.tokens import BREAK, COMMA, phrase, words
from polaris_nl.model.text import sentence

AS_IT_IS = "It is like that already; nothing changes."
ONLY_WHILE = (
    "I can't keep from something only for a while; say when it should be done: "
    '"only go home if ...".'
)
_GOING_ON = frozenset(("then", "next", "afterwards", "after"))
"""Words by which steps go on after the latest one."""
_ORDER = frozenset(("before", "after"))
"""Words by which what is to be done is put in order."""
MOST_REPAIRED = 60
"""Words up to which self-repairs are looked for."""
QUESTION_COST = 1.5
"""How much dearer a reading that needs a question may not be than one that needs none."""


@dataclass(frozen=True, slots=True)
class _Tried:
    """What one way to cut an utterance comes to; `meant` is None where it can't be."""

    cut: Cut
    cost: float
    text: str
    meant: Interpretation | None
    after: Dialogue


class Statements:
    """Reads steps for the language side of one world.

    Args:
        language: its other parts.
        repairs: mends false starts.
        refusals: says what isn't understood.
        known: whether a word is one of the grammar's or the world's.
    """

    def __init__(
        self,
        language: Language,
        repairs: Repairs,
        refusals: Refusals,
        known: Container[str],
    ) -> None:
        self._language = language
        self._repairs = repairs
        self._refusals = refusals
        self._known = known
        refused = language.grammar.common.refused
        self._refused_phrases = [(phrase(words), why) for words, why in refused.items()]

    def read(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """Reads tokens as steps of the program."""
        cuts = self._language.cuts(tokens)
        good = _understood(cuts, self._language.verbs.imperatives)
        for banned, reason in self._refused_phrases:
            if _says(tokens, banned) and not (good and _only_told(good[0], banned)):
                return self._language.refused(utterance, reason, (" ".join(banned),)), dialogue
        if "while" in tokens and _says(tokens[: tokens.index("while")], DO_NOT):
            return self._language.refused(utterance, ONLY_WHILE), dialogue
        mendable = len(tokens) <= MOST_REPAIRED
        mentions = self._language.mentions(tokens) if mendable else []
        best = None
        if mendable:
            corrected = self._repairs.corrections(tokens, mentions)
            best = self._first(utterance, corrected, program, dialogue)
        best = best or self._best(utterance, good, program, dialogue)
        if best is not None and best[0].outcome == "question" and mendable:
            plain = self._first(
                utterance, [self._repairs.without_fillers(tokens)], program, dialogue
            )
            best = plain if plain is not None and plain[0].outcome == "applied" else best
        if best is None and mendable:
            candidates = self._repairs.candidates(tokens, mentions)
            best = self._first(utterance, candidates, program, dialogue)
        if best is not None:
            return best
        if good and _only_conditions(good[0]):
            return self._asked_then(utterance, dialogue)
        return self._not_understood(utterance, cuts, tokens, good, program, dialogue), dialogue

    def _first(
        self,
        utterance: str,
        candidates: Iterable[Sequence[str]],
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[Interpretation, Dialogue] | None:
        """What the first of several candidates means that is understood, or None."""
        for tokens in candidates:
            best = self._best(
                utterance,
                _understood(self._language.cuts(tokens), self._language.verbs.imperatives),
                program,
                dialogue,
            )
            if best is not None:
                return best
        return None

    def _best(
        self, utterance: str, cuts: Sequence[Cut], program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue] | None:
        """The cheapest reading that can be, with its rivals, or None."""
        results = sorted(self._tried(utterance, cuts, program, dialogue), key=lambda r: r.cost)
        best = next((r for r in results if r.meant is not None), None)
        if best is None or best.meant is None:
            return None
        ranked = (best, *(r for r in results if r is not best))
        readings = tuple(
            Reading(r.text, -r.cost, tuple(f"{i.mark or i.role}: {i.text}" for i in r.cut.items))
            for r in ranked
        )
        return replace(best.meant, readings=readings), best.after

    def _tried(
        self, utterance: str, cuts: Sequence[Cut], program: Automaton, dialogue: Dialogue
    ) -> Iterator[_Tried]:
        for cut in cuts:
            builder = self._builder(program, dialogue)
            try:
                steps, scope = self._steps(cut, builder, dialogue, utterance)
            except Misfit as misfit:
                yield _Tried(cut, cut.cost, f"can't be: {misfit}", None, dialogue)
                continue
            except Unclear as unclear:
                meant, after = self._language.asked(utterance, unclear, dialogue)
                yield _Tried(cut, cut.cost + QUESTION_COST, f"asks: {meant.say}", meant, after)
                continue
            if not steps:
                continue
            if not builder.edits:
                meant = Interpretation(utterance, "answer", AS_IT_IS)
                yield _Tried(cut, cut.cost, AS_IT_IS, meant, dialogue)
                continue
            after = replace(
                dialogue,
                here=builder.here,
                touched=tuple(builder.touched),
                anchor=builder.anchor,
                scope=scope,
            )
            say = steps_in_words(steps, self._language.wording)
            if builder.reordered:
                how = "In another order:" if len(steps) > 1 else "First of all,"
                say = f"{how} {say[:1].lower()}{say[1:]}"
            elif builder.changed:
                say = sentence(builder.changed)
            aside = tuple(i.text for i in cut.items if i.role in ("topic", "fact"))
            meant = Interpretation(utterance, "applied", say, tuple(builder.edits), aside=aside)
            yield _Tried(cut, cut.cost, say, meant, after)

    def _steps(
        self, cut: Cut, builder: Builder, dialogue: Dialogue, utterance: str
    ) -> tuple[list[Step], Scope]:
        """The steps of a cut utterance, put into the program.

        Raises:
            Unclear: a question has to be asked.
            Misfit: the reading can't be.
        """
        branched = builder.anchor is not None
        latest = builder.program.checkpoints[builder.here].goals
        steps, scope = steps_of(cut, self._language.resolver, dialogue.scope, branched, latest)
        order = _in_order(cut, steps, builder.program, utterance)
        if order is not None:
            builder.put_in_order(order)
            return steps, scope
        other = _leading_up_to(cut, steps, builder, utterance)
        if other is not None:
            builder.put_in_front(steps[:-1], other)
            return steps, scope
        elsewhere = put_elsewhere(self._language, cut, steps, builder.program, utterance)
        if elsewhere is not None:
            builder.change(*elsewhere)
            return steps, scope
        whether = any(i.mark == "if" and i.text.split()[-1] == "if" for i in cut.items)
        builder.anew = whether or asked_anew(words(utterance))
        for step in steps:
            builder.add(step)
        return steps, scope

    def _builder(self, program: Automaton, dialogue: Dialogue) -> Builder:
        here = dialogue.here if dialogue.here in program.checkpoints else None
        if here is None:
            leaves = [c for c in program.checkpoints if not program.outgoing(c)]
            here = leaves[-1] if leaves else START
        anchor = dialogue.anchor if dialogue.anchor in program.checkpoints else None
        if anchor is None:
            anchor = next((t.source for t in reversed(program.path(here)) if t.when), None)
        return Builder(self._language.world, self._language.names, program, here, anchor)

    def _not_understood(
        self,
        utterance: str,
        cuts: Sequence[Cut],
        tokens: Sequence[str],
        good: Sequence[Cut],
        program: Automaton,
        dialogue: Dialogue,
    ) -> Interpretation:
        for cut in good:
            try:
                self._steps(cut, self._builder(program, dialogue), dialogue, utterance)
            except Misfit as misfit:
                return self._language.refused(utterance, str(misfit))
            except Unclear:
                continue
        told = next((c for c in cuts if not c.unknown and _only_tells(c)), None)
        if told is not None:
            return self._language.refused(utterance, self._refusals.told())
        unknown = self._refusals.unknown(tokens, cuts[0].unknown if cuts else tuple(tokens))
        reason = self._refusals.misfit(tokens, self._language.mentions(tokens))
        if reason and not any(word not in self._known for word in unknown):
            return self._language.refused(utterance, reason)
        return self._language.refused(
            utterance, self._refusals.reason(tokens, unknown, cuts), unknown
        )

    def _asked_then(self, utterance: str, dialogue: Dialogue) -> tuple[Interpretation, Dialogue]:
        """What a condition that came alone still needs."""
        about = "What should I do then?"
        meant = Interpretation(utterance, "question", about, question=Question(about))
        return meant, replace(dialogue, pending=Pending(utterance, "", kind="then"))


def _in_order(
    cut: Cut, steps: Sequence[Step], program: Automaton, utterance: str
) -> tuple[str, ...] | None:
    """The steps that are only put in another order, or None where something is new; one alone comes first."""
    said = [w for item in cut.items for w in item.text.split()]
    if not says_order(said) or asked_anew(words(utterance)):
        return None
    if any(step.role != "then" or step.when for step in steps):
        return None
    wanted = [step.goals for step in steps]
    if len(wanted) == 1:
        wanted += [program.checkpoints[c].goals for c in program.children(START)[:1]]
    return there_already(program, wanted)


def _leading_up_to(cut: Cut, steps: Sequence[Step], builder: Builder, utterance: str) -> str | None:
    """The checkpoint that new steps are to come before: the last of what is asked for, there already."""
    said = [w for w in words(utterance) if w not in (BREAK, COMMA)]
    if asked_anew(said) or _GOING_ON.intersection(said[:2]):
        return None
    if any(s.role not in ("then", "condition") or s.sequel for s in steps):
        return None
    if any(step.when for step in steps[1:]):
        return None
    program, when = builder.program, steps[0].when
    before = any(item.mark == "before" for item in cut.items)
    found = in_front_of(program, [s.goals for s in steps], builder.here, before or bool(when))
    incoming = program.incoming(found) if found is not None else None
    if when and (incoming is None or incoming.conditional != set(when)):
        return None
    return found


def _understood(cuts: Sequence[Cut], verbs: Collection[str]) -> list[Cut]:
    """The cuts that account for every word and ask for something."""
    return [
        cut
        for cut in cuts
        if not cut.unknown
        and _says_something(cut)
        and not any(_is_in_order(item, verbs) for item in cut.items)
    ]


def _is_in_order(item: Item, verbs: Collection[str]) -> bool:
    """Whether what seems only named is put in order: "before that put the knife in", "before the plate"."""
    first, *rest = item.text.split()
    if item.role != "topic" or first not in _ORDER:
        return False
    named = item.mention.parts if item.mention is not None else ()
    alone = any(thing.candidates and thing.end - thing.start == len(rest) for thing in named)
    return alone or bool(set(rest).intersection(verbs))


def _says_something(cut: Cut) -> bool:
    return any(
        item.role in ("goal", "condition", "again") or item.mark == "nothing" for item in cut.items
    )


def _only_conditions(cut: Cut) -> bool:
    """Whether a cut is "if ..." with nothing to do."""
    marks = {item.mark for item in cut.items}
    roles = {item.role for item in cut.items}
    waits = not marks & {"until", "else"} and roles <= {"condition", "mark", "fact"}
    return bool(marks & {"if", "unless"}) and waits


def _says(tokens: Sequence[str], phrase: Sequence[str]) -> bool:
    """Whether words stand somewhere in a row."""
    size = len(phrase)
    return any(tuple(tokens[at : at + size]) == tuple(phrase) for at in range(len(tokens)))


def _only_told(cut: Cut, phrase: Sequence[str]) -> bool:
    """Whether words are in nothing that is asked for: "she always forgets, so ..."."""
    asked = (item.text.split() for item in cut.items if item.role not in ("topic", "fact"))
    return not any(_says(words, phrase) for words in asked)


def _only_tells(cut: Cut) -> bool:
    return any(item.role == "fact" for item in cut.items) and not _says_something(cut)
