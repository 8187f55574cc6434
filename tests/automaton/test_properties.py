"""What holds for every automaton and every edit."""

from __future__ import annotations

import networkx as nx
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edit_json import edit_json, edit_of
from polaris_nl.automaton.edits import ReplaceProgram, apply
from polaris_nl.automaton.history import History
from polaris_nl.automaton.program import Program, program_json, program_of
from polaris_nl.model.errors import EditError

from .strategies import automata, edits


@given(automata())
def test_edits_keep_a_tree_rooted_in_the_start(automaton: Automaton) -> None:
    assert nx.is_arborescence(automaton.graph)
    assert set(automaton.subtree(START)) == set(automaton.checkpoints)
    names = [c.name for c in automaton.checkpoints.values()]
    assert len(names) == len(set(names))
    assert automaton.checkpoints[START].goals == ()


@given(automata())
def test_paths_lead_from_the_start_to_their_checkpoint(automaton: Automaton) -> None:
    for checkpoint in automaton.checkpoints:
        path = automaton.path(checkpoint)
        ends = [START, *(t.target for t in path)]
        assert [t.source for t in path] == ends[:-1]
        assert ends[-1] == checkpoint
    leaves = {c for c in automaton.checkpoints if not automaton.outgoing(c)}
    assert set(automaton.leaves()) == leaves


@given(automata())
def test_programs_are_read_back_from_their_json(automaton: Automaton) -> None:
    program = Program(automaton, "caregiving", "care-home")
    assert program_of(program_json(program)) == program


@given(st.data())
def test_edits_are_read_back_from_their_json(data: st.DataObject) -> None:
    edit = data.draw(edits(data.draw(automata())))
    assert edit_of(edit_json(edit)) == edit


@given(automata())
def test_replacing_programs_is_read_back_from_its_json(automaton: Automaton) -> None:
    assert edit_of(edit_json(ReplaceProgram(automaton))) == ReplaceProgram(automaton)


@given(st.data())
def test_an_edit_leaves_the_old_automaton_as_it_was(data: st.DataObject) -> None:
    automaton = data.draw(automata())
    before = program_json(Program(automaton, "", ""))
    failure = ""
    try:
        apply(automaton, data.draw(edits(automaton)))
    except EditError as error:
        failure = f"{error}." if str(error) else ""
    assert "\n" not in failure
    assert program_json(Program(automaton, "", "")) == before


@given(st.data())
def test_undo_and_redo_walk_the_same_way_back_and_forth(data: st.DataObject) -> None:
    history = History()
    seen = [history.present]
    for _ in range(data.draw(st.integers(0, 8))):
        try:
            history = history.do([data.draw(edits(history.present))], "step")
        except EditError:
            continue
        seen.append(history.present)
    for wanted in reversed(seen[:-1]):
        undone = history.undo()
        assert undone is not None
        history = undone
        assert history.present == wanted
    assert history.undo() is None
    for wanted in seen[1:]:
        redone = history.redo()
        assert redone is not None
        history = redone
        assert history.present == wanted
    assert history.redo() is None
