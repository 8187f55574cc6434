"""Fast Downward's translator, in process: PDDL text to the search binary's input.

The translator keeps its options and its printing in module globals, so one call runs at a time, and
its `print` is silenced in its own modules instead of redirecting this process's standard output,
which other threads use.
"""

from __future__ import annotations

import importlib
import io
import pkgutil
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

from polaris_nl.model.errors import PlanningError
from polaris_nl.planning import grounding
from polaris_nl.planning.budget import never

_LOCK = threading.RLock()
_PARTS: dict[str, ModuleType] = {}
INVARIANTS_S = 3
"""How long the translator may look for invariants, in seconds; it does without the rest."""
END = "the end"
"""The name of actions that are no robot's; no PDDL file can have one that is called so."""


@dataclass(frozen=True, slots=True)
class Task:
    """A translated problem.

    Attributes:
        sas: the search binary's input, or "" where the goals are out of reach even if nothing ever
            became false (no plan exists).
        plain: without axioms and conditional effects, so that every heuristic applies.
    """

    sas: str
    plain: bool = True


SasOperator = tuple[str, Sequence[tuple[int, int]], Sequence[tuple[int, int, int]]]


@dataclass(frozen=True, slots=True)
class Sas:
    """A translated problem without goals, all of whose variables are kept.

    Attributes:
        names: of each variable, what its values stand for: `Atom at(cup, table)`, `NegatedAtom ...`
            or `<none of those>`.
        mutexes: groups of (variable, value) that exclude each other.
        operators: name, what has to hold (variable, value), and what changes (variable, value before
            or -1, value after).
    """

    names: Sequence[Sequence[str]]
    mutexes: Sequence[Sequence[tuple[int, int]]]
    operators: Sequence[SasOperator] = field(repr=False)


def translate(domain: str, problem: str, cancelled: Callable[[], bool] = never) -> Task:
    """Grounds a problem.

    Args:
        domain: PDDL text.
        problem: PDDL text.
        cancelled: asked now and then; True ends the work.

    Raises:
        PlanningError: the translator doesn't support something in the domain, which is named, or takes
            too long.
        Cancelled: `cancelled` said so.
    """
    with _LOCK:
        parts = _translator()
        task = _parse(parts, domain, problem)
        sas = _grounded(parts, task, cancelled)
        if _is_unsolvable(sas):
            return Task("")
        out = io.StringIO()
        sas.output(out)
        return Task(out.getvalue(), plain=_is_plain(sas))


def translate_without_goals(
    domain: str, problem: str, cancelled: Callable[[], bool] = never
) -> Sas | None:
    """Grounds a problem whose goals aren't known yet.

    Returns:
        The problem, or None where it needs axioms or conditional effects.

    Raises:
        PlanningError: the translator doesn't support something in the domain, which is named, or takes
            too long.
        Cancelled: `cancelled` said so.
    """
    with _LOCK:
        parts = _translator()
        task = _parse(parts, domain, problem)
        # The translator stops early where there is nothing to reach, so it gets something that
        # an action of its own reaches. Neither has a name that PDDL allows.
        pddl = parts["pddl"]
        end = pddl.Atom(END, ())
        task.predicates.append(pddl.Predicate(END, []))
        done = [pddl.Effect([], pddl.Truth(), end)]
        task.actions.append(pddl.Action(END, [], 0, pddl.Conjunction([]), done, None))
        task.goal = pddl.Conjunction([end])
        options = parts["options"].get_options()
        options.filter_unimportant_vars = False
        try:
            sas = _grounded(parts, task, cancelled)
        finally:
            options.filter_unimportant_vars = True
        if not _is_plain(sas) or sas.metric:
            return None
        return Sas(
            [tuple(names) for names in sas.variables.value_names],
            [tuple(group.facts) for group in sas.mutexes],
            [
                (op.name[1:-1], op.prevail, [(v, pre, post) for v, pre, post, _ in op.pre_post])
                for op in sas.operators
                if op.name[1:-1] != END
            ],
        )


def _grounded(parts: dict[str, ModuleType], task: Any, cancelled: Callable[[], bool]) -> Any:
    try:
        with grounding.limited(grounding.LIMIT_S, cancelled):
            parts["normalize"].normalize(task)
            return parts["main"].pddl_to_sas(task)
    except PlanningError:
        raise
    except (Exception, SystemExit) as error:
        raise PlanningError(f"The planner can't use this domain: {_reason(error)}.") from error


def _is_plain(sas: Any) -> bool:
    conditional = any(condition for op in sas.operators for *_, condition in op.pre_post)
    return not sas.axioms and not conditional


def invariants(domain: str, problem: str) -> list[list[tuple[str, tuple[int | None, ...]]]]:
    """Fast Downward's invariants of a domain: groups of (predicate, positions).

    A position is the number of the shared variable that stands there, or None for what is counted
    over.
    """
    with _LOCK:
        parts = _translator()
        task = _parse(parts, domain, problem)
        parts["normalize"].normalize(task)
        found = parts["invariant_finder"].find_invariants(task, None)
        counted = parts["invariants"].COUNTED
        return [
            [
                (part.predicate, tuple(None if a == counted else a for a in part.args))
                for part in sorted(invariant.parts)
            ]
            for invariant in found
        ]


def _translator() -> dict[str, ModuleType]:
    if not _PARTS:
        package = importlib.import_module("fast_downward.translate")
        options = importlib.import_module("fast_downward.translate.options")
        options.set_options(
            ["domain.pddl", "problem.pddl", "--invariant-generation-max-time", str(INVARIANTS_S)]
        )
        for module in pkgutil.walk_packages(package.__path__, "fast_downward.translate."):
            if not module.name.endswith("__main__"):
                loaded: Any = importlib.import_module(module.name)
                loaded.print = _quiet
                _PARTS[module.name.rpartition(".")[2]] = loaded
        grounding.watch(_PARTS)
    return _PARTS


def _quiet(*values: object, file: Any = None, **how: Any) -> None:
    """Stands in for `print` in the translator's modules: writes to files, and not to the screen."""
    if file is not None:
        print(*values, file=file, **how)


def _parse(parts: dict[str, ModuleType], domain: str, problem: str) -> Any:
    read = parts["lisp_parser"].parse_nested_list
    try:
        return parts["parsing_functions"].parse_task(
            read(domain.splitlines(keepends=True)), read(problem.splitlines(keepends=True))
        )
    except (Exception, SystemExit) as error:
        raise PlanningError(f"The planner can't read this domain: {_reason(error)}.") from error


def _is_unsolvable(sas: Any) -> bool:
    """Whether the translator put its stand-in for an unsolvable task in the place of the task."""
    names = sas.variables.value_names
    return bool(names and names[0][:1] == ["Atom dummy(val1)"] and sas.goal.pairs == [(0, 1)])


def _reason(error: BaseException) -> str:
    """What the translator says, without the places in its own code that it lists first."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    places = [n for n, line in enumerate(lines) if line.startswith("->")]
    said = lines[places[-1] + 1 :] if places else lines[:1]
    return " ".join(said).strip(" .!") or type(error).__name__
