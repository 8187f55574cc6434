"""`check`: are domain, world, grammar and program files as they should be?"""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from polaris_nl.automaton.program import read_program
from polaris_nl.automaton.validation import validate
from polaris_nl.commands.common import complain, print_json, print_text, shown_path, world_for
from polaris_nl.execution.ros import profile as robot_profile
from polaris_nl.execution.ros import skills as robot_skills
from polaris_nl.execution.ros.profile import profile_for, profile_names, read_profile
from polaris_nl.execution.ros.skills import read_skills
from polaris_nl.interchange.isl_import import read_isl
from polaris_nl.language.grammar_check import SCHEMAS, Findings, check_domain, check_grammar_file
from polaris_nl.language.intents import INTENTS
from polaris_nl.model.errors import FileError, FormatError, GrammarError, PolarisError
from polaris_nl.model.pddl import read_domain
from polaris_nl.model.problem import is_problem, read_problem
from polaris_nl.model.text import capital, listed
from polaris_nl.model.world_file import read_world
from polaris_nl.model.yaml_lines import Lined, read_yaml

SKILLS = robot_skills.SCHEMA.partition("/")[0]
ROBOT = robot_profile.SCHEMA.partition("/")[0]


@dataclass(frozen=True)
class _Checked:
    """What a check of one file came to: what it is, and sentences about it."""

    what: str
    faults: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


def run(arguments: Namespace) -> int:
    """Checks each file; 1 where any has a fault. Warnings leave the code alone."""
    code = 0
    warned: set[str] = set()
    for path in arguments.files:
        try:
            found = _checked(path)
        except PolarisError as error:
            found = _Checked("", (str(error),))
        code = code or int(bool(found.faults))
        if arguments.json:
            print_json(_as_json(path, found))
        else:
            _print(path, found, warned)
    return code


def _as_json(path: Path, found: _Checked) -> dict[str, object]:
    return {
        "file": str(path),
        "kind": found.what or None,
        "ok": not found.faults,
        "faults": list(found.faults),
        "warnings": list(found.warnings),
    }


def _print(path: Path, found: _Checked, warned: set[str]) -> None:
    for fault in found.faults:
        complain(fault if str(path) in fault else f"{path}: {fault}")
    for warning in found.warnings:
        if warning not in warned:
            complain(f"warning: {warning}")
            warned.add(warning)
    if not found.faults:
        print_text(f"{path}: {found.what}, all right.")


def _checked(path: Path) -> _Checked:
    if path.suffix == ".json":
        program = read_program(path)
        faults = validate(program.automaton, world_for(None, program, path))
        return _Checked("a program", tuple(fault.text for fault in faults))
    if path.suffix == ".pddl":
        return _pddl(path)
    if path.suffix == ".isl":
        read_isl(path)
        return _Checked("a program in ISL")
    if path.suffix in (".yaml", ".yml"):
        return _yaml(path)
    raise FileError(
        f"{path} is neither a domain or problem (.pddl), world, grammar, skills or robot profile (.yaml), "
        "nor program (.json, .isl)."
    )


def _pddl(path: Path) -> _Checked:
    try:
        problem = is_problem(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError):
        problem = False  # Reading it as a domain says what is wrong.
    if problem:
        return _of("a problem, usable as a world", check_domain(read_problem(path).domain))
    domain = read_domain(path)
    what = "a domain"
    if domain.uncommanded:
        acts, others = listed(domain.commanded), listed(domain.uncommanded)
        what = f"a domain in which type {acts} can be commanded and type {others} can't"
    return _of(what, check_domain(domain))


def _yaml(path: Path) -> _Checked:
    schema = _schema(path)
    if schema == SKILLS:
        return _skills(path)
    if schema == ROBOT:
        profile = read_profile(path)
        return _Checked(f"a robot profile, {profile.title}")
    if _is_grammar(path):
        found = check_grammar_file(path)
        return _of(found.what, found)
    return _of("a world", check_domain(read_world(path).domain))


def _skills(path: Path) -> _Checked:
    domain = read_domain(path.with_name("domain.pddl"))
    skills = read_skills(path, domain)
    warnings = [
        f"{path}: {operator} has no skill, so no robot can do it."
        for operator in domain.operators
        if operator not in skills.by_operator
    ]
    for name in profile_names():
        profile = profile_for(name)
        unable = skills.missing(skills.by_operator, profile)
        if unable:
            warnings.append(f"{capital(profile.title)} has no means for: {listed(unable)}.")
    return _Checked(f"skills for {domain.name}", warnings=tuple(warnings))


def _fields(path: Path) -> dict[str, Lined]:
    try:
        root, _ = read_yaml(path)
    except FormatError as error:
        raise FormatError(error.reason, error.path or path, error.line) from error
    return root.value if isinstance(root.value, dict) else {}


def _schema(path: Path) -> str:
    """The name of the schema that a file gives itself, without the version, or ""."""
    return str(_fields(path).get("schema", Lined("", 1)).value or "").partition("/")[0]


def _is_grammar(path: Path) -> bool:
    """Whether a file calls itself a grammar, or, without a schema, has the fields of one."""
    fields, schema = _fields(path), _schema(path)
    if schema in [known.partition("/")[0] for known in SCHEMAS]:
        return True
    return not schema and not {"entities", "domain"} & fields.keys() and _grammar_fields(fields)


def _grammar_fields(fields: Iterable[str]) -> bool:
    return bool({"predicates", "operators", "wordings", "lists", "uses", INTENTS} & set(fields))


def _of(what: str, found: Findings) -> _Checked:
    warnings = (
        GrammarError(w.reason, Path(shown_path(w.path.resolve())) if w.path else None, w.line)
        for w in found.warnings
    )
    return _Checked(what, tuple(map(str, found.errors)), tuple(map(str, warnings)))
