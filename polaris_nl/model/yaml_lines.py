"""YAML with the line of every value, for error messages that name the place."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import yaml

from polaris_nl.model.errors import FormatError, did_you_mean
from polaris_nl.model.files import read_small_text


class Lined:
    """A YAML value with its line: `value` is a scalar, a list of `Lined`, or a dict of `Lined`."""

    __slots__ = ("line", "value")

    def __init__(self, value: Any, line: int) -> None:
        self.value = value
        self.line = line

    def mapping(self, what: str, allowed: Iterable[str]) -> dict[str, Lined]:
        """The value as a mapping with no other than the allowed fields.

        Raises:
            FormatError: it is none, or a field is unknown.
        """
        if not isinstance(self.value, dict):
            raise FormatError(f"{what} is a list of fields (name: value).", line=self.line)
        known = tuple(allowed)
        for key, field in self.value.items():
            if key not in known:
                hint = did_you_mean(str(key), known)
                raise FormatError(f"{what} has no field {key!r}.{hint}", line=field.line)
        return self.value

    def items(self, what: str) -> list[Lined]:
        """The value as a list.

        Raises:
            FormatError: it is none.
        """
        if self.value is None:
            return []
        if not isinstance(self.value, list):
            raise FormatError(
                f"{what} is a list ([a, b] or lines that start with a dash).", line=self.line
            )
        return self.value

    def text(self, what: str) -> str:
        """The value as text; numbers are taken for text.

        Raises:
            FormatError: it is a list, a mapping or empty.
        """
        if isinstance(self.value, str | int | float) and not isinstance(self.value, bool):
            return str(self.value)
        raise FormatError(f"{what} is a text.", line=self.line)

    def texts(self, what: str) -> tuple[str, ...]:
        """The value as a list of texts."""
        return tuple(item.text(f"each of {what}") for item in self.items(what))

    def number(self, what: str) -> float:
        """The value as a number.

        Raises:
            FormatError: it is none.
        """
        if isinstance(self.value, int | float) and not isinstance(self.value, bool):
            return float(self.value)
        raise FormatError(f"{what} is a number.", line=self.line)

    def flag(self, what: str) -> bool:
        """The value as true or false."""
        if isinstance(self.value, bool):
            return self.value
        raise FormatError(f"{what} is true or false.", line=self.line)


def read_yaml(path: Path) -> tuple[Lined, str]:
    """Reads a YAML file.

    Returns:
        Its root value and its text.

    Raises:
        FileError: it can't be read.
        FormatError: it is no YAML, names a field twice or uses aliases; the line is named.
    """
    text = read_small_text(path, "file", FormatError)
    return parse_yaml(text), text


def parse_yaml(text: str) -> Lined:
    """Makes lined values of YAML text.

    Raises:
        FormatError: see `read_yaml`.
    """
    try:
        for event in yaml.parse(text, Loader=yaml.CSafeLoader):
            if isinstance(event, yaml.AliasEvent):
                raise FormatError(
                    "YAML aliases (*name) are refused; write it out.", line=_line(event)
                )
        node = yaml.compose(text, Loader=yaml.CSafeLoader)
        return _lined(node)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or "it can't be read as YAML"
        raise FormatError(
            f"This is no YAML: {problem}.", line=mark.line + 1 if mark else 1
        ) from error
    except RecursionError as error:
        raise FormatError("The YAML is nested too deeply.", line=1) from error


def _line(node: Any) -> int:
    return int(node.start_mark.line) + 1


def _lined(node: Any) -> Lined:
    if node is None:
        return Lined(None, 1)
    if isinstance(node, yaml.SequenceNode):
        return Lined([_lined(item) for item in node.value], _line(node))
    if isinstance(node, yaml.MappingNode):
        found: dict[str, Lined] = {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise FormatError("A field's name is a word.", line=_line(key))
            if key.value in found:
                raise FormatError(f"The field {key.value!r} is given twice.", line=_line(key))
            found[key.value] = Lined(_lined(value).value, _line(key))
        return Lined(found, _line(node))
    return Lined(_scalar(node), _line(node))


def _scalar(node: Any) -> Any:
    """A plain value by the tag that YAML's rules gave it."""
    kind = node.tag.rpartition(":")[2]
    if kind == "null":
        return None
    if kind == "bool":
        return node.value.lower() in ("true", "yes", "on")
    try:
        if kind == "int":
            return int(node.value.replace("_", ""), 0)
        if kind == "float":
            return float(node.value.replace("_", "").replace(".nan", "nan").replace(".inf", "inf"))
    except ValueError:
        return node.value
    return node.value
