"""Searches for what was said among the words of a world: sound and phrases decide together, word by word.

A beam search whose readings are rated by the recogniser and, at each word's end, by a model of the
phrases ("shallow fusion": C. Gulcehre et al., "On using monolingual corpora in neural machine
translation", 2015). Words that no phrase has are not followed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy

from polaris_nl.speech.whisper_decoder import Listening, Memory
from polaris_nl.speech.word_model import END, START, WordModel

BEAM, FOLLOWED, FOUND = 12, 24, 10
"""Readings that are followed, the likeliest pieces that each may go on with, and readings that are returned."""
GUIDED, A_WORD, AT_MOST = 0.3, 1.0, 0.5
"""What the model of the phrases counts beside the recogniser, what makes up for it at each word, and the most
that a word may gain by both: where few phrases make each word likely, saying all twice must not pay."""
FAR = 10.0
"""What is so much less likely than the likeliest that is whole isn't followed."""
WORDS_A_S, MOST_PIECES = 5.0, 60
"""The fastest speech, in words a second, and the most that is followed."""
COMMONEST = 8192
"""The commonest pieces, which tell how likely those of the phrases are: the rest, five times as many, hardly
ever are, and cost most of the time."""


@dataclass(frozen=True, slots=True)
class Pieces:
    """What the recogniser writes words with, the commonest first.

    Attributes:
        letters: those of each piece, in lower case, "" for signs; None where no word has it.
        begins: whether a word begins with it.
        end: the number of the piece that ends all.
    """

    letters: Sequence[str | None]
    begins: Sequence[bool]
    end: int


class Guide:
    """What may be said, and what it is written with.

    Args:
        model: how words follow each other.
        pieces: what the recogniser writes with.
        weights: its numbers for each piece, (all pieces, w).

    Attributes:
        numbers: those of the pieces of the phrases, and behind them of the one that ends all.
        letters, begins: as in `pieces`, for each of `numbers`.
        weights: for each of `numbers`, and for the commonest of the others.
    """

    def __init__(self, model: WordModel, pieces: Pieces, weights: numpy.ndarray[Any, Any]) -> None:
        self.model = model
        inner = {w[i:j] for w in model.words for i in range(len(w)) for j in range(i, len(w) + 1)}
        written = [
            number
            for number, letters in enumerate(pieces.letters)
            if letters in (model.beginnings if pieces.begins[number] else inner)
        ]
        self.numbers = (*written, pieces.end)
        self.letters = [*(pieces.letters[number] or "" for number in written), ""]
        self.begins = [*(pieces.begins[number] for number in written), True]
        beside = sorted(set(range(min(COMMONEST, pieces.end))).difference(written))
        self.weights = weights[[*self.numbers, *beside]]


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


def guided(listening: Listening, prompt: Sequence[int], guide: Guide, seconds: float) -> list[str]:
    """What may have been said in words of the phrases, the likeliest first.

    Args:
        listening: the recogniser's decoder with the sound.
        prompt: the pieces that all begins with.
        guide: what may be said.
        seconds: how long the sound is.
    """
    most, end = ceil(seconds * WORDS_A_S), guide.numbers[-1]
    readings, whole = [_Reading(0.0, (START,), "", prompt[-1], 0)], dict[str, float]()
    found, memory = listening.following(numpy.array([prompt]))
    for _ in range(MOST_PIECES):
        likely = listening.likely(found[:, -1], guide.weights)
        on = sorted(_going_on(readings, likely, guide), key=lambda r: -r.score)
        for reading in (r for r in on if r.piece == end):
            text = " ".join(reading.words[1:])
            whole[text] = max(whole.get(text, reading.score), reading.score)
        far = max(whole.values(), default=-numpy.inf) - FAR
        readings = [r for r in on if r.piece != end and len(r.words) <= most and r.score > far][
            :BEAM
        ]
        enough = sorted(whole.values(), reverse=True)[FOUND - 1 : FOUND]
        if not readings or (enough and enough[0] > readings[0].score):
            break
        memory = _of(memory, [r.of for r in readings])
        found, memory = listening.following(numpy.array([[r.piece] for r in readings]), memory)
    return sorted(filter(None, whole), key=lambda text: -whole[text])[:FOUND]


def _going_on(
    readings: Sequence[_Reading], likely: numpy.ndarray[Any, Any], guide: Guide
) -> Iterator[_Reading]:
    """Each reading with each of the pieces that it may go on or end with."""
    model, last = guide.model, len(guide.numbers) - 1
    size = min(FOLLOWED, last)
    best = numpy.argpartition(-likely[:, :last], size - 1, axis=1)[:, :size]
    for at, reading in enumerate(readings):
        for column in (*map(int, best[at]), last):
            score = reading.score + float(likely[at, column])
            words, begun = reading.words, reading.begun
            if guide.begins[column] and begun:
                if begun not in model.words:
                    continue
                gain = GUIDED * model.log_probability(begun, words) + A_WORD
                score += min(gain, AT_MOST)
                words, begun = (*words, begun), ""
            if column == last:
                score += GUIDED * model.log_probability(END, words)
            begun += guide.letters[column]
            if begun in model.beginnings:
                yield _Reading(score, words, begun, guide.numbers[column], at)


def _of(memory: Memory, rows: Sequence[int]) -> Memory:
    return [(keys[rows], values[rows]) for keys, values in memory]
