"""`domains` and `worlds`: what ships with Polaris NL."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from polaris_nl.commands.common import print_json, print_text
from polaris_nl.model.data import shipped_domains, shipped_worlds
from polaris_nl.model.pddl import read_domain
from polaris_nl.model.world_file import read_world


def run(arguments: Namespace) -> int:
    """Lists domains or worlds."""
    rows = _domains() if arguments.command == "domains" else _worlds()
    for row in rows:
        if not arguments.json:
            print_text(row.pop("text"), f"{row['name']}: ")
    if arguments.json:
        print_json([{k: v for k, v in row.items() if k != "text"} for row in rows])
    return 0


def _domains() -> list[dict[str, Any]]:
    found = []
    for name, path in shipped_domains().items():
        domain = read_domain(path)
        operators = [o.name for o in domain.operators.values() if not o.internal]
        found.append(
            {
                "name": name,
                "predicates": sorted(domain.predicates),
                "operators": operators,
                "worlds": [w for w, p in shipped_worlds().items() if p.parent.parent.name == name],
                "text": f"the robot can {', '.join(o.replace('-', ' ') for o in operators)}",
            }
        )
    return found


def _worlds() -> list[dict[str, Any]]:
    found = []
    for name, path in shipped_worlds().items():
        world = read_world(path)
        regions = [e.spoken for e in world.of_type("region")]
        people = [e.spoken for e in world.of_type("person")]
        found.append(
            {
                "name": name,
                "domain": world.domain.name,
                "entities": len(world.entities),
                "text": f"{world.domain.name}, {len(world.entities)} entities; "
                f"rooms {', '.join(regions)}; people {', '.join(people)}",
            }
        )
    return found
