"""Literals and the formulas made of them: goals, conditionals, preconditions and effects.

A term is a name (`tray`) or a variable (`?o`). `str()` of every value is its PDDL text, and
`parse_formula(str(f)) == f`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from polaris_nl.model.errors import FormatError
from polaris_nl.model.sexpr import Group, Node, Word, read_one

Binding = Mapping[str, str]


@dataclass(frozen=True, slots=True, order=True)
class Literal:
    """A predicate applied to terms, or its negation: `(at tray table)`, `(not (open cupboard))`."""

    predicate: str
    args: tuple[str, ...] = ()
    positive: bool = True

    def __str__(self) -> str:
        atom = f"({' '.join((self.predicate, *self.args))})"
        return atom if self.positive else f"(not {atom})"

    @property
    def atom(self) -> Literal:
        """The same literal without its negation."""
        return self if self.positive else Literal(self.predicate, self.args)

    @property
    def negation(self) -> Literal:
        """The literal that is true exactly where this one is false."""
        return Literal(self.predicate, self.args, not self.positive)

    def bind(self, binding: Binding) -> Literal:
        """Replaces variables; terms without a binding stay."""
        return Literal(self.predicate, tuple(binding.get(a, a) for a in self.args), self.positive)


@dataclass(frozen=True, slots=True)
class Variable:
    """A typed variable, `?o - object`; several types mean `(either ...)`, none means any."""

    name: str
    types: tuple[str, ...] = ()

    def __str__(self) -> str:
        if not self.types:
            return self.name
        kind = self.types[0] if len(self.types) == 1 else f"(either {' '.join(self.types)})"
        return f"{self.name} - {kind}"


@dataclass(frozen=True, slots=True)
class And:
    """All parts hold; as an effect: all of them come about."""

    parts: tuple[Formula, ...]

    def __str__(self) -> str:
        return f"({' '.join(('and', *map(str, self.parts)))})"


@dataclass(frozen=True, slots=True)
class Or:
    """At least one part holds."""

    parts: tuple[Formula, ...]

    def __str__(self) -> str:
        return f"({' '.join(('or', *map(str, self.parts)))})"


@dataclass(frozen=True, slots=True)
class Not:
    """The part doesn't hold. A negated literal is a `Literal`, never a `Not`."""

    part: Formula

    def __str__(self) -> str:
        return f"(not {self.part})"


@dataclass(frozen=True, slots=True)
class Imply:
    """Where the condition holds, the conclusion does."""

    condition: Formula
    conclusion: Formula

    def __str__(self) -> str:
        return f"(imply {self.condition} {self.conclusion})"


@dataclass(frozen=True, slots=True)
class Quantified:
    """`(forall (?d - object) body)` or `(exists ...)`."""

    quantifier: str
    variables: tuple[Variable, ...]
    body: Formula

    def __str__(self) -> str:
        return f"({self.quantifier} ({' '.join(map(str, self.variables))}) {self.body})"


@dataclass(frozen=True, slots=True)
class When:
    """A conditional effect."""

    condition: Formula
    effect: Formula

    def __str__(self) -> str:
        return f"(when {self.condition} {self.effect})"


@dataclass(frozen=True, slots=True)
class Equal:
    """Two terms name the same entity."""

    left: str
    right: str

    def __str__(self) -> str:
        return f"(= {self.left} {self.right})"


Formula = Literal | And | Or | Not | Imply | Quantified | When | Equal
Goal = Formula


def parse_formula(text: str) -> Formula:
    """Reads a formula from PDDL text.

    Raises:
        FormatError: the text is no formula.
    """
    return formula_of(read_one(text))


def parse_literal(text: str) -> Literal:
    """Reads one literal from PDDL text.

    Raises:
        FormatError: the text is no literal.
    """
    formula = parse_formula(text)
    if not isinstance(formula, Literal):
        raise FormatError(f"{text} is not a single fact such as (at tray table).")
    return formula


def formula_of(node: Node) -> Formula:
    """Makes a formula of an expression.

    Raises:
        FormatError: the expression is no formula, named with its line.
    """
    if isinstance(node, Word):
        raise FormatError(
            f"A fact in parentheses was expected, but {node.text!r} found.", line=node.line
        )
    head, rest = node.head, node.items[1:]
    if head in ("and", "or"):
        parts = tuple(formula_of(part) for part in rest)
        return And(parts) if head == "and" else Or(parts)
    if head == "not":
        part = formula_of(_only(node, 1)[0])
        return part.negation if isinstance(part, Literal) else Not(part)
    if head in ("imply", "when"):
        first, second = (formula_of(part) for part in _only(node, 2))
        return Imply(first, second) if head == "imply" else When(first, second)
    if head in ("forall", "exists"):
        variables, body = _only(node, 2)
        return Quantified(head, tuple(typed_list(variables)), formula_of(body))
    terms = tuple(_term(part) for part in rest)
    if head == "=":
        _only(node, 2)
        return Equal(terms[0], terms[1])
    if not head:
        raise FormatError("A fact starts with the name of its predicate.", line=node.line)
    return Literal(head, terms)


def typed_list(node: Node) -> Iterator[Variable]:
    """Reads `(?a ?b - type ?c - (either t1 t2))`; names without a type get none.

    Raises:
        FormatError: a type is missing after a dash, or something else than a name stands in the
        list.
    """
    if isinstance(node, Word):
        raise FormatError(
            f"A list in parentheses was expected, but {node.text!r} found.", line=node.line
        )
    names: list[str] = []
    items = iter(node.items)
    for item in items:
        if isinstance(item, Group):
            raise FormatError("A name was expected here, not a list.", line=item.line)
        if item.text != "-":
            names.append(item.text)
            continue
        kind = next(items, None)
        if kind is None:
            raise FormatError("A type is missing after the dash.", line=item.line)
        types = _types(kind)
        yield from (Variable(name, types) for name in names)
        names.clear()
    yield from (Variable(name) for name in names)


def literals_in(formula: Formula) -> Iterator[Literal]:
    """Every literal in a formula, conditions included, in reading order."""
    if isinstance(formula, Literal):
        yield formula
    elif isinstance(formula, And | Or):
        for part in formula.parts:
            yield from literals_in(part)
    elif isinstance(formula, Not):
        yield from literals_in(formula.part)
    elif isinstance(formula, Imply):
        yield from literals_in(formula.condition)
        yield from literals_in(formula.conclusion)
    elif isinstance(formula, When):
        yield from literals_in(formula.condition)
        yield from literals_in(formula.effect)
    elif isinstance(formula, Quantified):
        yield from literals_in(formula.body)


def bind(formula: Formula, binding: Binding) -> Formula:
    """Replaces free variables in a formula."""
    if isinstance(formula, Literal):
        return formula.bind(binding)
    if isinstance(formula, And):
        return And(tuple(bind(p, binding) for p in formula.parts))
    if isinstance(formula, Or):
        return Or(tuple(bind(p, binding) for p in formula.parts))
    if isinstance(formula, Not):
        return Not(bind(formula.part, binding))
    if isinstance(formula, Imply):
        return Imply(bind(formula.condition, binding), bind(formula.conclusion, binding))
    if isinstance(formula, When):
        return When(bind(formula.condition, binding), bind(formula.effect, binding))
    if isinstance(formula, Quantified):
        inner = {k: v for k, v in binding.items() if k not in {x.name for x in formula.variables}}
        return Quantified(formula.quantifier, formula.variables, bind(formula.body, inner))
    return Equal(binding.get(formula.left, formula.left), binding.get(formula.right, formula.right))


def _only(node: Group, count: int) -> tuple[Node, ...]:
    rest = node.items[1:]
    if len(rest) != count:
        raise FormatError(
            f"({node.head} ...) takes {count} parts, but has {len(rest)}.", line=node.line
        )
    return rest


def _term(node: Node) -> str:
    if isinstance(node, Group):
        raise FormatError("A name was expected here, not a list.", line=node.line)
    return node.text


def _types(node: Node) -> tuple[str, ...]:
    if isinstance(node, Word):
        return (node.text,)
    if node.head != "either":
        raise FormatError("A type is a name or (either a b).", line=node.line)
    return tuple(_term(part) for part in node.items[1:])
