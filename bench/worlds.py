"""Worlds and programs of any size, grown from a shipped world."""

from __future__ import annotations

from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, apply
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.model.world import Entity, World
from polaris_nl.model.world_file import load_world

GOALS = (
    "(at tray table)",
    "(at cup desk)",
    "(open fridge)",
    "(robot-at home)",
    "(at plate dining-table)",
)


def grown(entities: int) -> World:
    """The care home with things added, or left out, until it has so many entities."""
    world = load_world("care-home")
    kept = dict(world.entities)
    surfaces = [e.name for e in world.of_type("surface")]
    needed = {"tray", "cup", "plate"}
    for entity in reversed(list(world.of_type("object"))):
        if len(kept) > entities and entity.name not in needed:
            del kept[entity.name]
    facts = {f for f in world.facts if all(a in kept for a in f.args)}
    number = 0
    while len(kept) < entities:
        name = f"thing-{number}"
        kept[name] = Entity(name, "object")
        facts.add(Literal("at", (name, surfaces[number % len(surfaces)])))
        number += 1
    return replace(world, entities=kept, facts=frozenset(facts))


def chain(length: int) -> Automaton:
    """A program of so many checkpoints in a row."""
    program, last = Automaton(), START
    for number in range(1, length + 1):
        goal = parse_literal(GOALS[number % len(GOALS)])
        here = Checkpoint(f"c{number}", f"step {number}", (goal,))
        program = apply(program, AddCheckpoint(here, Transition(f"t{number}", last, here.id)))
        last = here.id
    return program


def with_leaf(program: Automaton, goal: str) -> Automaton:
    """A program with one more checkpoint at its end."""
    last = list(program.checkpoints)[-1]
    here = Checkpoint(program.fresh_checkpoint_id(), "asked", (parse_literal(goal),))
    return apply(
        program, AddCheckpoint(here, Transition(program.fresh_transition_id(), last, here.id))
    )
