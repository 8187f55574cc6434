"""At a checkpoint: which transition is taken, and when (DESIGN section 5 point 8)."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import Transition
from polaris_nl.execution.events import TransitionTaken, Waiting
from polaris_nl.execution.halting import finish, halt
from polaris_nl.execution.work import Work
from polaris_nl.model.text import listed, sentence


def decide(work: Work) -> None:
    """Takes a transition, begins to wait for one, or ends the run at a leaf."""
    outgoing = work.run.automaton.outgoing(work.state.checkpoint)
    if not outgoing:
        finish(work)
        return
    labelled = [t for t in outgoing if t.when]
    holding = next((t for t in labelled if work.meets(t)), None)
    otherwise = next((t for t in outgoing if not t.when), None)
    if holding is not None:
        # It has to hold for a while, so that a flicker decides nothing.
        if work.held_for(holding.id, work.run.settings.condition_s):
            _take(work, holding, "its condition is perceived")
    elif otherwise is not None and all(map(work.denies, labelled)):
        reason = "no condition of its siblings is perceived" if labelled else ""
        _take(work, otherwise, reason)
    elif work.state.phase != "waiting":
        _start_waiting(work, labelled)
    else:
        work.note(held="", holding_since=None)


def waiting(work: Work) -> None:
    """Waits for a conditional, up to a limit."""
    limit = work.run.settings.wait_s
    if limit is None or work.elapsed <= limit:
        decide(work)
        return
    labelled = [t for t in work.run.automaton.outgoing(work.state.checkpoint) if t.when]
    expected = tuple(x for t in labelled for x in t.when)
    doubtful = [x for x in expected if not work.inputs.observation.knows(x)]
    if doubtful:
        doubts = listed([f"whether {work.run.wording.event(x)}" for x in doubtful], "or")
        halt(work, f"I waited {limit:g} seconds and still can't tell {doubts}", expected)
    else:
        words = listed(_events(work, labelled), "or")
        halt(work, f"I waited {limit:g} seconds, but it didn't happen that {words}", expected)


def _events(work: Work, labelled: Sequence[Transition]) -> list[str]:
    return [listed([work.run.wording.event(x) for x in t.when]) for t in labelled]


def _start_waiting(work: Work, labelled: Sequence[Transition]) -> None:
    work.go("waiting")
    work.events.append(
        Waiting(
            time=work.now,
            text=sentence(f"I wait until {listed(_events(work, labelled), 'or')}"),
            checkpoint=work.state.checkpoint,
            conditionals=[[str(x) for x in t.when] for t in labelled],
        )
    )


def _take(work: Work, transition: Transition, reason: str) -> None:
    target = work.run.automaton.checkpoints[transition.target]
    segment = work.run.plan.segments.get(target.id)
    if segment is None:
        problem = work.run.plan.problem_at(target.id)
        why = problem.text if problem else "it has no plan"
        halt(work, f"{target.name} comes next, but can't be done. {why}")
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
    work.state = work.state.towards(segment, transition.when)
    work.go("idle")
