"""Decodings of the speech set, kept between runs: what certain settings make of certain audio."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from pathlib import Path

from bench.speech_audio import blocks
from bench.speech_voices import FOLDER
from polaris_nl.speech.activity import Activity, Cutter
from polaris_nl.speech.recogniser import Decoded, Decoder


class Decodings:
    """A recogniser that remembers what it has heard, on disk.

    Args:
        settings: all that decides what is heard: search settings, phrases, ...
        make: makes the decoder, once something new is heard.
    """

    def __init__(self, settings: Sequence[object], make: Callable[[], Decoder]) -> None:
        key = hashlib.sha256(repr(("likelihoods", *settings)).encode()).hexdigest()[:16]
        self._path = FOLDER / "decodings" / f"{key}.jsonl"
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._make = make
        self._decoder: Decoder | None = None
        self._known = dict(_lines(self._path))

    def hear(self, audio: bytes) -> Decoded:
        """What one piece of speech may have been."""
        name = hashlib.sha256(audio).hexdigest()[:24]
        if name not in self._known:
            self._decoder = self._decoder or self._make()
            for block in blocks(audio):
                self._decoder.feed(block)
            found = self._known[name] = self._decoder.finish()
            with self._path.open("a", encoding="utf-8") as file:
                file.write(json.dumps([name, found.texts, found.likelihoods]) + "\n")
        return self._known[name]


def cut(audio: bytes, activity: Activity) -> list[bytes]:
    """The pieces of speech in some audio."""
    cutter = Cutter(activity)
    found: list[bytearray] = []
    for block in blocks(audio):
        piece = cutter.push(block)
        if piece.starts:
            found.append(bytearray())
        if piece.sound:
            found[-1] += piece.sound
    return [bytes(piece) for piece in found]


def _lines(path: Path) -> list[tuple[str, Decoded]]:
    if not path.exists():
        return []
    lines = path.read_text(encoding="utf-8").splitlines()
    found = map(json.loads, lines)
    return [(name, Decoded(tuple(texts), tuple(values))) for name, texts, values in found]
