"""`transcribe`: recordings to words and what they mean."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import replace
from pathlib import Path
from typing import Any

from polaris_nl.commands.common import complain, print_json, print_text, session_of
from polaris_nl.hands_free.phrases import spoken_names, spoken_phrases
from polaris_nl.hands_free.recording import kept
from polaris_nl.hands_free.weight import Sense
from polaris_nl.language.interpretation import Refusal
from polaris_nl.logs.reader import read_log
from polaris_nl.model.errors import LogError, SpeechError
from polaris_nl.model.text import listed
from polaris_nl.session import Session
from polaris_nl.snapshot import Answer, answer_json
from polaris_nl.speech.audio import file_blocks
from polaris_nl.speech.ears import EarMaker, Ears, gaps_in_words
from polaris_nl.speech.hearing import Utterance

NOT_MEANT = (
    "That didn't sound like something for the robot, so I left it alone. Say it again if it was."
)


def run(arguments: Namespace) -> int:
    """Transcribes each file, for itself or as one dialogue; 1 where one isn't understood or can't be read."""
    code = 0
    maker = EarMaker(arguments.second)
    with session_of(arguments) as session:
        ears = (
            maker.free_ears() if arguments.free else ears_for(session, maker, arguments.recogniser)
        )
        for text in gaps_in_words(ears.alikes, spoken_names(session.understanding)):
            complain(text)
        start = session.snapshot.automaton
        for number, path in enumerate(arguments.files):
            if number and not arguments.dialogue:
                session.begin_again(start)
            try:
                if path.suffix == ".mcap":
                    code = replay(path, ears, session, arguments.json) or code
                    continue
                said, answer = hear_file(path, ears, session)
            except (SpeechError, LogError) as error:
                complain(str(error))
                if arguments.json:
                    refused = {"file": str(path), "outcome": "refused", "accepted": False}
                    print_json({**refused, "error": str(error)})
                code = 1
                continue
            show(path, said, answer, session, arguments.json)
            code = code or int(answer.interpretation.outcome == "refused" or bool(answer.failure))
    return code


def replay(path: Path, ears: Ears, session: Session, as_json: bool) -> int:
    """Hears the sound that a log keeps again, as the conversation that it was; 1 where some isn't understood.

    Raises:
        LogError: it can't be read, or keeps no sound.
    """
    sounds = read_log(path).sounds
    if not sounds:
        raise LogError(f"The log {path} keeps no sound; listen --log FILE --record keeps it.")
    code = 0
    for name, audio in kept(sounds):
        sense = Sense(session)
        said, answer = take(ears.piece(audio, sense.weigh, sense.means), name, session)
        show(Path(name), said, answer, session, as_json)
        code = code or int(answer.interpretation.outcome == "refused")
    return code


def ears_for(session: Session, maker: EarMaker, recogniser: str = "vosk") -> Ears:
    """Ears for a session's world.

    Raises:
        SpeechError: the recogniser's packages are missing.
    """
    phrases, names = spoken_phrases(session.understanding), spoken_names(session.understanding)
    if recogniser == "whisper":
        return maker.whisper_ears(phrases, names)
    return maker.ears(phrases, names)


def hear_file(path: Path, ears: Ears, session: Session) -> tuple[Utterance, Answer]:
    """Hears a recording and carries out what it says.

    Raises:
        SpeechError: it can't be read.
    """
    sense = Sense(session)
    said = ears.utterance(file_blocks(path), sense.weigh, sense.means)
    return take(said, path.name, session)


def take(said: Utterance, source: str, session: Session) -> tuple[Utterance, Answer]:
    """Carries out what was said."""
    # What isn't understood at all is handed on for its reason; what is doubtful mustn't change anything.
    if said.accepted or (said.text and session.understood(said.text).outcome == "refused"):
        return said, session.say(said.text, source=source)
    return said, not_meant(session, said)


def not_meant(session: Session, said: Utterance) -> Answer:
    """The answer to speech that isn't taken for the robot's."""
    answer = session.say("", source="speech")
    say = NOT_MEANT
    if said.doubts:
        found = listed([f'"{text}"' for text in said.doubts], "or")
        say = f"I may have misheard, so I left it alone. Say it again if it was {found}."
    refused = replace(answer.interpretation, utterance=said.text, say=say, refusal=Refusal(say))
    return replace(answer, interpretation=refused, say=say)


def show(path: Path, said: Utterance, answer: Answer, session: Session, as_json: bool) -> None:
    """Prints what was heard and what was answered."""
    if as_json:
        value: dict[str, Any] = answer_json(answer, session.program)
        heard = {"file": str(path), "heard": said.text, "accepted": said.accepted}
        print_json({**value, **heard, "audio_s": round(said.audio_s, 2)})
        return
    print_text(said.text or "(nothing)", f"{path.name}: ")
    print_text(answer.say)
