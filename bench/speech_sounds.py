"""What is said in the benches of speech."""

from __future__ import annotations

from polaris_nl.speech.audio import BLOCK, Converter, level
from polaris_nl.speech.voices import HibariVoice

SENTENCES = (
    "tell the resident that lunch is ready",
    "once she acknowledges bring a full tray to her table and then go home",
    "if she dismisses it just go home",
    "what will you do if she dismisses it",
    "put the blue cup in the cupboard",
    "undo that",
    "take the newspaper to the office desk",
    "read me the program",
)
SILENCE = b"\0\0" * BLOCK
_QUIET_DB = -45.0


def spoken(text: str) -> list[bytes]:
    """A sentence in blocks of 100 ms, to its last sound: time counts from there."""
    speech = HibariVoice().speech(text)
    converter = Converter(speech.rate)
    sound = b"".join([*converter.push_bytes(speech.samples, 2, 1), *converter.rest()])
    blocks = [sound[at : at + BLOCK * 2] for at in range(0, len(sound), BLOCK * 2)]
    while level(blocks[-1]) < _QUIET_DB:
        blocks.pop()
    return [*blocks[:-1], blocks[-1].ljust(BLOCK * 2, b"\0")]
