"""The whole screen: title, program, problems, answers, input line and status."""

from __future__ import annotations

from textual.app import ComposeResult
from textual.containers import Container
from textual.widgets import Static

from polaris_nl.render.glyphs import Glyphs
from polaris_tui.layout import WIDE, heights
from polaris_tui.pane import Pane
from polaris_tui.prompt import Prompt
from polaris_tui.transcript import Transcript
from polaris_tui.views import (
    Scene,
    View,
    heading,
    status_row,
    title_row,
    trouble_heading,
    trouble_rows,
    view_rows,
)

PLACEHOLDER = "Say what the robot should achieve, and press Enter."


class Board(Container):
    """All panes.

    Args:
        glyphs: the signs to draw with.
    """

    def __init__(self, glyphs: Glyphs) -> None:
        super().__init__(id="board")
        self.prompt = Prompt(PLACEHOLDER, id="prompt")
        self.main = Pane(glyphs, id="main")
        self.answers = Pane(glyphs, id="answers", follows=True)
        self._trouble = Pane(glyphs, id="trouble")
        self._title = Pane(glyphs, id="title", focusable=False)
        self._status = Pane(glyphs, id="status", focusable=False)
        self._body = Container(
            Container(self.main, self._trouble, id="left"), self.answers, id="body"
        )

    def compose(self) -> ComposeResult:
        """The panes, from top to bottom."""
        yield self._title
        yield self._body
        with Container(id="line"):
            yield Static("> ", id="sign", markup=False)
            yield self.prompt
        yield self._status

    def show(self, scene: Scene, view: View, transcript: Transcript) -> None:
        """Draws all panes; they repaint only what has changed."""
        troubles = len(trouble_rows(scene, self.main.text_width)) if view != "help" else 0
        self._share(view, troubles)
        self._title.show(lambda width, _: [title_row(scene, width)])
        self.main.show(
            lambda width, height: view_rows(view, scene, width, height),
            heading(view, scene),
            scene.progress.at if view == "plan" else None,
        )
        self._trouble.show(lambda width, _: trouble_rows(scene, width), trouble_heading(scene))
        self.answers.show(lambda width, _: transcript.rows(width), "Answers")
        self._status.show(lambda width, _: [status_row(scene, width)])

    def _share(self, view: View, troubles: int) -> None:
        """Shares the rows of the screen out; CSS puts the panes beside or below each other."""
        width, height = self.app.size
        share = heights(height, troubles)
        filled = view == "answers" or width >= WIDE
        self._body.set_class(view == "answers", "-answers")
        self._trouble.display = troubles > 0
        self._trouble.styles.height = share.trouble
        self.answers.styles.height = "1fr" if filled else share.answers
