"""The `polaris-nl` command: reads the command line and hands over to one module of `polaris_nl.commands`.

Nothing heavy is imported before it is known to be needed, so that `--help` and mistakes are answered at once.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import sys
from collections.abc import Sequence
from io import TextIOWrapper

from polaris_nl.commands.parser import make_parser
from polaris_nl.model.errors import PolarisError

INTERRUPTED = 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one command.

    Returns:
        0 done, 1 the program or run has a problem that was named, 2 wrong usage.
    """
    _be_harmless()
    parsed = make_parser().parse_args(arguments)
    try:
        command = importlib.import_module(f"polaris_nl.commands.{parsed.module}")
        code = int(command.run(parsed))
        sys.stdout.flush()
    except PolarisError as error:
        return _fail(str(error), error.exit_code)
    except KeyboardInterrupt:
        return _fail("Stopped.", INTERRUPTED)
    except BrokenPipeError:
        # Whoever read the output has seen enough; Python would complain once more at exit.
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except OSError as error:
        name = f" {error.filename}" if error.filename else ""
        return _fail(
            f"Can't go on:{name} {error.strerror or error}. Make room or choose another place.", 1
        )
    except ModuleNotFoundError as error:
        extra = {"textual": "tui", "vosk": "voice", "soundfile": "voice", "soxr": "voice"}
        package = extra.get((error.name or "").partition(".")[0])
        if package is None:
            raise
        return _fail(
            f'This needs {error.name}, which is not installed: pip install "polaris-nl[{package}]"',
            1,
        )
    return code


def _fail(sentence: str, code: int) -> int:
    with contextlib.suppress(OSError):
        sys.stdout.flush()
    with contextlib.suppress(OSError):
        print(f"polaris-nl: {' '.join(sentence.split())}", file=sys.stderr, flush=True)
    if sys.stdout.closed or code == 1:
        with contextlib.suppress(OSError, ValueError):
            _drop_unwritten()
    return code


def _drop_unwritten() -> None:
    """Keeps Python from failing at exit over output that a full disk has not taken."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _be_harmless() -> None:
    """Characters that the terminal or the pipe can't take are shown by number instead of failing."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    if isinstance(sys.stdin, TextIOWrapper):
        sys.stdin.reconfigure(errors="replace")


if __name__ == "__main__":
    sys.exit(main())
