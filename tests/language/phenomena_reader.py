"""Reads the utterance suite of `phenomena/` and `held_out/`, and judges how a wording comes out.

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
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.model.check import formula_faults
from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.domain import KIND
from polaris_nl.model.evaluate import instances_of
from polaris_nl.model.formula import (
    And,
    Formula,
    Imply,
    Literal,
    Quantified,
    literals_in,
    parse_formula,
)
from polaris_nl.model.world import World
from polaris_nl.model.world_file import read_world

from .reader import OUTCOMES, Talk, in_form, language_of

FOLDERS = (Path(__file__).parent / "phenomena", Path(__file__).parent / "held_out")
FORMS = ("typed", "spoken")
VERDICTS = ("right", "asked", "refused", "wrong")
"""`wrong`: another program, a change where none was wanted, another command or another query, or a
command nobody gave that does harm. `asked` and `refused`: nothing happens, though something else than
this question or this refusal was wanted; an answer or a harmless command counts as `refused`.
"""
CHANGING = {"new", "undo", "redo", "run", "stop", "pause", "resume", "quit", "save", "load"}
"""Commands that do harm when nobody gave them."""

CASE_FIELDS = {
    "name", "world", "given", "wordings", "forms", "expect", "checkpoints", "transitions", "either",
    "command", "options", "unknown", "query", "partial",
}  # fmt: skip
PROGRAM_FIELDS = {"checkpoints", "transitions"}
CHECKPOINT_FIELDS = {"label", "name", "goals", "may_split"}
TRANSITION_FIELDS = {"from", "to", "when"}
QUERY_FIELDS = {"kind", "when", "entity", "literal"}
ONLY_WITH = {"command": "command", "options": "question", "unknown": "refused", "query": "answer"}


class Step(NamedTuple):
    """A checkpoint with what leads to it and what comes after it; comparable, without ids."""

    when: frozenset[str]
    goals: frozenset[str]
    name: str
    then: tuple[Step, ...]


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


@dataclass(frozen=True)
class Verdict:
    """How a wording came out in a form, and why it isn't right."""

    case: PhenomenonCase
    wording: str
    form: str
    verdict: str
    why: str = ""


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


def judge(case: PhenomenonCase, wording: str, form: str) -> Verdict:
    """Says a wording in a form, after what is given, and compares what comes of it."""
    talk = Talk(language_of(case.world))
    for utterance in in_form(case.given, form):
        talk.say(utterance)
    before = talk.program
    (text,) = in_form([wording], form)
    verdict, why = _verdict(case, talk.say(text), before, talk.program)
    return Verdict(case, wording, form, verdict, why)


def judge_all(cases: Iterable[PhenomenonCase]) -> Iterator[Verdict]:
    """Every wording of some cases in each of its forms."""
    for case in cases:
        for wording, form in itertools.product(case.wordings, case.forms):
            yield judge(case, wording, form)


def tally(verdicts: Iterable[Verdict]) -> dict[str, Counter[str]]:
    """How many verdicts of each sort there are, phenomenon by phenomenon."""
    found: dict[str, Counter[str]] = {}
    for verdict in verdicts:
        found.setdefault(verdict.case.phenomenon, Counter())[verdict.verdict] += 1
    return found


def tree_of(program: Automaton, world: World) -> tuple[Step, ...] | None:
    """A program as steps, in an order of its own; None where it is no tree rooted in the start."""
    if len(program.transitions) != len(program.checkpoints) - 1:
        return None
    if len(program.subtree(START)) != len(program.checkpoints):
        return None

    def steps(checkpoint: str) -> tuple[Step, ...]:
        return _ordered(
            Step(
                frozenset(map(str, t.when)),
                normal(program.checkpoints[t.target].goals, world),
                program.checkpoints[t.target].name,
                steps(t.target),
            )
            for t in program.outgoing(checkpoint)
        )

    return steps(START)


def same(wanted: Sequence[Step], found: Sequence[Step]) -> bool:
    """Whether two lists of steps are one, in any order; an empty name fits all names."""
    if len(wanted) != len(found):
        return False
    if not wanted:
        return True
    first, *others = wanted
    return any(
        (first.when, first.goals) == (step.when, step.goals)
        and first.name in ("", step.name)
        and same(first.then, step.then)
        and same(others, [*found[:i], *found[i + 1 :]])
        for i, step in enumerate(found)
    )


def normal(goals: Iterable[Formula], world: World) -> frozenset[str]:
    """Goals without `for all` and without kinds; conditions that depend on facts stay."""
    return frozenset(str(part) for goal in goals for part in _parts(goal, world))


def _verdict(
    case: PhenomenonCase, meant: Interpretation, before: Automaton, after: Automaton
) -> tuple[str, str]:
    heard = f"{meant.outcome}: {meant.say}"
    tree = tree_of(after, world_of(case.world))
    fits = tree is not None and any(same(program, tree) for program in case.programs)
    if meant.outcome == "applied":
        if "applied" in case.expect and fits:
            return "right", ""
        return "wrong", f"{heard} {described(tree)}"
    if after != before and "applied" in case.expect and meant.outcome == "question":
        return "asked", heard
    if after != before and not (case.wanted.get("partial") and meant.partial and fits):
        return "wrong", f"{heard} {described(tree)}"
    if meant.outcome in case.expect:
        return _detail(case.wanted, meant, heard)
    if meant.outcome == "question":
        return "asked", heard
    if meant.command in CHANGING:
        return "wrong", f"{meant.command}, {heard}"
    return "refused", heard


def _detail(wanted: Mapping[str, Any], meant: Interpretation, heard: str) -> tuple[str, str]:
    if meant.outcome == "question" and "options" in wanted:
        offered = meant.question.options if meant.question else ()
        if not _offers(wanted["options"], offered):
            return "asked", f"{heard} {offered}"
    if meant.outcome == "refused" and meant.refusal:
        named = {word for text in meant.refusal.unknown for word in text.lower().split()}
        missing = set(wanted.get("unknown", ())) - named
        if missing:
            return "refused", f"{heard} It does not name {', '.join(sorted(missing))}."
    if meant.command and meant.command not in _list(wanted.get("command", meant.command)):
        return "wrong", f"{meant.command}, {heard}"
    if meant.outcome == "answer" and "query" in wanted:
        query = meant.query
        found = {
            "kind": query and query.kind,
            "when": sorted(map(str, query.when)) if query else [],
            "entity": query and query.entity,
            "literal": str(query.literal) if query else "",
        }
        for key, value in wanted["query"].items():
            if found[key] != (sorted(value) if key == "when" else value):
                return "wrong", f"{heard} {key}: {found[key]}"
    return "right", ""


def _offers(wanted: Sequence[str], offered: Sequence[str]) -> bool:
    if len(wanted) != len(offered):
        return False
    return any(
        all(
            set(w.lower().split()) <= set(o.lower().split()) for w, o in zip(wanted, x, strict=True)
        )
        for x in itertools.permutations(offered)
    )


def described(steps: Sequence[Step] | None) -> str:
    """Steps on one line, for a person."""
    if steps is None:
        return "no tree"
    parts = []
    for step in steps:
        when = f"[{' '.join(sorted(step.when))}] " if step.when else ""
        then = f" > {described(step.then)}" if step.then else ""
        parts.append(f"{when}{' '.join(sorted(step.goals)) or '.'}{then}")
    return parts[0] if len(parts) == 1 else f"{{{' | '.join(parts)}}}"


def _case(item: Mapping[str, Any], phenomenon: str, held_out: bool) -> PhenomenonCase:
    _only(item, CASE_FIELDS)
    if item["world"] not in shipped_worlds():
        raise ValueError(f"which world is {item['world']}?")
    world = world_of(item["world"])
    expect = _list(item.get("expect", "applied"))
    if not expect or set(expect) - set(OUTCOMES):
        raise ValueError(f"expect is one of {', '.join(OUTCOMES)}")
    forms = _list(item.get("forms", FORMS))
    if not forms or set(forms) - set(FORMS):
        raise ValueError(f"forms are {', '.join(FORMS)}")
    wordings = _list(item.get("wordings", ()))
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
        _list(item.get("given", ())),
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
    return _ordered(steps)


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


def _parts(goal: Formula, world: World) -> Iterator[Formula]:
    if isinstance(goal, And):
        for part in goal.parts:
            yield from _parts(part, world)
    elif isinstance(goal, Quantified) and goal.quantifier == "forall":
        for body in instances_of(goal, world):
            yield from _parts(body, world)
    elif isinstance(goal, Imply):
        conditions = _conditions(goal.condition)
        kinds = [c for c in conditions if isinstance(c, Literal) and c.predicate == KIND]
        if all(world.is_kind(*k.args) is k.positive for k in kinds):
            rest = sorted(str(c) for c in conditions if c not in kinds)
            for part in _parts(goal.conclusion, world):
                yield parse_formula(f"(imply (and {' '.join(rest)}) {part})") if rest else part
    else:
        yield goal


def _conditions(formula: Formula) -> list[Formula]:
    if isinstance(formula, And):
        return [c for part in formula.parts for c in _conditions(part)]
    return [formula]


def _ordered(steps: Iterable[Step]) -> tuple[Step, ...]:
    return tuple(
        sorted(steps, key=lambda s: (sorted(s.when), sorted(s.goals), s.name, str(s.then)))
    )


def _without_wordings(case: PhenomenonCase) -> tuple[Any, ...]:
    rest = {k: v for k, v in case.wanted.items() if k != "wordings"}
    return case.world, case.given, case.forms, case.expect, case.programs, rest


def _only(item: Mapping[str, Any], fields: set[str]) -> None:
    if strange := set(item) - fields:
        raise ValueError(f"unknown fields {', '.join(sorted(strange))}")


def _list(value: Any) -> tuple[Any, ...]:
    return (value,) if isinstance(value, str) else tuple(value)
