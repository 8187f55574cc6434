"""Wordings for a domain that no grammar file speaks of, made of names and of its `; NL:` comments.

`; NL: [0] near [1]` behind a predicate, or only the name `near`, is enough for "the cup is near the
lamp", "put the cup near the lamp" and "if the cup isn't near the lamp". What is made here is what a
grammar file would say, and is read the same way.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from polaris_nl.language.plain_clauses import (
    AGENTS,
    HELPERS,
    HINT,
    PREPOSITIONS,
    Clause,
    being_of,
    imperative,
    is_agent,
    is_past,
    operator_clause,
    predicate_clause,
    slot_of,
)
from polaris_nl.language.verbs import gerund, participle, third_person
from polaris_nl.model.domain import Domain, Operator, Predicate
from polaris_nl.model.errors import GrammarError

_MOVES = "make|put|bring|place|move|set"
Entry = Mapping[str, str | Sequence[str]]
"""Fields of a predicate as in a grammar file."""


def plain_entry(predicate: Predicate) -> Entry:
    """What a grammar file would say of a predicate; nothing where it is internal."""
    if predicate.internal:
        return {}
    clause = predicate_clause(predicate)
    if not clause.subject:
        return _bare(clause.rest)
    if clause.verb == "be":
        first = predicate.parameters[0] if predicate.parameters else None
        return _being(
            clause, first is not None and slot_of(first) == clause.subject and is_agent(first)
        )
    if clause.verb in HELPERS:
        return _helped(clause)
    return _doing(clause)


def plain_action(operator: Operator) -> str:
    """What a grammar file would say of an operator, or "": `{r:agent} move to {to}`.

    `{r:agent}` is left out where the entity is the only robot, and "have ann" otherwise.
    """
    clause = operator_clause(operator)
    words = f"{clause.verb} {clause.rest}".strip()
    subject = clause.subject
    if subject.startswith("{"):
        return f"{{{subject[1:-1]}:agent}} {words}"
    return words if subject in ("", "the robot", *AGENTS) else f"have {subject} {words}"


def hint_faults(domain: Domain) -> Iterator[GrammarError]:
    """The comments that number a parameter which isn't there."""
    things: tuple[Predicate | Operator, ...] = (
        *domain.predicates.values(),
        *domain.operators.values(),
    )
    for thing in things:
        for number in map(int, HINT.findall(thing.hint)):
            if number >= len(thing.parameters):
                last = len(thing.parameters) - 1
                has = f"ends with [{last}]" if last >= 0 else "has no parameters"
                yield GrammarError(
                    f"The comment NL: {thing.hint} names [{number}], but {thing.name} {has}; mend the number.",
                    domain.path,
                    hint_line(domain, thing.hint),
                )


def hint_line(domain: Domain, hint: str) -> int:
    """The line of a comment in the domain file; 1 where there is none."""
    lines = domain.source.splitlines()
    return next((n for n, text in enumerate(lines, 1) if hint and hint in text), 1)


def _being(clause: Clause, agent: bool) -> Entry:
    """`the cup is near the lamp`, `the cup near the lamp` behind "have"."""
    subject, rest = clause.subject, clause.rest
    first, _, place = rest.partition(" ")
    yours = subject in ("the robot", "robot")
    said = "<you>" if yours else subject
    placed = f"(at|in|inside) {place}" if first in ("at", "in") and (yours or agent) else rest
    verb = being_of(subject)
    goals = [f"({_MOVES if first in PREPOSITIONS else 'make'}) {subject} {rest}"]
    if first in ("at", "in", "inside") and yours:
        goals = [f"be {placed}", f"<go> [to|into|{first}] {place}"]
    elif first in ("at", "in", "inside") and agent:
        goals.append(f"(have|make|let|get|send) {subject} [to] [<go>] (to|into) {place}")
    elif is_past(first) and " " not in place:
        goals.extend(
            f"{imperative(first)} {x}" for x in (f"{subject} {place}", f"{place} {subject}")
        )
    return {
        "states": [f"{said} <be> {placed}"],
        "not-states": [f"{said} <be> not {placed}"],
        "goals": [*dict.fromkeys(" ".join(goal.split()) for goal in goals)],
        "not-goals": [f"{subject} (should|must|shall) not be {rest}"],
        "fact": f"{subject} {verb} {rest}",
        "not-fact": f"{subject} {verb} not {rest}",
        "goal": f"be {rest}" if yours else f"have {subject} {rest}",
        "event": f"{subject} {verb} {rest}",
        "name": rest,
        "not-name": f"not {rest}",
    }


def _doing(clause: Clause) -> Entry:
    """`ann holds the cup`, `have ann hold the cup`, `ann does not hold the cup`."""
    subject, verb, rest = clause.subject, clause.verb, clause.rest
    third = "has" if verb == "have" else third_person(verb)
    return {
        "states": [f"{subject} ~{verb} {rest}"],
        "not-states": [f"{subject} !~{verb} {rest}"],
        "goals": [
            f"(have|make|let|get) {subject} [to] {verb} {rest}",
            f"{subject} (should|must|shall|has to|needs to|is to) {verb} {rest}",
        ],
        "not-goals": [f"{subject} (should|must|shall) not {verb} {rest}"],
        "fact": f"{subject} {third} {rest}".strip(),
        "not-fact": f"{subject} does not {verb} {rest}".strip(),
        "goal": f"have {subject} {verb} {rest}".strip(),
        "event": f"{subject} {third} {rest}".strip(),
        "name": f"{participle(verb) if verb != 'have' else gerund(verb)} {rest}".strip(),
    }


def _helped(clause: Clause) -> Entry:
    """`ann has accepted it`, `ann can reach the shelf`."""
    subject, helper, rest = clause.subject, clause.verb, clause.rest
    helpers = "(has|have|'s)" if helper == "has" else helper
    return {
        "states": [f"{subject} {helpers} {rest}"],
        "not-states": [f"{subject} {helpers} not {rest}"],
        "goals": [f"{subject} (should|must|shall) have {rest}"] if helper == "has" else [],
        "fact": f"{subject} {helper} {rest}",
        "not-fact": f"{subject} {helper} not {rest}",
        "event": f"{subject} {helper} {rest}",
        "name": rest,
    }


def _bare(said: str) -> Entry:
    """What is no clause, as it stands."""
    return {
        "states": [f"[it is] {said}"],
        "not-states": [f"it is not {said}", f"not {said}"],
        "goals": [f"(make|have) it {said}"],
        "fact": f"it is {said}",
        "not-fact": f"it is not {said}",
        "event": f"it is {said}",
        "name": said,
    }
