"""`why`: why an action is there, what a checkpoint takes, why a goal can't be reached."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import dataclass
from typing import Any

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, apply
from polaris_nl.commands.common import opened, print_json, print_text
from polaris_nl.model.errors import PolarisError, UsageError, did_you_mean
from polaris_nl.model.formula import Goal, parse_formula
from polaris_nl.model.text import listed, sentence
from polaris_nl.planning.reasons import Reason, reasons_for
from polaris_nl.planning.result import BranchingPlan, Segment
from polaris_nl.render.explanation import branches_in_words, segment_in_words
from polaris_nl.render.program import first_numbers
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
        names = {c.name: c.id for c in self.automaton.checkpoints.values()}
        checkpoint = names.get(name, name)
        if checkpoint not in self.automaton.checkpoints:
            raise UsageError(f"There is no checkpoint {name}.{did_you_mean(name, names)}")
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
        """What an action is for: the later actions and goals that need what it brings about."""
        segment, at = self._numbered(number)
        action = segment.actions[at]
        wording = self.session.wording
        links = reasons_for(self.plan, self.automaton, self.session.world, segment, at)
        name = self.automaton.checkpoints[segment.target].name
        reasons = [f"it makes sure that {wording.fact(r.fact)}, {self._need(r)}" for r in links]
        why = listed(reasons) or f"it is on the way to {name}"
        return {
            "text": sentence(f"I {wording.action(action)} because {why}"),
            "possible": True,
            "action": str(action),
            "checkpoint": segment.target,
            "reasons": [
                {
                    "fact": str(r.fact),
                    "action": r.needed_by and str(r.needed_by),
                    "checkpoint": r.checkpoint,
                }
                for r in links
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
            return self._problem(asked.id, plan)
        where = "at the start" if at == START else f"after {self.automaton.checkpoints[at].name}"
        steps = segment_in_words(segment, self.session.wording)
        return {
            "text": f"It is possible {where}: {steps[0].lower() if steps[0] != 'I' else 'I'}{steps[1:]}",
            "possible": True,
            "actions": [str(a) for a in segment.actions],
        }

    def _need(self, reason: Reason) -> str:
        if reason.needed_by is None:
            return f"which is a goal of {self.automaton.checkpoints[reason.checkpoint].name}"
        return f"which I need to {self.session.wording.action(reason.needed_by)}"

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
        first = first_numbers(self.plan)
        for checkpoint, start in first.items():
            segment = self.plan.segments[checkpoint]
            if start <= number < start + len(segment.actions):
                return segment, number - start
        count = self.plan.action_count
        raise UsageError(
            f"There is no action {number}; the plan has {count}. See them with: polaris-nl plan"
        )
