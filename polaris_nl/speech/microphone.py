"""A microphone of this machine, by sounddevice: found, tried, and found again after it was unplugged."""

from __future__ import annotations

import queue
import time
from collections.abc import Callable, Iterator
from typing import Any

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.audio import BLOCK, INSTALL, RATE
from polaris_nl.speech.trouble import Trouble

FIRST_S = 4.0
"""How long the first block may take: opening a device takes up to two seconds."""
LOST_S = 1.0
"""A microphone that gives nothing for so long is gone."""
AGAIN_S = 1.0
"""Seconds between attempts to open it again."""
MOST_WAITING = 100
"""Blocks that are kept while nobody takes them: 10 s."""


class Microphone:
    """A microphone.

    Args:
        device: its name, a part of it, or its number; the system's default if None.
        wait: waits some seconds before the next attempt.
    """

    live = True

    def __init__(self, device: str | None, wait: Callable[[float], None] = time.sleep) -> None:
        self.name = device or "the microphone"
        self._device = int(device) if device and device.isdigit() else device
        self._wait = wait

    def sound(self) -> Iterator[bytes | Trouble]:
        """Blocks as they are recorded; after a loss, blocks again as soon as the device is back.

        Raises:
            SpeechError: it can't be used from the start.
        """
        library = _library()
        first, looked, troubled = True, False, False
        while True:
            try:
                for block in self._blocks(library):
                    if troubled and isinstance(block, bytes):
                        yield Trouble(f"{self._called} is back.", over=True)
                        troubled = False
                    first = False
                    yield block
            except (library.PortAudioError, ValueError) as error:
                if first and not looked:
                    looked = True
                    _look_again(library)
                    continue
                if first:
                    raise SpeechError(
                        f"{self._called} can't be used. Microphones here: {_known()}. A recording can be given "
                        "instead: --mic FILE.wav"
                    ) from error
            if not troubled:
                yield Trouble(f"{self._called} gives no sound any more. Plug it in again; I wait.")
                troubled = True
            self._wait(AGAIN_S)
            _look_again(library)

    @property
    def _called(self) -> str:
        return f"The microphone {self._device}" if self._device is not None else "The microphone"

    def _blocks(self, library: Any) -> Iterator[bytes | Trouble]:
        """Blocks until the device gives no more."""
        waiting: queue.Queue[bytes] = queue.Queue(MOST_WAITING)
        lost = [0]

        def keep(data: Any, frames: int, when: Any, status: Any) -> None:
            if status.input_overflow:
                lost[0] += 1
            try:
                waiting.put_nowait(bytes(data))
            except queue.Full:
                lost[0] += 1

        stream = library.RawInputStream(
            samplerate=RATE, blocksize=BLOCK, channels=1, dtype="int16", device=self._device, callback=keep
        )  # fmt: skip
        try:
            stream.start()
            patience = FIRST_S
            while True:
                try:
                    block = waiting.get(timeout=patience)
                except queue.Empty:
                    return
                patience = LOST_S
                if lost[0]:
                    lost[0] = 0
                    yield Trouble(
                        "Some sound was lost: this machine is too busy. Say it again.", over=True
                    )
                yield block
        finally:
            # To stop it would wait for the device to end its last block, and one that is gone never does.
            stream.abort()
            stream.close()


def microphones() -> list[str]:
    """The names of the microphones there are; empty where there is no sound at all."""
    try:
        library = _library()
    except SpeechError:
        return []
    return [d["name"] for d in library.query_devices() if d["max_input_channels"] > 0]


def _known() -> str:
    return ", ".join(microphones()) or "none"


def _library() -> Any:
    try:
        import sounddevice
    except ImportError as error:
        raise SpeechError(f"A microphone needs sounddevice. {INSTALL}") from error
    except OSError as error:
        raise SpeechError(
            "A microphone needs the PortAudio library; install it with: sudo scripts/install-system voice"
        ) from error
    return sounddevice


def _look_again(library: Any) -> None:
    """PortAudio lists devices once, when it starts; so it is started anew to see what was plugged in."""
    library._terminate()
    library._initialize()
