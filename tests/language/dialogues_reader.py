"""Reads the YAML dialogues, checks them, and plays them to a `Session`.

A file is a list of dialogues `{name, world, turns}`. A turn says something and what should come of it:

    say          the utterance, as one types it
    expect       applied, question, answer, command or refused; or a list of those that will do
    checkpoints  the whole program after the turn but its start: a list of goals for each checkpoint, or
                 {name: ..., goals: [...]} where the user named it
    transitions  {from: ..., to: ..., when: [...]}; ends are goals, a name that the user gave, or start
    either       a list of programs {checkpoints, transitions} or {unchanged: true}, of which one will do; one
                 with an `expect` of its own will do for that outcome only
    unchanged    true: the program is as before the turn
    options      what a question offers, in any order
    command      which command
    says         words that occur in the answer

Where a turn gives no program, nothing is asked of it but the contract of DESIGN section 6: only `applied`,
the commands that step through the program's history, and a question that says `partial` change it. `<2>` in
a literal is the second option of the last question, in the order in which it was asked.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.model.check import formula_faults
from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.errors import PolarisError
from polaris_nl.model.formula import Literal, parse_formula, parse_literal
from polaris_nl.model.world import World
from polaris_nl.model.world_file import read_world
from polaris_nl.session import Session
from polaris_nl.snapshot import Answer

from .reader import OUTCOMES, language_of, spoken

FOLDERS = ("dialogues", "dialogues_held_out")
FORMS = ("typed", "spoken")
COMMANDS = frozenset(
    [
        "new",
        "undo",
        "redo",
        "run",
        "stop",
        "pause",
        "resume",
        "yes",
        "no",
        "help",
        "read-program",
        "read-plan",
        "status",
        "repeat",
        "quit",
        "save",
        "load",
    ]
)
CHANGING = ("new", "undo", "redo", "load")
PROGRAM_FIELDS = {"checkpoints", "transitions", "unchanged"}
TURN_FIELDS = {"say", "expect", "either", "options", "command", "says"} | PROGRAM_FIELDS
DIALOGUE_FIELDS = {"name", "world", "turns"}
DIGITS = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"]
NUMBERED = re.compile(r"<(\d)>")


@dataclass(frozen=True)
class Turn:
    """What is said, and what should come of it."""

    say: str
    expect: tuple[str, ...]
    wanted: Mapping[str, Any] = field(hash=False)


@dataclass(frozen=True)
class Dialogue:
    """A dialogue from an empty program on; `theme` is the name of its file."""

    name: str
    theme: str
    world: str
    turns: tuple[Turn, ...]


@dataclass(frozen=True)
class Played:
    """A turn as it went; `differences` says what is not as it should be, a sentence each."""

    said: str
    outcome: str
    answer: str
    differences: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether everything is as it should be."""
        return not self.differences


# Reading


def all_dialogues(folder: str = "dialogues") -> list[Dialogue]:
    """Every dialogue of a folder, file by file."""
    paths = sorted((Path(__file__).parent / folder).glob("*.yaml"))
    return [dialogue for path in paths for dialogue in read_dialogues(path)]


def read_dialogues(path: Path) -> list[Dialogue]:
    """The dialogues of a file.

    Raises:
        ValueError: a dialogue is not as it should be; says which and why.
    """
    return dialogues_of(yaml.safe_load(path.read_text(encoding="utf-8")), path.stem)


def dialogues_of(items: Any, theme: str = "") -> list[Dialogue]:
    """Dialogues from a parsed file.

    Raises:
        ValueError: a dialogue is not as it should be; says which and why.
    """
    if not isinstance(items, list):
        raise ValueError(f"{theme}: a file is a list of dialogues")
    names: set[str] = set()
    dialogues = []
    for item in items:
        where = f"{theme}: {item.get('name')}"
        _only(item, DIALOGUE_FIELDS, where)
        if not item.get("name") or item["name"] in names:
            raise ValueError(f"{where}: a dialogue needs a name of its own")
        names.add(item["name"])
        if item.get("world") not in shipped_worlds():
            raise ValueError(f"{where}: which world?")
        if not item.get("turns"):
            raise ValueError(f"{where}: nothing is said")
        turns = tuple(_turn(turn, where) for turn in item["turns"])
        dialogue = Dialogue(item["name"], theme, item["world"], turns)
        faults = list(_literal_faults(dialogue))
        if faults:
            raise ValueError(f"{where}: {faults[0]}")
        dialogues.append(dialogue)
    return dialogues


def _turn(item: Any, where: str) -> Turn:
    where = f"{where}: {item.get('say')!r}"
    _only(item, TURN_FIELDS, where)
    if not isinstance(item.get("say"), str) or not item["say"].strip():
        raise ValueError(f"{where}: what is said?")
    expect = _outcomes(item.get("expect"), where)
    if ("command" in item) != (expect == ("command",)):
        raise ValueError(f"{where}: a turn that expects a command alone says which, and no other")
    if item.get("command", "undo") not in COMMANDS:
        raise ValueError(f"{where}: there is no command {item['command']}")
    if "options" in item and expect != ("question",):
        raise ValueError(f"{where}: only a question has options")
    for key in ("options", "says"):
        if not _texts(item.get(key, [])):
            raise ValueError(f"{where}: {key} is a list of texts")
    if "either" in item and PROGRAM_FIELDS & set(item):
        raise ValueError(f"{where}: either several programs or one")
    for program in item.get("either", [{key: item[key] for key in PROGRAM_FIELDS & set(item)}]):
        _only(program, PROGRAM_FIELDS | {"expect"}, where)
        if "expect" in program and not set(_outcomes(program["expect"], where)) <= set(expect):
            raise ValueError(f"{where}: an alternative has an outcome that the turn has not")
        _check_program(program, where)
    return Turn(item["say"], expect, item)


def _outcomes(value: Any, where: str) -> tuple[str, ...]:
    expect = (value,) if isinstance(value, str) else tuple(value or ())
    if not expect or set(expect) - set(OUTCOMES):
        raise ValueError(f"{where}: expect is one or some of {', '.join(OUTCOMES)}")
    return expect


def _check_program(program: Mapping[str, Any], where: str) -> None:
    """The shape of a program: every end of a transition is one of its checkpoints, and it is a tree."""
    if program.get("unchanged", True) is not True or (
        "unchanged" in program and "checkpoints" in program
    ):
        raise ValueError(f"{where}: unchanged is true, or a program is given")
    if ("transitions" in program) != ("checkpoints" in program):
        raise ValueError(f"{where}: checkpoints and transitions go together")
    checkpoints = program.get("checkpoints", [])
    for item in checkpoints:
        if isinstance(item, dict):
            _only(item, {"name", "goals"}, where)
        if not _texts(_goals(item)):
            raise ValueError(f"{where}: a checkpoint is a list of goals, or has a name and goals")
    if len(program.get("transitions", ())) != len(checkpoints):
        raise ValueError(f"{where}: one transition leads to each checkpoint")
    for item in program.get("transitions", ()):
        _only(item, {"from", "to", "when"}, where)
        for end in (item["from"], item["to"]):
            there = any(_is_end(c, end) for c in checkpoints)
            if not there and not (end == "start" and end is item["from"]):
                raise ValueError(f"{where}: there is no checkpoint {end}")
    for item in checkpoints:
        if not any(_is_end(item, t["to"]) for t in program["transitions"]):
            raise ValueError(f"{where}: nothing leads to {item}")


def _is_end(checkpoint: Any, end: Any) -> bool:
    if isinstance(end, str):
        return isinstance(checkpoint, dict) and checkpoint["name"] == end
    return set(_goals(checkpoint)) == set(end)


def _goals(checkpoint: Any) -> list[str]:
    goals: list[str] = checkpoint["goals"] if isinstance(checkpoint, dict) else checkpoint
    return goals


def _only(item: Any, fields: set[str], where: str) -> None:
    if not isinstance(item, dict):
        raise ValueError(f"{where}: {item!r} has no fields")
    strange = set(item) - fields
    if strange:
        raise ValueError(f"{where}: unknown fields {', '.join(sorted(strange))}")


def _texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(text, str) for text in value)


# Type checks


@cache
def world_of(name: str) -> World:
    """A shipped world."""
    return read_world(shipped_worlds()[name])


def _literal_faults(dialogue: Dialogue) -> Iterator[str]:
    """What is wrong with the literals of a dialogue, a sentence each."""
    world = world_of(dialogue.world)
    types = {**world.domain.constants, **{e.name: e.type for e in world.entities.values()}}
    options: list[str] = []
    for turn in dialogue.turns:
        for text, is_goal in _literals(turn.wanted):
            numbers = [int(n) for n in NUMBERED.findall(text)]
            if numbers and not 0 < max(numbers) <= len(options):
                yield f"{text}: no question before offers so many options"
                continue
            for option in options if numbers else [""]:
                filled = NUMBERED.sub(_entity(option), text)
                try:
                    formula = parse_formula(filled) if is_goal else parse_literal(filled)
                except PolarisError as error:
                    yield f"{filled}: {error}"
                    continue
                yield from formula_faults(formula, world.domain, types)
        options = turn.wanted.get("options", options)


def _literals(turn: Mapping[str, Any]) -> Iterator[tuple[str, bool]]:
    for program in turn.get("either", [turn]):
        for checkpoint in program.get("checkpoints", ()):
            for goal in _goals(checkpoint):
                yield goal, True
        for transition in program.get("transitions", ()):
            for literal in transition.get("when", ()):
                yield literal, False


def _entity(option: str) -> str:
    return option.replace(" ", "-")


# Playing


def in_form(text: str, form: str) -> str:
    """A typed text, or the text as a recogniser writes it: digits are words there."""
    if form == "typed":
        return text
    return spoken(re.sub(r"\d", lambda digit: f" {DIGITS[int(digit[0])]} ", text))


def play(dialogue: Dialogue, form: str = "typed") -> list[Played]:
    """Says a dialogue to a session in one of the forms; goes on after a difference."""
    played = []
    options: tuple[str, ...] = ()
    with Session(world_of(dialogue.world)) as session:
        session.understanding = language_of(
            dialogue.world
        )  # One for all dialogues: it is slow to make.
        for turn in dialogue.turns:
            before = session.snapshot.automaton
            said = in_form(turn.say, form)
            answer = session.say(said, wait_s=0)
            differences = tuple(_differences(turn, answer, before, options))
            played.append(Played(said, answer.interpretation.outcome, answer.say, differences))
            if answer.interpretation.question is not None:
                options = tuple(answer.interpretation.question.options)
    return played


def _differences(
    turn: Turn, answer: Answer, before: Automaton, options: tuple[str, ...]
) -> Iterator[str]:
    """What is not as a turn wants it; `options` are those of the last question before it."""
    meant, after = answer.interpretation, answer.snapshot.automaton
    wanted = turn.wanted
    if meant.outcome not in turn.expect:
        yield f"{meant.outcome}, not {' or '.join(turn.expect)}"
    if "command" in wanted and meant.command != wanted["command"]:
        yield f"command {meant.command}, not {wanted['command']}"
    if "options" in wanted and meant.question is not None:
        offered = list(meant.question.options)
        if sorted(offered) != sorted(wanted["options"]):
            yield f"options {offered}, not {wanted['options']}"
    for words in wanted.get("says", ()):
        if words.lower() not in answer.say.lower():
            yield f'the answer lacks "{words}"'
    changes = meant.outcome == "applied" or meant.partial or meant.command in CHANGING
    if not changes and after != before:
        yield f"the program changed with {meant.outcome}"
    programs = [
        program
        for program in wanted.get("either", [wanted])
        if meant.outcome in program.get("expect", OUTCOMES)
    ]
    faults = [next(program_faults(p, after, before, options), "") for p in programs]
    if faults and all(faults):
        yield faults[0]


def program_faults(
    wanted: Mapping[str, Any], after: Automaton, before: Automaton, options: tuple[str, ...]
) -> Iterator[str]:
    """What keeps a program from being the one that is wanted; nothing where it is."""
    if wanted.get("unchanged") and after != before:
        yield f"the program changed to {described(after)}"
    if "checkpoints" not in wanted:
        return
    left = [c for c in after.checkpoints.values() if c.id != START]
    # What has a name goes first: it fits the least.
    for item in sorted(wanted["checkpoints"], key=lambda item: not isinstance(item, dict)):
        found = next((c for c in left if _fits(c, item, options)), None)
        if found is None:
            yield f"no checkpoint {item} in {described(after)}"
            return
        left.remove(found)
    if left:
        yield f"too many checkpoints in {described(after)}"
        return
    ends = dict(after.checkpoints)
    arrows = list(after.transitions.values())
    for item in sorted(wanted["transitions"], key=_unnamed_ends):
        arrow = next((t for t in arrows if _is_arrow(t, item, ends, options)), None)
        if arrow is None:
            yield f"no transition {item} in {described(after)}"
            return
        arrows.remove(arrow)


def _unnamed_ends(transition: Mapping[str, Any]) -> int:
    return sum(not isinstance(transition[end], str) for end in ("from", "to"))


def _is_arrow(
    transition: Transition,
    item: Mapping[str, Any],
    ends: Mapping[str, Checkpoint],
    options: tuple[str, ...],
) -> bool:
    return (
        _fits(ends[transition.source], item["from"], options)
        and _fits(ends[transition.target], item["to"], options)
        and _same(transition.when, item.get("when", []), options)
    )


def _fits(checkpoint: Checkpoint, item: Any, options: tuple[str, ...]) -> bool:
    """Whether a checkpoint is the one that a name, goals, or both mean."""
    if isinstance(item, str):
        return checkpoint.name == item
    if isinstance(item, dict) and checkpoint.name != item["name"]:
        return False
    return checkpoint.id != START and _same(checkpoint.goals, _goals(item), options)


def _same(found: Iterable[Any], wanted: list[str], options: tuple[str, ...]) -> bool:
    def option(number: re.Match[str]) -> str:
        index = int(number[1]) - 1
        return _entity(options[index]) if index < len(options) else number[0]

    return {_normal(str(x)) for x in found} == {_normal(NUMBERED.sub(option, x)) for x in wanted}


def _normal(formula: str) -> str:
    """PDDL text with variables called after their order: ?x0, ?x1, ..."""
    variables: dict[str, str] = {}
    return re.sub(
        r"\?[\w-]+", lambda v: variables.setdefault(v[0], f"?x{len(variables)}"), formula.lower()
    )


def described(program: Automaton) -> str:
    """A program in one line."""
    arrows = []
    for transition in program.transitions.values():
        one, two = (program.checkpoints[end] for end in (transition.source, transition.target))
        arrows.append(f"{one.name} -{_listed(transition.when)}-> {two.name} {_listed(two.goals)}")
    return "; ".join(arrows) or "the empty program"


def _listed(formulas: Iterable[Any]) -> str:
    return f"[{', '.join(str(f) if isinstance(f, Literal) else _normal(str(f)) for f in formulas)}]"
