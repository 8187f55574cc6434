"""One translated task, aimed at many states and goals: its initial values and goal values are replaced."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.planning.costs import Extra, cost
from polaris_nl.planning.memory import Memory
from polaris_nl.planning.translate import END, Sas, SasOperator, Task


class Shared:
    """One translated task, to be aimed at many states and goals.

    Args:
        sas: the translated task, or None where it can't be shared (axioms, conditional effects).
        facts: the state that it was translated from.
        asked: the predicates that some condition asks for.
        extra: what actions cost, where they don't all cost the same.
    """

    def __init__(
        self,
        sas: Sas | None,
        facts: frozenset[Literal],
        asked: frozenset[str],
        extra: Extra,
    ) -> None:
        self._extra = extra
        self._sas = sas
        self._facts = facts
        self._asked = asked
        self._places: dict[Literal, tuple[int, int]] = {}
        self._otherwise: list[int] = []
        self._texts: Memory[frozenset[int], _Text] = Memory(8)
        self.size = 1000
        if sas is not None:
            for variable, names in enumerate(sas.names):
                self._read(variable, names)
            self._causes = _causes(sas)
            self.size += 400 * len(sas.operators)
        self._rest = self._outside(facts)

    def aim(self, state: State, goals: Sequence[Literal]) -> Task | None:
        """The task from another state to some goals; None where it has to be translated for itself."""
        if self._sas is None or self._outside(state.facts) != self._rest:
            return None
        values = self._values(state)
        if values is None:
            return None
        aims: dict[int, int] = {}
        banned: dict[int, set[int]] = {}
        for goal in goals:
            place = self._places.get(goal.atom)
            if place is None:
                if (goal.atom in self._facts) != (goal.atom in state.facts):
                    return None
                if state.holds(goal):
                    continue  # Nothing ever changes it.
                return Task("")
            variable, value = place
            if not goal.positive:
                if len(self._sas.names[variable]) != 2:
                    banned.setdefault(variable, set()).add(value)
                    continue
                value = 1 - value
            if aims.setdefault(variable, value) != value:
                return Task("")  # Two values of one variable: they exclude each other.
        if any(aims[variable] in banned.pop(variable) for variable in aims.keys() & banned):
            return Task("")
        if banned:
            return Task(_without(self._sas, banned).text(values, aims, self._extra))
        if not aims:
            return None
        return Task(self._text(frozenset(aims)).with_values(values, aims))

    def _read(self, variable: int, names: Sequence[str]) -> None:
        otherwise = -1
        for value, name in enumerate(names):
            kind, _, atom = name.partition(" ")
            if kind == "Atom":
                predicate, _, args = atom.rstrip(")").partition("(")
                literal = Literal(predicate, tuple(args.split(", ")) if args else ())
                self._places[literal] = (variable, value)
            else:
                otherwise = value
        self._otherwise.append(otherwise)

    def _outside(self, facts: frozenset[Literal]) -> frozenset[Literal]:
        """The facts that some condition may ask for and that are no value of the task."""
        return frozenset(f for f in facts if f.predicate in self._asked and f not in self._places)

    def _values(self, state: State) -> list[int] | None:
        values = list(self._otherwise)
        taken = set()
        for fact in state.facts:
            place = self._places.get(fact)
            if place is not None:
                if place[0] in taken:
                    return None
                taken.add(place[0])
                values[place[0]] = place[1]
        return None if -1 in values else values

    def _text(self, aims: frozenset[int]) -> _Text:
        """The task's text without what can't matter to its goals."""
        text = self._texts.get(aims)
        if text is None:
            assert self._sas is not None
            text = _Text.of(self._sas, _needed(aims, self._causes), self._extra)
            self._texts.put(aims, text)
        return text


@dataclass(frozen=True, slots=True)
class _Text:
    """The search program's input around the initial and the goal values."""

    variables: Sequence[int]
    head: str = field(repr=False)
    tail: str = field(repr=False)

    @classmethod
    def of(cls, sas: Sas, variables: Sequence[int], extra: Extra) -> _Text:
        number = {variable: n for n, variable in enumerate(variables)}
        metric = int(bool(extra))
        head = [f"begin_version\n3\nend_version\nbegin_metric\n{metric}\nend_metric"]
        head.append(str(len(variables)))
        for variable, n in number.items():
            names = sas.names[variable]
            head.append(f"begin_variable\nvar{n}\n-1\n{len(names)}")
            head.extend((*names, "end_variable"))
        groups = [
            [f"{number[v]} {value}" for v, value in group if v in number] for group in sas.mutexes
        ]
        groups = [group for group in groups if len({x.split()[0] for x in group}) > 1]
        head.append(str(len(groups)))
        for group in groups:
            head.extend(("begin_mutex_group", str(len(group)), *group, "end_mutex_group"))
        tail = []
        for name, prevail, changes in sas.operators:
            kept = [f"0 {number[v]} {pre} {post}" for v, pre, post in changes if v in number]
            if kept:
                # A variable that something needed depends on is needed, so no condition is lost.
                conditions = [f"{number[v]} {value}" for v, value in prevail if v in number]
                tail.append(f"begin_operator\n{name}\n{len(conditions)}")
                tail.extend(
                    (*conditions, str(len(kept)), *kept, f"{cost(name, extra)}\nend_operator")
                )
        count = sum(line.startswith("begin_operator") for line in tail)
        return cls(variables, "\n".join(head), "\n".join((str(count), *tail, "0", "")))

    def with_values(self, values: Sequence[int], aims: Mapping[int, int]) -> str:
        at_first = "\n".join(str(values[v]) for v in self.variables)
        wanted = [f"{n} {aims[v]}" for n, v in enumerate(self.variables) if v in aims]
        goal = "\n".join((str(len(wanted)), *wanted))
        return (
            f"{self.head}\nbegin_state\n{at_first}\nend_state\n"
            f"begin_goal\n{goal}\nend_goal\n{self.tail}"
        )


@dataclass(frozen=True, slots=True)
class _Without:
    """A task in which variables must not have some values at the end.

    A goal of the search program is one value of a variable. So there is an end, after which nothing moves any
    more, and in which each such variable is looked at once. That makes all plans longer by the same, and
    leaves the shortest ones the shortest; the translator's own way counts every combination of other values.
    """

    sas: Sas
    aims: Mapping[int, int]

    def text(self, values: Sequence[int], aims: Mapping[int, int], extra: Extra) -> str:
        """The search program's input from some values to some others."""
        wanted = {**aims, **self.aims}
        variables = _needed(wanted, _causes(self.sas))
        first = [*values, *(0 for _ in range(len(self.sas.names) - len(values)))]
        return _Text.of(self.sas, variables, extra).with_values(first, wanted)


def _without(sas: Sas, banned: Mapping[int, set[int]]) -> _Without:
    over = len(sas.names)
    names = [*sas.names, ("Atom working()", "Atom ending()")]
    working = [(name, (*prevail, (over, 0)), changes) for name, prevail, changes in sas.operators]
    ending: list[SasOperator] = [(END, (), ((over, 0, 1),))]
    aims = {}
    for variable, values in sorted(banned.items()):
        looked = len(names)
        names.append(("NegatedAtom looked()", "Atom looked()"))
        aims[looked] = 1
        ending += [
            (END, ((over, 1), (variable, value)), ((looked, 0, 1),))
            for value in range(len(sas.names[variable]))
            if value not in values
        ]
    return _Without(Sas(names, sas.mutexes, [*working, *ending]), aims)


def _needed(aims: Iterable[int], causes: Mapping[int, set[int]]) -> list[int]:
    """The variables on which those of some goals depend, in order."""
    needed, waiting = set(aims), list(aims)
    while waiting:
        for cause in causes.get(waiting.pop(), ()):
            if cause not in needed:
                needed.add(cause)
                waiting.append(cause)
    return sorted(needed)


def _causes(sas: Sas) -> dict[int, set[int]]:
    """For each variable, those that the operators that change it also ask for or change."""
    found: dict[int, set[int]] = {}
    for _, prevail, changes in sas.operators:
        involved = {v for v, _ in prevail} | {v for v, _, _ in changes}
        for variable, _, _ in changes:
            found.setdefault(variable, set()).update(involved)
    return found
