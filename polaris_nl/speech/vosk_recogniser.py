"""Vosk behind the recogniser's protocol."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.audio import BLOCK, INSTALL, RATE
from polaris_nl.speech.models import MEND, WIDE, tuned
from polaris_nl.speech.recogniser import UNKNOWN, Decoded

ALTERNATIVES = 30
"""Readings of one piece of speech that are looked at: the first that makes sense wins."""
_ERRORS_ONLY = -2
_BLOCK_BYTES = BLOCK * 2


class VoskModel:
    """A loaded model, shared by its recognisers.

    Args:
        folder: the model's folder.
        search: settings of its search, `WIDE` or `NARROW`.

    Raises:
        SpeechError: Vosk isn't installed, or can't use the model.
    """

    def __init__(self, folder: Path, search: dict[str, str] = WIDE) -> None:
        try:
            import vosk
        except (ImportError, OSError) as error:
            raise SpeechError(f"Speech needs the package vosk. {INSTALL}") from error
        vosk.SetLogLevel(_ERRORS_ONLY)
        self._vosk = vosk
        try:
            self.handle = vosk.Model(str(tuned(folder, search)))
        except Exception as error:  # Vosk raises nothing more specific
            raise SpeechError(f"The speech model in {folder} can't be loaded. {MEND}") from error

    def knows(self, word: str) -> bool:
        """Whether the model's lexicon has a word; one that it hasn't is never heard."""
        return bool(self.handle.vosk_model_find_word(word) != -1)

    def missing(self, phrases: Iterable[str]) -> tuple[str, ...]:
        """The words of some phrases that the lexicon hasn't, in alphabetical order."""
        words = {word for phrase in phrases for word in phrase.split()}
        return tuple(sorted(word for word in words if not self.knows(word)))

    def recogniser(self, phrases: Sequence[str] | None) -> Any:
        """A new one of Vosk's own: of these phrases, or of free speech."""
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
        alternatives: how many readings of a piece are kept.
    """

    def __init__(
        self,
        model: VoskModel,
        phrases: Sequence[str] | None = None,
        alternatives: int = ALTERNATIVES,
    ) -> None:
        self._model = model
        self._phrases = None
        self._alternatives = alternatives if phrases is not None else 1
        if phrases is not None:
            gaps = set(model.missing(phrases))
            self._phrases = [p for p in phrases if gaps.isdisjoint(p.split())]

    def decoder(self) -> VoskDecoder:
        """A decoder; to make one takes 0.1 s where there are many phrases, so keep it."""
        return VoskDecoder(self._model.recogniser(self._phrases), self._alternatives)


class VoskDecoder:
    """One of Vosk's recognisers.

    Args:
        inner: Vosk's own.
        alternatives: how many readings are kept.
    """

    def __init__(self, inner: Any, alternatives: int) -> None:
        self._inner = inner
        self._inner.SetMaxAlternatives(alternatives)
        self._done: list[_Found] = []
        self._rest = b""

    def feed(self, sound: bytes) -> None:
        """Takes more of the piece, and hands it on in blocks of one size: what Vosk hears depends on it."""
        sound = self._rest + sound
        whole = len(sound) // _BLOCK_BYTES * _BLOCK_BYTES
        for at in range(0, whole, _BLOCK_BYTES):
            self._accept(sound[at : at + _BLOCK_BYTES])
        self._rest = sound[whole:]

    def _accept(self, block: bytes) -> None:
        if self._inner.AcceptWaveform(block):
            # Vosk thinks that a sentence has ended; whether it has is decided elsewhere.
            self._done += _found(self._inner.Result())[:1]

    def partial(self) -> str:
        """The likeliest words so far."""
        found = str(json.loads(self._inner.PartialResult()).get("partial", ""))
        return " ".join([*(text for text, _ in self._done), found]).strip()

    def finish(self) -> Decoded:
        """What the piece may have been; resets Vosk, so that nothing of it colours the next piece."""
        if self._rest:
            self._accept(self._rest)
        done, self._done, self._rest = self._done, [], b""
        found = _found(self._inner.FinalResult()) or ([("", 0.0)] if done else [])
        before = "".join(f"{text} " for text, _ in done)
        likelihood = sum(value for _, value in done)
        return Decoded(
            tuple(f"{before}{text}".strip() for text, _ in found),
            tuple(likelihood + value for _, value in found),
        )


_Found = tuple[str, float]
"""A reading, and the logarithm of its likelihood, which Vosk calls its confidence."""


def _found(result: str) -> list[_Found]:
    """The readings of a result, each once."""
    found: dict[str, float] = {}
    for one in json.loads(result).get("alternatives", ()):
        text = str(one.get("text", "")).strip()
        if text:
            found.setdefault(text, float(one.get("confidence", 0.0)))
    return list(found.items())
