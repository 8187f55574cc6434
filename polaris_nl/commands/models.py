"""`models`: the speech model, fetched with its checksum."""

from __future__ import annotations

import os
import sys
import time
from argparse import Namespace

from polaris_nl.commands.common import print_json, print_text
from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.models import NAME, OVERRIDE, SIZE, fetch, model_folder, usual_folder

BAR = 30


def run(arguments: Namespace) -> int:
    """Makes sure that there is a whole model."""
    fetched = False
    if arguments.force and not os.environ.get(OVERRIDE):
        folder, fetched = fetch(_Progress(arguments.json)), True
    else:
        try:
            folder = model_folder()
        except SpeechError:
            if os.environ.get(OVERRIDE):
                raise
            folder, fetched = fetch(_Progress(arguments.json)), True
    if arguments.json:
        print_json({"model": NAME, "folder": str(folder), "fetched": fetched})
    else:
        print_text(f"The speech model {'is now' if fetched else 'is'} in {_short(str(folder))}.")
    return 0


def _short(folder: str) -> str:
    home = str(usual_folder().parents[2])
    return folder.replace(home, "~", 1) if folder.startswith(home) else folder


class _Progress:
    """A bar on the error output: redrawn on a terminal, a line a quarter elsewhere."""

    def __init__(self, silent: bool) -> None:
        self._silent = silent
        self._terminal = sys.stderr.isatty()
        self._shown = -1
        self._last = 0.0

    def __call__(self, done: int, total: int) -> None:
        if self._silent:
            return
        now = time.monotonic()
        step = done * 4 // total
        if self._terminal and (done >= total or now - self._last > 0.1):
            self._last = now
            filled = BAR * done // total
            bar = "#" * filled + "." * (BAR - filled)
            end = "\n" if done >= total else ""
            print(
                f"\rSpeech model [{bar}] {done >> 20} of {SIZE >> 20} MB",
                end=end,
                file=sys.stderr,
                flush=True,
            )
        elif not self._terminal and step > self._shown:
            self._shown = step
            print(f"Speech model: {done >> 20} of {SIZE >> 20} MB", file=sys.stderr, flush=True)
