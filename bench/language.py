"""Utterance to interpretation, beside spaCy's tokenizer alone."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator

from bench.table import Row, timed
from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world

SENTENCES = (
    "tell the resident that lunch is ready",
    "once she acknowledges bring a full tray to her table and then go home",
    "if she dismisses it just go home",
    "could you please put the blue cup on the desk and fill the tray",
    "tell the resident that lunch is ready. once she acknowledges, bring a full tray to her table and then go "
    "home. if she dismisses it, just go home",
    "open the fridge, take the bottle of water out and bring it to mr brown's nightstand",
    "what will you do if she dismisses it?",
    "bring the zeppelin to the moon",
    "unless the caregiver is in the office bring all the cups to the kitchen",
    "no I meant the other table",
)


def rows() -> Iterator[Row]:
    """The rows about language."""
    import spacy

    understanding = Understanding(load_world("care-home"))
    tokens = spacy.blank("en")
    for text in SENTENCES:
        understanding.interpret(text, Automaton())
    ours, plain = [], []
    for _ in range(10):
        for text in SENTENCES:
            ours += timed(lambda text=text: understanding.interpret(text, Automaton()), 1)  # type: ignore[misc]
            plain += timed(lambda text=text: tokens(text), 1)  # type: ignore[misc]
    yield Row("typed utterance -> interpretation", "p95 <= 15", ours, plain, "spaCy's tokens alone")
    _python(START)
    yield Row(
        "start-up of the language side",
        "<= 1000",
        [_ready(START) for _ in range(7)],
        [_ready("import spacy") for _ in range(7)],
        "import spacy",
        note="from the start of a process until the world is read and a sentence is understood",
    )
    yield Row(
        "resident memory of the language side",
        "<= 250",
        [_memory(START)],
        [_memory("import spacy")],
        "import spacy",
        "MB",
    )


START = (
    "from polaris_nl.automaton.automaton import Automaton\n"
    "from polaris_nl.language.understanding import Understanding\n"
    "from polaris_nl.model.world_file import load_world\n"
    "Understanding(load_world('care-home')).interpret('go home', Automaton())\n"
)


def _python(code: str) -> str:
    return subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True
    ).stdout


def _ready(code: str) -> float:
    """Milliseconds from the start of a process to the end of some code in it."""
    started = time.perf_counter()
    command = [sys.executable, "-c", f"{code}\nprint(flush=True)"]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.readline()
        return (time.perf_counter() - started) * 1000


def _memory(code: str) -> float:
    measure = "\nimport resource; print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)"
    return float(_python(code + measure))
