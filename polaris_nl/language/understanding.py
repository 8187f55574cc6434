"""The language side's face: an utterance and a program in, an interpretation out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import apply_all
from polaris_nl.language.changes import Changes
from polaris_nl.language.clauses import ClauseFinder
from polaris_nl.language.commands import Commands, Told
from polaris_nl.language.corrections import Corrections
from polaris_nl.language.dialogue import Dialogue, Latest, Pending, recalled
from polaris_nl.language.generate import read_back, steps_in_words
from polaris_nl.language.grammar import Grammar, load_grammar
from polaris_nl.language.interpretation import Interpretation, Question, Reading, Refusal
from polaris_nl.language.lexicon import Lexicon
from polaris_nl.language.mention import Mention
from polaris_nl.language.mentions import MentionFinder
from polaris_nl.language.naming import Names
from polaris_nl.language.patterns import Patterns, strip
from polaris_nl.language.phrases import recogniser_phrases
from polaris_nl.language.queries import Asking, _condition, answer_to, contrast_asked
from polaris_nl.language.questions import Questions
from polaris_nl.language.reading import steps_of
from polaris_nl.language.references import References, UnclearStep
from polaris_nl.language.refusals import Refusals
from polaris_nl.language.repair import Repairs
from polaris_nl.language.rereading import with_phrase
from polaris_nl.language.resolve import Misfit, Resolver, Scope, Unclear
from polaris_nl.language.segment import Cut, Segmenter, cheapest
from polaris_nl.language.spelling import Spelling
from polaris_nl.language.structure import Builder, Step
from polaris_nl.language.tokens import BREAK, COMMA, LONGEST, MOST_WORDS, phrase, words
from polaris_nl.language.wording import GrammarWording
from polaris_nl.model.formula import Literal
from polaris_nl.model.world import World

AS_IT_IS = "It is like that already; nothing changes."
TRIED = 6
"""Ways to cut an utterance that are tried before it is refused or asked about."""
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
        self._repairs = Repairs(common, clauses.verbs, types)
        self._refused_phrases = [(phrase(k), v) for k, v in common.refused.items()]
        self._spelling = Spelling(self.grammar, lexicon)
        self._refusals = Refusals(world, self._spelling.known, clauses, self.wording)
        self.questions = Questions(common, self.resolver, self.wording)
        references = References(self.grammar, clauses.verbs, self._reads)
        self._edits = Patterns(common.of_kind("edit"), references, common.numbers)
        queries = Patterns(common.of_kind("query"), references, common.numbers)
        self._asking = Asking(common, queries)
        self._changes = Changes(self)
        self._read_in: Automaton | None = None
        self._read: dict[tuple[str, ...], Sequence[Literal]] = {}
        self._corrections = Corrections(self, self._changes, references)
        self._references = references
        self._connectives = tuple(
            words
            for mark in ("if", "until", "unless", "else")
            for words in common.connectives[mark]
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
            meant, after = self._fresh(utterance, tokens, bare, program, dialogue)
            return meant, self._remembered(meant, after, dialogue, tokens, program)
        answered = self._answered(utterance, bare, pending, program, dialogue)
        if answered is not None:
            return answered
        unanswered = replace(dialogue, scope=replace(dialogue.scope, choices={}))
        meant, after = self._fresh(utterance, tokens, bare, program, unanswered)
        after = self._remembered(meant, after, dialogue, tokens, program)
        if meant.command in _KEEPING or meant.query is not None or meant.outcome == "refused":
            return meant, replace(dialogue, pending=pending)
        return meant, after

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
        self,
        utterance: str,
        tokens: Sequence[str],
        bare: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[Interpretation, Dialogue]:
        told = self._commands.meant(tokens)
        if told is not None:
            return self._told(utterance, told), dialogue
        asked, dialogue = dialogue.asked, replace(dialogue, asked=None)
        core = self._corrections.core(tokens)
        told = self._commands.meant(core.words) if core.tokens != tuple(bare) else None
        if told is not None and told.commands[0] not in ("yes", "no"):
            return self._told(utterance, told), dialogue
        contrasted = contrast_asked(self, utterance, self._asking, tokens, program, dialogue)
        if contrasted is not None:
            return contrasted
        changed = self._corrections.corrected(utterance, core, program, dialogue)
        for part in dict.fromkeys((tuple(strip(tokens, ())), tuple(bare), core.tokens)):
            changed = changed or self.edited(utterance, part, program, dialogue)
        if changed is not None:
            return changed
        if self._asks_for([t for t in tokens if t not in (BREAK, COMMA)]):
            return self.said(utterance, tokens, program, dialogue)
        try:
            before = replace(dialogue, asked=asked)
            answer = answer_to(self, utterance, self._asking, tokens, program, before)
        except Unclear as unclear:
            return self.asked(utterance, unclear, dialogue)
        if answer is not None:
            return answer
        said, after = self.said(utterance, tokens, program, dialogue)
        if said.outcome == "refused" and core.tokens != tuple(bare):
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
            self._read[key] = _condition(self, tokens, (0, len(tokens)), scope)
        return self._read[key]

    def _told(self, utterance: str, told: Told) -> Interpretation:
        """What is to be done for commands: one at a time."""
        command = told.commands[0]
        if len(told.commands) > 1:
            names = " or ".join(f'"{c.replace("-", " the ")}"' for c in told.commands)
            return self.refused(utterance, f"One thing at a time, please: {names} first?")
        say = self.help if command == "help" else _COMMAND_SAYS.get(command, "")
        return Interpretation(utterance, "command", say, command=command, agrees=told.agrees)

    def _asks_for(self, tokens: Sequence[str]) -> bool:
        """Whether tokens as a whole are one imperative: "find the fork" is a goal where it can be one."""
        if not tokens:
            return False
        found = self._clauses.at(tokens, 0, self.mentions(tokens))
        return any(c.kind == "goal" and c.form == "base" and c.end == len(tokens) for c in found)

    def said(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[Interpretation, Dialogue]:
        """Reads tokens as steps of the program."""
        cuts = self.cuts(tokens)
        for banned, reason in self._refused_phrases:
            if any(tuple(tokens[at : at + len(banned)]) == banned for at in range(len(tokens))):
                return self.refused(utterance, reason, (" ".join(banned),)), dialogue
        good = _understood(cuts)
        mendable = len(tokens) <= MOST_REPAIRED
        mentions = self.mentions(tokens) if mendable else []
        best = None
        if mendable:
            corrected = self._repairs.corrections(tokens, mentions)
            best = self._first(utterance, corrected, program, dialogue)
        best = best or self._best(utterance, good, program, dialogue)
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
            best = self._best(utterance, _understood(self.cuts(tokens)), program, dialogue)
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

    def cuts(self, tokens: Sequence[str]) -> list[Cut]:
        """The best ways to cut tokens into clauses."""
        return cheapest(self._segmenter.cut(tokens, self.mentions(tokens)), TRIED)

    def mentions(self, tokens: Sequence[str]) -> list[tuple[Mention, ...]]:
        """The mentions that start at each position."""
        return [self._mentions.at(tokens, at) for at in range(len(tokens))]

    def _tried(
        self, utterance: str, cuts: Sequence[Cut], program: Automaton, dialogue: Dialogue
    ) -> Iterator[_Tried]:
        for cut in cuts:
            builder = self._builder(program, dialogue)
            try:
                steps, scope = self._steps(cut, builder, dialogue)
            except Misfit as misfit:
                yield _Tried(cut, cut.cost, f"can't be: {misfit}", None, dialogue)
                continue
            except Unclear as unclear:
                meant, after = self.asked(utterance, unclear, dialogue)
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
            say = steps_in_words(steps, self.wording)
            meant = Interpretation(utterance, "applied", say, tuple(builder.edits))
            yield _Tried(cut, cut.cost, say, meant, after)

    def _steps(self, cut: Cut, builder: Builder, dialogue: Dialogue) -> tuple[list[Step], Scope]:
        """The steps of a cut utterance, put into the program.

        Raises:
            Unclear: a question has to be asked.
            Misfit: the reading can't be.
        """
        branched = builder.anchor is not None
        latest = builder.program.checkpoints[builder.here].goals
        steps, scope = steps_of(cut, self.resolver, dialogue.scope, branched, latest)
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
        pending = Pending(utterance, unclear.phrase, options, unclear.types, unclear.number)
        if isinstance(unclear, UnclearStep):
            options = tuple(zip(unclear.options, unclear.ids, strict=True))
            pending = replace(pending, options=options, kind="step")
        say = self.questions.asked(unclear.about, options)
        return Interpretation(utterance, "question", say, question=question), replace(
            dialogue, pending=pending
        )

    def _asked_then(self, utterance: str, dialogue: Dialogue) -> tuple[Interpretation, Dialogue]:
        """What a condition that came alone still needs."""
        about = "What should I do then?"
        meant = Interpretation(utterance, "question", about, question=Question(about))
        return meant, replace(dialogue, pending=Pending(utterance, "", kind="then"))

    def _done_then(
        self,
        utterance: str,
        bare: Sequence[str],
        pending: Pending,
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[Interpretation, Dialogue] | None:
        """The condition that came alone with what is to be done then, or None for something else."""
        begins = any(tuple(bare[: len(words)]) == words for words in self._connectives)
        if begins or self._commands.meant(bare) is not None:
            return None
        whole = f"{pending.utterance.strip(' .,!?')}, {utterance}"
        meant, after = self.interpret(whole, program, dialogue)
        if meant.outcome not in ("applied", "question") or after.pending == pending:
            return None
        return replace(meant, utterance=utterance), after

    def _chosen(
        self, bare: Sequence[str], pending: Pending, program: Automaton, dialogue: Dialogue
    ) -> tuple[str, ...] | None:
        """What an answer chooses: () for none of it, None where it is no answer.

        Raises:
            Unclear: it may be the answer, but has several meanings.
        """
        core = self._corrections.core(bare)
        for tokens in (bare, core.words) if core.words != list(bare) else (bare,):
            chosen = self.questions.choice(tokens, pending, self.mentions, dialogue.scope)
            if chosen is None and pending.kind == "step":
                chosen = self._chosen_step(tokens, pending, program)
            if chosen is not None:
                return chosen
        return None

    def _chosen_step(
        self, tokens: Sequence[str], pending: Pending, program: Automaton
    ) -> tuple[str, ...] | None:
        ids = {i for _, i in pending.options}
        for found in self._references.at(tokens, 0, program, (), self.mentions(tokens)):
            fitting = [i for i in found.ids if i in ids]
            if found.end == len(tokens) and len(fitting) == 1:
                return (fitting[0],)
        return None

    def _asked_again(
        self,
        utterance: str,
        bare: Sequence[str],
        pending: Pending,
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[Interpretation, Dialogue] | None:
        """What was asked about is corrected: "Which bowl?" - "No, the plate"."""
        core = self._corrections.core(bare)
        if not core.strength or pending.kind != "thing" or not self.mentions(core.words):
            return None
        if not any(m.end == len(core.words) for m in self.mentions(core.words)[0]):
            return None
        tokens = with_phrase(words(pending.utterance), words(pending.phrase), core.words)
        if tokens is None:
            return None
        meant, after = self.interpret(" ".join(tokens), program, dialogue)
        if meant.outcome not in ("applied", "question"):
            return None
        return replace(meant, utterance=utterance), after

    def _answered(
        self,
        utterance: str,
        bare: Sequence[str],
        pending: Pending,
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[Interpretation, Dialogue] | None:
        """Reads an utterance as the answer to the open question, or None where it is something else."""
        if pending.kind == "then" and tuple(bare) not in self.questions.neither:
            return self._done_then(utterance, bare, pending, program, dialogue)
        try:
            chosen = self._chosen(bare, pending, program, dialogue)
        except Unclear as unclear:
            narrowed = Unclear(
                unclear.about, unclear.options, pending.phrase, pending.types, pending.number
            )
            meant, after = self.asked(pending.utterance, narrowed, dialogue)
            return replace(meant, utterance=utterance), after
        if chosen is None:
            return self._asked_again(utterance, bare, pending, program, dialogue)
        if not chosen:
            say = "All right, I left that out. Say it another way."
            scope = replace(dialogue.scope, choices={})
            return Interpretation(utterance, "answer", say), replace(dialogue, scope=scope)
        choices = {**dialogue.scope.choices, pending.phrase: chosen}
        answered = replace(dialogue, scope=replace(dialogue.scope, choices=choices))
        meant, after = self.interpret(pending.utterance, program, answered)
        if after.pending is None:  # Another question of the same utterance needs this answer again.
            scope = after.scope
            fresh = [c for c in chosen if c in self.world.entities and c not in scope.referents]
            for name in fresh:
                scope = scope.after((name,))
            after = replace(after, scope=replace(scope, choices={}))
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
        told = next((c for c in cuts if not c.unknown and _only_tells(c)), None)
        if told is not None:
            return self.refused(utterance, self._refusals.told())
        unknown = self._refusals.unknown(tokens, cuts[0].unknown if cuts else tuple(tokens))
        reason = self._refusals.misfit(tokens, self.mentions(tokens))
        if reason and not any(word not in self._spelling.known for word in unknown):
            return self.refused(utterance, reason)
        return self.refused(utterance, self._refusals.reason(tokens, unknown, cuts), unknown)

    def refused(self, utterance: str, reason: str, unknown: Sequence[str] = ()) -> Interpretation:
        """A refusal with its reason and the words that weren't understood."""
        return Interpretation(utterance, "refused", reason, refusal=Refusal(reason, tuple(unknown)))


def _understood(cuts: Sequence[Cut]) -> list[Cut]:
    """The cuts that account for every word and ask for something."""
    return [cut for cut in cuts if not cut.unknown and _says_something(cut)]


def _says_something(cut: Cut) -> bool:
    return any(item.role in ("goal", "condition", "again") for item in cut.items)


def _only_conditions(cut: Cut) -> bool:
    """Whether a cut is "if ..." with nothing to do."""
    marks = {item.mark for item in cut.items}
    roles = {item.role for item in cut.items}
    waits = not marks & {"until", "else"} and roles <= {"condition", "mark", "fact"}
    return bool(marks & {"if", "unless"}) and waits


def _only_tells(cut: Cut) -> bool:
    return any(item.role == "fact" for item in cut.items) and not _says_something(cut)


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
