"""How one predicate is talked about: what is understood, and what is said."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from polaris_nl.language.grammar_file import GrammarFile
from polaris_nl.language.mention import WORDLESS
from polaris_nl.language.template import NAMED, Lists, Parts, Slot, Source
from polaris_nl.model.domain import Predicate
from polaris_nl.model.errors import did_you_mean
from polaris_nl.model.formula import Variable
from polaris_nl.model.text import listed
from polaris_nl.model.yaml_lines import Lined

WORDINGS = ("goals", "not-goals", "states", "not-states", "asks", "seeks", "told", "ellipsis")
TEXTS = ("fact", "not-fact", "goal", "not-goal", "event", "not-event", "name", "not-name")
BE = "<be>"
"""The list of the forms of "be", which are exchanged where a state is wished for or denied."""
ADJECTIVES = ("adjectives", "not-adjectives")
SAID, AGENT = "said", "agent"
"""In a text, `{m:said}` is what a message says ("that lunch is ready"), and `{r:agent}` nothing where it
is the only robot, else "have ann"."""
_TEXT_SLOT = re.compile(r"\{([\w-]*)(?::([\w-]*))?\}|[{}]")


@dataclass(frozen=True, slots=True)
class Phrases:
    """How one predicate is talked about.

    Attributes:
        wordings: by kind (goals, states, ...): what is understood.
        texts: by kind (fact, goal, event, name, ...): what is said.
        adjectives: words before a noun that mean the predicate; not_adjectives: its negation.
        source: where they are written, or None where they are made.
    """

    predicate: str
    wordings: Mapping[str, tuple[Parts, ...]] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)
    adjectives: tuple[str, ...] = ()
    not_adjectives: tuple[str, ...] = ()
    source: Source | None = None


def read_phrases(
    file: GrammarFile,
    predicate: Predicate,
    value: Lined,
    lists: Lists,
    types: Collection[str],
) -> Phrases:
    """Reads the phrases of a predicate.

    Args:
        file: takes what is wrong.
        predicate: the predicate, for its parameters.
        value: its entry in the file.
        lists: the lists that wordings can use.
        types: the types of the domain, for slots such as `{p:person}`.
    """
    name = predicate.name
    fields = file.fields(value, f"The predicate {name}", (*WORDINGS, *TEXTS, *ADJECTIVES))

    def slot_fault(slot: Slot) -> str:
        if slot.type and slot.type not in (*types, *WORDLESS, NAMED):
            return f"There is no type {slot.type}.{did_you_mean(slot.type, types)}"
        return (
            "" if slot.type else _unknown_slot(slot.name, f"predicate {name}", predicate.parameters)
        )

    wordings: dict[str, list[Parts]] = {key: [] for key in WORDINGS}
    for key in WORDINGS:
        for text, line in file.items(fields.get(key), key):
            template = file.wording(text, line, lists, slot_fault)
            if template is None:
                continue
            wordings[key].append(template)
            for kind, written in _variants(key, text):
                template = file.wording(written, line, lists, slot_fault)
                if template is not None:
                    wordings.setdefault(kind, []).append(template)
    adjectives = [tuple(t for t, _ in file.items(fields.get(key), key)) for key in ADJECTIVES]
    return Phrases(
        name,
        {kind: tuple(templates) for kind, templates in wordings.items()},
        dict(_texts(file, fields, predicate)),
        adjectives[0],
        adjectives[1],
        Source(file.path, value.line, name),
    )


def _variants(key: str, text: str) -> Iterator[tuple[str, str]]:
    """A wording, and what follows from it: a state can be wished for, denied, or lack its verb.

    Yields:
        The kind of each, and its text: `denied-states` "the cup isn't on the table", `wished-states`
        "the cup should be on the table", `small-states` "(I want) the cup on the table".
    """
    if key not in ("states", "not-states"):
        return
    if BE in text:
        yield f"wished-{key}", text.replace(BE, "<shall-be>")
        yield f"small-{key}", text.replace(BE, "[both|all] [back|to be]")
        yield f"denied-{key}", text.replace(BE, "<not-be>")
        yield f"wished-denied-{key}", text.replace(BE, "<shall-not-be>")
    elif "~" in text and "!~" not in text:
        yield f"wished-{key}", text.replace("~", "?~")
    if "~" in text and "!~" not in text:
        yield f"denied-{key}", text.replace("~", "!~")


def _texts(
    file: GrammarFile, fields: Mapping[str, Lined], predicate: Predicate
) -> Iterator[tuple[str, str]]:
    for key in TEXTS:
        if key in fields:
            with file.kept():
                text = fields[key].text(key)
                owner = f"predicate {predicate.name}"
                check_text(file, text, fields[key].line, owner, predicate.parameters)
                yield key, text


def check_text(
    file: GrammarFile, text: str, line: int, owner: str, parameters: Sequence[Variable]
) -> None:
    """Looks for slots that what is said can't fill."""
    for slot in _TEXT_SLOT.finditer(text):
        if slot[1] is None:
            reason = f"The {slot[0]} is never closed or opened; write {{slot}}."
        elif slot[2] not in (None, SAID, AGENT):
            forms = listed([f"{{{slot[1]}{kind}}}" for kind in ("", f":{SAID}", f":{AGENT}")], "or")
            reason = f"What is said has no {slot[0]}; write {forms}."
        else:
            reason = _unknown_slot(slot[1], owner, parameters)
        if reason:
            file.fault(f"{reason} It stands in {text!r}.", line)
            return


def _unknown_slot(name: str, owner: str, parameters: Sequence[Variable]) -> str:
    known = [p.name.lstrip("?") for p in parameters]
    if name in known:
        return ""
    hint = did_you_mean(name, known) if known else " It has none."
    return f"The {owner} has no parameter ?{name} for {{{name}}}.{hint}"
