"""Everything that hearing takes, for one world at a time: decoders, the table of sound-alikes, the repairer."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from polaris_nl.speech.activity import Activity, SileroActivity
from polaris_nl.speech.ahead import Ahead
from polaris_nl.speech.doubt import Means
from polaris_nl.speech.hearing import Utterance, Ways, utterance
from polaris_nl.speech.lexicon import SoundAlikes, sound_alikes
from polaris_nl.speech.models import NARROW, model_folder
from polaris_nl.speech.recogniser import Decoder, Spoken, pieces
from polaris_nl.speech.repair import Repairer
from polaris_nl.speech.second import heard_again, in_noise, wants_second
from polaris_nl.speech.vosk_recogniser import VoskModel, VoskRecogniser
from polaris_nl.speech.weight import Weigh
from polaris_nl.speech.whisper_recogniser import WhisperRecogniser, is_installed

_ORDINARY = (
    "the a and to you i it is that was he she we they of in on for with at by so not what have are do this "
    "me my can will just no yes go get bring put take tell who how where when if then but or up out down top "
    "shop step soap drop spot cause course pass past please house"
)
"""Words that other speech is made of, and words that sound like a quick one: what is none of these is quick."""
QUICK_PHRASES = ("stop", "pause", "stop stop stop", *_ORDINARY.split())


@dataclass(frozen=True)
class Ears:
    """What hears one stream of sound in one world.

    Attributes:
        phrased: hears the world's phrases.
        free: hears anything, for a second opinion; None where `phrased` does.
        quick: hears little but the words that act at once.
        activity: where speech is.
        ways: what helps to make sense of what was heard.
        second: hears again what isn't sure, or None.
    """

    phrased: Decoder
    free: Decoder | None
    quick: Decoder
    activity: Activity
    ways: Ways
    second: Ahead | None = None

    @property
    def alikes(self) -> SoundAlikes:
        """Which of the world's words are listened for under other words, and which can't be heard."""
        return self.ways.alikes

    def expect(self, audio: bytes) -> None:
        """A piece of speech may have ended: if it will be heard again, that begins now.

        In noise it always will be. Elsewhere it rarely is, and would only be in the first recogniser's way.
        """
        if self.second is not None and in_noise(audio):
            self.second.begin(audio)

    def utterance(
        self, blocks: Iterable[bytes], weigh: Weigh, means: Means | None = None
    ) -> Utterance:
        """What a recording says as a whole."""
        return self.said(list(pieces(blocks, self.activity, self.phrased, self.free)), weigh, means)

    def piece(self, audio: bytes, weigh: Weigh, means: Means | None = None) -> Utterance:
        """What one piece of speech says, that was cut out before."""
        self.phrased.feed(audio)
        phrased, free = self.phrased.finish(), None
        if self.free is not None:
            self.free.feed(audio)
            free = self.free.finish()
        found = [Spoken.of(phrased, free, audio)] if phrased.texts else []
        return self.said(found, weigh, means)

    def said(self, pieces: Sequence[Spoken], weigh: Weigh, means: Means | None = None) -> Utterance:
        """What pieces of speech say together; what isn't sure is heard again, where that is possible."""
        first = utterance(pieces, weigh, self.ways, means)
        if self.second is None or means is None or not wants_second(first, pieces):
            return first
        opinions = [self.second.opinion(piece.audio) for piece in pieces]
        return heard_again(first, pieces, opinions, weigh, self.ways, means)


class EarMaker:
    """Makes ears, each time the world changes: the models are loaded once.

    Args:
        second: whether a second recogniser hears again what isn't sure; None: if it is installed.

    Raises:
        SpeechError: a package or the model is missing.
    """

    def __init__(self, second: bool | None = None) -> None:
        self._second = is_installed() if second is None else second
        folder = model_folder()
        self._activity: Callable[[], Activity] = SileroActivity
        self._wide = VoskModel(folder)
        self._narrow = VoskModel(folder, NARROW)

    def ears(self, phrases: Sequence[str], names: Iterable[str] = ()) -> Ears:
        """Ears for a world.

        Args:
            phrases: what may be said.
            names: what things are called: words of theirs that the recogniser lacks are listened for under
                others; other phrases with such words are left out, there are more ways to say the same.
        """
        vocabulary = {word for phrase in phrases for word in phrase.split()}
        names = list(names)
        named = {word for name in names for word in name.split()}
        owned = {word for word in vocabulary if word.endswith("'s")}
        bridged = sound_alikes(named | owned, self._wide.knows)
        gaps = (*bridged.gaps, *self._wide.missing(vocabulary - named - owned))
        alikes = SoundAlikes(bridged.inward, gaps)
        phrased = VoskRecogniser(self._wide, alikes.listened_for(phrases))
        free = VoskRecogniser(self._narrow)
        ways = Ways(alikes, Repairer(vocabulary))
        quick = VoskRecogniser(self._narrow, QUICK_PHRASES, alternatives=1)
        second = WhisperRecogniser(names, phrases) if self._second else None
        if second is not None:
            # It takes a second or two; nothing waits for it until something isn't sure.
            threading.Thread(target=second.load, name="loading", daemon=True).start()
        return Ears(
            phrased.decoder(), free.decoder(), quick.decoder(), self._activity(), ways,
            Ahead(second) if second is not None else None,
        )  # fmt: skip

    def whisper_ears(self, phrases: Sequence[str], names: Iterable[str] = ()) -> Ears:
        """Ears of the second recogniser: it knows no phrases, so what it hears is mended toward them.

        Args:
            phrases: what may be said.
            names: what things are called.

        Raises:
            SpeechError: its packages are missing.
        """
        vocabulary = {word for phrase in phrases for word in phrase.split()}
        quick = VoskRecogniser(self._narrow, QUICK_PHRASES, alternatives=1)
        ways = Ways(repairer=Repairer(vocabulary))
        whisper = WhisperRecogniser(names, phrases)
        return Ears(whisper.decoder(), None, quick.decoder(), self._activity(), ways)

    def free_ears(self) -> Ears:
        """Ears that expect nothing in particular."""
        decoder = VoskRecogniser(self._wide).decoder()
        return Ears(decoder, None, decoder, self._activity(), Ways())


def gaps_in_words(alikes: SoundAlikes, names: Iterable[str]) -> list[str]:
    """What a user should know of names that the recogniser lacks, one sentence each."""
    words = {word for name in names for word in name.split()}
    told = [
        f'I listen for "{word}" as "{alikes.inward[word]}".'
        for word in sorted(words & alikes.inward.keys())
    ]
    told += [
        f'I can\'t hear the word "{word}"; give what it names a synonym in the world file.'
        for word in sorted(words.intersection(alikes.gaps))
    ]
    return told
