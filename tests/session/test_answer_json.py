"""The answers as JSON (DESIGN section 6)."""

from __future__ import annotations

import json
from typing import Any

from jsonschema import Draft202012Validator

from polaris_nl.automaton.program import program_json
from polaris_nl.snapshot import answer_json
from tests.session.conftest import (
    CUP,
    Watched,
    add,
)

TEXTS = {"type": "array", "items": {"type": "string"}}


def exactly(optional: tuple[str, ...] = (), **properties: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": [k for k in properties if k not in optional],
        "additionalProperties": False,
    }


TEXT = {"type": "string"}
LITERAL = {"type": "string", "pattern": r"^\((not \()?[a-z][a-z0-9-]*( [a-z][a-z0-9-]*)*\)?\)$"}
LITERALS = {"type": "array", "items": LITERAL}
COMMANDS = (
    "new", "undo", "redo", "run", "stop", "pause", "resume", "yes", "no", "help", "read-program",
    "read-plan", "status", "repeat", "quit", "save", "load",
)  # fmt: skip
CONTRACT = exactly(
    ("partial",),
    utterance=TEXT,
    outcome={"enum": ["applied", "question", "answer", "command", "refused"]},
    edits={"type": "array", "items": {"type": "object"}},
    say=TEXT,
    command={"enum": [None, *COMMANDS]},
    question={"anyOf": [{"type": "null"}, exactly(about=TEXT, options=TEXTS)]},
    refusal={"anyOf": [{"type": "null"}, exactly(reason=TEXT, unknown=TEXTS)]},
    program=exactly(
        schema={"const": "polaris-program/1"},
        domain={"const": "caregiving"},
        world={"const": "care-home"},
        checkpoints={"type": "array", "items": exactly(id=TEXT, name=TEXT, goals=LITERALS)},
        transitions={
            "type": "array",
            "items": exactly(id=TEXT, **{"from": TEXT, "to": TEXT, "when": LITERALS}),
        },
    ),
    plan=exactly(
        status={"enum": ["ok", "partial", "underspecified", "invalid", "pending"]},
        omitted=TEXTS,
        actions={"type": "integer", "minimum": 0},
    ),
    partial={"const": True},
    ms={"type": "integer", "minimum": 0},
)
UTTERANCES = {
    "Tell the resident that lunch is ready.": "applied",
    "Once she acknowledges, bring a full tray to her table and then go home.": "applied",
    "Go to the room.": "question",
    "the first": "applied",
    "where is the tray?": "answer",
    "Go to the moon.": "refused",
    "save": "refused",
    "undo": "command",
    "run": "command",
    "yes": "command",
    "yes please": "command",
    "status": "command",
    "help": "command",
    "quit": "command",
}


def test_the_answers_json_is_what_the_contract_says(session: Watched) -> None:
    outcomes = {}
    for utterance in UTTERANCES:
        answer = session.say(utterance)
        value = json.loads(json.dumps(answer_json(answer, session.program)))
        Draft202012Validator(CONTRACT).validate(value)
        assert value["utterance"] == utterance
        assert value["say"] == answer.say != ""
        outcomes[utterance] = value["outcome"]
        assert (value["command"] is not None) == (value["outcome"] == "command")
        assert (value["question"] is not None) == (value["outcome"] == "question")
        assert (value["refusal"] is not None) == (value["outcome"] == "refused")
        assert bool(value["edits"]) == (value["outcome"] == "applied")
        assert value["program"] == program_json(session.program)
    assert outcomes == UTTERANCES


def test_the_json_tells_the_plans_status(session: Watched) -> None:
    def plan(utterance: str) -> dict[str, Any]:
        value: dict[str, Any] = answer_json(session.say(utterance), session.program)["plan"]
        return value

    assert plan("status") == {"status": "ok", "omitted": [], "actions": 0}
    assert plan(CUP)["actions"] > 0
    add(session, "(acknowledged lunchtime)")
    partial = plan("status")
    assert (partial["status"], partial["omitted"]) == ("partial", ["c2"])
    session.undo()
    add(session, "(at home desk)")
    assert plan("status") == {"status": "invalid", "omitted": ["c2"], "actions": 0}
