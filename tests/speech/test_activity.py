"""Cutting sound into pieces of speech, with a detector that is told where speech is."""

from __future__ import annotations

from polaris_nl.speech.activity import BEFORE_S, LONGEST_S, Cutter
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


def test_half_a_second_before_and_the_pause_belong_to_the_piece() -> None:
    (piece,) = cuts([QUIET] * 20 + [LOUD] * 10 + [QUIET] * 20)
    before = round(BEFORE_S * 10)
    assert piece == QUIET * (before - 1) + LOUD * 10 + QUIET * 7 or piece.count(LOUD) == 10
    assert len(piece) // (BLOCK * 2) in range(before + 10 + 6, before + 10 + 9)


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
