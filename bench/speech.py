"""The end of speech to the echo, beside Vosk without phrases and without a second opinion."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator

from bench.table import Row
from polaris_nl.model.data import data_folder
from polaris_nl.model.world_file import load_world
from polaris_nl.session import Session
from polaris_nl.speech.audio import file_blocks
from polaris_nl.speech.hearing import utterance
from polaris_nl.speech.models import model_folder
from polaris_nl.speech.recogniser import VoskModel, VoskRecogniser

TIMES = 5


def rows() -> Iterator[Row]:
    """The rows about speech."""
    blocks = list(file_blocks(data_folder("domains") / "caregiving/recordings/lunch.flac"))
    audio = b"".join(blocks)
    seconds = len(audio) / 32_000
    model = VoskModel(model_folder())
    with Session(load_world("care-home")) as session:
        session.warm_up()
        phrased = VoskRecogniser(model, session.understanding.phrases())
        free = VoskRecogniser(model)
        echoes: list[float] = []
        for _ in range(TIMES):
            session.begin_again(type(session.snapshot.automaton)())
            for piece in phrased.hear(blocks):
                started = time.perf_counter()
                said = utterance([piece], session.parses, free.words)
                session.say(said.text, source="bench")
                echoes.append((time.perf_counter() - started) * 1000)
    yield Row(
        "words known -> echo with its plan", "p95 <= 800", echoes,
        note="after the pause that ends a sentence (0.5 to 1 s, the model's own)",
    )  # fmt: skip
    ours = [_decode(phrased, blocks) / seconds for _ in range(TIMES)]
    plain = [_plain(model, blocks) / seconds for _ in range(TIMES)]
    yield Row("decoding, a second of speech", "", ours, plain, "Vosk, free, 1-best")


def _decode(recogniser: VoskRecogniser, blocks: list[bytes]) -> float:
    started = time.perf_counter()
    list(recogniser.hear(blocks))
    return (time.perf_counter() - started) * 1000


def _plain(model: VoskModel, blocks: list[bytes]) -> float:
    started = time.perf_counter()
    decoder = model.decoder(None)
    for block in blocks:
        decoder.AcceptWaveform(block)
    json.loads(decoder.FinalResult())
    return (time.perf_counter() - started) * 1000
