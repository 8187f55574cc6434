"""A small domain and world for the tests of the core values."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from polaris_nl.model.world import World
from polaris_nl.model.world_file import read_world

DOMAIN = """(define (domain errands)
  (:requirements :strips :typing)
  (:types object surface region person)
  (:predicates
    ; NL: [0] is on [1]
    (at ?o - object ?s - surface)
    (holding ?o - object)
    (hand-empty)
    (robot-at ?r - region)
    (located ?s - surface ?r - region)
    (called ?p - person)
    (answered ?p - person) (refused ?p - person))
  ; MUTEX: (answered ?p) (refused ?p)
  ; EXOGENOUS: at answered refused
  (:action go
    :parameters (?a ?b - region)
    :precondition (robot-at ?a)
    :effect (and (not (robot-at ?a)) (robot-at ?b)))
  ; NL: pick [0] up
  (:action pick
    :parameters (?o - object ?s - surface ?r - region)
    :precondition (and (hand-empty) (at ?o ?s) (located ?s ?r) (robot-at ?r))
    :effect (and (holding ?o) (not (hand-empty)) (not (at ?o ?s))))
  (:action drop-all
    :parameters (?s - surface)
    :precondition (and)
    :effect (forall (?o - object)
      (when (holding ?o) (and (at ?o ?s) (not (holding ?o)) (hand-empty))))))
"""

WORLD = """schema: polaris-world/1
name: flat
domain: errands.pddl
entities:
  - {name: kitchen, type: region, area: [[4.0, 3.0], [0.0, 0.0]]}
  - {name: shelf, type: surface, pose: [1.0, 1.0, 0.0]}
  - {name: red-cup, type: object, noun: cup, adjectives: [red], synonyms: [mug], kinds: [dish]}
  - {name: plate, type: object, kinds: [dish]}
  - {name: ann, type: person, gender: female, user: true}
facts: ["(at red-cup shelf)", "(hand-empty)", "(located shelf kitchen)", "(robot-at kitchen)"]
scenario:
  objectives: [{name: cup held, goal: "(and (holding red-cup) (not (hand-empty)))"}]
  human_actions:
    - {name: answer, effect: ["(answered ann)"], when: ["(called ann)"]}
"""

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes the domain and a world into a folder and returns the world's path."""

    def write_files(world: str = WORLD, domain: str = DOMAIN) -> Path:
        (tmp_path / "errands.pddl").write_text(domain, encoding="utf-8")
        path = tmp_path / "flat.yaml"
        path.write_text(world, encoding="utf-8")
        return path

    return write_files


@pytest.fixture
def flat(write: Write) -> World:
    """The world of this module."""
    return read_world(write())
