"""Requests as people would say them, written by those who knew the worlds and not the grammar.

Each stands with the program, question, answer or command that it asks for. They were read afterwards, and
what was missing in the grammar was added by kinds; what that is worth for other sentences is shown by the
part of the speech set that is set aside.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import pytest
import yaml

from bench.speech_meaning import Context, is_meant
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world

FOLDER = Path(__file__).parent / "requests"
FLOORS: Mapping[str, tuple[float, float]] = {
    "care": (0.92, 0.02),
    "hands-full": (0.92, 0.02),
    "visitors": (0.94, 0.02),
    "programmers": (0.92, 0.02),
    "organisers": (0.82, 0.01),
    "newcomers": (0.46, 0.01),
    "volunteers": (0.98, 0.007),
    "cooks": (0.98, 0.007),
    "regulars": (0.98, 0.005),
    "relatives": (0.965, 0.0),
    "kitchen": (0.96, 0.005),
    "head-nurses": (0.81, 0.045),
    "neighbours": (0.935, 0.015),
    "all-sorts": (0.96, 0.01),
    "parents": (0.95, 0.0),
    "assistant-users": (0.95, 0.005),
    "carers": (0.98, 0.005),
    "teenagers": (0.92, 0.02),
    "engineers": (0.92, 0.02),
    "night-nurses": (0.81, 0.035),
    "staff": (0.71, 0.025),
    "waiters": (0.72, 0.02),
    "planners": (0.74, 0.04),
    "grandparents": (0.79, 0.005),
    "editors": (0.53, 0.014),
    "talkers": (0.75, 0.0),
    "revisers": (0.62, 0.034),
}
"""For each file, the share that must be understood rightly, and that may be understood wrongly."""


@cache
def understanding(world: str) -> Understanding:
    return Understanding(load_world(world))


def outcome(context: Context, said: str, expected: str) -> str:
    _, meaning = context.understood(said)
    if is_meant(meaning, expected, said):
        return "right"
    return "wrong" if meaning.startswith(("start", "command")) else "refused or asked"


@pytest.mark.parametrize("name", FLOORS)
def test_requests_are_understood(name: str) -> None:
    found: Counter[str] = Counter()
    for group in yaml.safe_load((FOLDER / f"{name}.yaml").read_text(encoding="utf-8")):
        context = Context(understanding(group["world"]), tuple(group.get("after", ())))
        found.update(outcome(context, said, expected) for said, expected in group["say"].items())
    total, (right, wrong) = found.total(), FLOORS[name]
    assert total >= 150
    assert found["right"] >= right * total, found
    assert found["wrong"] <= wrong * total, found
