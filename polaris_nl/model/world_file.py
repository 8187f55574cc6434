"""Reads world files (`polaris-world/1`, DESIGN section 7)."""

from __future__ import annotations

import math
import re
from pathlib import Path

from polaris_nl.model.check import formula_faults
from polaris_nl.model.data import domain_path, world_path
from polaris_nl.model.domain import Domain
from polaris_nl.model.errors import FormatError, WorldError, did_you_mean
from polaris_nl.model.formula import Formula, Literal, parse_formula
from polaris_nl.model.pddl import parse_domain, read_domain
from polaris_nl.model.problem import is_problem, parse_problem, read_problem
from polaris_nl.model.schema import check_schema
from polaris_nl.model.world import Entity, HumanAction, Objective, Point, Scenario, World
from polaris_nl.model.yaml_lines import Lined, parse_yaml, read_yaml

SCHEMA = "polaris-world/1"
_FIELDS = ("schema", "name", "domain", "entities", "facts", "map", "scenario")
_ENTITY_FIELDS = (
    "name", "type", "synonyms", "noun", "adjectives", "kinds", "owner", "gender", "user", "area", "pose",
)  # fmt: skip
_GENDERS = ("female", "male", "")
_NAME = re.compile(r"[a-z0-9][a-z0-9_-]*\Z")


def load_world(name: str) -> World:
    """Reads a shipped world, or one named by a path: a world file or a PDDL problem.

    Raises:
        FileError: there is no such world, or it or its domain can't be read.
        FormatError: it or its domain is not as it should be; file and line are named.
    """
    path = world_path(name)
    return read_problem(path) if path.suffix == ".pddl" else read_world(path)


def world_of_texts(world: str, domain: str) -> World:
    """Makes a world of the texts of its file (or PDDL problem) and its domain, as logs keep them.

    The map is left out, as it lies in a file of its own.

    Raises:
        FormatError: either is not as it should be; the line is named.
    """
    known = parse_domain(domain)
    if is_problem(world):
        return parse_problem(world, known)
    fields = parse_yaml(world).mapping("A world", _FIELDS)
    check_schema(fields["schema"].text("schema") if "schema" in fields else "", SCHEMA, "world")
    return _world(fields, known, world, None)


def read_world(path: Path) -> World:
    """Reads a world file and its domain.

    Raises:
        FileError: it can't be read.
        WorldError: it is no world file, or doesn't fit its domain; the line is named.
        DomainError: its domain can't be understood.
    """
    try:
        root, text = read_yaml(path)
        fields = root.mapping("A world", _FIELDS)
        check_schema(fields["schema"].text("schema") if "schema" in fields else "", SCHEMA, "world")
        if "domain" not in fields:
            raise FormatError(
                "The world names no domain; add one, such as domain: caregiving.", line=1
            )
        domain = read_domain(domain_path(fields["domain"].text("domain"), path.parent))
        return _world(fields, domain, text, path)
    except FormatError as error:
        if error.path is not None:
            raise
        raise WorldError(error.reason, path, error.line) from error


def _world(fields: dict[str, Lined], domain: Domain, text: str, path: Path | None) -> World:
    entities = _entities(fields.get("entities", Lined(None, 1)), domain)
    types = {**domain.constants, **{e.name: e.type for e in entities.values()}}
    facts = [
        _fact(item, domain, types) for item in fields.get("facts", Lined(None, 1)).items("facts")
    ]
    map_path = None
    if "map" in fields and path is not None:
        map_path = path.parent / fields["map"].text("map")
        if not map_path.is_file():
            raise FormatError(f"There is no map file {map_path}.", line=fields["map"].line)
    return World(
        name=_name(fields, path),
        domain=domain,
        entities=entities,
        facts=frozenset(facts),
        scenario=_scenario(fields["scenario"], domain, types)
        if "scenario" in fields
        else Scenario(),
        map=map_path,
        source=text,
        path=path,
    )


def _name(fields: dict[str, Lined], path: Path | None) -> str:
    if "name" in fields:
        return fields["name"].text("name")
    return path.stem if path is not None else "world"


def _entities(root: Lined, domain: Domain) -> dict[str, Entity]:
    found = {name: Entity(name, kind) for name, kind in domain.constants.items()}
    lines: dict[str, int] = {}
    for item in root.items("entities"):
        entity = _entity(item, domain)
        if entity.name in lines:
            first = lines[entity.name]
            raise FormatError(
                f"There is another {entity.name} on line {first}; give one of them a new name.",
                line=item.line,
            )
        lines[entity.name] = item.line
        found[entity.name] = entity
    for name, line in lines.items():
        owner = found[name].owner
        if owner and owner not in found:
            hint = did_you_mean(owner, found)
            raise FormatError(f"{name}'s owner {owner} is not in this world.{hint}", line=line)
    users = [name for name in lines if found[name].user]
    if len(users) > 1:
        raise FormatError(
            f"{users[0]} and {users[1]} are both marked as user; one person speaks.",
            line=lines[users[1]],
        )
    return found


def _entity(item: Lined, domain: Domain) -> Entity:
    fields = item.mapping("An entity", _ENTITY_FIELDS)
    for wanted in ("name", "type"):
        if wanted not in fields:
            raise FormatError(
                f"This entity has no {wanted}; every entity needs a name and a type.",
                line=item.line,
            )
    name, kind = fields["name"].text("name"), fields["type"].text("type")
    if not _NAME.match(name):
        raise FormatError(
            f"{name!r} is no entity name: use lower case letters, digits and hyphens.",
            line=fields["name"].line,
        )
    if kind not in domain.types and kind != "object":
        hint = did_you_mean(kind, domain.types)
        raise FormatError(
            f"The domain {domain.name} has no type {kind}.{hint}", line=fields["type"].line
        )
    gender = fields["gender"].text("gender") if "gender" in fields else ""
    if gender not in _GENDERS:
        raise FormatError(f"gender is female or male, not {gender!r}.", line=fields["gender"].line)

    def words(field: str) -> tuple[str, ...]:
        return (
            tuple(w.lower().strip() for w in fields[field].texts(field)) if field in fields else ()
        )

    return Entity(
        name=name,
        type=kind,
        synonyms=words("synonyms"),
        noun=fields["noun"].text("noun").lower() if "noun" in fields else "",
        adjectives=words("adjectives"),
        kinds=words("kinds"),
        owner=fields["owner"].text("owner") if "owner" in fields else "",
        gender=gender,
        user=fields["user"].flag("user") if "user" in fields else False,
        area=_area(fields["area"]) if "area" in fields else None,
        pose=_pose(fields["pose"]) if "pose" in fields else None,
    )


def _numbers(value: Lined, what: str, count: int) -> tuple[float, ...]:
    numbers = tuple(item.number(f"each of {what}") for item in value.items(what))
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        raise FormatError(f"{what} is {count} numbers, but has {len(numbers)}.", line=value.line)
    return numbers


def _area(value: Lined) -> tuple[Point, Point]:
    corners = value.items("area")
    if len(corners) != 2:
        raise FormatError("area is two corners, [[x1, y1], [x2, y2]].", line=value.line)
    (x1, y1), (x2, y2) = (_numbers(corner, "a corner", 2) for corner in corners)
    if x1 == x2 or y1 == y2:
        raise FormatError("This area is empty: its corners lie on one line.", line=value.line)
    return (min(x1, x2), min(y1, y2)), (max(x1, x2), max(y1, y2))


def _pose(value: Lined) -> tuple[float, float, float]:
    x, y, heading = _numbers(value, "pose", 3)
    return x, y, heading


def _fact(item: Lined, domain: Domain, types: dict[str, str]) -> Literal:
    fact = _formula(item, domain, types)
    if not isinstance(fact, Literal):
        raise FormatError(f"{fact} is not a single fact such as (at tray table).", line=item.line)
    if not fact.positive:
        raise FormatError(f"{fact} needn't be said: what isn't listed is false.", line=item.line)
    return fact


def _formula(item: Lined, domain: Domain, types: dict[str, str]) -> Formula:
    try:
        formula = parse_formula(item.text("a fact"))
    except FormatError as error:
        raise FormatError(error.reason, line=item.line) from error
    for fault in formula_faults(formula, domain, types):
        raise FormatError(fault, line=item.line)
    return formula


def _scenario(root: Lined, domain: Domain, types: dict[str, str]) -> Scenario:
    fields = root.mapping("scenario", ("objectives", "human_actions"))
    objectives = []
    for item in fields["objectives"].items("objectives") if "objectives" in fields else ():
        objective = item.mapping("An objective", ("name", "goal"))
        if "goal" not in objective:
            raise FormatError("This objective has no goal.", line=item.line)
        goal = _formula(objective["goal"], domain, types)
        name = objective["name"].text("name") if "name" in objective else str(goal)
        objectives.append(Objective(name, goal))
    actions = []
    for item in fields["human_actions"].items("human_actions") if "human_actions" in fields else ():
        action = item.mapping("A human action", ("name", "effect", "when"))
        if "name" not in action or "effect" not in action:
            raise FormatError("A human action has a name and an effect.", line=item.line)
        actions.append(
            HumanAction(
                action["name"].text("name"),
                _literals(action["effect"], "effect", domain, types),
                _literals(action["when"], "when", domain, types) if "when" in action else (),
            )
        )
    return Scenario(tuple(objectives), tuple(actions))


def _literals(
    value: Lined, what: str, domain: Domain, types: dict[str, str]
) -> tuple[Literal, ...]:
    found = []
    for item in value.items(what):
        formula = _formula(item, domain, types)
        if not isinstance(formula, Literal):
            raise FormatError(
                f"{formula} is not a single fact such as (at tray table).", line=item.line
            )
        found.append(formula)
    return tuple(found)
