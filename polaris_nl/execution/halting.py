"""How runs end: nothing moves any more before one is over, and the robot's own stop is the last resort."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.execution.backend import CancelGoal, RunStop, StopRobot, ZeroVelocity
from polaris_nl.execution.events import Halted, RunEnded
from polaris_nl.execution.state import WITH_GOAL, Outcome
from polaris_nl.execution.work import Work
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import sentence


def halt(work: Work, reason: str, expected: Sequence[Literal] = ()) -> None:
    """Ends the run because something is wrong.

    Args:
        work: the step.
        reason: a clause for a person.
        expected: literals that were expected and aren't perceived.
    """
    observed = work.instead(expected)
    work.events.append(
        Halted(
            time=work.now,
            text=sentence(f"I halt: {reason}"),
            reason=sentence(reason),
            expected=[str(x) for x in expected],
            observed=[str(x) for x in observed],
        )
    )
    _stand_still(work, "halted", sentence(reason))


def stop(work: Work) -> None:
    """Ends the run because a person said so."""
    _stand_still(work, "stopped", "You stopped the run.")


def finish(work: Work) -> None:
    """Ends the run because all is done; the robot has no goal then."""
    work.note(outcome="done", why="The program is done.")
    _over(work)


def withdraw(work: Work) -> None:
    """Takes the present goal from the robot and stops it, so that one that ignores the first stops too."""
    if work.state.phase in WITH_GOAL:
        work.commands.append(CancelGoal(work.state.goal))
    work.commands += [ZeroVelocity(), StopRobot()]


def halting(work: Work) -> None:
    """Waits until the robot is seen to stand still; where it isn't, uses its run-stop."""
    moving = work.inputs.observation.moving
    settings = work.run.settings
    if work.elapsed > 0.0 and moving is False:
        _over(work)
    elif not work.state.run_stopped and work.elapsed >= settings.halt_s:
        # A robot that nothing is known of gets it too: it may be hearing while it isn't heard.
        work.commands += [ZeroVelocity(), RunStop()]
        work.note(run_stopped=True)
    elif work.elapsed >= 2 * settings.halt_s:
        _over(work)


def _stand_still(work: Work, outcome: Outcome, reason: str) -> None:
    withdraw(work)
    work.go("halting", reason, outcome=outcome, why=reason)


def _over(work: Work) -> None:
    outcome, reason = work.state.outcome, f"{work.state.why} {_last_words(work)}".strip()
    # Why it halts has been said; what is left to say is how it ended.
    text = _last_words(work) or "The run is over." if outcome == "halted" else reason
    names = [work.run.automaton.checkpoints[c].name for c in work.state.reached]
    work.events.append(
        RunEnded(time=work.now, text=text, outcome=outcome, reason=reason, checkpoints=names)
    )
    work.go("done" if outcome == "done" else "halted", reason, why=reason)


def _last_words(work: Work) -> str:
    """What a person has to know of how the robot was brought to stand still, or ""."""
    if work.state.phase != "halting" or not work.state.run_stopped:
        return ""
    moving = work.inputs.observation.moving
    if moving is None:
        return "I can't see whether the robot stands still: press its run-stop button."
    if moving:
        return "The robot still moves, whatever I send: press its run-stop button."
    return "The robot went on moving, so I used its run-stop; release it by hand."
