"""The types of entities, as slots ask for them."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.model.world import World


def is_a(world: World, entity: str, types: Sequence[str]) -> bool:
    """Whether an entity is of one of some types; of any where there are none."""
    known = world.entities.get(entity)
    if known is None:
        return False
    return not types or any(world.domain.is_a(known.type, t) for t in types)
