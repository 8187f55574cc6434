"""The real model on real audio."""

from __future__ import annotations

from pathlib import Path

import numpy
import pytest
import soundfile

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.hands_free.weight import weight_of
from polaris_nl.language.tokens import phrase
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.data import data_folder
from polaris_nl.model.errors import SpeechError
from polaris_nl.model.world_file import load_world
from polaris_nl.speech.audio import RATE, file_blocks
from polaris_nl.speech.ears import EarMaker, Ears
from polaris_nl.speech.models import model_folder
from polaris_nl.speech.vosk_recogniser import VoskModel
from polaris_nl.speech.weight import Weigh

RECORDINGS = data_folder("domains") / "caregiving/recordings"
SENTENCES = (
    "tell the resident that lunch is ready",
    "once she acknowledges bring a full tray to her table and then go home",
    "if she dismisses it just go home",
)


@pytest.fixture(scope="module")
def maker() -> EarMaker:
    return EarMaker()


@pytest.fixture(scope="module")
def understanding() -> Understanding:
    return Understanding(load_world("care-home"))


@pytest.fixture(scope="module")
def ears(maker: EarMaker, understanding: Understanding) -> Ears:
    return maker.ears(understanding.phrases())


@pytest.fixture(scope="module")
def weigh(understanding: Understanding) -> Weigh:
    return lambda text: weight_of(understanding.interpret(text, Automaton())[0])


def test_the_recording_is_three_sentences(ears: Ears, weigh: Weigh) -> None:
    said = ears.utterance(file_blocks(RECORDINGS / "lunch.flac"), weigh)
    assert said.text == ". ".join(SENTENCES)
    assert said.accepted
    assert 9 < said.audio_s < 12  # with half a second before each and a quarter behind it


def test_the_same_sound_is_heard_the_same_again(ears: Ears, weigh: Weigh) -> None:
    first = ears.utterance(file_blocks(RECORDINGS / "lunch.flac"), weigh)
    assert ears.utterance(file_blocks(RECORDINGS / "lunch.flac"), weigh) == first


def test_one_breath_is_one_utterance(ears: Ears, weigh: Weigh) -> None:
    said = ears.utterance(file_blocks(RECORDINGS / "lunch-in-one-breath.flac"), weigh)
    assert said.accepted
    assert said.text.replace(". ", " ").split()[:7] == SENTENCES[0].split()


def test_a_44_khz_stereo_copy_with_noise_is_heard_the_same(
    ears: Ears, weigh: Weigh, tmp_path: Path
) -> None:
    import soxr

    samples, rate = soundfile.read(RECORDINGS / "lunch.flac", dtype="float32")
    loud = soxr.resample(samples, rate, 44_100)
    noise = numpy.random.default_rng(1).normal(0, 0.003, len(loud)).astype("float32")
    path = tmp_path / "stereo.wav"
    soundfile.write(path, numpy.column_stack([loud + noise, loud]), 44_100)
    assert ears.utterance(file_blocks(path), weigh).text == ". ".join(SENTENCES)


def test_noise_is_nothing_and_the_terminal_stays_clean(
    ears: Ears, weigh: Weigh, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    noise = numpy.random.default_rng(2).normal(0, 0.01, RATE * 3).astype("float32")
    soundfile.write(tmp_path / "noise.wav", noise, RATE)
    assert not ears.utterance(file_blocks(tmp_path / "noise.wav"), weigh).accepted
    assert capfd.readouterr() == ("", "")


@pytest.fixture(scope="module")
def model() -> VoskModel:
    return VoskModel(model_folder())


def test_the_lexicon_names_its_gaps(model: VoskModel) -> None:
    assert model.missing(["bring the tray", "bring the zorblax"]) == ("zorblax",)


@pytest.mark.parametrize("name", ["care-home", "dinner-party"])
def test_everything_in_the_shipped_worlds_can_be_said_somehow(model: VoskModel, name: str) -> None:
    for entity in load_world(name).entities.values():
        names = [" ".join(phrase(text)) for text in (entity.spoken, *entity.synonyms)]
        assert any(not model.missing([spoken]) for spoken in names), entity.name


def test_a_folder_that_is_no_model_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(SpeechError, match="can't be loaded"):
        VoskModel(tmp_path)
