"""Says programs and edits back in plain English that can be said in again."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.language.structure import Step
from polaris_nl.model.formula import Goal, Literal
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording

EMPTY = "The program is empty: say what the robot should achieve."


def read_back(program: Automaton, wording: Wording) -> str:
    """A program in words, branch by branch."""
    sentences: list[str] = []
    _branch(program, START, wording, sentences, "first ")
    return " ".join(sentences) or EMPTY


def steps_in_words(steps: Sequence[Step], wording: Wording) -> str:
    """What was understood, in one sentence."""
    parts = []
    for number, step in enumerate(steps):
        done = goals_in_words(step.goals, wording)
        if step.when:
            event = listed([wording.event(x) for x in step.when])
            parts.append(f"once {event}, {done}" if step.goals else f"wait until {event}")
        elif step.role == "else":
            parts.append(f"otherwise {done}")
        else:
            parts.append(f"then {done}" if number else done)
    return sentence("; ".join(parts).replace("; then", ", then"))


def goals_in_words(goals: Sequence[Goal], wording: Wording) -> str:
    """Goals as an imperative: "fill the tray and bring it to the table"."""
    return listed([wording.goal(goal) for goal in goals]) or "do nothing"


def _branch(program: Automaton, at: str, wording: Wording, said: list[str], opening: str) -> None:
    """Says what comes after a checkpoint: straight on in one sentence, each way out in one of its own."""
    waiting: list[tuple[str, str]] = [(at, opening)]
    while waiting:
        at, opening = waiting.pop()
        outgoing = program.outgoing(at)
        if len(outgoing) == 1 and not outgoing[0].when:
            said.append(_step(program, outgoing[0], wording, opening))
            waiting.append((outgoing[0].target, "then "))
            continue
        ways = sorted(outgoing, key=lambda t: not t.when)
        name = program.checkpoints[at].name
        for number, transition in enumerate(ways):
            where = f"after {name}, " if number and at != START else ""
            rest: list[str] = []
            _branch(program, transition.target, wording, rest, "then ")
            lead = f"{where}otherwise " if not transition.when else where
            said.append(_step(program, transition, wording, lead))
            said.extend(rest)


def _step(program: Automaton, transition: Transition, wording: Wording, opening: str) -> str:
    checkpoint = program.checkpoints[transition.target]
    done = _checkpoint(checkpoint, wording)
    if not transition.when:
        return sentence(f"{opening}{done}")
    event = _events(transition.when, wording)
    opening = "" if opening == "then " else opening
    if not checkpoint.goals and checkpoint.action is None:
        return sentence(f"{opening}wait until {event}")
    return sentence(f"{opening}once {event}, {done}")


def _checkpoint(checkpoint: Checkpoint, wording: Wording) -> str:
    if checkpoint.action is not None:
        return wording.action(checkpoint.action)
    return goals_in_words(checkpoint.goals, wording)


def _events(when: Sequence[Literal], wording: Wording) -> str:
    return listed([wording.event(x) for x in when])
