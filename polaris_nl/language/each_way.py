"""What is to be done at the end of every branch: "either way, go home afterwards"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, Edit, apply
from polaris_nl.language.changes import NOTHING_CHANGES, Changes, MeantThen
from polaris_nl.language.cores import trimmed
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.generate import goals_in_words
from polaris_nl.language.protocol import Language
from polaris_nl.language.scope import Unclear
from polaris_nl.language.structure import Step
from polaris_nl.language.tokens import words
from polaris_nl.language.waiting import applied

_EACH_WAY = (
    ("either", "way"), ("in", "either", "case"), ("in", "both", "cases"), ("in", "each", "case"),
    ("in", "any", "case"), ("in", "all", "cases"), ("in", "every", "case"), ("both", "times"),
)  # fmt: skip
"""Words by which something is to be done on every branch."""
_WHATEVER = (("whatever",), ("whichever",), ("however",), ("regardless",), ("no", "matter"))
"""Words in front of what doesn't matter: "whatever she says"."""
_MATTERS = frozenset(
    (
        "happens",
        "says",
        "say",
        "does",
        "do",
        "answers",
        "answer",
        "replies",
        "decides",
        "chooses",
        "wants",
    )
)
"""Words that end what doesn't matter; "whatever is on the table" is something to be brought."""
_MOST = 6
"""Words of what doesn't matter."""
_AT_LAST = (
    ("at", "the", "end"), ("in", "the", "end"), ("at", "last"), ("afterwards",), ("after", "that"),
    ("finally",), ("then",), ("and",), ("also",),
)  # fmt: skip
"""Words that say no more than where it goes."""


def each_way(
    language: Language,
    changes: Changes,
    utterance: str,
    program: Automaton,
    dialogue: Dialogue,
) -> MeantThen | None:
    """Steps at the end of every branch that doesn't end with them; None where that isn't asked for."""
    ends = [c for c in program.leaves() if c != START]
    spoken = trimmed(words(utterance))
    # "Close it in any case", of one way only, doesn't wait for what it waited for.
    ways = (*_behind_it(spoken), *(_before_it(spoken) if len(ends) > 1 else ()))
    for said in ways:
        try:
            steps = changes.steps(said, dialogue)
        except Unclear:
            continue
        if ends and steps and all(s.goals and not s.when and s.role == "then" for s in steps):
            edits: list[Edit] = []
            changed, made = program, []
            for end in ends:
                new = [] if _ends_so(program, end, steps) else _added(language, changed, end, steps)
                made += [edit.checkpoint.id for edit in new]
                for edit in new:
                    changed = apply(changed, edit)
                edits += new
            done = ", then ".join(goals_in_words(s.goals, language.wording) for s in steps)
            say = f"in each case, {done}" if edits else NOTHING_CHANGES
            return applied(language, utterance, edits, say, program, dialogue, made)
    return None


def _behind_it(said: Sequence[str]) -> Iterator[Sequence[str]]:
    """What is to be done, behind that it is so in any case."""
    for phrase in _EACH_WAY:
        if tuple(said[: len(phrase)]) == phrase:
            yield _bare(said[len(phrase) :])
    for at in range(2, min(_MOST, len(said) - 1)):
        if _matters_not(said[:at]):
            yield _bare(said[at:])


def _before_it(said: Sequence[str]) -> Iterator[Sequence[str]]:
    """What is to be done, before that it is so in any case."""
    for phrase in _EACH_WAY:
        if tuple(said[-len(phrase) :]) == phrase:
            yield _bare(said[: -len(phrase)])
    for at in range(max(len(said) - _MOST, 2), len(said) - 1):
        if _matters_not(said[at:]):
            yield _bare(said[:at])


def _matters_not(tokens: Sequence[str]) -> bool:
    """Whether tokens are "whatever she says" or the like."""
    begins = any(tuple(tokens[: len(phrase)]) == phrase for phrase in _WHATEVER)
    return begins and tokens[-1] in _MATTERS


def _bare(tokens: Sequence[str]) -> Sequence[str]:
    """Tokens without the words that say no more than where it goes, at either end."""
    said = trimmed(tokens)
    while True:
        front = next((len(w) for w in _AT_LAST if tuple(said[: len(w)]) == w), 0)
        behind = next((len(w) for w in _AT_LAST if tuple(said[-len(w) :]) == w), 0)
        if not front and not behind:
            return said
        said = trimmed(said[front : len(said) - behind])


def _ends_so(program: Automaton, end: str, steps: Sequence[Step]) -> bool:
    """Whether a branch ends with some steps already."""
    way = [*(arrow.source for arrow in program.path(end)), end][-len(steps) :]
    return [set(program.checkpoints[c].goals) for c in way] == [set(s.goals) for s in steps]


def _added(
    language: Language, program: Automaton, end: str, steps: Sequence[Step]
) -> list[AddCheckpoint]:
    edits: list[AddCheckpoint] = []
    for step in steps:
        name = language.names.checkpoint(step.goals, (), program)
        new = Checkpoint(program.fresh_checkpoint_id(), name, step.goals)
        edits.append(AddCheckpoint(new, Transition(program.fresh_transition_id(), end, new.id)))
        program, end = apply(program, edits[-1]), new.id
    return edits
