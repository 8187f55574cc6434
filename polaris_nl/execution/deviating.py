"""When the world isn't as the plan has it: somebody puts it right, another way is found, or the run halts.

Two kinds of deviation are told apart. What the author said (a goal that was reached, a conditional
whose transition was taken) and somebody has undone since is against the program: the robot doesn't
find its own way around that, it says so, gives people some time to put it right, and halts. That is
the paper's forgotten wait. Anything else is the world's affair, such as where a tray stood when the
plan was made: the rest of the segment is planned anew from what is perceived.
"""

from __future__ import annotations

from dataclasses import replace

from polaris_nl.execution.events import Deviated, Recovered, Replanned
from polaris_nl.execution.halting import halt
from polaris_nl.execution.state import PlanAnswer, PlanRequest
from polaris_nl.execution.work import Work
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.text import sentence

_NO_OTHER_WAY = "no other way"


def deviate(work: Work, missing: tuple[Literal, ...]) -> None:
    """Begins a deviation: what is missing isn't perceived, or isn't known."""
    if work.state.deviations >= work.run.settings.deviations:
        halt(work, f"things keep changing. {sentence(work.expected_and_seen(missing))}", missing)
        return
    observed = work.instead(missing)
    grace = work.run.settings.grace_s
    work.events.append(
        Deviated(
            time=work.now,
            text=sentence(f"{work.expected_and_seen(missing)}; I give it {grace:g} seconds"),
            expected=[str(x) for x in missing],
            observed=[str(x) for x in observed],
            grace_s=grace,
        )
    )
    work.go(
        "deviating",
        expected=missing,
        observed=observed,
        deviations=work.state.deviations + 1,
        held=_NO_OTHER_WAY if work.state.word.intersection(missing) else "",
    )


def deviating(work: Work) -> None:
    """Waits for the deviation to be put right, and looks for another way where that is allowed."""
    missing = tuple(x for x in work.state.expected if not work.sees(x))
    if not missing:
        _recovered(work)
        return
    for answer in work.inputs.plans:
        if _taken_up(work, answer):
            return
    if work.elapsed >= work.run.settings.grace_s:
        halt(work, f"{work.expected_and_seen(missing)}{_way_out(work, missing)}", missing)
    elif work.state.held != _NO_OTHER_WAY:
        _ask(work, missing)


def _recovered(work: Work) -> None:
    expected = work.state.expected
    text = sentence(f"that is put right: {work.facts(expected)}")
    literals = [str(x) for x in expected]
    work.events.append(Recovered(time=work.now, text=text, expected=literals, seconds=work.elapsed))
    work.go("idle", "put right", expected=(), observed=())


def _ask(work: Work, missing: tuple[Literal, ...]) -> None:
    """Asks for another way once the deviation has settled and all that it is about is known."""
    observation = work.inputs.observation
    if not all(map(observation.knows, missing)):
        return  # Not seen is not gone.
    state = observation.state
    if work.state.request is not None and work.state.request.state == state:
        return  # It is being planned, or was in vain.
    seen = " ".join(map(str, (*missing, *work.instead(missing))))
    settled = work.held_for(seen, work.run.settings.settle_s)
    spent = (
        work.state.replans >= work.run.settings.replans
        or work.state.retries >= work.run.settings.retries
    )
    if not settled or spent:
        return
    number = work.state.requests + 1
    work.note(
        request=PlanRequest(number, state, work.wanted),
        requests=number,
        replans=work.state.replans + 1,
    )


def _taken_up(work: Work, answer: PlanAnswer) -> bool:
    """Takes a new way; False where it is another request's, or there is none."""
    request = work.state.request
    if request is None or request.number != answer.number or answer.actions is None:
        return False
    if work.insisted is not None and work.insisted not in answer.actions:
        return False  # The same end by another way isn't what was asked for.
    if not _still_works(work, State(work.inputs.observation.state.facts), answer, request):
        return False
    old = work.state.actions[work.state.done_actions :]
    seen = work.instead(work.state.expected)
    where = work.facts(seen) if seen else work.facts([x.negation for x in work.state.expected])
    first = answer.actions[0] if answer.actions else None
    then = f"next I {work.run.wording.action(first)}" if first else "nothing is left to do"
    count = len(answer.actions)
    text = sentence(f"I plan anew, since {where}: {then}{_more(count - 1)}")
    work.events.append(
        Replanned(
            time=work.now,
            text=text,
            goal=work.state.goal,
            before=[str(a) for a in old],
            after=[str(a) for a in answer.actions],
            reason=sentence(work.expected_and_seen(work.state.expected)),
            segment=work.state.segment,
        )
    )
    # The same action once more is a retry, and those are counted.
    again = answer.actions[:1] == old[:1]
    retries = work.state.retries + 1 if again else 0
    work.state = replace(work.state.on_another_way(answer.actions), retries=retries)
    work.go("idle", "planned anew", expected=(), observed=())
    return True


def _still_works(work: Work, state: State, answer: PlanAnswer, request: PlanRequest) -> bool:
    """Whether a new way fits what is perceived by now; planning takes time, and the world goes on."""
    if state == request.state:
        return True
    steps = work.run.simulator.run(state, answer.actions or ())
    if steps is None:
        return False
    end = steps[-1].state if steps else state
    return all(map(end.holds, request.goals))


def _way_out(work: Work, missing: tuple[Literal, ...]) -> str:
    """What the author can do where somebody has undone what the program had brought about."""
    seen = [
        x for x in work.instead(missing) if work.run.world.domain.people_can_change(x.predicate)
    ]
    if not seen or not work.state.word.intersection(missing):
        return ""
    until = work.run.wording.event(seen[0])
    return f". Put that right and resume the run, or let the program wait until {until}"


def _more(count: int) -> str:
    if count <= 0:
        return ""
    return f", then {count} more action{'s' if count > 1 else ''}"
