"""The translator runs in this process: it ends when its time is over, or when nobody wants it any more."""

from __future__ import annotations

import threading

import pytest

from polaris_nl.model.world_file import world_of_texts
from polaris_nl.planning import grounding, translate
from polaris_nl.planning.budget import never
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.segments import SegmentResult

from .conftest import facts, only_problem, program

THINGS = 60
# Sixty things in seven places: more combinations than can be counted out.
CROWD = """(define (domain crowd)
  (:requirements :strips :typing)
  (:types thing)
  (:predicates (tied ?a ?b - thing) (near ?a ?b - thing) (calm ?a - thing))
  (:action soothe
    :parameters (?a - thing)
    :precondition (near ?a ?a)
    :effect (calm ?a))
  (:action gather
    :parameters (?a ?b ?c ?d ?e ?f ?g - thing)
    :precondition (and (near ?a ?a) (near ?b ?b) (near ?c ?c) (near ?d ?d) (near ?e ?e) (near ?f ?f)
      (near ?g ?g))
    :effect (and (tied ?a ?b) (tied ?c ?d) (tied ?e ?f) (tied ?f ?g))))
"""
WORLD = "\n".join(
    [
        "schema: polaris-world/1", "name: many", "domain: crowd.pddl", "entities:",
        *[f"  - {{name: t{n}, type: thing}}" for n in range(THINGS)],
        "facts: [" + ", ".join(f'"(near t{n} t{n})"' for n in range(THINGS)) + "]",
    ]
)  # fmt: skip
TIED = facts("(tied t1 t2)")


@pytest.fixture
def crowd(monkeypatch: pytest.MonkeyPatch) -> Planner:
    monkeypatch.setattr(grounding, "LIMIT_S", 0.3)
    return Planner(world_of_texts(WORLD, CROWD))


def test_a_translation_without_end_is_given_up_and_said_so(crowd: Planner) -> None:
    plan = crowd.compile(program("tied: (tied t1 t2)"))
    problem = only_problem(plan)
    assert problem.cause == "undecided"
    assert "too many ways" in problem.text


def test_what_took_too_long_is_not_tried_again_at_once(
    crowd: Planner, monkeypatch: pytest.MonkeyPatch
) -> None:
    crowd.segment(crowd.world.initial, TIED)

    def again(*_: object) -> None:
        raise AssertionError("translated again")

    monkeypatch.setattr("polaris_nl.planning.tasks.translate_without_goals", again)
    assert "too many ways" in crowd.segment(crowd.world.initial, facts("(tied t3 t4)")).reason


def test_a_translation_ends_when_it_is_cancelled(
    crowd: Planner, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(grounding, "LIMIT_S", 600.0)
    unwanted = threading.Event()
    found: list[SegmentResult] = []

    def work() -> None:
        segments = crowd._segments
        found.append(segments.solve(crowd.world.initial, TIED, cancelled=unwanted.is_set))

    thread = threading.Thread(target=work)
    thread.start()
    unwanted.set()
    thread.join(30.0)
    assert not thread.is_alive()
    assert found[0].status == "cancelled"


def test_the_translator_works_as_before_after_it_was_interrupted(
    crowd: Planner, care_home: Planner
) -> None:
    crowd.segment(crowd.world.initial, TIED)
    fresh = Planner(care_home.world)
    lunch = program("home: (robot-at kitchen)", "held: (holding cup)")
    assert fresh.compile(lunch).status == "ok"
    # With its goals, too, whose translation drops what they don't need.
    sas = translate.translate(*texts(), never).sas
    assert "begin_operator" in sas


def texts() -> tuple[str, str]:
    domain = """(define (domain small) (:predicates (a) (b))
      (:action go :parameters () :precondition (a) :effect (b)))"""
    return domain, "(define (problem p) (:domain small) (:init (a)) (:goal (b)))"
