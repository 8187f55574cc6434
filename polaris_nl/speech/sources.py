"""Where sound comes from, behind one protocol: a recording, a pipe, a microphone, the network."""

from __future__ import annotations

import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.audio import BLOCK, file_blocks
from polaris_nl.speech.trouble import Trouble

RECORDINGS = (".wav", ".flac", ".ogg")


class Source(Protocol):
    """Gives blocks of 16 kHz mono 16-bit samples, and says at once when it can't."""

    @property
    def name(self) -> str:
        """What to call it."""
        ...

    @property
    def live(self) -> bool:
        """Whether sound comes at the pace of the world, without end; a recording comes as it is asked for."""
        ...

    def sound(self) -> Iterator[bytes | Trouble]:
        """Blocks of 100 ms, and troubles between them. Ends with the recording; a live source doesn't.

        Raises:
            SpeechError: it can't be used at all.
        """
        ...


@dataclass(frozen=True)
class Recording:
    """A file of any rate and channels."""

    path: Path
    live: bool = False

    @property
    def name(self) -> str:
        """The file's name."""
        return self.path.name

    def sound(self) -> Iterator[bytes | Trouble]:
        """Its blocks."""
        yield from file_blocks(self.path)


@dataclass(frozen=True)
class Pipe:
    """A named pipe that another program writes raw sound to: 16 kHz, mono, 16 bit, little-endian.

    Each time a writer closes the pipe, the next is waited for.
    """

    path: Path
    live: bool = True
    again: bool = True

    @property
    def name(self) -> str:
        """The pipe's name."""
        return self.path.name

    def sound(self) -> Iterator[bytes | Trouble]:
        """Blocks as they are written."""
        while True:
            try:
                with self.path.open("rb") as file:
                    while block := file.read(BLOCK * 2):
                        yield block if len(block) % 2 == 0 else block[:-1]
            except OSError as error:
                raise SpeechError(
                    f"The pipe {self.path} can't be read: {error.strerror}. Make one with: mkfifo"
                ) from error
            if not self.again:
                return
            yield Trouble("Nobody writes to the pipe any more; I wait for the next one.")


def source_for(named: str | None, remote: bool = False) -> Source:
    """The source that `--mic` names: a recording, a pipe, `tcp://HOST:PORT`, or a microphone.

    Args:
        named: what was given; the system's microphone if None.
        remote: whether addresses other than this machine's own may be used.

    Raises:
        UsageError: the address is none, or not this machine's.
    """
    if named and named.startswith("tcp://"):
        from polaris_nl.speech.network import NetworkMicrophone, address

        return NetworkMicrophone(*address(named, remote))
    if named:
        path = Path(named)
        if path.exists() and stat.S_ISFIFO(path.stat().st_mode):
            return Pipe(path)
        if path.suffix.lower() in RECORDINGS or path.is_file():
            return Recording(path)
    from polaris_nl.speech.microphone import Microphone

    return Microphone(named)
