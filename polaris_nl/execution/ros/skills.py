"""Skills: how each operator of a domain is done, as data: lists of primitives (`skills.yaml`).

A skills file lies beside its domain file. Parameters of primitives are the operator's own (`?o`) or
names of the world. What a primitive is to the robot is the profile's affair; code exists for
primitives only.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from polaris_nl.execution.ros.primitive_kinds import PRIMITIVES
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.model.domain import Action, Domain, Operator
from polaris_nl.model.errors import FormatError, did_you_mean
from polaris_nl.model.schema import check_schema
from polaris_nl.model.yaml_lines import Lined, read_yaml

SCHEMA = "polaris-skills/1"
FILE_NAME = "skills.yaml"


@dataclass(frozen=True, slots=True)
class Primitive:
    """One primitive: its name and arguments, still with variables in a skill, and bound in a step."""

    name: str
    arguments: Mapping[str, str]

    def __str__(self) -> str:
        return " ".join((self.name, *self.arguments.values()))


@dataclass(frozen=True)
class Skills:
    """The skills of a domain, by operator."""

    domain: str
    by_operator: Mapping[str, tuple[Primitive, ...]]

    def steps(self, action: Action, operator: Operator) -> tuple[Primitive, ...]:
        """The primitives that do an action, with its arguments in them."""
        names = {
            f"?{v.name.lstrip('?')}": a
            for v, a in zip(operator.parameters, action.args, strict=True)
        }
        return tuple(
            Primitive(p.name, {k: names.get(v, v) for k, v in p.arguments.items()})
            for p in self.by_operator[action.operator]
        )

    def missing(self, operators: Iterable[str], profile: Profile) -> tuple[str, ...]:
        """The operators that a robot has no skill for, each once, in their order."""
        able = profile.primitives
        return tuple(
            dict.fromkeys(
                name
                for name in operators
                if name not in self.by_operator
                or any(p.name not in able for p in self.by_operator[name])
            )
        )


def skills_for(domain: Domain) -> Skills:
    """The skills beside a domain file; none where there is no such file.

    Raises:
        FileError, FormatError: the file can't be read or isn't right.
    """
    path = domain.path.parent / FILE_NAME if domain.path is not None else None
    if path is None or not path.is_file():
        return Skills(domain.name, {})
    return read_skills(path, domain)


def read_skills(path: Path, domain: Domain) -> Skills:
    """Reads a skills file and checks it against its domain.

    Raises:
        FileError: it can't be read.
        FormatError: it isn't right; file and line are named.
    """
    try:
        root, _ = read_yaml(path)
        return _skills(root, domain)
    except FormatError as error:
        raise FormatError(error.reason, error.path or path, error.line) from error


def _skills(root: Lined, domain: Domain) -> Skills:
    given = root.mapping("A skills file", ("schema", "domain", "skills"))
    schema = given["schema"].text("schema") if "schema" in given else ""
    check_schema(schema, SCHEMA, "skills")
    if "skills" not in given or not isinstance(given["skills"].value, dict):
        raise FormatError("The field skills lists operators with their primitives.", line=root.line)
    named = given["domain"].text("domain") if "domain" in given else domain.name
    if named != domain.name:
        raise FormatError(
            f"These are skills for {named}, not for {domain.name}.", line=given["domain"].line
        )
    found: dict[str, tuple[Primitive, ...]] = {}
    for name, value in given["skills"].value.items():
        operator = domain.operators.get(name)
        if operator is None:
            hint = did_you_mean(str(name), domain.operators)
            raise FormatError(f"{domain.name} has no operator {name}.{hint}", line=value.line)
        found[name] = tuple(_primitive(item, operator, domain) for item in value.items(name))
    return Skills(domain.name, found)


def _primitive(lined: Lined, operator: Operator, domain: Domain) -> Primitive:
    if not isinstance(lined.value, dict) or "do" not in lined.value:
        raise FormatError("A primitive is given as {do: name, ...}.", line=lined.line)
    name = lined.value["do"].text("do")
    if name not in PRIMITIVES:
        raise FormatError(
            f"There is no primitive {name}.{did_you_mean(name, PRIMITIVES)}", line=lined.line
        )
    wanted = PRIMITIVES[name]
    given = lined.mapping(name, ("do", *wanted))
    for parameter, types in wanted.items():
        if parameter not in given:
            raise FormatError(f"{name} lacks {parameter}.", line=lined.line)
        _check_argument(given[parameter], parameter, types, operator, domain)
    return Primitive(name, {p: given[p].text(p) for p in wanted})


def _check_argument(
    lined: Lined, parameter: str, types: tuple[str, ...], operator: Operator, domain: Domain
) -> None:
    text = lined.text(parameter)
    if not text.startswith("?"):
        return  # A name of the world, which the domain doesn't know.
    variables = {f"?{v.name.lstrip('?')}": v for v in operator.parameters}
    if text not in variables:
        hint = did_you_mean(text, variables)
        raise FormatError(f"{operator.name} has no parameter {text}.{hint}", line=lined.line)
    for kind in variables[text].types:
        if not any(domain.is_a(kind, wanted) for wanted in types if wanted in domain.types):
            raise FormatError(
                f"{text} of {operator.name} is a {kind}; {parameter} takes a {' or '.join(types)}.",
                line=lined.line,
            )
