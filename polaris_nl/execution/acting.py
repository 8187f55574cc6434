"""From the first action of a segment to its checkpoint: goals sent, pursued and confirmed by what is seen."""

from __future__ import annotations

from polaris_nl.execution.backend import SendGoal
from polaris_nl.execution.deviating import deviate
from polaris_nl.execution.events import CheckpointReached, GoalConfirmed, GoalSent, Skipped
from polaris_nl.execution.expectations import needed_places
from polaris_nl.execution.halting import halt, withdraw
from polaris_nl.execution.shortcuts import seen_shortcut
from polaris_nl.execution.work import Work
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import effects
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import listed, sentence

_NAMED = 3
"""Skipped actions that are named in a sentence; of more than that, only the number is said."""


def act(work: Work) -> None:
    """Decides what comes next in a segment: an action, what can be left out, or the checkpoint."""
    action = work.state.action
    if action is None:
        _reach(work)
        return
    operator = work.run.world.domain.operators[action.operator]
    literals = effects(action, operator, work.inputs.observation.state, work.run.world)
    saved = _saved(work, literals)
    if saved:
        if work.held_for(f"{saved} saved", work.run.settings.confirm_s):
            _skip(work, saved)
        return
    missing = tuple(x for x in needed_places(action, operator) if not work.sees(x))
    if missing:
        deviate(work, missing)
    else:
        _send(work, action, literals)


def sending(work: Work) -> None:
    """Waits for the robot to accept its goal."""
    if work.elapsed > work.run.settings.accept_s:
        halt(work, f"the robot doesn't answer when asked to {work.action_words}")


def pursuing(work: Work) -> None:
    """Waits for the goal to be perceived."""
    missing = tuple(x for x in work.state.goal_literals if not work.sees(x))
    reported = work.state.reported_at
    if not missing:
        work.go("confirming")
    elif reported is not None and work.now - reported > work.run.settings.report_s:
        withdraw(work)
        deviate(work, missing)
    elif work.now - work.state.sent_at > work.run.settings.goal_s:
        halt(work, f"the robot took too long to {work.action_words}", work.state.goal_literals)


def confirming(work: Work) -> None:
    """Waits until the goal has been perceived for long enough not to be a flicker."""
    if not all(map(work.sees, work.state.goal_literals)):
        work.go("pursuing", "it doesn't hold any more")
    elif work.elapsed >= work.run.settings.confirm_s:
        _confirm(work)


def _send(work: Work, action: Action, literals: tuple[Literal, ...]) -> None:
    number = work.state.goal + 1
    work.commands.append(SendGoal(number, action, literals))
    work.events.append(
        GoalSent(
            time=work.now,
            text=sentence(f"I {work.run.wording.action(action)}"),
            goal=number,
            action=str(action),
            literals=[str(x) for x in literals],
            checkpoint=work.state.segment,
            plan=[str(a) for a in work.state.actions[work.state.done_actions :]],
        )
    )
    work.go("sending", goal=number, goal_literals=literals, reported_at=None, sent_at=work.now)


def _confirm(work: Work) -> None:
    said = "succeeded" if work.state.reported_at is not None else ""
    work.events.append(
        GoalConfirmed(
            time=work.now,
            goal=work.state.goal,
            action=str(work.state.action),
            seconds=round(work.now - work.state.sent_at, 3),
            reported=said,
        )
    )
    _done(work, 1, work.state.goal_literals)


def _saved(work: Work, literals: tuple[Literal, ...]) -> int:
    """How many actions needn't be done, since what they are for is so already."""
    done = work.state.done_actions
    rest = work.state.actions[done:]
    saved = seen_shortcut(work.run.simulator, work.inputs.observation, rest, work.wanted)
    so_already = bool(literals) and all(map(work.sees, literals))
    return max(saved, int(so_already))


def _skip(work: Work, count: int) -> None:
    done = work.state.done_actions
    skipped = work.state.actions[done : done + count]
    state, world = work.inputs.observation.state, work.run.world
    made = dict.fromkeys(
        x
        for a in skipped
        for x in effects(a, world.domain.operators[a.operator], state, world)
        if work.sees(x)
    )
    words = [work.run.wording.action(a) for a in skipped]
    what = listed(words)
    if count > _NAMED:
        what = f"{words[0]}, nor do the {count - 1} steps after that"
    work.events.append(
        Skipped(
            time=work.now,
            text=sentence(f"it is so already, so I needn't {what}"),
            checkpoint=work.state.segment,
            actions=[str(a) for a in skipped],
            literals=[str(x) for x in made],
        )
    )
    _done(work, count, tuple(made))


def _done(work: Work, count: int, literals: tuple[Literal, ...]) -> None:
    """Goes on after some actions."""
    segment = work.run.plan.segments[work.state.segment]
    work.state = work.state.after_actions(count, literals, segment)
    work.go("idle")


def _reach(work: Work) -> None:
    segment = work.run.plan.segments[work.state.segment]
    missing = tuple(x for x in segment.goals if x not in work.state.served and not work.sees(x))
    if missing:
        deviate(work, missing)
        return
    checkpoint = work.run.automaton.checkpoints[work.state.segment]
    text = f"Reached {checkpoint.name}."
    work.events.append(
        CheckpointReached(time=work.now, text=text, checkpoint=checkpoint.id, name=checkpoint.name)
    )
    work.state = work.state.at_checkpoint(segment)
    work.go("idle")
