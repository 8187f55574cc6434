"""Whole conversations by voice alone, from sound to log."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from polaris_nl.execution.events import CommandGiven, Heard, RunEnded, RunStarted, Said, Understood
from polaris_nl.hands_free.recording import kept
from polaris_nl.hands_free.weight import weigher
from polaris_nl.logs.chain import chain
from polaris_nl.logs.reader import read_log
from polaris_nl.speech.ears import EarMaker
from polaris_nl.speech.modes import Attention
from polaris_nl.speech.trouble import Trouble
from polaris_nl.speech.wake import MicroWakeWord
from tests.hands_free.talking import Counted, Talk
from tests.speech.speaking import Saying

CAREGIVING = (
    "tell the resident that lunch is ready",
    "once she acknowledges bring a full tray to the dining table and then go home",
    "no i meant her table",
    "if she dismisses it just go to the office",
    "what will you do if she dismisses it",
    "undo that",
    "if she dismisses it just go home",
    "read me the program",
    "run it",
    "yes",
    "stop",
)
TIDYING = (
    "put the cup and the plate on the countertop",
    "when both are on the drying rack open the cupboard and put them in it",
    "before that go to the hall",
    "no i meant the pantry",
    "where are you",
    "and then go to the lounge",
    "scratch that",
    "run it",
    "yes",
    "stop",
)


@pytest.fixture(scope="module")
def maker() -> EarMaker:
    return EarMaker()


@pytest.mark.parametrize(
    ("world", "said", "goals"),
    [
        ("care-home", CAREGIVING, {"(at tray table)", "(is-full tray)", "(robot-at home)"}),
        ("dinner-party", TIDYING, {"(in cup cupboard)", "(in plate cupboard)", "(open cupboard)"}),
    ],
)
def test_a_paper_program_is_authored_corrected_run_and_stopped_by_voice(
    maker: EarMaker, tmp_path: Path, world: str, said: tuple[str, ...], goals: set[str]
) -> None:
    path = tmp_path / "talk.mcap"
    with Talk(world, maker, path) as talk:
        face = talk.hold(Saying(*said))
        assert talk.conversation.running is not None
        assert talk.conversation.running.join(20)
        automaton = talk.session.snapshot.automaton
    found = {str(g) for c in automaton.checkpoints.values() for g in c.goals}
    assert goals <= found
    assert [r.said.text for r in face.heard] == list(said[:-1])  # "stop" acts before it is answered
    assert "Stopped." in face.told
    log = read_log(path)
    heard = [e for e in log.events if isinstance(e, Heard)]
    assert [e.utterance for e in heard] == list(said)
    assert all(e.decision == "accepted" and e.alternatives and e.audio for e in heard)
    assert any(isinstance(e, RunStarted) for e in log.events)
    (ended,) = (e for e in log.events if isinstance(e, RunEnded))
    assert ended.outcome == "stopped"
    assert [e.command for e in log.events if isinstance(e, CommandGiven)][-1] == "stop"
    aloud = [e.text for e in log.events if isinstance(e, Said)]
    assert aloud == [r.text for r in face.heard]
    assert all(len(text) <= 400 for text in aloud)
    of_run = read_log(tmp_path / "talk-run-1.mcap").events
    started = next(e for e in of_run if isinstance(e, RunStarted))
    stop = next(e for e in of_run if isinstance(e, CommandGiven))
    assert [e.utterance for e in of_run if isinstance(e, Heard)] == list(said)
    assert [e.utterance for e in chain(of_run, stop.id) if isinstance(e, Heard)] == ["stop"]
    assert "yes" in [e.utterance for e in chain(of_run, started.id) if isinstance(e, Heard)]


def test_the_sound_in_a_log_is_heard_again_bit_for_bit(maker: EarMaker, tmp_path: Path) -> None:
    path = tmp_path / "talk.mcap"
    with Talk("care-home", maker, path) as talk:
        talk.hold(Saying(*CAREGIVING[:3]))
    log = read_log(path)
    heard = {e.audio: e for e in log.events if isinstance(e, Heard)}
    understood = [e.interpretation["edits"] for e in log.events if isinstance(e, Understood)]
    again = []
    with Talk("care-home", maker) as talk:
        for name, audio in kept(log.sounds):
            found = talk.ears.piece(audio, weigher(talk.session))
            assert found.text == heard[name].utterance
            assert list(found.alternatives[:10]) == heard[name].alternatives
            assert found.free == heard[name].free
            again.append(talk.session.say(found.text).interpretation.edits)
    assert [len(edits) for edits in again] == [len(edits) for edits in understood]
    assert len(again) == 3


def test_without_a_yes_nothing_runs(maker: EarMaker, tmp_path: Path) -> None:
    with Talk("care-home", maker, tmp_path / "a.mcap") as talk:
        face = talk.hold(Saying("go to the kitchen", "run it", "no", "yes"))
        assert talk.conversation.running is None
    assert face.texts[2] == "All right, I won't start."


def test_chatter_is_left_alone_and_never_answered(maker: EarMaker) -> None:
    chatter = (
        "the doctor says my blood pressure is fine again",
        "thank you so much that's very kind",
    )
    with Talk("care-home", maker) as talk:
        face = talk.hold(Saying(*chatter))
        assert len(talk.session.snapshot.automaton.checkpoints) == 1
    assert face.texts == ["", ""]
    assert talk.voice.said == []


def test_asleep_only_quick_words_and_waking_are_heard(maker: EarMaker) -> None:
    said = ("go to sleep", "go to the kitchen", "stop", "wake up", "go to the office")
    with Talk("care-home", maker) as talk:
        face = talk.hold(Saying(*said))
        goals = [
            str(g) for c in talk.session.snapshot.automaton.checkpoints.values() for g in c.goals
        ]
    assert goals == ["(robot-at office)"]
    assert "asleep" in face.states
    assert "Stopped." in face.told


def test_the_wake_word_opens_a_window_for_more(maker: EarMaker) -> None:
    said = ("go to the kitchen", "hey jarvis", "go to the office", "then go home")
    source = Counted(Saying(*said))
    with Talk("care-home", maker) as talk:
        face = talk.hold(source, Attention("wake"), source.now, wake_word=MicroWakeWord())
        goals = [
            str(g) for c in talk.session.snapshot.automaton.checkpoints.values() for g in c.goals
        ]
    assert goals == ["(robot-at office)", "(robot-at home)"]
    assert face.states[:2] == ["waiting", "listening"]


def test_what_isn_t_understood_twice_is_offered_by_number(maker: EarMaker) -> None:
    nonsense = "the newspaper should tell the table to the kitchen"
    said = (nonsense, nonsense, "number two")
    source = Counted(Saying(*said))
    with Talk("care-home", maker) as talk:
        face = talk.hold(source, Attention("wake", until=60), source.now)
    assert "Did you mean one:" in face.texts[1]
    assert face.heard[2].answer is not None or "other words" in face.texts[2]


def test_trouble_with_the_source_is_said_at_once(maker: EarMaker) -> None:
    class Broken(Saying):
        def sound(self) -> Iterator[bytes | Trouble]:
            yield Trouble("The microphone gives no sound any more.")
            yield from super().sound()

    with Talk("care-home", maker) as talk:
        face = talk.hold(Broken("go to the kitchen"))
        assert talk.speaker.wait(10)
        assert face.told == ["The microphone gives no sound any more."]
        assert talk.voice.said[0] == "The microphone gives no sound any more."
    assert face.heard[0].said.text == "go to the kitchen"


class WhileSpeaking(Saying):
    """Somebody speaks while the program does."""

    def __init__(self, talk: Talk, *sentences: str) -> None:
        super().__init__(*sentences)
        self._talk = talk

    def sound(self) -> Iterator[bytes | Trouble]:
        self._talk.voice.endless = True
        self._talk.speaker.say("A long story.")
        while not self._talk.speaker.saying:
            pass
        yield from super().sound()


def test_with_a_headset_a_voice_silences_the_program_and_is_heard(maker: EarMaker) -> None:
    with Talk("care-home", maker) as talk:
        face = talk.hold(
            WhileSpeaking(talk, "go to the kitchen"), Attention("always", half_duplex=False)
        )
        assert talk.voice.interrupted >= 1
    assert [r.said.text for r in face.heard] == ["go to the kitchen"]


def test_without_one_it_hears_only_quick_words_while_it_speaks(maker: EarMaker) -> None:
    with Talk("care-home", maker) as talk:
        face = talk.hold(WhileSpeaking(talk, "go to the kitchen", "stop"))
        assert talk.voice.interrupted == 1
    assert face.heard == []
    assert face.told == ["Stopped."]
    assert face.states[0] == "speaking"
