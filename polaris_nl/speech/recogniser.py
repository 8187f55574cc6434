"""Audio to words: the recogniser's protocol, and Vosk behind it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.audio import RATE
from polaris_nl.speech.models import MEND, tuned

ALTERNATIVES = 30
"""Readings of one piece of speech that are looked at: the first that makes sense wins."""
UNKNOWN = "[unk]"
_ERRORS_ONLY = -2
_BYTES_A_SECOND = RATE * 2


@dataclass(frozen=True, slots=True)
class Spoken:
    """A piece of speech between two pauses.

    Attributes:
        alternatives: what it may have been, the likeliest first; lower case, no punctuation.
        audio: its samples, 16 kHz mono 16 bit.
    """

    alternatives: tuple[str, ...]
    audio: bytes

    @property
    def seconds(self) -> float:
        """How long it is."""
        return len(self.audio) / _BYTES_A_SECOND


class Recogniser(Protocol):
    """Turns audio into words."""

    def hear(self, blocks: Iterable[bytes]) -> Iterator[Spoken]:
        """Each piece of speech, as soon as its pause is heard; pieces without words are left out."""
        ...


class VoskModel:
    """A loaded model, shared by its recognisers.

    Args:
        folder: the model's folder.
        widely: search more widely than the model's own settings do.

    Raises:
        SpeechError: Vosk isn't installed, or can't use the model.
    """

    def __init__(self, folder: Path, widely: bool = True) -> None:
        try:
            import vosk
        except (ImportError, OSError) as error:
            raise SpeechError(
                'Speech needs the package vosk; install it with: pip install "polaris-nl[voice]"'
            ) from error
        vosk.SetLogLevel(_ERRORS_ONLY)
        self._vosk = vosk
        try:
            self.handle = vosk.Model(str(tuned(folder) if widely else folder))
        except Exception as error:  # Vosk raises nothing more specific
            raise SpeechError(f"The speech model in {folder} can't be loaded. {MEND}") from error

    def knows(self, word: str) -> bool:
        """Whether the model's lexicon has a word; one that it hasn't is never heard."""
        return bool(self.handle.vosk_model_find_word(word) != -1)

    def missing(self, phrases: Iterable[str]) -> tuple[str, ...]:
        """The words of some phrases that the lexicon hasn't, in alphabetical order."""
        words = {word for phrase in phrases for word in phrase.split()}
        return tuple(sorted(word for word in words if not self.knows(word)))

    def decoder(self, phrases: Sequence[str] | None) -> Any:
        """A new decoder: of these phrases, or of free speech."""
        if phrases is None:
            return self._vosk.KaldiRecognizer(self.handle, RATE)
        return self._vosk.KaldiRecognizer(self.handle, RATE, json.dumps([*phrases, UNKNOWN]))


class VoskRecogniser:
    """Vosk with a list of phrases, or without one.

    The list is no grammar to Vosk: it learns which word may follow which, so what it hears must be parsed.

    Args:
        model: the loaded model.
        phrases: what may be said; None for free speech. Phrases with words that the lexicon hasn't are left
            out: Vosk would drop the word and hear a different, shorter sentence.
    """

    def __init__(self, model: VoskModel, phrases: Sequence[str] | None = None) -> None:
        self._model = model
        self._phrases = None
        if phrases is not None:
            gaps = set(model.missing(phrases))
            self._phrases = [p for p in phrases if gaps.isdisjoint(p.split())]

    def hear(self, blocks: Iterable[bytes]) -> Iterator[Spoken]:
        """Each piece of speech, as soon as its pause is heard."""
        decoder = self._model.decoder(self._phrases)
        decoder.SetMaxAlternatives(ALTERNATIVES)
        audio = bytearray()
        for block in blocks:
            audio += block
            if decoder.AcceptWaveform(bytes(block)):
                yield from _spoken(decoder.Result(), bytes(audio))
                audio.clear()
        yield from _spoken(decoder.FinalResult(), bytes(audio))

    def words(self, audio: bytes) -> str:
        """The likeliest words of a piece of audio."""
        decoder = self._model.decoder(self._phrases)
        decoder.AcceptWaveform(audio)
        return str(json.loads(decoder.FinalResult()).get("text", "")).strip()


def _spoken(result: str, audio: bytes) -> Iterator[Spoken]:
    found = json.loads(result)
    texts = (str(a.get("text", "")).strip() for a in found.get("alternatives", ()))
    distinct = tuple(dict.fromkeys(t for t in texts if t))
    if distinct:
        yield Spoken(distinct, audio)
