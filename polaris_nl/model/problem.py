"""Reads PDDL problem files as worlds: objects are entities, the initial state is what is true at the start.

The problem's goal becomes the scenario's objectives, one for each part of it, so that `score` has
something to count. Values of functions (costs) are the planner's business and are passed over.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from polaris_nl.model.check import formula_faults
from polaris_nl.model.data import shipped_domains
from polaris_nl.model.domain import Domain, conjuncts
from polaris_nl.model.errors import FileError, FormatError, WorldError, did_you_mean
from polaris_nl.model.files import read_small_text
from polaris_nl.model.formula import Formula, Literal, formula_of, typed_list
from polaris_nl.model.pddl import read_domain
from polaris_nl.model.sexpr import Group, Node, Word, read_all
from polaris_nl.model.world import Entity, Objective, Scenario, World

_PARTS = (":domain", ":objects", ":init", ":goal", ":requirements", ":metric")


def is_problem(text: str) -> bool:
    """Whether a text starts as a PDDL problem does."""
    try:
        nodes = read_all(text)
    except FormatError:
        return False
    root = nodes[0] if nodes else None
    return isinstance(root, Group) and root.head == "define" and _head(root) == "problem"


def read_problem(path: Path) -> World:
    """Reads a PDDL problem and its domain, which lies in the same folder or is a shipped one.

    Raises:
        FileError: it can't be read, or its domain isn't there.
        WorldError: it is no PDDL problem, or doesn't fit its domain; the line is named.
        DomainError: its domain can't be understood.
    """
    text = read_small_text(path, "problem file", WorldError)
    try:
        name = _word(_part(_root(text), ":domain"))
        return parse_problem(text, _domain(name, path), path)
    except FormatError as error:
        if error.path is not None:
            raise
        raise WorldError(error.reason, path, error.line) from error


def parse_problem(text: str, domain: Domain, path: Path | None = None) -> World:
    """Makes a world of a PDDL problem's text.

    Raises:
        FormatError: the text is no PDDL problem, or doesn't fit the domain; the line is named.
    """
    root = _root(text)
    for section in root.items[2:]:
        if not isinstance(section, Group) or section.head not in _PARTS:
            name = section.head if isinstance(section, Group) else section.text
            hint = did_you_mean(name, _PARTS)
            raise FormatError(f"A problem has no part {name!r}.{hint}", line=section.line)
    wanted = _part(root, ":domain")
    if _word(wanted) != domain.name:
        raise FormatError(
            f"The problem is for the domain {_word(wanted)}, not for {domain.name}.",
            line=wanted.line,
        )
    entities = {n: Entity(n, kind) for n, kind in domain.constants.items()}
    entities.update((e.name, e) for e in _objects(root, domain))
    types = {e.name: e.type for e in entities.values()}
    return World(
        name=_word(_group(root.items[1])),
        domain=domain,
        entities=entities,
        facts=frozenset(_facts(root, domain, types)),
        scenario=Scenario(tuple(_objectives(root, domain, types))),
        source=text,
        path=path,
    )


def _domain(name: str, beside: Path) -> Domain:
    """The domain of a name among the PDDL files of a folder, or of those that are shipped.

    Raises:
        FileError: it isn't there.
        DomainError: it is there, and has a fault.
    """
    for path in sorted(beside.parent.glob("*.pddl")):
        if path.resolve() != beside.resolve() and _defined(path) == ("domain", name):
            return read_domain(path)
    if name in shipped_domains():
        return read_domain(shipped_domains()[name])
    raise FileError(
        f"{beside} is for the domain {name}, and no PDDL file beside it has that one; put it there."
    )


def _defined(path: Path) -> tuple[str, str] | None:
    """What a PDDL file defines, and its name; None where it can't be told."""
    try:
        nodes = read_all(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, FormatError):
        return None
    root = nodes[0] if nodes else None
    if not isinstance(root, Group) or not _head(root):
        return None
    named = _group(root.items[1]).items
    return (_head(root), named[1].text) if len(named) == 2 and isinstance(named[1], Word) else None


def _root(text: str) -> Group:
    nodes = read_all(text)
    root = nodes[0] if nodes else None
    if not isinstance(root, Group) or root.head != "define" or _head(root) != "problem":
        raise FormatError(
            "This is no PDDL problem: it doesn't start with (define (problem ...", line=1
        )
    return root


def _head(root: Group) -> str:
    second = root.items[1] if len(root.items) > 1 else None
    return second.head if isinstance(second, Group) else ""


def _part(root: Group, name: str) -> Group:
    """The one part of a problem that has a name.

    Raises:
        FormatError: there is none, or more than one.
    """
    found = [s for s in root.items[2:] if isinstance(s, Group) and s.head == name]
    if len(found) != 1:
        count = "no" if not found else f"{len(found)} parts"
        raise FormatError(f"The problem has {count} {name}; it needs one.", line=root.line)
    return found[0]


def _optional(root: Group, name: str) -> Group:
    there = any(isinstance(s, Group) and s.head == name for s in root.items[2:])
    return _part(root, name) if there else Group((Word(name, root.line),), root.line)


def _group(node: Node) -> Group:
    if isinstance(node, Word):
        raise FormatError(
            f"A list in parentheses was expected, but {node.text!r} found.", line=node.line
        )
    return node


def _word(section: Group) -> str:
    if len(section.items) == 2 and isinstance(section.items[1], Word):
        return section.items[1].text
    raise FormatError(f"({section.head} NAME) was expected here.", line=section.line)


def _objects(root: Group, domain: Domain) -> Iterator[Entity]:
    section = _optional(root, ":objects")
    seen: set[str] = set()
    for variable in typed_list(Group(section.items[1:], section.line)):
        name = variable.name
        if name in seen:
            raise FormatError(f"There are two objects {name}; rename one.", line=section.line)
        seen.add(name)
        if len(variable.types) > 1:
            raise FormatError(f"{name} has several types; give it one.", line=section.line)
        kind = variable.types[0] if variable.types else "object"
        if kind != "object" and kind not in domain.types:
            hint = did_you_mean(kind, domain.types)
            raise FormatError(
                f"The domain {domain.name} has no type {kind}.{hint}", line=section.line
            )
        if name not in domain.constants:
            yield Entity(name, kind)


def _facts(root: Group, domain: Domain, types: Mapping[str, str]) -> Iterator[Literal]:
    for node in _part(root, ":init").items[1:]:
        if isinstance(node, Group) and node.head == "=" and len(node.items) == 3:
            continue  # The value of a function.
        fact = _checked(node, domain, types)
        if not isinstance(fact, Literal):
            raise FormatError(
                f"{fact} is not a single fact such as (at tray table).", line=node.line
            )
        if fact.positive:  # What isn't listed is false, and may be said to be.
            yield fact


def _objectives(root: Group, domain: Domain, types: Mapping[str, str]) -> Iterator[Objective]:
    section = _optional(root, ":goal")
    if len(section.items) > 2:
        raise FormatError("(:goal ...) takes one formula.", line=section.line)
    for node in section.items[1:]:
        if isinstance(node, Group) and not node.items:
            continue
        for part in conjuncts(_checked(node, domain, types)):
            yield Objective(str(part), part)


def _checked(node: Node, domain: Domain, types: Mapping[str, str]) -> Formula:
    formula = formula_of(node)
    for fault in formula_faults(formula, domain, types):
        raise FormatError(fault, line=node.line)
    return formula
