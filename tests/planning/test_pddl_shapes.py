"""Classic shapes of STRIPS and ADL domains: read, checked, planned, and the plans valid by another program."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.language.grammar_check import check_domain
from polaris_nl.model.errors import FileError, FormatError
from polaris_nl.model.pddl import parse_domain
from polaris_nl.model.problem import parse_problem
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world, world_of_texts
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.planning.up_model import is_valid
from tests.planning.conftest import actions, program

EITHER = (
    """(define (domain freight)
 (:requirements :strips :typing)
 (:types place thing - object crate box - thing van lorry - object)
 (:constants depot - place)
 (:predicates (is-at ?x - (either box crate van lorry) ?p - place)
   (inside ?x - (either box crate) ?v - (either van lorry)))
 (:action load :parameters (?x - (either box crate) ?v - (either van lorry) ?p - place)
  :precondition (and (is-at ?x ?p) (is-at ?v ?p))
  :effect (and (inside ?x ?v) (not (is-at ?x ?p))))
 (:action unload :parameters (?x - (either box crate) ?v - (either van lorry) ?p - place)
  :precondition (and (inside ?x ?v) (is-at ?v ?p))
  :effect (and (not (inside ?x ?v)) (is-at ?x ?p)))
 (:action drive :parameters (?v - (either van lorry) ?p ?q - place)
  :precondition (is-at ?v ?p) :effect (and (not (is-at ?v ?p)) (is-at ?v ?q))))""",
    """(define (problem two-things) (:domain freight)
 (:objects b - box c - crate v - van shop - place)
 (:init (is-at b depot) (is-at c shop) (is-at v shop))
 (:goal (and (is-at b shop) (is-at c depot))))""",
    6,
)
CONDITIONAL = (
    """(define (domain switches)
 (:requirements :adl)
 (:predicates (lamp ?x) (lit ?x) (wired ?x ?y) (broken ?x) (all-dark))
 (:action flip :parameters (?x)
  :precondition (and (lamp ?x) (not (broken ?x)))
  :effect (and (when (lit ?x) (not (lit ?x))) (when (not (lit ?x)) (lit ?x))
    (forall (?y) (when (and (wired ?x ?y) (lit ?y)) (not (lit ?y))))))
 (:action announce :parameters ()
  :precondition (forall (?x) (imply (lamp ?x) (not (lit ?x)))) :effect (all-dark)))""",
    """(define (problem lamps) (:domain switches) (:objects a b c)
 (:init (lamp a) (lamp b) (lamp c) (lit a) (lit b) (wired a b) (broken b))
 (:goal (and (all-dark) (not (lit b)))))""",
    2,
)
LOGIC = (
    """(define (domain doors)
 (:requirements :adl :equality)
 (:types key door room)
 (:predicates (here ?r - room) (joins ?d - door ?a ?b - room) (fits ?k - key ?d - door)
   (have ?k - key) (lies ?k - key ?r - room) (bolted ?d - door))
 (:action take :parameters (?k - key ?r - room) :precondition (and (here ?r) (lies ?k ?r))
  :effect (and (have ?k) (not (lies ?k ?r))))
 (:action walk :parameters (?a ?b - room)
  :precondition (and (here ?a) (not (= ?a ?b)) (exists (?d - door)
    (and (or (joins ?d ?a ?b) (joins ?d ?b ?a))
      (or (not (bolted ?d)) (exists (?k - key) (and (have ?k) (fits ?k ?d)))))))
  :effect (and (here ?b) (not (here ?a)))))""",
    """(define (problem bolted) (:domain doors) (:objects k - key d e - door x y z - room)
 (:init (here x) (joins d x y) (joins e z y) (bolted e) (fits k e) (lies k x)) (:goal (here z)))""",
    3,
)
COSTS = (
    """(define (domain roads)
 (:requirements :strips :action-costs)
 (:predicates (on ?a) (road ?a ?b))
 (:functions (total-cost) - number (far ?a ?b) - number)
 (:action go :parameters (?a ?b) :precondition (and (on ?a) (road ?a ?b))
  :effect (and (on ?b) (not (on ?a)) (increase (total-cost) (far ?a ?b)))))""",
    """(define (problem trip) (:domain roads) (:objects u v w)
 (:init (on u) (road u v) (road v w) (= (total-cost) 0) (= (far u v) 1) (= (far v w) 1))
 (:goal (on w)) (:metric minimize (total-cost)))""",
    2,
)
UNTYPED = (
    """(define (domain stacks)
 (:requirements :strips :negative-preconditions)
 (:predicates (block ?b) (on ?a ?b) (clear ?b) (table ?b) (held ?b))
 (:action lift :parameters (?b) :precondition (and (block ?b) (clear ?b) (table ?b))
  :effect (and (held ?b) (not (table ?b)) (not (clear ?b))))
 (:action stack :parameters (?a ?b) :precondition (and (held ?a) (clear ?b) (not (held ?b)))
  :effect (and (on ?a ?b) (not (held ?a)) (clear ?a) (not (clear ?b)))))""",
    """(define (problem tower) (:domain stacks) (:objects a b c)
 (:init (block a) (block b) (block c) (clear a) (clear b) (clear c) (table a) (table b) (table c))
 (:goal (and (on a b) (on b c))))""",
    4,
)
NESTED = (
    """(define (domain vehicles)
 (:requirements :typing :adl)
 (:types vehicle place - object truck ship - vehicle big-truck - truck)
 (:predicates (v-at ?v - vehicle ?p - place) (harbour ?p - place) (seen ?v - vehicle))
 (:action move :parameters (?v - vehicle ?p ?q - place)
  :precondition (and (v-at ?v ?p) (imply (harbour ?p) (harbour ?q)))
  :effect (and (not (v-at ?v ?p)) (v-at ?v ?q)))
 (:action count :parameters () :precondition ()
  :effect (forall (?v - (either truck ship)) (seen ?v))))""",
    """(define (problem fleet) (:domain vehicles) (:objects t - big-truck s - ship i j - place)
 (:init (v-at t i) (harbour j)) (:goal (and (v-at t j) (seen t) (seen s))))""",
    2,
)
SHAPES = {
    "either": EITHER, "conditional effects": CONDITIONAL, "logic and equality": LOGIC,
    "costs": COSTS, "untyped": UNTYPED, "nested types": NESTED,
}  # fmt: skip


def of(domain: str, problem: str) -> World:
    return parse_problem(problem, parse_domain(domain))


def planned(world: World) -> BranchingPlan:
    goals = tuple(o.goal for o in world.scenario.objectives)
    automaton = Automaton().with_checkpoint(Checkpoint("c1", "goal", goals))
    return Planner(world).compile(automaton.with_transition(Transition("t1", START, "c1")))


@pytest.mark.parametrize("shape", SHAPES)
def test_a_classic_shape_is_read_checked_and_planned(shape: str) -> None:
    domain, problem, count = SHAPES[shape]
    world = of(domain, problem)
    assert not check_domain(world.domain).errors
    plan = planned(world)
    assert plan.status == "ok", plan.problems
    segment = plan.segments["c1"]
    assert len(segment.actions) == count
    assert segment.optimal
    assert is_valid(world, segment.before, segment.goals, segment.actions)
    assert not is_valid(world, segment.before, segment.goals, segment.actions[:-1])


def test_a_parameter_of_two_types_takes_nothing_else() -> None:
    domain, problem, _ = EITHER
    # A lorry is no thing to load, whatever is true of it.
    world = of(domain, problem.replace("v - van", "v - van l - lorry").replace(
        "(:goal (and (is-at b shop) (is-at c depot)))", "(:goal (is-at b shop))"
    ).replace("(is-at v shop)", "(is-at l shop)"))  # fmt: skip
    plan = planned(world)
    assert all(a.args[0] == "b" for a in plan.segments["c1"].actions if a.operator == "load")


# Problem files as worlds


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "domain.pddl").write_text(UNTYPED[0], encoding="utf-8")
    (tmp_path / "other.pddl").write_text("(define (domain other) (:predicates (p)))")
    (tmp_path / "tower.pddl").write_text(UNTYPED[1], encoding="utf-8")
    return tmp_path


def test_a_problem_is_a_world_with_the_domain_beside_it(folder: Path) -> None:
    world = load_world(str(folder / "tower.pddl"))
    assert (world.name, world.domain.name) == ("tower", "stacks")
    assert list(world.entities) == ["a", "b", "c"]
    assert len(world.facts) == 9
    assert [o.name for o in world.scenario.objectives] == ["(on a b)", "(on b c)"]
    assert world_of_texts(world.source, world.domain.source) == world_of_texts(*UNTYPED[1::-1])


@pytest.mark.parametrize(
    ("before", "after", "line", "reason"),
    [
        ("(:domain stacks)", "(:domain stack)", None, "no PDDL file beside it has that one"),
        ("(:domain stacks)", "", 1, "no :domain"),
        ("a b c)\n", "a b b)\n", 1, "two objects b"),
        ("a b c)\n", "a b c - brick)\n", 1, "no type brick"),
        ("(block a)", "(bloc a)", 2, "no predicate bloc. Did you mean block"),
        ("(block a)", "(block z)", 2, "nothing called z"),
        ("(block a)", "(or (block a))", 2, "not a single fact"),
        ("(:goal", "(:gaol", 3, "no part ':gaol'. Did you mean :goal"),
        ("(on b c))))", "(on b))))", 3, "takes 2"),
        ("(problem tower)", "(problem)", 1, "(problem NAME)"),
        ("(define", "(defin", 1, "no PDDL problem"),
        ("(:goal", "((:goal", 1, "never closed"),
    ],
)
def test_what_is_no_problem_is_named_with_its_line(
    folder: Path, before: str, after: str, line: int | None, reason: str
) -> None:
    assert before in UNTYPED[1]
    path = folder / "tower.pddl"
    path.write_text(UNTYPED[1].replace(before, after, 1), encoding="utf-8")
    with pytest.raises(FileError) as error:
        load_world(str(path))
    assert reason in str(error.value)
    if line is not None:
        assert isinstance(error.value, FormatError)
        assert (error.value.path, error.value.line) == (path, line)


# Agents that can't be commanded

OFFICE = """(define (domain office)
 (:types agent item place - object person robot - agent)
 (:predicates (agent_at ?a - agent ?p - place) (carries ?a - agent ?i - item) (item_at ?i - item ?p - place))
 (:action move_to :parameters (?a - agent ?from ?to - place)   ; NL: [0] moves to [2]
  :precondition (agent_at ?a ?from) :effect (and (not (agent_at ?a ?from)) (agent_at ?a ?to)))
 (:action pick_up :parameters (?a - agent ?i - item ?p - place)
  :precondition (and (agent_at ?a ?p) (item_at ?i ?p))
  :effect (and (carries ?a ?i) (not (item_at ?i ?p))))
 (:action give :parameters (?a ?b - agent ?i - item ?p - place)
  :precondition (and (agent_at ?a ?p) (agent_at ?b ?p) (carries ?a ?i))
  :effect (and (carries ?b ?i) (not (carries ?a ?i)))))"""
STAFF = """(define (problem floor) (:domain office)
 (:objects stretch - robot ann - person cup - item hall desk - place)
 (:init (agent_at stretch hall) (agent_at ann hall) (item_at cup desk)))"""


def test_the_planner_moves_robots_and_never_people() -> None:
    world = of(OFFICE, STAFF)
    planner = Planner(world)
    assert (world.domain.commanded, world.domain.uncommanded) == (("robot",), ("person",))
    plan = planner.compile(program("served: (carries ann cup)", "there: (agent_at ann desk)"))
    assert actions(plan.segments["c1"]) == [
        "(move_to stretch hall desk)", "(pick_up stretch cup desk)", "(move_to stretch desk hall)",
        "(give stretch ann cup hall)",
    ]  # fmt: skip
    assert plan.omitted == ("c2",)  # Ann walks by herself, or not at all.
    waits = planner.compile(program("met [(agent_at ann desk)]: (agent_at stretch desk)"))
    assert waits.status == "ok"
    assert world.domain.people_can_change("agent_at")


def test_a_comment_says_who_is_commanded() -> None:
    drones = OFFICE.replace("person robot - agent", "person robot - agent drone - robot")
    assert parse_domain(drones).commanded == ("robot",)
    one = parse_domain(drones.replace("(:types", "; COMMANDED: drone\n (:types"))
    assert one.commanded == ("drone",)
    assert one.operators["move_to"].parameters[0].types == ("drone",)
    with pytest.raises(FormatError, match=r"line 2: There is no type drom"):
        parse_domain(OFFICE.replace("(:types", "; COMMANDED: drom\n (:types"))


def test_operators_of_things_and_people_stay_as_they_are() -> None:
    both = OFFICE.replace("item place - object", "thing place - object").replace(
        "person robot - agent", "person robot - agent agent item - thing"
    )
    touched = both.replace(
        "(:action give",
        "(:action push :parameters (?x - thing) :effect (nudged ?x))\n (:action give",
    ).replace("(item_at ?i - item", "(nudged ?x - thing) (item_at ?i - item")
    domain = parse_domain(touched)
    assert domain.operators["push"].parameters[0].types == ("thing",)
    assert domain.operators["move_to"].parameters[0].types == ("robot",)


def test_what_is_not_supported_is_refused_by_line() -> None:
    for section in ("(:derived (p) (q))", "(:durative-action a :parameters ())"):
        with pytest.raises(FormatError, match=r"line 2: .* not supported"):
            parse_domain(f"(define (domain d) (:predicates (p) (q))\n{section})")
