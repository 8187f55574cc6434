"""What actions cost the search: fewest actions first, and among equally short plans the quickest.

An action costs `UNIT`, and up to `MOST_EXTRA` more where it is known to take its time. So in plans of up
to a hundred actions nothing that is learned ever makes a plan longer: it only decides between plans that
are as short.
"""

from __future__ import annotations

from collections.abc import Mapping

UNIT = 10_000
MOST_EXTRA = 99

Extra = Mapping[str, int]
"""What an action costs beyond the unit, by its text without parentheses: "move home hall", or, for all
other actions of an operator, by the operator: "move"."""


def cost(name: str, extra: Extra) -> int:
    """The cost of a ground action; 1 where nothing is known of any, so that costs are counts.

    Args:
        name: the action's text without parentheses.
        extra: what is known.
    """
    if not extra:
        return 1
    operator = name.partition(" ")[0]
    more = extra.get(name, extra.get(operator, 0))
    return UNIT + min(max(more, 0), MOST_EXTRA)
