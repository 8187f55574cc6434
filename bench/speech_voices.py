"""Which voices say which sentences of the speech set, and where their sound is kept."""

from __future__ import annotations

import hashlib
from pathlib import Path

FOLDER = Path.home() / ".cache" / "polaris-nl" / "speech-set"
QUICK = ("joe", "slt", "rms")
SLOW = ("heart", "kumo")
"""Voices that take longer to speak than all the others: each says a fifth of the set only."""
VOICES = (*SLOW, *QUICK)


def voices_of(text: str) -> tuple[str, ...]:
    """The voices that say a sentence: two quick ones, and for two sentences of five a slow one as well."""
    turn = int(_hash(text), 16)
    quick = tuple(voice for voice in QUICK if voice != QUICK[turn // 5 % len(QUICK)])
    return (*SLOW[turn % 5 : turn % 5 + 1], *quick)


def sound_file(text: str, voice: str) -> Path:
    """Where a sentence in a voice is kept."""
    return FOLDER / voice / f"{_hash(text)}.flac"


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]
