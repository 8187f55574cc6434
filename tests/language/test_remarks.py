"""What is said around a request and asks for nothing is passed over, and nothing that asks for something is."""

from __future__ import annotations

import pytest

from bench.speech_meaning import Context

from .test_requests import understanding

ALL_IN_THE_SINK = "(forall (?x - object) (imply (kind ?x dish) (at ?x sink)))"


def meant(world: str, said: str, *after: str) -> str:
    return Context(understanding(world), after).understood(said)[1]


@pytest.mark.parametrize(
    "said",
    [
        "take tom the newspaper he can't find it anywhere",
        "take tom the newspaper he likes to read after his nap",
        "take tom the newspaper he is waiting in the office",
        "take tom the newspaper he can't find his way without the headlines",
        "take tom the newspaper bless him",
        "take tom the newspaper he was asking for",
        "take tom the newspaper there's no hurry",
        "take tom the newspaper would you but do be careful",
        "hi there take tom the newspaper people are waiting",
        "i've had an idea take tom the newspaper he'll find it useful",
        "take tom the newspaper the bingo's over",
        "take tom the newspaper or he gets bored",
        "take tom the newspaper so the old man can read",
        "take tom the newspaper before the room gets dark",
        "take tom the newspaper while i look for the other one",
        "he forgets it every single day so take tom the newspaper",
        "the last thing i want is that he has nothing to read so take tom the newspaper",
        "the newspaper is in the way take it to tom",
        "tom has lost his and needs the newspaper",
    ],
)
def test_remarks_behind_a_request_are_passed_over(said: str) -> None:
    assert meant("care-home", said) == "start [(has mr-brown newspaper)]"


@pytest.mark.parametrize(
    "said",
    [
        "put the cup on the desk you are to sweep the floor",
        "put the cup on the desk you have to sweep the floor",
        "put the cup on the desk if he is asleep",
        "put the cup on the desk he is asleep take the floor mat away",
        "put the cup on the desk there is something else take the floor mat away",
        "go to the office it is where the nurse is and fill the tray",
        "bring tom the cup that is chipped",
        "put the cup on the desk he is asleep mop the floor",
        "put the cup on the desk it is dark switch on the light",
        "put the cup on the desk he is asleep ring up the doctor",
        "put the cup on the desk she is waiting the plate on the table",
        "put the cup on the desk she is waiting the book to tom",
        "that has gone delete the part where you go home",
        "that has gone to leak the park there you go home",
        "go home when the lady is dizzy",
        "do not go home before the soup is hot",
        "nobody likes the new carpet in the hall",
        "where is the cup i can't find it",
        "i am cleaning so everything in the lamp must come to the desk",
    ],
)
def test_what_asks_for_more_is_no_remark(said: str) -> None:
    assert not meant("care-home", said).startswith("start")


def test_a_remark_that_wants_something_known_asks_for_it() -> None:
    said = "put the cup on the desk he'll need the towel"
    assert "(has mr-brown towel)" in meant("care-home", said)


@pytest.mark.parametrize(
    ("said", "after", "expected"),
    [
        (
            "oh sorry i meant the blanket it's cold in there",
            "bring miss green her book",
            "(has resident blanket)",
        ),
        (
            "actually give it to tom he asked for it first",
            "bring miss green her book",
            "(has mr-brown book)",
        ),
        (
            "take it to tom instead she's eaten already",
            "bring miss green her book",
            "(has mr-brown book)",
        ),
    ],
)
def test_a_correction_can_say_why(said: str, after: str, expected: str) -> None:
    assert meant("care-home", said, after) == f"start [{expected}]"


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ("oh undo that she's fast asleep", "start"),
        ("pause for a moment someone's at the door", "command: pause"),
        ("stop stop the kid's in front of you", "command: stop"),
        ("right then let's get going or we'll miss it", "refused"),
        ("yes she's coming tomorrow", "refused"),
    ],
)
def test_a_command_can_say_why_but_none_that_starts_or_agrees(said: str, expected: str) -> None:
    assert meant("care-home", said, "bring miss green her book").rstrip() == expected


@pytest.mark.parametrize(
    ("after", "said", "expected"),
    [
        (
            "take the host the spoon",
            "give the spoon to anna instead of the host",
            "[(has guest spoon)]",
        ),
        (
            "take the host the fork and the spoon",
            "give the spoon to anna instead of the host",
            "[(has guest spoon) & (has host fork)]",
        ),
        (
            "put the plate in the cupboard",
            "put the plate in the sink instead of the cupboard",
            "[(at plate sink)]",
        ),
        (
            "take the host the spoon",
            "give the fork to anna instead of the host",
            "[(has host spoon) [(has guest fork)]]",
        ),
    ],
)
def test_what_is_wanted_instead_takes_the_place_of_only_that(
    after: str, said: str, expected: str
) -> None:
    assert meant("dinner-party", said, after) == f"start {expected}"


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ("gather up all the dishes and put them in the sink", ALL_IN_THE_SINK),
        ("take all the dishes and put them in the sink", ALL_IN_THE_SINK),
        (
            "put the fork on the sideboard and then the spoon as well",
            "(at fork sideboard) [(at spoon sideboard)]",
        ),
        ("put the cup no the plate on the sideboard", "(at plate sideboard)"),
        ("take the cup to the sideboard no to the countertop", "(at cup countertop)"),
        ("take the cup to anna no to the host", "(has host cup)"),
        ("take the magazine and put it away on the shelf", "(at magazine shelf)"),
        ("the bottle could go on the sideboard", "(at bottle sideboard)"),
        (
            "if it happens that the fridge is open close it",
            "when (open fridge): (not (open fridge))",
        ),
        ("give anna the fork before the others arrive", "(has guest fork)"),
        (
            "fork on the sideboard then the spoon then the cup",
            "(at fork sideboard) [(at spoon sideboard) [(at cup sideboard)]]",
        ),
        ("if somebody's left the fridge open shut it", "when (open fridge): (not (open fridge))"),
        ("it smells in here could you close the fridge", "(not (open fridge))"),
    ],
)
def test_spoken_ways_to_say_more(said: str, expected: str) -> None:
    assert meant("dinner-party", said) == f"start [{expected}]"


def test_a_guess_where_something_is_asks_for_nothing() -> None:
    assert meant("dinner-party", "the bottle could be on the sideboard") == "refused"


def test_picking_up_all_of_something_is_still_wanted_where_they_go_nowhere() -> None:
    said = "pick up all the dishes and put the fork on the sideboard"
    assert "(holding ?x)" in meant("dinner-party", said)


def test_why_do_not_you_suggests_only_where_nothing_is_planned() -> None:
    said = "why don't you go to the living room"
    assert meant("dinner-party", said) == "start [(robot-at living-room)]"
    assert meant("dinner-party", said, "open the drawer").startswith("answer: why-not")
