"""Fast Downward's search binary in a child process: everything through pipes, with hard limits.

The child can't write a file, takes no more memory and processor time than it is given, even if this
process is gone by then, and is killed when its time is over or nobody wants its plan any more.
`POLARIS_NL_PLANNER` names another search program.
"""

from __future__ import annotations

import contextlib
import math
import os
import resource
import signal
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Literal as OneOf

from polaris_nl.model.errors import PlanningError

OPTIMAL = "astar(lmcut())"
OPTIMAL_ANY = "astar(blind())"
QUICK = "lazy_greedy([ff()], preferred=[ff()])"
MEMORY_BYTES = 2_000_000_000
POLL_S = 0.05
"""How often a running search asks whether it has been cancelled."""

OVERRIDE = "POLARIS_NL_PLANNER"

_SOLVED = 0
_UNSOLVABLE = {11, 10}
_OUT_OF_TIME = {12, 21, 23, 24, -signal.SIGXCPU}
_OUT_OF_MEMORY = {20, 22}

_NO_MEMORY = (
    "The planning took more memory than there is for it; split the step in two, or ask for less."
)

Status = OneOf["solved", "unsolvable", "undecided", "cancelled"]


@dataclass(frozen=True, slots=True)
class Found:
    """What a search found.

    Attributes:
        plan: the actions as `(operator arg ...)`, for `solved`.
        reason: for `undecided`, what happened, where it wasn't the time.
    """

    status: Status
    plan: tuple[str, ...] = ()
    reason: str = ""


def search(sas: str, engine: str, seconds: float, cancelled: Callable[[], bool]) -> Found:
    """Runs one search.

    Args:
        sas: the translated problem.
        engine: one of the engines above.
        seconds: the hard limit.
        cancelled: asked now and then; True ends the search.

    Raises:
        PlanningError: the binary is missing or crashed.
    """
    # The plan goes to the second pipe, so that no file is ever written.
    command = [str(binary()), "--search", engine, "--internal-plan-file", "/dev/stderr"]
    deadline = time.monotonic() + seconds
    try:
        child = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
    except OSError as error:
        raise PlanningError(
            f"The planner can't be started: {error.strerror}. Run: polaris-nl doctor"
        ) from error
    with child:
        try:
            _limit(child.pid, math.ceil(seconds) + 1)
            plan = _communicate(child, sas, deadline, cancelled)
        finally:
            if child.poll() is None:
                child.kill()
    if plan is None:
        return Found("cancelled" if cancelled() else "undecided")
    return _outcome(child.returncode, plan)


def binary() -> Path:
    """The search program: the one that the environment names, or that of the up-fast-downward package.

    Raises:
        PlanningError: it is not installed.
    """
    named = os.environ.get(OVERRIDE)
    return Path(named) if named else _packaged()


@cache
def _packaged() -> Path:
    # Only located: importing the package would import unified-planning, which takes two seconds.
    package = find_spec("up_fast_downward")
    if package is None or package.origin is None:
        raise PlanningError("The planner up-fast-downward is not installed; install it with pip.")
    path = Path(package.origin).parent / "downward/builds/release/bin/downward"
    if not path.is_file():
        raise PlanningError(
            "The planner's search program is missing; install up-fast-downward again."
        )
    return path


def _limit(pid: int, seconds: int) -> None:
    """Limits a child before it gets its problem: memory in bytes, processor time in seconds, no files."""
    limits = (
        (resource.RLIMIT_AS, MEMORY_BYTES),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, 0),
    )
    with contextlib.suppress(OSError, ValueError):  # It may be dead already.
        for limit, most in limits:
            resource.prlimit(pid, limit, (most, most))


def _communicate(
    child: subprocess.Popen[str], sas: str, deadline: float, cancelled: Callable[[], bool]
) -> str | None:
    text: str | None = sas
    while True:
        try:
            _, plan = child.communicate(text, timeout=POLL_S)
        except subprocess.TimeoutExpired:
            text = None
            if cancelled() or time.monotonic() > deadline:
                return None
        else:
            return str(plan)


def _outcome(code: int, output: str) -> Found:
    if code == _SOLVED:
        return Found("solved", tuple(x.strip() for x in output.splitlines() if x.startswith("(")))
    if code in _UNSOLVABLE:
        return Found("unsolvable")
    if code in _OUT_OF_TIME:
        return Found("undecided")
    if code in _OUT_OF_MEMORY:
        return Found("undecided", reason=_NO_MEMORY)
    how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
    raise PlanningError(f"The planner {how}; nothing of your program is lost. Try again, or undo.")
