"""`transcribe`: recordings to words and what they mean."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import replace
from pathlib import Path
from typing import Any

from polaris_nl.commands.common import complain, print_json, print_text, session_of
from polaris_nl.language.interpretation import Refusal
from polaris_nl.model.errors import SpeechError
from polaris_nl.session import Session
from polaris_nl.snapshot import Answer, answer_json
from polaris_nl.speech.audio import file_blocks
from polaris_nl.speech.hearing import Utterance, utterance
from polaris_nl.speech.models import model_folder
from polaris_nl.speech.recogniser import VoskModel, VoskRecogniser

NOT_MEANT = (
    "That didn't sound like something for the robot, so I left it alone. Say it again if it was."
)


def run(arguments: Namespace) -> int:
    """Transcribes each file, for itself or as one dialogue; 1 where one isn't understood or can't be read."""
    code = 0
    model = VoskModel(model_folder())
    with session_of(arguments) as session:
        ear = Ear(session, model, arguments.free)
        start = session.snapshot.automaton
        for number, path in enumerate(arguments.files):
            if number and not arguments.dialogue:
                session.begin_again(start)
            try:
                said, answer = ear.file(path)
            except SpeechError as error:
                complain(str(error))
                if arguments.json:
                    print_json(
                        {
                            "file": str(path),
                            "outcome": "refused",
                            "accepted": False,
                            "error": str(error),
                        }
                    )
                code = 1
                continue
            show(path, said, answer, session, arguments.json)
            code = code or int(answer.interpretation.outcome == "refused" or bool(answer.failure))
    return code


class Ear:
    """Hears recordings in one session.

    Args:
        session: what is heard changes its program.
        model: the speech model.
        free: recognise any words; whether they are meant for the robot is then for the parser alone.
    """

    def __init__(self, session: Session, model: VoskModel, free: bool = False) -> None:
        self._session = session
        self._free = VoskRecogniser(model)
        self._phrased = (
            self._free if free else VoskRecogniser(model, session.understanding.phrases())
        )
        self._is_free = free

    def words(self, path: Path) -> Utterance:
        """What a recording says.

        Raises:
            SpeechError: it can't be read.
        """
        pieces = list(self._phrased.hear(file_blocks(path)))
        freely = None if self._is_free else self._free.words
        return utterance(pieces, self._session.parses, freely)

    def file(self, path: Path) -> tuple[Utterance, Answer]:
        """Hears a recording and carries out what it says."""
        said = self.words(path)
        if said.accepted or (said.text and not self._session.parses(said.text)):
            return said, self._session.say(said.text, source=path.name)
        return said, not_meant(self._session, said)


def not_meant(session: Session, said: Utterance) -> Answer:
    """The answer to speech that isn't taken for the robot's."""
    answer = session.say("", source="speech")
    refused = replace(
        answer.interpretation, utterance=said.text, say=NOT_MEANT, refusal=Refusal(NOT_MEANT)
    )
    return replace(answer, interpretation=refused, say=NOT_MEANT)


def show(path: Path, said: Utterance, answer: Answer, session: Session, as_json: bool) -> None:
    """Prints what was heard and what was answered."""
    if as_json:
        value: dict[str, Any] = answer_json(answer, session.program)
        heard = {"file": str(path), "heard": said.text, "accepted": said.accepted}
        print_json({**value, **heard, "audio_s": round(said.audio_s, 2)})
        return
    print_text(said.text or "(nothing)", f"{path.name}: ")
    print_text(answer.say)
