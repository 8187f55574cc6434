"""ISL: what is read, what is refused by name and line, and that a program comes back as it was."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.program import parse_action
from polaris_nl.interchange.isl_export import export_isl
from polaris_nl.interchange.isl_import import automaton_of, faults, notes
from polaris_nl.interchange.isl_syntax import parse_isl
from polaris_nl.interchange.properties import properties
from polaris_nl.model.errors import FormatError
from polaris_nl.model.formula import Literal, parse_formula, parse_literal
from polaris_nl.model.pddl import parse_domain
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world
from tests.automaton.strategies import GOALS, automata

TRAY = """import pddl.caregiving   # lunch
labels
    told: [predicate: alerted-to, params: [resident, lunchtime]],
    served: [predicate: at, params: [tray, table] & predicate: is-full, params: [tray]],
    back_home: [action: move, params: [hall, home]],
    waited: [],
    answered: [predicate: acknowledged, params: [lunchtime] & not predicate: open, params: [fridge]]
endlabels
module
    st: [0: init, 1: told, 2: served, 3: back_home, 4: waited, 7: served];
    guard: [0: answered];
    [] 0 -> 1;
    [] 1 & guard=0 -> 2;
    [] 1 & guard=default -> 3;
    [] 3 & guard=SUCCESS -> 4;
    [] 3 & guard=FAILURE -> 7;
endmodule
options
    conditional_effects;
    maintenance_goals;
endoptions
"""


@pytest.fixture(scope="module")
def care_home() -> World:
    return load_world("care-home")


def test_labels_guards_outcomes_and_actions_are_read(care_home: World) -> None:
    isl = parse_isl(TRAY)
    automaton = automaton_of(isl)
    assert list(faults(isl, care_home)) == []
    assert [(c.id, c.name) for c in automaton.checkpoints.values()] == [
        ("c0", "start"), ("c1", "told"), ("c2", "served"), ("c3", "back home"), ("c4", "waited"),
        ("c7", "served 2"),
    ]  # fmt: skip
    assert automaton.checkpoints["c3"].action == parse_action("(move hall home)")
    assert automaton.checkpoints["c4"].goals == ()
    assert list(map(str, automaton.checkpoints["c7"].goals)) == [
        "(at tray table)",
        "(is-full tray)",
    ]
    found = {
        (t.source, t.target): (tuple(map(str, t.when)), t.on)
        for t in automaton.transitions.values()
    }
    assert found == {
        ("c0", "c1"): ((), None),
        ("c1", "c2"): (("(acknowledged lunchtime)", "(not (open fridge))"), None),
        ("c1", "c3"): ((), None),
        ("c3", "c4"): ((), "success"),
        ("c3", "c7"): ((), "failure"),
    }
    assert automaton.is_else("t3")
    assert all(found.holds for found in properties(automaton))
    assert notes(isl) == (
        "The option maintenance_goals is left out: goals that are to hold all the time can't be "
        "asked for yet.",
    )


@pytest.mark.parametrize(
    ("before", "after", "line", "reason"),
    [
        ("import pddl.caregiving", "import caregiving", 1, "such as pddl.general, not caregiving"),
        ("import pddl.caregiving", "labels", 1, "At the beginning, import was expected"),
        ("told: [", "init: [", 3, "No label can be called init"),
        ("waited: []", "told: []", 6, "another label told on line 3"),
        ("params: [hall, home]]", "params: [hall, home] & action: move, params: [home, hall]]", 5,
         "two actions"),
        ("params: [hall, home]]", "params: [hall, home] & predicate: open, params: [fridge]]", 5,
         "predicates and an action"),
        ("[action: move", "[not action: move", 5, "an action is negated"),
        ("0: init", "0: told", 9, "No state is called init"),
        ("1: told", "1: init", 9, "2 states are called init"),
        ("2: served", "2: eaten", 10, "no label eaten"),
        ("2: served", "1: served", 10, "two states 1"),
        ("[] 0 -> 1", "[] 0 -> 5", 12, "no state 5; there are: 0, 1, 2, 3, 4, 7"),
        ("guard=0 ", "guard=4 ", 13, "no guard 4"),
        ("[] 0 -> 1;", "[] 0 -> 1", 13, "; was expected"),
        ("maintenance_goals", "maintenance_goal", 20, "Did you mean maintenance_goals?"),
        ("endoptions", "", 22, "end of the file"),
        ("endmodule", "endmodul", 17, "'endmodul' found"),
        ("endoptions", "endoptions more", 21, "Nothing comes after"),
        ("params: [resident, lunchtime]", "params: [resident lunchtime]", 3, "was expected"),
        ("[] 0 -> 1", "[] x -> 1", 12, "The number of a state was expected, but 'x'"),
    ],
)  # fmt: skip
def test_what_is_no_isl_is_named_with_its_line(
    before: str, after: str, line: int, reason: str
) -> None:
    assert before in TRAY
    text = TRAY.replace(before, after, 1)
    with pytest.raises(FormatError) as error:
        parse_isl(text)
    assert reason in error.value.reason
    assert error.value.line == line


@pytest.mark.parametrize(
    ("before", "after", "line", "reason"),
    [
        ("alerted-to", "alertedto", 3, "no predicate alertedto. Did you mean alerted-to?"),
        ("params: [tray, table]", "params: [tra, table]", 4, "nothing called tra."),
        ("params: [tray, table]", "params: [table, table]", 4, "table is a surface"),
        ("action: move", "action: walk", 5, "no operator walk"),
        ("guard: [0: answered]", "guard: [0: back_home]", 5, "The guard back_home is an action"),
        ("pddl.caregiving", "pddl.tidying", 1, "for the domain tidying"),
    ],
)
def test_what_does_not_fit_the_world_is_named_with_its_line(
    care_home: World, before: str, after: str, line: int, reason: str
) -> None:
    assert before in TRAY
    found = list(faults(parse_isl(TRAY.replace(before, after, 1)), care_home))
    assert [f.line for f in found] == [line]
    assert reason in found[0].reason


def test_shapes_that_are_not_programs_are_read_and_named() -> None:
    text = """import pddl.caregiving
labels a: [], b: [predicate: open, params: [fridge] & not predicate: open, params: [fridge]] endlabels
module
    st: [3: init, 0: a, 1: b, 2: a];
    [] 3 -> 0; [] 3 -> 1; [] 0 -> 0; [] 1 -> 3;
endmodule"""
    automaton = automaton_of(parse_isl(text))
    assert [c.id for c in automaton.checkpoints.values()] == [START, "c4", "c1", "c2"]
    against = {found.name: found.against for found in properties(automaton)}
    assert against == {
        "loop_free": (
            '"start" and "b" come after one another in a loop.',
            '"a" comes after itself.',
        ),
        "deterministic": ('From "start", "a" and "b" come next under the same condition.',),
        "executable": ('Nothing leads from the start to "a 2".',),
        "satisfiable": ('"b" asks for (open fridge) and for its opposite.',),
    }
    alone = automaton_of(
        parse_isl("import pddl.x labels endlabels module st: [0: init]; endmodule")
    )
    assert [found.name for found in properties(alone) if not found.holds] == ["executable"]


# Export


def test_a_program_reads_well_in_isl(care_home: World) -> None:
    automaton = automaton_of(parse_isl(TRAY))
    assert (
        export_isl(automaton, care_home.domain).text
        == """import pddl.caregiving
labels
    told: [predicate: alerted-to, params: [resident, lunchtime]],
    served: [predicate: at, params: [tray, table] & predicate: is-full, params: [tray]],
    back_home: [action: move, params: [hall, home]],
    waited: [],
    served_2: [predicate: at, params: [tray, table] & predicate: is-full, params: [tray]],
    if_served: [predicate: acknowledged, params: [lunchtime] & not predicate: open, params: [fridge]]
endlabels
module
    st: [0: init, 1: told, 2: served, 3: back_home, 4: waited, 7: served_2];
    guard: [0: if_served];
    [] 0 -> 1;
    [] 1 & guard=0 -> 2;
    [] 1 & guard=default -> 3;
    [] 3 & guard=SUCCESS -> 4;
    [] 3 & guard=FAILURE -> 7;
endmodule
"""
    )


def test_what_isl_cannot_say_is_named_and_nothing_is_written(care_home: World) -> None:
    dishes = parse_formula("(forall (?d - object) (imply (kind ?d dish) (at ?d countertop)))")
    automaton = (
        Automaton()
        .with_checkpoint(Checkpoint("c1", "all", (dishes,)))
        .with_checkpoint(Checkpoint("c2", "odd", (Literal("at", ("cup-", "table")),)))
        .with_transition(
            Transition("t1", START, "c1", (parse_literal("(open fridge)"),), "success")
        )
        .with_transition(Transition("t2", "c1", "c2"))
    )
    export = export_isl(automaton, care_home.domain)
    assert export.text == ""
    assert [m.split(",")[0] for m in export.missing] == [
        'In "all"',
        'In "odd"',
        "In the transition t1",
    ]
    assert "(forall (?d - object)" in export.missing[0]
    assert "the name cup-" in export.missing[1]
    assert "(open fridge) and for success" in export.missing[2]


def test_names_that_read_otherwise_are_named(care_home: World) -> None:
    automaton = Automaton()
    for number, name in enumerate(["Ann's cup", "a_b", "a b", "init", "-", "endlabels"], 1):
        automaton = automaton.with_checkpoint(Checkpoint(f"c{number}", name))
        automaton = automaton.with_transition(
            Transition(f"t{number}", f"c{number - 1}", f"c{number}")
        )
    export = export_isl(automaton, care_home.domain)
    back = automaton_of(parse_isl(export.text))
    names = [c.name for c in back.checkpoints.values()]
    assert names == ["start", "Ann s cup", "a b", "a b 2", "init 2", "checkpoint", "endlabels 2"]
    assert len(export.notes) == 6
    assert 'The name "a b" reads "a b 2" in ISL.' in export.notes


def test_conditional_effects_are_declared() -> None:
    domain = parse_domain(
        "(define (domain d) (:predicates (p) (q)) (:action a :parameters () :effect (when (p) (q))))"
    )
    assert "options\n    conditional_effects;\nendoptions" in export_isl(Automaton(), domain).text


# There and back

NAMES = st.text("abz 2", min_size=1, max_size=4).map(str.strip).filter(bool)


@st.composite
def programs(draw: st.DrawFn) -> Automaton:
    """A program with outcomes, actions and all kinds of names, and sometimes a shape that is none."""
    automaton = draw(automata())
    for checkpoint in list(automaton.checkpoints.values())[1:]:
        name = automaton.fresh_name(draw(NAMES))
        action = draw(st.sampled_from([None, None, parse_action("(open-container cupboard)")]))
        goals = () if action else checkpoint.goals
        automaton = automaton.with_checkpoint(Checkpoint(checkpoint.id, name, goals, action))
    for transition in automaton.transitions.values():
        if not transition.when:
            on = draw(st.sampled_from([None, "success", "failure"]))
            automaton = automaton.with_transition(dataclasses.replace(transition, on=on))
    ends = st.sampled_from(list(automaton.checkpoints))
    if draw(st.booleans()):
        extra = Transition(automaton.fresh_transition_id(), draw(ends), draw(ends), draw(GOALS))
        automaton = automaton.with_transition(extra)
    return automaton


@given(programs())
def test_a_program_comes_back_as_it_was(automaton: Automaton) -> None:
    domain = load_world("care-home").domain
    export = export_isl(automaton, domain)
    assert export.missing == ()
    back = automaton_of(parse_isl(export.text))
    renamed = {f'The name "{a}" reads "{b}" in ISL.' for a, b in changed(automaton, back)}
    assert renamed == set(export.notes)
    assert without_names(back) == without_names(automaton)
    # What has come back once comes back again, names and all.
    again = export_isl(back, domain)
    assert again.notes == ()
    assert automaton_of(parse_isl(again.text)) == back
    assert again.text == export_isl(automaton_of(parse_isl(again.text)), domain).text


def changed(one: Automaton, other: Automaton) -> Iterator[tuple[str, str]]:
    for a, b in zip(one.checkpoints.values(), other.checkpoints.values(), strict=True):
        if a.name != b.name:
            yield a.name, b.name


def without_names(automaton: Automaton) -> object:
    checkpoints = [(c.id, c.goals, c.action) for c in automaton.checkpoints.values()]
    transitions = [(t.source, t.target, t.when, t.on) for t in automaton.transitions.values()]
    return checkpoints, transitions
