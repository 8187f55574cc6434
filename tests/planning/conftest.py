"""Planners of the shipped worlds, small domains, and a short way to write a program."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.automaton.program import parse_action
from polaris_nl.model.formula import Literal, parse_formula, parse_literal
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world, read_world
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan, Problem, Segment

START = "start"
LUNCH = "alerted: (alerted-to resident lunchtime)"

BALLS = """(define (domain balls)
  (:requirements :strips :typing)
  (:types ball hand)
  (:predicates (in ?b - ball ?h - hand) (on-floor ?b - ball) (free ?h - hand) (held ?b - ball))
  (:action grab
    :parameters (?b - ball ?h - hand)
    :precondition (and (on-floor ?b) (free ?h))
    :effect (and (in ?b ?h) (held ?b) (not (on-floor ?b)) (not (free ?h))))
  (:action drop
    :parameters (?b - ball ?h - hand)
    :precondition (in ?b ?h)
    :effect (and (on-floor ?b) (free ?h) (not (in ?b ?h)) (not (held ?b)))))
"""

SHOPPING = """(define (domain shopping)
  (:requirements :strips :typing)
  (:types region)
  (:predicates (robot-at ?r - region) (way ?a ?b - region) (sells ?r - region) (tea))
  (:action go
    :parameters (?a ?b - region)
    :precondition (and (robot-at ?a) (way ?a ?b))
    :effect (and (robot-at ?b) (not (robot-at ?a))))
  (:action buy
    :parameters (?r - region)
    :precondition (and (robot-at ?r) (sells ?r))
    :effect (tea)))
"""

MakeWorld = Callable[[str, Iterable[str], Iterable[str]], World]


def program(*lines: str) -> Automaton:
    """A program from lines such as `parent -> name [conditional]: goals`.

    `parent ->` may be left out and then is the line before (the first line's is the start), `[...]`
    is left out where there is no conditional, and `!(place tray table)` insists on an action. Ids
    are c1, c2, ... and t1, t2, ... in the order of the lines.
    """
    automaton, ids, before = Automaton(), {START: "c0"}, START
    for number, line in enumerate(lines, 1):
        head, _, goals = line.partition(":")
        source, arrow, rest = head.rpartition("->")
        name, _, when = rest.partition("[")
        parent = source.strip() if arrow else before
        before, goals = name.strip(), goals.strip()
        ids[before] = f"c{number}"
        if goals.startswith("!"):
            checkpoint = Checkpoint(ids[before], before, action=parse_action(goals[1:]))
        else:
            parts = tuple(parse_formula(text) for text in split(goals))
            checkpoint = Checkpoint(ids[before], before, parts)
        conditional = facts(when.strip().removesuffix("]"))
        transition = Transition(f"t{number}", ids[parent], ids[before], conditional)
        automaton = automaton.with_checkpoint(checkpoint).with_transition(transition)
    return automaton


def split(text: str) -> list[str]:
    """The top-level parenthesised parts of a text."""
    parts, depth, begin = [], 0, 0
    for place, letter in enumerate(text):
        if letter == "(":
            begin = begin if depth else place
            depth += 1
        elif letter == ")":
            depth -= 1
            if not depth:
                parts.append(text[begin : place + 1])
    return parts


def facts(text: str) -> tuple[Literal, ...]:
    """Literals from one text, in its order."""
    return tuple(parse_literal(part) for part in split(text))


def actions(segment: Segment) -> list[str]:
    """A segment's actions as PDDL text."""
    return [str(action) for action in segment.actions]


def only_problem(plan: BranchingPlan) -> Problem:
    """The one problem of a plan."""
    assert [p.text for p in plan.problems] == [plan.problems[0].text]
    return plan.problems[0]


def core_texts(problem: Problem) -> set[frozenset[str]]:
    """The conflicting sets of a problem as sets of PDDL texts."""
    return {frozenset(map(str, core)) for core in problem.cores}


def balls_world(make_world: MakeWorld, count: int) -> World:
    """Some balls on the floor, and two hands."""
    names = [f"b{number}" for number in range(count)]
    entities = [f"{name} ball" for name in names]
    at_first = [f"(on-floor {name})" for name in names]
    return make_world(
        BALLS, [*entities, "left hand", "right hand"], [*at_first, "(free left)", "(free right)"]
    )


@pytest.fixture(scope="session")
def care_home() -> Planner:
    """The planner of the shipped care home."""
    return Planner(load_world("care-home"))


@pytest.fixture(scope="session")
def dinner_party() -> Planner:
    """The planner of the shipped dinner party."""
    return Planner(load_world("dinner-party"))


@pytest.fixture(scope="session")
def make_world(tmp_path_factory: pytest.TempPathFactory) -> MakeWorld:
    """Reads a world from a domain's text, `name type` entities and facts."""

    def make(domain: str, entities: Iterable[str], at_first: Iterable[str]) -> World:
        folder: Path = tmp_path_factory.mktemp("world")
        (folder / "small.pddl").write_text(domain, encoding="utf-8")
        lines = ["schema: polaris-world/1", "name: small", "domain: small.pddl", "entities:"]
        for entity in entities:
            name, kind = entity.split()
            lines.append(f"  - {{name: {name}, type: {kind}}}")
        lines.append("facts:")
        lines.extend(f'  - "{fact}"' for fact in at_first)
        path = folder / "small.yaml"
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return read_world(path)

    return make
