"""S-expressions with line numbers: the syntax under PDDL, literals and goals."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from polaris_nl.model.errors import FormatError

_TOKEN = re.compile(r"[()]|[^\s();]+|;[^\n]*|\s+")
MAX_DEPTH = 100
"""Deeper nesting than any domain has; beyond it the text is refused instead of exhausting the stack."""


@dataclass(frozen=True, slots=True)
class Word:
    """A token, lower case (PDDL is case-insensitive), and the line it stands on."""

    text: str
    line: int


@dataclass(frozen=True, slots=True)
class Group:
    """A parenthesised list and the line it opens on."""

    items: tuple[Word | Group, ...]
    line: int

    @property
    def head(self) -> str:
        """The first word, or "" where the list is empty or starts with another list."""
        first = self.items[0] if self.items else None
        return first.text if isinstance(first, Word) else ""


Node = Word | Group


def read_all(text: str, first_line: int = 1) -> list[Node]:
    """Reads every expression of a text.

    Raises:
        FormatError: a parenthesis is missing or too many, named by its line.
    """
    stack: list[tuple[int, list[Node]]] = [(first_line, [])]
    for token, line in _tokens(text, first_line):
        if token == "(":
            if len(stack) > MAX_DEPTH:
                raise FormatError(f"Parentheses are nested deeper than {MAX_DEPTH}.", line=line)
            stack.append((line, []))
        elif token == ")":
            if len(stack) == 1:
                raise FormatError("This closing parenthesis has no opening one.", line=line)
            opened, items = stack.pop()
            stack[-1][1].append(Group(tuple(items), opened))
        else:
            stack[-1][1].append(Word(token.lower(), line))
    if len(stack) > 1:
        raise FormatError("The parenthesis opened here is never closed.", line=stack[-1][0])
    return stack[0][1]


def read_one(text: str, first_line: int = 1) -> Node:
    """Reads a text that is exactly one expression.

    Raises:
        FormatError: the text is empty, unbalanced, or holds more than one expression.
    """
    nodes = read_all(text, first_line)
    if len(nodes) != 1:
        found = "nothing" if not nodes else f"{len(nodes)} expressions"
        raise FormatError(
            f"One expression in parentheses was expected, {found} found.", line=first_line
        )
    return nodes[0]


def _tokens(text: str, line: int) -> Iterator[tuple[str, int]]:
    for match in _TOKEN.finditer(text):
        token = match.group()
        if not token.isspace() and not token.startswith(";"):
            yield token, line
        line += token.count("\n")
