"""`durations`: how long a world's actions took, as plans take it into account; or forgets it."""

from __future__ import annotations

from argparse import Namespace

from polaris_nl.automaton.program import parse_action
from polaris_nl.commands.common import print_json, print_text
from polaris_nl.execution.durations_file import durations_path, forget, read_durations
from polaris_nl.model.world_file import load_world


def run(arguments: Namespace) -> int:
    """Shows or forgets what was learned."""
    world = load_world(arguments.world)
    if arguments.reset:
        forgotten = forget(world)
        if arguments.json:
            print_json({"world": world.name, "forgotten": forgotten})
        else:
            told = "is forgotten" if forgotten else "had not been learned"
            print_text(f"How long actions take in {world.name} {told}.")
        return 0
    known = read_durations(world).known
    if arguments.json:
        actions = [
            {"action": a, "seconds": round(d.seconds, 1), "times": d.times}
            for a, d in known.items()
        ]
        print_json({"world": world.name, "file": str(durations_path(world)), "actions": actions})
        return 0
    if not known:
        print_text(f"Nothing has been learned yet of how long actions take in {world.name}.")
        return 0
    from polaris_nl.language.understanding import Understanding

    wording = Understanding(world).wording
    print_text("Among equally short plans, the one that takes the least time is chosen.")
    for text, duration in sorted(known.items(), key=lambda item: -item[1].seconds):
        times = "once" if duration.times == 1 else f"{duration.times} times"
        print_text(f"{wording.action(parse_action(text))}, {times}", f"{duration.seconds:7.1f} s  ")
    return 0
