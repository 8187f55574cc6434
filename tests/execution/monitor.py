"""What must hold at each step of the executor's core, whatever happens, checked from the outside."""

from __future__ import annotations

from dataclasses import dataclass, field

from polaris_nl.automaton.program import parse_action
from polaris_nl.execution.backend import (
    CancelGoal,
    Command,
    Observation,
    RunStop,
    SendGoal,
    StopRobot,
    ZeroVelocity,
)
from polaris_nl.execution.events import (
    CheckpointReached,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    Replanned,
    RunEnded,
    Skipped,
    TransitionTaken,
)
from polaris_nl.execution.expectations import needed_places
from polaris_nl.execution.state import (
    TERMINAL,
    ExecutorState,
    Inputs,
)
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, applicable, effects
from polaris_nl.model.formula import Literal
from tests.execution.surroundings import Surroundings


@dataclass
class Monitor:
    """Checks each step against the rules, from the outside."""

    around: Surroundings
    active: int | None = None
    sent: int = 0
    paused: bool = False
    segment_from: int = 0
    plan: list[Action] = field(default_factory=list)
    done: int = 0
    segment: str = ""
    told: frozenset[Literal] = frozenset()
    ending: bool = False
    outcome: str = ""

    def check(
        self,
        before: ExecutorState,
        inputs: Inputs,
        commands: tuple[Command, ...],
        events: tuple[Event, ...],
    ) -> None:
        if before.phase in TERMINAL:
            assert (self.around.state, commands, events) == (before, (), ())
            return
        stopped = self._hear(inputs)
        for event in events:
            if isinstance(event, GoalConfirmed):
                self._check_confirmed(event)
            elif isinstance(event, TransitionTaken):
                self._check_transition(event, inputs)
            elif isinstance(event, CheckpointReached):
                self._check_reached(event, inputs.observation)
            elif isinstance(event, GoalSent):
                self._check_sent(event, inputs.observation)
            elif isinstance(event, Skipped):
                self._check_skipped(event, inputs.observation)
            elif isinstance(event, Replanned):
                self._check_replanned(event, inputs.observation)
        for command in commands:
            if isinstance(command, SendGoal):
                assert self.active is None, "two goals at once"
                assert command.goal > self.sent, "a number used twice"
                assert not any((self.paused, stopped, self.ending))
                self.active = self.sent = command.goal
            elif isinstance(command, CancelGoal):
                assert command.goal == self.sent
                self.active = None
        assert len([e for e in events if isinstance(e, GoalSent)]) == len(
            [c for c in commands if isinstance(c, SendGoal)]
        )
        self._check_end(stopped, commands, events)

    def _hear(self, inputs: Inputs) -> bool:
        """Takes note of reports and commands; returns whether a stop is among them."""
        over = ("failed", "cancelled", "rejected")
        if any(r.goal == self.active and r.kind in over for r in inputs.reports):
            self.active = None
        for command in inputs.commands:
            if command.kind in ("pause", "resume"):
                self.paused = command.kind == "pause"
            if command.kind == "happened":
                negations = {x.negation for x in command.literals}
                self.told = self.told - negations | set(command.literals)
            if command.kind == "stop":
                return True
        return False

    def _check_confirmed(self, event: GoalConfirmed) -> None:
        run, around = self.around.run, self.around
        action = self.plan[self.done]
        assert str(action) == event.action, "out of order"
        operator = run.world.domain.operators[action.operator]
        made = effects(action, operator, around.facts, run.world)
        assert around.perceived_for(made, run.settings.confirm_s), "not perceived long enough"
        self.done += 1
        self.active = None

    def _check_skipped(self, event: Skipped, observation: Observation) -> None:
        world = self.around.run.world
        skipped = self.plan[self.done : self.done + len(event.actions)]
        assert event.actions == [str(a) for a in skipped]
        self.done += len(skipped)
        rest, state = self.plan[self.done :], observation.state
        if len(skipped) == 1:
            operator = world.domain.operators[skipped[0].operator]
            made = effects(skipped[0], operator, state, world)
            if self.around.perceived_for(made, self.around.run.settings.confirm_s):
                return
        for action in rest:
            operator = world.domain.operators[action.operator]
            assert applicable(action, operator, state, world), "it was needed after all"
            state = after(action, operator, state, world)
        missed = [
            g for g in self.around.run.plan.segments[self.segment].goals if not state.holds(g)
        ]
        since = [o for _, o in self.around.seen[self.segment_from :]]
        assert all(any(o.holds(g) for o in since) for g in missed), "it was needed after all"

    def _check_replanned(self, event: Replanned, observation: Observation) -> None:
        assert self.active is None
        assert event.before == [str(a) for a in self.plan[self.done :]]
        self.plan = self.plan[: self.done] + [parse_action(a) for a in event.after]
        state, world = observation.state, self.around.run.world
        for action in self.plan[self.done :]:
            operator = world.domain.operators[action.operator]
            assert applicable(action, operator, state, world)
            state = after(action, operator, state, world)

    def _check_transition(self, event: TransitionTaken, inputs: Inputs) -> None:
        told = self.told
        see = inputs.observation.holds
        taken = self.around.run.automaton.transitions[event.transition]
        if taken.when:
            assert all(see(x) or x in told for x in taken.when)
        for rival in self.around.run.automaton.outgoing(taken.source):
            if rival.when and not taken.when:
                # Known to be false; what is unknown just now is not.
                assert any(see(x.negation) and x not in told for x in rival.when)
        assert self.segment == ""
        self.segment, self.done = taken.target, 0
        self.plan = list(self.around.run.plan.segments[taken.target].actions)
        self.segment_from = len(self.around.seen) - 1
        self.told = frozenset()

    def _check_reached(self, event: CheckpointReached, observation: Observation) -> None:
        segment = self.around.run.plan.segments[event.checkpoint]
        assert event.checkpoint == self.segment
        assert self.done == len(self.plan)
        since = [o for _, o in self.around.seen[self.segment_from :]]
        for goal in segment.goals:
            assert any(o.holds(goal) for o in since), f"{goal} was never perceived"
            if not any(goal in self._made(action) for action in self.plan):
                assert observation.holds(goal), f"{goal} isn't brought about, and doesn't hold now"
        self.segment = ""

    def _made(self, action: Action) -> tuple[Literal, ...]:
        world = self.around.run.world
        operator = world.domain.operators[action.operator]
        return effects(action, operator, world.initial, world)

    def _check_sent(self, event: GoalSent, observation: Observation) -> None:
        run, action = self.around.run, self.plan[self.done]
        assert str(action) == event.action
        needed = needed_places(action, run.world.domain.operators[action.operator])
        assert all(map(observation.holds, needed))

    def _check_end(
        self, stopped: bool, commands: tuple[Command, ...], events: tuple[Event, ...]
    ) -> None:
        phase = self.around.state.phase
        ends = [e for e in events if isinstance(e, RunEnded)]
        assert len(ends) == (phase in TERMINAL)
        halts = any(isinstance(e, Halted) for e in events)
        if stopped or halts:
            assert phase == "halting" or self.ending
        if phase == "halting" and not self.ending:
            # What was asked of the robot is withdrawn in the very step in which the end is decided.
            assert commands[-2:] == (ZeroVelocity(), StopRobot())
            self.ending, self.outcome = True, "halted" if halts else "stopped"
        elif self.ending:
            assert not halts
            assert all(isinstance(c, ZeroVelocity | RunStop) for c in commands)
        if phase == "halted":
            assert ends[0].outcome == self.outcome
        if phase in TERMINAL:
            assert self.active is None
