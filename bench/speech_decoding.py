"""Decodings of the speech set, kept between runs: what certain settings make of certain audio."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from bench.speech_audio import blocks
from bench.speech_voices import FOLDER
from polaris_nl.speech import guided
from polaris_nl.speech.activity import Activity, Cutter
from polaris_nl.speech.recogniser import Decoded, Decoder
from polaris_nl.speech.whisper_recogniser import BEAM, WhisperOpinion, WhisperRecogniser


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


class Opinions:
    """A second recogniser that remembers what it has heard, on disk.

    Args:
        names: what it is told that things are called.
        phrases: what it is told that may be said.
    """

    def __init__(self, names: Sequence[str], phrases: Sequence[str]) -> None:
        self._recogniser = WhisperRecogniser(names, phrases)
        settings = (
            "guided whisper",
            BEAM,
            guided.BEAM,
            guided.GUIDED,
            guided.A_WORD,
            guided.AT_MOST,
            guided.WORDS_A_S,
            guided.FAR,
            guided.COMMONEST,
            names,
            phrases,
        )
        key = hashlib.sha256(repr(settings).encode()).hexdigest()[:16]
        self._path = FOLDER / "decodings" / f"{key}.jsonl"
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._known: dict[str, Any] = {}
        if self._path.exists():
            lines = self._path.read_text(encoding="utf-8").splitlines()
            self._known.update(map(json.loads, lines))

    def opinion(self, sound: bytes) -> RememberedOpinion:
        """What a piece of speech may have been."""
        return RememberedOpinion(self, sound)

    def known(self, key: str, find: Callable[[], Any]) -> Any:
        """What is remembered, or else found now."""
        if key not in self._known:
            found = self._known[key] = find()
            with self._path.open("a", encoding="utf-8") as file:
                file.write(json.dumps([key, found]) + "\n")
        return self._known[key]

    def fresh(self, sound: bytes) -> WhisperOpinion:
        """What a piece of speech may have been, heard now."""
        return self._recogniser.opinion(sound)


class RememberedOpinion:
    """A remembered opinion; the sound is heard again only for what isn't known yet."""

    def __init__(self, opinions: Opinions, sound: bytes) -> None:
        self._opinions = opinions
        self._sound = sound
        self._name = hashlib.sha256(sound).hexdigest()[:24]

    @cached_property
    def _fresh(self) -> WhisperOpinion:
        return self._opinions.fresh(self._sound)

    @cached_property
    def texts(self) -> Sequence[str]:
        """What it may have been."""
        return tuple(self._opinions.known(self._name, lambda: list(self._fresh.texts)))

    def likelihoods(self, texts: Sequence[str]) -> Sequence[float]:
        """How likely any words are."""
        key = hashlib.sha256(f"{self._name} with the end {texts}".encode()).hexdigest()[:24]
        found: list[float] = self._opinions.known(key, lambda: self._fresh.likelihoods(texts))
        return found


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
