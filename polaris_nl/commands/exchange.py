"""`export` and `import`: programs in other forms."""

from __future__ import annotations

import json
from argparse import Namespace
from pathlib import Path

from polaris_nl.automaton.program import Program, program_json, write_program
from polaris_nl.automaton.validation import validate
from polaris_nl.commands.common import complain, opened, print_json, print_text, shown_path
from polaris_nl.interchange.isl_export import export_isl
from polaris_nl.interchange.isl_import import automaton_of, faults, notes, read_isl
from polaris_nl.interchange.isl_syntax import Isl
from polaris_nl.interchange.properties import Property, properties
from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.errors import FormatError, UsageError
from polaris_nl.model.text import listed
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world
from polaris_nl.render.glyphs import plain
from polaris_nl.render.graphs import dot, mermaid
from polaris_nl.session import Session


def run(arguments: Namespace) -> int:
    """Reads or writes another form; 1 where something of the program can't be said in it."""
    return _import(arguments) if arguments.command == "import" else _export(arguments)


def _export(arguments: Namespace) -> int:
    program, world = opened(arguments)
    missing: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    if arguments.to == "isl":
        export = export_isl(program.automaton, world.domain)
        text, missing, changed = export.text.rstrip("\n"), export.missing, export.notes
    else:
        draw = mermaid if arguments.to == "mermaid" else dot
        with Session(world, program.automaton) as session:
            text = draw(program.automaton, session.wording)
    if arguments.json:
        value = {"form": arguments.to, "text": text}
        print_json({**value, "missing": list(missing), "notes": list(changed)})
    else:
        for reason in missing:
            complain(plain(reason))
        for note in changed:
            complain(f"note: {plain(note)}")
        if not missing:
            print(text)
    return 1 if missing else 0


def _import(arguments: Namespace) -> int:
    path: Path = arguments.file
    isl = read_isl(path)
    world = load_world(arguments.world) if arguments.world else _world_of(isl)
    found = [str(FormatError(e.reason, path, e.line)) for e in faults(isl, world)]
    if found:
        if arguments.json:
            print_json({"file": str(path), "program": None, "faults": found})
        for fault in found if not arguments.json else ():
            complain(fault)
        return 1
    automaton = automaton_of(isl)
    program = Program(automaton, world.domain.name, world.name)
    if arguments.program is not None:
        if arguments.program.exists():
            raise UsageError(f"{arguments.program} is there already; name another with --program.")
        write_program(program, arguments.program)
    problems = tuple(fault.text for fault in validate(automaton, world))
    return _tell(arguments, program, properties(automaton), problems, _notes(isl, world))


def _notes(isl: Isl, world: World) -> tuple[str, ...]:
    """What doesn't come along, and who acts."""
    if not world.domain.uncommanded:
        return notes(isl)
    acts, others = listed(world.domain.commanded), listed(world.domain.uncommanded)
    return (*notes(isl), f"Type {acts} can be commanded, and type {others} can't.")


def _tell(
    arguments: Namespace,
    program: Program,
    shape: tuple[Property, ...],
    problems: tuple[str, ...],
    said: tuple[str, ...],
) -> int:
    """Says what came of an import; 1 where the program has to be mended before it can be planned."""
    fine = all(found.holds for found in shape) and not problems
    if arguments.json:
        print_json(
            {
                "file": str(arguments.file),
                "program": program_json(program),
                "properties": {found.name: found.holds for found in shape},
                "against": {found.name: list(found.against) for found in shape if not found.holds},
                "problems": list(problems),
                "notes": list(said),
                "faults": [],
            }
        )
        return 0 if fine else 1
    for note in said:
        complain(f"note: {plain(note)}")
    for found in shape:
        for text in found.against:
            complain(plain(f"not {found.name.replace('_', '-')}: {text}"))
    for text in problems:
        complain(plain(f"to be mended: {text}"))
    if arguments.program is None:
        print(json.dumps(program_json(program), indent=2, ensure_ascii=False))
    else:
        count = len(program.automaton.checkpoints) - 1
        shown = f"polaris-nl plan {shown_path(arguments.program)}"
        print_text(
            f"{count} checkpoint{'' if count == 1 else 's'} saved; see the plan with: {shown}"
        )
    return 0 if fine else 1


def _world_of(isl: Isl) -> World:
    """The one shipped world of an ISL text's domain.

    Raises:
        UsageError: there isn't exactly one.
    """
    worlds = [load_world(name) for name in shipped_worlds()]
    fitting = [world for world in worlds if world.domain.name == isl.domain]
    if len(fitting) != 1:
        raise UsageError(
            f"Which world? The program is for the domain {isl.domain}; name a world of it with --world."
        )
    return fitting[0]
