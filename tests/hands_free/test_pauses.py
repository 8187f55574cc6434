"""How long is waited for more, with all that may be said in a world."""

from __future__ import annotations

from polaris_nl.hands_free.phrases import spoken_names, spoken_phrases
from polaris_nl.hands_free.weight import weigher
from polaris_nl.model.world_file import load_world
from polaris_nl.session import Session
from polaris_nl.speech.ears import EarMaker
from polaris_nl.speech.hearer import Heard, Hearer
from tests.speech.speaking import blocks_of, silence, spoken


def test_the_last_word_is_known_when_the_pause_begins() -> None:
    """Wherever the blocks begin: without it, "read me the" would wait for more."""
    with Session(load_world("care-home")) as session:
        understanding = session.understanding
        phrases, names = spoken_phrases(understanding), spoken_names(understanding)
        hearer = Hearer(EarMaker(second=False).ears(phrases, names), weigher(session))
        for milliseconds in range(0, 100, 20):
            sound = bytes(milliseconds * 32) + spoken("read me the program")
            blocks = [*silence(0.6), *blocks_of(sound), *silence(2)]
            (heard,) = (h for b in blocks for h in hearer.push(b, True) if isinstance(h, Heard))
            assert heard.spoken.alternatives[0] == "read me the program"
            assert heard.pause_s < 0.6, milliseconds
