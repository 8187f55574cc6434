"""Which goals exclude each other: minimal conflicting sets, and the fewest goals to give up.

One minimal set is found by QuickXplain (Junker, "QuickXplain: preferred explanations and relaxations
for over-constrained problems", AAAI 2004), all of them by MARCO (Liffiton, Previti, Malik and
Marques-Silva, "Fast, flexible MUS enumeration", Constraints 21, 2016): the map of what is not known
yet is searched for the largest set that may still be met; where it can be, what is left out of it is
a minimal correction set, and where it can't, a minimal conflicting set is found in it. Everything
here is about sets alone: whether goals can be met is asked of a function.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

MOST_STEPS = 2_000
"""How many sets are looked at for the next one to try."""

T = TypeVar("T")
Meets = Callable[[Sequence[T]], bool | None]
"""Whether some goals can be met together; None where that isn't decided in time."""


@dataclass(frozen=True, slots=True)
class Conflicts(Generic[T]):
    """What is known of the conflicts among some goals.

    Attributes:
        cores: minimal sets that can't be met, the smallest first, each in the goals' order.
        corrections: minimal sets without which the rest can be met, the smallest first.
        complete: whether these are all of them, and surely minimal.
    """

    cores: tuple[tuple[T, ...], ...]
    corrections: tuple[tuple[T, ...], ...]
    complete: bool


def conflicts(
    goals: Sequence[T],
    meets: Meets[T],
    known: Iterable[Sequence[T]] = (),
    enough: int | None = None,
    over: Callable[[], bool] = lambda: False,
) -> Conflicts[T]:
    """All minimal conflicting sets and all minimal correction sets of some goals.

    Args:
        goals: different goals, in the order they were said.
        meets: whether some of them can be met together.
        known: minimal conflicting sets that needn't be looked for.
        enough: stop after so many conflicting sets (the known ones not counted).
        over: asked before each step; True ends the search with what was found.
    """
    cores = [frozenset(core) for core in known]
    given = len(cores)
    met: list[frozenset[T]] = []
    exact = True

    def ask(some: Sequence[T]) -> bool | None:
        nonlocal exact
        if any(core.issubset(some) for core in cores):
            return False
        answer = None if over() else meets(some)
        exact = exact and answer is not None
        return answer

    while True:
        seed, certain = _unexplored(goals, cores, met)
        exact = exact and certain
        if seed is None:
            break
        if over() or (enough is not None and len(cores) - given >= enough):
            exact = False
            break
        if ask(seed) is False:
            cores.append(frozenset(quick_explain(seed, lambda some: ask(some) is not False)))
        else:  # Undecided sets are passed over; `exact` remembers that.
            met.append(frozenset(seed))
    given_up = [tuple(g for g in goals if g not in some) for some in met]
    return Conflicts(
        tuple(sorted((_ordered(core, goals) for core in cores), key=len)),
        tuple(sorted(given_up, key=len)),
        exact,
    )


def quick_explain(goals: Sequence[T], may_be_met: Callable[[Sequence[T]], bool]) -> tuple[T, ...]:
    """A minimal subset that can't be met, of goals that can't; earlier goals are kept rather than later.

    Args:
        goals: goals that can't be met together.
        may_be_met: whether some of them can, or may be.
    """

    def explain(base: tuple[T, ...], grown: bool, rest: Sequence[T]) -> tuple[T, ...]:
        if grown and not may_be_met(base):
            return ()
        if len(rest) == 1:
            return tuple(rest)
        left, right = rest[: len(rest) // 2], rest[len(rest) // 2 :]
        of_right = explain((*base, *left), bool(left), right)
        of_left = explain((*base, *of_right), bool(of_right), left)
        return (*of_left, *of_right)

    return explain((), False, goals)


def alike(reasons: Mapping[tuple[T, ...], str]) -> list[tuple[tuple[T, ...], int, str]]:
    """Conflicting sets summed up: where all sets of one size among some goals have one reason, as one.

    Args:
        reasons: the conflicting sets, each with the reason for it.

    Returns:
        Goals, how many of them are too many, and why, in the order of the sets.
    """
    found: list[tuple[tuple[T, ...], int, str]] = []
    left = list(reasons)
    while left:
        first = left[0]
        group = [c for c in left if reasons[c] == reasons[first] and len(c) == len(first)]
        union = tuple(dict.fromkeys(goal for core in group for goal in core))
        whole = {frozenset(some) for some in itertools.combinations(union, len(first))}
        if whole != {frozenset(core) for core in group}:
            group, union = [first], first
        found.append((union, len(first), reasons[first]))
        left = [core for core in left if core not in group]
    return found


def _unexplored(
    goals: Sequence[T], cores: Sequence[frozenset[T]], met: Sequence[frozenset[T]]
) -> tuple[tuple[T, ...] | None, bool]:
    """A largest set of goals not known to be a conflict, nor part of what can be met; None if none is left.

    What is left out has to hit every core, and must not hold all that a met set leaves out. The
    least such sets are all found by branching over the goals of a core that isn't hit yet.

    Returns:
        The set, and whether it is surely a largest one, or surely none is left.
    """
    whole = frozenset(goals)

    def fits(out: frozenset[T]) -> bool:
        return not any(whole - out <= some for some in met)

    best: frozenset[T] | None = None
    waiting: list[frozenset[T]] = [frozenset()]
    seen: set[frozenset[T]] = set()
    while waiting and len(seen) < MOST_STEPS:
        out = waiting.pop()
        if out in seen or (best is not None and len(out) >= len(best)):
            continue
        seen.add(out)
        if not fits(out):
            continue
        core = next((c for c in cores if not c & out), None)
        if core is None:
            best = out
        else:
            # The last goal of a core is the first to be left out: what was said first is kept.
            waiting.extend(out | {goal} for goal in _ordered(core, goals))
    if best is None:
        return None, not waiting
    for goal in goals:
        fewer = best - {goal}
        if waiting and all(core & fewer for core in cores) and fits(fewer):
            best = fewer
    return tuple(g for g in goals if g not in best), not waiting


def _ordered(some: Iterable[T], goals: Sequence[T]) -> tuple[T, ...]:
    wanted = frozenset(some)
    return tuple(g for g in goals if g in wanted)
