"""What a user has in mind instead of the plan, and how the two compare, as values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal

Way = OneOf["first", "before", "instead"]
Outcome = OneOf[
    "possible", "already", "holds", "needed", "impossible", "asked", "absent", "undecided"
]


@dataclass(frozen=True, slots=True)
class Foil:
    """What the user has in mind.

    Attributes:
        way: `first`: the wanted facts before all else; `before`: before the plan's facts; `instead`:
            the wanted facts, and the plan's never on the way to that checkpoint's goals.
        wanted: the facts that the foil reaches.
        fact: the facts of the plan that they are held against; none for `first`.
    """

    way: Way
    wanted: tuple[Literal, ...]
    fact: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class Contrast:
    """The plan beside its foil.

    Attributes:
        outcome: `possible`; `already`: the plan does it so; `holds`: the wanted facts are true then
            anyway; `needed`: they can't be reached without the plan's facts; `impossible`: they
            can't be reached there at all; `asked`: the plan's facts are what the user asked for;
            `absent`: the plan doesn't bring its own facts about; `undecided`: not found out in time.
        checkpoint: the checkpoint on the way to which the plan would change, or None.
        prefix: what the robot would do first, in the foil.
        extra: how many actions more the foil has, on the branch where they differ most; negative
            where it has fewer.
        more, less: the actions that only the foil has, and only the plan, on that branch.
        still: for `instead`: the plan's facts come about all the same.
        lost: the checkpoints that the foil would leave out.
        reason: for `impossible`, why, in a sentence.
        offered: whether a step of its own with the wanted facts, put there, gives a plan that is as
            short as the foil and has its order.
        exact: whether no way to the checkpoint is shorter than the one found.
    """

    outcome: Outcome
    checkpoint: str | None = None
    prefix: tuple[Action, ...] = ()
    extra: int = 0
    more: tuple[Action, ...] = ()
    less: tuple[Action, ...] = ()
    still: bool = False
    lost: tuple[str, ...] = ()
    reason: str = ""
    exact: bool = True
    offered: bool = False
