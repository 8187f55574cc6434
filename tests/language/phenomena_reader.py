"""Reads the utterance suite of `phenomena/` and `held_out/`.

Both folders have a YAML file for each phenomenon. A file is a list of `cases` (and may set `world`):

    - name: fill, then carry          # once in the file; the other folder has other wordings of it
      world: care-home
      given: [Go to the kitchen.]     # said before, in the same form (optional)
      wordings: [Fill the tray., ...] # each said alone, after `given`; each must come out the same
      forms: [typed, spoken]          # if nothing is said: both
      expect: applied                 # or question, answer, command, refused; a list: any of them
      checkpoints: [["(is-full tray)"], {label: b, goals: [...], may_split: true, name: ...}]
      transitions: [{from: start, to: b, when: [...]}]

`checkpoints` and `transitions` are the whole program afterwards, what was given included. Without
`transitions` the checkpoints are a sequence in this order. `from` and `to` are a label, a name or a
list of goals. A checkpoint has a name only where the user gives one. `may_split`: "A and B" is one
checkpoint or a sequence, cut anywhere between goals but in the order given. `either` is a list of
`{checkpoints, transitions}`, any of which is right. A goal "for all dishes" is the same as its dishes
one by one; where it depends on facts ("every dirty dish"), `either` says so.

`command`, `options` (of a question, in any order, each perhaps in more words), `unknown` (words that
a refusal names) and `query` are compared where they are given. `partial: true` lets a question keep a
clear part: `checkpoints` or `either` says which.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from polaris_nl.model.check import formula_faults
from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.domain import KIND
from polaris_nl.model.formula import Formula, Literal, literals_in, parse_formula
from polaris_nl.model.world import World
from polaris_nl.model.world_file import read_world

from .phenomena_steps import Step, normal, ordered
from .reader import OUTCOMES, in_form

FOLDERS = (Path(__file__).parent / "phenomena", Path(__file__).parent / "held_out")
FORMS = ("typed", "spoken")
CASE_FIELDS = {
    "name", "world", "given", "wordings", "forms", "expect", "checkpoints", "transitions", "either",
    "command", "options", "unknown", "query", "partial",
}  # fmt: skip
PROGRAM_FIELDS = {"checkpoints", "transitions"}
CHECKPOINT_FIELDS = {"label", "name", "goals", "may_split"}
TRANSITION_FIELDS = {"from", "to", "when"}
QUERY_FIELDS = {"kind", "when", "entity", "literal"}
ONLY_WITH = {"command": "command", "options": "question", "unknown": "refused", "query": "answer"}


@dataclass(frozen=True)
class PhenomenonCase:
    """One thing that people want, the ways in which they say it, and what must come of each."""

    phenomenon: str
    name: str
    held_out: bool
    world: str
    given: tuple[str, ...]
    wordings: tuple[str, ...]
    forms: tuple[str, ...]
    expect: tuple[str, ...]
    programs: tuple[tuple[Step, ...], ...] = field(repr=False)
    wanted: Mapping[str, Any] = field(hash=False, repr=False)


@cache
def world_of(name: str) -> World:
    """A shipped world."""
    return read_world(shipped_worlds()[name])


def all_phenomena() -> list[PhenomenonCase]:
    """Every case of both folders.

    Raises:
        ValueError: a case is not as it should be; says which and why.
    """
    found: dict[tuple[str, str], PhenomenonCase] = {}
    cases = []
    for folder in FOLDERS:
        for path in sorted(folder.glob("*.yaml")):
            for case in read_phenomenon(path):
                cases.append(case)
                other = found.setdefault((case.phenomenon, case.name), case)
                if _without_wordings(other) != _without_wordings(case):
                    raise ValueError(f"{path.stem}: {case.name}: the two folders expect different")
    said = Counter(
        (c.world, c.given, form, *in_form([w], form))
        for c in cases
        for w in c.wordings
        for form in c.forms
    )
    twice = sorted(str(key) for key, count in said.items() if count > 1)
    if twice:
        raise ValueError(f"said twice: {'; '.join(twice)}")
    return cases


def read_phenomenon(path: Path) -> list[PhenomenonCase]:
    """The cases of a file.

    Raises:
        ValueError: a case is not as it should be; says which and why.
    """
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    return list(cases_in(content, path.stem, path.parent.name == "held_out"))


def cases_in(content: Any, phenomenon: str, held_out: bool = False) -> Iterator[PhenomenonCase]:
    """The cases of a file's content.

    Raises:
        ValueError: a case is not as it should be; says which and why.
    """
    if strange := set(content) - {"world", "cases"}:
        raise ValueError(f"{phenomenon}: unknown fields {', '.join(sorted(strange))}")
    names: set[str] = set()
    for item in content["cases"]:
        name = item.get("name")
        try:
            if not isinstance(name, str) or name in names:
                raise ValueError("a case needs a name of its own")
            names.add(name)
            yield _case({"world": content.get("world"), **item}, phenomenon, held_out)
        except ValueError as fault:
            raise ValueError(f"{phenomenon}: {name}: {fault}") from fault


def _case(item: Mapping[str, Any], phenomenon: str, held_out: bool) -> PhenomenonCase:
    _only(item, CASE_FIELDS)
    if item["world"] not in shipped_worlds():
        raise ValueError(f"which world is {item['world']}?")
    world = world_of(item["world"])
    expect = listed(item.get("expect", "applied"))
    if not expect or set(expect) - set(OUTCOMES):
        raise ValueError(f"expect is one of {', '.join(OUTCOMES)}")
    forms = listed(item.get("forms", FORMS))
    if not forms or set(forms) - set(FORMS):
        raise ValueError(f"forms are {', '.join(FORMS)}")
    wordings = listed(item.get("wordings", ()))
    if not wordings or not all(isinstance(w, str) and w.strip() for w in wordings):
        raise ValueError("no wordings")
    for key, outcome in ONLY_WITH.items():
        if key in item and outcome not in expect:
            raise ValueError(f"{key} goes with {outcome}")
    _check_query(item.get("query", {}), world)
    alternatives = list(item.get("either", ()))
    if PROGRAM_FIELDS & set(item):
        alternatives.append({k: item[k] for k in PROGRAM_FIELDS & set(item)})
    if bool(alternatives) != ("applied" in expect or item.get("partial", False)):
        raise ValueError("a program goes with applied or partial, and only with them")
    programs = [p for alternative in alternatives for p in _programs(alternative, world)]
    return PhenomenonCase(
        phenomenon,
        item["name"],
        held_out,
        item["world"],
        listed(item.get("given", ())),
        wordings,
        forms,
        expect,
        tuple(dict.fromkeys(programs)),
        item,
    )


def _check_query(query: Mapping[str, Any], world: World) -> None:
    _only(query, QUERY_FIELDS)
    if query.get("entity", "") and query["entity"] not in world.entities:
        raise ValueError(f"there is no {query['entity']}")
    for text in [*query.get("when", ()), *([query["literal"]] if "literal" in query else ())]:
        _formula(text, world)


def _programs(item: Mapping[str, Any], world: World) -> Iterator[tuple[Step, ...]]:
    """The programs that an expectation stands for: one, or more where checkpoints may be split."""
    _only(item, PROGRAM_FIELDS)
    checkpoints = [c if isinstance(c, dict) else {"goals": c} for c in item.get("checkpoints", ())]
    for checkpoint in checkpoints:
        _only(checkpoint, CHECKPOINT_FIELDS)
    labels = [c.get("label") or c.get("name") or str(sorted(c["goals"])) for c in checkpoints]
    if "start" in labels or len(set(labels)) != len(labels):
        raise ValueError("two checkpoints are the same: give them labels")
    if "transitions" in item:
        transitions = item["transitions"]
    else:
        ends = ["start", *labels]
        transitions = [{"from": a, "to": b} for a, b in itertools.pairwise(ends)]
    after: dict[str, list[tuple[str, frozenset[str]]]] = {}
    for transition in transitions:
        _only(transition, TRANSITION_FIELDS)
        source, target = (
            end if isinstance(end, str) else str(sorted(end))
            for end in (transition["from"], transition["to"])
        )
        for end in (source, target):
            if end not in labels and end != "start":
                raise ValueError(f"no checkpoint {end}")
        when = [_formula(text, world) for text in transition.get("when", ())]
        if not all(isinstance(x, Literal) for x in when):
            raise ValueError("a conditional is made of literals")
        after.setdefault(source, []).append((target, frozenset(map(str, when))))
    reached = [target for targets in after.values() for target, _ in targets]
    if sorted(reached) != sorted(labels):
        raise ValueError("the program is no tree")
    cuts = [_cuts(c, world) for c in checkpoints]
    for choice in itertools.product(*cuts):
        yield _tree(
            "start", after, dict(zip(labels, zip(checkpoints, choice, strict=True), strict=True))
        )


def _tree(
    source: str,
    after: Mapping[str, list[tuple[str, frozenset[str]]]],
    chosen: Mapping[str, tuple[Mapping[str, Any], tuple[frozenset[str], ...]]],
) -> tuple[Step, ...]:
    steps: list[Step] = []
    for target, when in after.get(source, ()):
        checkpoint, groups = chosen[target]
        then = _tree(target, after, chosen)
        for i in reversed(range(len(groups))):
            name = checkpoint.get("name", "") if i == 0 else ""
            then = (Step(when if i == 0 else frozenset(), groups[i], name, then),)
        steps.extend(then)
    return ordered(steps)


def _cuts(checkpoint: Mapping[str, Any], world: World) -> list[tuple[frozenset[str], ...]]:
    """A checkpoint's goals in one group, and, where it may be split, in all groups of neighbours."""
    goals = [_formula(text, world) for text in checkpoint["goals"]]
    places = range(1, len(goals)) if checkpoint.get("may_split") else range(0)
    found = []
    for count in range(len(places) + 1):
        for cut in itertools.combinations(places, count):
            ends = [0, *cut, len(goals)]
            found.append(tuple(normal(goals[a:b], world) for a, b in itertools.pairwise(ends)))
    return found


def _formula(text: str, world: World) -> Formula:
    formula = parse_formula(text)
    types = {name: entity.type for name, entity in world.entities.items()}
    if faults := list(formula_faults(formula, world.domain, types)):
        raise ValueError(" ".join(faults))
    for literal in literals_in(formula):
        if literal.predicate == KIND and not any(
            world.is_kind(name, literal.args[1]) for name in world.entities
        ):
            raise ValueError(f"nothing is of the kind {literal.args[1]}")
    return formula


def _without_wordings(case: PhenomenonCase) -> tuple[Any, ...]:
    rest = {k: v for k, v in case.wanted.items() if k != "wordings"}
    return case.world, case.given, case.forms, case.expect, case.programs, rest


def _only(item: Mapping[str, Any], fields: set[str]) -> None:
    if strange := set(item) - fields:
        raise ValueError(f"unknown fields {', '.join(sorted(strange))}")


def listed(value: Any) -> tuple[Any, ...]:
    """What is given as one or as a list of them."""
    return (value,) if isinstance(value, str) else tuple(value)
