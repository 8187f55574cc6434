"""`why`: why an action is there, what a checkpoint takes, why a goal can't be reached."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import dataclass
from typing import Any

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, apply
from polaris_nl.commands.common import opened, print_json, print_text
from polaris_nl.commands.plan import checkpoint_of
from polaris_nl.model.errors import PolarisError, UsageError
from polaris_nl.model.formula import Goal, parse_formula
from polaris_nl.model.text import listed, sentence
from polaris_nl.planning.forgone import earlier_place
from polaris_nl.planning.reasons import Reason, Reasons, Step
from polaris_nl.planning.result import BranchingPlan, Segment
from polaris_nl.render.explanation import branches_in_words, purpose_in_words, segment_in_words
from polaris_nl.render.program import numbered
from polaris_nl.session import Session


def run(arguments: Namespace) -> int:
    """Explains; 1 where what is asked about has no plan."""
    program, world = opened(arguments)
    with Session(world, program.automaton) as session:
        plan = session.planner.compile(program.automaton)
        asker = Asker(session, program.automaton, plan)
        if arguments.action is not None:
            found = asker.action(arguments.action)
        elif arguments.checkpoint is not None:
            found = asker.checkpoint(arguments.checkpoint)
        elif arguments.why_not is not None:
            found = asker.why_not(arguments.why_not)
        else:
            found = asker.whole()
    if arguments.json:
        print_json(found)
    else:
        print_text(found["text"])
        for repair in found.get("repairs", ()):
            print_text(repair, "Way out: ")
    return 0 if found["possible"] else 1


@dataclass(frozen=True)
class Asker:
    """Answers from a program and its plan."""

    session: Session
    automaton: Automaton
    plan: BranchingPlan

    def whole(self) -> dict[str, Any]:
        """What each branch does, or the first problem."""
        if self.plan.problems:
            return self._problem(self.plan.problems[0].checkpoint, self.plan)
        texts = branches_in_words(self.automaton, self.plan, self.session.wording)
        return {"text": " ".join(texts) or "The program is empty.", "possible": True}

    def checkpoint(self, name: str) -> dict[str, Any]:
        """What a checkpoint takes."""
        checkpoint = checkpoint_of(name, self.automaton)
        if checkpoint == START:
            return {"text": "The start is where every program begins.", "possible": True}
        segment = self.plan.segments.get(checkpoint)
        if segment is None:
            return self._problem(checkpoint, self.plan)
        goals = listed([self.session.wording.fact(g) for g in segment.goals])
        aim = sentence(f"the aim is that {goals}") if goals else "It has no goal of its own."
        text = f"{segment_in_words(segment, self.session.wording, self._when(segment))} {aim}"
        actions = [str(a) for a in segment.actions]
        return {"text": text, "possible": True, "checkpoint": checkpoint, "actions": actions}

    def action(self, number: int) -> dict[str, Any]:
        """What an action is for: the goals that it serves, and the chain from it to each."""
        segment, at = self._numbered(number)
        reasons = Reasons(self.plan, self.automaton, self.session.world)
        step = Step(segment.target, at)
        return {
            "text": purpose_in_words(reasons, step, self.session.wording),
            "possible": True,
            "action": str(segment.actions[at]),
            "checkpoint": segment.target,
            "reasons": [_link(r) for r in reasons.links(step)],
            "purposes": [
                {
                    "goal": str(p.goal),
                    "checkpoint": p.checkpoint,
                    "chain": [_link(r) for r in p.chain],
                }
                for p in reasons.purposes(step)
            ],
        }

    def why_not(self, text: str) -> dict[str, Any]:
        """Whether a goal could come last, and what keeps it from that."""
        goals = self._goals(text)
        at = self._last()
        asked = Checkpoint(self.automaton.fresh_checkpoint_id(), "asked", goals)
        onward = Transition(self.automaton.fresh_transition_id(), at, asked.id)
        tried = apply(self.automaton, AddCheckpoint(asked, onward))
        plan = self.session.planner.compile(tried)
        segment = plan.segments.get(asked.id)
        if segment is None:
            return self._forgone(goals, at, self._problem(asked.id, plan))
        steps = segment_in_words(segment, self.session.wording)
        count = len(segment.actions)
        more = f", in {count} more actions" if count > 1 else ""
        return {
            "text": f"It is possible {self._place(at)}{more}: {_lowered(steps)}",
            "possible": True,
            "actions": [str(a) for a in segment.actions],
        }

    def _forgone(self, goals: tuple[Goal, ...], at: str, problem: dict[str, Any]) -> dict[str, Any]:
        """The problem with the earlier place where the goals could still be met, if there is one."""
        found = earlier_place(self.session.planner, self.automaton, self.plan, goals, at)
        if found is None or found.checkpoint is None:
            return problem
        names = self.automaton.checkpoints
        lost = listed([f'"{names[c].name}"' for c in found.lost])
        but = f", but then I couldn't do {lost} any more" if lost else ""
        earlier = sentence(f"it could be done {self._place(found.checkpoint)}{but}")
        return {**problem, "text": f"{problem['text']} {earlier}", "earlier": found.checkpoint}

    def _place(self, checkpoint: str) -> str:
        if checkpoint == START:
            return "at the start"
        return f"after {self.automaton.checkpoints[checkpoint].name}"

    def _goals(self, text: str) -> tuple[Goal, ...]:
        if text.lstrip().startswith("("):
            return (parse_formula(text),)
        understanding = self.session.understanding
        meant, _ = understanding.interpret(text, Automaton())
        if not meant.edits:
            meant, _ = understanding.interpret(f"make sure that {text}", Automaton())
        goals = [g for e in meant.edits if isinstance(e, AddCheckpoint) for g in e.checkpoint.goals]
        if not goals:
            raise PolarisError(
                meant.say or f"I don't understand the goal {text!r}; say it another way."
            )
        return tuple(goals)

    def _problem(self, checkpoint: str | None, plan: BranchingPlan) -> dict[str, Any]:
        problem = plan.problem_at(checkpoint) if checkpoint else plan.problems[0]
        if problem is None:
            return {"text": "There is no plan for it.", "possible": False}
        return {
            "text": problem.text,
            "possible": False,
            "cause": problem.cause,
            "cores": [[str(x) for x in core] for core in problem.cores],
            "repairs": [repair.text for repair in problem.repairs],
        }

    def _when(self, segment: Segment) -> str:
        if not segment.when:
            return ""
        return f"once {listed([self.session.wording.event(x) for x in segment.when])}, "

    def _last(self) -> str:
        planned = [c for c in self.automaton.checkpoints if c == START or c in self.plan.segments]
        leaves = [c for c in planned if not self.automaton.outgoing(c)]
        return leaves[-1] if leaves else planned[-1]

    def _numbered(self, number: int) -> tuple[Segment, int]:
        found = numbered(self.plan, number)
        if found is not None:
            return self.plan.segments[found[0]], found[1]
        count = self.plan.action_count
        raise UsageError(
            f"There is no action {number}; the plan has {count}. See them with: polaris-nl plan"
        )


def _lowered(text: str) -> str:
    """A sentence as the rest of another one: "I" stays."""
    return text if text.split()[0] == "I" else f"{text[0].lower()}{text[1:]}"


def _link(reason: Reason) -> dict[str, Any]:
    return {
        "fact": str(reason.fact),
        "action": reason.needed_by and str(reason.needed_by),
        "checkpoint": reason.checkpoint,
    }
