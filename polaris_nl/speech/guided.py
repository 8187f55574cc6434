"""Searches for what was said among the words of a world: sound and phrases decide together, word by word.

A beam search whose readings are rated by the recogniser and, at each word's end, by a model of the
phrases ("shallow fusion": C. Gulcehre et al., "On using monolingual corpora in neural machine
translation", 2015). Words that no phrase has are not followed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil

import numpy

from polaris_nl.speech.whisper_decoder import Listening, Memory
from polaris_nl.speech.word_model import END, START, WordModel

BEAM, FOLLOWED, FOUND = 12, 24, 10
"""Readings that are followed, the likeliest pieces that each may go on with, and readings that are returned."""
GUIDED, A_WORD, AT_MOST = 0.3, 1.0, 0.5
"""What the model of the phrases counts beside the recogniser, what makes up for it at each word, and the most
that a word may gain by both: where few phrases make each word likely, saying all twice must not pay."""
WORDS_A_S, MOST_PIECES = 5.0, 60
"""The fastest speech, in words a second, and the most that is followed."""


@dataclass(frozen=True, slots=True)
class Pieces:
    """What the recogniser writes words with.

    Attributes:
        letters: those of each piece, in lower case, "" for signs; None where no word has it.
        begins: whether a word begins with it.
        end: the number of the piece that ends all.
    """

    letters: Sequence[str | None]
    begins: Sequence[bool]
    end: int


@dataclass(frozen=True, slots=True)
class _Reading:
    """A reading so far.

    Attributes:
        score: how likely it is, sound and phrases together.
        words: START and the words that are whole.
        begun: the letters of the word behind them.
        piece: its latest piece.
        of: which of the readings before it goes on.
    """

    score: float
    words: tuple[str, ...]
    begun: str
    piece: int
    of: int


def guided(
    listening: Listening, prompt: Sequence[int], pieces: Pieces, model: WordModel, seconds: float
) -> list[str]:
    """What may have been said in words of the phrases, the likeliest first.

    Args:
        listening: the recogniser's decoder with the sound.
        prompt: the pieces that all begins with.
        pieces: what it writes with.
        model: how words follow each other.
        seconds: how long the sound is.
    """
    most = ceil(seconds * WORDS_A_S)
    readings, whole = [_Reading(0.0, (START,), "", prompt[-1], 0)], dict[str, float]()
    found, memory = listening.following(numpy.array([prompt]))
    for _ in range(MOST_PIECES):
        likely = listening.likely(found[:, -1])
        on = sorted(_going_on(readings, likely, pieces, model), key=lambda r: -r.score)
        for reading in (r for r in on if r.piece == pieces.end):
            text = " ".join(reading.words[1:])
            whole[text] = max(whole.get(text, reading.score), reading.score)
        readings = [r for r in on if r.piece != pieces.end and len(r.words) <= most][:BEAM]
        enough = sorted(whole.values(), reverse=True)[FOUND - 1 : FOUND]
        if not readings or (enough and enough[0] > readings[0].score):
            break
        memory = _of(memory, [r.of for r in readings])
        found, memory = listening.following(numpy.array([[r.piece] for r in readings]), memory)
    return sorted(filter(None, whole), key=lambda text: -whole[text])[:FOUND]


def _going_on(
    readings: Sequence[_Reading], likely: numpy.ndarray, pieces: Pieces, model: WordModel
) -> Iterator[_Reading]:
    """Each reading with each of the pieces that it may go on or end with."""
    best = numpy.argpartition(-likely[:, : pieces.end], FOLLOWED, axis=1)[:, :FOLLOWED]
    for at, reading in enumerate(readings):
        for piece in (*map(int, best[at]), pieces.end):
            letters = pieces.letters[piece] if piece != pieces.end else ""
            if letters is None:
                continue
            score, words, begun = (
                reading.score + float(likely[at, piece]),
                reading.words,
                reading.begun,
            )
            if piece == pieces.end or pieces.begins[piece]:
                if begun and begun not in model.words:
                    continue
                if begun:
                    gain = GUIDED * model.log_probability(begun, words) + A_WORD
                    score += min(gain, AT_MOST)
                    words, begun = (*words, begun), ""
            if piece == pieces.end:
                score += GUIDED * model.log_probability(END, words)
            begun += letters
            if begun in model.beginnings:
                yield _Reading(score, words, begun, piece, at)


def _of(memory: Memory, rows: Sequence[int]) -> Memory:
    return [(keys[rows], values[rows]) for keys, values in memory]
