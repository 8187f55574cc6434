"""One thread that makes every rclpy call.

rclpy loses the replies to goals that are sent from a thread other than its executor's, so nothing but
this thread touches it. What is to be done is handed over as a coroutine and advanced here, between
the callbacks; each wait in it has a deadline, since a robot that was killed never answers.
"""

from __future__ import annotations

import contextlib
import queue
import threading
import time
from collections.abc import Callable, Coroutine, Generator
from concurrent.futures import Future as Handed
from dataclasses import dataclass
from typing import Any, TypeVar

from polaris_nl.execution.ros.middleware import load_rclpy
from polaris_nl.model.errors import RunError

T = TypeVar("T")
Job = Coroutine[None, None, Any]

TURN_S = 0.01
"""How long the thread waits for messages before it looks at its jobs again."""
CLOSE_S = 3.0


class Late(Exception):
    """A wait was over before what it was for; `what` names it."""

    def __init__(self, what: str, seconds: float) -> None:
        super().__init__(f"{what} took more than {seconds:g} seconds")
        self.what = what


class _Turn:
    """Gives the thread back until its next turn."""

    def __await__(self) -> Generator[None, None, None]:
        yield


async def until(ready: Callable[[], bool], seconds: float, what: str) -> None:
    """Waits until something is so.

    Raises:
        Late: it isn't within `seconds`.
    """
    deadline = time.monotonic() + seconds
    while not ready():
        if time.monotonic() >= deadline:
            raise Late(what, seconds)
        await _Turn()


async def pause(seconds: float) -> None:
    """Lets time pass."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        await _Turn()


async def within(future: Any, seconds: float, what: str) -> Any:
    """The result of an rclpy future.

    Raises:
        Late: there is none within `seconds`; the future is cancelled.
    """
    try:
        await until(lambda: future.done() or future.cancelled(), seconds, what)
    except BaseException:
        future.cancel()
        raise
    if future.cancelled():
        raise Late(what, 0.0)
    return future.result()


@dataclass(slots=True)
class _Running:
    job: Job
    handed: Handed[Any]


class Owner:
    """A node, its context, and the thread that owns both.

    Args:
        name: the node's name.
        set_up: is called in the thread with the node before anything else.
        watch: is called in the thread at every turn, some hundred times a second.
        last: is called in the thread when it ends by a fault of its own, before the node goes.

    Attributes:
        failure: why the thread ended by a fault of its own, or "".

    Raises:
        RunError: rclpy is missing, or can't start.
    """

    def __init__(
        self,
        name: str,
        set_up: Callable[[Any], None],
        watch: Callable[[], None] = lambda: None,
        last: Callable[[], None] = lambda: None,
    ) -> None:
        self._rclpy = load_rclpy()
        self._name = name
        self._set_up = set_up
        self._watch = watch
        self._last = last
        self._jobs: list[_Running] = []
        self._inbox: queue.SimpleQueue[_Running] = queue.SimpleQueue()
        self._closing = threading.Event()
        self.failure = ""
        self._ready: Handed[None] = Handed()
        self._executor: Any = None
        self._thread = threading.Thread(target=self._run, name="ros", daemon=True)
        self._thread.start()
        try:
            self._ready.result(timeout=10.0)
        except BaseException:
            self._closing.set()
            raise

    @property
    def alive(self) -> bool:
        """Whether the thread runs."""
        return self._thread.is_alive() and not self._closing.is_set()

    def start(self, job: Coroutine[None, None, T]) -> Handed[T]:
        """Hands a coroutine over; from any thread. Cancelling what is returned ends it at its next wait."""
        handed: Handed[T] = Handed()
        self._inbox.put(_Running(job, handed))
        if self._executor is not None:
            self._executor.wake()  # A guard condition: the one call that other threads may make.
        return handed

    def do(self, job: Coroutine[None, None, T], seconds: float) -> T:
        """Has a coroutine done, and waits for it; not from the thread itself.

        Raises:
            RunError: it isn't done in time.
        """
        handed = self.start(job)
        try:
            return handed.result(timeout=seconds)
        except TimeoutError as error:
            handed.cancel()
            raise RunError(
                f"The link to the robot didn't come back within {seconds:g} seconds; start the run again."
            ) from error

    def close(self) -> None:
        """Ends the thread, the node and the context. Jobs that still run are ended."""
        self._closing.set()
        if self._executor is not None:
            self._executor.wake()
        if threading.current_thread() is not self._thread:
            self._thread.join(CLOSE_S)

    def _run(self) -> None:
        context = self._rclpy.Context()
        try:
            context.init()
            self._serve(context)
        except BaseException as error:
            self.failure = _reason(error)
            if not self._ready.done():
                self._ready.set_exception(_as_run_error(error))
        finally:
            for running in self._jobs:
                running.job.close()
                running.handed.cancel()
            while not self._inbox.empty():
                running = self._inbox.get()
                running.job.close()
                running.handed.cancel()
            context.try_shutdown()

    def _serve(self, context: Any) -> None:
        node = self._rclpy.create_node(
            self._name, context=context, start_parameter_services=False, enable_rosout=False
        )
        executors = __import__("rclpy.executors", fromlist=["SingleThreadedExecutor"])
        executor = executors.SingleThreadedExecutor(context=context)
        executor.add_node(node)
        try:
            self._set_up(node)
            self._executor = executor
            self._ready.set_result(None)
            while not self._closing.is_set() and context.ok():
                executor.spin_once(timeout_sec=TURN_S)
                self._watch()
                self._advance()
        except BaseException:
            with contextlib.suppress(Exception):
                self._last()
                executor.spin_once(timeout_sec=0.1)
            raise
        finally:
            self._executor = None
            executor.remove_node(node)
            node.destroy_node()
            executor.shutdown(timeout_sec=1.0)

    def _advance(self) -> None:
        while not self._inbox.empty():
            self._jobs.append(self._inbox.get())
        for running in tuple(self._jobs):
            if running.handed.cancelled():
                running.job.close()
                self._jobs.remove(running)
                continue
            try:
                running.job.send(None)
            except StopIteration as done:
                self._jobs.remove(running)
                _settle(running.handed, result=done.value)
            except BaseException as error:
                self._jobs.remove(running)
                _settle(running.handed, error=error)


def _settle(handed: Handed[Any], result: Any = None, error: BaseException | None = None) -> None:
    if handed.set_running_or_notify_cancel():
        if error is None:
            handed.set_result(result)
        else:
            handed.set_exception(error)


def _as_run_error(error: BaseException) -> BaseException:
    if isinstance(error, RunError):
        return error
    return RunError(
        f"The link to the robot can't be opened ({_reason(error)}); see: polaris-nl doctor"
    )


def _reason(error: BaseException) -> str:
    return f"{type(error).__name__}: {(str(error).splitlines() or [''])[0]}"
