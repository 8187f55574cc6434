"""A microphone on another machine, over the Wyoming protocol: such as a laptop's, through an SSH tunnel.

The protocol has no authentication of its own, so only this machine's own addresses are used unless
the user says otherwise; a tunnel makes the other machine's port one of them.
"""

from __future__ import annotations

import ipaddress
import socket
import time
from collections.abc import Callable, Iterator
from urllib.parse import urlsplit

from polaris_nl.model.errors import SpeechError, UsageError
from polaris_nl.speech.audio import INSTALL, Converter
from polaris_nl.speech.trouble import Trouble

PORT = 10_700
AGAIN_S = 1.0
"""Seconds between attempts to connect."""
QUIET_S = 5.0
"""A microphone that sends nothing for so long is lost, whatever its connection says."""
WIDTHS = (2, 4)


class NetworkMicrophone:
    """Sound from a Wyoming microphone server.

    Args:
        host: its address.
        port: its port.
        wait: waits some seconds before the next attempt.
    """

    live = True

    def __init__(self, host: str, port: int, wait: Callable[[float], None] = time.sleep) -> None:
        self.name = f"tcp://{host}:{port}"
        self._address = (host, port)
        self._wait = wait

    def sound(self) -> Iterator[bytes | Trouble]:
        """Blocks as they come; connects again, for ever, after the connection was lost."""
        try:
            import wyoming.event  # noqa: F401 - said now, not after the first connection
        except ImportError as error:
            raise SpeechError(f"A microphone over the network needs wyoming. {INSTALL}") from error
        troubled = False
        while True:
            try:
                with socket.create_connection(self._address, QUIET_S) as connection:
                    for block in _blocks(connection):
                        if troubled:
                            yield Trouble(f"The microphone {self.name} is back.", over=True)
                            troubled = False
                        yield block
                reason = "was closed"
            except (OSError, ValueError, KeyError) as error:
                reason = f"is not there ({error})"
            if not troubled:
                yield Trouble(
                    f"The microphone {self.name} {reason}. I try again every second; is the tunnel open "
                    "and the microphone server running?"
                )
                troubled = True
            self._wait(AGAIN_S)


def _blocks(connection: socket.socket) -> Iterator[bytes]:
    from wyoming.event import read_event

    converter: Converter | None = None
    form: tuple[int, int, int] | None = None
    with connection.makefile("rb") as stream:
        while (event := read_event(stream)) is not None:
            if event.type != "audio-chunk" or not event.payload:
                continue
            now = _form(event.data)
            if converter is None or now != form:
                converter, form = Converter(now[0]), now
            yield from converter.push_bytes(event.payload, now[1], now[2])


def _form(data: dict[str, object]) -> tuple[int, int, int]:
    try:
        rate, width, channels = (int(str(data[k])) for k in ("rate", "width", "channels"))
    except (KeyError, ValueError) as error:
        raise ValueError("what it sends is no sound") from error
    if not (4_000 <= rate <= 384_000 and width in WIDTHS and 1 <= channels <= 32):
        raise ValueError(f"it sends {rate} Hz, {width} bytes, {channels} channels")
    return rate, width, channels


def address(named: str, remote: bool = False) -> tuple[str, int]:
    """Host and port of `tcp://HOST:PORT`.

    Args:
        named: what was given.
        remote: whether other machines' addresses may be used.

    Raises:
        UsageError: it is none, or not this machine's own.
    """
    parts = urlsplit(named)
    try:
        host, port = parts.hostname or "", parts.port or PORT
    except ValueError as error:
        raise UsageError(f"{named} is no address; give tcp://HOST:PORT.") from error
    if not host:
        raise UsageError(f"{named} names no machine; give tcp://HOST:PORT.")
    if not remote and not _own(host):
        raise UsageError(
            f"{host} is another machine, and anybody between it and this one could speak to the robot. Open a "
            f"tunnel (ssh -R {port}:127.0.0.1:{port}) and use tcp://127.0.0.1:{port}, or insist with "
            "--allow-remote."
        )
    return host, port


def _own(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
