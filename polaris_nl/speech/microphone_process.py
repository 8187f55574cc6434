"""The process that records a microphone, or says which there are.

    python -m polaris_nl.speech.microphone_process [DEVICE]
    python -m polaris_nl.speech.microphone_process --list

It writes frames of sound to standard output until standard input ends, or a JSON list of names.
A frame is one byte, 1 where sound was lost before it and else 0, and a block of 100 ms at 16 kHz, mono, 16 bit.
It ends with `REFUSED` where the device can't be opened.
"""

from __future__ import annotations

import json
import os
import queue
import sys
import threading
from collections.abc import Iterator
from typing import Any

from polaris_nl.speech.audio import BLOCK, RATE

FRAME = 1 + BLOCK * 2
"""Bytes of a frame."""
REFUSED = 3
"""The exit code for a device that can't be opened."""
LIST = "--list"
MOST_WAITING = 100
"""Blocks that are kept while nobody takes them: 10 s."""


def frames(library: Any, device: int | str | None) -> Iterator[bytes]:
    """Frames as they are recorded, without end.

    Args:
        library: sounddevice.
        device: its name, a part of it, or its number; the system's default if None.

    Raises:
        library.PortAudioError, ValueError: it can't be opened.
    """
    waiting: queue.Queue[bytes] = queue.Queue(MOST_WAITING)
    lost = [False]

    def keep(data: Any, count: int, when: Any, status: Any) -> None:
        lost[0] = lost[0] or bool(status.input_overflow)
        try:
            waiting.put_nowait(bytes([lost[0]]) + bytes(data))
            lost[0] = False
        except queue.Full:
            lost[0] = True

    stream = library.RawInputStream(
        samplerate=RATE, blocksize=BLOCK, channels=1, dtype="int16", device=device, callback=keep
    )
    stream.start()
    while True:
        yield waiting.get()


def unpacked(frame: bytes) -> tuple[bytes, bool]:
    """The block of a frame, and whether sound was lost before it."""
    return frame[1:], frame[0] == 1


def main() -> None:
    """Records."""
    import sounddevice

    named = sys.argv[1] if len(sys.argv) > 1 else ""
    if named == LIST:
        found = sounddevice.query_devices()
        sys.stdout.write(json.dumps([d["name"] for d in found if d["max_input_channels"] > 0]))
        return

    def end_with_parent() -> None:
        sys.stdin.buffer.read()
        os._exit(0)  # Leaving a device that is gone may never end.

    threading.Thread(target=end_with_parent, daemon=True).start()
    device = int(named) if named.isdigit() else named or None
    try:
        for frame in frames(sounddevice, device):
            sys.stdout.buffer.write(frame)
            sys.stdout.buffer.flush()
    except (sounddevice.PortAudioError, ValueError):
        os._exit(REFUSED)
    except BrokenPipeError:
        os._exit(0)


if __name__ == "__main__":
    main()
