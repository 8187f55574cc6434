"""`python -m bench.score_speech`: how well speech is understood, on the project's own speech set.

| column | share of |
|---|---|
| words | sentences heard word for word (the recogniser alone) |
| program | sentences that led to the right program, question, answer or command |
| as typed | the same, of the sentences that are understood rightly when typed |
| wrong | sentences that led to a program or command that was not meant, and weren't questioned or refused |
| foreign | sentences meant for somebody else that were taken for the robot's |
| heard | how many of the former and of the latter, in the voices that say them |

"Told the list" is Polaris NL whose phrases are the very sentences of the part that it is scored with: a bound
for phrases that have to generalise, and what tables of closed lists compare with. The last system hears again
with Whisper what isn't sure, and is left out where that isn't installed.
Settings were chosen by the set's first part; the part that is set aside has a table of its own.
`--some N` scores every N-th sentence; `--only CONDITION` one condition; `--misses` lists what went wrong.
"""

from __future__ import annotations

import argparse
import itertools
import multiprocessing
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache

from bench.speech_audio import CONDITIONS, PARTS, Sentence, audio, foreign, sentences
from bench.speech_decoding import Decodings, Opinions, cut
from bench.speech_meaning import Remembered, is_meant
from bench.speech_voices import VOICES, voices_of
from polaris_nl.hands_free.phrases import spoken_names
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world
from polaris_nl.speech.activity import SileroActivity
from polaris_nl.speech.hearing import Utterance, Ways, utterance
from polaris_nl.speech.models import NARROW, WIDE, model_folder
from polaris_nl.speech.recogniser import UNKNOWN, Spoken
from polaris_nl.speech.repair import Repairer
from polaris_nl.speech.second import heard_again, wants_second
from polaris_nl.speech.vosk_recogniser import ALTERNATIVES, VoskModel, VoskRecogniser
from polaris_nl.speech.whisper_recogniser import is_installed

WORLDS = ("care-home", "dinner-party")
SEARCHES = {"wide": WIDE, "narrow": NARROW}
SYSTEMS = ("free Vosk", "Vosk, phrases", "told the list", "Polaris NL", "with Whisper")
FREE, PHRASES, TOLD, ALONE, _ = SYSTEMS


@dataclass(frozen=True, slots=True)
class Task:
    """One sentence in one voice and one condition."""

    sentence: Sentence
    world: str
    voice: str
    condition: str


@dataclass(frozen=True, slots=True)
class Score:
    """What came of one task in one system."""

    task: Task
    system: str
    heard: str
    meaning: str
    right: bool
    typed_right: bool
    exact: bool
    wrong: bool
    free: str = ""
    note: str = ""


@cache
def _understanding(world: str) -> Understanding:
    return Understanding(load_world(world))


@cache
def _model(search: str) -> VoskModel:
    return VoskModel(model_folder(), SEARCHES[search])


@cache
def _decodings(world: str, search: str, part: str = "") -> Decodings:
    """What is heard with a world's phrases, or with a part's own sentences there; freely without a world."""
    phrases = _understanding(world).phrases() if world else None
    if part:
        phrases = sorted({s.text for s in sentences(part) if s.world == world})
    return Decodings(
        (phrases, sorted(SEARCHES[search].items()), ALTERNATIVES),
        lambda: VoskRecogniser(_model(search), phrases).decoder(),
    )


@cache
def _opinions(world: str) -> Opinions:
    understanding = _understanding(world)
    return Opinions(spoken_names(understanding), understanding.phrases())


@cache
def _ways(world: str) -> Ways:
    words = {word for phrase in _understanding(world).phrases() for word in phrase.split()}
    return Ways(repairer=Repairer(words))


@cache
def _activity() -> SileroActivity:
    return SileroActivity()


@cache
def _context(world: str, after: tuple[str, ...]) -> Remembered:
    return Remembered(world, after)


def _pieces(world: str, sounds: Sequence[bytes], part: str = "") -> list[Spoken]:
    found = []
    for sound in sounds:
        phrased = _decodings(world, "wide", part).hear(sound)
        free = _decodings("", "narrow").hear(sound)
        if phrased.texts:
            found.append(Spoken.of(phrased, free, sound))
    return found


def _plain(world: str, sounds: Sequence[bytes], context: Remembered) -> Utterance:
    heard = [_decodings(world, "narrow").hear(sound) for sound in sounds]
    text = ". ".join(found.texts[0] for found in heard if found.texts)
    return Utterance(text, bool(text) and UNKNOWN not in text and context.weigh(text) is not None)


def _hear(system: str, task: Task, sounds: Sequence[bytes], context: Remembered) -> Utterance:
    if system in (FREE, PHRASES):
        return _plain(task.world if system == PHRASES else "", sounds, context)
    pieces = _pieces(task.world, sounds, task.sentence.part if system == TOLD else "")
    ways = _ways(task.world)
    first = utterance(pieces, context.weigh, ways, context.meaning)
    if system in (TOLD, ALONE) or not wants_second(first, pieces):
        return first
    opinions = [_opinions(task.world).opinion(piece.audio) for piece in pieces]
    return heard_again(first, pieces, opinions, context.weigh, ways, context.meaning)


def score(order: tuple[Task, tuple[str, ...]]) -> list[Score]:
    """What each system makes of a sentence."""
    task, systems = order
    sentence = task.sentence
    sounds = cut(audio(sentence.text, task.voice, task.condition), _activity())
    context = _context(task.world, sentence.after)
    typed_right = is_meant(context.meaning(sentence.text), sentence.expect, sentence.text)
    return [
        _scored(task, system, _hear(system, task, sounds, context), context, typed_right)
        for system in systems
    ]


def _scored(
    task: Task, system: str, said: Utterance, context: Remembered, typed_right: bool
) -> Score:
    meaning = context.meaning(said.text) if said.accepted else "refused"
    if said.doubts:
        meaning = f"question: {', '.join(said.doubts)}"
    right = is_meant(meaning, task.sentence.expect, task.sentence.text)
    note = f" ({said.why_not})" if said.why_not else f" <- {said.repaired}" * bool(said.repaired)
    return Score(
        task=task,
        system=system,
        heard=said.text,
        meaning=meaning,
        right=right,
        typed_right=typed_right,
        exact=said.text.replace(". ", " ").replace("mister", "mr") == task.sentence.text,
        wrong=meaning.startswith(("start", "command")) and not right,
        free=said.free,
        note=note,
    )


def tasks(part: str, some: int, conditions: Sequence[str], voices: Sequence[str]) -> Iterator[Task]:
    """Everything of a part that is to be heard: clean in all its voices, with noise in one, taking turns."""
    for condition in conditions:
        turn = CONDITIONS.index(condition)
        for number, sentence in enumerate((*sentences(part), *foreign(part))):
            if number % some:
                continue
            said_by = voices_of(sentence.text)
            taking_turns = said_by[(number + turn) % len(said_by)]
            world = sentence.world or WORLDS[number // some % 2]
            for voice in said_by:
                if voice in voices and (condition == "clean" or voice == taking_turns):
                    yield Task(sentence, world, voice, condition)


def _percent(part: int, whole: int) -> str:
    return f"{100 * part / whole:5.1f}" if whole else "    -"


def table(scores: Sequence[Score], conditions: Sequence[str], systems: Sequence[str]) -> None:
    """Prints the shares, a line for each condition and system, and how many sentences they are of."""
    said = len({s.task.sentence for s in scores if s.task.sentence.world})
    more = len({s.task.sentence for s in scores if not s.task.sentence.world})
    part = scores[0].task.sentence.part
    sys.stdout.write(f"{part}: {said} sentences to the robot, {more} to others\n")
    head = ("condition", "system", "words", "program", "as typed", "wrong", "foreign", "heard")
    sys.stdout.write("{:<15} {:<14} {:>7} {:>9} {:>9} {:>7} {:>8} {:>9}\n".format(*head))
    for condition in (*conditions, *(("all",) if len(conditions) > 1 else ())):
        for system in systems:
            own = [
                s for s in scores
                if s.system == system and condition in (s.task.condition, "all")
            ]  # fmt: skip
            meant = [s for s in own if s.task.sentence.world]
            others = [s for s in own if not s.task.sentence.world]
            typed = [s for s in meant if s.typed_right]
            cells = (
                _percent(sum(s.exact for s in meant), len(meant)),
                _percent(sum(s.right for s in meant), len(meant)),
                _percent(sum(s.right for s in typed), len(typed)),
                _percent(sum(s.wrong for s in meant), len(meant)),
                _percent(sum(s.meaning != "refused" for s in others), len(others)),
                f"{len(meant)}+{len(others)}",
            )
            sys.stdout.write(
                "{:<15} {:<14} {:>7} {:>9} {:>9} {:>7} {:>8} {:>9}\n".format(
                    condition, system, *cells
                )
            )
    sys.stdout.flush()


def misses(scores: Sequence[Score]) -> None:
    """Lists what the last system got wrong, the most frequent sentence first."""
    wrong = [s for s in scores if s.system == scores[-1].system and not s.right]
    often = Counter(s.task.sentence.text for s in wrong)
    for s in sorted(wrong, key=lambda s: (-often[s.task.sentence.text], s.task.sentence.text)):
        mark = "!" if s.wrong or not s.task.sentence.world else " "
        typed = "" if s.typed_right or not s.task.sentence.world else " (typed, too)"
        sys.stdout.write(
            f"{mark} {s.task.voice:<5} {s.task.condition:<13} {s.task.sentence.text}{typed}\n"
            f"      heard {s.heard!r} free {s.free!r}: {s.meaning}{s.note}\n"
        )


def main() -> None:
    """Scores and prints."""
    parser = argparse.ArgumentParser(description="How well speech is understood.")
    parser.add_argument("--some", type=int, default=1, help="every N-th sentence")
    parser.add_argument("--part", choices=PARTS, action="append", help="these parts of the set")
    parser.add_argument("--only", choices=CONDITIONS, action="append", help="these conditions")
    parser.add_argument("--voice", choices=VOICES, action="append", help="these voices")
    parser.add_argument("--system", choices=SYSTEMS, action="append", help="these systems")
    parser.add_argument("--misses", action="store_true", help="list what went wrong")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    given = parser.parse_args()
    conditions = tuple(given.only or CONDITIONS)
    systems = tuple(given.system or (SYSTEMS if is_installed() else SYSTEMS[:-1]))
    for part in given.part or PARTS:
        some = tasks(part, given.some, conditions, given.voice or VOICES)
        found = list(_scores([(task, systems) for task in some], given.jobs))
        if given.misses:
            misses(found)
        table(found, conditions, systems)


def _scores(work: Sequence[tuple[Task, tuple[str, ...]]], jobs: int) -> Iterator[Score]:
    if jobs == 1:
        yield from itertools.chain.from_iterable(map(score, work))
        return
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        yield from itertools.chain.from_iterable(pool.imap(score, work, 8))


if __name__ == "__main__":
    main()
