"""A program as a drawing for other tools: Mermaid flow charts and Graphviz digraphs."""

from __future__ import annotations

import re

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.model.text import listed
from polaris_nl.model.wording import Wording
from polaris_nl.render.glyphs import plain

_IN_MERMAID = {ord(c): f"#{ord(c)};" for c in '"#&<>`\\'}
_IN_DOT = {ord('"'): '\\"', ord("\\"): "\\\\"}


def mermaid(automaton: Automaton, wording: Wording) -> str:
    """A Mermaid flow chart, without an end of line."""
    ids = _ids(automaton)
    lines = ["flowchart TD"]
    for checkpoint in automaton.checkpoints.values():
        label = "<br/>".join(plain(x).translate(_IN_MERMAID) for x in _said(checkpoint, wording))
        shape = f'(["{label}"])' if checkpoint.id == START else f'["{label}"]'
        lines.append(f"  {ids[checkpoint.id]}{shape}")
    for transition in automaton.transitions.values():
        label = plain(_condition(automaton, transition, wording)).translate(_IN_MERMAID)
        line = "-.->" if automaton.is_else(transition.id) else "-->"
        arrow = f'{line}|"{label}"|' if label else line
        lines.append(f"  {ids[transition.source]} {arrow} {ids[transition.target]}")
    return "\n".join(lines)


def dot(automaton: Automaton, wording: Wording) -> str:
    """A Graphviz digraph, without an end of line."""
    ids = _ids(automaton)
    lines = ["digraph program {", "  node [shape=box];"]
    for checkpoint in automaton.checkpoints.values():
        label = "\\n".join(plain(x).translate(_IN_DOT) for x in _said(checkpoint, wording))
        shape = ", shape=ellipse" if checkpoint.id == START else ""
        lines.append(f'  {ids[checkpoint.id]} [label="{label}"{shape}];')
    for transition in automaton.transitions.values():
        label = plain(_condition(automaton, transition, wording)).translate(_IN_DOT)
        arrow = f"{ids[transition.source]} -> {ids[transition.target]}"
        style = ", style=dashed" if automaton.is_else(transition.id) else ""
        lines.append(f'  {arrow} [label="{label}"{style}];')
    return "\n".join([*lines, "}"])


def _ids(automaton: Automaton) -> dict[str, str]:
    """A plain word for each checkpoint: its id, where that is one such as c3."""
    ends = (end for t in automaton.transitions.values() for end in (t.source, t.target))
    known = dict.fromkeys((*automaton.checkpoints, *ends))
    return {
        checkpoint: checkpoint if re.fullmatch("c[0-9]+", checkpoint) else f"n{number}"
        for number, checkpoint in enumerate(known)
    }


def _said(checkpoint: Checkpoint, wording: Wording) -> list[str]:
    goals = [wording.goal(g) for g in checkpoint.goals]
    if checkpoint.action is not None:
        goals = [wording.action(checkpoint.action)]
    return [checkpoint.name, listed(goals)] if goals else [checkpoint.name]


def _condition(automaton: Automaton, transition: Transition, wording: Wording) -> str:
    if transition.on is not None:
        outcome = "it is done" if transition.on == "success" else "it can't be done"
        return listed([outcome, *map(wording.event, transition.when)])
    if transition.when:
        return listed([wording.event(x) for x in transition.when])
    return "otherwise" if automaton.is_else(transition.id) else ""
