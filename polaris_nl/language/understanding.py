"""The language side's face: an utterance and a program in, an interpretation out."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property, lru_cache

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import apply_all
from polaris_nl.language.answering import Answering, PendingReply
from polaris_nl.language.asking import Asking
from polaris_nl.language.changes import Changes
from polaris_nl.language.clauses import ClauseFinder
from polaris_nl.language.commands import COMMAND_SAYS, REPLIES, SAID_ALONE, Commands, Told
from polaris_nl.language.conditions import condition_in
from polaris_nl.language.cores import DO_NOT
from polaris_nl.language.corrections import Corrections
from polaris_nl.language.dialogue import Dialogue, Latest, Pending, recalled
from polaris_nl.language.generate import read_back
from polaris_nl.language.grammar import Grammar, load_grammar
from polaris_nl.language.interpretation import Interpretation, Question, Refusal
from polaris_nl.language.lexicon import Lexicon
from polaris_nl.language.mention import Mention
from polaris_nl.language.mentions import MentionFinder
from polaris_nl.language.naming import Names
from polaris_nl.language.patterns import Patterns, strip
from polaris_nl.language.phrases import recogniser_phrases
from polaris_nl.language.queries import answer_to, contrast_asked
from polaris_nl.language.questions import Questions
from polaris_nl.language.references import References, UnclearStep
from polaris_nl.language.refusals import Refusals
from polaris_nl.language.repair import Repairs
from polaris_nl.language.resolve import Resolver
from polaris_nl.language.salvage import Salvage
from polaris_nl.language.scope import Unclear
from polaris_nl.language.segment import Cut, Segmenter, cheapest
from polaris_nl.language.spelling import Spelling
from polaris_nl.language.statements import Statements
from polaris_nl.language.template import prepare
from polaris_nl.language.tokens import BREAK, COMMA, LONGEST, MOST_WORDS, words
from polaris_nl.language.wording import GrammarWording
from polaris_nl.model.formula import Literal
from polaris_nl.model.world import World

TRIED = 6
"""Ways to cut an utterance that are tried before it is refused or asked about."""
CUTS_KEPT = 64
"""Utterances, or parts of them, whose cuts are remembered."""


class Understanding:
    """Understands utterances about one world.

    Args:
        world: entities and their names.
        language: the folder of grammar files.

    Raises:
        GrammarError: a grammar file is not as it should be.
    """

    def __init__(self, world: World, language: str = "en") -> None:
        self.world = world
        self.grammar: Grammar = load_grammar(world.domain, language)
        self.wording = GrammarWording(world, self.grammar)
        common = self.grammar.common
        lexicon = Lexicon(world)
        self._mentions = MentionFinder(lexicon, self.grammar)
        clauses = self._clauses = ClauseFinder(world, self.grammar)
        self._segmenter = Segmenter(common, clauses)
        self.resolver = Resolver(world, self.wording)
        self.names = Names(world, self.grammar)
        self.fillers = common.fillers
        self._commands = Commands(common)
        self.verbs = clauses.verbs
        types = {e.name: e.type for e in world.entities.values()}
        repairs = Repairs(common, clauses.verbs, types, self._mentions.adjectives)
        self._spelling = Spelling(self.grammar, lexicon)
        self._refusals = Refusals(world, self._spelling.known, clauses, self.wording)
        self.questions = Questions(common, self.resolver, self.wording)
        references = References(self.grammar, clauses.verbs, self._reads)
        self._edits = Patterns(common.of_kind("edit"), references, common.numbers)
        queries = Patterns(common.of_kind("query"), references, common.numbers)
        # An utterance is cut several times on the way to its meaning: as a whole, and without fillers.
        self._cut = lru_cache(CUTS_KEPT)(self._cheapest)
        self._asking = Asking(common, queries)
        self._changes = Changes(self)
        self._read_in: Automaton | None = None
        self._read: dict[tuple[str, ...], Sequence[Literal]] = {}
        self._corrections = Corrections(self, self._changes, references)
        self._answering = Answering(self, self._commands, self._corrections, references)
        self._statements = Statements(self, repairs, self._refusals, self._spelling.known)
        self._salvage = Salvage(
            self, self._commands, self._segmenter, self._spelling, self._with_remarks
        )

    def interpret(
        self, utterance: str, program: Automaton, dialogue: Dialogue | None = None
    ) -> tuple[Interpretation, Dialogue]:
        """The meaning of an utterance, and the state of the dialogue after it.

        Never raises: what isn't understood is a refusal with its reason.

        Args:
            utterance: what was said or typed.
            program: the program it is about.
            dialogue: what was said before.
        """
        dialogue = dialogue or recalled(program)
        if len(utterance) > LONGEST:
            return self.refused(
                utterance[:60] + "...", "That is too long; say it in several sentences."
            ), dialogue
        tokens = words(utterance)
        if len(tokens) > MOST_WORDS:
            return self.refused(
                utterance, "That is too long; say it in several sentences."
            ), dialogue
        tokens = self._spelling.mended(tokens, program)
        bare = strip(tokens, self.fillers)
        if not any(t not in (BREAK, COMMA) for t in tokens):
            return self.refused(
                utterance, "I heard nothing. Say what the robot should achieve."
            ), dialogue
        pending = dialogue.pending
        dialogue = replace(dialogue, pending=None)
        if pending is None:
            meant, after = self._fresh(utterance, tokens, program, dialogue)
            return meant, self._remembered(meant, after, dialogue, tokens, program)
        answered = self._answering.answered(
            PendingReply(utterance, bare, pending, program, dialogue)
        )
        if answered is not None:
            return answered
        unanswered = replace(dialogue, scope=replace(dialogue.scope, choices={}))
        meant, after = self._fresh(utterance, tokens, program, unanswered)
        after = self._remembered(meant, after, dialogue, tokens, program)
        if pending.kind == "part":
            # A yes to it has to come right behind it.
            return meant, replace(
                after, pending=pending if meant.command == "repeat" else after.pending
            )
        if meant.command in _KEEPING or meant.query is not None or meant.outcome == "refused":
            return meant, replace(dialogue, pending=pending)
        return meant, after

    def offered(
        self, refused: Interpretation, program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """A refusal with the part of the utterance that can be understood, to be done after a yes.

        Args:
            refused: what an utterance was taken to mean.
            program: the program it is about.
            dialogue: what was said before it, and that it was refused.
        """
        return self._salvage.offered(refused, program, dialogue)

    def _remembered(
        self,
        meant: Interpretation,
        after: Dialogue,
        before: Dialogue,
        tokens: Sequence[str],
        program: Automaton,
    ) -> Dialogue:
        """The dialogue with what corrections need to know of the latest utterance."""
        if meant.outcome == "refused":
            return replace(after, missed=not self._corrections.core(tokens).strength)
        if meant.outcome != "applied" or after.latest is not before.latest:
            return replace(after, missed=False)
        changed = apply_all(program, meant.edits)
        latest = Latest(tuple(tokens), program, changed, replace(before, latest=None))
        return replace(after, missed=False, latest=latest)

    def warm_up(self) -> None:
        """Loads what the first utterance would wait for: the dictionary, and the wordings' states."""
        for said in ("help", "hlep"):  # The dictionary is for the first word that isn't known.
            self.interpret(said, Automaton())
        goals = (w for p in self.grammar.predicates.values() for w in p.wordings.values())
        intents = (intent.wordings for intent in self.grammar.common.intents)
        for template in itertools.chain.from_iterable((*goals, *intents)):
            prepare(template)

    def read_back(self, program: Automaton) -> str:
        """A program in words."""
        return read_back(program, self.wording)

    def parses(self, utterance: str, program: Automaton, dialogue: Dialogue | None = None) -> bool:
        """Whether an utterance is understood: anything but a refusal."""
        return self.interpret(utterance, program, dialogue)[0].outcome != "refused"

    def phrases(self) -> tuple[str, ...]:
        """Phrases for a recogniser: everything that can be said about this world, by examples."""
        return recogniser_phrases(self.world, self.grammar)

    def examples(self) -> str:
        """What can be said, by examples."""
        return self._refusals.examples()

    @cached_property
    def help(self) -> str:
        """What can be said, in a few sentences."""
        return self._refusals.help()

    # Ways to understand, in order

    def _fresh(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """What is meant, without what is only told around it; by a "stop" where nothing else is."""
        meant, after = self._with_remarks(utterance, tokens, program, dialogue)
        if meant.outcome != "refused":
            return meant, after
        behind = self._salvage.behind_told(utterance, tokens, program, dialogue)
        behind = behind or self._salvage.between_commas(utterance, tokens, program, dialogue)
        if behind is not None:
            return behind
        return self._salvage.halting(utterance, tokens) or meant, after

    def _with_remarks(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """What is meant by all of the tokens, or else by those before what is only told."""
        kept = self._segmenter.before_remark(tokens, self.mentions(tokens))
        strength = self._corrections.core(tokens).strength
        for rest in (kept, self._salvage.without_told(tokens)[0]):
            if len(rest) < len(tokens) and self._corrections.core(rest).strength > strength:
                # "To Mr Brown instead, she has eaten" is nothing on top.
                return self._whole(utterance, rest, program, dialogue)
        if len(kept) == len(tokens):
            return self._whole(utterance, tokens, program, dialogue)
        meant, after = self._whole(utterance, tokens, program, dialogue)
        if meant.outcome == "refused":
            again, then = self._whole(utterance, kept, program, dialogue)
            if again.outcome != "refused" and again.command not in (*SAID_ALONE, "repeat"):
                return again, then
        return meant, after

    def _whole(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """What is meant by all of the tokens."""
        bare = strip(tokens, self.fillers)
        told = self._commands.meant(tokens)
        if told is not None:
            return self._told(utterance, told), dialogue
        asked, dialogue = dialogue.asked, replace(dialogue, asked=None)
        core = self._corrections.core(tokens)
        told = self._commands.meant(core.words) if core.tokens != tuple(bare) else None
        if told is not None and not REPLIES.intersection(told.commands):
            return self._told(utterance, told), dialogue
        contrasted = contrast_asked(self, utterance, self._asking, tokens, program, dialogue)
        if contrasted is not None:
            return contrasted
        changed = self._corrections.corrected(utterance, core, program, dialogue)
        takes_back = core.strength or core.tokens[:2] == DO_NOT
        if takes_back and (changed is None or changed[0].outcome != "applied"):
            kept = self._segmenter.before_remark(core.tokens, self.mentions(core.tokens))
            if len(kept) < len(core.tokens) and not _limits(core.tokens[len(kept) :]):
                core = replace(core, tokens=kept)
                changed = self._corrections.corrected(utterance, core, program, dialogue) or changed
        for part in dict.fromkeys((tuple(strip(tokens, ())), tuple(bare), core.tokens)):
            changed = changed or self.edited(utterance, part, program, dialogue)
        if changed is not None:
            return changed
        if self.asks_for([t for t in tokens if t not in (BREAK, COMMA)]):
            return self.said(utterance, tokens, program, dialogue)
        try:
            before = replace(dialogue, asked=asked)
            answer = answer_to(self, utterance, self._asking, tokens, program, before)
        except Unclear as unclear:
            return self.asked(utterance, unclear, dialogue)
        if answer is not None:
            return answer
        said, after = self.said(utterance, tokens, program, dialogue)
        if said.outcome == "refused" and core.tokens != tuple(bare) and not core.needless:
            again, then = self.said(utterance, core.tokens, program, dialogue)
            if again.outcome != "refused":
                return again, then
        if said.refusal is not None:
            reason = self._changes.missing(core.tokens, self._edits, program)
            reason = reason or self._corrections.excuse(core, program, dialogue)
            if reason:
                return self.refused(utterance, reason, said.refusal.unknown), after
        return said, after

    def edited(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue] | None:
        """Reads tokens as an edit of what is there, with their marks and without; None where they are none."""
        plain = [t for t in tokens if t not in (BREAK, COMMA)]
        for said in (list(tokens), plain) if plain != list(tokens) else (plain,):
            matches = self._edits.matches(said, self.mentions(said), program, dialogue.touched)
            changed = self._changes.edited(utterance, matches, program, dialogue)
            if changed is not None:
                return changed
        return None

    def _reads(self, tokens: Sequence[str], program: Automaton) -> Sequence[Literal]:
        """The condition that describes a step: "(the part where) she dismisses it"."""
        if self._read_in is not program:
            self._read_in, self._read = program, {}
        key = tuple(tokens)
        if key not in self._read:
            scope = recalled(program).scope
            self._read[key] = condition_in(self, tokens, (0, len(tokens)), scope)
        return self._read[key]

    def said(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """Reads tokens as steps of the program."""
        return self._statements.read(utterance, tokens, program, dialogue)

    def _told(self, utterance: str, told: Told) -> Interpretation:
        """What is to be done for commands: one at a time."""
        command = told.commands[0]
        if len(told.commands) > 1:
            names = " or ".join(f'"{c.replace("-", " the ")}"' for c in told.commands)
            return self.refused(utterance, f"One thing at a time, please: {names} first?")
        say = self.help if command == "help" else COMMAND_SAYS.get(command, "")
        return Interpretation(utterance, "command", say, command=command, agrees=told.agrees)

    def asks_for(self, tokens: Sequence[str]) -> bool:
        """Whether tokens as a whole are one imperative: "find the fork" is a goal where it can be one."""
        if not tokens:
            return False
        found = self._clauses.at(tokens, 0, self.mentions(tokens))
        whole = (c for c in found if c.kind == "goal" and c.end == len(tokens))
        return any(c.form == "base" and not c.seeks for c in whole)

    def cuts(self, tokens: Sequence[str]) -> list[Cut]:
        """The best ways to cut tokens into clauses."""
        return list(self._cut(tuple(tokens)))

    def _cheapest(self, tokens: tuple[str, ...]) -> tuple[Cut, ...]:
        return tuple(cheapest(self._segmenter.cut(tokens, self.mentions(tokens)), TRIED))

    def mentions(self, tokens: Sequence[str]) -> list[tuple[Mention, ...]]:
        """The mentions that start at each position."""
        return [self._mentions.at(tokens, at) for at in range(len(tokens))]

    # Questions and refusals

    def asked(
        self, utterance: str, unclear: Unclear, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """The question that an unclear mention needs, kept open in the dialogue."""
        question = Question(unclear.about, unclear.options)
        by_name = {self.world.entities[e].spoken: e for e in self.world.entities}
        options = tuple((o, by_name.get(o, o)) for o in unclear.options)
        pending = Pending(utterance, unclear.phrase, options, unclear.types, unclear.number)
        if isinstance(unclear, UnclearStep):
            options = tuple(zip(unclear.options, unclear.ids, strict=True))
            pending = replace(pending, options=options, kind="step")
        say = self.questions.asked(unclear.about, options)
        return Interpretation(utterance, "question", say, question=question), replace(
            dialogue, pending=pending
        )

    def refused(self, utterance: str, reason: str, unknown: Sequence[str] = ()) -> Interpretation:
        """A refusal with its reason and the words that weren't understood."""
        return Interpretation(utterance, "refused", reason, refusal=Refusal(reason, tuple(unknown)))


def _limits(tokens: Sequence[str]) -> bool:
    """Whether words limit what is before them: "don't go home while I'm in the kitchen"."""
    return bool(_LIMITS.intersection(tokens))


_LIMITS = frozenset(("while", "if", "when", "unless", "until", "till", "before"))
_KEEPING = ("help", "repeat", "read-program", "read-plan", "status", "yes")
"""Commands after which an open question can still be answered."""
