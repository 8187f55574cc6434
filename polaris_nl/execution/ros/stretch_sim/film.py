"""Drawing beside the simulation: a video of all that happens, or a picture of how it ended.

A thread draws, so that the simulation doesn't wait; a moment that comes while it still draws the one before is
left out. Frames carry their own times, and the file can be played up to the last one even if the process dies.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any, Protocol

import av
from PIL import Image

from polaris_nl.execution.ros.stretch_sim.snapshot import Snapshot
from polaris_nl.model.errors import RunError

CLOSE_S = 30.0
_MILLISECONDS = Fraction(1, 1000)


class Draws(Protocol):
    """What turns moments into pictures (a `Painter`)."""

    def draw(self, moment: Snapshot) -> Any:
        """A picture, as an array of height x width x 3 bytes."""
        ...

    def close(self) -> None:
        """Frees what it holds."""
        ...


class Film:
    """Draws into a file.

    Args:
        path: a `.mp4` or a `.png`.
        make_painter: makes what draws; it is called in the drawing thread, as OpenGL wants it.

    Raises:
        RunError: the file can't be made.
    """

    def __init__(self, path: Path, make_painter: Callable[[], Draws]) -> None:
        self._path = path
        self._make_painter = make_painter
        self._moments: queue.Queue[tuple[float, Snapshot] | None] = queue.Queue(maxsize=1)
        self._last: Snapshot | None = None
        self._problem = ""
        self.frames = 0
        if not path.parent.is_dir():
            raise RunError(f"There is no folder {path.parent} to draw into; make it first.")
        self._begun = threading.Event()
        self._thread = threading.Thread(target=self._work, name="film", daemon=True)
        self._thread.start()

    def begin(self) -> None:
        """Waits until it can draw (or has found that it can't)."""
        self._begun.wait(CLOSE_S)

    def show(self, seconds: float, moment: Snapshot) -> None:
        """Draws a moment, unless it is still busy with the one before.

        Args:
            seconds: when, from the start of the film.
            moment: what.
        """
        self._last = moment
        if self._path.suffix == ".png":
            return
        try:
            self._moments.put_nowait((seconds, moment))
        except queue.Full:
            return

    def close(self, seconds: float) -> str:
        """Ends the film with the last moment; what went wrong, or ""."""
        if self._last is not None and self._thread.is_alive():
            self._hand_over((seconds, self._last))
        self._hand_over(None)
        self._thread.join(CLOSE_S)
        return self._problem

    def _hand_over(self, item: tuple[float, Snapshot] | None) -> None:
        while self._thread.is_alive():
            try:
                self._moments.put(item, timeout=0.2)
                return
            except queue.Full:
                continue

    def _work(self) -> None:
        try:
            painter = self._make_painter()
            self._begun.set()
            try:
                self._draw(painter)
            finally:
                painter.close()
        except Exception as error:  # Whatever fails in drawing must not end the simulation.
            self._problem = f"The picture {self._path} couldn't be drawn ({error})."
        finally:
            self._begun.set()

    def _draw(self, painter: Draws) -> None:
        if self._path.suffix == ".png":
            while (item := self._moments.get()) is not None:
                Image.fromarray(painter.draw(item[1])).save(self._path)
                self.frames += 1
            return
        # In pieces, so that what was written can be played whatever happens.
        options = {"movflags": "frag_keyframe+empty_moov+default_base_moof"}
        with av.open(str(self._path), "w", options=options) as container:
            stream: Any = None
            before = -1
            while (item := self._moments.get()) is not None:
                picture = painter.draw(item[1])
                if stream is None:
                    stream = _stream(container, picture)
                before = max(before + 1, round(item[0] * 1000))
                frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
                frame.pts, frame.time_base = before, _MILLISECONDS
                container.mux(stream.encode(frame))
                self.frames += 1
            if stream is not None:
                container.mux(stream.encode(None))


def _stream(container: Any, picture: Any) -> Any:
    height, width = picture.shape[:2]
    stream = container.add_stream("h264", rate=30)
    stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
    stream.time_base = stream.codec_context.time_base = _MILLISECONDS
    stream.codec_context.gop_size = 20
    stream.options = {"preset": "veryfast", "crf": "24"}
    return stream
