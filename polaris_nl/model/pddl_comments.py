"""What comments in PDDL domain files say (see `polaris_nl.model.pddl` for their forms)."""

from __future__ import annotations

import re
from typing import NamedTuple

from polaris_nl.model.domain import Operator, Predicate, effect_literals
from polaris_nl.model.errors import FormatError, did_you_mean
from polaris_nl.model.formula import Literal, formula_of
from polaris_nl.model.sexpr import read_all
from polaris_nl.model.state import MutexGroup

_COMMENT = re.compile(
    r";+\s*(?:(NL|MUTEX|EXOGENOUS|COMMANDED):\s*(.*)|(INTERNAL)\b)", re.IGNORECASE
)


class Comment(NamedTuple):
    """A comment that says something: its kind and text, and whether it has a line of its own."""

    kind: str
    text: str
    alone: bool


def comments_in(text: str) -> dict[int, Comment]:
    """The comments that say something, by their lines."""
    found = {}
    for number, line in enumerate(text.splitlines(), 1):
        match = _COMMENT.search(line)
        if match:
            alone = not line[: match.start()].strip()
            found[number] = Comment((match[1] or match[3]).upper(), (match[2] or "").strip(), alone)
    return found


def hint_at(line: int, comments: dict[int, Comment]) -> tuple[str, bool]:
    """The phrases beside a definition, or on the lines right above it that hold nothing else."""
    found = [comments[line]] if line in comments else []
    above = line - 1
    while above in comments and comments[above].alone:
        found.append(comments[above])
        above -= 1
    hint = next((comment.text for comment in found if comment.kind == "NL"), "")
    return hint, any(comment.kind == "INTERNAL" for comment in found)


def mutexes_in(
    comments: dict[int, Comment], predicates: dict[str, Predicate]
) -> tuple[MutexGroup, ...]:
    """The groups that comments list.

    Raises:
        FormatError: a comment lists something else than atoms of the domain.
    """
    groups = []
    for line, (kind, text, _) in comments.items():
        if kind != "MUTEX":
            continue
        patterns = tuple(formula_of(node) for node in read_all(text, line))
        for pattern in patterns:
            if not isinstance(pattern, Literal) or not pattern.positive:
                raise FormatError(
                    "A MUTEX comment lists atoms such as (acknowledged ?m).", line=line
                )
            check_predicate(pattern, predicates, line)
        groups.append(MutexGroup(tuple(p for p in patterns if isinstance(p, Literal))))
    return tuple(groups)


def exogenous_in(
    comments: dict[int, Comment],
    predicates: dict[str, Predicate],
    operators: dict[str, Operator],
) -> frozenset[str]:
    """The predicates that people bring about, by the comments or else by the operators.

    Raises:
        FormatError: a comment names no predicate.
    """
    found = set()
    for line, (kind, text, _) in comments.items():
        for name in text.lower().split() if kind == "EXOGENOUS" else ():
            if name not in predicates:
                raise FormatError(
                    f"There is no predicate {name}.{did_you_mean(name, predicates)}", line=line
                )
            found.add(name)
    if found:
        return frozenset(found)
    changed = {e.predicate for op in operators.values() for e in effect_literals(op.effect)}
    return frozenset(predicates) - changed


def commanded_in(comments: dict[int, Comment], types: tuple[str, ...]) -> tuple[str, ...]:
    """The types that comments say can be commanded.

    Raises:
        FormatError: there is no such type.
    """
    found: dict[str, None] = {}
    for line, (kind, text, _) in comments.items():
        for name in text.lower().split() if kind == "COMMANDED" else ():
            if name not in types:
                hint = did_you_mean(name, types)
                raise FormatError(f"There is no type {name} to be commanded.{hint}", line=line)
            found[name] = None
    return tuple(found)


def check_predicate(atom: Literal, predicates: dict[str, Predicate], line: int) -> None:
    """Checks that an atom is one of a domain's predicates.

    Raises:
        FormatError: it isn't, or has another number of terms.
    """
    predicate = predicates.get(atom.predicate)
    if predicate is None:
        hint = did_you_mean(atom.predicate, predicates)
        raise FormatError(f"There is no predicate {atom.predicate}.{hint}", line=line)
    if len(predicate.parameters) != len(atom.args):
        raise FormatError(
            f"{predicate} takes {len(predicate.parameters)} terms, but {atom} has {len(atom.args)}.",
            line=line,
        )
