"""`both` of two things that are named, or of two of a kind; of three it is asked which."""

from __future__ import annotations

import pytest

from bench.speech_meaning import Context

from .test_requests import understanding


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("put both the cup and the plate on the desk", "start [(at cup desk) & (at plate desk)]"),
        ("both the cup and the plate should be on the desk", "start [(at cup desk) & (at plate desk)]"),
        (
            "tell both the lady and the gentleman that lunch is ready",
            "start [(alerted-to mr-brown lunchtime) & (alerted-to resident lunchtime)]",
        ),
        ("put both cups on the desk", "question: cup, blue cup, red cup"),
        ("put both cups and the plate on the desk", "question: cup, blue cup, red cup"),
    ],
)  # fmt: skip
def test_both_says_it_of_two(said: str, meant: str) -> None:
    assert Context(understanding("care-home")).understood(said)[1] == meant
