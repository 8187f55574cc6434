"""What isn't sure is heard again, and done only where both recognisers bear it out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import pytest

from polaris_nl.speech.ears import EarMaker
from polaris_nl.speech.hearing import Utterance, Ways, utterance
from polaris_nl.speech.recogniser import Spoken
from polaris_nl.speech.second import heard_again, wants_second
from polaris_nl.speech.weight import Weight
from polaris_nl.speech.whisper_recogniser import WhisperRecogniser
from tests.speech.speaking import blocks_of, in_noise, silence, spoken

CUP, TRAY = "move the cup to the desk", "move the tray to the desk"
WEIGHTS = {
    CUP: Weight.CHANGING, TRAY: Weight.CHANGING, f"don't {CUP}": Weight.CHANGING,
    "where is the cup": Weight.HARMLESS, "run the whole program": Weight.MOVING,
    "undo": Weight.CHANGING, "right": Weight.CHANGING, "move the desk": Weight.ASKING,
    f"then {CUP}": Weight.CHANGING, f"{CUP} then go home": Weight.CHANGING,
    "where is it": Weight.HARMLESS,
}  # fmt: skip


@dataclass(frozen=True)
class Heard:
    """An opinion that finds words as likely as it is told."""

    texts: Sequence[str] = ()
    known: Mapping[str, float] = field(default_factory=dict)

    def likelihoods(self, texts: Sequence[str]) -> Sequence[float]:
        return [self.known.get(text, -99.0) for text in texts]


def weigh(text: str) -> Weight | None:
    return WEIGHTS.get(text)


def means(text: str) -> str:
    return text.removeprefix("then ")


def both(
    opinion: Heard, *alternatives: str, gains: Sequence[float] = (), free: str = "who's a threat"
) -> Utterance:
    piece = Spoken(alternatives, b"\0\0" * 16_000, free, tuple(gains) or (1.0,) * len(alternatives))
    first = utterance([piece], weigh, Ways(), means)
    assert not first.sure
    return heard_again(first, [piece], [opinion], weigh, Ways(), means)


def test_the_second_decides_between_readings_of_the_first() -> None:
    opinion = Heard(("remove the tray to the desk",), {
        "remove the tray to the desk": -3.0, TRAY: -4.0, CUP: -12.0,
    })  # fmt: skip
    said = both(opinion, CUP, TRAY)
    assert (said.text, said.accepted, said.doubts) == (TRAY, True, ())
    assert (said.again, said.repaired) == ("remove the tray to the desk", CUP)


def test_words_that_only_the_second_heard_are_done_where_it_is_certain_of_them() -> None:
    said = both(Heard((CUP,), {CUP: -2.0}), "more of the cop", "more of the best")
    assert (said.text, said.accepted) == (CUP, True)
    unlikely = Heard(("move the cub",), {"move the cub": -2.0, CUP: -7.0})
    assert not both(unlikely, "more of the cop").accepted


def test_where_both_are_as_likely_it_is_asked_about() -> None:
    opinion = Heard((CUP, TRAY), {CUP: -3.0, TRAY: -3.5})
    said = both(opinion, CUP, TRAY)
    assert (said.accepted, said.doubts) == (False, (CUP, TRAY))
    assert said.why_not == "two recognisers don't agree"


@pytest.mark.parametrize(("own", "accepted"), [(-3.0, False), (-8.0, True)])
def test_a_not_that_only_one_heard_is_asked_about(own: float, accepted: bool) -> None:
    opinion = Heard((f"i don't {CUP}",), {f"i don't {CUP}": own, CUP: -6.0})
    said = both(opinion, CUP)
    assert (said.text, said.accepted) == (CUP, accepted)
    assert said.doubts == (() if accepted else (CUP,))


@pytest.mark.parametrize(("likely", "accepted"), [(-5.0, False), (-9.0, True)])
def test_a_not_that_may_have_been_lost_is_asked_about(likely: float, accepted: bool) -> None:
    said = both(Heard((CUP,), {CUP: -3.0, f"don't {CUP}": likely}), CUP, f"don't {CUP}")
    assert (said.text, said.accepted) == (CUP, accepted)
    assert said.doubts == (() if accepted else (CUP, f"don't {CUP}"))


def test_what_the_second_finds_unlikely_is_left_alone() -> None:
    opinion = Heard(("who is there",), {"who is there": -2.0, CUP: -40.0})
    said = both(opinion, CUP, gains=[0.1], free="mother gets the best")
    assert not said.accepted
    assert said.doubts == ()
    assert "heard again" in said.why_not


def test_other_people_are_not_asked_what_they_said() -> None:
    opinion = Heard(("who is there",), {"who is there": -2.0, CUP: -10.0})
    said = both(opinion, CUP, gains=[-30.0], free="who is at the theatre")
    assert (said.accepted, said.doubts) == (False, ())


def test_a_few_words_are_hard_for_the_second() -> None:
    # It has to be certain to have them done, and is no witness against what the first accepted.
    certain = Heard(("under",), {"under": -4.0, "undo": -4.0, "right": -9.0})
    assert both(certain, "right", "undo", free="rye").text == "undo"
    unsure = Heard(("and do",), {"and do": -1.0, "undo": -4.0, "right": -3.0})
    assert both(unsure, "undo", "right", free="rye") == utterance_of(
        "undo", "right", again="and do"
    )


def utterance_of(*alternatives: str, again: str) -> Utterance:
    piece = Spoken(alternatives, b"\0\0" * 16_000, "rye", (1.0,) * len(alternatives))
    return replace(utterance([piece], weigh, Ways(), means), again=again)


def test_motion_asks_for_more_than_a_question() -> None:
    run, where = "run the whole program", "where is the cup"
    doubtful = {run: -4.0, where: -4.0, "and": -2.5}
    assert both(Heard(("and",), doubtful), run).doubts == (run,)
    assert both(Heard(("and",), doubtful), where).accepted


@pytest.mark.parametrize(
    ("words", "accepted"), [("where is it", False), ("where is the cup", True)]
)
def test_short_questions_that_only_the_second_heard_are_other_peoples(
    words: str, accepted: bool
) -> None:
    said = both(Heard((words,), {words: -1.0}), "were as the cub")
    assert (said.accepted, said.doubts) == (accepted, ())


@pytest.mark.parametrize(("likely", "heard"), [(-6.0, f"{CUP} then go home"), (-20.0, CUP)])
def test_what_breaks_off_in_the_middle_is_no_reading(likely: float, heard: str) -> None:
    longer = f"{CUP} then go home"
    said = both(Heard((CUP, longer), {CUP: -5.0, longer: likely}), longer, gains=[4.0])
    assert (said.text, said.accepted, said.doubts) == (heard, True, ())


@pytest.mark.parametrize(
    ("own", "free", "accepted"),
    [
        (
            "remove the cup to the desk and then you all go home",
            "the cup on the deck and then we all may go home",
            False,
        ),
        ("remove the cup to the desk and then you all go home", "the cup on the deck", True),
        ("remove the cup to the desk", "the cup on the deck and then we all may go home", True),
    ],
)
def test_where_both_heard_far_more_it_is_asked_about(own: str, free: str, accepted: bool) -> None:
    said = both(Heard((own,), {own: -3.0, CUP: -4.0}), CUP, free=free)
    assert (said.text, said.accepted) == (CUP, accepted)
    assert said.doubts == (() if accepted else (CUP,))


def test_what_only_the_second_heard_must_be_explained_by_the_phrases_of_the_first() -> None:
    opinion = Heard((CUP,), {CUP: -2.0})
    assert both(opinion, "more of the cop", gains=[-5.0]).accepted
    assert not both(opinion, "more of the cop", gains=[-30.0]).accepted


def test_in_noise_what_is_sure_is_heard_again_too() -> None:
    speech = b"".join(blocks_of(spoken(CUP)))
    quiet = b"".join([*silence(0.5), speech])
    first = utterance([Spoken((CUP,), quiet, CUP, (1.0,))], weigh, Ways(), means)
    assert first.sure
    assert not wants_second(first, [Spoken((CUP,), quiet, CUP)])
    assert wants_second(first, [Spoken((CUP,), in_noise(quiet, 10), CUP)])
    assert not wants_second(first, [])


def test_what_makes_sense_only_in_part_stays_a_question() -> None:
    said = both(Heard(("move the desk",), {"move the desk": -1.0}), "move the desk")
    assert said.text == "move the desk"


def test_silence_to_the_second_changes_nothing() -> None:
    said = both(Heard(), CUP, TRAY)
    assert (said.text, said.again) == (CUP, "")


@pytest.fixture(scope="module")
def maker() -> EarMaker:
    return EarMaker()


def test_whisper_tells_how_likely_any_words_are() -> None:
    sound = b"".join([*silence(0.2), *blocks_of(spoken(CUP)), *silence(0.2)])
    opinion = WhisperRecogniser(["cup", "tray", "desk"]).opinion(sound)
    assert opinion.texts[0] == CUP
    assert len(set(opinion.texts)) == len(opinion.texts)
    cup, tray, fridge = opinion.likelihoods([CUP, TRAY, "open the fridge and go home"])
    assert cup - 5 > tray > fridge + 5


def test_it_hears_the_same_each_time() -> None:
    sound = b"".join(blocks_of(spoken(CUP)))
    one, two = (WhisperRecogniser(["cup"]).opinion(sound) for _ in range(2))
    assert one.texts == two.texts
    assert one.likelihoods([TRAY, CUP]) == two.likelihoods([TRAY, CUP])


PHRASES = [
    CUP, TRAY, "bring the tray to the table", "open the fridge",
    "put the cup on the table and open the fridge", "close the cupboard then go home",
    "fill the tray and bring it to the table",
]  # fmt: skip


def test_ears_hear_again_what_noise_has_made_unsure(maker: EarMaker) -> None:
    """Which one gets lost depends on the machine's arithmetic, by a decibel; that more are heard doesn't."""

    def whole(text: str) -> Weight | None:
        return Weight.CHANGING if text in PHRASES else None

    ears = maker.ears(PHRASES, ["cup", "tray", "desk", "table", "fridge", "cupboard"])
    by_one: list[str] = []
    by_both: list[str] = []
    for text in PHRASES:
        for decibels in (2.0, 4.0):
            blocks = [*silence(0.6), *blocks_of(in_noise(spoken(text), decibels)), *silence(1)]
            alone = replace(ears, second=None).utterance(blocks, whole, means)
            said = ears.utterance(blocks, whole, means)
            assert alone.again == ""
            assert said.again
            by_one += [text] if (alone.text, alone.accepted) == (text, True) else []
            by_both += [text] if said.accepted else []
            if (text, decibels) == (TRAY, 4.0):
                assert (alone.accepted, said.accepted) == (False, True)
            assert not said.accepted or said.text == text
    assert len(by_both) >= len(by_one) + 2
    assert len(by_both) > len(PHRASES)


def test_what_both_decodings_of_vosk_bear_out_is_not_heard_again(maker: EarMaker) -> None:
    ears = maker.ears([CUP, TRAY], ["cup", "tray", "desk"])
    sound = [*silence(0.6), *blocks_of(spoken(CUP)), *silence(1)]
    said = ears.utterance(sound, weigh, means)
    assert (said.text, said.sure, said.again) == (CUP, True, "")


def test_without_whisper_nothing_is_heard_again() -> None:
    assert EarMaker(second=False).ears([CUP]).second is None
