"""The composition root: an utterance or an edit comes in, a new snapshot of program and plan goes out.

The command line and the terminal application are two faces of one `Session`. The program changes in
the caller's thread, at once; planning happens in one thread of the session's own, newest revision
first, and what a newer revision makes stale is cancelled. Everything that happens is reported to
`sink` as an event, for the log.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from polaris_nl.answers import STILL_PLANNING, answer_query, change_in_words, run_in_words
from polaris_nl.answers.about_goals import possible_in_words, problem_of, with_goals
from polaris_nl.answers.contrast import CONTRASTS, answer_contrast
from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import Edit, ReplaceProgram
from polaris_nl.automaton.history import History
from polaris_nl.automaton.program import Program, read_program, write_program
from polaris_nl.execution.events import Event, Heard
from polaris_nl.language.interpretation import Command, Interpretation, Query, Refusal
from polaris_nl.model.errors import FileError, PolarisError
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.publishing import Publisher, Subscriber
from polaris_nl.replanning import Published, Replanner
from polaris_nl.reporting import Reporter
from polaris_nl.snapshot import Answer, Planning, Snapshot

if TYPE_CHECKING:
    from polaris_nl.language.dialogue import Dialogue
    from polaris_nl.language.understanding import Understanding
    from polaris_nl.planning.planner import Planner

PLAN_WAIT_S = 10.0
"""How long an answer waits for its plan before it says that planning goes on."""


class Session:
    """One user's work on one program in one world.

    Args:
        world: the world, with its domain.
        automaton: the program to start from.
        path: the program file that every change is saved to, or None.
        sink: is given every event.
        now: the time in seconds since the epoch.
    """

    def __init__(
        self,
        world: World,
        automaton: Automaton | None = None,
        path: Path | None = None,
        sink: Callable[[Event], None] | None = None,
        now: Callable[[], float] = time.time,
    ) -> None:
        self.world = world
        self.path = path
        self.running = False  # A face says so while it carries the program out.
        self._reporter = Reporter(sink, now)
        self._history = History(automaton or Automaton())
        self._dialogue: Dialogue | None = None
        self._run_echoed = False
        self._last_say = ""
        self._publisher = Publisher(Snapshot(automaton=self._history.present))
        self._replanner = Replanner(
            lambda automaton, stale: self.planner.drafts(automaton, stale), self._publish_plan
        )

    # The parts, each made when it is first needed: they take a second to load.

    @cached_property
    def understanding(self) -> Understanding:
        """The language side."""
        from polaris_nl.language.understanding import Understanding

        return Understanding(self.world)

    @cached_property
    def planner(self) -> Planner:
        """The planning side."""
        from polaris_nl.execution.durations_file import learned
        from polaris_nl.planning.planner import Planner

        return Planner(self.world, self.wording, learned(self.world))

    @property
    def wording(self) -> Wording:
        """How this world's things are put into words."""
        return self.understanding.wording

    @property
    def snapshot(self) -> Snapshot:
        """Program and plan now."""
        return self._publisher.snapshot

    @property
    def program(self) -> Program:
        """The program now, with the names of its domain and world."""
        return self.program_of(self._publisher.snapshot.automaton)

    def program_of(self, automaton: Automaton) -> Program:
        """An automaton as a program of this world."""
        return Program(automaton, self.world.domain.name, self.world.name)

    def subscribe(self, subscriber: Subscriber) -> Callable[[], None]:
        """Calls back with every new snapshot in order, from the caller's or the planning thread.

        Returns:
            A function that ends the subscription.
        """
        return self._publisher.subscribe(subscriber)

    def say(
        self,
        utterance: str,
        wait_s: float = PLAN_WAIT_S,
        source: str = "typed",
        heard: Heard | None = None,
    ) -> Answer:
        """Interprets an utterance, carries it out, and answers.

        Args:
            utterance: what the user said or typed.
            wait_s: how long to wait for the plan, in seconds; 0 answers with the plan pending.
            source: where it came from, for the log: `typed`, `voice`, a recording's name.
            heard: how it was heard, for the log, where it was spoken.
        """
        started = time.perf_counter()
        self._reporter.heard(utterance, source, heard)
        interpretation, self._dialogue = self._interpret(utterance)
        if interpretation.outcome == "refused":
            interpretation, self._dialogue = self.understanding.offered(
                interpretation, self._publisher.snapshot.automaton, self._dialogue
            )
        self._reporter.interpreted(interpretation)
        failure, confirmed = "", False
        was_echoed, self._run_echoed = self._run_echoed, False
        if was_echoed and interpretation.command == "run" and interpretation.agrees:
            interpretation = replace(interpretation, command="yes")  # "Yes, go ahead."
        before = self._publisher.snapshot
        if interpretation.edits:
            failure = self._do(interpretation.edits, interpretation.say)
        if interpretation.command is not None:
            interpretation, failure = self._carry_out(interpretation)
            confirmed = was_echoed and interpretation.command == "yes"
        snapshot = (
            self.wait(wait_s) if self._needs_plan(interpretation) else self._publisher.snapshot
        )
        text = self._words(interpretation, before, snapshot, was_echoed)
        if interpretation.command != "repeat":
            self._last_say = text
        ms = (time.perf_counter() - started) * 1000
        answer = Answer(interpretation, text, snapshot, confirmed, failure, ms)
        self._reporter.understood(answer, self.program_of(answer.snapshot.automaton))
        return answer

    def understood(self, utterance: str) -> Interpretation:
        """What an utterance would be taken to mean now. Changes nothing."""
        return self._interpret(utterance)[0]

    @property
    def awaits_yes(self) -> bool:
        """Whether a yes would start a run: what will happen was read out last."""
        return self._run_echoed

    def begin_again(self, automaton: Automaton) -> None:
        """Goes back to a program, as if nothing had been said: for utterances that are independent."""
        self._dialogue = None
        self._run_echoed = False
        if automaton != self._publisher.snapshot.automaton:
            self._do((ReplaceProgram(automaton),), "begin again")

    def edit(self, edits: Iterable[Edit], label: str) -> str:
        """Changes the program as one step that can be undone.

        Returns:
            Why the change could not be saved, or "".

        Raises:
            EditError: an edit doesn't fit; nothing has changed.
        """
        return self._do(tuple(edits), label)

    def undo(self) -> str | None:
        """Takes the last step back and returns its label, or None where there is nothing to undo."""
        return self._step(self._history.undo())[0]

    def redo(self) -> str | None:
        """Makes the last undone step again and returns its label, or None where there is nothing to redo."""
        return self._step(self._history.redo())[0]

    def wait(self, seconds: float = PLAN_WAIT_S) -> Snapshot:
        """Waits until the present revision is planned, or for some seconds; returns the snapshot then."""
        self._replanner.request(
            self._publisher.snapshot.revision, self._publisher.snapshot.automaton
        )
        return self._publisher.wait(lambda snapshot: snapshot.planning != "planning", seconds)

    @property
    def past(self) -> tuple[Event, ...]:
        """What was heard, understood and changed so far, for the log of a run that follows from it."""
        return self._reporter.past

    def report_to(self, sink: Callable[[Event], None]) -> None:
        """Reports everything that happens from now on to another sink."""
        self._reporter.sink = sink

    def warm_up(self) -> None:
        """Loads language and planner, so that the first sentence is answered as quickly as the second."""
        self.understanding.warm_up()
        self._replanner.request(
            self._publisher.snapshot.revision, self._publisher.snapshot.automaton
        )

    def close(self) -> None:
        """Ends the planning thread; a search that is under way is killed."""
        self._replanner.close()

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # Utterances

    def _interpret(self, utterance: str) -> tuple[Interpretation, Dialogue]:
        if self._dialogue is None:
            return self.understanding.interpret(utterance, self._publisher.snapshot.automaton)
        return self.understanding.interpret(
            utterance, self._publisher.snapshot.automaton, self._dialogue
        )

    def _carry_out(self, interpretation: Interpretation) -> tuple[Interpretation, str]:
        """Does what a command asks of the session; what it asks of the face is left to the face."""
        match interpretation.command:
            case "undo" | "redo" as command:
                history = self._history
                there = history.undo() if command == "undo" else history.redo()
                label, failure = self._step(there)
                done = "Undone" if command == "undo" else "Done again"
                said = f"There is nothing to {command}." if label is None else f"{done}: {label}"
                return replace(interpretation, say=said), failure
            case "new":
                if len(self._publisher.snapshot.automaton.checkpoints) == 1:
                    return replace(interpretation, say="The program is empty already."), ""
                failure = self._do((ReplaceProgram(Automaton()),), "start over")
                return replace(
                    interpretation, say='I\'ve dropped all of it; "undo" brings it back.'
                ), failure
            case "save" | "load" as command:
                return self._file_command(interpretation, command)
            case "run":
                self._run_echoed = True
            case "stop" | "pause" | "resume" as command if not self.running:
                said = f"Nothing is running, so there is nothing to {command}."
                return replace(interpretation, say=said), ""
        return interpretation, ""

    def _file_command(
        self, interpretation: Interpretation, command: Command
    ) -> tuple[Interpretation, str]:
        if self.path is None:
            reason = f"There is no program file to {command}: start with --program FILE."
            return _refused(interpretation, reason), ""
        try:
            if command == "save":
                write_program(self.program, self.path)
                return replace(interpretation, say=f"Saved to {self.path.name}."), ""
            loaded = read_program(self.path)
        except PolarisError as error:
            return _refused(interpretation, str(error)), ""
        self._do((ReplaceProgram(loaded.automaton),), f"load {self.path.name}", save=False)
        return replace(interpretation, say=f"Loaded from {self.path.name}."), ""

    def _needs_plan(self, interpretation: Interpretation) -> bool:
        changing = interpretation.command in (
            "undo",
            "redo",
            "new",
            "load",
            "run",
            "read-program",
            "read-plan",
            "status",
        )
        return bool(interpretation.edits) or changing or interpretation.query is not None

    def _words(
        self, interpretation: Interpretation, before: Snapshot, after: Snapshot, was_echoed: bool
    ) -> str:
        if interpretation.query is not None:
            if interpretation.say:
                return interpretation.say
            if interpretation.query.kind in ("able", "why-not"):
                return self._possible(interpretation.query, after)
            if interpretation.query.kind in CONTRASTS:
                return answer_contrast(
                    interpretation.query,
                    after.automaton,
                    after.plan,
                    lambda: self.planner,
                    self.wording,
                )
            back = self.understanding.read_back(after.automaton)
            return answer_query(
                interpretation.query, after.automaton, after.plan, self.world, self.wording, back
            )
        match interpretation.command:
            case "run":
                if after.planning != "planned":  # Nobody says yes to an older plan.
                    self._run_echoed = False
                    return f"I can't run it yet. {after.failure or STILL_PLANNING}"
                if after.plan is None or not after.plan.segments:
                    self._run_echoed = False
                back = self.understanding.read_back(after.automaton)
                return run_in_words(after.automaton, after.plan, back)
            case "read-program":
                return self.understanding.read_back(after.automaton)
            case "read-plan" | "status":
                query = Query("plan" if interpretation.command == "read-plan" else "status")
                back = self.understanding.read_back(after.automaton)
                return answer_query(
                    query, after.automaton, after.plan, self.world, self.wording, back
                )
            case "yes" if was_echoed:
                return "Starting."
            case "no" if was_echoed:
                return "All right, I won't start."
            case "repeat":
                return self._last_say or "I haven't said anything yet."
        if after.revision != before.revision:
            pending = after.planning == "planning"
            return change_in_words(
                interpretation.say, before.plan, after.plan, pending, after.failure
            )
        return interpretation.say

    def _possible(self, query: Query, now: Snapshot) -> str:
        """Whether goals could be reached after all else, or why not; tried without changing anything."""
        if now.plan is not None and (found := problem_of(query.goals, now.automaton, now.plan)):
            return found
        tried, asked = with_goals(query.goals, now.automaton, now.plan)
        plan = self.planner.compile(tried)
        return possible_in_words(query, tried, asked, plan, self.wording)

    # Changes

    def _do(self, edits: tuple[Edit, ...], label: str, save: bool = True) -> str:
        self._history = self._history.do(edits, label)
        self._publish_program(label, edits)
        return self._save() if save else ""

    def _step(self, history: History | None) -> tuple[str | None, str]:
        """Goes to a step of the history; returns its label, and why it could not be saved, or ""."""
        if history is None:
            return None, ""
        undone = len(history.past) < len(self._history.past)
        label = self._history.past[-1].label if undone else history.past[-1].label
        self._history = history
        self._publish_program(f"{'undo' if undone else 'redo'}: {label}", ())
        return label, self._save()

    def _save(self) -> str:
        if self.path is None:
            return ""
        try:
            write_program(self.program, self.path)
        except FileError as error:
            self._reporter.failed(str(error), "save")
            return str(error)
        return ""

    def _publish_program(self, label: str, edits: tuple[Edit, ...]) -> None:
        self._run_echoed = False  # The yes would be to another program than the one read out.
        snapshot = self._publisher.next_revision(
            automaton=self._history.present,
            planning="planning",
            failure="",
            undoable=tuple(step.label for step in self._history.past),
            redoable=tuple(step.label for step, _ in self._history.future),
        )
        self._reporter.edited(label, snapshot.revision, edits, self.program)
        self._publisher.tell()
        self._replanner.request(snapshot.revision, snapshot.automaton)

    # Plans, in the planning thread

    def _publish_plan(self, news: Published) -> None:
        state: Planning = "planning"
        if news.whole:
            state = "failed" if news.plan is None else "planned"
        snapshot = self._publisher.of_revision(
            news.revision, plan=news.plan, planning=state, failure=news.failure
        )
        if snapshot is None:
            return
        if news.whole:
            self._reporter.planned(snapshot)
        self._publisher.tell()


def _refused(interpretation: Interpretation, reason: str) -> Interpretation:
    return replace(
        interpretation, outcome="refused", command=None, say=reason, refusal=Refusal(reason)
    )
