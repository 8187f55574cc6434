"""Answers to questions about the plan: what comes when, what is done with a thing, and why."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import START, Automaton, Transition
from polaris_nl.language.interpretation import Query
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after
from polaris_nl.model.formula import Goal, Literal, literals_in
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.reasons import Reasons, Step
from polaris_nl.planning.result import BranchingPlan, Segment
from polaris_nl.render.explanation import (
    branches_in_words,
    purpose_in_words,
    segment_in_words,
    steps_in_words,
)


@dataclass(frozen=True)
class AboutPlan:
    """Answers from a program and its plan."""

    automaton: Automaton
    plan: BranchingPlan
    world: World
    wording: Wording

    def answer(self, query: Query) -> str:
        """The answer in a sentence or two."""
        match query.kind:
            case "plan" if query.when:
                return self._case(query.when)
            case "checkpoint" if query.checkpoint:
                return self._step(query.checkpoint)
            case "why":
                return self._why(query)
            case "first":
                return self._first()
            case "last":
                return self._last()
            case "next":
                return self._after(query.checkpoint) if query.checkpoint else self._first()
            case "after-step" if query.checkpoint:
                return self._after(query.checkpoint)
            case "before-step" if query.checkpoint:
                return self._before(query.checkpoint)
            case "length":
                return self._length()
            case "use" if query.entity:
                return self._use(query.entity)
            case "when":
                return self._when(query.goals)
            case "will":
                return self._will(query.goals)
        return self._whole()

    def _whole(self) -> str:
        return " ".join(branches_in_words(self.automaton, self.plan, self.wording))

    def _case(self, when: Sequence[Literal]) -> str:
        wanted = frozenset(when)
        ways = [
            t for t in self.automaton.transitions.values() if t.when and wanted <= t.conditional
        ]
        if ways:
            return self._onward(ways[0].target)
        events = self._events(when)
        other = self._otherwise(when)
        if other is not None:
            return f"The program has nothing of its own for when {events}. {self._onward(other.target)}"
        return (
            f"The program says nothing about what happens once {events}. Tell me what to do then."
        )

    def _otherwise(self, when: Sequence[Literal]) -> Transition | None:
        """The way that is taken where none of its siblings, which speak of the same things, can be."""
        predicates = {(x.predicate, x.args) for x in when}
        for transition in self.automaton.transitions.values():
            siblings = self.automaton.outgoing(transition.source)
            about = {(x.predicate, x.args) for s in siblings for x in s.when}
            if not transition.when and predicates & about:
                return transition
        return None

    def _onward(self, checkpoint: str) -> str:
        """What happens on the way to a checkpoint, and after it."""
        segment = self.plan.segments.get(checkpoint)
        if segment is None:
            problem = self.plan.problem_at(checkpoint)
            return problem.text if problem else "I have no plan for that yet."
        rest = branches_in_words(self.automaton, self.plan, self.wording, checkpoint)
        return " ".join([self._segment(segment), *rest])

    def _segment(self, segment: Segment) -> str:
        if not segment.actions and not segment.goals:
            return sentence(f"{self._lead(segment)}I do nothing more")
        return segment_in_words(segment, self.wording, self._lead(segment))

    def _lead(self, segment: Segment) -> str:
        if segment.when:
            return f"once {self._events(segment.when)}, "
        siblings = self.automaton.outgoing(segment.source)
        return "otherwise " if len(siblings) > 1 else ""

    def _step(self, checkpoint: str) -> str:
        if checkpoint == START:
            return "That is where every program begins."
        segment = self.plan.segments.get(checkpoint)
        name = self.automaton.checkpoints[checkpoint].name
        if segment is None:
            problem = self.plan.problem_at(checkpoint)
            return problem.text if problem else "I have no plan for that yet."
        goals = self._goals(checkpoint)
        if not goals:
            return self._segment(segment)
        how = self._segment(segment)
        return f"""{sentence(f'in "{name}", you asked me to {goals}')} {how}"""

    # Order

    def _first(self) -> str:
        said = []
        for segment in self._ways(START):
            if not segment.actions:
                said.append(sentence(f"{self._lead(segment)}there is nothing to do at first"))
                continue
            aim = self._goals(segment.target)
            action = self.wording.action(segment.actions[0])
            purpose = (
                f", so that I can {aim}"
                if aim and aim != action and len(segment.actions) > 1
                else ""
            )
            said.append(sentence(f"{self._lead(segment) or 'first '}I {action}{purpose}"))
        return " ".join(said) or "There is nothing to do at first."

    def _last(self) -> str:
        leaves = [s for s in self.plan.segments.values() if not self.automaton.outgoing(s.target)]
        said = []
        for segment in leaves:
            lead = self._branch(segment.target)
            actions = segment.actions or self._actions_before(segment)
            done = self.wording.action(actions[-1]) if actions else "do nothing"
            said.append((lead, f"last of all I {done}"))
        if len({done for _, done in said}) == 1:
            return sentence(said[0][1])
        return " ".join(sentence(lead + done) for lead, done in said)

    def _branch(self, checkpoint: str) -> str:
        """The case in which a checkpoint is reached: "once she acknowledges, ", or "" where always."""
        for transition in reversed(self.automaton.path(checkpoint)):
            if len(self.automaton.outgoing(transition.source)) > 1:
                return (
                    f"once {self._events(transition.when)}, " if transition.when else "otherwise "
                )
        return ""

    def _actions_before(self, segment: Segment) -> tuple[Action, ...]:
        for transition in reversed(self.automaton.path(segment.source)):
            above = self.plan.segments.get(transition.target)
            if above is not None and above.actions:
                return above.actions
        return ()

    def _after(self, checkpoint: str) -> str:
        if checkpoint not in self.automaton.checkpoints:
            return self._first()
        ways = self._ways(checkpoint)
        if not ways:
            missing = [t.target for t in self.automaton.outgoing(checkpoint)]
            if missing:
                return self._onward(missing[0])
            return sentence(f"nothing comes after {self._name(checkpoint)}: the program ends there")
        if len(ways) == 1 and not self._lead(ways[0]):
            return segment_in_words(ways[0], self.wording, "then ")
        return " ".join(self._segment(segment) for segment in ways)

    def _before(self, checkpoint: str) -> str:
        incoming = self.automaton.incoming(checkpoint)
        if incoming is None or incoming.source == START:
            return sentence(f"nothing comes before {self._name(checkpoint)}: it is the first step")
        above = self.plan.segments.get(incoming.source)
        return self._segment(above) if above else self._onward(incoming.source)

    def _length(self) -> str:
        count = self.plan.action_count
        steps = len(self.automaton.checkpoints) - 1
        branches = [
            c for c in self.automaton.checkpoints if c != START and not self.automaton.outgoing(c)
        ]
        said = f"the program has {_count(steps, 'step')}, and the plan for it takes {_count(count, 'action')}"
        if len(branches) > 1:
            lengths = [sum(len(s.actions) for s in self._along(leaf)) for leaf in branches]
            said += f", of which I do between {min(lengths)} and {max(lengths)}"
        return sentence(said)

    def _along(self, checkpoint: str) -> Iterator[Segment]:
        for transition in self.automaton.path(checkpoint):
            if transition.target in self.plan.segments:
                yield self.plan.segments[transition.target]

    # Things and goals

    def _use(self, entity: str) -> str:
        said = []
        for transition in self.automaton.transitions.values():
            checkpoint = self.automaton.checkpoints[transition.target]
            goals = [g for g in checkpoint.goals if any(entity in x.args for x in literals_in(g))]
            if goals:
                lead = f"once {self._events(transition.when)}, " if transition.when else ""
                said.append(sentence(f"{lead}I {listed([self.wording.goal(g) for g in goals])}"))
        if said:
            return " ".join(said)
        actions = [a for s in self.plan.segments.values() for a in s.actions if entity in a.args]
        if actions:
            done = listed([self.wording.action(a) for a in dict.fromkeys(actions)][:4])
            return sentence(f"on the way, I {done}")
        return sentence(f"nothing: {self.wording.entity(entity)} isn't in the program")

    def _when(self, goals: Sequence[Goal]) -> str:
        wanted = {x for goal in goals for x in literals_in(goal)}
        asked = [s for s in self.plan.segments.values() if wanted <= set(s.goals)]
        if asked:
            return sentence(listed(list(dict.fromkeys(map(self._moment, asked)))))
        found = self._placed(goals)
        if found is None:
            return f"I don't do that: it isn't in the program. {_ASK}"
        aim = self._goals(found[0].target)
        return sentence(f"{self._moment(found[0])}, on the way to what you asked: {aim}")

    def _will(self, goals: Sequence[Goal]) -> str:
        found = self._placed(goals)
        if found is None:
            return f"No, that isn't in the program. {_ASK}"
        return sentence(f"yes, {self._moment(found[0])}")

    def _moment(self, segment: Segment) -> str:
        """When a segment is done: "once she acknowledges", "first of all", "after alerted"."""
        if segment.when:
            return f"once {self._events(segment.when)}"
        if self._lead(segment):
            return "if nothing else applies"
        return "first of all" if segment.source == START else f"after {self._name(segment.source)}"

    def _placed(self, goals: Sequence[Goal]) -> tuple[Segment, int | None] | None:
        """The segment, and the action in it, that brings a goal about; no action for what holds already."""
        wanted = [x for goal in goals for x in literals_in(goal)]
        segments = list(self.plan.segments.values())
        for segment in segments:
            if wanted and all(x in segment.goals for x in wanted):
                at = self._achiever(segment, wanted[-1])
                return segment, at
        for segment in segments:
            at = self._achiever(segment, wanted[-1]) if wanted else None
            if at is not None:
                return segment, at
        return None

    def _achiever(self, segment: Segment, literal: Literal) -> int | None:
        state = segment.before
        for at, action in enumerate(segment.actions):
            following = after(
                action, self.world.domain.operators[action.operator], state, self.world
            )
            if following.holds(literal) and not state.holds(literal):
                return at
            state = following
        return None

    # Why

    def _why(self, query: Query) -> str:
        if not query.goals:
            return self._why_step(query.checkpoint)
        found = self._placed(query.goals)
        if found is None:
            return f"I don't: that isn't in the plan. {_ASK}"
        segment, at = found
        if at is None:
            return sentence(
                f"because you asked me to {self._goals(segment.target) or 'wait there'}"
            )
        return self._why_action(segment, at)

    def _why_action(self, segment: Segment, at: int) -> str:
        """What an action is for: the actions that need it, and the goals at the end."""
        reasons = Reasons(self.plan, self.automaton, self.world)
        return purpose_in_words(reasons, Step(segment.target, at), self.wording)

    def _why_step(self, checkpoint: str | None) -> str:
        segment = self.plan.segments.get(checkpoint or "")
        if segment is None:
            asked = [self._goals(c) for c in self.plan.segments if self._goals(c)]
            if not asked:
                return self._whole()
            return sentence(f"because you asked me to {listed(asked[:4])}")
        goals = self._goals(segment.target)
        if not goals:
            return sentence(f"because you asked me to wait until {self._events(segment.when)}")
        lead = f"once {self._events(segment.when)}, " if segment.when else ""
        how = steps_in_words(segment, self.wording)
        if not segment.actions or how == goals:
            return sentence(f"because you asked me to {goals}")
        return f"{sentence(f'because you asked me to {goals}')} {sentence(f'{lead}to do that, I {how}')}"

    # Words

    def _goals(self, checkpoint: str) -> str:
        if checkpoint not in self.automaton.checkpoints:
            return ""
        return listed([self.wording.goal(g) for g in self.automaton.checkpoints[checkpoint].goals])

    def _events(self, when: Sequence[Literal]) -> str:
        return listed([self.wording.event(x) for x in when])

    def _name(self, checkpoint: str) -> str:
        name = self.automaton.checkpoints[checkpoint].name
        return "the start" if checkpoint == START else f'"{name}"'

    def _ways(self, checkpoint: str) -> list[Segment]:
        ways = self.automaton.outgoing(checkpoint)
        found = [self.plan.segments[t.target] for t in ways if t.target in self.plan.segments]
        return sorted(found, key=lambda s: not s.when)


_ASK = "Tell me, if you want it."


def _count(number: int, noun: str) -> str:
    return f"one {noun}" if number == 1 else f"{number} {noun}s"
