"""The level of speech that the speech set's noise is measured against."""

from __future__ import annotations

from itertools import pairwise

import numpy
import pytest

from bench.speech_audio import active_power
from polaris_nl.speech.audio import RATE


def _tone(seconds: float, height: float) -> numpy.ndarray:
    return height * numpy.sin(2 * numpy.pi * 500 * numpy.arange(round(RATE * seconds)) / RATE)


def _silence(seconds: float) -> numpy.ndarray:
    return numpy.zeros(round(RATE * seconds))


@pytest.mark.parametrize("height", [0.05, 0.2, 0.7])
@pytest.mark.parametrize("pause", [0.5, 2, 8])
def test_pauses_do_not_count(height: float, pause: float) -> None:
    samples = numpy.concatenate([_silence(pause), _tone(3, height), _silence(pause)])
    decibels = 10 * numpy.log10(active_power(samples) / (height**2 / 2))
    assert -0.5 < decibels < 0.1  # The last 200 ms of what counts are silent.


def test_twice_as_high_is_six_decibels_more() -> None:
    sound = numpy.concatenate([_tone(1, 0.2), _silence(0.5), _tone(0.5, 0.1), _silence(3)])
    powers = [active_power(sound * factor) for factor in (0.5, 1, 2, 4)]
    assert all(abs(b / a - 4) < 0.05 for a, b in pairwise(powers))


def test_silence_has_no_level_to_divide_by() -> None:
    assert active_power(_silence(1)) > 0
