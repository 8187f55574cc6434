"""A simulated person, who stands somewhere or walks."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

WALK_M_S = 0.9


@dataclass(slots=True)
class Person:
    """Somebody: where, and the way ahead."""

    name: str
    x: float
    y: float
    yaw: float = 0.0
    way: list[tuple[float, float]] = field(default_factory=list)

    def step(self, seconds: float) -> None:
        """Walks on."""
        left = WALK_M_S * seconds
        while self.way and left > 0:
            x, y = self.way[0]
            distance = math.dist((self.x, self.y), (x, y))
            if distance > 1e-6:
                self.yaw = math.atan2(y - self.y, x - self.x)
            if distance <= left:
                self.x, self.y = self.way.pop(0)
            else:
                self.x += (x - self.x) * left / distance
                self.y += (y - self.y) * left / distance
            left -= distance
