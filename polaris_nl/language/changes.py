"""Edits of what is there: corrections of the last step, and changes of checkpoints by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import (
    AddCheckpoint,
    Connect,
    Edit,
    InsertCheckpoint,
    MoveCheckpoint,
    RemoveCheckpoint,
    RenameCheckpoint,
    SetConditional,
    SetGoals,
    apply_all,
)
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.generate import goals_in_words
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.mention import Mention
from polaris_nl.language.patterns import Match, matches_of
from polaris_nl.language.queries import _condition
from polaris_nl.language.resolve import Misfit, Unclear
from polaris_nl.language.structure import Step, steps_of
from polaris_nl.model.errors import EditError
from polaris_nl.model.formula import Formula, Goal, Literal, bind
from polaris_nl.model.text import sentence

if TYPE_CHECKING:
    from polaris_nl.language.understanding import Understanding

Meant = tuple[Interpretation, Dialogue]


class Changes:
    """Reads corrections and edits for one `Understanding`."""

    def __init__(self, language: Understanding) -> None:
        self._language = language
        self._corrections = language.grammar.common.templates("corrections")

    # Corrections: "no, I meant the blue cup"

    def corrected(
        self,
        utterance: str,
        tokens: Sequence[str],
        mentions: Sequence[Sequence[Mention]],
        program: Automaton,
        dialogue: Dialogue,
    ) -> Meant | None:
        """A correction of what was just done, or None where the utterance is none."""
        touched = [c for c in dialogue.touched if c in program.checkpoints]
        plain = [t for t in tokens if t != ","]
        if plain != list(tokens):
            mentions = self._language.mentions(plain)
        for template in self._corrections:
            for match in matches_of("correct", template, plain, mentions, program, ()):
                if not touched:
                    continue
                result = self._replaced(utterance, match, touched, program, dialogue)
                if result is not None:
                    return result
        return None

    def _replaced(
        self,
        utterance: str,
        match: Match,
        touched: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> Meant | None:
        language = self._language
        new, old = match.slots.get("x"), match.slots.get("y")
        assert isinstance(new, Mention)
        try:
            meant = self._entities(new, touched, program, dialogue)
        except Unclear as unclear:
            return language.asked(utterance, unclear, dialogue)
        except Misfit:
            return None
        if len(meant) != 1:
            return None
        replaced = self._replaceable(meant[0], old, touched, program, dialogue)
        if replaced is None:
            return None
        edits = list(_swapped(program, touched, replaced, meant[0]))
        if not edits:
            return None
        after = replace(dialogue, scope=dialogue.scope.after(meant))
        say = sentence(
            f"I've put {language.wording.entity(meant[0])} in place of {language.wording.entity(replaced)}"
        )
        return Interpretation(utterance, "applied", say, tuple(edits)), after

    def _entities(
        self, mention: Mention, touched: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[str, ...]:
        """What is meant instead: "the other table" is not the one that is there."""
        resolver = self._language.resolver
        if not mention.other:
            return resolver.meant(
                replace(mention, pronoun="one") if mention.pronoun == "one" else mention,
                (),
                dialogue.scope,
            ).entities
        used = _used(program, touched)
        fitting = [c.entity for c in mention.candidates if c.entity not in used]
        if mention.candidates and not fitting:
            raise Misfit("There is no other one.")
        kept = replace(
            mention,
            other=False,
            candidates=tuple(c for c in mention.candidates if c.entity not in used),
        )
        return resolver._one(
            [c.entity for c in kept.candidates], kept, replace(dialogue.scope, referents=())
        ).entities

    def _replaceable(
        self, new: str, old: object, touched: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> str | None:
        """The entity that a correction is about: the one named, or the latest of the same type."""
        world = self._language.world
        used = [u for u in _used(program, touched) if u in world.entities]
        if isinstance(old, Mention):
            named = {c.entity for c in old.candidates}
            chosen = [u for u in used if u in named]
            if old.pronoun == "one":
                chosen = [u for u in used if world.entities[u].type == world.entities[new].type]
            return chosen[0] if chosen else None
        kind, noun = world.entities[new].type, world.entities[new].noun
        same = [u for u in used if world.entities[u].type == kind and u != new]
        nouns = [u for u in same if noun and (world.entities[u].noun == noun or u == noun)]
        return next(iter(nouns or same), None)

    # Edits: "rename fetched to served", "before home, open the cupboard"

    def edited(
        self,
        utterance: str,
        matches: Iterable[Match],
        tokens: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> Meant | None:
        """An edit of checkpoints that are there, or None where the utterance is none."""
        for match in matches:
            try:
                edits, say, touched = self._edits(match, tokens, program, dialogue)
            except Unclear as unclear:
                return self._language.asked(utterance, unclear, dialogue)
            except Misfit:
                continue
            try:
                changed = apply_all(program, edits)
            except EditError as error:
                return self._language.refused(utterance, str(error)), dialogue
            if changed == program:
                return Interpretation(
                    utterance, "answer", "It is like that already; nothing changes."
                ), dialogue
            kept = tuple(t for t in touched if t in changed.checkpoints)
            here = _going_on(kept, program, changed, dialogue)
            after = replace(dialogue, here=here, touched=kept)
            return Interpretation(utterance, "applied", sentence(say), tuple(edits)), after
        return None

    def _edits(
        self, match: Match, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[list[Edit], str, list[str]]:
        """The edits of a match, what to say, and the checkpoints they touch.

        Raises:
            Misfit: the match is not what was meant.
            Unclear: a question has to be asked.
        """
        slots = match.slots
        if "k" not in slots:
            raise Misfit("")
        this = str(slots["k"])
        name = program.checkpoints[this].name
        if match.intent == "remove":
            alone = [RemoveCheckpoint(this, subtree=False)]
            return list(alone), f"{name} is gone", []
        if match.intent == "rename":
            span = slots["n"]
            assert isinstance(span, tuple)
            wanted = " ".join(tokens[span[0] : span[1]])
            return [RenameCheckpoint(this, wanted)], f"{name} is called {wanted} now", [this]
        if match.intent == "move":
            other = str(slots["l"])
            after = program.checkpoints[other].name
            return [MoveCheckpoint(this, other)], f"{name} comes after {after} now", [this]
        if match.intent == "connect":
            return self._connected(match, tokens, program, dialogue)
        if match.intent == "else":
            incoming = program.incoming(this)
            if incoming is None:
                raise Misfit("")
            return [SetConditional(incoming.id, ())], f"{name} is what happens otherwise", [this]
        goals, when = self._goals(tokens, slots.get("g"), program, dialogue)
        return self._with_goals(match.intent, this, goals, when, program)

    def _with_goals(
        self,
        intent: str,
        this: str,
        goals: tuple[Goal, ...],
        when: tuple[Literal, ...],
        program: Automaton,
    ) -> tuple[list[Edit], str, list[str]]:
        language = self._language
        name = program.checkpoints[this].name
        words = goals_in_words(goals, language.wording)
        new = Checkpoint(
            program.fresh_checkpoint_id(), language.names.checkpoint(goals, when, program), goals
        )
        arrow = program.fresh_transition_id()
        if intent == "replace":
            return [SetGoals(this, goals)], f"in {name}: {words}", [this]
        if intent == "also":
            kept = program.checkpoints[this].goals
            return [SetGoals(this, (*kept, *goals))], f"in {name}, also {words}", [this]
        if intent == "before":
            incoming = program.incoming(this)
            if incoming is None:
                raise Misfit("")
            return (
                [InsertCheckpoint(new, incoming.id, arrow, when)],
                f"before {name}, {words}",
                [new.id],
            )
        outgoing = program.outgoing(this)
        if len(outgoing) == 1 and not outgoing[0].when and not when:
            return (
                [InsertCheckpoint(new, outgoing[0].id, arrow)],
                f"after {name}, {words}",
                [new.id],
            )
        return (
            [AddCheckpoint(new, Transition(arrow, this, new.id, when))],
            f"after {name}, {words}",
            [new.id],
        )

    def _connected(
        self, match: Match, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[list[Edit], str, list[str]]:
        source, target = str(match.slots["k"]), str(match.slots["l"])
        when: tuple[Literal, ...] = ()
        if "f" in match.slots:
            when = _condition(self._language, tokens, match.slots["f"], dialogue.scope)
            if not when:
                raise Misfit("")
        one, two = program.checkpoints[source].name, program.checkpoints[target].name
        incoming = program.incoming(target)
        say = f"{two} comes after {one} now"
        if incoming is None:
            return (
                [Connect(Transition(program.fresh_transition_id(), source, target, when))],
                say,
                [target],
            )
        if incoming.source == source:
            return [SetConditional(incoming.id, when)], say, [target]
        return [MoveCheckpoint(target, source, when)], say, [target]

    def _goals(
        self, tokens: Sequence[str], span: object, program: Automaton, dialogue: Dialogue
    ) -> tuple[tuple[Goal, ...], tuple[Literal, ...]]:
        assert isinstance(span, tuple)
        part = list(tokens[span[0] : span[1]])
        question: Unclear | None = None
        for cut in self._language.cuts(part):
            if cut.unknown:
                continue
            try:
                steps, _ = steps_of(cut, self._language.resolver, dialogue.scope)
            except Misfit:
                continue
            except Unclear as unclear:
                question = question or unclear
                continue
            if steps and all(_plain(s) for s in steps[1:]) and steps[0].goals:
                return tuple(g for s in steps for g in s.goals), steps[0].when
        if question is not None:
            raise question
        raise Misfit("")


def _going_on(
    touched: Sequence[str], program: Automaton, changed: Automaton, dialogue: Dialogue
) -> str | None:
    """Where the next step goes: after a new step or a last one, else where it would have gone."""
    latest = touched[-1] if touched else None
    if latest is not None and (latest not in program.checkpoints or not changed.outgoing(latest)):
        return latest
    return dialogue.here if dialogue.here in changed.checkpoints else None


def _plain(step: Step) -> bool:
    return not step.when and step.role == "then"


def _used(program: Automaton, touched: Sequence[str]) -> list[str]:
    """The entities in some checkpoints' goals, the latest checkpoint's first, each once."""
    found: dict[str, None] = {}
    for checkpoint in reversed(touched):
        for goal in program.checkpoints[checkpoint].goals:
            for arg in _args(goal):
                found[arg] = None
        incoming = program.incoming(checkpoint)
        for literal in incoming.when if incoming else ():
            for arg in literal.args:
                found.setdefault(arg)
    return list(found)


def _args(goal: Formula) -> Iterator[str]:
    from polaris_nl.model.formula import literals_in

    for literal in literals_in(goal):
        yield from literal.args


def _swapped(program: Automaton, touched: Sequence[str], old: str, new: str) -> Iterator[Edit]:
    """The edits that put one entity in another's place."""
    for checkpoint in touched:
        if checkpoint == START:
            continue
        goals = program.checkpoints[checkpoint].goals
        changed = tuple(bind(g, {old: new}) for g in goals)
        if changed != goals:
            yield SetGoals(checkpoint, changed)
        incoming = program.incoming(checkpoint)
        if incoming is not None:
            when = tuple(x.bind({old: new}) for x in incoming.when)
            if when != incoming.when:
                yield SetConditional(incoming.id, when)
