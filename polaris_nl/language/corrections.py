"""Corrections of what was just done: "no, I meant the blue cup", "no, close it", "not the fridge, the sink"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import (
    Edit,
    RemoveCheckpoint,
    RenameCheckpoint,
    SetConditional,
    SetGoals,
)
from polaris_nl.language.another_condition import another_condition
from polaris_nl.language.changes import (
    NO_STEPS,
    NOTHING_CHANGES,
    NOTHING_OF_THAT,
    Changes,
    MeantThen,
    steps_there,
)
from polaris_nl.language.choosing import Choosing
from polaris_nl.language.clauses import pronoun_types
from polaris_nl.language.conditions import condition_in
from polaris_nl.language.contrasted import only_these, put_instead
from polaris_nl.language.cores import AROUND, DO_NOT, NEEDLESS, Core, Cores, trimmed
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.each_way import each_way
from polaris_nl.language.elsewhere import exchanged_places, taken_there
from polaris_nl.language.excepting import Excepting
from polaris_nl.language.exchange import exchanged, used_in, without
from polaris_nl.language.generate import goals_in_words, steps_in_words
from polaris_nl.language.goal_relations import flat
from polaris_nl.language.mention import Mention
from polaris_nl.language.patterns import Match, Patterns
from polaris_nl.language.protocol import Language
from polaris_nl.language.references import References, meant
from polaris_nl.language.rereading import Rereading
from polaris_nl.language.reshaping import removed
from polaris_nl.language.retractions import negated, place_of
from polaris_nl.language.scope import Misfit, Unclear
from polaris_nl.language.tokens import words
from polaris_nl.language.waiting import Waiting, applied
from polaris_nl.model.errors import EditError
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import listed, sentence

WHAT_INSTEAD = "I don't see what should be changed; say what you meant, or undo."
_MORE = ("also", "too", "as well", "again")
"""Words of a sentence that adds to what was said, however it starts."""
_PLEASE, _INSTEAD = "please", "instead"
_LIMITS = frozenset(("while", "whilst", "unless"))
_ON = ("and", "but", "then", "please")
"""Words between what isn't wanted and what is."""


class Corrections:
    """Reads corrections for the language side of one world."""

    def __init__(self, language: Language, changes: Changes, references: References) -> None:
        self._language = language
        self._changes = changes
        self._references = references
        common = language.grammar.common
        intents = common.of_kind("correction")
        cores = Cores(language.grammar.common, references.verbs)
        self.core = cores.core
        self._exceptions = Excepting(language, changes, cores)
        rest = [intent for intent in intents if intent.name not in (*AROUND, NEEDLESS)]
        self._patterns = Patterns(rest, references, common.numbers)
        self._choosing = Choosing(language)
        self._again = Rereading(language, references)
        self._conditions = Waiting(language, changes)

    def corrected(
        self, utterance: str, core: Core, program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        """A correction of what was just done, or None where the utterance is none."""
        touched = [c for c in dialogue.touched if c in program.checkpoints and c != START]
        if len(program.checkpoints) == 1 and dialogue.latest is None:
            return None
        if any(w in core.tokens for w in _MORE):
            return None
        core = replace(core, tokens=tuple(w for w in core.tokens if w != _PLEASE) or core.tokens)
        try:
            return self._corrected(utterance, core, touched, program, dialogue)
        except Unclear as unclear:
            return self._language.asked(utterance, unclear, dialogue)
        except EditError as error:
            return self._language.refused(utterance, sentence(str(error))), dialogue

    def _corrected(
        self,
        utterance: str,
        core: Core,
        touched: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> MeantThen | None:
        words = core.words
        if core.strength and words[:1] == ["about"] and len(words) > 1:
            thing = " ".join(words[1:])
            reason = f'What about {thing}? Say what should be done, or "leave out {thing}".'
            return self._language.refused(utterance, reason), dialogue
        if core.strength and (again := self._again.edited(utterance, words, program, dialogue)):
            return again
        excepted = self._exceptions.excepted(utterance, core.tokens, program, dialogue)
        if excepted is not None:
            return excepted
        always = each_way(self._language, self._changes, utterance, program, dialogue)
        if always is not None:
            return always
        other = self._conditions.other_way(utterance, words, touched, program, dialogue)
        if other is not None:
            return other
        mentions = self._language.mentions(words)
        instead = put_instead(self._language, self._changes, words, touched, program, dialogue)
        if instead is None:
            instead = only_these(self._language, utterance, touched, program, dialogue)
        if instead is not None:
            return applied(self._language, utterance, *instead, program, dialogue, touched)
        question: Unclear | None = None
        for match in self._patterns.matches(words, mentions, program, touched):
            if match.intent.startswith("correct-") and not core.strength and "y" not in match.slots:
                continue
            if (
                match.intent == "leave-out"
            ):  # "Remove home" means the step of that name, if there is one.
                edited = self._language.edited(utterance, core.tokens, program, dialogue)
                if edited is not None:
                    return edited
            try:
                found = self._matched(match, core, touched, program, dialogue)
            except Misfit:
                continue
            except Unclear as unclear:
                question = question or unclear
                continue
            if found is not None:
                return applied(self._language, utterance, *found, program, dialogue, touched)
        if question is not None:
            raise question
        if core.tokens[:2] == DO_NOT:
            taken = self._conditions.anyway(utterance, core, program, dialogue) or self._taken_back(
                utterance, core, program, dialogue
            )
            if taken is not None or not core.strength or core.needless:
                return taken
        limited = (
            self._conditions.limited(utterance, core, program, dialogue)
            or self._conditions.anyway(utterance, core, program, dialogue)
            or self._conditions.done_then(utterance, core, program, dialogue)
        )
        if limited is not None or not core.strength:
            return limited
        edited = self._language.edited(utterance, core.tokens, program, dialogue)
        if edited is not None:
            return edited
        condition = another_condition(self._language, core.words, touched, program, dialogue)
        if condition is not None:
            return applied(self._language, utterance, *condition, program, dialogue, touched)
        return self._sentence(utterance, core, touched, program, dialogue)

    def _matched(
        self,
        match: Match,
        core: Core,
        touched: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[list[Edit], str] | None:
        if match.intent == "correct-number":
            return self._again.counted(match, program, dialogue)
        if match.intent == "correct-other":
            return self._choosing.another(match.slots.get("y"), touched, program, dialogue)
        where = list(touched)
        rest = [c for c in reversed(list(program.checkpoints)) if c != START and c not in touched]
        if "k" in match.references:
            where = [meant(match.references["k"], match.tokens, program, dialogue.scope)]
            rest = []
        if "f" in match.slots:
            where, rest = self._waiting(match, program, dialogue), []
        if match.intent == "leave-out":
            return self._left_out(match, where, rest, program, dialogue)
        new, old = match.slots["x"], match.slots.get("y")
        assert isinstance(new, Mention)
        if isinstance(old, Mention) and pronoun_types(old.pronoun) == ("person",):
            old = None  # "Not him": whoever of that kind was just spoken of.
        entities, everything = self._choosing.entities(new, old, where, program, dialogue)
        if old is None and set(entities) <= set(used_in(program, where)):
            return [], NOTHING_CHANGES
        for number, group in enumerate(self._groups(where, rest, old)):
            replaced = self._choosing.replaceable(
                entities[0], old, group, program, convert=number == 0
            )
            if replaced is None:
                continue
            if entities == (replaced,) and everything is None:
                return [], NOTHING_CHANGES
            domain, names = self._language.world, self._language.names
            edits = list(exchanged(program, group, replaced, entities, everything, domain, names))
            if edits:
                wording = self._language.wording
                put = listed([wording.entity(e) for e in entities])
                return edits, f"I've put {put} in place of {wording.entity(replaced)}"
        return None

    def _waiting(self, match: Match, program: Automaton, dialogue: Dialogue) -> list[str]:
        """The steps that wait for something: "if she dismisses it, go to the hall instead of home".

        Raises:
            Misfit: there is none.
        """
        when = condition_in(self._language, match.tokens, match.slots["f"], dialogue.scope)
        ways = [t for t in program.transitions.values() if t.when and t.conditional == set(when)]
        if not ways:
            raise Misfit("")
        return [c for t in ways for c in program.subtree(t.target)]

    def _groups(
        self, touched: Sequence[str], rest: Sequence[str], old: object
    ) -> Iterator[Sequence[str]]:
        """Where to look for what was wrong: in what was just done, then in the whole program."""
        yield touched
        if old is not None:
            yield rest
        else:
            yield from ([c] for c in rest)

    def _left_out(
        self,
        match: Match,
        where: Sequence[str],
        rest: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[list[Edit], str] | None:
        mention = match.slots["x"]
        assert isinstance(mention, Mention)
        if mention.pronoun:
            return None
        named = {c.entity for part in (mention.parts or (mention,)) for c in part.candidates}
        for checkpoint in [*reversed(where), *rest]:
            goals = program.checkpoints[checkpoint].goals
            used = {a for g in goals if isinstance(g, Literal) for a in g.args[:1]}
            about = [e for e in used_in(program, [checkpoint]) if e in named]
            about = [e for e in about if e in used] or about
            if not about:
                continue
            best = [about[0]] if not (mention.parts or mention.plural) else about
            kept = without(goals, best)
            if kept == goals:
                continue
            words = listed([self._language.wording.entity(e) for e in best])
            name = program.checkpoints[checkpoint].name
            if not kept:
                return removed(program, checkpoint), f"{name} is gone"
            return [SetGoals(checkpoint, kept)], f"{name} is without {words} now"
        return None

    def excuse(self, core: Core, program: Automaton, dialogue: Dialogue) -> str:
        """Why something can't be put in another's place, or ""."""
        words, wording = core.words, self._language.wording
        for match in self._patterns.matches(words, self._language.mentions(words), program, ()):
            old = match.slots.get(
                "y", match.slots.get("x") if match.intent == "leave-out" else None
            )
            if not isinstance(old, Mention) or not old.candidates:
                continue
            thing = wording.entity(min(old.candidates, key=lambda c: c.rank).entity)
            if len(program.checkpoints) == 1:
                return NO_STEPS
            return f"{sentence(f'{thing} is in no step')} {steps_there(program)}"
        if core.needless:
            none = len(program.checkpoints) == 1
            return NO_STEPS if none else f"{NOTHING_OF_THAT} {steps_there(program)}"
        if core.strength == 2 and len(program.checkpoints) > 1:
            return f"{WHAT_INSTEAD} {self._language.examples()}"
        return ""

    # Sentences

    def _taken_back(
        self, utterance: str, core: Core, program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        """`don't go home, go to the kitchen`, where going home was asked for: that step is gone, or another."""
        if _LIMITS.intersection(core.tokens):
            return None  # "Don't go home while I'm in the kitchen" takes back no more than that.
        there = [c for c in program.checkpoints if c != START]
        size = len(core.tokens)
        # "Don't open it, close it" as a whole forbids both.
        other = [at for at in range(size - 1, 2, -1) if self._asks_other(core.tokens[at:])]
        for end in dict.fromkeys((*other, *range(size, 2, -1))):
            try:
                steps = self._changes.steps(core.tokens[:end], dialogue)
            except Unclear:
                continue  # "Don't put the cup in the bin, put it": not all of what was said.
            if len(steps) != 1 or not steps[0].forbidden or steps[0].when:
                continue
            left = negated(steps[0].goals, there, program)
            rest = trimmed(core.tokens[end:])
            if left is None:
                return None
            if not rest:
                return applied(self._language, utterance, *left, program, dialogue, there)
            rest = rest[1:] if rest[0] in _ON else rest
            if not self._language.asks_for(rest):
                return None  # "Don't go home before you have filled the tray."
            touched = [e.checkpoint for e in left[0] if isinstance(e, RemoveCheckpoint | SetGoals)]
            # "Don't put the napkin in the bin, put it in the drawer": it is the napkin.
            for goal in flat(steps[0].forbidden):
                scope = dialogue.scope.after(goal.args[1:]).after(goal.args[:1])
                dialogue = replace(dialogue, scope=scope)
            return self._sentence(utterance, Core(tuple(rest), 2), touched, program, dialogue)
        return None

    def _asks_other(self, tokens: Sequence[str]) -> bool:
        """Whether tokens are what is asked for in the place of what is taken back."""
        rest = trimmed(tokens)
        rest = rest[1:] if rest and rest[0] == "but" else rest
        return self._language.asks_for(rest)

    def _sentence(
        self,
        utterance: str,
        core: Core,
        touched: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> MeantThen | None:
        """Another step in the place of the latest: "no, close it"."""
        replaces = touched and not dialogue.missed
        elses = [t.target for t in program.transitions.values() if program.is_else(t.id)]
        steps = self._changes.steps(core.tokens, dialogue, bool(elses)) if replaces else []
        if not steps:
            return None
        latest = program.checkpoints[touched[-1]].goals
        goals = taken_there(self._changes.steps, core.tokens, steps[0].goals, latest, dialogue)
        step = replace(steps[0], goals=goals)
        target = place_of(step.goals, touched, program)
        if step.role == "else" and len(steps) == 1 and len(elses) == 1:
            step, target = replace(step, role="then"), elses[0]
        if core.strength < 2 and target is None:
            return None
        if core.tokens[:2] == DO_NOT:
            left = negated(step.goals, touched, program)
            if left is not None:
                return applied(self._language, utterance, *left, program, dialogue, touched)
        if len(steps) > 1 or step.role == "else":
            return self._again.said(utterance, core.tokens, program, dialogue)
        target = target or touched[-1]
        incoming = program.incoming(target)
        if incoming is None or not step.goals:
            return None
        there = set(program.checkpoints[target].goals)
        step = replace(step, goals=exchanged_places(step.goals, program.checkpoints[target].goals))
        if (
            core.strength < 2
            and step.when
            and incoming.conditional != set(step.when)
            and (incoming.when or there != set(step.goals))
        ):
            # "If she dismisses it, take it to the desk instead" is another way on.
            beside = _INSTEAD in words(utterance) and not incoming.when
            if not beside:
                return None
            return self._conditions.beside(utterance, step, incoming.source, program, dialogue)
        when = step.when or incoming.when
        edits: list[Edit] = []
        if there != set(step.goals):
            edits.append(SetGoals(target, step.goals))
        if incoming.conditional != set(when):
            edits.append(SetConditional(incoming.id, when))
        edits += self._language.names.renamed(program, target, step.goals, when)
        say = (
            steps_in_words([step], self._language.wording)
            if step.when
            else (f"{goals_in_words(step.goals, self._language.wording)} instead")
        )
        if not any(not isinstance(e, RenameCheckpoint) for e in edits):
            edits, say = [], NOTHING_CHANGES
        return applied(self._language, utterance, edits, say, program, dialogue, touched)
