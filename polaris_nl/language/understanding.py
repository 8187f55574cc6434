"""The language side's face: an utterance and a program in, an interpretation out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.language.changes import Changes
from polaris_nl.language.clauses import ClauseFinder
from polaris_nl.language.dialogue import Dialogue, Pending, recalled
from polaris_nl.language.generate import read_back, steps_in_words
from polaris_nl.language.grammar import Grammar, load_grammar
from polaris_nl.language.interpretation import Command, Interpretation, Question, Reading, Refusal
from polaris_nl.language.lexicon import Lexicon
from polaris_nl.language.mention import Mention
from polaris_nl.language.mentions import MentionFinder
from polaris_nl.language.naming import Names
from polaris_nl.language.patterns import Patterns, strip
from polaris_nl.language.phrases import recogniser_phrases
from polaris_nl.language.queries import answer_to
from polaris_nl.language.questions import Questions
from polaris_nl.language.refusals import Refusals
from polaris_nl.language.resolve import Misfit, Resolver, Scope, Unclear
from polaris_nl.language.segment import Cut, Segmenter, cheapest
from polaris_nl.language.spelling import Spelling
from polaris_nl.language.structure import Builder, Step, steps_of
from polaris_nl.language.tokens import BREAK, COMMA, LONGEST, MOST_WORDS, words
from polaris_nl.language.wording import GrammarWording
from polaris_nl.model.world import World

AS_IT_IS = "It is like that already; nothing changes."
TRIED = 6
"""Ways to cut an utterance that are tried before it is refused or asked about."""
QUESTION_COST = 1.5
"""How much dearer a reading that needs a question may not be than one that needs none."""


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
        clauses = ClauseFinder(world, self.grammar)
        self._segmenter = Segmenter(common, clauses)
        self.resolver = Resolver(world)
        self.names = Names(world, self.grammar)
        self._fillers = common.words("fillers")
        self._commands: dict[tuple[str, ...], Command] = {}
        for command in common.mapping("commands"):
            for phrase_words in common.words("commands", command):
                self._commands.setdefault(phrase_words, command)  # type: ignore[arg-type]
        self._spelling = Spelling(self.grammar, lexicon)
        self._refusals = Refusals(world, self._spelling.known, clauses, self.wording)
        self.questions = Questions(common, self.resolver, self.wording)
        self._edits = Patterns(common, "edits")
        self._queries = Patterns(common, "queries")
        self._changes = Changes(self)

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
        bare = strip(tokens, self._fillers)
        if not any(t not in (BREAK, COMMA) for t in tokens):
            return self.refused(
                utterance, "I heard nothing. Say what the robot should achieve."
            ), dialogue
        pending = dialogue.pending
        dialogue = replace(dialogue, pending=None)
        if pending is None:
            return self._fresh(utterance, tokens, bare, program, dialogue)
        answered = self._answered(utterance, bare, pending, program, dialogue)
        if answered is not None:
            return answered
        unanswered = replace(dialogue, scope=replace(dialogue.scope, choices={}))
        meant, after = self._fresh(utterance, tokens, bare, program, unanswered)
        if meant.command in _KEEPING or meant.query is not None or meant.outcome == "refused":
            return meant, replace(dialogue, pending=pending)
        return meant, after

    def read_back(self, program: Automaton) -> str:
        """A program in words."""
        return read_back(program, self.wording)

    def parses(self, utterance: str, program: Automaton, dialogue: Dialogue | None = None) -> bool:
        """Whether an utterance is understood: anything but a refusal."""
        return self.interpret(utterance, program, dialogue)[0].outcome != "refused"

    def phrases(self) -> tuple[str, ...]:
        """Phrases for a recogniser: everything that can be said about this world, by examples."""
        return recogniser_phrases(self.world, self.grammar)

    @cached_property
    def help(self) -> str:
        """What can be said, in a few sentences."""
        return self._refusals.help()

    # Ways to understand, in order

    def _fresh(
        self,
        utterance: str,
        tokens: Sequence[str],
        bare: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[Interpretation, Dialogue]:
        command = self._commands.get(tuple(t for t in tokens if t not in (BREAK, COMMA)))
        command = command or self._commands.get(tuple(bare))
        if command is not None:
            say = self.help if command == "help" else ""
            return Interpretation(
                utterance, "command", say or _COMMAND_SAYS.get(command, ""), command=command
            ), dialogue
        mentions = self.mentions(bare)
        changed = self._changes.corrected(utterance, bare, mentions, program, dialogue)
        changed = changed or self._changes.edited(
            utterance,
            self._edits.matches(bare, mentions, program, dialogue.touched),
            bare,
            program,
            dialogue,
        )
        if changed is not None:
            return changed
        matches = self._queries.matches(bare, mentions, program, dialogue.touched)
        try:
            answer = answer_to(self, utterance, matches, bare, program, dialogue)
        except Unclear as unclear:
            return self.asked(utterance, unclear, dialogue)
        if answer is not None:
            return answer, dialogue
        return self.said(utterance, tokens, program, dialogue)

    def said(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """Reads tokens as steps of the program."""
        cuts = self.cuts(tokens)
        for word, reason in self.grammar.common.mapping("refused").items():
            if word in tokens:
                return self.refused(utterance, str(reason), (word,)), dialogue
        good = [cut for cut in cuts if not cut.unknown and _says_something(cut)]
        results = list(self._tried(utterance, good, program, dialogue))
        if results:
            return min(results, key=lambda r: r[0])[1:]
        return self._not_understood(utterance, cuts, tokens, good, program, dialogue), dialogue

    def cuts(self, tokens: Sequence[str]) -> list[Cut]:
        """The best ways to cut tokens into clauses."""
        return cheapest(self._segmenter.cut(tokens, self.mentions(tokens)), TRIED)

    def mentions(self, tokens: Sequence[str]) -> list[tuple[Mention, ...]]:
        """The mentions that start at each position."""
        return [self._mentions.at(tokens, at) for at in range(len(tokens))]

    def _tried(
        self, utterance: str, cuts: Sequence[Cut], program: Automaton, dialogue: Dialogue
    ) -> Iterator[tuple[float, Interpretation, Dialogue]]:
        for cut in cuts:
            builder = self._builder(program, dialogue)
            try:
                steps, scope = self._steps(cut, builder, dialogue)
            except Misfit:
                continue
            except Unclear as unclear:
                meant, after = self.asked(utterance, unclear, dialogue)
                yield cut.cost + QUESTION_COST, meant, after
                continue
            if not steps:
                continue
            if not builder.edits:
                yield cut.cost, Interpretation(utterance, "answer", AS_IT_IS), dialogue
                continue
            after = replace(
                dialogue,
                here=builder.here,
                touched=tuple(builder.touched),
                anchor=builder.anchor,
                scope=scope,
            )
            say = steps_in_words(steps, self.wording)
            reading = Reading(
                say, -cut.cost, tuple(f"{i.role or i.mark}: {i.text}" for i in cut.items)
            )
            meant = Interpretation(
                utterance, "applied", say, tuple(builder.edits), readings=(reading,)
            )
            yield cut.cost, meant, after

    def _steps(self, cut: Cut, builder: Builder, dialogue: Dialogue) -> tuple[list[Step], Scope]:
        """The steps of a cut utterance, put into the program.

        Raises:
            Unclear: a question has to be asked.
            Misfit: the reading can't be.
        """
        branched = builder.anchor is not None
        steps, scope = steps_of(cut, self.resolver, dialogue.scope, branched)
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
        return Builder(self.world, self.names, program, here, anchor)

    # Questions and refusals

    def asked(
        self, utterance: str, unclear: Unclear, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """The question that an unclear mention needs, kept open in the dialogue."""
        question = Question(unclear.about, unclear.options)
        by_name = {self.world.entities[e].spoken: e for e in self.world.entities}
        options = tuple((o, by_name.get(o, o)) for o in unclear.options)
        say = self.questions.asked(unclear.about, options)
        pending = Pending(utterance, unclear.phrase, options, unclear.types, unclear.number)
        return Interpretation(utterance, "question", say, question=question), replace(
            dialogue, pending=pending
        )

    def _answered(
        self,
        utterance: str,
        bare: Sequence[str],
        pending: Pending,
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[Interpretation, Dialogue] | None:
        """Reads an utterance as the answer to the open question, or None where it is something else."""
        try:
            chosen = self.questions.choice(bare, pending, self.mentions, dialogue.scope)
        except Unclear as unclear:
            narrowed = Unclear(
                unclear.about, unclear.options, pending.phrase, pending.types, pending.number
            )
            meant, after = self.asked(pending.utterance, narrowed, dialogue)
            return replace(meant, utterance=utterance), after
        if chosen is None:
            return None
        if not chosen:
            say = "All right, I left that out. Say it another way."
            scope = replace(dialogue.scope, choices={})
            return Interpretation(utterance, "answer", say), replace(dialogue, scope=scope)
        choices = {**dialogue.scope.choices, pending.phrase: chosen}
        answered = replace(dialogue, scope=replace(dialogue.scope, choices=choices))
        meant, after = self.interpret(pending.utterance, program, answered)
        if after.pending is None:  # Another question of the same utterance needs this answer again.
            after = replace(after, scope=replace(after.scope, choices={}))
        return replace(meant, utterance=utterance), after

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
                self._steps(cut, self._builder(program, dialogue), dialogue)
            except Misfit as misfit:
                return self.refused(utterance, str(misfit))
            except Unclear:
                continue
        unknown = self._refusals.unknown(tokens, cuts[0].unknown if cuts else tuple(tokens))
        reason = self._refusals.misfit(tokens, self.mentions(tokens))
        if reason and not any(word not in self._spelling.known for word in unknown):
            return self.refused(utterance, reason)
        return self.refused(utterance, self._refusals.reason(tokens, unknown, cuts), unknown)

    def refused(self, utterance: str, reason: str, unknown: Sequence[str] = ()) -> Interpretation:
        """A refusal with its reason and the words that weren't understood."""
        return Interpretation(utterance, "refused", reason, refusal=Refusal(reason, tuple(unknown)))


def _says_something(cut: Cut) -> bool:
    return any(item.role in ("goal", "condition") for item in cut.items)


_KEEPING = ("help", "repeat", "read-program", "read-plan", "status", "yes")
"""Commands after which an open question can still be answered."""
_COMMAND_SAYS = {
    "stop": "Stopping.",
    "pause": "Pausing.",
    "resume": "Going on.",
    "yes": "There is nothing to say yes to.",
    "no": "There is nothing to say no to.",
    "quit": "Goodbye.",
}
