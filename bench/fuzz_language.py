"""`python -m bench.fuzz_language [N]`: N random utterances, of which none may raise or half-change anything.

Half are made of any characters at all, and may change nothing. Half are made of the grammar's and the world's
words, of which a few happen to be goals; those are printed.
"""

from __future__ import annotations

import random
import sys
import time

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import apply_all
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world

OUTCOMES = ("applied", "question", "answer", "command", "refused")


def main() -> None:
    """Says random things to both shipped worlds."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    chance = random.Random(1)
    languages = [Understanding(load_world(world)) for world in ("care-home", "dinner-party")]
    vocabularies = [
        sorted({w for p in language.phrases() for w in p.split()}) for language in languages
    ]
    started, goals = time.perf_counter(), []
    for _ in range(count):
        index = chance.randrange(2)
        salad = chance.random() < 0.5
        text = (
            " ".join(chance.choices(vocabularies[index], k=chance.randrange(1, 12)))
            if salad
            else "".join(chr(_character(chance)) for _ in range(chance.randrange(60)))
        )
        meant, _dialogue = languages[index].interpret(text, Automaton())
        assert meant.outcome in OUTCOMES, text
        assert bool(meant.edits) == (meant.outcome == "applied") or meant.partial, text
        apply_all(Automaton(), meant.edits)
        if meant.edits:
            assert salad, text
            goals.append(f"{text!r}: {meant.say}")
    seconds = time.perf_counter() - started
    sys.stdout.write(
        f"{count} random utterances in {seconds:.0f} s: nothing raised, and no noise changed anything.\n"
    )
    sys.stdout.write("".join(f"Words that happen to be goals: {goal}\n" for goal in goals))


def _character(chance: random.Random) -> int:
    """Any code point but a surrogate, mostly of the first thousand."""
    code = chance.randrange(0x400) if chance.random() < 0.7 else chance.randrange(0x110000)
    return 0x20 if 0xD800 <= code <= 0xDFFF else code


if __name__ == "__main__":
    main()
