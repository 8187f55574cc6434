"""How things look: the terminal's own colours, so that light and dark screens both stay readable."""

from __future__ import annotations

from rich.style import Style

from polaris_nl.render.layout import Tone
from polaris_tui.layout import WIDE

STYLES: dict[Tone, Style] = {
    "": Style(),
    "strong": Style(bold=True),
    "good": Style(color="green"),
    "bad": Style(color="red", bold=True),
    "faint": Style(dim=True),
}
CURSOR = Style(reverse=True)
MARK = Style(bold=True)

THEME = "ansi-dark"
"""Of the themes that use the terminal's colours; nothing here depends on dark or light."""

BREAKPOINTS = [(0, "-narrow"), (WIDE, "-wide")]

CSS = """
#title, #status, #line { height: 1; }
#line { layout: horizontal; }
#sign { width: 2; }
#prompt, #prompt:focus { width: 1fr; border: none; background: ansi_default; background-tint: ansi_default 0%; }
#prompt > .input--cursor { background: ansi_default; color: ansi_default; text-style: reverse; }
#body { height: 1fr; layout: vertical; }
#left { height: 1fr; }
#main { height: 1fr; }
.-wide #body { layout: horizontal; }
.-wide #left { width: 3fr; }
.-wide #answers { width: 2fr; }
#body.-answers #left { display: none; }
#body.-answers #answers { width: 1fr; }
"""
