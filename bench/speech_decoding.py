"""Decodings of the speech set, kept between runs: what a recogniser with certain settings makes of certain audio."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from pathlib import Path

from bench.speech_audio import FOLDER, blocks
from polaris_nl.speech.recogniser import Recogniser, Spoken


class Decodings:
    """A recogniser that remembers what it has heard, on disk.

    Args:
        settings: all that decides what is heard: search settings, phrases, ...
        make: makes the recogniser, once something new is heard.
    """

    def __init__(self, settings: Sequence[object], make: Callable[[], Recogniser]) -> None:
        key = hashlib.sha256(repr(settings).encode()).hexdigest()[:16]
        self._path = FOLDER / "decodings" / f"{key}.jsonl"
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._make = make
        self._recogniser: Recogniser | None = None
        self._known = dict(_lines(self._path))

    def hear(self, audio: bytes) -> list[Spoken]:
        """The pieces of speech in some audio."""
        name = hashlib.sha256(audio).hexdigest()[:24]
        if name not in self._known:
            if self._recogniser is None:
                self._recogniser = self._make()
            pieces = [
                (list(p.alternatives), len(p.audio)) for p in self._recogniser.hear(blocks(audio))
            ]
            self._known[name] = pieces
            with self._path.open("a", encoding="utf-8") as file:
                file.write(json.dumps([name, pieces]) + "\n")
        found, at = [], 0
        for alternatives, length in self._known[name]:
            found.append(Spoken(tuple(alternatives), audio[at : at + length]))
            at += length
        return found

    def words(self, audio: bytes) -> str:
        """The likeliest words."""
        return " ".join(p.alternatives[0] for p in self.hear(audio))


def _lines(path: Path) -> list[tuple[str, list[tuple[list[str], int]]]]:
    if not path.exists():
        return []
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
