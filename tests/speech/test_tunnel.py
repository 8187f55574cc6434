"""A microphone on another machine through a real SSH tunnel, from loopback to loopback."""

from __future__ import annotations

import itertools
import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from polaris_nl.speech.network import NetworkMicrophone
from polaris_nl.speech.trouble import Trouble
from tests.speech.test_sources import BLOCKS, chunk, server

PATIENCE_S = 30.0


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as probe:
        return int(probe.getsockname()[1])


def reachable(port: int) -> bool:
    with socket.socket() as probe:
        probe.settimeout(1)
        return probe.connect_ex(("127.0.0.1", port)) == 0


@pytest.fixture
def ssh_server(tmp_path: Path) -> Iterator[tuple[int, Path]]:
    """An SSH server of the test's own: its port and the key that opens it."""
    daemon = shutil.which("sshd") or "/usr/sbin/sshd"
    if not Path(daemon).exists() or shutil.which("ssh") is None:
        pytest.fail("scripts/install-system test installs openssh, and it isn't here")
    if os.geteuid() == 0:
        Path("/run/sshd").mkdir(mode=0o755, exist_ok=True)
    host, key = tmp_path / "host", tmp_path / "key"
    for path in (host, key):
        subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(path)], check=True)
    (tmp_path / "authorized").write_bytes(key.with_suffix(".pub").read_bytes())
    port = free_port()
    settings = {
        "Port": port, "ListenAddress": "127.0.0.1", "HostKey": host, "StrictModes": "no",
        "AuthorizedKeysFile": tmp_path / "authorized", "PidFile": tmp_path / "pid", "UsePAM": "no",
        "PermitRootLogin": "yes",
    }  # fmt: skip
    config = tmp_path / "sshd_config"
    config.write_text("".join(f"{k} {v}\n" for k, v in settings.items()))
    running = subprocess.Popen([daemon, "-D", "-f", str(config), "-E", str(tmp_path / "log")])
    try:
        until = time.monotonic() + PATIENCE_S
        while not reachable(port):
            assert time.monotonic() < until, (tmp_path / "log").read_text()
        yield port, key
    finally:
        running.terminate()
        running.wait(PATIENCE_S)


def test_sound_comes_through_a_tunnel(ssh_server: tuple[int, Path]) -> None:
    ssh_port, key = ssh_server
    robot_port = free_port()
    with server([], [chunk(b"".join(BLOCKS))]) as laptop_port:
        tunnel = subprocess.Popen([
            "ssh", "-N", "-p", str(ssh_port), "-i", str(key), "-o", "StrictHostKeyChecking=no",
            "-o", "UserKnownHostsFile=/dev/null", "-o", "ExitOnForwardFailure=yes", "-o", "LogLevel=ERROR",
            "-R", f"{robot_port}:127.0.0.1:{laptop_port}", "127.0.0.1",
        ])  # fmt: skip
        try:
            until = time.monotonic() + PATIENCE_S
            while not reachable(robot_port):  # the first connection of the server is for this
                assert tunnel.poll() is None
                assert time.monotonic() < until
            source = NetworkMicrophone("127.0.0.1", robot_port, lambda seconds: None)
            sound = (block for block in source.sound() if not isinstance(block, Trouble))
            found = list(itertools.islice(sound, 4))
        finally:
            tunnel.terminate()
            tunnel.wait(PATIENCE_S)
    assert b"".join(found) == b"".join(BLOCKS[:4])
