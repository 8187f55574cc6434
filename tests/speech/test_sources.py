"""Pipes, microphones over the network, and what is said when one is lost."""

from __future__ import annotations

import contextlib
import io
import itertools
import os
import socket
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from polaris_nl.model.errors import SpeechError, UsageError
from polaris_nl.speech.audio import BLOCK, RATE
from polaris_nl.speech.network import NetworkMicrophone, address
from polaris_nl.speech.sources import Pipe, source_for
from polaris_nl.speech.trouble import Trouble

BLOCKS = [bytes([n, 0]) * BLOCK for n in range(1, 6)]


def chunk(sound: bytes, rate: int = RATE, width: int = 2, channels: int = 1) -> bytes:
    from wyoming.event import Event, write_event

    out = io.BytesIO()
    data = {"rate": rate, "width": width, "channels": channels}
    write_event(Event("audio-chunk", data, sound), out)
    return out.getvalue()


@contextlib.contextmanager
def server(*connections: list[bytes]) -> Iterator[int]:
    """A microphone server: each connection is sent its messages and closed."""
    listener = socket.create_server(("127.0.0.1", 0))

    def serve() -> None:
        for messages in connections:
            try:
                peer, _ = listener.accept()
            except OSError:
                return
            with peer, contextlib.suppress(OSError):
                for message in messages:
                    peer.sendall(message)

    thread = threading.Thread(target=serve)
    thread.start()
    yield listener.getsockname()[1]
    listener.shutdown(socket.SHUT_RDWR)
    listener.close()
    thread.join()


def taken(source: NetworkMicrophone, count: int) -> list[bytes | Trouble]:
    return list(itertools.islice(source.sound(), count))


def no_wait(seconds: float) -> None:
    pass


def test_sound_comes_over_the_network() -> None:
    with server([chunk(b"".join(BLOCKS))]) as port:
        found = taken(NetworkMicrophone("127.0.0.1", port, no_wait), 4)
    assert [len(block) for block in found if isinstance(block, bytes)] == [BLOCK * 2] * 4


def test_a_lost_connection_is_said_once_and_made_again() -> None:
    sound = chunk(b"".join(BLOCKS * 2))
    with server([sound], [sound]) as port:
        found = taken(NetworkMicrophone("127.0.0.1", port, no_wait), 14)
    troubles = [(at, t) for at, t in enumerate(found) if isinstance(t, Trouble)]
    assert [t.over for _, t in troubles] == [False, True]
    assert "was closed" in troubles[0][1].text
    assert "is back" in troubles[1][1].text


def test_no_server_is_said_at_once_with_what_to_look_at() -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    (trouble,) = taken(NetworkMicrophone("127.0.0.1", port, no_wait), 1)
    assert isinstance(trouble, Trouble)
    assert "is the tunnel open" in trouble.text


@pytest.mark.parametrize(
    "message",
    [b"this is no event\n", chunk(b"x" * 99, rate=1), chunk(b"x" * 99, width=3), chunk(b"xx")[:-1]],
)
def test_what_is_no_sound_is_a_trouble_and_no_crash(message: bytes) -> None:
    with server([message]) as port:
        (trouble,) = taken(NetworkMicrophone("127.0.0.1", port, no_wait), 1)
    assert isinstance(trouble, Trouble)


@pytest.mark.parametrize("own", ["tcp://127.0.0.1:10700", "tcp://localhost", "tcp://[::1]:10700"])
def test_this_machine_s_addresses_are_taken(own: str) -> None:
    assert address(own)[1] == 10_700


@pytest.mark.parametrize(
    "other", ["tcp://192.0.2.7:10700", "tcp://laptop.example", "tcp://[2001:db8::1]"]
)
def test_other_machines_are_refused_unless_told(other: str) -> None:
    with pytest.raises(UsageError, match=r"another machine.*ssh -R.*--allow-remote"):
        source_for(other)
    assert address(other, remote=True)[1] == 10_700


@pytest.mark.parametrize("bad", ["tcp://", "tcp://:5", "tcp://127.0.0.1:99999"])
def test_no_address_is_a_usage_error(bad: str) -> None:
    with pytest.raises(UsageError, match="tcp://HOST:PORT"):
        source_for(bad)


def test_a_pipe_gives_what_is_written_to_it_and_waits_for_the_next_writer(tmp_path: Path) -> None:
    path = tmp_path / "mic"
    os.mkfifo(path)
    source = source_for(str(path))
    assert isinstance(source, Pipe)
    again = threading.Event()

    def write() -> None:
        path.write_bytes(b"".join(BLOCKS[:2]))
        again.wait(10)
        path.write_bytes(BLOCKS[2])

    writer = threading.Thread(target=write)
    writer.start()
    sound = source.sound()
    assert [next(sound), next(sound)] == BLOCKS[:2]
    assert isinstance(next(sound), Trouble)
    again.set()
    assert next(sound) == BLOCKS[2]
    writer.join()


def test_a_pipe_that_can_t_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(SpeechError, match="can't be read"):
        list(Pipe(tmp_path / "gone").sound())
