"""The executor's core: pure steps from perception to commands and events (DESIGN section 5 points 8, 9).

Each action of the branching plan is sent as a goal, its effects. A goal is done when its literals
have been perceived for a while, whatever the robot reports. What the robot can put right by itself
(where it is, what is open) is left to its own planning of each goal; what it can't is a deviation.
Every phase has a deadline, and everything that is wrong with the robot itself ends the run at once.
docs/execution.md tells the phases, their deadlines, and what happens at each fault.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from polaris_nl.execution.acting import act, confirming, pursuing, sending
from polaris_nl.execution.backend import Command, Report
from polaris_nl.execution.deciding import decide, waiting
from polaris_nl.execution.deviating import deviate, deviating
from polaris_nl.execution.events import CommandGiven, Event, Replanned, RobotReported
from polaris_nl.execution.expectations import needed
from polaris_nl.execution.halting import halt, halting, stop, withdraw
from polaris_nl.execution.state import (
    TERMINAL,
    WITH_GOAL,
    ExecutorState,
    HumanCommand,
    Inputs,
    Phase,
    RunPlan,
)
from polaris_nl.execution.work import Work
from polaris_nl.model.text import listed, sentence


def step(
    run: RunPlan, state: ExecutorState, now: float, inputs: Inputs
) -> tuple[ExecutorState, tuple[Command, ...], tuple[Event, ...]]:
    """One step: from the state and what is perceived to the next state, commands and events.

    Pure: the same arguments give the same result. After a terminal phase nothing is commanded any
    more, and from `halting` on nothing that moves the robot. Where the next state has a `request`,
    the rest of a segment is to be planned anew, and the answer is to come with a later step's inputs.

    Args:
        run: what is carried out.
        state: the result of the step before.
        now: the time in seconds; should it run backwards, it is taken to stand still.
        inputs: what is perceived, reported, commanded and planned since then.
    """
    if state.phase in TERMINAL:
        return state, (), ()
    now = max(now, state.now)
    work = Work(run, now, inputs, replace(state, now=now))
    for report in inputs.reports:
        _take_report(work, report)
    for command in inputs.commands:
        _take_command(work, command)
    health = inputs.observation.health
    if not health.ready and work.state.phase != "halting":
        halt(work, health.words)
    for _ in range(len(run.automaton.checkpoints) + len(inputs.commands) + 4):
        # Some phases pass without time: reaching a checkpoint, taking an else.
        before = work.state
        if work.state.phase not in TERMINAL:
            _PHASES[work.state.phase](work)
        if work.state == before or work.commands:
            break
    return work.state, tuple(work.commands), tuple(work.events)


def _take_report(work: Work, report: Report) -> None:
    if report.goal != work.state.goal or work.state.phase not in WITH_GOAL:
        return  # Late news about a goal that is over.
    if report.kind == "replanned":
        _take_new_way(work, report)
        return
    work.events.append(
        RobotReported(time=work.now, goal=report.goal, report=report.kind, reason=report.reason)
    )
    if report.kind == "accepted" and work.state.phase == "sending":
        work.go("pursuing")
    elif report.kind == "rejected":
        halt(work, f"the robot refused to {work.action_words}{_because(report.reason)}")
    elif report.kind == "succeeded":
        if work.state.phase == "sending":
            work.go("pursuing")  # The acceptance was lost on the way.
        work.note(reported_at=work.now)
    elif report.kind in ("failed", "cancelled"):
        _given_up(work, report.reason)


def _given_up(work: Work, reason: str) -> None:
    """Has a goal that the robot gave up sent again, or looks at what is wrong with it."""
    if work.state.retries < work.run.settings.retries:
        work.go("idle", "the robot gave the goal up", retries=work.state.retries + 1)
        return
    action = work.state.action
    assert action is not None
    missing = tuple(
        x
        for x in needed(action, work.run.world.domain.operators[action.operator])
        if work.sees(x.negation)
    )
    if missing:
        # It isn't the robot's fault: the world isn't as the plan has it.
        work.note(retries=0)
        deviate(work, missing)
    else:
        halt(work, f"the robot couldn't {work.action_words}{_because(reason)}")


def _take_new_way(work: Work, report: Report) -> None:
    words = listed([work.run.wording.action(a) for a in report.after[:2]])
    more = " and so on" if len(report.after) > 2 else ""
    text = f"to {work.action_words}, I go another way: I {words}{more}" if words else ""
    work.events.append(
        Replanned(
            time=work.now,
            text=sentence(text),
            goal=report.goal,
            before=[str(a) for a in report.before],
            after=[str(a) for a in report.after],
            reason=sentence(report.reason),
        )
    )


def _take_command(work: Work, command: HumanCommand) -> None:
    literals = [str(x) for x in command.literals]
    work.events.append(
        CommandGiven(
            time=work.now,
            text=_answer(work, command),
            command=command.kind,
            literals=literals,
            source=command.source,
        )
    )
    if work.state.phase == "halting":
        return  # It ends already.
    if command.kind == "stop":
        stop(work)
    elif command.kind == "pause" and work.state.phase != "paused":
        withdraw(work)
        work.go("paused", "paused by a person")
    elif command.kind == "resume" and work.state.phase == "paused":
        work.go("idle", "resumed by a person", expected=(), observed=())
    elif command.kind == "happened":
        negations = {x.negation for x in command.literals}
        work.note(told=(work.state.told - negations) | set(command.literals))


def _answer(work: Work, command: HumanCommand) -> str:
    """What a person hears who commands the run; a stop is answered when all stands still."""
    phase = work.state.phase
    if command.kind == "happened" and command.literals:
        events = listed([work.run.wording.event(x) for x in command.literals])
        return sentence(f"you say that {events}")
    if command.kind == "pause" and phase not in ("paused", "halting"):
        return "I pause; say resume, and I go on."
    return "I go on." if command.kind == "resume" and phase == "paused" else ""


def _idle(work: Work) -> None:
    if work.state.segment:
        act(work)
    else:
        decide(work)


def _paused(work: Work) -> None:
    limit = work.run.settings.pause_s
    if limit is not None and work.elapsed > limit:
        halt(work, f"nobody said resume within {limit:g} seconds")


_PHASES: Mapping[Phase, Callable[[Work], None]] = {
    "idle": _idle,
    "sending": sending,
    "pursuing": pursuing,
    "confirming": confirming,
    "waiting": waiting,
    "deviating": deviating,
    "paused": _paused,
    "halting": halting,
}


def _because(reason: str) -> str:
    return f", because {reason}" if reason else ""
