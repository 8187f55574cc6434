"""What is there already is put in order rather than asked for twice, and another way stands beside."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bench.speech_meaning import Context
from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, apply_all
from polaris_nl.language.reordering import put_in_order, there_already
from polaris_nl.model.formula import Literal

from .test_requests import understanding

TELL, FILL, HOME = "(alerted-to resident lunchtime)", "(is-full tray)", "(robot-at home)"
TOLD = ("tell her lunch is ready", "fill the tray")
TOLD_THEN_HOME = (*TOLD, "then go home")
WATER = ("put the water in the cupboard",)
CHOICE = ("if the fridge is open close it, otherwise go home",)


def after(said: str, before: tuple[str, ...]) -> str:
    return Context(understanding("care-home"), before).understood(said)[1]


@pytest.mark.parametrize(
    "said",
    [
        "fill the tray first and tell her afterwards",
        "fill the tray before you tell her",
        "tell her after you fill the tray",
        "fill the tray and only then tell her lunch is ready",
        "before you tell her fill the tray",
        "first fill the tray",
        "at the start fill the tray",
        "but first fill the tray",
        "do them the other way round",
        "do those in the opposite order",
        "swap steps one and two",
    ],
)
def test_two_steps_change_places(said: str) -> None:
    assert after(said, TOLD) == f"start [{FILL} [{TELL}]]"


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        (TOLD, "first tell her lunch is ready then fill the tray", f"start [{TELL} [{FILL}]]"),
        (TOLD_THEN_HOME, "before that fill the tray", f"start [{TELL} [{FILL} [{HOME}]]]"),
        (("go home",), "but first go home", f"start [{HOME}]"),
        (TOLD, "tell her again after you fill the tray", f"start [{TELL} [{FILL} [{TELL}]]]"),
        (TOLD_THEN_HOME, "swap the first two steps", f"start [{FILL} [{TELL} [{HOME}]]]"),
        (TOLD_THEN_HOME, "do them in reverse order", "refused"),
        (
            (
                "fill the tray",
                "then tell her lunch is ready",
                "then go home",
                "if she dismisses it go to the office instead",
            ),
            "swap the first two",
            f"start [{TELL} [{FILL} [{HOME}] [when (dismissed lunchtime): (robot-at office)]]]",
        ),
        (
            ("tell her lunch is ready", "then open the fridge", "then fill the tray"),
            "tell her after filling the tray",
            f"start [(open fridge) [{FILL} [{TELL}]]]",
        ),
        (
            (*TOLD, "once she acknowledges it bring it to her"),
            "fill the tray before you tell her",
            f"start [{FILL} [{TELL} [when (acknowledged lunchtime): (has resident tray)]]]",
        ),
    ],
)
def test_only_what_is_in_a_row_changes_places(
    before: tuple[str, ...], said: str, program: str
) -> None:
    assert after(said, before) == program


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        (WATER, "the water would be better in the fridge", "start [(in water-bottle fridge)]"),
        (WATER, "it would be better if the cupboard was open",
         "start [(in water-bottle cupboard) [(open cupboard)]]"),
        (WATER, "if the fridge is open put it in the fridge instead",
         "start [(in water-bottle cupboard)] [when (open fridge): (in water-bottle fridge)]"),
        (TOLD_THEN_HOME, "and if she dismisses it go to the office instead",
         f"start [{TELL} [{FILL} [{HOME}] [when (dismissed lunchtime): (robot-at office)]]]"),
        (CHOICE, "otherwise go to the kitchen instead",
         "start [(robot-at kitchen)] [when (open fridge): (not (open fridge))]"),
        (CHOICE, "otherwise go to the kitchen", "refused"),
        (CHOICE, "remove the otherwise", "start [when (open fridge): (not (open fridge))]"),
        (CHOICE, "remove what happens otherwise",
         "start [when (open fridge): (not (open fridge))]"),
    ],
)  # fmt: skip
def test_what_is_asked_for_instead(before: tuple[str, ...], said: str, program: str) -> None:
    assert after(said, before) == program


def row(size: int, conditions: tuple[bool, ...]) -> Automaton:
    """A program of steps one after the other, some of which are waited for."""
    edits = []
    for at in range(size):
        when = (Literal("open", ("fridge",)),) if conditions[at] else ()
        checkpoint = Checkpoint(f"s{at}", f"step {at}", (Literal("at", (f"x{at}", "table")),))
        source = f"s{at - 1}" if at else START
        edits.append(AddCheckpoint(checkpoint, Transition(f"t{at}", source, f"s{at}", when)))
    return apply_all(Automaton(), edits)


@settings(derandomize=True, deadline=None, database=None)
@given(st.data())
def test_an_order_is_kept_and_nothing_is_lost(data: st.DataObject) -> None:
    size = data.draw(st.integers(2, 6))
    conditions = tuple(data.draw(st.lists(st.booleans(), min_size=size, max_size=size)))
    chosen = data.draw(st.permutations(range(size)))[: data.draw(st.integers(2, size))]
    program = row(size, conditions)
    wanted = [program.checkpoints[f"s{at}"].goals for at in chosen]
    order = there_already(program, wanted)
    waits = any(conditions[min(chosen) + 1 : max(chosen) + 1])
    assert (order is None) == waits
    if order is None:
        return
    changed = apply_all(program, put_in_order(program, order))
    depths = [len(changed.path(c)) for c in order]
    assert depths == sorted(depths)
    assert changed.checkpoints == program.checkpoints
    assert [len(changed.outgoing(c)) for c in changed.checkpoints].count(1) == size
    kept = [t.when for t in changed.transitions.values() if t.when]
    assert len(kept) == sum(conditions)
