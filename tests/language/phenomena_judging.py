"""Says the wordings of the utterance suite and judges what comes of each."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.interpretation import Interpretation

from .phenomena_reader import PhenomenonCase, listed, world_of
from .phenomena_steps import described, same, tree_of
from .reader import Talk, in_form, language_of

VERDICTS = ("right", "asked", "refused", "wrong")
"""`wrong`: another program, a change where none was wanted, another command or another query, or a
command nobody gave that does harm. `asked` and `refused`: nothing happens, though something else than
this question or this refusal was wanted; an answer or a harmless command counts as `refused`.
"""
CHANGING = {"new", "undo", "redo", "run", "stop", "pause", "resume", "quit", "save", "load"}
"""Commands that do harm when nobody gave them."""


@dataclass(frozen=True)
class Verdict:
    """How a wording came out in a form, and why it isn't right."""

    case: PhenomenonCase
    wording: str
    form: str
    verdict: str
    why: str = ""


def judge(case: PhenomenonCase, wording: str, form: str) -> Verdict:
    """Says a wording in a form, after what is given, and compares what comes of it."""
    talk = Talk(language_of(case.world))
    for utterance in in_form(case.given, form):
        talk.say(utterance)
    before = talk.program
    (text,) = in_form([wording], form)
    verdict, why = _verdict(case, talk.say(text), before, talk.program)
    return Verdict(case, wording, form, verdict, why)


def judge_all(cases: Iterable[PhenomenonCase]) -> Iterator[Verdict]:
    """Every wording of some cases in each of its forms."""
    for case in cases:
        for wording, form in itertools.product(case.wordings, case.forms):
            yield judge(case, wording, form)


def tally(verdicts: Iterable[Verdict]) -> dict[str, Counter[str]]:
    """How many verdicts of each sort there are, phenomenon by phenomenon."""
    found: dict[str, Counter[str]] = {}
    for verdict in verdicts:
        found.setdefault(verdict.case.phenomenon, Counter())[verdict.verdict] += 1
    return found


def _verdict(
    case: PhenomenonCase, meant: Interpretation, before: Automaton, after: Automaton
) -> tuple[str, str]:
    heard = f"{meant.outcome}: {meant.say}"
    tree = tree_of(after, world_of(case.world))
    fits = tree is not None and any(same(program, tree) for program in case.programs)
    if meant.outcome == "applied":
        if "applied" in case.expect and fits:
            return "right", ""
        return "wrong", f"{heard} {described(tree)}"
    if after != before and "applied" in case.expect and meant.outcome == "question":
        return "asked", heard
    if after != before and not (case.wanted.get("partial") and meant.partial and fits):
        return "wrong", f"{heard} {described(tree)}"
    if meant.outcome in case.expect:
        return _detail(case.wanted, meant, heard)
    if meant.outcome == "question":
        return "asked", heard
    if meant.command in CHANGING:
        return "wrong", f"{meant.command}, {heard}"
    return "refused", heard


def _detail(wanted: Mapping[str, Any], meant: Interpretation, heard: str) -> tuple[str, str]:
    if meant.outcome == "question" and "options" in wanted:
        offered = meant.question.options if meant.question else ()
        if not _offers(wanted["options"], offered):
            return "asked", f"{heard} {offered}"
    if meant.outcome == "refused" and meant.refusal:
        named = {word for text in meant.refusal.unknown for word in text.lower().split()}
        missing = set(wanted.get("unknown", ())) - named
        if missing:
            return "refused", f"{heard} It does not name {', '.join(sorted(missing))}."
    if meant.command and meant.command not in listed(wanted.get("command", meant.command)):
        return "wrong", f"{meant.command}, {heard}"
    if meant.outcome == "answer" and "query" in wanted:
        query = meant.query
        found = {
            "kind": query and query.kind,
            "when": sorted(map(str, query.when)) if query else [],
            "entity": query and query.entity,
            "literal": str(query.literal) if query else "",
        }
        for key, value in wanted["query"].items():
            if found[key] != (sorted(value) if key == "when" else value):
                return "wrong", f"{heard} {key}: {found[key]}"
    return "right", ""


def _offers(wanted: Sequence[str], offered: Sequence[str]) -> bool:
    if len(wanted) != len(offered):
        return False
    return any(
        all(
            set(w.lower().split()) <= set(o.lower().split()) for w, o in zip(wanted, x, strict=True)
        )
        for x in itertools.permutations(offered)
    )
