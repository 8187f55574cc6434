"""Checkpoints that are meant: by name, by number, by recency, or by what is done there.

"remove fetched", "the second step", "the last one", "the part where you fetch the tray", "going home",
"the alert", "the step before home", "the branch where she dismisses it".
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.language.grammar import Grammar
from polaris_nl.language.mention import Mention
from polaris_nl.language.scope import Scope, Unclear
from polaris_nl.language.template import first_words
from polaris_nl.language.tokens import phrase
from polaris_nl.language.verbs import INFLECTED, Verbs
from polaris_nl.model.formula import Literal, literals_in

Reads = Callable[[Sequence[str], Automaton], Sequence[Literal]]
"""Reads a condition without its connective."""
Mentions = Sequence[Sequence[Mention]]
Asked = frozenset[tuple[str, bool]]
"""Predicates, each with whether it is to hold."""

_PART = ("step", "part", "checkpoint", "one", "branch", "bit", "goal", "thing", "stage", "case")
_DETERMINERS = ("the", "this", "that", "my", "your")
_BEGINNING = ("start", "beginning")
_WHERE = [
    tuple(words.split())
    for words in ("where", "when", "in which", "that", "that says", "which", "who", "if", "what happens if",
                  "what happens when", "for when", "for if", "with", "about", "for", "of", "to", "involving",
                  "in", "on", "at", "concerning", "what you do if", "saying")
]  # fmt: skip
_ELSE = [("what", "happens", "otherwise"), ("what", "you", "do", "otherwise")]
_DOER = [tuple(words.split()) for words in ("you", "the robot", "robot", "it", "i", "we", "to")]
_ORDINALS = {
    "first": 0, "second": 1, "third": 2, "fourth": 3, "fifth": 4, "sixth": 5, "last": -1, "latest": -1,
    "final": -1, "previous": -1, "newest": -1, "one": 0, "two": 1, "three": 2, "four": 3, "five": 4, "six": 5,
}  # fmt: skip
_MIDDLE = "middle"
_NUMBERS = ("one", "two", "three", "four", "five", "six")
_PLURALS = frozenset(("steps", "checkpoints", "numbers"))
_NOUNS: Mapping[str, str] = {
    "alert": "alert", "message": "tell", "announcement": "tell", "notification": "notify", "reminder": "remind",
    "delivery": "bring", "trip": "go", "drive": "drive", "visit": "go", "move": "go", "handover": "hand",
    "pickup": "pick", "opening": "open", "closing": "close", "warning": "warn", "way": "go", "return": "return",
}  # fmt: skip
"""Nouns for what is done, with its verb."""
_SMALL = (
    "to", "on", "in", "into", "onto", "at", "from", "up", "away", "back", "down", "with", "about", "that", "of",
    "it", "her", "him", "them", "me", "us", "there", "out", "for", "inside", "over",
)  # fmt: skip
_TAKEN_UP = ("it", "her", "him", "them", "me", "us", "there")
_ORDER = ("after", "before", "behind", "between")
"""Words behind which a thing stands for the step that is about it."""
_BETWEEN = ("", "and", "with", "before", "after", "behind", "to")
"""Words behind "the first" where it stands for the first step."""
_MOST_THINGS = 3


@dataclass(frozen=True, slots=True)
class Reference:
    """Words that mean a checkpoint.

    Attributes:
        start, end: the tokens, the end exclusive.
        ids: the checkpoints that fit equally well, the latest first.
    """

    start: int
    end: int
    ids: tuple[str, ...]


class UnclearStep(Unclear):
    """A reference that fits several checkpoints.

    Args:
        phrase: the words that are unclear.
        options: the names of the checkpoints.
        ids: the checkpoints.
    """

    def __init__(self, phrase: str, options: Sequence[str], ids: Sequence[str]) -> None:
        super().__init__(f"Which step do you mean by {phrase}?", options, phrase)
        self.ids = tuple(ids)


def meant(reference: Reference, tokens: Sequence[str], program: Automaton, scope: Scope) -> str:
    """The checkpoint that a reference means, with what was answered about it.

    Raises:
        UnclearStep: it has to be asked.
    """
    if len(reference.ids) == 1:
        return reference.ids[0]
    words = " ".join(tokens[reference.start : reference.end])
    chosen = scope.choices.get(words, ())
    if len(chosen) == 1 and chosen[0] in reference.ids:
        return chosen[0]
    ids = sorted(reference.ids, key=list(program.checkpoints).index)
    raise UnclearStep(words, [program.checkpoints[c].name for c in ids], ids)


class References:
    """Finds references to checkpoints.

    Args:
        grammar: whose verbs say what is done.
        verbs: the forms of these verbs.
        reads: reads the condition in "the part where she dismisses it".
    """

    def __init__(self, grammar: Grammar, verbs: Verbs, reads: Reads | None = None) -> None:
        self._verbs = verbs
        self._reads = reads
        self._said: dict[str, set[tuple[str, bool]]] = {}
        for name, phrases in grammar.predicates.items():
            for key in ("goals", "not-goals", "asks"):
                for template in phrases.wordings.get(key, ()):
                    for word in first_words(template) or ():
                        self._said.setdefault(word, set()).add((name, key != "not-goals"))

    @property
    def verbs(self) -> Collection[str]:
        """The first words of what can be asked for."""
        return self._said.keys()

    def at(
        self,
        tokens: Sequence[str],
        at: int,
        program: Automaton,
        touched: Sequence[str],
        mentions: Mentions = (),
    ) -> Iterator[Reference]:
        """The checkpoints that may be meant from a position on."""
        search = _Search(
            tokens, at, program, touched, mentions, self._said, self._verbs, self._reads
        )
        seen: set[tuple[int, tuple[str, ...]]] = set()
        for end, ids in search.found():
            if ids and (end, ids) not in seen:
                seen.add((end, ids))
                yield Reference(at, end, ids)


Found = Iterator[tuple[int, tuple[str, ...]]]


@dataclass
class _Search:
    tokens: Sequence[str]
    at: int
    program: Automaton
    touched: Sequence[str]
    mentions: Mentions
    said: Mapping[str, set[tuple[str, bool]]]
    verbs: Verbs
    reads: Reads | None

    def found(self) -> Found:
        """References from the position on: where each ends, and whom it fits."""
        at = self.at
        determined = self._word(at) in _DETERMINERS
        inner = at + determined
        starts = [inner]
        if self._word(inner) in ("checkpoint", "step", "part", "branch"):
            starts.append(inner + 1)
        for start in starts:
            yield from self._named(start)
        yield from self._counted(inner)
        yield from self._beside(inner)
        yield from self._described(inner)
        yield from self._latest(at, determined)

    @property
    def _made(self) -> list[str]:
        """The steps, in the order of the program."""
        ordered = dict.fromkeys((*self.program.subtree(START), *self.program.checkpoints))
        return [c for c in ordered if c != START]

    @property
    def _newest(self) -> str | None:
        if self.touched and self.touched[-1] in self.program.checkpoints:
            return self.touched[-1]
        made = [c for c in self.program.checkpoints if c != START]
        return made[-1] if made else None

    def _word(self, at: int) -> str:
        return self.tokens[at] if at < len(self.tokens) else ""

    def _one_of(self, at: int, phrases: Sequence[tuple[str, ...]]) -> Iterator[int]:
        """Where each of some phrases ends that stands at a position."""
        for words in phrases:
            if tuple(self.tokens[at : at + len(words)]) == words:
                yield at + len(words)

    def _latest(self, at: int, determined: bool) -> Found:
        """`it`, `that`, `this step`."""
        latest, word = self._newest, self._word(at)
        if latest is None or not self.touched:
            return
        if word in ("it", "that", "this"):
            yield at + 1, (latest,)
        if determined and word in ("that", "this") and self._word(at + 1) in _PART:
            yield at + 2, (latest,)

    def _named(self, at: int) -> Found:
        if self._word(at) in _BEGINNING:
            yield at + 1, (START,)
        for checkpoint in self._made:
            name = phrase(self.program.checkpoints[checkpoint].name)
            end = at + len(name)
            if name and tuple(self.tokens[at:end]) == name:
                yield end, (checkpoint,)
                if self._word(end) in _PART:
                    yield end + 1, (checkpoint,)

    def _counted(self, at: int) -> Found:
        """`second step`, `step two`, `last one`, `first alert`."""
        word, made = self._word(at), self._made
        if not made:
            return
        if word in _PART and self._word(at + 1) == "before":
            end = at + 2 + (self._word(at + 2) == "the")
            yield from ((end + 1, self._nth(made, -2)) for _ in range(self._word(end) == "last"))
        if word in ("step", "checkpoint", "number", "goal"):
            number = at + 1 + (self._word(at + 1) == "number")
            if self._word(number) in _NUMBERS:
                yield number + 1, self._nth(made, _ORDINALS[self._word(number)])
            return
        if word in _PLURALS and self._word(at + 1) in _NUMBERS:
            yield at + 2, self._nth(made, _ORDINALS[self._word(at + 1)])
        if word in _NUMBERS and _PLURALS.intersection(self.tokens):
            yield at + 1, self._nth(made, _ORDINALS[word])
        if word == _MIDDLE and len(made) % 2 == 0:
            return
        if (word not in _ORDINALS and word != _MIDDLE) or word in _NUMBERS:
            return
        number, end = _ORDINALS[word] if word != _MIDDLE else len(made) // 2, at + 1
        if self._word(end) == "but" and self._word(end + 1) == "one" and number == -1:
            number, end = -2, end + 2
        latest = self._newest
        while self._word(end) in _PART:
            end += 1
        if end > at + 1:
            chosen = (latest,) if number == -1 and latest else self._nth(made, number)
            yield end, chosen
        elif self._word(at - 1) in _DETERMINERS and self._word(end) in _BETWEEN:
            yield end, self._nth(made, number)
        for end, ids in self._described(at + 1):
            fitting = sorted(ids, key=made.index)
            yield end, self._nth(fitting, number)

    def _nth(self, ids: Sequence[str], number: int) -> tuple[str, ...]:
        return (ids[number],) if -len(ids) <= number < len(ids) else ()

    def _beside(self, at: int) -> Found:
        """`step before home`, `one after alerted`."""
        if self._word(at) not in _PART or self._word(at + 1) not in ("before", "after", "behind"):
            return
        inner = replace(self, at=at + 2)
        for end, ids in inner._plainly():
            if self._word(at + 1) == "before":
                parent = self.program.parent(ids[0])
                yield end, (parent,) if parent is not None and parent != START else ()
            else:
                yield end, self.program.children(ids[0])

    def _plainly(self) -> Found:
        determined = self._word(self.at) in _DETERMINERS
        yield from self._named(self.at + determined)
        yield from self._counted(self.at + determined)
        yield from self._latest(self.at, determined)

    # By what is done there

    def _described(self, at: int) -> Found:
        if not self._made:
            return
        if self._word(at) in _PART:
            yield from self._part(at + 1)
        yield from self._verbal(at, INFLECTED)
        for start in self._one_of(at, _DOER[:-1]):
            yield from self._verbal(start, ("base",))
            if self._word(start) in ("have", "has"):
                yield from self._verbal(start + 1, ("participle",))
        noun = _NOUNS.get(self._word(at), "")
        if noun:
            asked = frozenset(self.said.get(noun, ()))
            yield at + 1, self._fitting(asked, [])
            yield from self._with_things(asked, at + 1)
        yield from ((end, self._elses) for end in self._otherwise(at))
        yield from self._thing_part(at)

    def _otherwise(self, at: int) -> Iterator[int]:
        """Where `else branch`, `(the) otherwise` or `what happens otherwise` ends."""
        if self._word(at) in ("else", "otherwise", "other") and self._word(at + 1) in _PART:
            yield at + 2
        elif self._word(at) == "otherwise" and self._word(at - 1) in _DETERMINERS:
            yield at + 1
        yield from self._one_of(at, _ELSE)

    @property
    def _elses(self) -> tuple[str, ...]:
        transitions = self.program.transitions.values()
        return tuple(t.target for t in transitions if self.program.is_else(t.id))

    def _part(self, at: int) -> Found:
        """What follows `part`: `where you fetch the tray`, `with the tray`, `where she dismisses it`."""
        done = False
        for start in (at, *self._one_of(at, _WHERE)):
            for inner in (start, *self._one_of(start, _DOER)):
                for found in self._verbal(inner, ("base", *INFLECTED), alone=True):
                    done = done or bool(found[1])
                    yield found
            if start > at:
                yield from self._with_things(None, start)
                if not done:
                    yield from self._conditional(start)

    def _conditional(self, at: int) -> Found:
        """Checkpoints that a condition leads to; it takes all the words that are left."""
        if self.reads is None or at >= len(self.tokens):
            return
        wanted = set(self.reads(self.tokens[at:], self.program))
        fitting = [
            t.target
            for t in self.program.transitions.values()
            if wanted and wanted <= t.conditional
        ]
        yield len(self.tokens), tuple(fitting)

    def _verbal(self, at: int, forms: Sequence[str], alone: bool = False) -> Found:
        word = self._word(at)
        asked = frozenset(
            said
            for form in forms
            for base in self.verbs.bases(word, form)  # type: ignore[arg-type] # form is one of the forms
            for said in self.said.get(base, ())
        )
        if not asked:
            return
        named = forms != ("base",)
        if alone:
            yield at + 1, self._fitting(asked, [])
        if named and self._word(at + 1) in _PART:
            yield at + 2, self._fitting(asked, [])
        if named and self._word(at + 1) == "of":
            yield from self._with_things(asked, at + 2)
        for end, ids in self._with_things(asked, at + 1):
            yield end, ids
            if named and self._word(end) in _PART:
                yield end + 1, ids

    def _behind_order(self, at: int) -> bool:
        """Whether a thing at a position stands for its step: "after the pills"."""
        before = self.tokens[:at]
        if before and before[-1] in _DETERMINERS:
            before = before[:-1]
        return bool(before) and (
            before[-1] in _ORDER or (before[-1] == "and" and "between" in before)
        )

    def _thing_part(self, at: int) -> Found:
        """`newspaper step`, `dismissed branch`."""
        for mention in self.mentions[at] if at < len(self.mentions) else ():
            if not mention.candidates:
                continue
            if self._word(mention.end) in _PART[:3] + _PART[4:]:
                yield mention.end + 1, self._fitting(None, [mention])
            elif self._behind_order(at) and not mention.pronoun:
                fitting = self._fitting(None, [mention])
                yield from [(mention.end, fitting)] * bool(fitting)
        if self._word(at + 1) in _PART:
            word = self._word(at)
            yield (
                at + 2,
                tuple(
                    t.target
                    for t in self.program.transitions.values()
                    if any(x.positive and x.predicate == word for x in t.when)
                ),
            )

    def _with_things(self, asked: Asked | None, at: int) -> Found:
        for end, things in self._things(at):
            yield end, self._fitting(asked, things)

    def _things(self, at: int) -> Iterator[tuple[int, list[Mention]]]:
        """What a description names: at most three things, with small words between them."""
        things: list[Mention] = []
        taken_up = False
        while at < len(self.tokens) and len(things) < _MOST_THINGS:
            here = self.mentions[at] if at < len(self.mentions) else ()
            found = max((m for m in here if m.candidates), key=lambda m: m.end, default=None)
            if found is not None:
                things.append(found)
                at = found.end
                taken_up = True
                yield at, list(things)
            elif self.tokens[at] in _SMALL:
                at += 1
                taken_up = taken_up or self.tokens[at - 1] in _TAKEN_UP
                if taken_up:
                    yield at, list(things)
            else:
                return

    def _fitting(self, asked: Asked | None, things: Sequence[Mention]) -> tuple[str, ...]:
        """The checkpoints that fit best, the latest first."""
        ranked: list[tuple[int, str]] = []
        for checkpoint in reversed(list(self.program.checkpoints)):
            goals = self.program.checkpoints[checkpoint].goals
            literals = [x for goal in goals for x in literals_in(goal)]
            done = [x for x in literals if asked is None or (x.predicate, x.positive) in asked]
            rank = _rank(literals, things)
            if done and rank is not None:
                ranked.append((rank, checkpoint))
        best = min((rank for rank, _ in ranked), default=0)
        return tuple(c for rank, c in ranked if rank == best)


def _rank(literals: Sequence[Literal], things: Sequence[Mention]) -> int | None:
    """How well goals fit what is named, the lower the better; None where they don't."""
    used = {arg for x in literals for arg in x.args}
    total = 0
    for thing in things:
        ranks = [c.rank for c in thing.candidates if c.entity in used]
        if thing.kind and thing.kind in used:
            ranks.append(0)
        if not ranks:
            return None
        total += min(ranks)
    return total
