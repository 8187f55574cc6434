"""Each edit by example, and each refusal."""

from __future__ import annotations

import pytest

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import (
    AddCheckpoint,
    Connect,
    Disconnect,
    Edit,
    InsertCheckpoint,
    MoveCheckpoint,
    RemoveCheckpoint,
    RenameCheckpoint,
    SetConditional,
    SetGoals,
    apply,
    apply_all,
)
from polaris_nl.automaton.history import LIMIT, History
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import EditError
from polaris_nl.model.formula import Literal

ACKNOWLEDGED = (Literal("acknowledged", ("lunchtime",)),)
DISMISSED = (Literal("dismissed", ("lunchtime",)),)
HOME = (Literal("robot-at", ("home",)),)


def add(number: int, name: str, after: int, when: tuple[Literal, ...] = ()) -> AddCheckpoint:
    checkpoint = Checkpoint(f"c{number}", name)
    return AddCheckpoint(checkpoint, Transition(f"t{number}", f"c{after}", checkpoint.id, when))


@pytest.fixture
def paper() -> Automaton:
    """The shape of the paper's caregiving program."""
    return apply_all(
        Automaton(),
        [
            add(1, "alerted", 0),
            add(2, "fetched", 1, ACKNOWLEDGED),
            add(3, "home", 2),
            add(4, "cancelled", 1, DISMISSED),
        ],
    )


def shape(automaton: Automaton) -> set[tuple[str, str, int]]:
    names = {c.id: c.name for c in automaton.checkpoints.values()}
    return {(names[t.source], names[t.target], len(t.when)) for t in automaton.transitions.values()}


def test_inserting_keeps_the_conditional_in_front(paper: Automaton) -> None:
    changed = apply(paper, InsertCheckpoint(Checkpoint("c5", "filled"), "t2", "t5"))
    assert {("alerted", "filled", 1), ("filled", "fetched", 0)} <= shape(changed)


def test_removing_one_moves_what_follows_up_with_both_conditionals(paper: Automaton) -> None:
    changed = apply(paper, RemoveCheckpoint("c2"))
    assert shape(changed) == {
        ("start", "alerted", 0),
        ("alerted", "home", 1),
        ("alerted", "cancelled", 1),
    }


def test_removing_a_subtree_removes_all_of_it(paper: Automaton) -> None:
    assert shape(apply(paper, RemoveCheckpoint("c2", subtree=True))) == {
        ("start", "alerted", 0),
        ("alerted", "cancelled", 1),
    }


def test_moving_takes_the_subtree_along(paper: Automaton) -> None:
    changed = apply(paper, MoveCheckpoint("c2", "c4", HOME))
    assert {("cancelled", "fetched", 1), ("fetched", "home", 0)} <= shape(changed)


def test_goals_are_replaced_without_duplicates(paper: Automaton) -> None:
    changed = apply(paper, SetGoals("c3", HOME + HOME))
    assert changed.checkpoints["c3"].goals == HOME


def test_an_else_is_an_unconditional_transition_beside_a_labelled_one(paper: Automaton) -> None:
    changed = apply(paper, SetConditional("t4", ()))
    assert changed.is_else("t4")
    assert not changed.is_else("t2")
    assert not changed.is_else("t3")


def test_disconnecting_and_connecting_again(paper: Automaton) -> None:
    loose = apply(paper, Disconnect("t4"))
    assert loose.incoming("c4") is None
    assert apply(loose, Connect(Transition("t4", "c3", "c4"))).parent("c4") == "c3"


def test_names_are_made_unique(paper: Automaton) -> None:
    assert paper.fresh_name("tea") == "tea"
    assert paper.fresh_name("home") == "home 2"


@pytest.mark.parametrize(
    ("edit", "reason"),
    [
        (add(2, "again", 0), "a checkpoint c2 already"),
        (add(5, "home", 0), "is called home already"),
        (add(5, "tea", 9), "no checkpoint c9"),
        (
            AddCheckpoint(Checkpoint("c5", "x"), Transition("t5", "c0", "c1")),
            "has to lead to the new",
        ),
        (
            AddCheckpoint(Checkpoint("c5", "x"), Transition("t1", "c0", "c5")),
            "a transition t1 already",
        ),
        (InsertCheckpoint(Checkpoint("c5", "x"), "t9", "t5"), "no transition t9"),
        (RemoveCheckpoint(START), "start can't be removed"),
        (RenameCheckpoint("c1", "  "), "needs a name"),
        (RenameCheckpoint("c1", "home"), "is called home already"),
        (RenameCheckpoint(START, "x"), "start can't be renamed"),
        (SetGoals(START, HOME), "start can't be given goals"),
        (SetGoals("c1", HOME, Action("move", ("hall", "home"))), "not both"),
        (SetConditional("t9", ()), "no transition t9"),
        (MoveCheckpoint("c1", "c3"), "alerted can't come after home"),
        (Connect(Transition("t9", "c0", "c3")), "leads to home already"),
        (Connect(Transition("t1", "c0", "c3")), "a transition t1 already"),
        (Disconnect("t9"), "no transition t9"),
    ],
)
def test_an_edit_that_does_not_fit_is_refused_by_name(
    paper: Automaton, edit: Edit, reason: str
) -> None:
    with pytest.raises(EditError, match=reason):
        apply(paper, edit)


def test_a_loop_is_refused(paper: Automaton) -> None:
    loose = apply(paper, Disconnect("t1"))
    with pytest.raises(EditError, match="loop"):
        apply(loose, Connect(Transition("t1", "c3", "c1")))


def test_a_failed_step_changes_nothing() -> None:
    history = History().do([add(1, "tea", 0)], "tea")
    with pytest.raises(EditError):
        history.do([add(2, "cake", 1), add(2, "cake", 1)], "cake")
    assert list(history.present.checkpoints) == ["c0", "c1"]


def test_a_new_step_forgets_what_was_undone_and_the_history_is_bounded() -> None:
    history = History().do([add(1, "tea", 0)], "tea")
    undone = history.undo()
    assert undone is not None
    assert undone.do([add(1, "cake", 0)], "cake").redo() is None
    for _ in range(LIMIT + 5):
        history = history.do([], "nothing")
    assert len(history.past) == LIMIT
