"""The whole screen: title, program, problems, answers, menu, input line and status."""

from __future__ import annotations

from typing import Protocol

from textual.app import ComposeResult
from textual.containers import Container
from textual.widgets import Static

from polaris_nl.render.glyphs import Glyphs
from polaris_tui import pane, prompt
from polaris_tui.choosing import Choosing
from polaris_tui.layout import WIDE, heights
from polaris_tui.menus import Ask
from polaris_tui.pane import Pane
from polaris_tui.prompt import Prompt
from polaris_tui.reasons import View
from polaris_tui.reviewing import detail_heading, detail_rows
from polaris_tui.scene import Scene
from polaris_tui.styles import Look
from polaris_tui.transcript import Transcript
from polaris_tui.views import (
    heading,
    outline_rows,
    status_row,
    title_row,
    trouble_heading,
    trouble_rows,
    view_rows,
)

PLACEHOLDER = "Say what the robot should achieve, and press Enter."
LARGE: tuple[View, ...] = ("plan", "run", "review")


class Owner(pane.Owner, prompt.Owner, Protocol):
    """The application, which is told at once of what is typed."""


class Board(Container):
    """All panes.

    Args:
        owner: is told of keys.
        glyphs: the signs to draw with.
        look: the colours.
    """

    def __init__(self, owner: Owner, glyphs: Glyphs, look: Look) -> None:
        super().__init__(id="board")
        self._glyphs = glyphs
        self.prompt = Prompt(owner, PLACEHOLDER, id="prompt")
        self.main = Pane(owner, glyphs, look, id="main")
        self.side = Pane(owner, glyphs, look, id="side")
        self.answers = Pane(owner, glyphs, look, id="answers", follows=True)
        self.trouble = Pane(owner, glyphs, look, id="trouble")
        self._menu = Pane(owner, glyphs, look, id="menu", focusable=False)
        self._title = Pane(owner, glyphs, look, id="title", focusable=False)
        self._status = Pane(owner, glyphs, look, id="status", focusable=False)
        self._sign = Static("> ", id="sign", markup=False)
        self._signed = "> "
        self._left = Container(self.main, self.side, self.trouble, id="left")
        self._body = Container(self._left, self.answers, self._menu, id="body")

    def compose(self) -> ComposeResult:
        """The panes, from top to bottom."""
        yield self._title
        yield self._body
        with Container(id="line"):
            yield self._sign
            yield self.prompt
        yield self._status

    def dress(self, look: Look) -> None:
        """Takes other colours."""
        for part in self.query(Pane):
            part.dress(look)

    def show(self, scene: Scene, view: View, transcript: Transcript, menu: Choosing) -> None:
        """Draws all panes; they repaint only what has changed."""
        troubles = 0
        if view in ("program", "map") and menu.last is None:
            troubles = len(trouble_rows(scene, self.main.text_width))
        self._share(view, scene, troubles, menu)
        self._title.show(lambda width, _: [title_row(scene, width)])
        self.main.show(
            lambda width, height: view_rows(view, scene, width, height),
            heading(view, scene),
            scene.progress.at if view == "program" else None,
        )
        if self.side.display and view == "review":
            self.side.show(lambda width, _: detail_rows(scene, width), detail_heading(scene))
        elif self.side.display:
            self.side.show(
                lambda width, _: outline_rows(scene, width, True), "Plan", scene.progress.at
            )
        if self.trouble.display:
            self.trouble.show(lambda width, _: trouble_rows(scene, width), trouble_heading(scene))
        self.answers.show(lambda width, _: transcript.rows(width), "Answers")
        if menu.last is not None:
            self._menu.show(lambda width, _: menu.rows(width, self._glyphs), menu.heading())
        place = self._place(view, scene)
        if menu.last is not None:
            place = "ask" if isinstance(menu.last, Ask) else "menu"
        self._status.show(lambda width, _: [status_row(scene, width, place)])
        self._sign_with(
            "> " if menu.last is None else "text: " if isinstance(menu.last, Ask) else "filter: "
        )

    def _place(self, view: View, scene: Scene) -> str:
        """What the status line's keys are about."""
        if view in ("plan", "review") and self.main.has_focus:
            return view
        if self.main.has_focus or self.trouble.has_focus:
            return "program"
        return "run" if scene.running else "prompt"

    def _sign_with(self, sign: str) -> None:
        if sign != self._signed:
            self._signed = sign
            self._sign.update(sign)

    def _share(self, view: View, scene: Scene, troubles: int, menu: Choosing) -> None:
        """Shares the rows of the screen out; CSS puts the panes beside or below each other."""
        width, height = self.app.size
        share = heights(height, troubles, view in LARGE)
        filled = view == "answers" or width >= WIDE
        self._body.set_class(view == "answers" and menu.last is None, "-answers")
        self.trouble.display = troubles > 0
        self.trouble.styles.height = share.trouble
        drawn = len(view_rows(view, scene, self.main.text_width, 1)) if scene.tree else 0
        self.main.styles.height = (
            min(drawn + 2, height // 2) if drawn and view == "program" else "1fr"
        )
        self.side.display = view == "review" or (view == "program" and scene.tree)
        self.answers.display = menu.last is None and not (view == "review" and width < WIDE)
        self.answers.styles.height = "1fr" if filled else share.answers
        self._menu.display = menu.last is not None
        self._menu.styles.height = "1fr" if width >= WIDE else share.menu
