"""Plans the newest revision of a program in a thread of its own; newer revisions cancel older work.

Plans stream: parts of one while it takes long, then all of it, then a better one where there is any.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.errors import PolarisError

if TYPE_CHECKING:
    from polaris_nl.planning.compile import Draft
    from polaris_nl.planning.result import BranchingPlan

Compile = Callable[[Automaton, Callable[[], bool]], "Iterator[Draft]"]
"""Plans an automaton; the second argument says when the work has become stale."""


@dataclass(frozen=True, slots=True)
class Published:
    """News about the plan of a revision.

    Attributes:
        plan: None where planning failed.
        failure: what failed, in a sentence, or "".
        whole: all of the program has been tried; else more is about to come.
    """

    revision: int
    plan: BranchingPlan | None
    failure: str = ""
    whole: bool = True


CLOSE_S = 5.0
"""How long closing waits for what can't be broken off, in seconds."""
Publish = Callable[[Published], None]


class Replanner:
    """One planning thread.

    Args:
        compile: makes the drafts of a plan; called in the thread, one call at a time.
        publish: is given each draft; called in the thread, never for a revision that has become
            stale.
    """

    def __init__(self, compile: Compile, publish: Publish) -> None:
        self._compile = compile
        self._publish = publish
        self._changed = threading.Condition()
        self._wanted: tuple[int, Automaton] | None = None
        self._newest = -1
        self._closed = False
        self._thread: threading.Thread | None = None

    def request(self, revision: int, automaton: Automaton) -> None:
        """Asks for the plan of a revision; whatever is being planned for an older one is stale now."""
        with self._changed:
            if self._closed or revision <= self._newest:
                return
            self._newest = revision
            self._wanted = (revision, automaton)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name="planning", daemon=True)
                self._thread.start()
            self._changed.notify()

    def close(self) -> None:
        """Cancels what is being planned and ends the thread, or leaves it where it doesn't end soon."""
        with self._changed:
            self._closed = True
            self._changed.notify()
        if self._thread is not None:
            self._thread.join(CLOSE_S)

    def _work(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or self._wanted is not None)
                if self._closed or self._wanted is None:
                    return
                revision, automaton = self._wanted
                self._wanted = None
            self._plan(revision, automaton)

    def _stale(self, revision: int) -> bool:
        return self._closed or revision != self._newest

    def _plan(self, revision: int, automaton: Automaton) -> None:
        failure = ""
        try:
            for draft in self._compile(automaton, lambda: self._stale(revision)):
                if self._stale(revision):
                    return
                self._publish(Published(revision, draft.plan, whole=draft.whole))
        except PolarisError as error:
            failure = str(error)
        except Exception as error:
            # A fault in planning must neither end the session nor leave its faces waiting for ever.
            kind = type(error).__name__
            failure = f"Planning failed ({kind}: {error}); undo, or say it another way."
        if failure and not self._stale(revision):
            self._publish(Published(revision, None, failure))
