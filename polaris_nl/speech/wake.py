"""The wake word: a small network that listens for one name, and runs all the time."""

from __future__ import annotations

from typing import Protocol

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.audio import INSTALL

WORDS = ("hey jarvis", "okay nabu", "hey mycroft", "alexa")
"""The names whose networks come with the package."""


class WakeWord(Protocol):
    """Hears its name."""

    word: str

    def heard(self, block: bytes) -> bool:
        """Whether the name ends in this block."""
        ...


class MicroWakeWord:
    """One of the networks of pymicro-wakeword (Apache-2.0).

    Args:
        word: one of WORDS.

    Raises:
        SpeechError: the package is missing.
    """

    def __init__(self, word: str = WORDS[0]) -> None:
        try:
            import pymicro_wakeword as package
        except (ImportError, OSError) as error:
            raise SpeechError(f"A wake word needs pymicro-wakeword. {INSTALL}") from error
        self.word = word
        model = package.Model(word.replace(" ", "_"))
        self._network = package.MicroWakeWord.from_builtin(model)
        self._features = package.MicroWakeWordFeatures()

    def heard(self, block: bytes) -> bool:
        """Whether the name ends in this block."""
        found = False
        for features in self._features.process_streaming(block):
            found = bool(self._network.process_streaming(features)) or found
        if found:
            self._network.reset()  # or the same name would be heard again in the next blocks
        return found
