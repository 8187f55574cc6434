"""`python -m bench.score_language`: how much of what people say is understood, and how rightly.

Reads the sentences beside the checkout (`tests/language/corpora.py` says where) and the project's own
suites. What isn't there is skipped, and said so.
"""

from __future__ import annotations

import argparse
import itertools
import json
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

from polaris_nl.language.understanding import Understanding
from polaris_nl.model.formula import Literal
from polaris_nl.model.world import World
from tests.language import corpora, corpora_judging, dialogues_reader
from tests.language.corpora import Annotated, Sentence
from tests.language.corpora_judging import Judgement, Reading
from tests.language.phenomena_judging import judge_all
from tests.language.phenomena_reader import all_phenomena

FORMS: Mapping[str, Callable[[str], str]] = {"typed": str, "speech": corpora.spoken}


@dataclass(frozen=True)
class Scored:
    """An annotated sentence with what came out in a form, and how right that is."""

    sentence: Annotated
    reading: Reading
    judgement: Judgement


@cache
def _language(sentence: Annotated, whole: bool) -> tuple[World, Understanding]:
    world = corpora.world_of(sentence, whole)
    return world, Understanding(world)


def scored(form: str = "typed", whole: bool = False) -> list[Scored]:
    """Reads the annotated sentences in a form, each in its own world or in the whole one."""
    found = []
    for sentence in corpora.annotated():
        world, language = _language(sentence, whole)
        reading = corpora_judging.read(language, FORMS[form](sentence.text))
        found.append(Scored(sentence, reading, corpora_judging.judge(sentence, world, reading)))
    return found


@dataclass(frozen=True)
class Scores:
    """What is counted over the annotated sentences: shares from 0 to 1, and of how many.

    Attributes:
        outcome: parsed, asked or refused as it should be; asking for a choice that the sentence
            leaves open (two of three, this way or that) counts as parsed.
        exact: of what is to be parsed, goal sets that are just as wanted; steps that only lead to a
            wanted goal (going there, finding it, taking it up) are passed over.
        precision, recall, f1: of single goals.
        order: of several steps, those that come one after the other as they should.
        conditions: of what has or gets conditionals, those where every goal waits for what it should.
        wrong: programs changed that should not be, or with a goal that nobody wanted, or that waits
            for something else.
        incomplete: programs changed rightly, but without all that was wanted.
        refused: of what is to be parsed, what is refused (or taken for a question or a command).
        asked: of what is to be parsed, what is asked about needlessly.
        accepted: of what is to be asked about or refused, what changes the program.
        counts: of how many each is a share.
    """

    outcome: float
    exact: float
    precision: float
    recall: float
    f1: float
    order: float
    conditions: float
    wrong: float
    incomplete: float
    refused: float
    asked: float
    accepted: float
    counts: Mapping[str, int]


def scores(results: Sequence[Scored]) -> Scores:
    """Counts."""
    to_parse = [r for r in results if r.sentence.outcome == "parse"]
    others = [r for r in results if r.sentence.outcome != "parse"]
    ordered = [r for r in to_parse if r.judgement.order is not None]
    told = [r for r in to_parse if r.judgement.conditions is not None]
    right, lost, extra = (
        sum(getattr(r.judgement, key) for r in results) for key in ("right", "lost", "extra")
    )
    precision, recall = _part(right, right + extra), _part(right, right + lost)
    return Scores(
        outcome=_share(results, lambda r: r.judgement.outcome),
        exact=_share(to_parse, lambda r: r.judgement.exact),
        precision=precision,
        recall=recall,
        f1=_part(2 * precision * recall, precision + recall),
        order=_share(ordered, lambda r: r.judgement.order is True),
        conditions=_share(told, lambda r: r.judgement.conditions is True),
        wrong=_share(results, lambda r: r.judgement.wrong),
        incomplete=_share(
            to_parse,
            lambda r: bool(r.reading.goals) and not r.judgement.wrong and r.judgement.lost > 0,
        ),
        refused=_share(to_parse, lambda r: r.reading.outcome in ("refuse", "command")),
        asked=_share(to_parse, lambda r: r.reading.outcome == "clarify" and not r.judgement.outcome),
        accepted=_share(others, lambda r: r.reading.outcome == "parse" and not r.judgement.outcome),
        counts={
            "sentences": len(results), "to parse": len(to_parse), "others": len(others),
            "ordered": len(ordered), "conditional": len(told), "goals": right + lost,
        },
    )  # fmt: skip


def _share(results: Sequence[Scored], holds: Callable[[Scored], bool]) -> float:
    return _part(sum(map(holds, results)), len(results))


def _part(some: float, whole: float) -> float:
    return some / whole if whole else 0.0


# The larger corpora, for which there are no goals to compare with


@dataclass(frozen=True)
class Larger:
    """What came out for a larger corpus, or a part of it, in a form.

    Attributes:
        counts: by outcome: applied, question, answer, command, refused.
        thing: of what was applied, how much carries the thing that the corpus says to where it ends;
            None where it says none. (Where it ends is not compared: the corpus has a simulator's
            name for it, and people say another.)
    """

    corpus: str
    form: str
    counts: Mapping[str, int]
    thing: float | None


@cache
def _corpus(name: str) -> tuple[list[Sentence], World, Understanding]:
    found = corpora.sentences(name)
    world = corpora.world_for(name, found)
    return found, world, Understanding(world)


def larger(name: str, form: str) -> tuple[Larger, list[tuple[Sentence, Reading]]]:
    """Reads a larger corpus in a form."""
    found, world, language = _corpus(name)
    readings = [(s, corpora_judging.read(language, FORMS[form](s.text))) for s in found]
    return _counted(name, form, readings, world), readings


def _counted(
    name: str, form: str, readings: Sequence[tuple[Sentence, Reading]], world: World
) -> Larger:
    counts: Counter[str] = Counter(reading.meant.outcome for _, reading in readings)
    known = [
        _right_thing(str(s.expected["object"]), r, world)
        for s, r in readings
        if r.meant.outcome == "applied" and "object" in s.expected
    ]
    return Larger(name, form, dict(counts), _part(sum(known), len(known)) if known else None)


_CARRIED = {"at": 0, "in": 0, "near": 0, "in-room": 0, "has": 1, "holding": 0}


def _right_thing(thing: str, reading: Reading, world: World) -> bool:
    """Whether every goal of the last step that carries something carries a thing of this name."""
    last = max((found.depth for found in reading.goals), default=0)
    goals = [found.goal for found in reading.goals if found.depth == last]
    carried = [
        world.entities[g.args[_CARRIED[g.predicate]]]
        for g in goals
        if isinstance(g, Literal) and g.predicate in _CARRIED
    ]
    wanted = set(thing.split("_"))
    names = [{w for n in (e.spoken, *e.synonyms) for w in n.split()} for e in carried]
    return bool(names) and all(wanted & words for words in names)


def by_pattern(readings: Sequence[tuple[Sentence, Reading]], world: World) -> list[Larger]:
    """A corpus whose sentences have patterns, pattern by pattern."""
    parts: dict[str, list[tuple[Sentence, Reading]]] = {}
    for sentence, reading in readings:
        if "pattern" in sentence.expected:
            parts.setdefault(sentence.expected["pattern"], []).append((sentence, reading))
    return [_counted(name, "typed", parts[name], world) for name in sorted(parts)]


def refusals(readings: Iterable[tuple[Sentence, Reading]]) -> tuple[Counter[str], Counter[str]]:
    """The reasons of refusals without what they quote, and the words that were not understood."""
    reasons: Counter[str] = Counter()
    unknown: Counter[str] = Counter()
    for _, reading in readings:
        refusal = reading.meant.refusal
        if refusal is None:
            continue
        if "You can say" in refusal.reason:
            reason = refusal.reason.partition(" You can say")[0]
        else:
            reason = refusal.reason.partition(" Did you mean")[0]
        reason = re.sub(r'"[^"]*"((, "[^"]*")* and "[^"]*")?', '"..."', reason)
        reasons[re.sub(r"(?<=called ).*", "...", reason)] += 1
        unknown.update(refusal.unknown)
    return reasons, unknown


# The project's own suites


def suites() -> tuple[dict[str, Counter[str]], list[str]]:
    """Verdicts of the project's own suites, developed and held out apart; and what was skipped."""
    found: dict[str, Counter[str]] = {}
    skipped = []
    for title, judged in (("phenomena", _phenomena), ("dialogues", _dialogues)):
        try:
            found.update(judged())
        except ValueError as fault:
            skipped.append(f"{title}: a case is not as it should be: {fault}")
    return found, skipped


def _phenomena() -> dict[str, Counter[str]]:
    found: dict[str, Counter[str]] = {}
    for verdict in judge_all(all_phenomena()):
        half = "held out" if verdict.case.held_out else "developed"
        found.setdefault(f"phenomena, {half}", Counter())[verdict.verdict] += 1
    return found


_AS_VERDICT = {"question": "asked", "refused": "refused"}


def _dialogues() -> dict[str, Counter[str]]:
    """Verdicts on turns; on dialogues by their first turn that isn't right, and by whether any is wrong.

    A turn after one that failed often fails with it, since the program is not what it should be.
    """
    found: dict[str, Counter[str]] = {}
    for folder, form in itertools.product(dialogues_reader.FOLDERS, dialogues_reader.FORMS):
        half = "held out" if folder.endswith("held_out") else "developed"
        for dialogue in dialogues_reader.all_dialogues(folder):
            turns = dialogues_reader.play(dialogue, form)
            verdicts = ["right" if t.ok else _AS_VERDICT.get(t.outcome, "wrong") for t in turns]
            found.setdefault(f"turns, {half}", Counter()).update(verdicts)
            first = next((v for v in verdicts if v != "right"), "right")
            found.setdefault(f"first failures, {half}", Counter())[first] += 1
            worst = "wrong" if "wrong" in verdicts else first
            found.setdefault(f"dialogues, {half}", Counter())[worst] += 1
    return found


# Printing

_ROWS = (
    ("outcome right", "outcome", "sentences", ">= 92 %"),
    ("goal sets exact", "exact", "to parse", ">= 85 %"),
    ("wrong edits", "wrong", "sentences", "<= 2 %"),
    ("precision of goals", "precision", "", ""),
    ("recall of goals", "recall", "goals", ""),
    ("F1 of goals", "f1", "", ""),
    ("step order right", "order", "ordered", ""),
    ("conditionals right", "conditions", "conditional", ""),
    ("edits that lack a goal", "incomplete", "to parse", ""),
    ("false refusals", "refused", "to parse", ""),
    ("needless questions", "asked", "to parse", ""),
    ("false acceptances", "accepted", "others", ""),
)


def _show_annotated(columns: Mapping[str, Scores]) -> None:
    _line("what", "aim", "of", *columns)
    for what, key, of, aim in _ROWS:
        first = next(iter(columns.values()))
        count = str(first.counts[of]) if of else ""
        _line(what, aim, count, *(f"{getattr(s, key) * 100:.1f} %" for s in columns.values()))
    apart = max(
        abs(getattr(columns["typed"], key) - getattr(columns["speech"], key))
        for key in ("outcome", "exact")
    )
    _line("typed and speech apart", "<= 4 points", "", f"{apart * 100:.1f}")


def _show_larger(rows: Iterable[Larger]) -> None:
    _line(
        "corpus", "form", "of", "applied", "asked", "answered", "refused", "command", "right thing"
    )
    for row in rows:
        total = sum(row.counts.values())
        shares = [
            f"{_part(row.counts.get(key, 0), total) * 100:.1f} %"
            for key in ("applied", "question", "answer", "refused", "command")
        ]
        thing = "" if row.thing is None else f"{row.thing * 100:.1f} %"
        _line(row.corpus, row.form, str(total), *shares, thing)


def _show_suites(found: Mapping[str, Counter[str]]) -> None:
    _line("suite", "", "of", "right", "asked", "refused", "wrong")
    for name, counts in found.items():
        total = sum(counts.values())
        shares = (counts[key] for key in ("right", "asked", "refused", "wrong"))
        _line(name, "", str(total), *(f"{_part(n, total) * 100:.1f} %" for n in shares))


def _show_failures(results: Mapping[str, Sequence[Scored]]) -> None:
    for form, found in results.items():
        for one in found:
            j = one.judgement
            if j.outcome and j.exact and j.order is not False:
                continue
            wanted = [_wanted(step) for step in one.sentence.steps]
            came = [
                f"{f.depth}: {f.goal}" + (f" when {_listed(f.when)}" if f.when else "")
                for f in one.reading.goals
            ]
            sys.stdout.write(
                f"\n{one.sentence.id} ({form}{', WRONG' if j.wrong else ''}): {one.sentence.text}\n"
                f"  wanted {one.sentence.outcome}: {'; '.join(wanted)}\n"
                f"  came {one.reading.meant.outcome}: {'; '.join(came) or one.reading.meant.say}\n"
            )


def _wanted(step: corpora.Step) -> str:
    goals = " ".join(
        f"{goal.number or 'all'} {goal.kind}: {goal.literal}" if goal.kind else
        " or ".join(map(str, (goal.literal, *goal.others)))
        for goal in step.goals
    )  # fmt: skip
    return f"{goals} when {_listed(step.when)}" if step.when else goals


def _listed(literals: Iterable[object]) -> str:
    return " ".join(sorted(map(str, literals)))


def _show_refusals(readings: Sequence[tuple[Sentence, Reading]], count: int) -> None:
    reasons, unknown = refusals(readings)
    sys.stdout.write("\nThe commonest reasons of refusals\n")
    for reason, times in reasons.most_common(min(count, 15)):
        sys.stdout.write(f"{times:6}  {reason}\n")
    sys.stdout.write(
        "\nThe commonest words that were not understood, with sentences that have them\n"
    )
    for word, times in unknown.most_common(count):
        having = [s.id for s, r in readings if r.meant.refusal and word in r.meant.refusal.unknown]
        sys.stdout.write(f"{times:6}  {word:20} {' '.join(having[:4])}\n")
    sys.stdout.write("\nRefused\n")
    refused = [(s, r) for s, r in readings if r.meant.outcome == "refused"]
    for sentence, _ in refused[:: max(len(refused) // count, 1)][:count]:
        sys.stdout.write(f"{sentence.id:14} {sentence.text}\n")


WIDTHS = (30, 12, 6)


def _line(*cells: str) -> None:
    widths = (*WIDTHS, *([12] * len(cells)))
    text = "".join(f"{c:<{w}}" for c, w in zip(cells, widths, strict=False))
    sys.stdout.write(text.rstrip() + "\n")
    sys.stdout.flush()


def main(arguments: Sequence[str] | None = None) -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(prog="python -m bench.score_language", description=__doc__)
    parser.add_argument("--json", action="store_true", help="one JSON value")
    parser.add_argument(
        "--failures", action="store_true", help="print annotated sentences that failed, and how"
    )
    parser.add_argument(
        "--refusals",
        type=int,
        default=0,
        metavar="N",
        help="print what is refused of the larger corpora",
    )
    parser.add_argument(
        "--patterns", action="store_true", help="count temporal patterns apart, too"
    )
    parser.add_argument("--annotated", action="store_true", help="only the annotated sentences")
    options = parser.parse_args(arguments)
    report: dict[str, Any] = {"skipped": []}
    missing = corpora.missing()
    if missing:
        report["skipped"].append(missing)
    else:
        _score_corpora(options, report)
    if not options.annotated:
        found, skipped = suites()
        report["skipped"] += skipped
        report["suites"] = {name: dict(counts) for name, counts in found.items()}
        if found and not options.json:
            sys.stdout.write("\n")
            _show_suites(found)
    if options.json:
        sys.stdout.write(json.dumps(report, indent=1) + "\n")
        return
    for reason in report["skipped"]:
        sys.stdout.write(f"Skipped. {reason}\n")


def _score_corpora(options: argparse.Namespace, report: dict[str, Any]) -> None:
    results = {form: scored(form) for form in FORMS}
    results["whole world"] = scored("typed", whole=True)
    columns = {form: scores(found) for form, found in results.items()}
    report["annotated"] = {form: asdict(s) for form, s in columns.items()}
    if not options.json:
        _show_annotated(columns)
    if options.failures and not options.json:
        _show_failures({form: results[form] for form in FORMS})
    if options.annotated:
        return
    rows, typed = [], []
    for corpus in corpora.LARGER:
        if not corpora.sentences(corpus):
            report["skipped"].append(f"There is no {corpus} among the corpora.")
            continue
        for form in FORMS:
            row, readings = larger(corpus, form)
            rows.append(row)
            if options.patterns and form == "typed":
                rows += by_pattern(readings, _corpus(corpus)[1])
            typed += readings if form == "typed" and corpus != "clinc_refusal" else []
    report["larger"] = [asdict(row) for row in rows]
    if not options.json:
        sys.stdout.write("\n")
        _show_larger(rows)
        if options.refusals:
            _show_refusals(typed, options.refusals)


if __name__ == "__main__":
    main()
