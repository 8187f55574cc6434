"""How people say things: read from a file, with the world's names in their places, for the recogniser."""

from __future__ import annotations

import shutil
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from polaris_nl.language.grammar import load_grammar
from polaris_nl.language.phrases import MOST_SAID, SAID, recogniser_phrases
from polaris_nl.language.said import Open, read_said
from polaris_nl.model.world_file import load_world

from .reader import language_of


def test_names_are_left_open(tmp_path: Path) -> None:
    file = tmp_path / "said.txt"
    file.write_text("# people at home\n\ntake {the person} her {object}\nundo that\n")
    assert read_said(file) == (
        ("take", Open("person", whole=True), "her", Open("object", whole=False)),
        ("undo", "that"),
    )
    assert read_said(tmp_path / "none.txt") == ()


def test_each_request_comes_up_with_different_names_and_as_often(
    care_home_said: Counter[str],
) -> None:
    assert care_home_said["undo that"] == SAID
    taken = {text for text in care_home_said if text.startswith("take ") and " her " in text}
    assert len(taken) > SAID // 2
    assert any("miss green" in text for text in taken)
    assert any("mr brown" in text for text in taken)
    assert not any("{" in text for text in care_home_said)


@pytest.fixture
def care_home_said() -> Counter[str]:
    language = language_of("care-home")
    said = (
        ("take", Open("person", whole=True), "her", Open("object", whole=False)),
        ("undo", "that"),
    )
    phrases = recogniser_phrases(language.world, replace(language.grammar, said=said))
    return Counter(phrases[-2 * SAID :])


def test_a_domain_may_bring_its_own(tmp_path: Path) -> None:
    shipped = load_world("care-home").domain
    assert shipped.path is not None
    shutil.copy(shipped.path, tmp_path / "domain.pddl")
    (tmp_path / "said.txt").write_text("lunch for {the person} please\n")
    own = load_grammar(replace(shipped, path=tmp_path / "domain.pddl"))
    assert own.said == (("lunch", "for", Open("person", whole=True), "please"),)
    assert len(load_grammar(shipped).said) > 400


def test_many_requests_come_up_less_often_each() -> None:
    language = language_of("care-home")
    said = tuple((f"request{chr(97 + n % 26)}", "please") for n in range(2 * MOST_SAID // SAID))
    phrases = recogniser_phrases(language.world, replace(language.grammar, said=said))
    assert (
        sum(phrase.endswith(" please") and "request" in phrase for phrase in phrases) == MOST_SAID
    )
