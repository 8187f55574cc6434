"""`stretch-sim`: starts a simulated Stretch in this process, until it is stopped."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from polaris_nl.commands.common import print_json, print_text
from polaris_nl.execution.ros.stretch_sim.main import Order, Ready, serve
from polaris_nl.execution.ros.stretch_sim.simulator import Options
from polaris_nl.model.errors import UsageError, did_you_mean
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world

NONE = "none"
FASTEST = 50.0
PICTURES = (".mp4", ".png")


def run(arguments: Namespace) -> int:
    """Serves until it is interrupted; 0 then."""
    order = _order(arguments)

    def ready(found: Ready) -> None:
        if arguments.json:
            print_json({"ready": True, "world": order.world.name, "physics": found.physical})
        else:
            print_text(found.text)

    closing = serve(order, ready)
    if arguments.json:
        print_json({"ready": False, **closing.figures})
    else:
        print_text(closing.text)
    return 0


def _order(arguments: Namespace) -> Order:
    world = load_world(arguments.world)
    if not 0 < arguments.speed <= FASTEST:
        raise UsageError(
            f"--speed is more than 0 and at most {FASTEST:g}, not {arguments.speed:g}."
        )
    if not 0 <= arguments.dropout <= 1:
        raise UsageError(f"--dropout is a share from 0 to 1, not {arguments.dropout:g}.")
    if arguments.noise < 0:
        raise UsageError(f"--noise is in metres and at least 0, not {arguments.noise:g}.")
    render: Path | None = arguments.render
    if render is not None and render.suffix not in PICTURES:
        raise UsageError(f"--render makes {' or '.join(PICTURES)}, not {render.name}.")
    people = _people(arguments.people, world)
    options = Options(people, arguments.seed, arguments.speed, arguments.noise, arguments.dropout)
    return Order(world, options, arguments.kinematic, render)


def _people(named: list[str] | None, world: World) -> tuple[str, ...] | None:
    if named is None:
        return None
    names = [name.strip() for text in named for name in text.split(",")]
    known = [a.name for a in world.scenario.human_actions]
    for name in names:
        if name != NONE and name not in known:
            hint = did_you_mean(name, known) or " The world file lists none."
            raise UsageError(f"Nobody in {world.name} can do {name!r}.{hint}")
    return tuple(name for name in names if name != NONE)
