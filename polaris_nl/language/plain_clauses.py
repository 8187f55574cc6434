"""Predicates and operators as clauses, found in their names and in `; NL:` comments: who, verb, rest."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from polaris_nl.language.tokens import phrase
from polaris_nl.model.domain import Operator, Predicate
from polaris_nl.model.formula import Variable

HINT = re.compile(r"\[(\d+)\]")
_BE = ("is", "are", "was", "were", "be")
HELPERS = ("has", "can", "will", "may", "must")
PREPOSITIONS = (
    "at", "in", "on", "near", "to", "by", "with", "from", "into", "inside", "onto", "under", "behind", "beside",
    "above", "below", "for", "of", "next", "around", "outside", "off", "over", "towards", "between", "facing",
)  # fmt: skip
_NO_VERBS = ("its", "this", "across", "towards", "always", "besides", "as", "yes", "plus", "less")
"""Words that end like a verb after "she"."""
_IRREGULAR = {"has": "have", "does": "do", "goes": "go"}
AGENTS = ("robot", "agent")
"""Types of what the robot itself can be; "I move" is said of it where there is only one."""


@dataclass(frozen=True, slots=True)
class Clause:
    """A predicate as a clause: slots are written `{o}`.

    Attributes:
        subject: what it is said of, or "" where the whole is no clause.
        verb: the imperative of its verb; `be` where there is none.
        rest: what follows the verb.
    """

    subject: str
    verb: str
    rest: str


def predicate_clause(predicate: Predicate) -> Clause:
    """A predicate as a clause: "[0] near [1]" is near."""
    return _clause(_told(predicate), predicate)


def operator_clause(operator: Operator) -> Clause:
    """An operator as a clause; without a comment, its name is the verb and who does it comes first."""
    slots = [slot_of(p) for p in operator.parameters]
    if operator.hint:
        return _clause(_filled(operator.hint, slots), None)
    acts = bool(slots) and is_agent(operator.parameters[0])
    words = _named_action(operator.name, operator.parameters[int(acts) :])
    return Clause(slots[0] if acts else "", "", words)


def _named_action(name: str, parameters: Sequence[Variable]) -> str:
    """`put_near` of a cup, a lamp and a hall: "put {cup} near {lamp} ({hall})"."""
    words = list(phrase(_spaced(name)))
    slots = [slot_of(p) for p in parameters]
    roles = [p.name.lstrip("?") for p in parameters]
    told = [f"{r} {s}" if r in PREPOSITIONS else s for r, s in zip(roles, slots, strict=True)]
    if len(words) > 1 and words[-1] in PREPOSITIONS and len(slots) > 1:
        told[:2] = [f"{slots[0]} {words.pop()} {slots[1]}"]
    else:
        words, told = [*words, *told[:1]], told[1:]
    placed = [t for t in told if " " in t]
    others = [t for t in told if " " not in t]
    return " ".join([*words, *placed, *([f"({', '.join(others)})"] if others else [])])


def _told(predicate: Predicate) -> list[str]:
    """The words and slots of a predicate, as its author says it or in the order of its name."""
    slots = [slot_of(p) for p in predicate.parameters]
    if predicate.hint:
        return _filled(predicate.hint, slots)
    words = list(phrase(_spaced(predicate.name)))
    if not slots:
        known = len(words) == 1 or any(w in _BE for w in words)
        return words if known else ["the", *words[:-1], being_of(words[-2]), words[-1]]
    if len(slots) == 1 and words[-1] in PREPOSITIONS and not is_past(words[0]):
        return [*(words[:-1] or ["robot"]), words[-1], slots[0]]
    if len(slots) == 1 and words[0].endswith("ing"):
        return ["the", "robot", "is", *words, slots[0]]
    if len(words) > 1 and words[0] in predicate.parameters[0].types:
        words = words[1:]
    return [slots[0], *words, *slots[1:]]


def _filled(hint: str, slots: Sequence[str]) -> list[str]:
    """A comment as words and slots."""
    found: list[str] = []
    for number, part in enumerate(HINT.split(hint)):
        if number % 2 == 0:
            found.extend(phrase(part))
        elif int(part) < len(slots):
            found.append(slots[int(part)])
    return found


def _clause(told: Sequence[str], predicate: Predicate | None) -> Clause:
    """Finds the verb of what is told: behind the first slot, or any "is"."""
    for at in range(1, len(told)):
        word, before = told[at], told[at - 1]
        subject, rest = " ".join(told[:at]), " ".join(told[at + 1 :])
        if word in _BE:
            return Clause(subject, "be", rest)
        if word in HELPERS and (word != "has" or is_past("".join(told[at + 1 : at + 2]))):
            return Clause(subject, word, rest)
        follows = before.startswith("{") or before in AGENTS or before == "person"
        if follows and (base := _base(word)):
            return Clause(subject, base, rest)
    if predicate is not None and told and told[0].startswith("{") and len(told) > 1:
        return Clause(told[0], "be", " ".join(told[1:]))
    places = [at for at, word in enumerate(told) if at and word in PREPOSITIONS]
    if predicate is not None and places:
        subject = " ".join(told[: places[0]])
        named = "the robot" if subject == "robot" else subject
        return Clause(named, "be", " ".join(told[places[0] :]))
    return Clause("", "", " ".join(told))


def _base(word: str) -> str:
    """The imperative of a verb after "she": `moves` -> `move`; "" where it is none."""
    if word in _IRREGULAR:
        return _IRREGULAR[word]
    if word in _NO_VERBS or len(word) < 4 or not word.endswith("s") or word.endswith(("ss", "us")):
        return ""
    if word.endswith("ies"):
        return word[:-3] + "y"
    if word.endswith(("ches", "shes", "sses", "xes", "zzes", "oes")):
        return word[:-2]
    return word[:-1]


def is_past(word: str) -> bool:
    """Whether a word looks like a past participle: `switched`, `taken`."""
    return word.endswith(("ed", "en")) and len(word) > 4 and word not in PREPOSITIONS


def imperative(past: str) -> str:
    """`switched` -> `switch`, `closed` -> `close`, `dropped` -> `drop`, `emptied` -> `empty`."""
    stem = past[:-2]
    if stem.endswith("i"):
        return f"{stem[:-1]}y"
    if stem[-1:] == stem[-2:-1] and stem[-1:] not in "lsfz":
        return stem[:-1]
    silent = stem.endswith(("c", "g", "v", "u", "z")) or re.search(
        r"[aeiou]s$|[^aeiou]at$|[^aeiou][ao]r$", stem
    )
    return f"{stem}e" if silent else stem


def being_of(subject: str) -> str:
    """The form of "be" behind a subject: "the lights are"."""
    plural = subject.endswith("s") and not subject.endswith(("ss", "us", "'s"))
    return "are" if plural else "is"


def slot_of(parameter: Variable) -> str:
    """The slot of a parameter, `{o}` for `?o`."""
    return f"{{{parameter.name.lstrip('?')}}}"


def _spaced(name: str) -> str:
    return name.replace("-", " ").replace("_", " ")


def is_agent(parameter: Variable) -> bool:
    """Whether a parameter is somebody who acts."""
    return bool({*AGENTS, "person"} & set(parameter.types))
