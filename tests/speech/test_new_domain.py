"""A third domain, made of data alone, whose things differ by one word: the same recognition with no code."""

from __future__ import annotations

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.hands_free.phrases import spoken_names, spoken_phrases
from polaris_nl.hands_free.weight import weight_of
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world
from polaris_nl.speech.ears import EarMaker, Ears, gaps_in_words
from tests.speech.speaking import blocks_of, silence, spoken

DOMAIN = """
(define (domain workshop)
  (:requirements :adl)
  (:types object container surface region person)
  (:predicates
    (robot-at ?r - region)
    (located ?x - surface ?r - region) (connected ?a - region ?b - region)
    (at ?o - object ?s - surface) (holding ?o - object) (hand-empty)
    (oiled ?o - object))
  (:action move
    :parameters (?from - region ?to - region)
    :precondition (and (robot-at ?from) (connected ?from ?to))
    :effect (and (not (robot-at ?from)) (robot-at ?to)))
  (:action pick
    :parameters (?o - object ?s - surface)
    :precondition (and (hand-empty) (at ?o ?s))
    :effect (and (not (hand-empty)) (not (at ?o ?s)) (holding ?o)))
  (:action place
    :parameters (?o - object ?s - surface)
    :precondition (holding ?o)
    :effect (and (not (holding ?o)) (at ?o ?s) (hand-empty)))
  (:action oil
    :parameters (?o - object)
    :precondition (holding ?o)
    :effect (oiled ?o)))
"""
GRAMMAR = """
schema: polaris-grammar/1
uses: [household]

predicates:
  oiled:
    fact: "{o} is oiled"
    not-fact: "{o} is not oiled"
    goal: "oil {o}"
    event: "{o} is oiled"
    name: "oiled"
    goals: ["(oil|grease|lubricate) {o}", "put [some] oil on {o}"]
    states: ["{o} <be> (oiled|greased)"]
operators:
  oil: "oil {o}"
"""
SIZES = ("ten", "twelve", "thirteen", "fourteen", "sixteen", "seventeen", "eighteen", "nineteen")
TOOLS = ("wrench", "drill", "file")
SAID = (
    "oil the thirteen wrench",
    "bring the seventeen drill to the bench",
    "put the sixteen file on the rack",
    "grease the nineteen drill and then go to the yard",
    "if the twelve file is on the bench oil the fourteen file",
    "bring the eighteen wrench to the rack",
    "put some oil on the ten drill",
    "bring the rotorvator to the bench",
)


@pytest.fixture(scope="module")
def understanding(tmp_path_factory: pytest.TempPathFactory) -> Understanding:
    folder = tmp_path_factory.mktemp("workshop")
    (folder / "domain.pddl").write_text(DOMAIN)
    (folder / "grammar.yaml").write_text(GRAMMAR)
    things = [
        f"  - {{name: {size}-{tool}, type: object, noun: {tool}, adjectives: [{size}]}}"
        for size in SIZES
        for tool in TOOLS
    ]
    facts = [f'  - "(at {size}-{tool} bench)"' for size in SIZES for tool in TOOLS]
    world = folder / "shop.yaml"
    world.write_text(
        "\n".join(
            [
                "schema: polaris-world/1", "name: shop", f"domain: {folder / 'domain.pddl'}", "entities:",
                "  - {name: hall, type: region}", "  - {name: yard, type: region}",
                "  - {name: bench, type: surface}", "  - {name: rack, type: surface}",
                "  - {name: rotorvator, type: object}", *things,
                "facts:", '  - "(robot-at hall)"', '  - "(hand-empty)"', '  - "(connected hall yard)"',
                '  - "(located bench hall)"', '  - "(located rack yard)"', '  - "(at rotorvator rack)"', *facts,
            ]
        )
    )  # fmt: skip
    return Understanding(load_world(str(world)))


@pytest.fixture(scope="module")
def ears(understanding: Understanding) -> Ears:
    return EarMaker().ears(spoken_phrases(understanding), spoken_names(understanding))


@pytest.mark.parametrize("text", SAID)
def test_things_that_differ_by_one_word_are_told_apart(
    understanding: Understanding, ears: Ears, text: str
) -> None:
    said = ears.utterance(
        [*silence(0.6), *blocks_of(spoken(text)), *silence(1.0)],
        lambda words: weight_of(understanding.interpret(words, Automaton())[0]),
    )
    typed, _ = understanding.interpret(text, Automaton())
    heard, _ = understanding.interpret(said.text, Automaton())
    assert typed.outcome == "applied"
    assert said.accepted
    assert heard.edits == typed.edits


def test_a_name_that_the_recogniser_lacks_is_listened_for_under_others(
    understanding: Understanding, ears: Ears
) -> None:
    told = gaps_in_words(ears.alikes, spoken_names(understanding))
    assert told == [f'I listen for "rotorvator" as "{ears.alikes.inward["rotorvator"]}".']
