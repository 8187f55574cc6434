"""The executor's core: pure steps from perception to commands and events (DESIGN section 5 points 8, 9).

Each action of the branching plan is sent as a goal, its effects. A goal is done when its literals
have been perceived for a while, whatever the robot reports. Where an object isn't where the next
action needs it, the run deviates: it goes on if that is put right within the grace time, and halts
otherwise, saying what was expected and what was seen. What the robot can put right by itself (where
it is, what is open) is left to its own planning of each goal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from polaris_nl.automaton.automaton import Transition
from polaris_nl.execution.backend import (
    CancelGoal,
    Command,
    Report,
    SendGoal,
    StopRobot,
)
from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    Recovered,
    RobotReported,
    RunEnded,
    StateChanged,
    TransitionTaken,
    Waiting,
)
from polaris_nl.execution.expectations import kept_goals, needed_places, perceived_instead
from polaris_nl.execution.state import TERMINAL, ExecutorState, HumanCommand, Inputs, Phase, RunPlan
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import effects
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import listed, sentence


@dataclass(slots=True)
class _Step:
    """One step being made: the state so far, and what came of it."""

    run: RunPlan
    now: float
    inputs: Inputs
    state: ExecutorState
    commands: list[Command] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)

    def go(self, phase: Phase, reason: str = "", **changes: object) -> None:
        """Changes the phase."""
        before = self.state.phase
        self.state = replace(self.state, phase=phase, since=self.now, holding_since=None, **changes)  # type: ignore[arg-type]
        if before != phase:
            self.events.append(
                StateChanged(time=self.now, before=before, after=phase, reason=reason)
            )

    def sees(self, literal: Literal) -> bool:
        """Whether a literal is perceived."""
        return self.inputs.observation.holds(literal)

    def meets(self, transition: Transition) -> bool:
        """Whether a conditional is perceived, or a person said that it came true."""
        return all(x in self.state.told or self.sees(x) for x in transition.when)

    def denies(self, transition: Transition) -> bool:
        """Whether a conditional is known not to hold; what is unknown just now is not false."""
        return any(x not in self.state.told and self.sees(x.negation) for x in transition.when)

    @property
    def elapsed(self) -> float:
        """Seconds in the present phase."""
        return self.now - self.state.since


def step(
    run: RunPlan, state: ExecutorState, now: float, inputs: Inputs
) -> tuple[ExecutorState, tuple[Command, ...], tuple[Event, ...]]:
    """One step: from the state and what is perceived to the next state, commands and events.

    Pure: the same arguments give the same result. After a terminal phase nothing is commanded any
    more.

    Args:
        run: what is carried out.
        state: the result of the step before.
        now: the time in seconds; never less than in the step before.
        inputs: what is perceived, reported and commanded since then.
    """
    if state.phase in TERMINAL:
        return state, (), ()
    work = _Step(run, now, inputs, state)
    for report in inputs.reports:
        _take_report(work, report)
    for command in inputs.commands:
        _take_command(work, command)
    for _ in range(len(run.automaton.checkpoints) + len(inputs.commands) + 4):
        # Some phases pass without time: reaching a checkpoint, taking an else.
        before = work.state
        if work.state.phase not in TERMINAL:
            _PHASES[work.state.phase](work)
        if work.state == before or work.commands:
            break
    return work.state, tuple(work.commands), tuple(work.events)


def _take_report(work: _Step, report: Report) -> None:
    if report.goal != work.state.goal or work.state.phase not in (
        "sending",
        "pursuing",
        "confirming",
    ):
        return  # Late news about a goal that is over.
    work.events.append(
        RobotReported(time=work.now, goal=report.goal, report=report.kind, reason=report.reason)
    )
    if report.kind == "accepted" and work.state.phase == "sending":
        work.go("pursuing")
    elif report.kind == "rejected":
        _halt(work, f"the robot refused to {_action_words(work)}{_because(report.reason)}")
    elif report.kind == "succeeded":
        if work.state.phase == "sending":
            work.go("pursuing")  # The acceptance was lost on the way.
        work.state = replace(work.state, reported_at=work.now)
    elif report.kind in ("failed", "cancelled"):
        if work.state.retries >= work.run.settings.retries:
            _halt(work, f"the robot couldn't {_action_words(work)}{_because(report.reason)}")
        else:
            work.go("idle", "the robot gave the goal up", retries=work.state.retries + 1)


def _take_command(work: _Step, command: HumanCommand) -> None:
    if work.state.phase in TERMINAL:
        return
    literals = [str(x) for x in command.literals]
    work.events.append(
        CommandGiven(time=work.now, command=command.kind, literals=literals, source=command.source)
    )
    if command.kind == "stop":
        _end(work, "stopped", "You stopped the run.")
    elif command.kind == "pause" and work.state.phase != "paused":
        _cancel(work)
        work.commands.append(StopRobot())  # A robot that ignores the cancelling stands still, too.
        work.go("paused", "paused by a person")
    elif command.kind == "resume" and work.state.phase == "paused":
        work.go("idle", "resumed by a person")
    elif command.kind == "happened":
        negations = {x.negation for x in command.literals}
        work.state = replace(work.state, told=(work.state.told - negations) | set(command.literals))


# Phases


def _idle(work: _Step) -> None:
    """Decides what comes next: the next action of the segment, or a transition."""
    if not work.state.segment:
        _decide(work)
        return
    segment = work.run.plan.segments[work.state.segment]
    if work.state.done_actions >= len(segment.actions):
        _reach(work)
        return
    _next_action(work, segment.actions[work.state.done_actions])


def _decide(work: _Step) -> None:
    outgoing = work.run.automaton.outgoing(work.state.checkpoint)
    if not outgoing:
        _end(work, "done", "The program is done.")
        return
    labelled = [t for t in outgoing if t.when]
    holding = next((t for t in labelled if work.meets(t)), None)
    otherwise = next((t for t in outgoing if not t.when), None)
    if holding is not None:
        # It has to hold for a while, so that a flicker decides nothing.
        if work.state.held != holding.id or work.state.holding_since is None:
            work.state = replace(work.state, held=holding.id, holding_since=work.now)
        if work.now - (work.state.holding_since or 0.0) >= work.run.settings.condition_s:
            _take(work, holding, "its condition is perceived")
    elif otherwise is not None and all(work.denies(t) for t in labelled):
        reason = "no condition of its siblings is perceived" if labelled else ""
        _take(work, otherwise, reason)
    elif work.state.phase != "waiting":
        _start_waiting(work, labelled)
    else:
        work.state = replace(work.state, held="", holding_since=None)


def _start_waiting(work: _Step, labelled: Sequence[Transition]) -> None:
    words = [listed([work.run.wording.event(x) for x in t.when]) for t in labelled]
    work.go("waiting", held="")
    work.events.append(
        Waiting(
            time=work.now,
            text=sentence(f"I wait until {listed(words, 'or')}"),
            checkpoint=work.state.checkpoint,
            conditionals=[[str(x) for x in t.when] for t in labelled],
        )
    )


def _waiting(work: _Step) -> None:
    limit = work.run.settings.wait_s
    if limit is not None and work.elapsed > limit:
        labelled = [t for t in work.run.automaton.outgoing(work.state.checkpoint) if t.when]
        words = [listed([work.run.wording.event(x) for x in t.when]) for t in labelled]
        expected = tuple(x for t in labelled for x in t.when)
        _halt(
            work,
            f"I waited {limit:g} seconds, but it didn't happen that {listed(words, 'or')}",
            expected,
        )
        return
    _decide(work)


def _take(work: _Step, transition: Transition, reason: str) -> None:
    target = work.run.automaton.checkpoints[transition.target]
    if target.id not in work.run.plan.segments:
        problem = work.run.plan.problem_at(target.id)
        why = problem.text if problem else "it has no plan"
        _halt(work, f"{target.name} comes next, but can't be done. {why}")
        return
    events = listed([work.run.wording.event(x) for x in transition.when])
    text = f"{events}: on to {target.name}" if events else f"on to {target.name}"
    work.events.append(
        TransitionTaken(
            time=work.now,
            text=sentence(text),
            transition=transition.id,
            source=transition.source,
            target=transition.target,
            when=[str(x) for x in transition.when],
            reason=reason,
        )
    )
    told: frozenset[Literal] = frozenset()  # It has served; what follows is to be perceived.
    work.go("idle", segment=target.id, done_actions=0, retries=0, held="", expected=(), told=told)


def _next_action(work: _Step, action: Action) -> None:
    operator = work.run.world.domain.operators[action.operator]
    perceived = work.inputs.observation
    literals = effects(action, operator, perceived.state, work.run.world)
    if literals and all(work.sees(x) for x in literals):
        # Here, too, a flicker decides nothing.
        if work.state.holding_since is None:
            work.state = replace(work.state, holding_since=work.now)
        elif work.now - work.state.holding_since >= work.run.settings.confirm_s:
            _confirmed(work, action, 0.0, "it is so already")
        return
    missing = tuple(x for x in needed_places(action, operator) if not work.sees(x))
    if missing:
        _deviate(work, missing)
        return
    number = work.state.goal + 1
    segment = work.run.plan.segments[work.state.segment]
    work.commands.append(SendGoal(number, action, literals))
    work.events.append(
        GoalSent(
            time=work.now,
            text=sentence(f"I {work.run.wording.action(action)}"),
            goal=number,
            action=str(action),
            literals=[str(x) for x in literals],
            checkpoint=work.state.segment,
            plan=[str(a) for a in segment.actions[work.state.done_actions :]],
        )
    )
    work.go(
        "sending",
        goal=number,
        goal_literals=literals,
        reported_at=None,
        sent_at=work.now,
        expected=(),
    )


def _sending(work: _Step) -> None:
    if work.elapsed > work.run.settings.accept_s:
        _halt(work, f"the robot doesn't answer when asked to {_action_words(work)}")


def _pursuing(work: _Step) -> None:
    if all(work.sees(x) for x in work.state.goal_literals):
        work.go("confirming")
        return
    reported = work.state.reported_at
    if reported is not None and work.now - reported > work.run.settings.report_s:
        _cancel(work)
        _deviate(work, tuple(x for x in work.state.goal_literals if not work.sees(x)))
    elif work.now - work.state.sent_at > work.run.settings.goal_s:
        _halt(work, f"the robot took too long to {_action_words(work)}", work.state.goal_literals)


def _confirming(work: _Step) -> None:
    if not all(work.sees(x) for x in work.state.goal_literals):
        work.go("pursuing", "it doesn't hold any more")
    elif work.elapsed >= work.run.settings.confirm_s:
        segment = work.run.plan.segments[work.state.segment]
        action = segment.actions[work.state.done_actions]
        said = "succeeded" if work.state.reported_at is not None else ""
        _confirmed(work, action, work.now - work.state.sent_at, said)


def _confirmed(work: _Step, action: Action, seconds: float, reported: str) -> None:
    work.events.append(
        GoalConfirmed(
            time=work.now,
            goal=work.state.goal,
            action=str(action),
            seconds=round(seconds, 3),
            reported=reported,
        )
    )
    work.go("idle", done_actions=work.state.done_actions + 1, retries=0, goal_literals=())


def _reach(work: _Step) -> None:
    kept = kept_goals(work.run.plan.segments[work.state.segment], work.run.world)
    missing = tuple(x for x in kept if not work.sees(x))
    if missing:
        _deviate(work, missing)
        return
    checkpoint = work.run.automaton.checkpoints[work.state.segment]
    text = f"Reached {checkpoint.name}."
    work.events.append(
        CheckpointReached(time=work.now, text=text, checkpoint=checkpoint.id, name=checkpoint.name)
    )
    work.go(
        "idle", checkpoint=checkpoint.id, segment="", reached=(*work.state.reached, checkpoint.id)
    )


def _deviate(work: _Step, missing: tuple[Literal, ...]) -> None:
    if work.state.phase == "deviating":
        return
    observed = perceived_instead(missing, work.inputs.observation)
    words = listed([work.run.wording.fact(x) for x in missing])
    seen = listed([work.run.wording.fact(x) for x in observed]) or "nothing of it"
    grace = work.run.settings.grace_s
    work.events.append(
        Deviated(
            time=work.now,
            text=sentence(
                f"I expected that {words}, but I see {_that(seen)}; I give it {grace:g} seconds"
            ),
            expected=[str(x) for x in missing],
            observed=[str(x) for x in observed],
            grace_s=grace,
        )
    )
    work.go("deviating", expected=missing)


def _deviating(work: _Step) -> None:
    missing = tuple(x for x in work.state.expected if not work.sees(x))
    if not missing:
        words = listed([work.run.wording.fact(x) for x in work.state.expected])
        text = sentence(f"that is put right: {words}")
        expected = [str(x) for x in work.state.expected]
        work.events.append(
            Recovered(time=work.now, text=text, expected=expected, seconds=work.elapsed)
        )
        work.go("idle", "put right")
    elif work.elapsed >= work.run.settings.grace_s:
        words = listed([work.run.wording.fact(x) for x in missing])
        observed = perceived_instead(missing, work.inputs.observation)
        seen = listed([work.run.wording.fact(x) for x in observed]) or "nothing of it"
        _halt(work, f"I expected that {words}, but I see {_that(seen)}", missing)


def _paused(work: _Step) -> None:
    """Nothing happens until a person says so."""


_PHASES = {
    "idle": _idle,
    "sending": _sending,
    "pursuing": _pursuing,
    "confirming": _confirming,
    "waiting": _waiting,
    "deviating": _deviating,
    "paused": _paused,
}


# Ends


def _halt(work: _Step, reason: str, expected: Sequence[Literal] = ()) -> None:
    observed = perceived_instead(expected, work.inputs.observation)
    text = sentence(f"I halt: {reason}")
    work.events.append(
        Halted(
            time=work.now,
            text=text,
            reason=sentence(reason),
            expected=[str(x) for x in expected],
            observed=[str(x) for x in observed],
        )
    )
    _end(work, "halted", sentence(reason))


def _end(work: _Step, outcome: str, reason: str) -> None:
    if outcome != "done":
        _cancel(work)
        work.commands.append(StopRobot())
    names = [work.run.automaton.checkpoints[c].name for c in work.state.reached]
    work.events.append(
        RunEnded(time=work.now, text=reason, outcome=outcome, reason=reason, checkpoints=names)
    )
    work.go("done" if outcome == "done" else "halted", reason)


def _cancel(work: _Step) -> None:
    if work.state.phase in ("sending", "pursuing", "confirming"):
        work.commands.append(CancelGoal(work.state.goal))


def _action_words(work: _Step) -> str:
    segment = work.run.plan.segments.get(work.state.segment)
    if segment is None or work.state.done_actions >= len(segment.actions):
        return "go on"
    return work.run.wording.action(segment.actions[work.state.done_actions])


def _because(reason: str) -> str:
    return f", because {reason}" if reason else ""


def _that(seen: str) -> str:
    return seen if seen == "nothing of it" else f"that {seen}"
