"""Words that say in which order things are to be done, and how clauses stand to each other by them."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from polaris_nl.language.clauses import Clause
from polaris_nl.language.segment import Item
from polaris_nl.model.formula import Literal

FIRST = ("first", "first of all", "beforehand", "before that", "before")
LATER = (
    "afterwards", "after that", "and afterwards", "later", "thereafter", "subsequently", "last", "at last",
    "last of all", "right after it", "right after that", "straight after it", "right afterwards",
)  # fmt: skip
"""Behind a goal, these make it a step of its own: "put it in and close it afterwards"."""
BUT_FIRST = "but"
"""Begins what is to come before the goals in front of it: "close it, but first put the cup in it"."""
WITH = ("with", "holding", "carrying")
"""Begins what the robot holds where it goes: "go to the kitchen with the cup"."""
SEQUELS = ("then", "and then", "after that", "and after that", "afterwards", "and afterwards")
"""Words in front of a condition that keep it where the program has come to."""
INSTEAD = "in which case"
"""Behind "unless ...", says what is to be done then."""
ENDING = ("finish", "end", "conclude", "continue", "carry", "followed")
"""Begins a step of its own: "... and finish by shutting it"."""
GOING_ON = (*SEQUELS[1:], "and finally", "and next", "finally", "after this")
"""Words after a condition that stands behind its goal: "bring it once she acknowledges, and then ..."."""


def says_only_names(clause: Clause) -> bool:
    """Whether a clause has no words of its own: "anna the cup" leans on what was said just before."""
    return sum(m.end - m.start for _, m in clause.bindings) == clause.end - clause.start


def goes_on(item: Item) -> bool:
    """Whether a word behind a condition only goes on, so that the condition is for what it follows."""
    return item.mark == "then" and (item.text in GOING_ON or item.text.startswith(INSTEAD))


def without(item: Item) -> bool:
    """Whether something is said to be left undone before: "without opening it"."""
    return item.mark == "before" and item.text.startswith("without")


def is_otherwise(items: Sequence[Item]) -> bool:
    """Whether what is said ends with an "if she isn't" that stands behind its goal."""
    marks = [i.mark for i in items]
    return len(items) > 3 and marks[-1] == "else" and "else" not in marks[:-1]


def in_an_order(items: Sequence[Item], at: int) -> bool:
    """Whether an item stands right before or after "then", so that it isn't only told."""
    around = (items[max(at - 1, 0) : at], items[at + 1 : at + 2])
    return any(i.mark == "then" for there in around for i in there)


def condition_follows(rest: Sequence[Item]) -> bool:
    """Whether a condition stands first."""
    return bool(rest) and rest[0].role == "condition"


def stands_behind(rest: Sequence[Item], joined: bool, onward: Collection[str] = ()) -> bool:
    """Whether a condition stands behind what it is for: "go home if she dismisses it".

    Args:
        rest: what follows the condition.
        joined: whether "and" stands before it: "do A, and if it's clean after that do B".
        onward: the marks behind it, or "", that go on: "then" in "shut it if it's open, then go home".
    """
    rest = [i for i in rest if i.mark != "comma"]
    if not rest or rest[0].mark in ("break", "else", "if", "until", "unless"):
        return True
    return (goes_on(rest[0]) or (rest[0].mark or "") in onward) and not joined


def going_on(
    items: Sequence[Item],
    at: int,
    how: str,
    asked: Sequence[Literal],
    when: Sequence[Literal],
) -> Sequence[str]:
    """The marks behind a condition that go on where it is for what stands before it.

    "Then" goes on in "close it if it's open, then go home". Else, "if she dismisses it then go home" stands in
    front of what it is for. What would undo the condition can't come before it; and a comma parts it from
    "then", unless it may come of what was asked for.

    Args:
        items: the utterance.
        at: where the condition ends in it.
        how: the words that the condition begins with.
        asked: what is asked for before it.
        when: the condition.
    """
    if any(x.negation in asked for x in when):
        return ("then", "and", "")
    start = at - 1
    while start and items[start].mark not in ("if", "unless"):
        start -= 1
    set_off = [i.mark for i in items[start - 1 : start]] == ["comma"]
    said = how.split()
    if "only" in said or (said == ["unless"] and not set_off):
        return ("then", "and")
    parted = [i.mark for i in items[at : at + 1]] == ["comma"]
    about = {arg for goal in asked for arg in goal.args}
    comes_of_it = all(set(x.args) <= about for x in when)
    return ("then",) if said == ["if"] and parted and not set_off and not comes_of_it else ()


def but_before(items: Sequence[Item]) -> bool:
    """Whether "but" stands before the latest goal: "shut it, but put the cup in it first"."""
    joined = [i for i in items if i.mark in ("and", "comma")][-1:]
    return any(i.text.startswith(BUT_FIRST) for i in joined)


def all_postposed(items: Sequence[Item]) -> bool:
    """Whether goals and conditions alternate and a condition ends: "A if x and B if y"."""
    roles = [i.role for i in items if i.role in ("goal", "condition")]
    marks = [i.mark for i in items]
    if is_otherwise(items):
        roles.append("condition")  # "A if she is there and B if she isn't".
    if len(roles) < 4 or "until" in marks or "then" in marks:
        return False
    return (
        roles[0] == "goal"
        and roles[-1] == "condition"
        and roles == ["goal", "condition"] * (len(roles) // 2)
    )
