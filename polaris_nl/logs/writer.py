"""Writes events to MCAP so that a crash loses nothing that was written, and the disk delays nobody.

While a run lasts, its file is a journal (`logs/journal.py`): each event goes to the system at once, in the
caller's thread, which takes some microseconds; what may take long, forcing the file to the disk and
compressing it, is done in a thread of the log's own. Where the disk is busy for so long that even the
first could take time, events queue up in memory, up to a limit, and what doesn't fit is counted and said.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType

from polaris_nl.execution.events import (
    Edited,
    Event,
    Failed,
    GoalConfirmed,
    GoalSent,
    Halted,
    RunEnded,
    RunStarted,
    Stepped,
)
from polaris_nl.logs.finalising import finalise
from polaris_nl.logs.journal import Journal
from polaris_nl.logs.keeping import ABOUT, CUT_OFF
from polaris_nl.logs.keeping import LogSettings as LogSettings
from polaris_nl.logs.keeping import RawKind as RawKind
from polaris_nl.logs.keeping import attachments_of as attachments_of
from polaris_nl.logs.records import Records
from polaris_nl.model.errors import LogError

FORCED: tuple[type[Event], ...] = (Edited, GoalSent, GoalConfirmed, Halted, RunStarted, RunEnded)
"""Events after which the file is forced to the disk, so that even a power cut keeps them."""
AUDIO = "audio/"


@dataclass(slots=True)
class _Disk:
    """What the log's own thread is at: since when it forces the file to the disk, and what is asked of it."""

    since: float | None = None
    wanted: bool = False
    closing: bool = False
    old: list[Journal] = field(default_factory=list)


class LogWriter:
    """An open log. Safe to use from several threads.

    Args:
        path: the file to make; it must not exist. Later parts get names of their own.
        attachments: texts that make the log explain itself elsewhere, by name: program, domain,
            world.
        settings: how it is kept.

    Attributes:
        failure: why nothing is written any more, or "".
        lost: what is missing since the disk was too slow, or "".

    Raises:
        LogError: the file can't be made.
    """

    def __init__(
        self,
        path: Path,
        attachments: Mapping[str, str] | None = None,
        settings: LogSettings | None = None,
    ) -> None:
        self.path = path
        self.failure = self.lost = ""
        self._settings = settings or LogSettings()
        self._lock = threading.Lock()
        self._backlog: deque[Callable[[], None]] = deque()
        self._dropped: Counter[str] = Counter()
        self._closed = False
        self._disk = _Disk()
        self._wake = threading.Condition()
        try:
            self._records = Records(path, attachments or {}, self._settings, self._retire)
        except FileExistsError as error:
            raise LogError(
                f"There is a file {path} already; choose another name for the log."
            ) from error
        except OSError as error:
            raise LogError(
                f"Can't write the log {path}: {error.strerror}. Choose another place."
            ) from error
        self._thread = threading.Thread(target=self._tend, name="log", daemon=True)
        self._thread.start()

    def write(self, event: Event) -> bool:
        """Writes an event.

        Returns:
            Whether it is in the file now. Where it isn't, it waits for the disk, was dropped (`lost`
            says so later), or writing has failed: then `failure` says why, nothing more is written,
            and what was written stays.
        """
        often = isinstance(event, Stepped)
        return self._hand_over(lambda: self._write(event), event.topic, often)

    __call__ = write

    def write_raw(self, topic: str, kind: RawKind, time: float, data: bytes) -> bool:
        """Writes a message that is bytes already, such as one of the robot's own.

        Args:
            topic: its topic; not one of an event.
            kind: what the bytes are.
            time: seconds since the epoch.
            data: the message.

        Returns:
            Whether it is in the file, as for `write`.
        """
        if self._settings.privacy.in_bytes(data):
            return False
        write = self._records.write_raw
        return self._hand_over(lambda: write(topic, kind, time, data), topic, True)

    def attach(self, name: str, kind: str, data: bytes, time: float) -> bool:
        """Adds a file, such as the sound of what was said.

        Args:
            name: its name in the log.
            kind: its media type.
            data: its content.
            time: when it was made, in seconds since the epoch.

        Returns:
            Whether it is in the log; also False where sound isn't to be kept.
        """
        if kind.startswith(AUDIO) and not self._settings.privacy.sound:
            return False
        nanoseconds = max(int(time * 1e9), 0)
        return self._hand_over(
            lambda: self._records.journal.attach(name, kind, data, nanoseconds), name, False
        )

    def close(self) -> None:
        """Ends the log and makes the compressed, indexed file of it; the journal stays where that fails."""
        with self._lock:
            if self._closed:
                return
            self._closed = True
        with self._wake:
            self._disk.closing = True
            self._wake.notify()
        self._thread.join()

    def __enter__(self) -> LogWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    # In the callers' threads

    def _hand_over(self, work: Callable[[], None], topic: str, often: bool) -> bool:
        """Does what appends a record now, or queues it where that could take long."""
        since = self._disk.since
        busy = since is not None and time.monotonic() - since > self._settings.slow_s
        if not busy and (
            self._lock.acquire(blocking=False)
            or self._lock.acquire(timeout=self._settings.patience_s)
        ):
            try:
                if not self._backlog:  # Else it would overtake what waits.
                    return not self._closed and self._done(work)
            finally:
                self._lock.release()
        if self._closed or self.failure:
            return False
        room = self._settings.queue // 2 if often else self._settings.queue
        with self._wake:
            if len(self._backlog) < room:
                self._backlog.append(work)
            else:
                self._dropped[topic] += 1
            self._wake.notify()
        return False

    def _done(self, work: Callable[[], None]) -> bool:
        if self.failure:
            return False
        try:
            work()
        except OSError as error:
            self._fail(error)
            with contextlib.suppress(
                OSError
            ):  # Where a few bytes fit still, the file says it itself.
                self._records.journal.metadata(ABOUT, {CUT_OFF: error.strerror or str(error)})
            return False
        return True

    def _write(self, event: Event) -> None:
        self._records.write(event)
        if isinstance(event, FORCED):
            with self._wake:
                self._disk.wanted = True
                self._wake.notify()

    def _retire(self, journal: Journal) -> None:
        with self._wake:
            self._disk.old.append(journal)
            self._wake.notify()

    def _fail(self, error: OSError) -> None:
        self.failure = (
            f"The log {self.path} can't be written any more ({error.strerror}); what happened before"
            " is in it. Make room on the disk."
        )

    # In the log's own thread

    def _tend(self) -> None:
        disk = self._disk
        while True:
            with self._wake:
                while not (disk.wanted or disk.closing or disk.old or self._backlog):
                    self._wake.wait()
            if disk.wanted:
                disk.wanted = False
                self._force()
            self._work_off()
            while disk.old:
                self._end(disk.old.pop(0))
            if disk.closing and not self._backlog:
                self._end(self._records.journal)
                return

    def _force(self) -> None:
        self._disk.since = time.monotonic()
        try:
            self._records.journal.force()
        except OSError as error:
            if not self._closed:
                self._fail(error)
        finally:
            self._disk.since = None

    def _work_off(self) -> None:
        while self._backlog:
            with self._lock:
                self._done(self._backlog[0])
                self._backlog.popleft()
        if self._dropped and not self.failure:
            with self._wake:
                dropped, self._dropped = self._dropped, Counter()
            with self._lock:
                words = ", ".join(f"{n} of {topic}" for topic, n in sorted(dropped.items()))
                self.lost = f"The disk was too slow for a while; missing in the log: {words}."
                missing = Failed(time=self._records.time, text=self.lost, what="log")
                self._done(lambda: self._write(missing))

    def _end(self, journal: Journal) -> None:
        with contextlib.suppress(OSError):
            if not self.failure:
                journal.end()
                journal.force()
        with contextlib.suppress(OSError):
            journal.close()
        if not self.failure:
            self._finalise(journal.path)

    def _finalise(self, path: Path) -> None:
        try:
            finalise(path)
        except (OSError, LogError) as error:
            why = error.strerror if isinstance(error, OSError) else str(error)
            self.failure = f"The log {path} is whole, but couldn't be compressed: {why}."
