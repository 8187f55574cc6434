"""Push to talk: the hands-free loop behind the screen, loaded when it is first asked for."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING

from textual.message import Message

from polaris_nl.model.errors import PolarisError
from polaris_nl.session import Session
from polaris_tui.messages import Listened
from polaris_tui.running import Current

if TYPE_CHECKING:
    from polaris_nl.hands_free.listening import Listening
    from polaris_nl.speech.ears import EarMaker
    from polaris_nl.speech.modes import Mode
    from polaris_nl.speech.sources import Source

Tell = Callable[[Message], object]
INSTALL = 'Install it with: pip install "polaris-nl[voice]"'
END_S = 2.0
"""How long leaving waits for the microphone to be let go."""


class Talking:
    """Listens from the first press of its key on: for what is said then, and for "stop" and "pause" always.

    A recording is heard from its beginning at each press, as if it was said just then.

    Args:
        source: where sound comes from; None for this machine's microphone.
        mode: when speech is meant for the robot; see `speech.modes`.
        session: what is talked about.
        turn: is held while a sentence is carried out: the keyboard's have to wait their turn, too.
        tell: is given messages, in threads of its own.
        current: the run that goes on, or None.
    """

    def __init__(
        self,
        source: Source | None,
        mode: Mode,
        session: Session,
        turn: AbstractContextManager[object],
        tell: Tell,
        current: Current,
    ) -> None:
        self._source = source
        self._mode = mode
        self._session = session
        self._turn = turn
        self._tell = tell
        self._current = current
        self._maker: EarMaker | None = None
        self._listening: Listening | None = None
        self._thread: threading.Thread | None = None
        self._called = False
        self._ended = False

    @property
    def at_once(self) -> bool:
        """Whether it is to listen from the start: the user has named a microphone, or how to be called."""
        return (self._source is not None and self._source.live) or self._mode != "talk"

    def key(self) -> None:
        """The key was pressed: opens the microphone, or listens again."""
        self._called = True  # Pressed while the models are loaded, it counts when they are.
        if self._listening is not None:
            self._listening.key()
        if self._thread is None or not self._thread.is_alive():
            self.begin()

    def begin(self) -> None:
        """Opens the microphone; what is said is meant for the robot as the mode has it."""
        self._thread = threading.Thread(target=self._work, name="talking", daemon=True)
        self._thread.start()

    def end(self) -> None:
        """Lets the microphone go."""
        self._ended = True
        if self._listening is not None:
            self._listening.stop()
        if self._thread is not None:
            self._thread.join(END_S)

    def _work(self) -> None:
        self._tell(Listened("opening"))
        try:
            self._listening = listening = self._opened()
            if self._called and listening.source.live:
                listening.key()
            if not self._ended:
                listening.run()
        except PolarisError as error:
            self._tell(Listened("deaf", str(error)))
        except ImportError as error:
            self._tell(
                Listened("deaf", f"Listening needs {error.name}, which is missing. {INSTALL}")
            )
        except Exception as error:
            text = (
                f"Listening went wrong ({type(error).__name__}: {error}). Typing works as before."
            )
            self._tell(Listened("deaf", text))
        else:
            self._tell(Listened("off"))
        finally:
            self._listening, self._called = None, False

    def _opened(self) -> Listening:
        from polaris_nl.commands.transcribe import ears_for
        from polaris_nl.hands_free.listening import Listening
        from polaris_nl.speech.ears import EarMaker
        from polaris_nl.speech.modes import Attention
        from polaris_nl.speech.sources import source_for
        from polaris_nl.speech.wake import MicroWakeWord
        from polaris_tui.heard import Heard, Shown

        source = self._source or source_for(None)
        self._maker = self._maker or EarMaker()
        ears = ears_for(self._session, self._maker)
        conversation = Heard(self._session, self._turn, self._tell, self._current)
        mode = self._mode if source.live else "always"
        wake_word = MicroWakeWord() if mode == "wake" else None
        return Listening(
            source, ears, conversation, Shown(self._tell), Attention(mode), None, wake_word
        )
