"""Grammar files while they are read: fields and wordings, and a fault with its line where one is wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from polaris_nl.language.expansions import expansion_count, expansions
from polaris_nl.language.template import (
    NO_LISTS,
    Lists,
    Parts,
    Slot,
    Source,
    parse_template,
    slots_in,
)
from polaris_nl.language.verbs import with_forms
from polaris_nl.model.errors import FormatError, GrammarError, did_you_mean
from polaris_nl.model.schema import check_schema
from polaris_nl.model.yaml_lines import Lined, read_yaml

Phrase = tuple[str, ...]
SlotFault = Callable[[Slot], str]
"""What is wrong with a slot where it stands, or ""."""
MOST_PHRASES = 5_000
"""A list of phrases that stands for more is refused: somebody left out a slot."""


class GrammarFile:
    """One file, its fields and its faults.

    Args:
        path: the file.
        faults: takes the faults, so that all are found; without it the first one is raised.
        irregular: by verb, the past forms that `~verb` in a wording stands for too.
    """

    def __init__(
        self,
        path: Path,
        faults: list[GrammarError] | None = None,
        irregular: Mapping[str, str] | None = None,
    ) -> None:
        self.path = path
        self.irregular: Mapping[str, str] = irregular or {}
        self._faults = faults

    def fault(self, reason: str, line: int | None) -> None:
        """Raises a fault, or keeps it.

        Raises:
            GrammarError: the fault, where none are kept.
        """
        error = GrammarError(reason, self.path, line)
        if self._faults is None:
            raise error
        if str(error) not in map(str, self._faults):
            self._faults.append(error)

    @contextmanager
    def kept(self, line: int | None = None) -> Iterator[None]:
        """Makes a fault of what is raised inside: of this file, unless it names another."""
        try:
            yield
        except FormatError as error:
            if error.path is None:
                self.fault(error.reason, error.line or line)
            elif self._faults is None:
                raise
            else:
                self._faults.append(GrammarError(error.reason, error.path, error.line))

    def root(self, schema: str, what: str, allowed: tuple[str, ...]) -> dict[str, Lined]:
        """The fields of the file; those that it may not have are faults."""
        with self.kept():
            root, _ = read_yaml(self.path)
            fields = self.fields(root, what, allowed)
            text = fields["schema"].text("schema") if "schema" in fields else ""
            if not text:
                self.fault(f"The first field of {what.lower()} is schema: {schema}.", root.line)
            with self.kept(fields["schema"].line if text else root.line):
                check_schema(text, schema, what.lower().removeprefix("a ").removeprefix("an "))
            return fields
        return {}

    def fields(
        self, value: Lined | None, what: str, allowed: tuple[str, ...] | None = None
    ) -> dict[str, Lined]:
        """A mapping; fields that are not allowed are faults."""
        if value is None:
            return {}
        if not isinstance(value.value, dict):
            self.fault(f"{what} is a list of fields (name: value).", value.line)
            return {}
        if allowed is None:
            return dict(value.value)
        for key in value.value:
            if key not in allowed:
                self.fault(
                    f"{what} has no field {key!r}.{did_you_mean(key, allowed)}",
                    value.value[key].line,
                )
        return {key: field for key, field in value.value.items() if key in allowed}

    def items(self, value: Lined | None, what: str) -> Iterator[tuple[str, int]]:
        """The texts of a list with their lines."""
        with self.kept():
            for item in value.items(what) if value is not None else ():
                with self.kept():
                    if isinstance(item.value, bool):
                        self.fault(
                            f'{what} has a yes, no, on or off without quotes; write "yes".',
                            item.line,
                        )
                    else:
                        yield item.text(f"each of {what}"), item.line

    def texts(self, value: Lined | None, what: str) -> dict[str, str]:
        """A mapping of texts."""
        found: dict[str, str] = {}
        for key, item in self.fields(value, what).items():
            with self.kept():
                found[key] = item.text(key)
        return found

    def numbers(self, value: Lined | None, what: str) -> dict[str, int]:
        """A mapping of whole numbers."""
        found: dict[str, int] = {}
        for key, item in self.fields(value, what).items():
            with self.kept():
                found[key] = int(item.number(key))
        return found

    def lists(self, value: Lined | None, known: Lists = NO_LISTS) -> Lists:
        """Lists by name, the known ones first: each a wording, or a list of wordings to choose from.

        One that can't be read is a fault, and empty from then on.
        """
        found, lines = dict(known), {}
        for name, item in self.fields(value, "lists").items():
            with self.kept():
                several = isinstance(item.value, list)
                text = f"({'|'.join(item.texts(name))})" if several else item.text(name)
                found[name] = with_forms(text, self.irregular)
                lines[name] = item.line
        for name, line in lines.items():
            try:
                Lists(found).parts(name, found[name])
            except GrammarError as error:
                self.fault(error.reason, line)
                found[name] = ""
        return Lists(found)

    def wording(self, text: str, line: int, lists: Lists, slot_fault: SlotFault) -> Parts | None:
        """A wording, or None where it has a fault."""
        with self.kept(line):
            written = with_forms(text, self.irregular)
            template = parse_template(written, lists, Source(self.path, line, text))
            reasons = (slot_fault(slot) for slot in slots_in(template))
            reason = next(filter(None, reasons), "")
            if not reason:
                return template
            self.fault(f"{reason} It stands in {text!r}.", line)
        return None

    def phrases(self, value: Lined | None, what: str, lists: Lists) -> tuple[Phrase, ...]:
        """A list of phrases, the longest first; brackets and lists in them are written out."""
        found: set[Phrase] = set()
        for text, line in self.items(value, what):
            template = self.wording(text, line, lists, no_slots)
            found.update(self.written_out(template) if template is not None else ())
        return tuple(sorted(found, key=lambda p: (-len(p), p)))

    def written_out(self, template: Parts) -> Iterator[Phrase]:
        """The phrases that a wording without slots stands for."""
        source = template.source
        if expansion_count(template) > MOST_PHRASES and source is not None:
            self.fault(
                f"{source.text!r} stands for more than {MOST_PHRASES} phrases; use fewer brackets.",
                source.line,
            )
        for said in expansions(template, MOST_PHRASES):
            words = tuple(word for word in said if isinstance(word, str))
            if words:
                yield words


def no_slots(slot: Slot) -> str:
    """The fault of a slot where there are none."""
    return f"There are no slots here, but {{{slot.name}}} is one; write words."
