"""A state in words, grouped by where things are."""

from __future__ import annotations

from polaris_nl.model.state import State
from polaris_nl.model.text import sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.render.layout import Row, wrapped


def state_rows(state: State, world: World, wording: Wording, width: int) -> list[Row]:
    """The facts that can change, one a row; static ones (where rooms and furniture are) are left out."""
    domain = world.domain
    facts = sorted(
        fact
        for fact in state.facts
        if domain.robot_can_change(fact.predicate) or domain.people_can_change(fact.predicate)
    )
    rows: list[Row] = []
    for fact in facts:
        rows.extend(wrapped(sentence(wording.fact(fact)), width))
    return rows
