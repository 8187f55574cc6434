"""Plays `intents/*.yaml`: for every intent, sentences that must be it, with what they yield, and near misses.

A file names its `world` and, for all its sentences, what was said before (`given`); `kind` is the kind of
query, where it isn't the intent's name. `yields` are
sentences that must be the intent, `never` near misses; each is a text, or has `say`, its own `given`,
and what comes of it:

- `entity`, `literal`, `when`, `checkpoint`: of a query;
- `checkpoints`, `transitions`: the whole program after an edit, as `{name: [goals]}` and
  `a -> b when (fact)`;
- `becomes`: of a near miss an outcome, a command, a kind of query, or `same` (nothing changes); of an
  edit the outcome, where it is a question.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.intents import SIGNATURES
from polaris_nl.model.data import data_folder

from .reader import Talk, language_of, spoken

FOLDER = Path(__file__).parent / "intents"
INTENTS = data_folder("grammars") / "en" / "intents"
POSITIVE, NEGATIVE = 3, 1
FIELDS = {
    "say",
    "given",
    "entity",
    "literal",
    "when",
    "checkpoint",
    "checkpoints",
    "transitions",
    "becomes",
}


def mirrors() -> Iterator[tuple[str, Mapping[str, Any]]]:
    for path in sorted(FOLDER.glob("*.yaml")):
        yield path.stem, yaml.safe_load(path.read_text(encoding="utf-8"))


def sentences(key: str) -> list[Any]:
    return [
        pytest.param(
            name, content, item if isinstance(item, dict) else {"say": item}, id=f"{name}: {number}"
        )
        for name, content in mirrors()
        for number, item in enumerate(content[key], 1)
    ]


def test_every_intent_has_its_mirror() -> None:
    assert {p.name for p in INTENTS.glob("*.yaml")} == {p.name for p in FOLDER.glob("*.yaml")}
    assert {p.stem for p in INTENTS.glob("*.yaml")} == set(SIGNATURES)


@pytest.mark.parametrize(("name", "content"), [pytest.param(*m, id=m[0]) for m in mirrors()])
def test_a_mirror_says_enough(name: str, content: Mapping[str, Any]) -> None:
    assert set(content) <= {"world", "given", "kind", "yields", "never"}
    assert len(content["yields"]) >= POSITIVE
    assert len(content["never"]) >= NEGATIVE
    for item in (*content["yields"], *content["never"]):
        assert isinstance(item, str) or set(item) <= FIELDS
        if SIGNATURES[name].kind in ("edit", "correction"):
            assert {"checkpoints", "transitions", "becomes"} & set(item), item


@pytest.mark.parametrize("form", ["typed", "spoken"])
@pytest.mark.parametrize(("name", "content", "item"), sentences("yields"))
def test_it_is_the_intent(
    name: str, content: Mapping[str, Any], item: Mapping[str, Any], form: str
) -> None:
    talk, _ = said(content, item, form)
    kind = SIGNATURES[name].kind
    last = talk.last
    assert last is not None
    if kind == "command":
        assert (last.outcome, last.command) == ("command", name), last.say
    elif kind == "query":
        assert last.query is not None, last.say
        assert last.query.kind == content.get("kind", name)
        check_query(talk, item)
    else:
        assert last.outcome == item.get("becomes", "applied"), last.say
        check_program(talk.program, item)


@pytest.mark.parametrize("form", ["typed", "spoken"])
@pytest.mark.parametrize(("name", "content", "item"), sentences("never"))
def test_a_near_miss_is_not(
    name: str, content: Mapping[str, Any], item: Mapping[str, Any], form: str
) -> None:
    talk, earlier = said(content, item, form)
    last = talk.last
    assert last is not None
    kind = last.query.kind if last.query else ""
    assert content.get("kind", name) not in (last.command, kind), last.say
    if "becomes" in item:
        same = "same" if talk.program == earlier else "changed"
        assert item["becomes"] in (last.outcome, last.command, kind, same), last.say
    check_program(talk.program, item)


def said(content: Mapping[str, Any], item: Mapping[str, Any], form: str) -> tuple[Talk, Automaton]:
    """The dialogue after a sentence, and the program before it."""
    given = item.get("given", content.get("given", []))
    world = content.get("world", "care-home")
    program, dialogue = before((given,) if isinstance(given, str) else tuple(given), world)
    talk = Talk(language_of(world), program, dialogue)
    talk.say(spoken(item["say"]) if form == "spoken" else item["say"])
    return talk, program


@cache
def before(given: tuple[str, ...], world: str) -> tuple[Automaton, Dialogue]:
    """The program and the dialogue after what was said before."""
    talk = Talk(language_of(world))
    for text in given:
        assert talk.say(text).outcome == "applied", text
    return talk.program, talk.dialogue


def check_query(talk: Talk, item: Mapping[str, Any]) -> None:
    assert talk.last is not None
    query = talk.last.query
    assert query is not None
    if "entity" in item:
        assert query.entity == item["entity"]
    if "literal" in item:
        assert str(query.literal) == item["literal"]
    if "when" in item:
        assert [str(x) for x in query.when] == item["when"]
    if "checkpoint" in item:
        assert query.checkpoint is not None
        assert talk.program.checkpoints[query.checkpoint].name == item["checkpoint"]


def check_program(program: Automaton, item: Mapping[str, Any]) -> None:
    names = {c.id: c.name for c in program.checkpoints.values()}
    if "checkpoints" in item:
        found = {
            c.name: sorted(map(str, c.goals)) for c in program.checkpoints.values() if c.id != START
        }
        assert found == {name: sorted(goals) for name, goals in item["checkpoints"].items()}
    if "transitions" in item:
        arrows = [
            f"{names[t.source]} -> {names[t.target]}"
            + (f" when {' '.join(sorted(map(str, t.when)))}" if t.when else "")
            for t in program.transitions.values()
        ]
        assert sorted(arrows) == sorted(item["transitions"])
