"""Literals and formulas: PDDL text and back."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.model.errors import FormatError
from polaris_nl.model.formula import (
    And,
    Equal,
    Imply,
    Literal,
    Not,
    Or,
    Quantified,
    Variable,
    When,
    bind,
    literals_in,
    parse_formula,
    parse_literal,
)

names = st.from_regex(r"[a-z][a-z0-9-]{0,8}", fullmatch=True).filter(
    lambda n: n not in {"and", "or", "not", "imply", "when", "forall", "exists", "either"}
)
literals = st.builds(Literal, names, st.lists(names, max_size=3).map(tuple), st.booleans())
variables = st.builds(Variable, names.map("?{}".format), st.lists(names, max_size=2).map(tuple))
formulas = st.recursive(
    literals | st.builds(Equal, names, names),
    lambda inner: (
        st.builds(And, st.lists(inner, max_size=3).map(tuple))
        | st.builds(Or, st.lists(inner, max_size=3).map(tuple))
        | st.builds(Not, inner.filter(lambda f: not isinstance(f, Literal)))
        | st.builds(Imply, inner, inner)
        | st.builds(When, inner, inner)
        | st.builds(
            Quantified,
            st.sampled_from(["forall", "exists"]),
            st.lists(variables.filter(lambda v: v.types), min_size=1, max_size=2).map(tuple),
            inner,
        )
    ),
    max_leaves=8,
)


@given(formulas)
def test_a_formula_is_read_back_from_its_text(formula: And) -> None:
    assert parse_formula(str(formula)) == formula


def test_text_is_case_insensitive_and_freely_spaced() -> None:
    assert parse_literal("( NOT\n(Open  Cupboard) )") == Literal("open", ("cupboard",), False)


def test_binding_replaces_free_variables_only() -> None:
    formula = parse_formula("(and (at ?o ?s) (forall (?o - object) (at ?o ?s)))")
    bound = bind(formula, {"?o": "cup", "?s": "sink"})
    assert str(bound) == "(and (at cup sink) (forall (?o - object) (at ?o sink)))"


def test_literals_are_found_in_reading_order() -> None:
    formula = parse_formula("(imply (and (a) (not (b))) (when (c) (exists (?x - t) (d ?x))))")
    assert [str(x) for x in literals_in(formula)] == ["(a)", "(not (b))", "(c)", "(d ?x)"]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "One expression"),
        ("(at tray", "never closed"),
        ("at tray)", "no opening"),
        ("(a) (b)", "2 expressions"),
        ("tray", "fact in parentheses"),
        ("()", "name of its predicate"),
        ("(not (a) (b))", "takes 1 parts"),
        ("(imply (a))", "takes 2 parts"),
        ("(at (tray) table)", "not a list"),
        ("(forall (?d -) (a ?d))", "type is missing"),
        ("(" * 200 + ")" * 200, "nested deeper"),
    ],
)
def test_what_is_no_formula_is_refused_with_the_reason(text: str, reason: str) -> None:
    with pytest.raises(FormatError, match=reason):
        parse_formula(text)
