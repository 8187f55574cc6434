"""What a session publishes: immutable snapshots of program and plan, and answers, with their JSON values."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edit_json import edit_json
from polaris_nl.automaton.program import Program, program_json
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.planning.result import BranchingPlan

Planning = OneOf["planning", "planned", "failed"]


@dataclass(frozen=True)
class Snapshot:
    """Program and plan at one moment; never changes.

    Attributes:
        revision: counts the changes of the program.
        plan: the newest plan there is; wholly of this revision only if `planning` is `planned`.
        planning: whether the plan of this revision is still being made; until it is there, the plan is
            an older one, or as much of the new one as there is.
        failure: why planning failed, or "".
        undoable, redoable: the labels of what can be undone and redone, the next last.
    """

    revision: int = 0
    automaton: Automaton = field(default_factory=Automaton)
    plan: BranchingPlan | None = None
    planning: Planning = "planning"
    failure: str = ""
    undoable: tuple[str, ...] = ()
    redoable: tuple[str, ...] = ()


@dataclass(frozen=True)
class Answer:
    """What came of one utterance.

    Attributes:
        interpretation: what it was taken to mean.
        say: what to answer, a sentence or two, the plan's news included.
        snapshot: program and plan after it.
        confirmed: the user just said yes to a run that was echoed before; the face may start it.
        failure: why the program could not be saved, or "".
        ms: from utterance to answer.
    """

    interpretation: Interpretation
    say: str
    snapshot: Snapshot
    confirmed: bool = False
    failure: str = ""
    ms: float = 0.0


def answer_json(answer: Answer, program: Program) -> dict[str, Any]:
    """The object that `say --json` and each line of `dialogue --json` print (DESIGN section 6)."""
    meant = answer.interpretation
    question, refusal = meant.question, meant.refusal
    value: dict[str, Any] = {
        "utterance": meant.utterance,
        "outcome": meant.outcome,
        "edits": [edit_json(edit) for edit in meant.edits],
        "say": answer.say,
        "command": meant.command,
        "question": None,
        "refusal": None,
        "program": program_json(program),
        "plan": plan_summary(answer.snapshot),
        "ms": round(answer.ms),
    }
    if question is not None:
        value["question"] = {"about": question.about, "options": list(question.options)}
    if refusal is not None:
        value["refusal"] = {"reason": refusal.reason, "unknown": list(refusal.unknown)}
    if meant.partial:
        value["partial"] = True
    return value


def plan_summary(snapshot: Snapshot) -> dict[str, Any]:
    """Status, omitted checkpoints and number of actions of a plan; `pending` without one."""
    plan = snapshot.plan
    if plan is None or snapshot.planning != "planned":
        return {"status": "pending", "omitted": [], "actions": 0}
    status = "pending" if plan.status == "undecided" else plan.status
    return {"status": status, "omitted": list(plan.omitted), "actions": plan.action_count}
