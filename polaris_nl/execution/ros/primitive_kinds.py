"""The primitives that skills are made of, and that profiles say how to do."""

from __future__ import annotations

from collections.abc import Mapping

PLACE = ("surface", "container")
PRIMITIVES: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    "navigate": {"to": ("region", "person", *PLACE)},
    "reach": {"to": ("object", "person", *PLACE)},
    "retract": {},
    "grasp": {"object": ("object",), "at": PLACE},
    "release": {"object": ("object",), "at": PLACE},
    "hand-over": {"object": ("object",), "to": ("person",)},
    "take": {"object": ("object",), "from": ("person",)},
    "open": {"what": ("container",)},
    "close": {"what": ("container",)},
    "fill": {"object": ("object",), "at": ("surface",)},
    "say": {"person": ("person",), "message": ("message",)},
}
"""The primitives there is code for, with their parameters and the types that these may have."""
