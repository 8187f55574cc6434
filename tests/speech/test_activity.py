"""Cutting sound into pieces of speech, with a detector that is told where speech is."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.speech.activity import BEFORE_S, KEPT_S, LONGEST_S, Cutter
from polaris_nl.speech.audio import BLOCK


class Told:
    """A detector that reads the probability out of the block: its first byte, in hundredths."""

    frame_s = 0.05

    def speech(self, block: bytes) -> list[float]:
        return [block[0] / 100] * 2

    def reset(self) -> None:
        pass


LOUD, QUIET = bytes([90]) * (BLOCK * 2), bytes([5]) * (BLOCK * 2)


def cuts(blocks: list[bytes], pause_s: float = 0.7) -> list[bytes]:
    cutter = Cutter(Told())
    pieces: list[bytearray] = []
    for block in blocks:
        cut = cutter.push(block, pause_s)
        if cut.starts:
            pieces.append(bytearray())
        if cut.sound:
            pieces[-1] += cut.sound
    return [bytes(piece) for piece in pieces]


def test_silence_is_no_speech() -> None:
    assert cuts([QUIET] * 50) == []


@pytest.mark.parametrize("pause_s", [0.3, 0.7, 1.5])
def test_half_a_second_before_and_a_little_silence_belong_to_the_piece(pause_s: float) -> None:
    (piece,) = cuts([QUIET] * 20 + [LOUD] * 10 + [QUIET] * 20, pause_s)
    before, behind = round(BEFORE_S * 10), round(KEPT_S * 10)
    assert piece == QUIET * before + LOUD * 10 + QUIET * behind


def test_what_was_silent_belongs_to_the_piece_if_speech_follows() -> None:
    blocks = [LOUD] * 5 + [QUIET] * 5 + [LOUD] * 5
    (piece,) = cuts([*blocks, *[QUIET] * 9])
    assert piece == b"".join(blocks) + QUIET * round(KEPT_S * 10)


def test_speech_right_behind_a_piece_brings_the_silence_between_them() -> None:
    first, second = cuts([LOUD] * 5 + [QUIET] * 4 + [LOUD] * 5, pause_s=0.35)
    assert first + second == LOUD * 5 + QUIET * 4 + LOUD * 5


@given(
    st.lists(st.tuples(st.integers(2, 6), st.integers(1, 9)), min_size=1, max_size=5),
    st.sampled_from([0.35, 0.8, 1.1]),
)
def test_no_speech_is_lost_and_none_is_heard_twice(
    spoken: list[tuple[int, int]], pause_s: float
) -> None:
    blocks: list[bytes] = []
    for number, (loud, quiet) in enumerate(spoken):
        # Each block is told from the others by its second byte.
        blocks += [bytes([90, number * 20 + i]) * BLOCK for i in range(loud)]
        blocks += [bytes([5, 100 + number * 20 + i]) * BLOCK for i in range(quiet)]
    found = b"".join(cuts(blocks, pause_s))
    assert all(found.count(block) == 1 for block in blocks if block[0] == 90)
    assert all(found.count(block) <= 1 for block in blocks)


def test_a_short_pause_doesnt_cut_and_a_long_one_does() -> None:
    blocks = [LOUD] * 5 + [QUIET] * 5 + [LOUD] * 5 + [QUIET] * 9 + [LOUD] * 5
    assert len(cuts(blocks)) == 2
    assert len(cuts(blocks, pause_s=0.3)) == 3


def test_the_pause_wanted_may_change_while_the_speaker_pauses() -> None:
    cutter = Cutter(Told())
    for block in [LOUD] * 5 + [QUIET] * 4:
        assert not cutter.push(block, 1.5).ends
    assert cutter.push(QUIET, 0.3).ends
    assert not cutter.speaking


def test_noise_that_never_pauses_is_cut_all_the_same() -> None:
    assert len(cuts([LOUD] * round(LONGEST_S * 10 * 2.5))) == 3


def test_the_same_sound_is_cut_the_same_way_after_a_new_beginning() -> None:
    cutter = Cutter(Told())
    blocks = [QUIET] * 3 + [LOUD] * 6 + [QUIET] * 8
    first = [cutter.push(block) for block in blocks]
    cutter.begin()
    assert [cutter.push(block) for block in blocks] == first
