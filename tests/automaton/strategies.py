"""Random automata and edits."""

from __future__ import annotations

from hypothesis import strategies as st

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import (
    AddCheckpoint,
    Edit,
    InsertCheckpoint,
    MoveCheckpoint,
    RemoveCheckpoint,
    RenameCheckpoint,
    SetConditional,
    SetGoals,
    apply,
)
from polaris_nl.model.errors import EditError
from polaris_nl.model.formula import Literal

LITERALS = st.sampled_from(
    [
        Literal("at", ("tray", "table")),
        Literal("is-full", ("tray",)),
        Literal("open", ("cupboard",), False),
        Literal("acknowledged", ("lunchtime",)),
        Literal("robot-at", ("home",)),
    ]
)
GOALS = st.lists(LITERALS, max_size=3).map(lambda goals: tuple(dict.fromkeys(goals)))


@st.composite
def edits(draw: st.DrawFn, automaton: Automaton) -> Edit:
    """An edit that mostly fits an automaton."""
    checkpoints = st.sampled_from(sorted(automaton.checkpoints))
    new = Checkpoint(
        automaton.fresh_checkpoint_id(),
        automaton.fresh_name(draw(st.sampled_from(["a", "b"]))),
        draw(GOALS),
    )
    arrow = automaton.fresh_transition_id()
    choices: list[st.SearchStrategy[Edit]] = [
        st.builds(
            lambda c, w: AddCheckpoint(new, Transition(arrow, c, new.id, w)), checkpoints, GOALS
        ),
        st.builds(RemoveCheckpoint, checkpoints, st.booleans()),
        st.builds(RenameCheckpoint, checkpoints, st.sampled_from(["a", "z", " "])),
        st.builds(SetGoals, checkpoints, GOALS),
        st.builds(MoveCheckpoint, checkpoints, checkpoints, GOALS),
    ]
    if automaton.transitions:
        arrows = st.sampled_from(sorted(automaton.transitions))
        choices.append(st.builds(lambda t, w: InsertCheckpoint(new, t, arrow, w), arrows, GOALS))
        choices.append(st.builds(SetConditional, arrows, GOALS))
    return draw(st.one_of(choices))


@st.composite
def automata(draw: st.DrawFn) -> Automaton:
    """An automaton made by up to ten edits."""
    automaton = Automaton()
    for _ in range(draw(st.integers(0, 10))):
        try:
            automaton = apply(automaton, draw(edits(automaton)))
        except EditError:
            continue
    assert START in automaton.checkpoints
    return automaton
