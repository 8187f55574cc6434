"""`listen`: the hands-free loop without a screen."""

from __future__ import annotations

import sys
import threading
import time
from argparse import Namespace

from polaris_nl.commands.common import complain, print_json, print_text
from polaris_nl.commands.session_log import logged_session
from polaris_nl.commands.transcribe import ears_for
from polaris_nl.execution.events import Event, Said
from polaris_nl.hands_free.conversation import Conversation, Reply
from polaris_nl.hands_free.listening import Listening
from polaris_nl.hands_free.phrases import spoken_names
from polaris_nl.hands_free.recording import AudioKeeper
from polaris_nl.hands_free.runs import Runs
from polaris_nl.logs.privacy import privacy_of
from polaris_nl.logs.writer import LogWriter
from polaris_nl.model.errors import UsageError
from polaris_nl.robot_runs import carry_out_with, profile_of
from polaris_nl.session import Session
from polaris_nl.snapshot import answer_json
from polaris_nl.speech.audio import level
from polaris_nl.speech.ears import EarMaker, Ears, gaps_in_words
from polaris_nl.speech.microphone import microphones
from polaris_nl.speech.modes import Attention, State
from polaris_nl.speech.sources import Source, source_for
from polaris_nl.speech.speaker import SoundPlayer, Speaker
from polaris_nl.speech.trouble import Trouble
from polaris_nl.speech.voices import find_voice
from polaris_nl.speech.wake import WORDS, MicroWakeWord

LEVEL_S = 3.0
_TOO_QUIET, _TOO_LOUD = -50.0, -6.0
_HOW = {
    "always": "Say", "talk": "Press Enter, then say", "wake": f'Say "{WORDS[0]}", then say',
}  # fmt: skip
_STATES: dict[State, str] = {
    "listening": "Listening.", "waiting": "Waiting to be called.", "asleep": "Asleep.", "speaking": "",
}  # fmt: skip


def run(arguments: Namespace) -> int:
    """Answers each sentence as soon as it has ended, until sound or user do; 1 where a save failed."""
    if arguments.microphones:
        return _list(arguments.json)
    source = source_for(arguments.mic, arguments.allow_remote)
    if arguments.level:
        return _level(source, arguments.json)
    maker, profile = EarMaker(arguments.second), profile_of(arguments.robot)
    if arguments.record and arguments.log is None:
        raise UsageError("--record keeps the sound in a log; name one with --log OUT.mcap.")
    with logged_session(arguments) as (session, log):
        ears = ears_for(session, maker, arguments.recogniser)
        session.warm_up()
        face = _Face(session, arguments.json, _HOW[arguments.mode])
        for text in gaps_in_words(ears.alikes, spoken_names(session.understanding)):
            complain(text)

        def sink(event: Event) -> None:
            if log is not None:
                log.write(event)

        conversation = Conversation(
            session, sink, arguments.aloud, profile.title if profile is not None else ""
        )
        speaker = _speaker(arguments)

        def tell(text: str) -> None:
            face.tells(text)
            if speaker is not None:
                speaker.say(text, "run")
                sink(Said(time=time.time(), text=text, aloud=True))

        listening = _listening(arguments, source, ears, conversation, face, speaker, log)
        runs = Runs(
            conversation, sink, tell, arguments.log, carry_out_with(profile),
            privacy_of(arguments.leave_out),
        )  # fmt: skip
        listening.started = runs.start
        try:
            listening.run()
        finally:
            runs.close()
            if speaker is not None:
                speaker.close()
    return face.code


def _listening(
    arguments: Namespace,
    source: Source,
    ears: Ears,
    conversation: Conversation,
    face: _Face,
    speaker: Speaker | None,
    log: LogWriter | None,
) -> Listening:
    listening = Listening(
        source, ears, conversation, face,
        Attention(arguments.mode, half_duplex=not arguments.headset), speaker,
        MicroWakeWord() if arguments.mode == "wake" else None,
        AudioKeeper(log).keep if log is not None and arguments.record else None,
    )  # fmt: skip
    if speaker is not None:
        speaker.changed = listening.spoke
    if arguments.mode == "talk" and sys.stdin.isatty():
        threading.Thread(target=_keys, args=(listening,), name="keys", daemon=True).start()
    return listening


class _Face:
    """Prints what is heard and answered."""

    def __init__(self, session: Session, as_json: bool, how: str) -> None:
        self._session = session
        self._json = as_json
        self._how = how
        self.code = 0

    def shows(self, state: State) -> None:
        """Whether it listens now; the first time, with sound coming in, how to be heard."""
        if self._how and not self._json:
            print_text(
                f'{self._how} what the robot should achieve; "help" tells more, "quit" ends.'
            )
            self._how = ""
        if not self._json and _STATES[state]:
            print_text(_STATES[state], "-- ")

    def tells(self, text: str) -> None:
        """A sentence about the microphone, the mode or the run."""
        if self._json:
            print_json({"tells": text})
        else:
            print_text(text)

    def replies(self, reply: Reply) -> None:
        """What was heard, and what came of it."""
        if self._json:
            self._print(reply)
        elif reply.text:
            print_text(reply.said.text, "You: ")
            print_text(reply.text)
        if reply.answer is not None and reply.answer.failure:
            complain(reply.answer.failure)
            self.code = 1

    def _print(self, reply: Reply) -> None:
        said = reply.said
        heard = {
            "heard": said.text, "accepted": said.accepted, "audio_s": round(said.audio_s, 2),
        }  # fmt: skip
        if reply.answer is not None:
            print_json({**answer_json(reply.answer, self._session.program), **heard})
        else:
            outcome = "command" if said.accepted else "refused"
            print_json({"utterance": said.text, "outcome": outcome, "say": reply.text, **heard})


def _speaker(arguments: Namespace) -> Speaker | None:
    if not arguments.aloud:
        return None
    return Speaker(find_voice(), SoundPlayer())


def _keys(listening: Listening) -> None:
    for _ in sys.stdin:
        listening.key()


def _list(as_json: bool) -> int:
    found = microphones()
    if as_json:
        print_json({"microphones": found})
    else:
        for number, name in enumerate(found):
            print_text(f"{number}: {name}")
        if not found:
            complain("There is no microphone here. A recording can be given: --mic FILE.wav")
    return 0 if found else 1


def _level(source: Source, as_json: bool) -> int:
    """Measures the sound for some seconds while the user speaks, and says whether it will do."""
    loudest, until = -90.0, time.monotonic() + LEVEL_S
    if not as_json:
        print_text(f"Speak for {LEVEL_S:.0f} seconds.")
    for sound in source.sound():
        if isinstance(sound, Trouble):
            complain(sound.text)
        else:
            loudest = max(loudest, level(sound))
        if source.live and time.monotonic() > until:
            break
    verdict = "is good"
    if loudest < _TOO_QUIET:
        verdict = "is too quiet: move closer, or choose another microphone with --mic"
    elif loudest > _TOO_LOUD:
        verdict = "is too loud: turn the microphone down"
    if as_json:
        print_json({"source": source.name, "level": round(loudest, 1), "verdict": verdict})
    else:
        print_text(f"{source.name}: {loudest:.0f} dB, which {verdict}.")
    return 0 if verdict == "is good" else 1
