"""Wordings that get in each other's way: one that is never reached, or words that mean two things.

What wordings stand for is written out, as far as it is not too much, and compared with slots left
blank.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from polaris_nl.language.common import Common
from polaris_nl.language.expansions import expansions
from polaris_nl.language.grammar import Grammar
from polaris_nl.language.intents import SIGNATURES, SLOTS
from polaris_nl.language.template import Parts, Slot
from polaris_nl.model.domain import Domain
from polaris_nl.model.errors import GrammarError
from polaris_nl.model.text import listed

MOST = 2_000
"""What a wording is written out to; of one that stands for more, so many are looked at."""
SHOWN = 3
"""Examples and lines that are named in one warning."""
_ROLES: Mapping[str, tuple[str, bool]] = {
    "goals": ("goal", True),
    "asks": ("goal", True),
    "not-goals": ("goal", False),
    "states": ("state", True),
    "not-states": ("state", False),
    "ellipsis": ("rest", True),
}
_ORDER = ("command", "correction", "edit", "query")
"""The kinds of intents in the order in which an utterance is tried for them."""


@dataclass(frozen=True)
class _Entry:
    """A wording and what it means."""

    owner: str
    positive: bool
    template: Parts
    types: Mapping[str, tuple[str, ...]] = field(default_factory=dict, hash=False)

    @property
    def meaning(self) -> str:
        return self.owner if self.positive else f"not {self.owner}"

    @property
    def place(self) -> str:
        source = self.template.source
        return f"{source.path.name}, line {source.line}" if source else "its name"

    def slot_types(self, slot: Slot) -> tuple[str, ...]:
        return slot.types(self.types)


_Key = tuple[str, ...]
_Index = dict[_Key, list[tuple[_Entry, tuple[Slot, ...]]]]


def predicate_overlaps(grammar: Grammar, domain: Domain) -> Iterator[GrammarError]:
    """Warnings about the wordings of a domain's predicates."""
    for role in dict.fromkeys(role for role, _ in _ROLES.values()):
        entries = list(_predicate_entries(grammar, domain, role))
        index = _indexed(entries)
        for number, entry in enumerate(entries):
            yield from _unreached(entry, index, domain, entries[:number])
        yield from _fought_for(index, domain)
    yield from _adjectives(grammar)


def intent_overlaps(common: Common) -> Iterator[GrammarError]:
    """Warnings about intents: wordings that an earlier one takes, or another wording of the same."""
    intents = sorted(common.intents, key=lambda i: _ORDER.index(i.kind))
    entries = [_Entry(i.name, True, t) for i in intents for t in i.wordings]
    index = _indexed(entries)
    whole = {name for name, signature in SIGNATURES.items() if signature.whole}
    for number, entry in enumerate(entries):
        before = set(map(id, entries[:number]))
        takers = []
        for key, slots in _written_out(entry):
            names = [SLOTS.get(s.name) for s in slots]
            takers.append(
                [
                    other
                    for other, theirs in index[key]
                    if id(other) in before
                    and (other.owner == entry.owner or {other.owner, entry.owner} <= whole)
                    and [SLOTS.get(s.name) for s in theirs] == names
                ]
            )
        if takers and all(takers):
            others = list(dict.fromkeys(other for found in takers for other in found))
            yield _never_reached(entry, others)


def _predicate_entries(grammar: Grammar, domain: Domain, role: str) -> Iterator[_Entry]:
    for name, phrases in grammar.predicates.items():
        predicate = domain.predicates.get(name)
        if predicate is None:
            continue
        types = {p.name.lstrip("?"): p.types for p in predicate.parameters}
        for key, templates in phrases.wordings.items():
            kind, positive = _ROLES.get(key, ("", True))
            if kind == role:
                yield from (_Entry(name, positive, t, types) for t in templates if t.source)


def _written_out(entry: _Entry) -> Iterator[tuple[_Key, tuple[Slot, ...]]]:
    for said in expansions(entry.template, MOST):
        key = tuple(part if isinstance(part, str) else "" for part in said)
        yield key, tuple(part for part in said if isinstance(part, Slot))


def _indexed(entries: Sequence[_Entry]) -> _Index:
    index: _Index = {}
    for entry in entries:
        for key, slots in _written_out(entry):
            index.setdefault(key, []).append((entry, slots))
    return index


def _unreached(
    entry: _Entry, index: _Index, domain: Domain, before: Sequence[_Entry]
) -> Iterator[GrammarError]:
    """Whether other wordings of the same predicate take all that a wording stands for.

    Of two that stand for the same, the later one is to blame.
    """
    earlier = set(map(id, before))
    takers: list[list[_Entry]] = []
    for key, slots in _written_out(entry):
        takers.append(
            [
                other
                for other, theirs in index[key]
                if other is not entry
                and (other.owner, other.positive) == (entry.owner, entry.positive)
                and _narrower(entry, slots, other, theirs, domain)
                and (id(other) in earlier or not _same(entry, other))
            ]
        )
        if not takers[-1]:
            return
    yield _never_reached(entry, list(dict.fromkeys(o for found in takers for o in found)))


def _same(one: _Entry, other: _Entry) -> bool:
    return dict(_written_out(one)).keys() == dict(_written_out(other)).keys()


def _narrower(
    entry: _Entry, slots: Sequence[Slot], other: _Entry, theirs: Sequence[Slot], domain: Domain
) -> bool:
    """Whether another wording's slots take everything that a wording's slots take."""
    for mine, its in zip(slots, theirs, strict=True):
        wide = other.slot_types(its)
        narrow = entry.slot_types(mine)
        if mine.name != its.name:
            return False
        if wide and not (narrow and all(any(domain.is_a(n, w) for w in wide) for n in narrow)):
            return False
    return True


def _never_reached(entry: _Entry, others: Sequence[_Entry]) -> GrammarError:
    source = entry.template.source
    assert source is not None
    places = listed([f"{o.place} ({o.meaning})" for o in others[:SHOWN]])
    return GrammarError(
        f"{source.text!r} is never reached: all that it stands for is taken by {places}; take it out.",
        source.path,
        source.line,
    )


def _fought_for(index: _Index, domain: Domain) -> Iterator[GrammarError]:
    """Words that mean two predicates, or one and its negation, for entities of the same types."""
    found: dict[tuple[int, int], tuple[_Entry, _Entry, list[str]]] = {}
    for key, users in index.items():
        for number, (later, slots) in enumerate(users):
            for earlier, theirs in users[:number]:
                if earlier.meaning != later.meaning and _overlap(
                    later, slots, earlier, theirs, domain
                ):
                    pair = found.setdefault((id(earlier), id(later)), (earlier, later, []))
                    pair[2].append(_example(key, slots))
    for earlier, later, examples in found.values():
        source = later.template.source
        assert source is not None
        words = listed([f'"{e}"' for e in dict.fromkeys(examples)][:SHOWN])
        yield GrammarError(
            f"{words} means {later.meaning} here and {earlier.meaning} in {earlier.place}; "
            "take it out of one of them.",
            source.path,
            source.line,
        )


def _overlap(
    one: _Entry, slots: Sequence[Slot], other: _Entry, theirs: Sequence[Slot], domain: Domain
) -> bool:
    return all(
        _common_type(one.slot_types(mine), other.slot_types(its), domain)
        for mine, its in zip(slots, theirs, strict=True)
    )


def _common_type(some: Sequence[str], others: Sequence[str], domain: Domain) -> bool:
    if not some or not others:
        return True
    kinds = {*domain.types, *some, *others}
    return any(
        any(domain.is_a(kind, a) for a in some) and any(domain.is_a(kind, b) for b in others)
        for kind in kinds
    )


def _example(key: _Key, slots: Sequence[Slot]) -> str:
    names = iter(slots)
    return " ".join(word or f"{{{next(names).name}}}" for word in key)


def _adjectives(grammar: Grammar) -> Iterator[GrammarError]:
    """Adjectives of two predicates."""
    owners: dict[str, str] = {}
    for phrases in grammar.predicates.values():
        for words, sign in ((phrases.adjectives, ""), (phrases.not_adjectives, "not ")):
            for word in words:
                meaning = f"{sign}{phrases.predicate}"
                other = owners.setdefault(word, meaning)
                if other != meaning and phrases.source is not None:
                    yield GrammarError(
                        f'The adjective "{word}" means {meaning} here and {other} elsewhere; '
                        "take it out of one of them.",
                        phrases.source.path,
                        phrases.source.line,
                    )
