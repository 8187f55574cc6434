"""PDDL domains: what is read, and what each mistake is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.model.errors import FileError, FormatError
from polaris_nl.model.formula import Variable, parse_literal
from polaris_nl.model.pddl import parse_domain, read_domain
from polaris_nl.model.world import World

from .conftest import DOMAIN


def test_types_predicates_operators_and_comments_are_read() -> None:
    domain = parse_domain(DOMAIN)
    assert domain.types == ("object", "surface", "region", "person")
    assert domain.predicates["at"].hint == "[0] is on [1]"
    assert domain.predicates["holding"].hint == ""
    assert domain.operators["pick"].hint == "pick [0] up"
    assert domain.operators["pick"].parameters[2] == Variable("?r", ("region",))
    assert domain.exogenous == {"at", "answered", "refused"}
    assert [str(g) for g in domain.mutexes] == ["(answered ?p) (refused ?p)"]


def test_object_is_a_type_of_its_own_where_the_domain_declares_it() -> None:
    domain = parse_domain(DOMAIN)
    assert not domain.is_a("surface", "object")
    other = parse_domain("(define (domain d) (:types a - b) (:predicates (p ?x - object)))")
    assert other.is_a("a", "object")
    assert other.is_a("a", "b")
    assert not other.is_a("b", "a")


def test_without_a_comment_whatever_no_operator_changes_is_exogenous() -> None:
    text = "(define (domain d) (:predicates (p) (q)) (:action a :parameters () :effect (p)))"
    assert parse_domain(text).exogenous == {"q"}


def test_achievers_are_found_below_conditions_and_quantifiers() -> None:
    domain = parse_domain(DOMAIN)
    assert [o.name for o in domain.achievers(parse_literal("(at red-cup shelf)"))] == ["drop-all"]
    assert [o.name for o in domain.achievers(parse_literal("(not (hand-empty))"))] == ["pick"]
    assert not domain.robot_can_change("answered")


def test_costs_are_passed_over() -> None:
    text = DOMAIN.replace("(robot-at ?b)))", "(robot-at ?b) (increase (total-cost) 3)))", 1)
    assert parse_domain(text).operators["go"] == parse_domain(DOMAIN).operators["go"]


@pytest.mark.parametrize(
    ("old", "new", "line", "reason"),
    [
        ("(define (domain errands)", "(define (problem errands)", 1, "(domain NAME) is missing"),
        ("(define", "(problem", 1, "doesn't start with"),
        ("(robot-at ?a)\n", "(robot-on ?a)\n", 17, "no predicate robot-on. Did you mean robot-at?"),
        ("(located ?s ?r)", "(located ?s)", 22, "takes 2 terms"),
        (
            "(called ?p - person)",
            "(called ?p - persn)",
            None,
            "undeclared type persn. Did you mean person",
        ),
        ("; EXOGENOUS: at", "; EXOGENOUS: att", 14, "no predicate att"),
        ("(:action go", "(:action pick", 20, "defined twice"),
        (":parameters (?a ?b - region)", ":parameters", 15, "An operator is"),
    ],
)
def test_every_mistake_is_named_with_its_line(
    tmp_path: Path, old: str, new: str, line: int | None, reason: str
) -> None:
    assert old in DOMAIN
    path = tmp_path / "d.pddl"
    path.write_text(DOMAIN.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(FormatError) as caught:
        read_domain(path)
    assert reason in str(caught.value)
    assert caught.value.line == line


@pytest.mark.parametrize("content", [b"", b"hello", b"\xff\xff", b"(define)", b"(define (domain))"])
def test_files_that_are_no_domains_raise_one_sentence(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "d.pddl"
    path.write_bytes(content)
    with pytest.raises(FileError) as caught:
        read_domain(path)
    assert "\n" not in str(caught.value)


def test_the_world_knows_its_domain(flat: World) -> None:
    assert flat.domain.path is not None
    assert flat.domain.source == DOMAIN
