"""A sound card made of software: what is played into it comes out of its microphone."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from pathlib import Path

import pytest

from polaris_nl.hands_free.recording import wav

PATIENCE_S = 30.0


class SoundCard:
    """A PulseAudio server of the test's own.

    Args:
        folder: where it keeps its files; `XDG_RUNTIME_DIR` and `HOME` must point below it.
    """

    def __init__(self, folder: Path) -> None:
        if shutil.which("pulseaudio") is None or shutil.which("paplay") is None:
            pytest.fail("scripts/install-system test installs pulseaudio, and it isn't here")
        self._folder = folder
        self._running: subprocess.Popen[bytes] | None = None

    def plug_in(self) -> None:
        """Starts it, and waits until it answers."""
        self._running = subprocess.Popen(
            [
                "pulseaudio", "-n", "--exit-idle-time=-1", "--daemonize=no", "--log-target=null",
                "-L", "module-native-protocol-unix", "-L", "module-null-sink sink_name=vmic",
            ],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        until = time.monotonic() + PATIENCE_S
        order = ["pactl", "set-default-source", "vmic.monitor"]
        while subprocess.run(order, capture_output=True).returncode:
            assert time.monotonic() < until, "PulseAudio doesn't answer"

    def unplug(self) -> None:
        """Ends it."""
        if self._running is not None:
            self._running.kill()
            self._running.wait(PATIENCE_S)
            self._running = None

    def play(self, sound: bytes) -> None:
        """Plays 16 kHz mono samples into the microphone, to the end."""
        path = self._folder / "play.wav"
        path.write_bytes(wav(sound))
        subprocess.run(["paplay", "--device=vmic", str(path)], check=True, timeout=PATIENCE_S)


def sound_card(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> SoundCard:
    """A sound card that is not plugged in yet."""
    runtime = tmp_path / "run"
    runtime.mkdir(mode=0o700)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(runtime))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("PULSE_RUNTIME_PATH", str(runtime))
    for name in ("PULSE_SERVER", "XDG_CONFIG_HOME"):
        monkeypatch.delenv(name, raising=False)
    os.environ.setdefault("DBUS_SESSION_BUS_ADDRESS", "disabled:")
    return SoundCard(tmp_path)
