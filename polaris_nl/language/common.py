"""What every domain's grammar shares: word classes, connectives, and the intents."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from polaris_nl.language.expansions import expansions
from polaris_nl.language.grammar_file import GrammarFile, Phrase
from polaris_nl.language.intents import INTENTS, Intent, Kind, read_intent
from polaris_nl.language.template import Lists, Parts, parse_template, vocabulary
from polaris_nl.language.tokens import phrase
from polaris_nl.model.errors import GrammarError, did_you_mean
from polaris_nl.model.yaml_lines import Lined

SCHEMA = "polaris-grammar/1"
MARKS = (
    "and", "or", "then", "if", "until", "unless", "else", "not", "before", "done", "purpose", "given", "polite",
    "nothing"
)  # fmt: skip
"""The connectives that there are."""
_FIELDS = (
    "schema", "lists", INTENTS, "fillers", "assure", "connectives", "refused", "pronouns", "determiners",
    "possessives", "all", "both", "rest", "none", "excepting", "quantified", "numbers", "ordinals", "neither",
    "irregular", "asides", "contrast", "reasons", "telling", "descriptors", "markers", "hesitations", "needing",
    "homophones", "again", "beside", "whereabouts", "remarks",
)  # fmt: skip


@dataclass(frozen=True)
class Common:
    """The content of `common.yaml` and of the intents beside it. Phrases come the longest first.

    Attributes:
        lists: wordings that others use as `<name>`.
        intents: in the order in which they are tried.
        fillers: skipped wherever they stand.
        assure: "make sure that", in front of a state.
        connectives: by mark (`and`, `then`, `if`, ...).
        refused: by word, why a goal with it is refused.
        pronouns: by pronoun, the types that it can stand for.
        determiners: "the", "some".
        possessives: by word, the gender of the owner, `user` for the one who speaks, or "".
        all: "all the".
        both: "both of".
        rest: "the rest of", "the other".
        none: "none of the", "no".
        excepting: "except", before what is left out of all.
        quantified: by noun that is a quantifier too ("everything", "nobody"), which one.
        numbers: by word.
        ordinals: by word; the last is -1.
        neither: answers that choose nothing.
        irregular: by verb, its past forms, several with spaces between them.
        asides: what is said beside goals and asks for nothing: "i am cold".
        contrast: before what is not meant: "not", "instead of".
        reasons: before why something is asked for: "so that", "because".
        telling: verbs of what is only told of people: "says", "is", "left".
        descriptors: adjectives that only describe, such as "old".
        markers: what people say before they correct themselves: "no sorry".
        hesitations: what may be one, and mostly isn't: "um", "wait".
        needing: between a thing and what is to be done with it: "needs", "must be".
        homophones: groups of words that sound alike.
        beside: before a thing that only says where another one is: "next to".
        whereabouts: what is said behind a thing and tells nothing: "on the floor".
        remarks: how a sentence behind a request begins that only says why: "she'll be", "there's no".
        again: wordings with {x} that ask for the same with another thing.
        language: the folder's name.
    """

    lists: Lists = field(default_factory=Lists)
    intents: tuple[Intent, ...] = ()
    fillers: tuple[Phrase, ...] = ()
    assure: tuple[Phrase, ...] = ()
    connectives: Mapping[str, tuple[Phrase, ...]] = field(default_factory=dict)
    refused: Mapping[str, str] = field(default_factory=dict)
    pronouns: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    determiners: tuple[Phrase, ...] = ()
    possessives: Mapping[str, str] = field(default_factory=dict)
    all: tuple[Phrase, ...] = ()
    both: tuple[Phrase, ...] = ()
    rest: tuple[Phrase, ...] = ()
    none: tuple[Phrase, ...] = ()
    excepting: tuple[Phrase, ...] = ()
    quantified: Mapping[str, str] = field(default_factory=dict)
    numbers: Mapping[str, int] = field(default_factory=dict)
    ordinals: Mapping[str, int] = field(default_factory=dict)
    neither: tuple[Phrase, ...] = ()
    irregular: Mapping[str, str] = field(default_factory=dict)
    asides: tuple[Phrase, ...] = ()
    contrast: tuple[Phrase, ...] = ()
    reasons: tuple[Phrase, ...] = ()
    telling: tuple[Phrase, ...] = ()
    descriptors: tuple[Phrase, ...] = ()
    markers: tuple[Phrase, ...] = ()
    hesitations: tuple[Phrase, ...] = ()
    needing: tuple[Phrase, ...] = ()
    homophones: tuple[Phrase, ...] = ()
    beside: tuple[Phrase, ...] = ()
    whereabouts: tuple[Phrase, ...] = ()
    remarks: tuple[Phrase, ...] = ()
    again: tuple[Parts, ...] = ()
    language: str = "en"

    def of_kind(self, kind: Kind) -> tuple[Intent, ...]:
        """The intents of a kind, in order."""
        return tuple(intent for intent in self.intents if intent.kind == kind)

    @cached_property
    def vocabulary(self) -> frozenset[str]:
        """Every word of the intents and of the word classes."""
        wordings = (template for intent in self.intents for template in intent.wordings)
        listed = (self.fillers, self.assure, self.determiners, self.all, self.both)
        others = (
            self.rest, self.none, self.excepting, self.neither, self.markers, self.contrast, self.reasons
        )  # fmt: skip
        keyed = (
            self.refused, self.pronouns, self.possessives, self.numbers, self.ordinals, self.quantified
        )  # fmt: skip
        phrases = (
            *listed,
            *others,
            *self.connectives.values(),
            map(phrase, itertools.chain(*keyed)),
        )
        return frozenset(
            itertools.chain(
                *map(vocabulary, (*wordings, *self.again)), *itertools.chain.from_iterable(phrases)
            )
        )

    def listed(self, name: str) -> tuple[Phrase, ...]:
        """The phrases of a list without slots, the longest first; none where there is no such list."""
        if name not in self.lists:
            return ()
        found = {
            tuple(word for word in words if isinstance(word, str))
            for words in expansions(parse_template(self.lists[name], self.lists))
        }
        return tuple(sorted(found, key=lambda p: (-len(p), p)))


def read_common(path: Path, faults: list[GrammarError] | None = None) -> Common:
    """Reads `common.yaml` and the intents in the folder beside it.

    Args:
        path: the file.
        faults: takes what is wrong; without it the first fault is raised.

    Raises:
        FileError: it can't be read.
        GrammarError: it is not as it should be; file and line are named.
    """
    file = GrammarFile(path, faults)
    fields = file.root(SCHEMA, "A grammar", _FIELDS)
    file.irregular = file.texts(fields.get("irregular"), "irregular")
    lists = file.lists(fields.get("lists"))

    def phrases(key: str) -> tuple[Phrase, ...]:
        return file.phrases(fields.get(key), key, lists)

    marks = file.fields(fields.get("connectives"), "connectives", MARKS)
    pronouns = file.fields(fields.get("pronouns"), "pronouns")
    return Common(
        lists=lists,
        intents=_intents(file, fields.get(INTENTS), lists, faults),
        fillers=phrases("fillers"),
        assure=phrases("assure"),
        connectives={mark: file.phrases(item, mark, lists) for mark, item in marks.items()},
        refused=file.texts(fields.get("refused"), "refused"),
        pronouns={
            name: tuple(kind for kind, _ in file.items(item, name))
            for name, item in pronouns.items()
        },
        determiners=phrases("determiners"),
        possessives=file.texts(fields.get("possessives"), "possessives"),
        all=phrases("all"),
        both=phrases("both"),
        rest=phrases("rest"),
        none=phrases("none"),
        excepting=phrases("excepting"),
        quantified=file.texts(fields.get("quantified"), "quantified"),
        numbers=file.numbers(fields.get("numbers"), "numbers"),
        ordinals=file.numbers(fields.get("ordinals"), "ordinals"),
        neither=phrases("neither"),
        irregular=file.irregular,
        asides=phrases("asides"),
        contrast=phrases("contrast"),
        reasons=phrases("reasons"),
        telling=phrases("telling"),
        descriptors=phrases("descriptors"),
        markers=phrases("markers"),
        hesitations=phrases("hesitations"),
        needing=phrases("needing"),
        homophones=tuple(
            phrase(text) for text, _ in file.items(fields.get("homophones"), "homophones")
        ),
        beside=phrases("beside"),
        whereabouts=phrases("whereabouts"),
        remarks=phrases("remarks"),
        again=tuple(
            template
            for text, line in file.items(fields.get("again"), "again")
            if (template := file.wording(text, line, lists, lambda slot: "")) is not None
        ),
        language=path.resolve().parent.name,
    )


def _intents(
    file: GrammarFile,
    value: Lined | None,
    lists: Lists,
    faults: list[GrammarError] | None,
) -> tuple[Intent, ...]:
    found = []
    there = {p.stem: p for p in sorted(file.path.with_name(INTENTS).glob("*.yaml"))}
    for name, line in file.items(value, INTENTS):
        if name in there:
            found.append(read_intent(there.pop(name), lists, faults))
        else:
            file.fault(
                f"There is no file {INTENTS}/{name}.yaml; write it, or take {name} out."
                f"{did_you_mean(name, there)}",
                line,
            )
    for name in there:
        file.fault(
            f"The file {INTENTS}/{name}.yaml is not used; add {name} to intents.",
            value.line if value is not None else 1,
        )
    return tuple(found)
