"""`check`: are domain, world, grammar and program files as they should be?"""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from polaris_nl.automaton.program import read_program
from polaris_nl.automaton.validation import validate
from polaris_nl.commands.common import complain, print_json, print_text, world_for
from polaris_nl.language.grammar import SCHEMA as GRAMMAR
from polaris_nl.language.grammar import load_grammar, read_common, read_grammar
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.data import data_folder, shipped_domains
from polaris_nl.model.errors import FileError, FormatError, PolarisError
from polaris_nl.model.pddl import read_domain
from polaris_nl.model.world_file import read_world
from polaris_nl.model.yaml_lines import read_yaml


def run(arguments: Namespace) -> int:
    """Checks each file; 1 where any has a fault."""
    code = 0
    for path in arguments.files:
        try:
            what, faults = _checked(path)
        except PolarisError as error:
            what, faults = "", [str(error)]
        code = code or int(bool(faults))
        if arguments.json:
            print_json(
                {"file": str(path), "kind": what or None, "ok": not faults, "faults": faults}
            )
            continue
        for fault in faults:
            complain(fault if str(path) in fault else f"{path}: {fault}")
        if not faults:
            print_text(f"{path}: {what}, all right.")
    return code


def _checked(path: Path) -> tuple[str, list[str]]:
    if path.suffix == ".json":
        program = read_program(path)
        faults = validate(program.automaton, world_for(None, program, path))
        return "a program", [fault.text for fault in faults]
    if path.suffix == ".pddl":
        load_grammar(read_domain(path))
        return "a domain", []
    if path.suffix in (".yaml", ".yml"):
        return _yaml(path)
    raise FileError(
        f"{path} is neither a domain (.pddl), world or grammar (.yaml) nor program (.json)."
    )


def _yaml(path: Path) -> tuple[str, list[str]]:
    try:
        root, _ = read_yaml(path)
    except FormatError as error:
        raise FormatError(error.reason, error.path or path, error.line) from error
    schema = root.value.get("schema") if isinstance(root.value, dict) else None
    if schema is None or schema.value != GRAMMAR:
        Understanding(read_world(path))
        return "a world", []
    folder = (
        path.parent if (path.parent / "common.yaml").is_file() else data_folder("grammars") / "en"
    )
    common = read_common(folder / "common.yaml")
    if path.name == "common.yaml":
        return "the shared grammar", []
    domains = shipped_domains()
    domain = domains.get(path.stem) or next(iter(path.parent.glob("*.pddl")), None)
    if domain is None:
        # A grammar that others use is checked with every domain, by the files that use it.
        for known in domains.values():
            read_grammar(path, read_domain(known), common, folder)
        return "a shared grammar", []
    read_grammar(path, read_domain(domain), common, folder)
    return "a grammar", []
