"""The weights of a Whisper model as CTranslate2 keeps them: a file of named arrays."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

from polaris_nl.model.errors import SpeechError

_VERSION = 6
_KIND = b"WhisperSpec\0"
_HEAD = struct.pack("<IH", _VERSION, len(_KIND)) + _KIND
_TYPES = ("<f4", "<i1", "<i2", "<i4", "<f2")


def read_weights(path: Path) -> Mapping[str, Any]:
    """The arrays of a model file (`model.bin`) by name, as they are kept.

    The layout is that of CTranslate2's own converter (`ctranslate2/specs/model_spec.py`): names are
    length-prefixed and end with a zero, numbers are little-endian.

    Args:
        path: the file.

    Raises:
        SpeechError: it is no such file, or of another version.
    """
    import numpy

    with path.open("rb") as file:
        if file.read(len(_HEAD)) != _HEAD:
            raise SpeechError(
                f"{path}: not a Whisper model of version {_VERSION}; install the versions that "
                "requirements-robot.lock names, or do without: --no-second."
            )
        _, count = _numbers(file, "II")
        found: dict[str, Any] = {}
        for _ in range(count):
            name = _name(file)
            (rank,) = _numbers(file, "B")
            shape = _numbers(file, "I" * rank)
            kept, size = _numbers(file, "BI")
            found[name] = numpy.frombuffer(file.read(size), _TYPES[kept]).reshape(shape)
        (count,) = _numbers(file, "I")
        for _ in range(count):
            alias, name = _name(file), _name(file)
            found[alias] = found[name]
    return found


def _numbers(file: BinaryIO, layout: str) -> tuple[int, ...]:
    return struct.unpack(f"<{layout}", file.read(struct.calcsize(f"<{layout}")))


def _name(file: BinaryIO) -> str:
    (size,) = _numbers(file, "H")
    return file.read(size)[:-1].decode()
