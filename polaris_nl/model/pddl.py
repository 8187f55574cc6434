"""Reads PDDL domain files.

Understood are types, constants, predicates and operators of STRIPS and ADL; what planning with
costs or time adds is kept in the source text for the planner and otherwise passed over. Four kinds
of comment carry what PDDL has no syntax for:

    ; NL: [0] is near [1]                     phrases for the predicate or operator above or beside
    it ; INTERNAL                                never shown to users
    ; MUTEX: (acknowledged ?m) (dismissed ?m)  at most one of them holds (see `MutexGroup`)
    ; EXOGENOUS: at in acknowledged            people bring these about (without such a
                                              comment: whatever no operator changes)
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from polaris_nl.model.domain import Domain, Operator, Predicate, effect_literals
from polaris_nl.model.errors import DomainError, FileError, FormatError, did_you_mean
from polaris_nl.model.formula import And, Formula, Literal, Variable, formula_of, typed_list
from polaris_nl.model.sexpr import Group, Node, Word, read_all
from polaris_nl.model.state import MutexGroup

MAX_BYTES = 4_000_000
_COMMENT = re.compile(r";+\s*(?:(NL|MUTEX|EXOGENOUS):\s*(.*)|(INTERNAL)\b)", re.IGNORECASE)


def read_domain(path: Path) -> Domain:
    """Reads a domain file.

    Raises:
        FileError: it can't be read.
        DomainError: it is no PDDL domain; the line is named.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise DomainError(
                f"A domain file of more than {MAX_BYTES // 10**6} MB is refused.", path
            )
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = "it is not UTF-8 text" if isinstance(error, UnicodeDecodeError) else error.strerror
        raise FileError(f"Can't read the domain file {path}: {reason}. Check the path.") from error
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
    comments = _comments(text)
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
    domain = Domain(
        name=_word(name_node.items[1]),
        parents=parents,
        predicates=predicates,
        operators=operators,
        constants=constants,
        exogenous=_exogenous(comments, predicates, operators),
        mutexes=_mutexes(comments, predicates),
        source=text,
        path=path,
    )
    _check(domain, root)
    return domain


class _Comment(NamedTuple):
    """A comment that says something: its kind and text, and whether it has a line of its own."""

    kind: str
    text: str
    alone: bool


def _comments(text: str) -> dict[int, _Comment]:
    found = {}
    for number, line in enumerate(text.splitlines(), 1):
        match = _COMMENT.search(line)
        if match:
            alone = not line[: match.start()].strip()
            found[number] = _Comment(
                (match[1] or match[3]).upper(), (match[2] or "").strip(), alone
            )
    return found


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


def _predicates(section: Group, comments: dict[int, _Comment]) -> list[Predicate]:
    found = []
    for node in section.items[1:]:
        if not isinstance(node, Group) or not node.head:
            raise FormatError(
                "A predicate such as (at ?o - object ?s - surface) was expected.", line=node.line
            )
        hint, internal = _hint(node.line, comments)
        found.append(Predicate(node.head, _list(node), hint, internal))
    return found


def _hint(line: int, comments: dict[int, _Comment]) -> tuple[str, bool]:
    """The phrases beside a definition, or on the lines right above it that hold nothing else."""
    found = [comments[line]] if line in comments else []
    above = line - 1
    while above in comments and comments[above].alone:
        found.append(comments[above])
        above -= 1
    hint = next((comment.text for comment in found if comment.kind == "NL"), "")
    return hint, any(comment.kind == "INTERNAL" for comment in found)


def _operator(section: Group, comments: dict[int, _Comment]) -> Operator:
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
    hint, internal = _hint(section.line, comments)
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


def _mutexes(
    comments: dict[int, _Comment], predicates: dict[str, Predicate]
) -> tuple[MutexGroup, ...]:
    groups = []
    for line, (kind, text, _) in comments.items():
        if kind != "MUTEX":
            continue
        patterns = tuple(formula_of(node) for node in read_all(text, line))
        for pattern in patterns:
            if not isinstance(pattern, Literal) or not pattern.positive:
                raise FormatError(
                    "A MUTEX comment lists atoms such as (acknowledged ?m).", line=line
                )
            _check_predicate(pattern, predicates, line)
        groups.append(MutexGroup(tuple(p for p in patterns if isinstance(p, Literal))))
    return tuple(groups)


def _exogenous(
    comments: dict[int, _Comment],
    predicates: dict[str, Predicate],
    operators: dict[str, Operator],
) -> frozenset[str]:
    found = set()
    for line, (kind, text, _) in comments.items():
        for name in text.lower().split() if kind == "EXOGENOUS" else ():
            if name not in predicates:
                raise FormatError(
                    f"There is no predicate {name}.{did_you_mean(name, predicates)}", line=line
                )
            found.add(name)
    if found:
        return frozenset(found)
    changed = {e.predicate for op in operators.values() for e in effect_literals(op.effect)}
    return frozenset(predicates) - changed


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
            _check_predicate(atom, dict(domain.predicates), node.line)


def _check_predicate(atom: Literal, predicates: dict[str, Predicate], line: int) -> None:
    predicate = predicates.get(atom.predicate)
    if predicate is None:
        hint = did_you_mean(atom.predicate, predicates)
        raise FormatError(f"There is no predicate {atom.predicate}.{hint}", line=line)
    if len(predicate.parameters) != len(atom.args):
        raise FormatError(
            f"{predicate} takes {len(predicate.parameters)} terms, but {atom} has {len(atom.args)}.",
            line=line,
        )
