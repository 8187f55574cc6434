"""An SSH server of the test's own, on loopback, and terminals that are connected to it."""

from __future__ import annotations

import getpass
import os
import shlex
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[2]
LIMIT_S = 20.0
SSHD = shutil.which("sshd") or ("/usr/sbin/sshd" if Path("/usr/sbin/sshd").exists() else None)
MISSING = (
    "no SSH server is installed, and this is about SSH: run scripts/install-system test"
    if SSHD is None or shutil.which("ssh") is None or shutil.which("tmux") is None
    else ""
)


class Tmux:
    """A terminal of 80 columns and 24 rows, on a socket of its own."""

    def __init__(self, folder: Path, name: str = "tmux") -> None:
        self._socket = folder / name
        self.folder = folder

    def __call__(self, *arguments: str) -> str:
        environment = {k: v for k, v in os.environ.items() if k != "TMUX"}
        command = ["tmux", "-S", str(self._socket), "-f", os.devnull, *arguments]
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=LIMIT_S
        )
        return done.stdout

    def open(self, *arguments: str) -> None:
        self.start(shlex.join([sys.executable, "-m", "polaris_nl.cli", *arguments]))

    def start(self, command: str) -> None:
        # The shell stays, so that the exit code can be read off the screen.
        self("new-session", "-d", "-x", "80", "-y", "24", f"{command}; echo code $?; cat")

    def screen(self) -> str:
        return self("capture-pane", "-p")

    def see(self, *texts: str, seconds: float = LIMIT_S) -> str:
        """Waits for texts, which may be wrapped."""
        deadline = time.monotonic() + seconds
        while not all(text in (screen := self.screen()) or text in _flat(screen) for text in texts):
            assert time.monotonic() < deadline, screen
            time.sleep(0.05)
        return screen

    def keys(self, *keys: str) -> None:
        self("send-keys", *keys)

    def write(self, text: str) -> None:
        self("send-keys", "-l", text)

    def type(self, line: str) -> None:
        self.write(line)
        self.keys("Enter")

    def choose(self, words: str, then: str) -> None:
        """Filters the menu that is open, chooses, and waits for what comes."""
        self.write(words)
        self.see(f"filter: {words}")
        self.keys("Enter")
        self.see(then)


def _flat(screen: str) -> str:
    return " ".join(screen.split())


class Sshd:
    """A server with keys of its own, for this user alone.

    Attributes:
        state: where programs that are started through it keep their state.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.state = folder / "state"
        settings = folder / "config" / "polaris-nl" / "tui.toml"
        settings.parent.mkdir(parents=True)
        settings.write_text(f'logs = "{folder / "logs"}"\n')
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self._port = probe.getsockname()[1]
        for name in ("host", "user"):
            subprocess.run(
                ["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(folder / name)],
                check=True,
                timeout=LIMIT_S,
            )
        (folder / "authorized").write_text((folder / "user.pub").read_text())
        settings = (
            f"Port {self._port}\nListenAddress 127.0.0.1\nHostKey {folder / 'host'}\n"
            f"AuthorizedKeysFile {folder / 'authorized'}\nPidFile {folder / 'pid'}\n"
            "StrictModes no\nUsePAM no\nPasswordAuthentication no\nPrintMotd no\nPermitRootLogin yes\n"
        )
        (folder / "sshd_config").write_text(settings)
        assert SSHD is not None
        if os.getuid() == 0:
            Path("/run/sshd").mkdir(mode=0o755, exist_ok=True)
        self._log = (folder / "sshd.log").open("w")
        self._process = subprocess.Popen(
            [SSHD, "-D", "-e", "-f", str(folder / "sshd_config")],
            stdout=self._log,
            stderr=self._log,
        )
        self._wait()

    def _wait(self) -> None:
        deadline = time.monotonic() + LIMIT_S
        while True:
            try:
                socket.create_connection(("127.0.0.1", self._port), 1).close()
                return
            except OSError:
                log = (self.folder / "sshd.log").read_text()
                assert time.monotonic() < deadline, log
                assert self._process.poll() is None, log
                time.sleep(0.05)

    def command(self, *arguments: str) -> str:
        """What a shell runs to get `polaris-nl ARGUMENTS` in a terminal through this server."""
        variables = {
            "PYTHONPATH": os.environ.get("PYTHONPATH", ""),
            "XDG_STATE_HOME": str(self.state),
            "XDG_CONFIG_HOME": str(self.folder / "config"),
            "LANG": "C.UTF-8",
        }
        inner = shlex.join(
            [
                "env",
                *(f"{k}={v}" for k, v in variables.items()),
                *(sys.executable, "-m", "polaris_nl.cli", *arguments),
            ]
        )
        there = f"cd {shlex.quote(str(self.folder))} && exec {inner}"
        options = ("StrictHostKeyChecking=no", "UserKnownHostsFile=/dev/null", "LogLevel=ERROR")
        return shlex.join(
            ["ssh", "-tt", "-F", "none", "-p", str(self._port), "-i", str(self.folder / "user")]
            + [part for option in options for part in ("-o", option)]
            + [f"{getpass.getuser()}@127.0.0.1", there]
        )

    @property
    def process(self) -> int:
        """The server's process."""
        return self._process.pid

    def close(self) -> None:
        self._process.terminate()
        self._process.wait(LIMIT_S)
        self._log.close()


@contextmanager
def server(folder: Path) -> Iterator[Sshd]:
    found = Sshd(folder)
    try:
        yield found
    finally:
        found.close()
