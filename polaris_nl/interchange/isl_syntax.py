"""Reads the text of ISL, the goal-automaton language that the paper's authors published (HRI 2025).

What is read is what the text says, whatever program that makes: it may loop, leave a choice between
two transitions, or have states that nothing leads to. docs/interchange.md shows the language.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NoReturn

from polaris_nl.model.domain import Action
from polaris_nl.model.errors import FormatError, did_you_mean
from polaris_nl.model.formula import Literal

INIT = "init"
OUTCOMES = ("default", "success", "failure")
OPTIONS = ("conditional_effects", "maintenance_goals", "uncertain_item_locations")
WORD = re.compile(r"\w+(?:[.\-]+\w+)*")
RESERVED = (INIT, "endlabels", "not", "predicate", "action", "params")
"""What no label can be called."""
_TOKEN = re.compile(rf"#[^\n]*|\s+|->|[\[\]:,;&=]|{WORD.pattern}|.")


@dataclass(frozen=True, slots=True)
class Label:
    """A name for literals, or for one action; `lines` are those of the literals or of the action."""

    name: str
    literals: tuple[Literal, ...]
    action: Action | None
    lines: tuple[int, ...]
    line: int


@dataclass(frozen=True, slots=True)
class Step:
    """A transition: `guard` is the number of a guard, `default`, `success`, `failure`, or None."""

    source: int
    target: int
    guard: int | str | None
    line: int


@dataclass(frozen=True)
class Isl:
    """What an ISL text says.

    Attributes:
        states, guards: the names of their labels, by number; one state is called `init`.
    """

    domain: str
    labels: Mapping[str, Label]
    states: Mapping[int, str]
    guards: Mapping[int, str]
    steps: tuple[Step, ...]
    options: tuple[str, ...] = ()


def parse_isl(text: str) -> Isl:
    """Reads an ISL text.

    Raises:
        FormatError: it is none; what is wrong is named with its line.
    """
    return _Parser(text).isl()


@dataclass(frozen=True, slots=True)
class _Token:
    text: str
    line: int


def _tokens(text: str) -> Iterator[_Token]:
    line = 1
    for match in _TOKEN.finditer(text):
        token = match.group()
        if not token.isspace() and not token.startswith("#"):
            yield _Token(token, line)
        line += token.count("\n")


class _Parser:
    def __init__(self, text: str) -> None:
        self._tokens = list(_tokens(text))
        self._at = 0
        self._end = _Token("", text.count("\n") + 1)

    # Tokens

    @property
    def _now(self) -> _Token:
        return self._tokens[self._at] if self._at < len(self._tokens) else self._end

    def _next(self) -> _Token:
        token = self._now
        self._at += 1
        return token

    def _take(self, *wanted: str, where: str) -> _Token:
        """The next token, which has to be one of some."""
        token = self._next()
        if token.text not in wanted:
            known = " or ".join(wanted)
            found = f"{token.text!r}" if token.text else "the end of the file"
            raise FormatError(f"{where}, {known} was expected, but {found} found.", line=token.line)
        return token

    def _if(self, wanted: str) -> bool:
        if self._now.text == wanted:
            self._at += 1
            return True
        return False

    def _word(self, what: str) -> _Token:
        token = self._next()
        if not WORD.fullmatch(token.text):
            found = f"{token.text!r}" if token.text else "the end of the file"
            raise FormatError(f"{what} was expected, but {found} found.", line=token.line)
        return token

    def _number(self, what: str) -> tuple[int, int]:
        token = self._next()
        if not (token.text.isascii() and token.text.isdecimal()):
            found = f"{token.text!r}" if token.text else "the end of the file"
            raise FormatError(
                f"The number of {what} was expected, but {found} found.", line=token.line
            )
        return int(token.text), token.line

    # Sections

    def isl(self) -> Isl:
        self._take("import", where="At the beginning")
        name = self._word("A domain such as pddl.general")
        before, _, domain = name.text.partition(".")
        if before != "pddl" or not domain:
            raise FormatError(
                f"A program imports a domain such as pddl.general, not {name.text}.", line=name.line
            )
        self._if(";")
        labels = self._labels()
        states, guards, steps = self._module(labels)
        options = self._options()
        if self._now.text:
            self._fail(f"Nothing comes after the program, but {self._now.text!r} does", self._now)
        return Isl(domain.lower(), labels, states, guards, steps, options)

    def _labels(self) -> dict[str, Label]:
        self._take("labels", where="After the import")
        found: dict[str, Label] = {}
        if self._if("endlabels"):
            return found
        while True:
            name = self._word("A label's name")
            if name.text in RESERVED:
                self._fail(f"No label can be called {name.text}; rename it", name)
            if name.text in found:
                first = found[name.text].line
                self._fail(f"There is another label {name.text} on line {first}; rename one", name)
            self._take(":", where=f"Behind the label {name.text}")
            found[name.text] = self._label(name)
            if self._take(",", "endlabels", where=f"After the label {name.text}").text != ",":
                return found

    def _label(self, name: _Token) -> Label:
        where = f"In the label {name.text}"
        self._take("[", where=where)
        literals: list[Literal] = []
        actions: list[Action] = []
        lines: list[int] = []
        while not self._if("]"):
            if literals or actions:
                self._take("&", "]", where=where)
            positive = not self._if("not")
            kind = self._take("predicate", "action", where=where)
            self._take(":", where=where)
            positive = not self._if("not") and positive
            head = self._word(f"The name of the {kind.text}").text.lower()
            self._take(",", where=where)
            args = self._params(where)
            lines.append(kind.line)
            if kind.text == "predicate":
                literals.append(Literal(head, args, positive))
            elif not positive:
                self._fail(f"{where}, an action is negated; only predicates can be", kind)
            else:
                actions.append(Action(head, args))
            if len(actions) > 1:
                self._fail(f"{where} there are two actions; give each a label", kind)
            if actions and literals:
                self._fail(f"{where} there are predicates and an action; give each a label", kind)
        action = actions[0] if actions else None
        return Label(name.text, tuple(literals), action, tuple(lines), name.line)

    def _params(self, where: str) -> tuple[str, ...]:
        self._take("params", where=where)
        self._take(":", where=where)
        self._take("[", where=where)
        found: list[str] = []
        while not self._if("]"):
            if found:
                self._take(",", where=where)
            found.append(self._word("A parameter").text.lower())
        return tuple(found)

    def _module(
        self, labels: Mapping[str, Label]
    ) -> tuple[dict[int, str], dict[int, str], tuple[Step, ...]]:
        start = self._take("module", where="After the labels")
        states = self._numbered("st", "state", labels)
        inits = [number for number, name in states.items() if name == INIT]
        if len(inits) != 1:
            many = f"{len(inits)} states are" if inits else "No state is"
            self._fail(f"{many} called init; one has to be, where the program starts", start)
        guards = self._numbered("guard", "guard", labels) if self._now.text == "guard" else {}
        steps = []
        while not self._if("endmodule"):
            steps.append(self._step(states, guards))
        return states, guards, tuple(steps)

    def _numbered(self, head: str, what: str, labels: Mapping[str, Label]) -> dict[int, str]:
        self._take(head, where="In the module")
        self._take(":", where=f"Behind {head}")
        self._take("[", where=f"Behind {head}")
        found: dict[int, str] = {}
        while not self._if("]"):
            if found:
                self._take(",", "]", where=f"In the list of {what}s")
            number, line = self._number(f"a {what}")
            self._take(":", where=f"Behind the number {number}")
            name = self._word("A label's name")
            if number in found:
                raise FormatError(f"There are two {what}s {number}; renumber one.", line=line)
            if name.text not in labels and not (name.text == INIT and head == "st"):
                hint = did_you_mean(name.text, labels)
                raise FormatError(f"There is no label {name.text}.{hint}", line=name.line)
            found[number] = name.text
        self._take(";", where=f"After the list of {what}s")
        return found

    def _step(self, states: Mapping[int, str], guards: Mapping[int, str]) -> Step:
        first = self._take("[", where="Before endmodule")
        self._take("]", where="In a transition")
        source = self._known(states, "state")
        guard: int | str | None = None
        if self._if("&"):
            self._take("guard", where="In a transition")
            self._take("=", where="In a transition")
            outcome = self._now.text.lower()
            guard = outcome if outcome in OUTCOMES else None
            if guard is None:
                guard = self._known(guards, "guard")
            else:
                self._at += 1
        self._take("->", where="In a transition")
        target = self._known(states, "state")
        self._take(";", where="After a transition")
        return Step(source, target, guard, first.line)

    def _known(self, numbered: Mapping[int, str], what: str) -> int:
        number, line = self._number(f"a {what}")
        if number not in numbered:
            known = ", ".join(map(str, numbered)) or "none"
            raise FormatError(f"There is no {what} {number}; there are: {known}.", line=line)
        return number

    def _options(self) -> tuple[str, ...]:
        found: list[str] = []
        if not self._if("options"):
            return ()
        while not self._if("endoptions"):
            option = self._word("An option or endoptions")
            if option.text not in OPTIONS:
                self._fail(f"There is no option {option.text}", option, OPTIONS)
            self._take(";", where=f"After the option {option.text}")
            found.append(option.text)
        return tuple(dict.fromkeys(found))

    def _fail(self, reason: str, token: _Token, known: tuple[str, ...] = ()) -> NoReturn:
        hint = did_you_mean(token.text, known) if known else ""
        raise FormatError(f"{reason}.{hint}", line=token.line)
