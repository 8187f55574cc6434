"""One step of the executor while it is being made, and what all phases ask of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from polaris_nl.automaton.automaton import Transition
from polaris_nl.execution.backend import Command
from polaris_nl.execution.events import Event, StateChanged
from polaris_nl.execution.expectations import perceived_instead
from polaris_nl.execution.state import ExecutorState, Inputs, Phase, RunPlan
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import effects
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import listed


@dataclass(slots=True)
class Work:
    """The state so far, and what came of the step."""

    run: RunPlan
    now: float
    inputs: Inputs
    state: ExecutorState
    commands: list[Command] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)

    def go(self, phase: Phase, reason: str = "", **changes: object) -> None:
        """Changes the phase."""
        before = self.state.phase
        again: dict[str, object] = {"holding_since": None, "held": "", "request": None}
        self.state = replace(self.state, phase=phase, since=self.now, **(again | changes))  # type: ignore[arg-type] # fields by their names
        if before != phase:
            self.events.append(
                StateChanged(time=self.now, before=before, after=phase, reason=reason)
            )

    def note(self, **changes: object) -> None:
        """Changes what is remembered, in the same phase."""
        self.state = replace(self.state, **changes)  # type: ignore[arg-type] # fields by their names

    def held_for(self, what: str, seconds: float) -> bool:
        """Whether something has been perceived for some time; asked at each step in which it is."""
        if self.state.held != what or self.state.holding_since is None:
            self.note(held=what, holding_since=self.now)
        return self.now - (self.state.holding_since or 0.0) >= seconds

    def sees(self, literal: Literal) -> bool:
        """Whether a literal is perceived."""
        return self.inputs.observation.holds(literal)

    def meets(self, transition: Transition) -> bool:
        """Whether a conditional is perceived, or a person said that it came true."""
        return all(x in self.state.told or self.sees(x) for x in transition.when)

    def denies(self, transition: Transition) -> bool:
        """Whether a conditional is known not to hold; what is unknown just now is not false."""
        return any(x not in self.state.told and self.sees(x.negation) for x in transition.when)

    @property
    def insisted(self) -> Action | None:
        """The action that the author insists on in the present segment, instead of goals, or None."""
        return self.run.automaton.checkpoints[self.state.segment].action

    @property
    def wanted(self) -> tuple[Literal, ...]:
        """What the present segment is still to bring about."""
        action = self.insisted
        if action is not None:
            operator = self.run.world.domain.operators[action.operator]
            return effects(action, operator, self.inputs.observation.state, self.run.world)
        goals = self.run.plan.segments[self.state.segment].goals
        return tuple(x for x in goals if x not in self.state.served)

    @property
    def elapsed(self) -> float:
        """Seconds in the present phase."""
        return self.now - self.state.since

    @property
    def action_words(self) -> str:
        """The action whose turn it is, as an imperative."""
        action = self.state.action
        return self.run.wording.action(action) if action else "go on"

    def facts(self, literals: Sequence[Literal], word: str = "and") -> str:
        """Literals as clauses in a list."""
        return listed([self.run.wording.fact(x) for x in literals], word)

    def instead(self, expected: Sequence[Literal]) -> tuple[Literal, ...]:
        """What is perceived about the things of which something else was expected."""
        return perceived_instead(expected, self.inputs.observation)

    def expected_and_seen(self, expected: Sequence[Literal]) -> str:
        """Expected beside observed, as a clause."""
        # That it holds the tray says that its hand isn't empty.
        shown = [x for x in expected if x.positive] or list(expected)
        words = f"I expected that {self.facts(shown)}"
        if not any(map(self.inputs.observation.knows, shown)):
            return f"{words}, but I can't see just now whether that is so"
        seen = self.facts(self.instead(shown))
        return f"{words}, but I see {f'that {seen}' if seen else 'nothing of it'}"
