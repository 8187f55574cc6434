"""What a quantified goal is about, in words: "there is no dish that is dirty"."""

from __future__ import annotations

import re
from collections.abc import Iterator

from polaris_nl.model.domain import KIND, conjuncts
from polaris_nl.model.formula import And, Equal, Formula, Goal, Imply, Literal, Not, Quantified
from polaris_nl.model.text import in_words, listed
from polaris_nl.model.wording import Wording

IT = "zz"
"""Stands for a variable in a fact that is put into words, and is replaced there."""


def none_of(goal: Goal, wording: Wording) -> str:
    """That there is none of what a goal is about: "there is no dish that is dirty"."""
    found = next(_quantified(goal), None)
    if found is None:
        return "there is nothing that it could be about"
    several = found.quantifier == "exists" and len(found.variables) > 1
    variable = found.variables[0]
    body = found.body
    condition = body.condition if isinstance(body, Imply) else body
    if found.quantifier == "forall" and not isinstance(body, Imply):
        condition = And(())
    parts = [p for p in conjuncts(condition) if variable.name in _terms(p)]
    kinds = [
        p.args[1] for p in parts if isinstance(p, Literal) and p.predicate == KIND and p.positive
    ]
    noun = (kinds or list(variable.types) or ["thing"])[0].replace("-", " ")
    noun = "thing" if noun == "object" else noun
    if several:
        count = in_words(len(found.variables))
        return f'there are fewer than {count} things of the kind "{noun}"'
    if found.quantifier == "exists":
        return (
            f"there is no {noun} for that" if kinds else "there is nothing that it could be about"
        )
    said = [s for p in parts if (s := _condition(p, variable.name, wording))]
    none = "nothing" if noun == "thing" else f"no {noun}"
    return f"there is {none}{' that ' if said else ''}{listed(said)}"


def _quantified(goal: Goal) -> Iterator[Quantified]:
    if isinstance(goal, And):
        for part in goal.parts:
            yield from _quantified(part)
    elif isinstance(goal, Imply):
        yield from _quantified(goal.conclusion)
    elif isinstance(goal, Quantified):
        yield goal


def _condition(part: Formula, variable: str, wording: Wording) -> str:
    """A condition as what follows "that": "is dirty", "isn't the cup"."""
    if isinstance(part, Literal) and part.predicate != KIND:
        fact = wording.fact(part.bind({variable: IT}))
        return re.sub(rf"^(the )?{IT} ", "", re.sub(rf"(?<!^)\b(the )?{IT}\b", "it", fact))
    if isinstance(part, Not) and isinstance(part.part, Equal):
        other = part.part.right if part.part.left == variable else part.part.left
        return f"isn't {wording.entity(other)}"
    return ""


def _terms(formula: Formula) -> set[str]:
    if isinstance(formula, Literal):
        return set(formula.args)
    if isinstance(formula, Not):
        return _terms(formula.part)
    if isinstance(formula, Equal):
        return {formula.left, formula.right}
    return set()
