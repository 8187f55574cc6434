"""From the end of speech to the echo, the quick words, memory over many utterances, and the price of decoding.

Sound is worked on as fast as it goes; what would be waited for (the pause that ends a sentence) is counted by
the sound itself, so that the figures are those of a microphone without its own delay. The same at a microphone,
in real time, follows (`bench/speech_live.py`).
"""

from __future__ import annotations

import resource
import time
from collections.abc import Iterator, Sequence

from bench import speech_live
from bench.speech_sounds import SENTENCES, SILENCE, spoken
from bench.table import Row
from polaris_nl.automaton.automaton import Automaton
from polaris_nl.hands_free.phrases import spoken_phrases
from polaris_nl.hands_free.weight import weigher
from polaris_nl.model.world_file import load_world
from polaris_nl.session import Session
from polaris_nl.speech.audio import BLOCK, RATE
from polaris_nl.speech.ears import EarMaker, Ears
from polaris_nl.speech.hearer import Heard, Hearer, Quick
from polaris_nl.speech.hearing import utterance
from polaris_nl.speech.recogniser import Decoder

ROUNDS = 3
IN_A_ROW = 300
_BLOCK_S = BLOCK / RATE


def rows() -> Iterator[Row]:
    """The rows about speech."""
    maker, sounds = EarMaker(), [_padded(text) for text in (*SENTENCES, "stop", "pause")]
    with Session(load_world("care-home")) as session:
        session.warm_up()
        ears = maker.ears(spoken_phrases(session.understanding))
        echoes, pauses = _echoes(session, ears, sounds[: len(SENTENCES)])
        yield Row("end of speech -> echo with its plan", "p95 <= 800", echoes)
        yield Row("  of that, silence that is waited for", "", pauses)
        quick = [_quick(session, ears, sound) for sound in sounds[len(SENTENCES) :] * 4]
        yield Row('end of "stop" or "pause" -> acted on', "p95 <= 400", quick)
        yield Row(
            "memory, growth over the second half of utterances", "0", [_growth(session, ears, sounds)],
            unit="MB", note=f"{IN_A_ROW} in a row; resident at the end: {_resident():.0f} MB",
        )  # fmt: skip
        price = [_price(ears.phrased, s) for s in sounds]
        free = [_price(ears.free, s) for s in sounds] if ears.free is not None else []
        yield Row(
            "decoding with phrases, a second of sound", "<= 300", price, free, "decoding freely"
        )
    yield from speech_live.rows()


def _padded(text: str) -> list[bytes]:
    return [*[SILENCE] * 6, *spoken(text)]


def _echoes(
    session: Session, ears: Ears, sounds: Sequence[list[bytes]]
) -> tuple[list[float], list[float]]:
    echoes, pauses = [], []
    for _ in range(ROUNDS):
        session.begin_again(Automaton())
        hearer = Hearer(ears, weigher(session))
        for sound in sounds:
            silent = 0
            for number, block in enumerate([*sound, *[SILENCE] * 30]):
                started = time.perf_counter()
                silent = max(number + 1 - len(sound), 0)
                heard = [h for h in hearer.push(block, True) if isinstance(h, Heard)]
                if heard:
                    said = utterance([heard[0].spoken], weigher(session), ears.ways)
                    session.say(said.text, source="bench")
                    took = time.perf_counter() - started
                    pauses.append(silent * _BLOCK_S * 1000)
                    echoes.append(pauses[-1] + took * 1000)
                    break
    return echoes, pauses


def _quick(session: Session, ears: Ears, sound: list[bytes]) -> float:
    hearer = Hearer(ears, weigher(session))
    for number, block in enumerate([*sound, *[SILENCE] * 20]):
        started = time.perf_counter()
        if any(isinstance(h, Quick) for h in hearer.push(block, False)):
            took = time.perf_counter() - started
            return (max(number + 1 - len(sound), 0) * _BLOCK_S + took) * 1000
    return 2_000.0


def _growth(session: Session, ears: Ears, sounds: Sequence[list[bytes]]) -> float:
    hearer, half = Hearer(ears, weigher(session)), 0.0
    for number in range(IN_A_ROW):
        for block in [*sounds[number % len(sounds)], *[SILENCE] * 15]:
            for happening in hearer.push(block, True):
                if isinstance(happening, Heard):
                    utterance([happening.spoken], weigher(session), ears.ways)
        if number == IN_A_ROW // 2:
            half = _resident()
    return _resident() - half


def _resident() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def _price(decoder: Decoder, sound: Sequence[bytes]) -> float:
    started = time.process_time()
    for block in sound:
        decoder.feed(block)
    decoder.finish()
    return (time.process_time() - started) * 1000 / (len(sound) * _BLOCK_S)
