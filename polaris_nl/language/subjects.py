"""What goals and conditions are about."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.model.formula import Literal


def subjects(literals: Sequence[Literal]) -> set[str]:
    """What literals are about: the first argument, but for what a person has the thing."""
    return {x.args[-1 if x.predicate == "has" else 0] for x in literals if x.args}
