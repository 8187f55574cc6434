"""`polaris-nl check` of grammar files: every fault by its line, and wordings that get in each other's way."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from polaris_nl.cli import main
from polaris_nl.language.common import read_common
from polaris_nl.language.grammar import load_grammar, read_grammar, read_shared
from polaris_nl.language.grammar_check import Findings, check_domain, check_grammar_file
from polaris_nl.model.data import data_folder, shipped_domains
from polaris_nl.model.errors import GrammarError
from polaris_nl.model.pddl import read_domain

SHIPPED = data_folder("grammars") / "en"
DOMAIN = """
(define (domain shop)
  (:types item shelf robot person)
  (:predicates (on ?i - item ?s - shelf) (under ?i - item ?s - shelf) (held ?r - robot ?i - item)
               (greeted ?p - person) (dusty ?i - item))
  (:action lay :parameters (?i - item ?s - shelf) :precondition (and) :effect (on ?i ?s)))
"""


def grammar_file(folder: Path, text: str) -> Path:
    """A grammar beside a domain of its own; the text starts in line 2."""
    (folder / "domain.pddl").write_text(DOMAIN, encoding="utf-8")
    path = folder / "grammar.yaml"
    path.write_text(f"schema: polaris-grammar/1\n{text}", encoding="utf-8")
    return path


def language_folder(folder: Path) -> Path:
    """A copy of the shipped grammars."""
    return Path(shutil.copytree(SHIPPED, folder / "en"))


def errors_of(found: Findings) -> list[tuple[int | None, str]]:
    return [(e.line, e.reason) for e in found.errors]


@pytest.mark.parametrize(
    ("text", "line", "parts"),
    [
        ("predicate: {}\n", 2, ["no field 'predicate'", "Did you mean predicates?"]),
        ("predicates:\n  onn: {fact: x}\n", 3, ["shop has no predicate onn", "Did you mean on?"]),
        ("predicates:\n  on:\n    goal-s: []\n", 4, ["on has no field 'goal-s'", "goals"]),
        ("predicates:\n  on:\n    goals: [lay it]\n    states: {a: b}\n", 5, ["states is a list"]),
        ("predicates:\n  on:\n    goals:\n      - lay {i} on\n      - [x]\n", 6, ["is a text"]),
        (
            "predicates:\n  on:\n    goals:\n      - put {i} <ontto> {s}\n",
            5,
            ["There is no list <ontto>", "Did you mean onto"],
        ),
        ("predicates:\n  on:\n    goals:\n      - (put|lay {i}\n", 5, ["A ( is never closed"]),
        (
            "predicates:\n  on:\n    goals:\n      - '[put|lay) {i}'\n",
            5,
            ["closed by )", "write ]"],
        ),
        (
            "predicates:\n  on:\n    goals:\n      - put {i}] on\n",
            5,
            ["one closing bracket too many"],
        ),
        ("predicates:\n  on:\n    goals:\n      - put|lay {i}\n", 5, ["stands in no brackets"]),
        ("predicates:\n  on:\n    goals:\n      - put {i on {s}\n", 5, ["The {", "never closed"]),
        (
            "predicates:\n  on:\n    goals:\n      - put {o} on {s}\n",
            5,
            ["The predicate on has no parameter ?o", "Known here: i, s."],
        ),
        (
            "predicates:\n  on:\n    states:\n      - '{p:persn} puts {i} on {s}'\n",
            5,
            ["There is no type persn", "Did you mean person?"],
        ),
        ("predicates:\n  on:\n    fact: '{x} is on {s}'\n", 4, ["no parameter ?x"]),
        ("predicates:\n  on:\n    fact: '{i:sad} is on'\n", 4, ["{i}, {i:said} or {i:agent}"]),
        ("operators:\n  lay: lay {o}\n", 3, ["The operator lay has no parameter ?o"]),
        ("operators:\n  lie: lie down\n", 3, ["shop has no operator lie", "Known here: lay."]),
        ("uses: [houshold]\n", 2, ["no grammar houshold", "Did you mean household?"]),
        ("names:\n  - {when: onn, name: laid}\n", 3, ["no predicate onn"]),
        ("lists:\n  a: <b>\n  b: <a>\n", 3, ["contains itself"]),
        ("lists:\n  a: (x|y\n", 3, ["A ( is never closed"]),
        (
            "predicates:\n  on:\n    asks: [on, yes]\n",
            4,
            ["asks has a yes, no, on or off without quotes"],
        ),
        ("predicates: [\n", 3, ["This is no YAML"]),
    ],
)
def test_errors_name_the_line_and_a_way_out(
    tmp_path: Path, text: str, line: int, parts: list[str]
) -> None:
    path = grammar_file(tmp_path, text)
    found = check_grammar_file(path)
    error = found.errors[0]
    assert (error.path, error.line) == (path, line), error
    for part in parts:
        assert part in error.reason
    with pytest.raises(GrammarError) as raised:
        load_grammar(read_domain(tmp_path / "domain.pddl"))
    assert str(raised.value) == str(error)


def test_all_errors_of_a_file_are_found(tmp_path: Path) -> None:
    text = """predicates:
  on:
    goals:
      - put {o} on {s}
      - (put {i}
      - lay {i} on {s}
    asks: <nowhere>
  onto: {fact: x}
"""
    found = check_grammar_file(grammar_file(tmp_path, text))
    assert [line for line, _ in errors_of(found)] == [5, 6, 8, 9]


@pytest.mark.parametrize(
    ("schema", "part"),
    [
        ("", "The first field of a grammar is schema"),
        ("schema: polaris-grammar/9\n", "newer than polaris-grammar/1"),
        ("schema: polaris-intent/1\n", "no grammar file"),
    ],
)
def test_the_schema_is_checked(tmp_path: Path, schema: str, part: str) -> None:
    path = grammar_file(tmp_path, "")
    path.write_text(f"{schema}predicates: {{}}\n", encoding="utf-8")
    assert part in check_grammar_file(path).errors[0].reason


@pytest.mark.parametrize(
    ("text", "line", "parts"),
    [
        (
            "predicates:\n  on:\n    goals:\n      - (put|lay) {i} [back] on {s}\n      - put {i} on {s}\n",
            6,
            ["'put {i} on {s}' is never reached", "grammar.yaml, line 5 (on)"],
        ),
        (
            "predicates:\n  on:\n    goals:\n      - put {i} on {s}\n      - put {i} on {s}\n",
            6,
            ["is never reached", "line 5"],
        ),
        (
            "predicates:\n  on:\n    goals:\n      - lay {i} on {s}\n    asks:\n      - lay {i} on {s}\n",
            7,
            ["is never reached", "line 5"],
        ),
        (
            "predicates:\n  on:\n    states:\n      - '{i} <be> at {s}'\n"
            "  under:\n    states:\n      - '{i} is (at|below) {s}'\n",
            8,
            ['"{i} is at {s}" means under here and on in grammar.yaml, line 5'],
        ),
        (
            "predicates:\n  on:\n    states: ['{i} is at {s}']\n    not-states: ['{i} is at {s}']\n",
            5,
            ["means not on here and on in"],
        ),
        (
            "predicates:\n  on:\n    adjectives: [shelved]\n  dusty:\n    adjectives: [shelved]\n",
            5,
            ['"shelved" means dusty here and on elsewhere'],
        ),
    ],
)
def test_warnings_name_the_line_and_the_other_wording(
    tmp_path: Path, text: str, line: int, parts: list[str]
) -> None:
    found = check_grammar_file(grammar_file(tmp_path, text))
    assert not found.errors
    (warning,) = found.warnings
    assert warning.line == line
    for part in parts:
        assert part in warning.reason


@pytest.mark.parametrize(
    "text",
    [
        # Each says something that the other doesn't.
        "predicates:\n  on:\n    goals:\n      - (put|lay) {i} on {s}\n      - (put|drop) {i} on {s}\n",
        # Slots in another order mean something else.
        "predicates:\n  on:\n    goals:\n      - put {i} on {s}\n      - put {s} on {i}\n",
        # No entity is of both types.
        "predicates:\n  greeted:\n    goals: ['greet {p}']\n  held:\n    goals: ['greet {i}']\n",
        # A goal and a state are never taken for each other.
        "predicates:\n  on:\n    goals: ['{i} on {s}']\n  under:\n    states: ['{i} on {s}']\n",
    ],
)
def test_no_warnings_without_cause(tmp_path: Path, text: str) -> None:
    found = check_grammar_file(grammar_file(tmp_path, text))
    assert (found.errors, found.warnings) == ([], [])


def test_a_wording_without_end_is_checked_in_part(tmp_path: Path) -> None:
    many = " ".join(["(a|b|c|d|e|f|g|h)"] * 20)
    text = f"predicates:\n  on:\n    goals:\n      - put {{i}} {many}\n      - put {{i}} {many}\n"
    (warning,) = check_grammar_file(grammar_file(tmp_path, text)).warnings
    assert warning.line == 6


# Intents and what is shared


@pytest.mark.parametrize(
    ("intent", "text", "line", "parts"),
    [
        (
            "where",
            "kind: query\nwordings:\n  - where is {y}\n",
            4,
            ["{y} is no slot", "{x} (an entity)"],
        ),
        ("where", "kind: query\nwordings:\n  - where is it\n", 4, ["lacks {x}"]),
        ("where", "kind: query\nwordings:\n  - where is {x:object}\n", 4, ["takes no type"]),
        ("where", "kind: edit\nwordings:\n  - where is {x}\n", 2, ["kind: query"]),
        ("where", "kind: query\nwording:\n  - where is {x}\n", 3, ["no field 'wording'"]),
        ("where", "kind: query\n", 1, ["has no wordings"]),
        ("undo", "kind: command\nwordings:\n  - undo {k}\n", 4, ["{k} is no slot", "it has none"]),
        ("undo", "kind: command\nwordings:\n  - undo (that|it\n", 4, ["A ( is never closed"]),
    ],
)
def test_errors_of_intents(
    tmp_path: Path, intent: str, text: str, line: int, parts: list[str]
) -> None:
    path = language_folder(tmp_path) / "intents" / f"{intent}.yaml"
    path.write_text(f"schema: polaris-intent/1\n{text}", encoding="utf-8")
    error = check_grammar_file(path).errors[0]
    assert (error.path, error.line) == (path, line), error
    for part in parts:
        assert part in error.reason


def test_an_intent_that_the_program_does_not_know(tmp_path: Path) -> None:
    path = language_folder(tmp_path) / "intents" / "udno.yaml"
    path.write_text("schema: polaris-intent/1\nkind: command\nwordings: [undo]\n", encoding="utf-8")
    assert "There is no intent udno" in check_grammar_file(path).errors[0].reason
    assert "Did you mean undo" in check_grammar_file(path).errors[0].reason


def test_an_intent_that_an_earlier_one_shadows(tmp_path: Path) -> None:
    folder = language_folder(tmp_path)
    path = folder / "intents" / "redo.yaml"
    text = "schema: polaris-intent/1\nkind: command\nwordings:\n  - redo\n  - undo (that|it)\n"
    path.write_text(text, encoding="utf-8")
    (warning,) = check_grammar_file(path).warnings
    assert warning.line == 5
    assert "'undo (that|it)' is never reached" in warning.reason
    assert "(undo)" in warning.reason
    assert path in [w.path for w in check_grammar_file(folder / "common.yaml").warnings]


def test_intents_and_their_files_are_listed_one_to_one(tmp_path: Path) -> None:
    folder = language_folder(tmp_path)
    (folder / "intents" / "undo.yaml").rename(folder / "intents" / "undoing.yaml")
    reasons = [e.reason for e in check_grammar_file(folder / "common.yaml").errors]
    assert any("There is no file intents/undo.yaml" in r for r in reasons)
    assert any("intents/undoing.yaml is not used" in r for r in reasons)


def test_errors_of_what_is_shared(tmp_path: Path) -> None:
    path = language_folder(tmp_path) / "common.yaml"
    text = path.read_text(encoding="utf-8")
    text = text.replace("fillers:\n", "fillers:\n  - hey {x}\n", 1).replace("  and: [", "  und: [")
    path.write_text(text + "nouns: []\n", encoding="utf-8")
    lines = [line.strip()[:6].strip() for line in text.splitlines()]
    errors = errors_of(check_grammar_file(path))
    for start, part in (("- hey", "There are no slots here"), ("und: [", "no field 'und'")):
        assert any(e[0] == lines.index(start) + 1 and part in e[1] for e in errors), errors
    assert errors[0][0] == len(lines) + 1
    assert "A grammar has no field 'nouns'." in errors[0][1]
    with pytest.raises(GrammarError, match="no field 'nouns'"):
        read_common(path)


def test_a_shared_grammar_may_speak_of_any_domain(tmp_path: Path) -> None:
    path = language_folder(tmp_path) / "household.yaml"
    domains = [read_domain(p) for p in shipped_domains().values()]
    assert set(read_shared(path, domains, read_common(SHIPPED / "common.yaml")).predicates) > {"at"}
    with path.open("a", encoding="utf-8") as file:
        file.write("  flly: fly {o}\n")
    (error,) = check_grammar_file(path).errors
    assert "has no operator flly" in error.reason


def test_a_file_that_is_used_is_checked_in_its_place(tmp_path: Path) -> None:
    path = grammar_file(tmp_path, "uses: [base]\n")
    (tmp_path / "base.yaml").write_text(
        "schema: polaris-grammar/1\npredicates:\n  on: {goals: [put ( on]}\n  flies: {fact: x}\n",
        encoding="utf-8",
    )
    (error,) = check_grammar_file(path).errors
    assert (error.path, error.line) == (tmp_path / "base.yaml", 3)
    domain = read_domain(tmp_path / "domain.pddl")
    with pytest.raises(GrammarError, match=r"base\.yaml, line 3"):
        read_grammar(path, domain, read_common(SHIPPED / "common.yaml"))


# The command


def test_the_shipped_grammars_have_no_errors_and_no_warnings(
    capsys: pytest.CaptureFixture[str],
) -> None:
    files = [*SHIPPED.glob("*.yaml"), *SHIPPED.glob("intents/*.yaml")]
    assert main(["check", *map(str, files)]) == 0
    said = capsys.readouterr()
    # A line is broken where the path is long.
    assert " ".join(said.out.split()).count("all right") == len(files)
    assert said.err == ""


def test_warnings_leave_the_exit_code_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    goals = "predicates:\n  on:\n    goals:\n      - put {i} on {s}\n      - put {i} on {s}\n"
    path = grammar_file(tmp_path, goals)
    assert main(["check", str(path)]) == 0
    said = capsys.readouterr()
    assert f"warning: {path}, line 6: " in said.err
    assert "all right" in said.out
    assert main(["check", "--json", str(path)]) == 0
    value = json.loads(capsys.readouterr().out)
    assert value["ok"]
    assert len(value["warnings"]) == 1


def test_a_domain_and_a_world_are_checked_with_their_grammar(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = grammar_file(
        tmp_path, "predicates:\n  on:\n    goals:\n      - put {o}\n      - lay (\n"
    )
    world = tmp_path / "world.yaml"
    world.write_text(
        "schema: polaris-world/1\nname: corner\ndomain: domain.pddl\nentities: []\n",
        encoding="utf-8",
    )
    for file in (tmp_path / "domain.pddl", world):
        assert main(["check", str(file)]) == 1
        said = capsys.readouterr().err
        assert f"{path}, line 5: " in said
        assert f"{path}, line 6: " in said


def test_words_that_two_comments_fight_for(tmp_path: Path) -> None:
    path = tmp_path / "domain.pddl"
    path.write_text(
        "(define (domain d) (:types a)\n(:predicates (p ?x ?y - a) ; NL: [0] near [1]\n"
        "(q ?x ?y - a) ; NL: [0] near [1]\n))",
        encoding="utf-8",
    )
    found = check_domain(read_domain(path))
    assert not found.errors
    assert any("means q here and p in domain.pddl" in w.reason for w in found.warnings)
