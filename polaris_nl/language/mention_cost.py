"""What speaks against a mention: vague words, and places that may rather be where a thing is to go."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.language.mention import Mention
from polaris_nl.model.world import World

_BESIDE = 0.5
_STATE, _PART = 0.05, 0.02
_VAGUE, _NO_SURFACE = 0.3, 0.4
_PLACE, _ELSEWHERE, _ON_ANOTHER = 0.15, 0.3, 0.4
_IDLE_PLACE = 2.5
"""What a place in a list costs, unless each thing stands where it says: in "the bowl in the cupboard and
the cup in the drawer" it is where the bowl is to be put."""
_TYPE_RANK = 3
"""The rank of a candidate of which only the type was named."""


class MentionCost:
    """Rates mentions of one world's entities."""

    def __init__(self, world: World) -> None:
        self._world = world

    def of(self, mention: Mention, types: Sequence[str]) -> float:
        """How much speaks against a mention in a slot of some types."""
        cost = self._place(mention) + (_BESIDE if mention.beside else 0.0)
        if mention.parts:
            return cost + _PART * len(mention.parts) + self._places(mention.parts)
        cost += _STATE * len(mention.states)
        best = min((c.rank for c in mention.candidates), default=0)
        cost += _VAGUE if best == _TYPE_RANK else 0.0
        if mention.candidates and "surface" in types:
            kinds = {self._world.entities[c.entity].type for c in mention.candidates}
            cost += _NO_SURFACE if "surface" not in kinds else 0.0
        return cost

    def _places(self, parts: Sequence[Mention]) -> float:
        """The places in a list: one for all of it describes as well as that of a single thing."""
        if all(p.place is not None and p.place is parts[0].place for p in parts):
            return max(self._place(p) for p in parts)
        everywhere = all(p.place for p in parts)
        idle = [p for p in parts if p.place and not (everywhere and self._stands_there(p))]
        return _IDLE_PLACE * len(idle)

    def _place(self, mention: Mention) -> float:
        """A place that is taken for a description: "the cup on the table", which stands there."""
        if mention.place is None:
            return 0.0
        cost = _PLACE if self._stands_there(mention) else _PLACE + _ELSEWHERE
        return cost + (_ON_ANOTHER if self._is_furniture_on_another(mention) else 0.0)

    def _stands_there(self, mention: Mention) -> bool:
        """Whether one of the things that a mention can mean is where it says, at the start."""
        places = {c.entity for c in mention.place.candidates} if mention.place else set()
        things = {c.entity for c in mention.candidates}
        return any(
            len(f.args) == 2 and f.args[0] in things and f.args[1] in places
            for f in self._world.facts
        )

    def _is_furniture_on_another(self, mention: Mention) -> bool:
        """Whether a surface or a container is said to be on or in another one."""
        named = [c.entity for m in (mention, mention.place) if m for c in m.candidates]
        kinds = {self._world.entities[name].type for name in named}
        return kinds <= {"surface", "container"}
