"""What was said and answered, as values and as rows."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import lru_cache

from polaris_nl.execution.events import Event, GoalConfirmed
from polaris_nl.render.glyphs import Glyphs
from polaris_nl.render.layout import Row, Tone, wrapped
from polaris_nl.snapshot import Answer

MOST = 400
"""Exchanges that are kept; the log of a run has everything."""

_LEADS = {"question": "? ", "refused": "! "}


@dataclass(frozen=True, slots=True)
class Entry:
    """A paragraph: an answer, an option, an event.

    Attributes:
        text: what it says; shown literally.
        lead: stands before it.
        tone: how it is meant.
    """

    text: str
    lead: str = "  "
    tone: Tone = ""


@dataclass(frozen=True, slots=True)
class Exchange:
    """Something the user said, with all that came of it.

    Attributes:
        said: the user's words, or "" where something came unasked.
        entries: the answer.
    """

    said: str = ""
    entries: tuple[Entry, ...] = ()


@dataclass(frozen=True)
class Transcript:
    """All exchanges, by ticket, oldest first; never changes."""

    exchanges: dict[int, Exchange] = field(default_factory=dict)
    tickets: int = 0

    def add(self, exchange: Exchange) -> Transcript:
        """With one more exchange; its ticket is `tickets` of the result."""
        ticket = self.tickets + 1
        kept = dict(list(self.exchanges.items())[-(MOST - 1) :])
        return Transcript({**kept, ticket: exchange}, ticket)

    def answer(self, ticket: int, entries: Iterable[Entry]) -> Transcript:
        """With an answer below what was said, however late it comes."""
        exchange = self.exchanges.get(ticket)
        if exchange is None:
            return self.add(Exchange("", tuple(entries)))
        more = replace(exchange, entries=(*exchange.entries, *entries))
        return replace(self, exchanges={**self.exchanges, ticket: more})

    def last_answer(self) -> str:
        """What was answered last, as one text."""
        for exchange in reversed(self.exchanges.values()):
            if exchange.entries:
                return " ".join(entry.text for entry in exchange.entries)
        return ""

    def rows(self, width: int) -> list[Row]:
        """As rows."""
        return [row for e in self.exchanges.values() for row in _exchange_rows(e, width)]


def answer_entries(answer: Answer) -> list[Entry]:
    """An answer of the session: its sentence, what can be chosen, and what could not be saved."""
    entries = [Entry(answer.say, _LEADS.get(answer.interpretation.outcome, "  "))]
    question = answer.interpretation.question
    if question is not None:
        entries += [Entry(o, f"    {n}. ") for n, o in enumerate(question.options, start=1)]
    if answer.failure:
        entries.append(Entry(answer.failure, "! ", "bad"))
    return entries


def event_entry(event: Event, seconds: float, glyphs: Glyphs) -> Entry | None:
    """An event of a run, with its time; None where it says nothing that a person wants to know."""
    if not event.text or event.severity == "debug" or isinstance(event, GoalConfirmed):
        return None
    sign = {"warning": "!", "error": glyphs.bad}.get(event.severity, " ")
    return Entry(event.text, f"{seconds:6.1f} s {sign} ", "bad" if sign != " " else "")


@lru_cache(maxsize=4 * MOST)
def _exchange_rows(exchange: Exchange, width: int) -> tuple[Row, ...]:
    rows = wrapped(exchange.said, width, "> ", "  ", "strong") if exchange.said else []
    for entry in exchange.entries:
        rows.extend(wrapped(entry.text, width, entry.lead, tone=entry.tone))
    return tuple(rows)
