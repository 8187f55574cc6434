"""Edits of what is there: changes of checkpoints by name, by number, or by what is done there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint
from polaris_nl.automaton.edits import (
    RenameCheckpoint,
    SetGoals,
    apply_all,
)
from polaris_nl.language.afterthoughts import limited, narrowed, spared, step_about
from polaris_nl.language.conditions import condition_in, span_of
from polaris_nl.language.connecting import connected
from polaris_nl.language.dialogue import Dialogue, Latest
from polaris_nl.language.edited_steps import NOT_START, going_on, latest_step, pair
from polaris_nl.language.elsewhere import taken_there
from polaris_nl.language.generate import goals_in_words, steps_in_words
from polaris_nl.language.goal_relations import flat
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.mention import Mention
from polaris_nl.language.patterns import Match, Patterns
from polaris_nl.language.protocol import Language
from polaris_nl.language.reading import steps_of
from polaris_nl.language.references import Reference, meant
from polaris_nl.language.reordering import asked_anew, moved, there_already
from polaris_nl.language.reshaping import (
    Reshaped,
    conditional,
    cut_after,
    merged,
    merged_all,
    moved_before,
    moved_behind,
    otherwise,
    put_after,
    put_before,
    put_between,
    removed_latest,
    removed_with_rest,
    several_removed,
    split,
    swapped,
    unconditional,
)
from polaris_nl.language.scope import Misfit, Unclear
from polaris_nl.language.segment import Item
from polaris_nl.language.structure import Step
from polaris_nl.language.tokens import BREAK, COMMA, phrase
from polaris_nl.model.errors import EditError
from polaris_nl.model.formula import Goal, Literal
from polaris_nl.model.text import listed, sentence

MOST_NAMED = 8
"""Steps that a refusal names."""
_REFUSABLE = (
    "remove", "rename", "move", "move-before", "swap", "merge", "split", "cut-after", "remove-rest", "connect",
    "else", "unconditional", "between",
)  # fmt: skip
_TAKES_DOING = ("with", "by", "step", "one")
"""Words behind which something to do may be said as "going to the kitchen"."""
_BY_DOING = ("start", "by")
"""Words before which "going to the kitchen" is something to do."""
_PLACING = ("before", "after", "before-that", "at-start")
"""Intents that put a step where it belongs, new or not."""
NO_STEPS = "There are no steps yet; say what the robot should achieve first."
NOTHING_OF_THAT = "That isn't asked for, so there is nothing to leave out."
NOTHING_CHANGES = "It is like that already; nothing changes."
MeantThen = tuple[Interpretation, Dialogue]


def steps_there(program: Automaton) -> str:
    """A sentence that names the steps of a program."""
    made = [c.name for c in program.checkpoints.values() if c.id != START]
    more = f" and {len(made) - MOST_NAMED} more" if len(made) > MOST_NAMED else ""
    if len(made) == 1:
        return f"The only step is {made[0]}."
    return f"The steps are {listed(made[:MOST_NAMED])}{more}."


class Changes:
    """Reads edits for the language side of one world."""

    def __init__(self, language: Language) -> None:
        self._language = language

    def edited(
        self, utterance: str, matches: Iterable[Match], program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        """An edit of checkpoints that are there, or None where the utterance is none."""
        question: Unclear | None = None
        for match in matches:
            try:
                edits, say, touched = self._edits(match, program, dialogue)
                changed = apply_all(program, edits)
            except Unclear as unclear:
                question = question or unclear
                continue
            except Misfit:
                continue
            except EditError as error:
                return self._language.refused(utterance, sentence(str(error))), dialogue
            if changed == program:
                return Interpretation(utterance, "answer", NOTHING_CHANGES), dialogue
            kept = tuple(t for t in touched if t in changed.checkpoints)
            here = going_on(kept, program, changed, dialogue)
            spans = {name: (found.start, found.end) for name, found in match.references.items()}
            latest = Latest(
                tuple(match.tokens),
                program,
                changed,
                replace(dialogue, latest=None),
                match.intent,
                spans,
            )
            after = replace(dialogue, here=here, touched=kept, latest=latest)
            return Interpretation(utterance, "applied", sentence(say), tuple(edits)), after
        if question is not None:
            return self._language.asked(utterance, question, dialogue)
        return None

    def missing(self, tokens: Sequence[str], patterns: Patterns, program: Automaton) -> str:
        """Why an edit of a checkpoint that isn't there can't be done, or ""."""
        found = next(patterns.unnamed(tokens, _REFUSABLE), None)
        if found is None:
            return ""
        if len(program.checkpoints) == 1:
            return NO_STEPS
        words = " ".join(w for w in found[1] if w not in (COMMA, BREAK))
        return f'There is no step "{words}". {steps_there(program)}'

    def _edits(self, match: Match, program: Automaton, dialogue: Dialogue) -> Reshaped:
        """The edits of a match, what to say, and the checkpoints they touch.

        Raises:
            Misfit: the match is not what was meant.
            Unclear: a question has to be asked.
            EditError: it can't be done.
        """
        intent, slots = match.intent, match.slots
        if intent == "else" and self._language.asks_for(match.tokens[1:]):
            # "Otherwise put the cup away" asks for it, whatever step does that already.
            raise Misfit("")
        named = {
            name: meant(found, match.tokens, program, dialogue.scope)
            for name, found in match.references.items()
        }
        for slot, other in (("x", "k"), ("y", "l")):
            if slot in slots and intent != "together":
                named[other] = self._about(slots[slot], (), program, dialogue)
        latest = latest_step(program, dialogue)
        if intent in ("limit", "spare"):
            return self._limited(match, named.get("k", latest), program, dialogue)
        if intent == "remove-latest":
            return removed_latest(program, int(str(slots["q"])), latest)
        if intent in ("at-start", "before-that"):
            return self._put(match, START if intent == "at-start" else latest, program, dialogue)
        this = named.get("k", latest)
        if intent == "unconditional" and not named:
            # "Don't wait for her", said of what waits, may be said when there is more behind it.
            this = next((t.target for t in reversed(program.path(latest)) if t.when), latest)
        if this == START and intent in NOT_START:
            raise EditError(NOT_START[intent])
        name = program.checkpoints[this].name
        if "k" in match.references:
            # "Rather than putting the towel there, hand it to her": it is the towel.
            for goal in flat(program.checkpoints[this].goals):
                if goal.args:
                    dialogue = replace(dialogue, scope=dialogue.scope.after(goal.args[:1]))
        if intent == "remove":
            return several_removed(program, [named[slot] for slot in ("k", "l") if slot in named])
        if intent == "rename":
            return _renamed(match, program, this)
        if intent in _ALONE:
            return _ALONE[intent](program, this)
        if intent == "split":
            return split(program, this, self._language.names)
        if intent == "merge" and not named and "all" in match.tokens:
            return merged_all(program)
        if intent in _TOGETHER:
            return _TOGETHER[intent](program, *pair(intent, named, latest, program, match.tokens))
        if intent == "connect":
            return connected(self._language, match, this, named["l"], program, dialogue)
        if intent == "condition":
            when = condition_in(
                self._language, match.tokens, slots["c"], dialogue.scope, introduced=True
            )
            if not when:
                raise Misfit("")
            step = Step(program.checkpoints[this].goals, when, "condition")
            return conditional(program, this, when, steps_in_words([step], self._language.wording))
        if intent in ("replace", "also", "together"):
            goals, _ = self.goals(match.tokens, slots.get("g"), dialogue)
            if intent == "replace":
                start, end = span_of(slots["g"])
                there = program.checkpoints[this].goals
                goals = taken_there(self.steps, match.tokens[start:end], goals, there, dialogue)
            words = goals_in_words(goals, self._language.wording)
            if intent == "together":
                if self._tells(match.tokens, match.slots["g"]):
                    raise Misfit("")  # "... the boy is playing with it": it is what is told.
                this = self._about(slots["y"], goals, program, dialogue)
                name = program.checkpoints[this].name
            if intent != "replace":
                kept = program.checkpoints[this].goals
                if any(g.negation in kept for g in goals if isinstance(g, Literal)):
                    raise Misfit("")
                return [SetGoals(this, (*kept, *goals))], f"in {name}, also {words}", [this]
            incoming = program.incoming(this)
            names = self._language.names.renamed(
                program, this, goals, incoming.when if incoming else ()
            )
            return [SetGoals(this, goals), *names], f"in {name}: {words}", [this]
        if intent != "between":
            return self._put(match, this, program, dialogue)
        one, two = pair(intent, named, latest, program)
        one, two = (two, one) if program.parent(one) == two else (one, two)
        return self._put(match, one, program, dialogue, two)

    def _tells(self, tokens: Sequence[str], span: object) -> bool:
        """Whether something is only told in a span of tokens."""
        assert isinstance(span, tuple)
        cuts = self._language.cuts(tokens[span[0] : span[1]])
        return bool(cuts) and any(item.role in ("fact", "topic") for item in cuts[0].items)

    def _about(
        self, thing: object, alike: Sequence[Goal], program: Automaton, dialogue: Dialogue
    ) -> str:
        """The step that is about a thing: "do the bowls first", "the plate along with the cup"."""
        assert isinstance(thing, Mention)
        touched = [c for c in dialogue.touched if c in program.checkpoints]
        spoken_of = [(r,) for r in reversed(dialogue.scope.referents)]
        if not thing.pronoun:
            named = self._language.resolver.meant(thing, (), dialogue.scope).entities
            return step_about([named], alike, touched, program)
        return step_about(spoken_of, alike, touched, program)

    def _limited(
        self, match: Match, latest: str, program: Automaton, dialogue: Dialogue
    ) -> Reshaped:
        """A condition that is said behind a step: "but only if she is in", "unless it's open"."""
        when = condition_in(self._language, match.tokens, match.slots["f"], dialogue.scope)
        if not when or latest == START:
            raise Misfit("")
        several = tuple(c for c in reversed(dialogue.touched) if c in program.checkpoints)
        several = (latest,) if "x" in match.slots else several
        whole = Reference(0, len(match.tokens), several or (latest,))
        this = meant(whole, match.tokens, program, dialogue.scope)
        if match.intent == "spare":
            return spared(program, this, when, self._language.names)
        incoming = program.incoming(this)
        when = narrowed(incoming.when if incoming else (), when)
        step = Step(program.checkpoints[this].goals, when, "condition")
        return limited(program, this, when, steps_in_words([step], self._language.wording))

    def _put(
        self,
        match: Match,
        this: str,
        program: Automaton,
        dialogue: Dialogue,
        other: str | None = None,
    ) -> Reshaped:
        """New steps before, after or between what is there."""
        first, *rest = self._several(match.tokens, match.slots.get("g"), dialogue)
        name = program.checkpoints[this].name
        if match.intent == "before-that" and this == START:
            raise Misfit("")
        moved = self._moved(match, this, [first, *rest], program)
        if moved is not None:
            return moved
        new = self._new(first.goals, first.when, program)
        said = (goals_in_words(step.goals, self._language.wording) for step in (first, *rest))
        words = ", then ".join(said)
        if match.intent == "between" and other is not None:
            edits = put_between(program, new, this, other)
            say = f"between the steps {name} and {program.checkpoints[other].name}, {words}"
        elif match.intent == "at-start":
            edits, say = put_after(program, new, START), f"first, {words}"
        elif match.intent in ("before", "before-that"):
            edits = put_before(program, new, this, first.when)
            say = f"before the step {name}, {words}"
        else:
            edits = put_after(program, new, this, first.when)
            say = f"after the step {name}, {words}"
        added, all_edits = [new.id], [*edits]
        for step in rest:
            program = apply_all(program, edits)
            new = self._new(step.goals, (), program)
            edits = put_after(program, new, added[-1])
            added.append(new.id)
            all_edits += edits
        return all_edits, say, added

    def _moved(
        self, match: Match, this: str, steps: Sequence[Step], program: Automaton
    ) -> Reshaped | None:
        """A step that is there already, before or after another one; None where it is a new one."""
        intent, goals = match.intent, steps[0].goals
        if intent not in _PLACING or asked_anew(match.tokens):
            return None
        if len(steps) > 1 or steps[0].when or not goals or self._by_name(match, program):
            return None
        first = next(iter(program.children(START)), START)
        if intent == "at-start" or goals == program.checkpoints[this].goals:
            this = first
        if goals == program.checkpoints[this].goals:
            return [], "", []
        order = there_already(program, (goals, program.checkpoints[this].goals))
        if order is None and intent == "before-that":
            this = first
            order = there_already(program, (goals, program.checkpoints[this].goals))
        if order is None:
            return None
        return moved(program, order[0], this, behind=intent == "after")

    def _by_name(self, match: Match, program: Automaton) -> bool:
        """Whether a step is spoken of by its name: then something is to come after it, new or not."""
        found = match.references.get("k")
        if found is None:
            return False
        said = " ".join(match.tokens[found.start : found.end])
        return any(said == " ".join(phrase(c.name)) for c in program.checkpoints.values())

    def _new(
        self, goals: tuple[Goal, ...], when: tuple[Literal, ...], program: Automaton
    ) -> Checkpoint:
        name = self._language.names.checkpoint(goals, when, program)
        return Checkpoint(program.fresh_checkpoint_id(), name, goals)

    def goals(
        self, tokens: Sequence[str], span: object, dialogue: Dialogue
    ) -> tuple[tuple[Goal, ...], tuple[Literal, ...]]:
        """The goals of a step in a span of tokens, and its condition.

        Raises:
            Misfit: it is no step, or several.
            Unclear: a question has to be asked.
        """
        step, *rest = self._several(tokens, span, dialogue)
        if rest:
            raise Misfit("")
        return step.goals, step.when

    def _several(self, tokens: Sequence[str], span: object, dialogue: Dialogue) -> list[Step]:
        """The steps in a span of tokens, one after the other; the first may wait for something.

        Raises:
            Misfit: it is no step.
            Unclear: a question has to be asked.
        """
        assert isinstance(span, tuple)
        said = list(tokens[span[0] : span[1]])
        steps = self.steps(said, dialogue)
        if not steps and tokens[span[0] - 1] in _TAKES_DOING:
            steps = self.steps([*_BY_DOING, *said], dialogue)
        if (
            not steps
            or not (steps[0].goals or steps[0].when)
            or not all(_plain(s) for s in steps[1:])
        ):
            raise Misfit("")
        return steps

    def steps(
        self, tokens: Sequence[str], dialogue: Dialogue, branched: bool = False
    ) -> list[Step]:
        """The steps that some tokens ask for, none where they ask for none.

        Args:
            tokens: what was said.
            dialogue: what was said before.
            branched: there is a condition that "otherwise" can belong to.

        Raises:
            Unclear: a question has to be asked.
        """
        question: Unclear | None = None
        for cut in self._language.cuts(tokens):
            if cut.unknown or not any(_asks(i) for i in cut.items):
                continue
            try:
                steps, _ = steps_of(cut, self._language.resolver, dialogue.scope, branched)
            except Misfit:
                continue
            except Unclear as unclear:
                question = question or unclear
                continue
            if steps:
                return steps
        if question is not None:
            raise question
        return []


def _asks(item: Item) -> bool:
    return item.role in ("goal", "again") or item.mark == "nothing"


_ALONE: Mapping[str, Callable[[Automaton, str], Reshaped]] = {
    "cut-after": cut_after,
    "remove-rest": removed_with_rest,
    "else": otherwise,
    "unconditional": unconditional,
}
_TOGETHER: Mapping[str, Callable[[Automaton, str, str], Reshaped]] = {
    "move": moved_behind,
    "move-before": moved_before,
    "merge": merged,
    "swap": swapped,
}


def _renamed(match: Match, program: Automaton, this: str) -> Reshaped:
    span = match.slots["n"]
    assert isinstance(span, tuple)
    wanted = " ".join(match.tokens[span[0] : span[1]])
    name = program.checkpoints[this].name
    return [RenameCheckpoint(this, wanted)], f"{name} is called {wanted} now", [this]


def _plain(step: Step) -> bool:
    return not step.when and step.role == "then"
