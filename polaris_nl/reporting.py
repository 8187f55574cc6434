"""What a session reports: each utterance, change and plan as an event, kept for the logs of its runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from polaris_nl.automaton.edit_json import edit_json
from polaris_nl.automaton.edits import Edit
from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.events import (
    Edited,
    Event,
    Failed,
    Heard,
    Interpreted,
    Planned,
    Understood,
)
from polaris_nl.language.interpretation import Interpretation, Reading
from polaris_nl.past import Past
from polaris_nl.snapshot import Answer, Snapshot, answer_json


class Reporter:
    """Makes events and hands them on.

    Args:
        sink: is given every event, or None.
        now: the time in seconds since the epoch.
    """

    def __init__(self, sink: Callable[[Event], None] | None, now: Callable[[], float]) -> None:
        self.sink = sink or (lambda event: None)
        self._past = Past()
        self._now = now

    @property
    def past(self) -> tuple[Event, ...]:
        """What was heard, understood and changed so far."""
        return self._past.events()

    def heard(self, utterance: str, source: str, heard: Heard | None) -> None:
        """An utterance, and how it was heard, where it was spoken."""
        self._report(heard or Heard(time=self._now(), utterance=utterance, source=source))

    def interpreted(self, interpretation: Interpretation) -> None:
        """What an utterance was taken to mean, and what else it could have meant."""
        # Readings that differ in how they came about alone are no rivals.
        readings: dict[tuple[str, tuple[str, ...]], Reading] = {}
        for reading in interpretation.readings:
            readings.setdefault((reading.text, reading.why), reading)
        self._report(
            Interpreted(
                time=self._now(),
                utterance=interpretation.utterance,
                outcome=interpretation.outcome,
                readings=[
                    {"text": r.text, "score": r.score, "why": list(r.why)}
                    for r in readings.values()
                ],
            )
        )

    def understood(self, answer: Answer, program: Program) -> None:
        """What came of an utterance."""
        value = answer_json(answer, program)
        value.pop("program")
        self._report(
            Understood(
                time=self._now(),
                text=answer.say,
                utterance=answer.interpretation.utterance,
                outcome=answer.interpretation.outcome,
                interpretation=value,
                ms=answer.ms,
            )
        )

    def edited(self, label: str, revision: int, edits: Sequence[Edit], program: Program) -> None:
        """A change of the program."""
        self._report(
            Edited(
                time=self._now(),
                text=label,
                revision=revision,
                label=label,
                edits=[edit_json(e) for e in edits],
                program=program_json(program),
            )
        )

    def planned(self, snapshot: Snapshot) -> None:
        """The plan of a revision, or why there is none."""
        if snapshot.plan is None:
            self.failed(snapshot.failure, "planning")
            return
        from polaris_nl.planning.plan_json import plan_json

        plan = snapshot.plan
        self._report(
            Planned(
                time=self._now(),
                revision=snapshot.revision,
                status=plan.status,
                plan=plan_json(plan, snapshot.automaton),
                ms=plan.ms,
            )
        )

    def failed(self, text: str, what: str) -> None:
        """Something that didn't work, and what it was part of: `save`, `planning`."""
        self._report(Failed(time=self._now(), text=text, what=what))

    def _report(self, event: Event) -> None:
        self._past.add(event)
        self.sink(event)
