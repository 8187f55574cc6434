"""`listen`: the hands-free loop without a screen."""

from __future__ import annotations

from argparse import Namespace

from polaris_nl.commands.common import complain, print_json, print_text, session_of
from polaris_nl.commands.transcribe import not_meant
from polaris_nl.snapshot import answer_json
from polaris_nl.speech.audio import source_blocks
from polaris_nl.speech.hearing import utterance
from polaris_nl.speech.models import model_folder
from polaris_nl.speech.recogniser import VoskModel, VoskRecogniser


def run(arguments: Namespace) -> int:
    """Answers each sentence as soon as it has ended, until sound or user do; 1 where a save failed."""
    code = 0
    blocks = source_blocks(arguments.mic)
    model = VoskModel(model_folder())
    with session_of(arguments) as session:
        recogniser = VoskRecogniser(model, session.understanding.phrases())
        free = VoskRecogniser(model)
        if not arguments.json:
            print_text(
                'Listening. Say what the robot should achieve; "help" tells more, "quit" ends.'
            )
        for piece in recogniser.hear(blocks):
            said = utterance([piece], session.parses, free.words)
            answer = (
                session.say(said.text, source="voice")
                if said.accepted
                else not_meant(session, said)
            )
            if arguments.json:
                heard = {
                    "heard": said.text,
                    "accepted": said.accepted,
                    "audio_s": round(said.audio_s, 2),
                }
                print_json({**answer_json(answer, session.program), **heard})
            else:
                print_text(said.text, "You: ")
                print_text(answer.say)
            if answer.failure:
                complain(answer.failure)
                code = 1
            if answer.interpretation.command == "quit":
                break
    return code
