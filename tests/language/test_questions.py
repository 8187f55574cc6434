"""Questions and commands in ordinary wordings: each is what it is, typed and spoken, and changes nothing.

The wordings are those that `intents/` doesn't have: inverted, indirect, elliptic, with a tag, and with
what people say around them.
"""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from polaris_nl.language.interpretation import Interpretation

from .reader import Talk, language_of, spoken

GIVEN = (
    "Tell the resident that lunch is ready. Once she acknowledges, bring a full tray to her table "
    "and then go home. If she dismisses it, just go to the office."
)
COMMANDS: Mapping[str, str] = {
    "undo": "can you undo that|oops, undo that|no, undo that|take that back please|ok undo the last step",
    "redo": "please redo that|redo the last change",
    "new": "new program please|I want to start over|throw everything away",
    "run": "ok robot, please run it now|could you run the program|yes, go ahead|alright, do it",
    "stop": "stop, stop, stop!|hey, stop|no, stop!|could you please stop right now|don't move",
    "pause": "pause for a moment, please|hang on a second|could you wait a minute",
    "resume": "ok, continue|you can continue now|please carry on",
    "yes": "yep, that's right|yes yes|yeah sure",
    "no": "no, thank you|no no|no, that's not right",
    "help": "can you help me|please help|what can I say to you",
    "read-program": "could you read me the program please|what did I tell you to do",
    "read-plan": "so, what are you going to do?|could you tell me the plan",
    "status": "how's it going|are you done yet",
    "repeat": "could you repeat that|sorry?|say that again, please",
    "quit": "ok, bye|thanks, bye|bye bye",
    "save": "could you save that|save this program, please",
    "load": "please load my program",
}
QUESTIONS: Mapping[str, str] = {
    "where": "any idea where the blanket is?|have you seen my newspaper|I wonder where the book is|"
    "where did I leave the book|where exactly is the cupboard",
    "where-robot": "tell me where you are|what room are you in right now",
    "contents": "do you know what's in the fridge?|is there anything on the desk?|is the fridge empty",
    "which": "who has the pills|can you tell me who is in the office|what does mr brown have|"
    "which of the containers are open|what are you holding",
    "any": "is anyone in the office|tell me if someone is there|does anyone have the pills|"
    "is there a cup on the worktop|are you holding anything",
    "inside": "are the cups in the kitchen|do you know if the tray is in the cafeteria",
    "is-it": "the fridge is closed, isn't it?|did I leave the glasses on the coffee table|"
    "are you sure the fridge is closed|isn't the fridge open?|I'd like to know whether the tray is full",
    "list": "which rooms are there|how many cups do you know|who is there|do you have a blanket",
    "plan": "and if she acknowledges?|what about if she declines|suppose she declines|"
    "I wonder what you will do if she says no",
    "first": "tell me what you will do first|where will you go first?",
    "last": "how does it end|where will you end up",
    "next": "and then?|then what|what happens after that|what will you do then",
    "after-step": "after fetched, what happens?|what happens once fetched is done",
    "before-step": "what comes before fetched",
    "length": "how many steps are there|how long will it take",
    "use": "where will you take the tray|what do you need the tray for|where are you taking the tray",
    "when": "tell me when you will fill the tray",
    "will": "are you going to fill the tray|do you plan to go home",
    "able": "are you capable of opening the fridge|do you know how to open the fridge",
    "why-not": "why don't you open the fridge|what stops you from opening the fridge",
    "why": "why do you go to the cafeteria first|can you explain why you go to the cafeteria|"
    "what is the point of filling the tray|how come",
    "problems": "why not|why can't you do that|what's missing",
    "world": "what is there|what do you know",
}  # fmt: skip
GOALS = (
    "go to the kitchen", "can you open the fridge", "could you please open the wardrobe", "will you go home",
    "start by going to the kitchen", "let the nurse know that bingo is starting", "go home now",
    "take the cup back to the worktop", "you can go to the hall now", "have the fridge open", "let's go home",
    "run to the kitchen", "do you think you could open the fridge", "if the fridge is open, close it",
)  # fmt: skip


def wordings(by_intent: Mapping[str, str]) -> list[tuple[str, str]]:
    return [
        (form, intent)
        for intent, wordings in by_intent.items()
        for wording in wordings.split("|")
        for form in dict.fromkeys((wording, spoken(wording)))
    ]


def said(utterance: str) -> Interpretation:
    """What an utterance means after a program was said; it may not change it unless it is applied."""
    talk = Talk(language_of("care-home"))
    talk.say(GIVEN)
    before = talk.program
    meant = talk.say(utterance)
    assert (talk.program != before) is (meant.outcome == "applied")
    return meant


@pytest.mark.parametrize(("utterance", "command"), wordings(COMMANDS))
def test_it_is_the_command(utterance: str, command: str) -> None:
    meant = said(utterance)
    assert (meant.outcome, meant.command) == ("command", command), meant.say


@pytest.mark.parametrize(("utterance", "kind"), wordings(QUESTIONS))
def test_it_is_the_question(utterance: str, kind: str) -> None:
    meant = said(utterance)
    assert meant.outcome == "answer", meant.say
    assert meant.query is not None
    assert meant.query.kind == kind


@pytest.mark.parametrize("utterance", GOALS)
def test_goals_are_neither(utterance: str) -> None:
    meant = said(utterance)
    assert meant.outcome == "applied", meant.say


def test_two_commands_at_once_are_asked_for_one_by_one() -> None:
    meant = said("undo that and run it")
    assert meant.outcome == "refused"
    assert "One thing at a time" in meant.say


def test_what_was_asked_about_is_meant_afterwards() -> None:
    talk = Talk(language_of("dinner-party"))
    talk.say("Where is the fork?")
    assert talk.say("Bring it to the dining table.").outcome == "applied"
    (checkpoint,) = list(talk.program.checkpoints.values())[1:]
    assert [str(g) for g in checkpoint.goals] == ["(at fork dining-table)"]


def test_after_that_goes_on_from_the_case_that_was_asked_about() -> None:
    talk = Talk(language_of("care-home"))
    talk.say(GIVEN)
    asked = talk.say("What will you do if she acknowledges?").query
    following = talk.say("And then?").query
    assert asked is not None
    assert following is not None
    assert following.checkpoint is not None
    goals = talk.program.checkpoints[following.checkpoint].goals
    assert "(at tray table)" in [str(g) for g in goals]
