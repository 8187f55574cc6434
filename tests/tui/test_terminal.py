"""In a real terminal: what a person over SSH gets, and how many bytes it takes."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

from bench.tui import Terminal, echoes, keys, moves, plans
from tests.tui.conftest import LIMIT_S
from tests.tui.ssh import Tmux

SENTENCES = (
    "Tell the resident that lunch is ready.",
    "Once she acknowledges, bring a full tray to her table and then go home.",
    "If she dismisses it, just go home.",
)


@pytest.fixture
def tmux(tmp_path: Path) -> Iterator[Tmux]:
    if shutil.which("tmux") is None:
        pytest.fail("tmux is not installed; scripts/install-system test does it")
    terminal = Tmux(tmp_path)
    yield terminal
    terminal("kill-server")


def test_lunch_over_a_terminal(tmux: Tmux) -> None:
    file = tmux.folder / "lunch.polaris.json"
    tmux.open("tui", str(file), "--world", "care-home")
    tmux.see("empty program", "lunch.polaris.json")
    for sentence in SENTENCES:
        tmux.type(sentence)
        tmux.see("ok, ", "The plan takes")
    tmux.see("ok, 14 actions")
    tmux("send-keys", "F2")
    tmux.see(
        "─ Program ─", "alerted: tell the resident", "once lunch is dismissed", "cancelled: go home"
    )
    tmux("send-keys", "C-q")
    assert "Program" not in tmux.see("code 0")
    assert '"alerted"' in file.read_text()


def test_few_bytes_are_sent(tmp_path: Path) -> None:
    with Terminal(tmp_path) as terminal:
        terminal.settle(b"empty program")
        assert max(islice(keys(terminal), 3)) <= 1024
        terminal.send(b"\x15")
        assert max(plans(terminal)) <= 6144
        assert max(islice(moves(terminal), 3)) <= 512


def test_it_needs_a_terminal() -> None:
    command = [sys.executable, "-m", "polaris_nl.cli", "tui", "--world", "care-home"]
    done = subprocess.run(
        command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=LIMIT_S
    )
    assert done.returncode == 2
    assert done.stderr.startswith("polaris-nl: The terminal application needs a terminal;")


def test_without_textual_one_sentence_says_so() -> None:
    script = """
import sys
class Missing:
    def find_spec(self, name, path=None, target=None):
        if name == "textual":
            raise ModuleNotFoundError(name="textual")
sys.meta_path.insert(0, Missing())
for stream in (sys.stdin, sys.stdout, sys.stderr):
    stream.isatty = lambda: True
from polaris_nl.cli import main
sys.exit(main(["tui", "--world", "care-home"]))
"""
    done = subprocess.run(
        [sys.executable, "-c", script], stdin=subprocess.DEVNULL, capture_output=True, text=True
    )
    assert done.returncode == 1
    (sentence,) = done.stderr.splitlines()
    assert sentence.startswith("polaris-nl: This needs textual, which is not installed:")


def test_keys_typed_ahead_keep_their_order(tmux: Tmux) -> None:
    tmux.open("tui", "--world", "care-home")
    tmux.see("empty program")
    tmux("send-keys", "-l", "nonsense")
    tmux("send-keys", "C-u", "go to the hall", "Enter", "open the fridge", "Enter", "F7", "x")
    screen = tmux.see("Undone: Open the fridge", "> x", "ok, 1 action")
    # A colon in the program opens the list of actions; what follows at once is a word, not keys.
    tmux("send-keys", "C-u", "Tab", ":history", "Enter")
    tmux.see("Where to go back, or forward, to")
    tmux("send-keys", "Escape")
    assert "> go to the hall" in screen
    assert "> open the fridge" in screen
    tmux("send-keys", "C-q")
    tmux.see("code 0")


def test_typing_does_not_wait_for_planning(tmp_path: Path) -> None:
    found = sorted(echoes(tmp_path, 200))
    assert len(found) == 100  # none was lost
    assert found[50] <= 100
