"""A domain that no grammar file speaks of is usable from its predicates' names and `; NL:` comments."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import apply_all
from polaris_nl.language.generate import read_back
from polaris_nl.language.grammar import load_grammar
from polaris_nl.language.grammar_check import check_domain
from polaris_nl.language.plain_phrases import plain_action, plain_entry
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.domain import Action, Operator, Predicate
from polaris_nl.model.formula import Literal, Variable, parse_formula
from polaris_nl.model.pddl import parse_domain, read_domain
from polaris_nl.model.world_file import read_world

DOMAIN = """
(define (domain office)
  (:requirements :strips :typing)
  (:types agent item place - object
          person robot - agent
          lamp - item)
  (:predicates
    (agent_at ?a - agent ?p - place)   ; NL: [0] is at [1]
    (near ?i - item ?j - item)         ; NL: [0] near [1]
    (carries ?a - agent ?i - item)     ; NL: [0] carries [1]
    ; NL: [0] in [1]
    (item_at ?i - item ?p - place)
    (switched_on ?l - lamp)
    (has_seen ?a - person ?i - item)   ; NL: [0] has noticed [1]
    (hand_free ?a - agent)             ; INTERNAL
    (lights_out))
  (:action move_to                     ; NL: [0] moves to [2]
    :parameters (?a - agent ?from - place ?to - place)
    :precondition (agent_at ?a ?from)
    :effect (and (not (agent_at ?a ?from)) (agent_at ?a ?to)))
  (:action pick_up                     ; NL: [0] picks up [1]
    :parameters (?a - agent ?i - item ?p - place)
    :precondition (and (agent_at ?a ?p) (item_at ?i ?p) (hand_free ?a))
    :effect (and (carries ?a ?i) (not (item_at ?i ?p)) (not (hand_free ?a))))
  (:action put_near
    :parameters (?a - agent ?i - item ?j - item ?p - place)
    :precondition (and (agent_at ?a ?p) (carries ?a ?i) (item_at ?j ?p))
    :effect (and (near ?i ?j) (item_at ?i ?p) (hand_free ?a) (not (carries ?a ?i)))))
"""
WORLD = """
schema: polaris-world/1
name: small-office
domain: domain.pddl
entities:
  - {name: stretch, type: robot}
  - {name: visitor, type: person}
  - {name: cup, type: item}
  - {name: desk-lamp, type: lamp, synonyms: [lamp]}
  - {name: hall, type: place}
  - {name: office, type: place}
facts: ["(agent_at stretch hall)", "(hand_free stretch)", "(item_at cup hall)", "(item_at desk-lamp office)"]
"""


@pytest.fixture(scope="module")
def office(tmp_path_factory: pytest.TempPathFactory) -> Understanding:
    folder = tmp_path_factory.mktemp("office")
    (folder / "domain.pddl").write_text(DOMAIN, encoding="utf-8")
    (folder / "world.yaml").write_text(WORLD, encoding="utf-8")
    return Understanding(read_world(folder / "world.yaml"))


def program_of(language: Understanding, utterance: str) -> Automaton:
    meant, _ = language.interpret(utterance, Automaton())
    assert meant.outcome == "applied", f"{utterance!r}: {meant.say}"
    return apply_all(Automaton(), meant.edits)


def goals_of(language: Understanding, utterance: str) -> list[str]:
    checkpoints = program_of(language, utterance).checkpoints.values()
    return [str(goal) for checkpoint in checkpoints for goal in checkpoint.goals]


@pytest.mark.parametrize(
    ("utterance", "goal"),
    [
        ("have the cup near the lamp", "(near cup desk-lamp)"),
        ("make sure the cup is near the lamp", "(near cup desk-lamp)"),
        ("Make sure that the cup is near the lamp.", "(near cup desk-lamp)"),
        ("put the cup near the lamp", "(near cup desk-lamp)"),
        ("the cup should be near the lamp", "(near cup desk-lamp)"),
        ("make sure that the cup is not near the lamp", "(not (near cup desk-lamp))"),
        ("the lamp must not be in the hall", "(not (item_at desk-lamp hall))"),
        ("have the cup in the office", "(item_at cup office)"),
        ("have stretch at the office", "(agent_at stretch office)"),
        ("send stretch to the office", "(agent_at stretch office)"),
        ("have the visitor carry the cup", "(carries visitor cup)"),
        ("stretch should carry the cup", "(carries stretch cup)"),
        ("have the lamp switched on", "(switched_on desk-lamp)"),
        ("switch the lamp on", "(switched_on desk-lamp)"),
        ("make sure the visitor has noticed the cup", "(has_seen visitor cup)"),
        ("make sure the lights are out", "(lights_out)"),
    ],
)
def test_goals(office: Understanding, utterance: str, goal: str) -> None:
    assert goals_of(office, utterance) == [goal]


@pytest.mark.parametrize(
    ("condition", "literal"),
    [
        ("if the cup is near the lamp", "(near cup desk-lamp)"),
        ("if the cup isn't near the lamp", "(not (near cup desk-lamp))"),
        ("once the visitor carries the cup", "(carries visitor cup)"),
        ("when the visitor is carrying the cup", "(carries visitor cup)"),
        ("when the visitor does not carry the cup", "(not (carries visitor cup))"),
        ("as soon as stretch is in the office", "(agent_at stretch office)"),
        ("if the lamp is switched on", "(switched_on desk-lamp)"),
        ("once the visitor has noticed the cup", "(has_seen visitor cup)"),
        ("if the lights are out", "(lights_out)"),
    ],
)
def test_conditions(office: Understanding, condition: str, literal: str) -> None:
    program = program_of(office, f"{condition}, have the cup in the office")
    assert [str(x) for t in program.transitions.values() for x in t.when] == [literal]


def test_questions(office: Understanding) -> None:
    meant, _ = office.interpret("is the cup near the lamp", Automaton())
    assert meant.query is not None
    assert str(meant.query.literal) == "(near cup desk-lamp)"


@pytest.mark.parametrize(
    ("literal", "fact", "goal"),
    [
        (
            "(near cup desk-lamp)",
            "the cup is near the desk lamp",
            "have the cup near the desk lamp",
        ),
        (
            "(not (near cup desk-lamp))",
            "the cup is not near the desk lamp",
            "make sure that the cup is not near the desk lamp",
        ),
        ("(carries stretch cup)", "stretch carries the cup", "have stretch carry the cup"),
        (
            "(not (carries visitor cup))",
            "the visitor does not carry the cup",
            "make sure that the visitor does not carry the cup",
        ),
        ("(agent_at stretch hall)", "stretch is at the hall", "have stretch at the hall"),
        (
            "(switched_on desk-lamp)",
            "the desk lamp is switched on",
            "have the desk lamp switched on",
        ),
        (
            "(has_seen visitor cup)",
            "the visitor has noticed the cup",
            "make sure that the visitor has noticed the cup",
        ),
        ("(lights_out)", "the lights are out", "have the lights out"),
    ],
)
def test_facts_and_goals_in_words(
    office: Understanding, literal: str, fact: str, goal: str
) -> None:
    formula = parse_formula(literal)
    assert isinstance(formula, Literal)
    assert office.wording.fact(formula) == fact
    assert office.wording.event(formula) == fact
    assert office.wording.goal(formula) == goal
    assert goals_of(office, goal) == [literal]


@pytest.mark.parametrize(
    ("action", "words"),
    [
        (("move_to", "stretch", "hall", "office"), "move to the office"),
        (("move_to", "visitor", "hall", "office"), "have the visitor move to the office"),
        (("pick_up", "stretch", "cup", "hall"), "pick up the cup"),
        (
            ("put_near", "stretch", "cup", "desk-lamp", "hall"),
            "put the cup near the desk lamp (the hall)",
        ),
    ],
)
def test_actions_in_words(office: Understanding, action: tuple[str, ...], words: str) -> None:
    assert office.wording.action(Action(action[0], action[1:])) == words


def test_a_program_is_read_back(office: Understanding) -> None:
    program = program_of(office, "once the visitor carries the cup, have the cup near the lamp")
    said = read_back(program, office.wording)
    assert said == "Once the visitor carries the cup, have the cup near the desk lamp."
    assert [c.name for c in program.checkpoints.values()] == ["start", "near desk lamp"]


def test_internal_predicates_are_never_offered(office: Understanding) -> None:
    assert not any("hand free" in phrase for phrase in office.phrases())
    assert "free" not in office.help
    meant, _ = office.interpret("make sure stretch hand free", Automaton())
    assert meant.outcome == "refused"
    assert load_grammar(office.world.domain).predicates["hand_free"].wordings.get("goals") == ()


def test_a_refusal_says_what_can_be_said(office: Understanding) -> None:
    meant, _ = office.interpret("frobnicate the cup", Automaton())
    assert '"have the cup near the desk lamp"' in meant.say


@pytest.mark.parametrize(
    ("hint", "fact", "negated"),
    [
        ("[0] moves to [1]", "{a} moves to {b}", "{a} does not move to {b}"),
        ("[0] watches [1]", "{a} watches {b}", "{a} does not watch {b}"),
        ("[0] tidies [1]", "{a} tidies {b}", "{a} does not tidy {b}"),
        ("[0] has [1]", "{a} has {b}", "{a} does not have {b}"),
        ("[0] can reach [1]", "{a} can reach {b}", "{a} can not reach {b}"),
        ("[0] is next to [1]", "{a} is next to {b}", "{a} is not next to {b}"),
        ("[1] under [0]", "{b} is under {a}", "{b} is not under {a}"),
        ("", "{a} is linked to {b}", "{a} is not linked to {b}"),
    ],
)
def test_comments_become_clauses(hint: str, fact: str, negated: str) -> None:
    parameters = (Variable("?a", ("agent",)), Variable("?b", ("item",)))
    entry = plain_entry(Predicate("linked_to", parameters, hint))
    assert (entry["fact"], entry["not-fact"]) == (fact, negated)


@pytest.mark.parametrize(
    ("name", "types", "fact"),
    [
        ("at", ("place",), "the robot is at {x0}"),
        ("robot-at", ("place",), "the robot is at {x0}"),
        ("holding", ("item",), "the robot is holding {x0}"),
        ("is_full", ("item",), "{x0} is full"),
        ("full", ("item",), "{x0} is full"),
        ("person_in", ("person", "place"), "{x0} is in {x1}"),
        ("door_locked", (), "the door is locked"),
        ("raining", (), "it is raining"),
    ],
)
def test_names_become_clauses(name: str, types: tuple[str, ...], fact: str) -> None:
    parameters = tuple(Variable(f"?x{n}", (kind,)) for n, kind in enumerate(types))
    assert plain_entry(Predicate(name, parameters))["fact"] == fact


def test_operators_without_a_comment_are_said_by_their_names() -> None:
    robot = Variable("?r", ("robot",))
    nothing = parse_formula("(and)")
    move = Operator("move", (robot, Variable("?from", ()), Variable("?to", ())), nothing, nothing)
    assert plain_action(move) == "{r:agent} move from {from} to {to}"


def test_a_comment_belongs_to_its_own_line_or_to_the_one_below() -> None:
    domain = parse_domain(DOMAIN)
    hints = {p.name: (p.hint, p.internal) for p in domain.predicates.values()}
    assert hints["item_at"] == ("[0] in [1]", False)
    assert hints["switched_on"] == ("", False)
    assert hints["hand_free"] == ("", True)
    assert hints["lights_out"] == ("", False)


def test_a_wrong_number_in_a_comment_is_named_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "domain.pddl"
    path.write_text(DOMAIN.replace("[0] carries [1]", "[0] carries [2]"), encoding="utf-8")
    (error,) = check_domain(read_domain(path)).errors
    assert error.line == 10
    assert "carries ends with [1]" in error.reason
