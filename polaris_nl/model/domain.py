"""Planning domains: types, predicates and operators, as values.

`polaris_nl.model.pddl` reads them from PDDL files.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from polaris_nl.model.formula import And, Formula, Literal, Quantified, Variable, When, literals_in
from polaris_nl.model.state import MutexGroup

OBJECT = "object"
KIND = "kind"
"""The predicate of `(kind ?d dish)` in quantified goals, which is read from the world."""


@dataclass(frozen=True, slots=True, order=True)
class Action:
    """An operator applied to entities: `(move home hall)`."""

    operator: str
    args: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"({' '.join((self.operator, *self.args))})"


@dataclass(frozen=True, slots=True)
class Predicate:
    """A predicate symbol with typed parameters.

    Attributes:
        hint: how the domain's author phrases it in a `; NL: [0] near [1]` comment, or "".
        internal: marked `; INTERNAL`: never shown to users.
    """

    name: str
    parameters: tuple[Variable, ...] = ()
    hint: str = ""
    internal: bool = False

    def __str__(self) -> str:
        return f"({' '.join((self.name, *map(str, self.parameters)))})"


@dataclass(frozen=True, slots=True)
class Operator:
    """What the robot can do: an action schema.

    Attributes:
        precondition: what has to hold before; `And(())` for nothing.
        effect: what comes about: literals, `and`, `forall` and `when`.
    """

    name: str
    parameters: tuple[Variable, ...]
    precondition: Formula
    effect: Formula
    hint: str = ""
    internal: bool = False

    def __str__(self) -> str:
        return f"({' '.join((self.name, *map(str, self.parameters)))})"

    def binding(self, action: Action) -> dict[str, str]:
        """The parameters' values in an action of this operator."""
        return dict(zip((p.name for p in self.parameters), action.args, strict=True))


@dataclass(frozen=True)
class Domain:
    """A planning domain.

    Attributes:
        name: as in the file.
        parents: each declared type and its parent types. A domain that declares `object` itself as
            one type among others means by it a thing that can be grasped, not the root of all
            types.
        predicates: by name; operators: by name.
        constants: entities that the domain itself declares, name to type.
        exogenous: predicates that a person brings about or may bring about (`; EXOGENOUS:`
            comments; without any, all that no operator changes).
        mutexes: groups that the file states in `; MUTEX:` comments; the others are found from the
            operators.
        commanded, uncommanded: where operators are anybody's, the types of those who carry them out
            and of those who can't be told to (see `polaris_nl.model.agents`).
        source: the PDDL text, as it was read.
        path: where it was read, or None.
    """

    name: str
    parents: Mapping[str, tuple[str, ...]]
    predicates: Mapping[str, Predicate]
    operators: Mapping[str, Operator]
    constants: Mapping[str, str] = field(default_factory=dict)
    exogenous: frozenset[str] = frozenset()
    mutexes: tuple[MutexGroup, ...] = ()
    commanded: tuple[str, ...] = ()
    uncommanded: tuple[str, ...] = ()
    source: str = field(default="", repr=False)
    path: Path | None = None

    @property
    def types(self) -> tuple[str, ...]:
        """All type names, as declared."""
        return tuple(self.parents)

    @property
    def object_is_a_type(self) -> bool:
        """Whether `object` is one type among others here (a thing to grasp) rather than the root."""
        return OBJECT in self.parents

    def is_a(self, kind: str, wanted: str) -> bool:
        """Whether every entity of type `kind` is one of type `wanted`."""
        if kind == wanted or (wanted == OBJECT and not self.object_is_a_type):
            return True
        return any(
            self.is_a(parent, wanted) for parent in self.parents.get(kind, ()) if parent != kind
        )

    def fits(self, kind: str, parameter: Variable) -> bool:
        """Whether an entity of type `kind` may stand for a parameter."""
        return not parameter.types or any(self.is_a(kind, wanted) for wanted in parameter.types)

    def achievers(self, literal: Literal) -> tuple[Operator, ...]:
        """The operators that can make a literal of this predicate and sign true."""
        return tuple(
            op
            for op in self.operators.values()
            if any(
                e.predicate == literal.predicate and e.positive == literal.positive
                for e in effect_literals(op.effect)
            )
        )

    def robot_can_change(self, predicate: str) -> bool:
        """Whether any operator makes atoms of a predicate true or false."""
        return any(
            e.predicate == predicate
            for op in self.operators.values()
            for e in effect_literals(op.effect)
        )

    def people_can_change(self, predicate: str) -> bool:
        """Whether a person may bring atoms of this predicate about (exogenous, DESIGN section 2)."""
        return predicate in self.exogenous


def effect_literals(effect: Formula) -> tuple[Literal, ...]:
    """The literals that an effect can make true, without the conditions they may depend on."""
    if isinstance(effect, And):
        return tuple(e for part in effect.parts for e in effect_literals(part))
    if isinstance(effect, When):
        return effect_literals(effect.effect)
    if isinstance(effect, Quantified):
        return effect_literals(effect.body)
    return tuple(literals_in(effect))


def conjuncts(formula: Formula) -> Iterable[Formula]:
    """The parts of nested `and`s, or the formula itself."""
    if isinstance(formula, And):
        for part in formula.parts:
            yield from conjuncts(part)
    else:
        yield formula
