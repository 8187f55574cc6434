"""Utterance to interpretation, beside spaCy's tokenizer alone."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator

from bench.table import Row, timed
from polaris_nl.automaton.automaton import Automaton
from tests.language.phenomena_reader import all_phenomena
from tests.language.reader import language_of

LONG = (
    "bring the blue cup to the desk and fill the tray, then go to the kitchen, "
    "once the caregiver is in the office open the fridge, "
)
"""Some 25 words, said again and again for long utterances."""
SIZES = (60, 120, 240)


def rows() -> Iterator[Row]:
    """The rows about language."""
    import spacy

    tokens = spacy.blank("en")
    ours, plain = [], []
    for case in all_phenomena():
        language = language_of(case.world)
        for text in () if case.held_out else case.wordings:
            language.interpret(text, Automaton())
            ours += timed(lambda s=text, u=language: u.interpret(s, Automaton()), 1)
            plain += timed(lambda s=text: tokens(s), 1)
    yield Row("typed utterance -> interpretation", "p95 <= 15", ours, plain, "spaCy's tokens alone")
    for size in SIZES:
        text = " ".join((LONG * size).split()[:size])
        times = timed(lambda s=text: language_of("care-home").interpret(s, Automaton()), 5)
        yield Row(f"an utterance of {size} words", "", times)
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
    # What getrusage tells of a child begins with what its parent had.
    measure = (
        "\nfor line in open('/proc/self/status'):\n if line[:6] == 'VmHWM:': print(line.split()[1])"
    )
    return int(_python(code + measure)) / 1024
