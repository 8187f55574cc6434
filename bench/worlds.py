"""Worlds and programs of any size, grown from a shipped world."""

from __future__ import annotations

import random
from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, apply
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.model.world import Entity, World
from polaris_nl.model.world_file import load_world

NEEDED = ("tray", "cup", "plate")
SURFACES = ("table", "desk", "worktop", "dining-table", "nightstand")
CORE = ("home", "hall", "kitchen", "office", "worktop", "desk", *NEEDED)
"""What is left of the care home in a world that is smaller than its rooms and furniture."""
FURNISHED = 30


def grown(entities: int) -> World:
    """The care home with things added, or left out, until it has so many entities."""
    world = load_world("care-home")
    kept = {
        name: entity
        for name, entity in world.entities.items()
        if entities >= FURNISHED or name in CORE
    }
    for entity in reversed(list(world.of_type("object"))):
        if len(kept) > entities and entity.name not in NEEDED:
            kept.pop(entity.name, None)
    facts = {f for f in world.facts if all(a in kept for a in f.args)}
    surfaces = [e.name for e in kept.values() if e.type == "surface"]
    placed = {f.args[0] for f in facts if f.predicate in ("at", "in")}
    for name in NEEDED:
        if name not in placed:
            facts.add(Literal("at", (name, surfaces[0])))
    number = 0
    while len(kept) < entities:
        name = f"thing-{number}"
        kept[name] = Entity(name, "object")
        facts.add(Literal("at", (name, surfaces[number % len(surfaces)])))
        number += 1
    return replace(world, entities=kept, facts=frozenset(facts))


def goals(world: World, count: int, seed: int = 1) -> list[Literal]:
    """Things to be put on surfaces, never the same twice in a row."""
    chosen = random.Random(seed)
    surfaces = [s for s in SURFACES if s in world.entities]
    found: list[Literal] = []
    while len(found) < count:
        goal = Literal("at", (chosen.choice(NEEDED), chosen.choice(surfaces)))
        if found[-1:] != [goal]:
            found.append(goal)
    return found


def chain(world: World, length: int, seed: int = 1) -> Automaton:
    """A program of so many checkpoints in a row."""
    return _program(world, list(range(length)), seed)


def tree(world: World, size: int, seed: int = 1) -> Automaton:
    """A program of so many checkpoints, two after each: one if a message is acknowledged, one else."""
    return _program(world, [0, *((number + 1) // 2 for number in range(size - 1))], seed)


def _program(world: World, parents: list[int], seed: int) -> Automaton:
    program = Automaton()
    messages = [e.name for e in world.of_type("message")]
    for number, (parent, goal) in enumerate(
        zip(parents, goals(world, len(parents), seed), strict=True), 1
    ):
        here = Checkpoint(f"c{number}", f"step {number}", (goal,))
        source = START if parent == 0 else f"c{parent}"
        siblings = program.outgoing(source)
        when: tuple[Literal, ...] = ()
        if siblings:
            when = (Literal("acknowledged", (messages[number % len(messages)],)),)
        program = apply(
            program, AddCheckpoint(here, Transition(f"t{number}", source, here.id, when))
        )
    return program


def with_leaf(program: Automaton, goal: str) -> Automaton:
    """A program with one more checkpoint at its end."""
    last = list(program.checkpoints)[-1]
    here = Checkpoint(program.fresh_checkpoint_id(), "asked", (parse_literal(goal),))
    return apply(
        program, AddCheckpoint(here, Transition(program.fresh_transition_id(), last, here.id))
    )


def with_goal(program: Automaton, checkpoint: str, goal: Literal) -> Automaton:
    """A program in which a checkpoint has another goal."""
    return program.with_checkpoint(replace(program.checkpoints[checkpoint], goals=(goal,)))
