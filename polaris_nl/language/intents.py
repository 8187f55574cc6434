"""Intents: what can be said about the program and the plan, a file each in `grammars/<language>/intents`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal as OneOf
from typing import get_args

from polaris_nl.language.grammar_file import GrammarFile, Phrase
from polaris_nl.language.interpretation import Command
from polaris_nl.language.template import Lists, Parts, Slot, slots_in
from polaris_nl.model.errors import GrammarError, did_you_mean
from polaris_nl.model.yaml_lines import Lined

SCHEMA = "polaris-intent/1"
INTENTS = "intents"
"""The folder of the files, beside `common.yaml`."""
Kind = OneOf["command", "query", "edit", "correction"]
_FIELDS = ("schema", "kind", "wordings")

SLOTS: Mapping[str, str] = {
    "x": "an entity",
    "y": "an entity",
    "k": "a checkpoint",
    "l": "a checkpoint",
    "f": "a fact",
    "c": "a condition with its connective",
    "g": "goals",
    "h": "other goals",
    "n": "a name",
    "q": "a number",
}
"""What each slot of a wording stands for."""


@dataclass(frozen=True, slots=True)
class Signature:
    """What an intent is and needs.

    Attributes:
        needs: the slots that every wording has.
        may: the slots that a wording may have besides.
        whole: whether it is an utterance, rather than something said before or behind another.
    """

    kind: Kind
    needs: tuple[str, ...] = ()
    may: tuple[str, ...] = ()
    whole: bool = True

    @property
    def slots(self) -> tuple[str, ...]:
        """All slots."""
        return (*self.needs, *self.may)


SIGNATURES: Mapping[str, Signature] = {
    **{command: Signature("command") for command in get_args(Command)},
    "where": Signature("query", ("x",)),
    "where-robot": Signature("query"),
    "people": Signature("query"),
    "contents": Signature("query", ("x",)),
    "list": Signature("query", ("x",)),
    "meaning": Signature("query", ("x",)),
    "owner": Signature("query", ("x",)),
    "plan": Signature("query", (), ("c", "f")),
    "first": Signature("query"),
    "last": Signature("query"),
    "next": Signature("query"),
    "after-step": Signature("query", ("k",)),
    "before-step": Signature("query", ("k",)),
    "length": Signature("query"),
    "use": Signature("query", ("x",)),
    "when": Signature("query", ("g",)),
    "will": Signature("query", ("g",)),
    "able": Signature("query", ("g",)),
    "is-it": Signature("query", ("f",), ("x",)),
    "what-if-never": Signature("query", (), ("f",)),
    "why-first": Signature("query", ("g",)),
    "why-before": Signature("query", ("g",), ("h", "x")),
    "why-not-before": Signature("query", ("g",), ("h", "x")),
    "why-instead": Signature("query", ("g",), ("h", "x")),
    "why-not-instead": Signature("query", ("g",), ("h", "x")),
    "why-not": Signature("query", ("g",)),
    "why": Signature("query", (), ("g",)),
    "checkpoint": Signature("query", ("k",)),
    "world": Signature("query"),
    "problems": Signature("query"),
    "remove": Signature("edit", ("k",), ("l",)),
    "rename": Signature("edit", ("k", "n")),
    "remove-latest": Signature("edit", ("q",)),
    "remove-rest": Signature("edit", ("k",)),
    "cut-after": Signature("edit", ("k",)),
    "move": Signature("edit", (), ("k", "l", "x")),
    "move-before": Signature("edit", (), ("k", "l", "x", "y")),
    "swap": Signature("edit", (), ("k", "l", "x", "y")),
    "merge": Signature("edit", (), ("k", "l", "x", "y")),
    "split": Signature("edit", ("k",)),
    "connect": Signature("edit", ("k", "l"), ("f",)),
    "else": Signature("edit", ("k",)),
    "condition": Signature("edit", ("k", "c")),
    "unconditional": Signature("edit", (), ("k", "x")),
    "between": Signature("edit", ("g",), ("k", "l")),
    "at-start": Signature("edit", ("g",)),
    "before-that": Signature("edit", ("g",)),
    "before": Signature("edit", ("k", "g")),
    "after": Signature("edit", ("k", "g")),
    "replace": Signature("edit", ("k", "g")),
    "also": Signature("edit", ("k", "g")),
    "together": Signature("edit", ("y", "g")),
    "limit": Signature("edit", ("f",), ("x",)),
    "spare": Signature("edit", ("f",)),
    "correct": Signature("correction", ("x",), ("y", "k", "f")),
    "correct-thing": Signature("correction", ("x",), whole=False),
    "correct-other": Signature("correction", (), ("y",), whole=False),
    "correct-number": Signature("correction", (), ("q",), whole=False),
    "leave-out": Signature("correction", ("x",), ("k",)),
    "correct-lead": Signature("correction", whole=False),
    "correct-aside": Signature("correction", whole=False),
    "correct-noise": Signature("correction", whole=False),
    "correct-tail": Signature("correction", whole=False),
    "correct-needless": Signature("correction", whole=False),
}
"""The intents that the program can act upon."""


@dataclass(frozen=True, slots=True)
class Intent:
    """One intent.

    Attributes:
        wordings: what is understood, in order.
        phrases: for a command, which has no slots, the wordings written out, the longest first.
    """

    name: str
    kind: Kind
    wordings: tuple[Parts, ...]
    phrases: tuple[Phrase, ...] = ()


def read_intent(path: Path, lists: Lists, faults: list[GrammarError] | None = None) -> Intent:
    """Reads the file of one intent.

    Args:
        path: the file; its name is the intent's.
        lists: the lists that its wordings can use.
        faults: takes what is wrong; without it the first fault is raised.

    Raises:
        GrammarError: it is not as it should be; file and line are named.
    """
    file = GrammarFile(path, faults)
    name = path.stem
    fields = file.root(SCHEMA, "An intent", _FIELDS)
    signature = SIGNATURES.get(name)
    if signature is None:
        file.fault(
            f"There is no intent {name}; name the file after one.{did_you_mean(name, SIGNATURES)}",
            1,
        )
        return Intent(name, "query", ())
    _check_kind(file, fields, name, signature)

    def slot_fault(slot: Slot) -> str:
        if slot.name not in signature.slots:
            hint = _slots_of(name, signature)
            return f"{{{slot.name}}} is no slot of the intent {name}; {hint}."
        return f"The slot {{{slot.name}:{slot.type}}} takes no type here." if slot.type else ""

    wordings: list[Parts] = []
    for text, line in file.items(fields.get("wordings"), "wordings"):
        template = file.wording(text, line, lists, slot_fault)
        if template is None:
            continue
        missing = set(signature.needs) - {slot.name for slot in slots_in(template)}
        if missing:
            file.fault(f"{text!r} lacks {{{min(missing)}}}; {_slots_of(name, signature)}.", line)
        wordings.append(template)
    if not wordings:
        file.fault(f"The intent {name} has no wordings; list what is said.", 1)
    return Intent(name, signature.kind, tuple(wordings), _phrases(file, signature, wordings))


def _check_kind(
    file: GrammarFile, fields: Mapping[str, Lined], name: str, signature: Signature
) -> None:
    kind = fields.get("kind", Lined("", 1))
    with file.kept():
        if kind.text("kind") != signature.kind:
            file.fault(f"The intent {name} has kind: {signature.kind}; write that.", kind.line)


def _phrases(file: GrammarFile, signature: Signature, wordings: list[Parts]) -> tuple[Phrase, ...]:
    if signature.kind != "command":
        return ()
    found = {phrase for template in wordings for phrase in file.written_out(template)}
    return tuple(sorted(found, key=lambda p: (-len(p), p)))


def _slots_of(name: str, signature: Signature) -> str:
    if not signature.slots:
        return "it has none"
    return "its slots are " + ", ".join(f"{{{s}}} ({SLOTS[s]})" for s in signature.slots)
