"""Beliefs: with time and source, stale is unknown and never false, contradictions are unknown too."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.execution.beliefs import AHEAD_S, Beliefs, Lifetimes, Percept, contradicted
from polaris_nl.model.state import State
from polaris_nl.planning.planner import Planner
from tests.execution.story import literal, literals

TABLE, DESK, HELD = literals("(at tray table)", "(at tray desk)", "(holding tray)")
ACKNOWLEDGED, DISMISSED = literals("(acknowledged lunchtime)", "(dismissed lunchtime)")
SHORT = Lifetimes({"at": 2.0})


def test_what_was_seen_is_known_with_time_and_source(care: Planner) -> None:
    beliefs = Beliefs().after([Percept(TABLE, 5.0, "camera")], care.mutexes, 5.0)
    seen = beliefs.observation(5.5, SHORT)
    assert seen.holds(TABLE)
    assert (seen.seen[TABLE].at, seen.seen[TABLE].source) == (5.0, "camera")


def test_what_is_stale_is_unknown_and_neither_true_nor_false(care: Planner) -> None:
    beliefs = Beliefs().after([Percept(TABLE, 5.0, "camera")], care.mutexes, 5.0)
    late = beliefs.observation(7.5, SHORT)
    assert not late.holds(TABLE)
    assert not late.holds(TABLE.negation)
    assert TABLE in late.state.facts  # What was believed last is still there to plan from.
    again = beliefs.after([Percept(TABLE, 7.4, "camera")], care.mutexes, 7.5)
    assert again.observation(7.5, SHORT).holds(TABLE)


def test_what_is_seen_elsewhere_later_is_no_longer_where_it_was(care: Planner) -> None:
    beliefs = Beliefs.assumed(State(frozenset({TABLE})), 0.0)
    moved = beliefs.after([Percept(DESK, 3.0, "camera")], care.mutexes, 3.0)
    seen = moved.observation(3.0, Lifetimes())
    assert seen.holds(DESK)
    assert seen.holds(TABLE.negation)
    assert beliefs.observation(3.0, Lifetimes()).seen[TABLE].source == "assumed"


def test_what_contradicts_itself_is_unknown_until_it_is_seen_anew(care: Planner) -> None:
    both = [Percept(ACKNOWLEDGED, 3.0, "speech"), Percept(DISMISSED, 3.0, "speech")]
    beliefs = Beliefs().after(both, care.mutexes, 3.0)
    seen = beliefs.observation(3.0, Lifetimes())
    for fact in (ACKNOWLEDGED, DISMISSED):
        assert not seen.knows(fact)
    after = beliefs.after([Percept(DISMISSED, 4.0, "speech")], care.mutexes, 4.0)
    assert after.observation(4.0, Lifetimes()).holds(DISMISSED)
    assert after.observation(4.0, Lifetimes()).holds(ACKNOWLEDGED.negation)


def test_old_news_and_news_from_the_future_change_nothing(care: Planner) -> None:
    beliefs = Beliefs().after([Percept(TABLE, 5.0, "camera")], care.mutexes, 5.0)
    old = beliefs.after([Percept(TABLE.negation, 4.0, "camera")], care.mutexes, 6.0)
    assert old.observation(6.0, Lifetimes()).holds(TABLE)
    ahead = Percept(TABLE.negation, 6.0 + AHEAD_S + 0.1, "camera")
    assert beliefs.after([ahead], care.mutexes, 6.0).observation(6.0, Lifetimes()).holds(TABLE)


def test_the_members_of_a_contradiction_are_found(care: Planner) -> None:
    assert contradicted(care.world.initial, care.mutexes) == frozenset()
    state = care.world.initial.change((), literals("(holding tray)"))
    assert contradicted(state, care.mutexes) >= {literal("(holding tray)"), literal("(hand-empty)")}


PERCEPTS = st.lists(
    st.builds(
        Percept,
        st.sampled_from([TABLE, TABLE.negation, DESK, HELD, DESK.negation]),
        st.integers(0, 6).map(float),
        st.just("camera"),
    ),
    max_size=6,
)


@given(PERCEPTS, st.randoms(use_true_random=False))
def test_nothing_is_believed_against_the_rules_whatever_is_seen(
    care: Planner, percepts: list[Percept], random: object
) -> None:
    beliefs = Beliefs().after(percepts, care.mutexes, 6.0)
    seen = beliefs.observation(6.0, SHORT)
    assert contradicted(State(seen.certain), care.mutexes) == frozenset()
    for atom in (TABLE, DESK, HELD):
        last = max((p.at for p in percepts if p.literal.atom == atom), default=None)
        if last is None or 6.0 - last > 2.0:
            assert atom.predicate != "at" or not seen.holds(atom)
        assert not (seen.holds(atom) and seen.holds(atom.negation))
