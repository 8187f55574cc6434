"""Reads PDDL domain files.

Understood are types, constants, predicates and operators of STRIPS and ADL; what planning with
costs or time adds is kept in the source text for the planner and otherwise passed over. Five kinds
of comment carry what PDDL has no syntax for:

    ; NL: [0] is near [1]                     phrases for the predicate or operator above or beside
    it ; INTERNAL                                never shown to users
    ; MUTEX: (acknowledged ?m) (dismissed ?m)  at most one of them holds (see `MutexGroup`)
    ; EXOGENOUS: at in acknowledged            people bring these about (without such a
                                              comment: whatever no operator changes)
    ; COMMANDED: robot                        who carries out operators that are anybody's (without
                                              it: `robot`; see `polaris_nl.model.agents`)
"""

from __future__ import annotations

from pathlib import Path

from polaris_nl.model.agents import narrowed
from polaris_nl.model.domain import Domain, Operator, Predicate
from polaris_nl.model.errors import DomainError, FormatError, did_you_mean
from polaris_nl.model.files import read_small_text
from polaris_nl.model.formula import And, Formula, Literal, Variable, formula_of, typed_list
from polaris_nl.model.pddl_comments import (
    Comment,
    check_predicate,
    commanded_in,
    comments_in,
    exogenous_in,
    hint_at,
    mutexes_in,
)
from polaris_nl.model.sexpr import Group, Node, Word, read_all


def read_domain(path: Path) -> Domain:
    """Reads a domain file.

    Raises:
        FileError: it can't be read.
        DomainError: it is no PDDL domain; the line is named.
    """
    text = read_small_text(path, "domain file", DomainError)
    try:
        return parse_domain(text, path)
    except DomainError:
        raise
    except FormatError as error:
        raise DomainError(error.reason, path, error.line) from error


def parse_domain(text: str, path: Path | None = None) -> Domain:
    """Makes a `Domain` of PDDL text.

    Raises:
        FormatError: the text is no PDDL domain; the line is named.
    """
    nodes = read_all(text)
    root = nodes[0] if nodes else None
    if not isinstance(root, Group) or root.head != "define" or len(root.items) < 2:
        raise DomainError(
            "This is no PDDL domain: it doesn't start with (define (domain ...", path, 1
        )
    name_node = root.items[1]
    if not isinstance(name_node, Group) or name_node.head != "domain" or len(name_node.items) != 2:
        raise DomainError("This is no PDDL domain: (domain NAME) is missing.", path, name_node.line)
    comments = comments_in(text)
    parents: dict[str, tuple[str, ...]] = {}
    predicates: dict[str, Predicate] = {}
    operators: dict[str, Operator] = {}
    constants: dict[str, str] = {}
    for section in root.items[2:]:
        if not isinstance(section, Group):
            raise DomainError(
                f"A section in parentheses was expected, but {section.text!r} found.",
                path,
                section.line,
            )
        if section.head == ":types":
            parents.update(_types(section))
        elif section.head == ":constants":
            constants.update({v.name: v.types[0] if v.types else "object" for v in _list(section)})
        elif section.head == ":predicates":
            for predicate in _predicates(section, comments):
                predicates[predicate.name] = predicate
        elif section.head == ":action":
            operator = _operator(section, comments)
            if operator.name in operators:
                raise DomainError(
                    f"The operator {operator.name} is defined twice.", path, section.line
                )
            operators[operator.name] = operator
        elif section.head == ":derived":
            raise DomainError(
                "Derived predicates are not supported; make it an operator's effect.",
                path,
                section.line,
            )
        elif section.head == ":durative-action":
            raise DomainError(
                "Operators that take time are not supported; make it an (:action ...).",
                path,
                section.line,
            )
    domain = Domain(
        name=_word(name_node.items[1]),
        parents=parents,
        predicates=predicates,
        operators=operators,
        constants=constants,
        exogenous=exogenous_in(comments, predicates, operators),
        mutexes=mutexes_in(comments, predicates),
        source=text,
        path=path,
    )
    _check(domain, root)
    return narrowed(domain, commanded_in(comments, domain.types))


def _types(section: Group) -> dict[str, tuple[str, ...]]:
    found: dict[str, tuple[str, ...]] = {}
    for kind in _list(section):
        found[kind.name] = found.get(kind.name, ()) + kind.types
        for parent in kind.types:
            if parent != "object":
                found.setdefault(parent, ())
    return found


def _list(section: Group) -> tuple[Variable, ...]:
    return tuple(typed_list(Group(section.items[1:], section.line)))


def _predicates(section: Group, comments: dict[int, Comment]) -> list[Predicate]:
    found = []
    for node in section.items[1:]:
        if not isinstance(node, Group) or not node.head:
            raise FormatError(
                "A predicate such as (at ?o - object ?s - surface) was expected.", line=node.line
            )
        hint, internal = hint_at(node.line, comments)
        found.append(Predicate(node.head, _list(node), hint, internal))
    return found


def _operator(section: Group, comments: dict[int, Comment]) -> Operator:
    if len(section.items) < 2 or len(section.items) % 2:
        raise FormatError(
            "An operator is (:action NAME :parameters ... :precondition ... :effect ...).",
            line=section.line,
        )
    name = _word(section.items[1])
    fields = {_word(k): v for k, v in zip(section.items[2::2], section.items[3::2], strict=True)}
    parameters: tuple[Variable, ...] = ()
    if ":parameters" in fields:
        parameters = tuple(typed_list(fields[":parameters"]))
    hint, internal = hint_at(section.line, comments)
    return Operator(
        name,
        parameters,
        _formula(fields.get(":precondition")),
        _formula(fields.get(":effect")),
        hint,
        internal,
    )


def _formula(node: Node | None) -> Formula:
    if node is None or (isinstance(node, Group) and not node.items):
        return And(())
    return formula_of(_without_costs(node))


def _without_costs(node: Node) -> Node:
    """Drops `(increase (total-cost) ...)`: the planner reads costs from the source."""
    if not isinstance(node, Group):
        return node
    kept = tuple(
        _without_costs(item)
        for item in node.items
        if not (isinstance(item, Group) and item.head in ("increase", "decrease", "assign"))
    )
    return Group(kept, node.line)


def _word(node: Node) -> str:
    if not isinstance(node, Word):
        raise FormatError("A name was expected here, not a list.", line=node.line)
    return node.text


def _check(domain: Domain, root: Group) -> None:
    if not domain.predicates:
        raise DomainError(
            "The domain has no :predicates, so there is nothing to aim for.", domain.path, root.line
        )
    for section in root.items[2:]:
        if isinstance(section, Group) and section.head == ":action":
            for node in section.items[2:]:
                _check_atoms(node, domain)
    known = {*domain.types, "object"}
    things: list[Predicate | Operator] = [*domain.predicates.values(), *domain.operators.values()]
    for thing in things:
        for parameter in thing.parameters:
            for kind in parameter.types:
                if kind not in known:
                    hint = did_you_mean(kind, known)
                    raise DomainError(
                        f"{thing.name} uses the undeclared type {kind}.{hint}", domain.path
                    )


_CONNECTIVES = {"and", "or", "not", "imply", "when", "forall", "exists", "=", "either", ""}


def _check_atoms(node: Node, domain: Domain) -> None:
    if not isinstance(node, Group):
        return
    if node.head in _CONNECTIVES or node.head.startswith("?"):
        for item in node.items[1:]:
            _check_atoms(item, domain)
    elif node.head not in ("increase", "decrease", "assign"):
        atom = formula_of(node)
        if isinstance(atom, Literal):
            check_predicate(atom, dict(domain.predicates), node.line)
