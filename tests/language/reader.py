"""Reads the YAML cases and plays them to an `Understanding`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import apply_all
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.world_file import read_world

FOLDER = Path(__file__).parent / "cases"
FORMS = ("typed", "spoken", "typed in parts", "spoken in parts")
OUTCOMES = ("applied", "question", "answer", "command", "refused")
CASE_FIELDS = {
    "name", "world", "given", "say", "forms", "expect", "program", "checkpoints", "transitions", "command",
    "options", "unknown", "query", "says", "partial",
}  # fmt: skip


@dataclass(frozen=True)
class Case:
    """One case: what was said before, what is said now, and what comes of it."""

    name: str
    world: str
    given: tuple[str, ...]
    say: tuple[str, ...]
    forms: tuple[str, ...]
    wanted: Mapping[str, Any] = field(hash=False)


@dataclass
class Talk:
    """A dialogue in progress: the program so far and the last interpretation."""

    language: Understanding
    program: Automaton = field(default_factory=Automaton)
    dialogue: Dialogue = field(default_factory=Dialogue)
    last: Interpretation | None = None
    outcomes: list[str] = field(default_factory=list)

    def say(self, utterance: str) -> Interpretation:
        """Interprets an utterance and applies its edits."""
        meant, self.dialogue = self.language.interpret(utterance, self.program, self.dialogue)
        assert meant.outcome in OUTCOMES
        if meant.edits:
            assert meant.outcome == "applied" or meant.partial
            self.program = apply_all(self.program, meant.edits)
        self.last = meant
        self.outcomes.append(meant.outcome)
        return meant


@cache
def language_of(world: str) -> Understanding:
    """The language side of a shipped world."""
    return Understanding(read_world(shipped_worlds()[world]))


def spoken(text: str) -> str:
    """A typed text as a recogniser writes it: lower case, letters, apostrophes and spaces."""
    text = re.sub(r"[^a-z' ]+", " ", text.lower().replace("’", "'"))
    return " ".join(text.split())


def sentences(text: str) -> list[str]:
    """The sentences of a typed text."""
    return [part for part in re.split(r"(?<=[.!?])\s+", text.strip()) if part]


def in_form(utterances: Sequence[str], form: str) -> list[str]:
    """Typed utterances in one of the four forms."""
    said = list(utterances)
    if form.endswith("in parts"):
        said = [part for text in said for part in sentences(text)]
    return [spoken(text) for text in said] if form.startswith("spoken") else said


def read_cases(path: Path) -> Iterator[Case]:
    """The cases of a file.

    Raises:
        ValueError: a case is not as it should be; says which and why.
    """
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    programs = content.get("programs", {})
    names = set()
    for item in content["cases"]:
        name = item.get("name")
        where = f"{path.name}: {name}"
        if not name or name in names:
            raise ValueError(f"{where}: a case needs a name of its own")
        names.add(name)
        strange = set(item) - CASE_FIELDS
        if strange:
            raise ValueError(f"{where}: unknown fields {', '.join(sorted(strange))}")
        if "program" in item:
            if item["program"] not in programs:
                raise ValueError(f"{where}: no program called {item['program']}")
            item = {**programs[item["program"]], **item}
        forms = tuple(item.get("forms", content.get("forms", ("typed", "spoken"))))
        if not forms or set(forms) - set(FORMS):
            raise ValueError(f"{where}: forms are {', '.join(FORMS)}")
        expect = item.setdefault("expect", "applied")
        if expect not in OUTCOMES:
            raise ValueError(f"{where}: expect is one of {', '.join(OUTCOMES)}")
        world = item.get("world", content.get("world"))
        if world is None:
            raise ValueError(f"{where}: which world?")
        yield Case(name, world, _texts(item.get("given")), _texts(item["say"]), forms, item)


def all_cases() -> list[tuple[str, Case]]:
    """Every collected case with its name, file by file."""
    return [
        (path.stem, case) for path in sorted(FOLDER.glob("*.yaml")) for case in read_cases(path)
    ]


def play(case: Case, form: str) -> Talk:
    """Says a case in a form; what was said before goes in as one list, in the same form."""
    talk = Talk(language_of(case.world))
    for utterance in in_form(case.given, form.replace(" in parts", "")):
        talk.say(utterance)
    talk.outcomes.clear()
    for utterance in in_form(case.say, form):
        talk.say(utterance)
    return talk


def play_before(case: Case, form: str) -> Talk:
    """Says only what was said before."""
    return play(replace(case, say=()), form)


def _texts(value: Any) -> tuple[str, ...]:
    if value is None:
        return ()
    return (value,) if isinstance(value, str) else tuple(value)
