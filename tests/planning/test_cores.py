"""Minimal conflicting sets and correction sets, against trying out every subset."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.planning.cores import alike, conflicts, quick_explain

Bad = list[frozenset[int]]
BAD = st.lists(st.frozensets(st.integers(0, 6), min_size=1, max_size=4), min_size=1, max_size=5)


def minimal(sets: Bad) -> set[frozenset[int]]:
    return {s for s in sets if not any(other < s for other in sets)}


def subsets(goals: Sequence[int]) -> Bad:
    sizes = range(len(goals) + 1)
    return [frozenset(some) for k in sizes for some in itertools.combinations(goals, k)]


@given(BAD)
def test_all_minimal_sets_are_found_and_nothing_else(bad: Bad) -> None:
    goals = range(7)

    def meets(some: Sequence[int]) -> bool:
        return not any(b <= set(some) for b in bad)

    found = conflicts(goals, meets)
    assert found.complete
    assert {frozenset(core) for core in found.cores} == minimal(bad)
    assert len(set(found.cores)) == len(found.cores)
    assert [len(core) for core in found.cores] == sorted(map(len, found.cores))
    left_out = [frozenset(goals) - some for some in subsets(goals) if meets(sorted(some))]
    assert {frozenset(c) for c in found.corrections} == minimal(left_out)
    known = conflicts(goals, meets, [sorted(core) for core in minimal(bad)])
    assert set(map(frozenset, known.cores)) == minimal(bad)


@given(BAD)
def test_one_minimal_set_is_found(bad: Bad) -> None:
    def may_be_met(some: Sequence[int]) -> bool:
        return not any(b <= set(some) for b in bad)

    core = quick_explain(range(7), may_be_met)
    assert frozenset(core) in minimal(bad)


@given(BAD, st.sets(st.integers(0, 127)))
def test_what_is_undecided_is_never_called_a_conflict(bad: Bad, unsure: set[int]) -> None:
    def meets(some: Sequence[int]) -> bool | None:
        if sum(1 << x for x in some) in unsure:
            return None
        return not any(b <= set(some) for b in bad)

    found = conflicts(range(7), meets)
    for core in found.cores:
        assert any(b <= set(core) for b in bad)
    if found.complete:
        assert {frozenset(core) for core in found.cores} == minimal(bad)


def test_a_search_ends_when_its_time_is_over() -> None:
    asked: list[Sequence[int]] = []

    def meets(some: Sequence[int]) -> bool:
        asked.append(some)
        return len(some) < 3

    found = conflicts(range(8), meets, over=lambda: len(asked) >= 10)
    assert not found.complete
    assert len(asked) == 10


def test_enough_is_enough() -> None:
    found = conflicts(range(12), lambda some: len(some) < 3, enough=1)
    assert (len(found.cores), len(found.cores[0]), found.complete) == (1, 3, False)


def test_very_many_known_conflicts_take_no_long_time() -> None:
    goals = range(20)
    pairs = list(itertools.combinations(goals, 2))
    asked: list[Sequence[int]] = []

    def meets(some: Sequence[int]) -> bool:
        asked.append(some)
        return len(some) < 2

    found = conflicts(goals, meets, pairs, over=lambda: len(asked) >= 5)
    assert (len(found.cores), found.complete) == (len(pairs), False)
    assert len(found.corrections) == 5
    assert all(len(out) == 19 for out in found.corrections)


def test_sets_that_are_alike_are_summed_up() -> None:
    pairs = {(1, 2): "hand", (1, 3): "hand", (2, 3): "hand", (4, 5): "place", (4, 6): "place"}
    assert alike(pairs) == [((1, 2, 3), 2, "hand"), ((4, 5), 2, "place"), ((4, 6), 2, "place")]
