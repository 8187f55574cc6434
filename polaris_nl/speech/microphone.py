"""A microphone of this machine, by sounddevice: found, tried, and found again after it was unplugged.

It is recorded by a process of its own (`microphone_process.py`): with some sound systems, leaving a
device that is gone never ends, whether its stream is stopped or aborted. A process can be ended always.
"""

from __future__ import annotations

import importlib
import json
import os
import select
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.audio import INSTALL
from polaris_nl.speech.microphone_process import FRAME, LIST, REFUSED, unpacked
from polaris_nl.speech.trouble import Trouble

FIRST_S = 6.0
"""How long the first block may take: opening a device takes up to two seconds, and a process has to start."""
LOST_S = 1.0
"""A microphone that gives nothing for so long is gone."""
AGAIN_S = 1.0
"""Seconds between attempts to open it again."""
_READ = 1 << 16


class Microphone:
    """A microphone.

    Args:
        device: its name, a part of it, or its number; the system's default if None.
        wait: waits some seconds before the next attempt.
    """

    live = True

    def __init__(self, device: str | None, wait: Callable[[float], None] = time.sleep) -> None:
        self.name = device or "the microphone"
        self._device = device
        self._wait = wait

    def sound(self) -> Iterator[bytes | Trouble]:
        """Blocks as they are recorded; after a loss, blocks again as soon as the device is back.

        Raises:
            SpeechError: it can't be used from the start.
        """
        _require()
        first, troubled = True, False
        while True:
            try:
                for block in _blocks(self._device):
                    if troubled and isinstance(block, bytes):
                        yield Trouble(f"{self._called} is back.", over=True)
                        troubled = False
                    first = False
                    yield block
            except _Refused as error:
                if first:
                    here = ", ".join(microphones()) or "none"
                    raise SpeechError(
                        f"{self._called} can't be used. Microphones here: {here}. A recording can be given "
                        "instead: --mic FILE.wav"
                    ) from error
            if not troubled:
                yield Trouble(f"{self._called} gives no sound any more. Plug it in again; I wait.")
                troubled = True
            self._wait(AGAIN_S)

    @property
    def _called(self) -> str:
        return f"The microphone {self._device}" if self._device is not None else "The microphone"


class _Refused(Exception):
    """The device can't be opened."""


def _blocks(device: str | None) -> Iterator[bytes | Trouble]:
    """Blocks until the device gives no more.

    Raises:
        _Refused: it can't be opened.
    """
    recorder = subprocess.Popen(
        [*_process(), device or ""],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    assert recorder.stdout is not None
    assert recorder.stdin is not None
    try:
        patience, pending = FIRST_S, b""
        while select.select([recorder.stdout], [], [], patience)[0]:
            found = os.read(recorder.stdout.fileno(), _READ)
            if not found:
                if recorder.wait() == REFUSED:
                    raise _Refused(device)
                return
            pending += found
            while len(pending) >= FRAME:
                frame, pending = pending[:FRAME], pending[FRAME:]
                patience = LOST_S
                block, lost = unpacked(frame)
                if lost:
                    yield Trouble(
                        "Some sound was lost: this machine is too busy. Say it again.", over=True
                    )
                yield block
    finally:
        recorder.kill()
        recorder.stdin.close()
        recorder.stdout.close()
        recorder.wait()


def microphones() -> list[str]:
    """The names of the microphones there are now; empty where there is no sound at all.

    They are asked for in a process, too: PortAudio looks for devices once, when it is loaded.
    """
    asked = subprocess.run(
        [*_process(), LIST],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    found: list[str] = json.loads(asked.stdout) if asked.returncode == 0 else []
    return found


def _process() -> list[str]:
    return [sys.executable, "-m", "polaris_nl.speech.microphone_process"]


def _require() -> None:
    """Says what is missing, if anything is.

    Raises:
        SpeechError: sounddevice or its library.
    """
    try:
        importlib.import_module("sounddevice")  # Its library is loaded with it.
    except ImportError as error:
        raise SpeechError(f"A microphone needs sounddevice. {INSTALL}") from error
    except OSError as error:
        raise SpeechError(
            "A microphone needs the PortAudio library; install it with: sudo scripts/install-system voice"
        ) from error
