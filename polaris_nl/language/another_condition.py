"""Another condition for what was asked for: "no, if he acknowledges it"."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import (
    Edit,
    SetConditional,
)
from polaris_nl.language.changes import (
    NOTHING_CHANGES,
)
from polaris_nl.language.conditions import condition_in
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.generate import steps_in_words
from polaris_nl.language.protocol import Language
from polaris_nl.language.structure import Step
from polaris_nl.model.errors import EditError


def another_condition(
    language: Language,
    words: Sequence[str],
    touched: Sequence[str],
    program: Automaton,
    dialogue: Dialogue,
) -> tuple[list[Edit], str] | None:
    """The edits that put another condition in the place of the closest one.

    Args:
        language: its other parts.
        words: what was said, without what stands around a correction.
        touched: the steps of the latest edit.
        program: the program.
        dialogue: what was said before.

    Returns:
        The edits and what they do in words; None where nothing of the kind was said.

    Raises:
        EditError: another step waits for the same already.
    """
    when = condition_in(language, words, (0, len(words)), dialogue.scope, introduced=True)
    if not when or not touched:
        return None
    way = [touched[-1], *(t.source for t in reversed(program.path(touched[-1])))]
    arrows = [t for c in (*reversed(touched), *way) if (t := program.incoming(c)) is not None]
    about = {a for x in when for a in x.args}
    close = [t for t in arrows if t.when and about & {a for x in t.when for a in x.args}]
    arrow = next(iter(close or [t for t in arrows if t.when] or arrows), None)
    if arrow is None:
        return None
    for beside in program.outgoing(arrow.source):
        if beside.id != arrow.id and beside.conditional == set(when):
            name = program.checkpoints[beside.target].name
            raise EditError(f"{name} is what happens then already; change or remove {name} first.")
    goals = program.checkpoints[arrow.target].goals
    if arrow.conditional == set(when):
        return [], NOTHING_CHANGES
    names = language.names.renamed(program, arrow.target, goals, when)
    say = steps_in_words([Step(goals, when, "condition")], language.wording)
    return [SetConditional(arrow.id, when), *names], say
