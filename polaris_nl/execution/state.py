"""What the executor is given and what it remembers: values only."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.execution.backend import Observation, Report
from polaris_nl.execution.events import Heard
from polaris_nl.execution.settings import RunSettings
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan, Segment
from polaris_nl.planning.simulate import Simulator

Phase = OneOf[
    "idle", "sending", "pursuing", "confirming", "waiting",
    "deviating", "paused", "halting", "halted", "done",
]  # fmt: skip
TERMINAL: tuple[Phase, ...] = ("halted", "done")
WITH_GOAL: tuple[Phase, ...] = ("sending", "pursuing", "confirming")
"""The phases in which the robot has a goal."""
Outcome = OneOf["", "done", "halted", "stopped"]


@dataclass(frozen=True, slots=True)
class HumanCommand:
    """What a person tells the run: `stop`, `pause`, `resume`, or `happened` with literals.

    Attributes:
        said: the words that it was told with, where there were any; for the log, and nothing that a run
            decides depends on them.
    """

    kind: OneOf["stop", "pause", "resume", "happened"]
    literals: tuple[Literal, ...] = ()
    source: str = "keyboard"
    said: Heard | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class PlanRequest:
    """The rest of a segment is to be planned anew; `number` tells answers apart."""

    number: int
    state: State
    goals: tuple[Literal, ...]


@dataclass(frozen=True, slots=True)
class PlanAnswer:
    """What came of a request: actions, or None where there is no way, or none was found in time."""

    number: int
    actions: tuple[Action, ...] | None


@dataclass(frozen=True, slots=True)
class Inputs:
    """What a step sees."""

    observation: Observation
    reports: tuple[Report, ...] = ()
    commands: tuple[HumanCommand, ...] = ()
    plans: tuple[PlanAnswer, ...] = ()


@dataclass(frozen=True)
class RunPlan:
    """What is carried out, and how: constant during a run."""

    automaton: Automaton
    plan: BranchingPlan
    world: World
    wording: Wording
    settings: RunSettings = RunSettings()

    @cached_property
    def simulator(self) -> Simulator:
        """Carries actions out in thought; remembers what it has grounded, and nothing else."""
        return Simulator(self.world)


@dataclass(frozen=True, slots=True)
class ExecutorState:
    """All that the executor remembers.

    Attributes:
        now: the time of the last step.
        checkpoint: the last one reached; reached: all of them, in order.
        segment: the checkpoint that is aimed for, or "".
        actions: the actions to it: as planned, or as planned anew.
        done_actions: how many of them are done.
        served: goals of the segment that have been perceived as brought about by its actions; they
            may have served since (a dish may be washed before the next one is brought).
        word: what the author's goals and conditionals say is so at this point; when it isn't, the
            robot doesn't find its own way around it.
        goal: the number of the current goal; numbers are never used twice.
        sent_at: when it was sent; reported_at: when the robot reported success, or None.
        since: when the phase began.
        holding_since: since when what is waited for has been perceived, or None.
        held: what `holding_since` is about.
        told: literals of conditionals that a person said came true.
        expected: what a deviation misses; observed: what is seen instead.
        deviations, replans: how often, in this segment.
        request: what is being planned; requests: how many there were, so that numbers are new.
        outcome, why: how the run ends, from the moment when that is decided.
        run_stopped: the robot's run-stop has been used.
    """

    phase: Phase = "idle"
    now: float = 0.0
    checkpoint: str = START
    reached: tuple[str, ...] = ()
    segment: str = ""
    actions: tuple[Action, ...] = ()
    done_actions: int = 0
    served: tuple[Literal, ...] = ()
    word: frozenset[Literal] = frozenset()
    goal: int = 0
    goal_literals: tuple[Literal, ...] = ()
    sent_at: float = 0.0
    reported_at: float | None = None
    retries: int = 0
    since: float = 0.0
    holding_since: float | None = None
    held: str = ""
    told: frozenset[Literal] = frozenset()
    expected: tuple[Literal, ...] = ()
    observed: tuple[Literal, ...] = ()
    deviations: int = 0
    replans: int = 0
    request: PlanRequest | None = None
    requests: int = 0
    outcome: Outcome = ""
    why: str = ""
    run_stopped: bool = False

    @property
    def action(self) -> Action | None:
        """The action whose turn it is, or None."""
        return self.actions[self.done_actions] if self.done_actions < len(self.actions) else None

    # What a run has come to, as the executor and the reader of an interrupted run's log have it.

    def towards(self, segment: Segment, when: Iterable[Literal]) -> ExecutorState:
        """On the way to a segment's checkpoint, after its transition was taken on a conditional."""
        none: frozenset[Literal] = frozenset()
        return replace(
            self,
            segment=segment.target,
            actions=segment.actions,
            done_actions=0,
            served=(),
            word=_said(self.word, when),
            told=none,  # It has served; what follows is to be perceived.
            retries=0,
            deviations=0,
            replans=0,
        )

    def after_actions(
        self, count: int, literals: Collection[Literal], segment: Segment
    ) -> ExecutorState:
        """After some actions; goals among what they were seen to bring about have been served."""
        negations = {x.negation for x in literals}
        served = [x for x in self.served if x not in negations]
        served += [x for x in segment.goals if x in literals and x not in served]
        done = self.done_actions + count
        return replace(self, done_actions=done, served=tuple(served), retries=0, goal_literals=())

    def on_another_way(self, actions: tuple[Action, ...]) -> ExecutorState:
        """With other actions from here to the end of the segment."""
        return replace(self, actions=self.actions[: self.done_actions] + actions, retries=0)

    def at_checkpoint(self, segment: Segment) -> ExecutorState:
        """At the end of a segment, where the author's goals have become what is so."""
        return replace(
            self,
            checkpoint=segment.target,
            reached=(*self.reached, segment.target),
            segment="",
            actions=(),
            done_actions=0,
            served=(),
            word=_said(self.word, segment.goals),
        )


def _said(word: frozenset[Literal], literals: Iterable[Literal]) -> frozenset[Literal]:
    """What has been said, and not taken back by saying the opposite."""
    said = frozenset(literals)
    return frozenset(x for x in word if x.negation not in said) | said
