"""How things look: tones to styles for each theme. Colour is never the only sign of anything."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rich.style import Style
from textual.theme import Theme

from polaris_nl.render.layout import Tone
from polaris_tui.layout import WIDE


@dataclass(frozen=True)
class Look:
    """A theme of the application.

    Attributes:
        name: as settings have it.
        does: what it is for.
        theme: the name of Textual's theme for it.
        tones: the style of each tone.
    """

    name: str
    does: str
    theme: str
    tones: Mapping[Tone, Style]

    def style(self, tone: Tone) -> Style:
        """The style of a tone."""
        return self.tones[tone]


def _tones(good: str, bad: str, faint: Style | None = None) -> Mapping[Tone, Style]:
    return {
        "": Style(),
        "strong": Style(bold=True),
        "good": Style(color=good),
        "bad": Style(color=bad, bold=True),
        "faint": faint or Style(dim=True),
    }


LOOKS: Mapping[str, Look] = {
    look.name: look
    for look in (
        Look(
            "terminal",
            "the terminal's own colours, light or dark",
            "ansi-dark",
            _tones("green", "red"),
        ),
        Look("dark", "light on dark", "polaris-dark", _tones("#7bd88f", "#ff8080")),
        Look(
            "light",
            "dark on light",
            "polaris-light",
            _tones("#006b2d", "#b00020", Style(color="#5a5a5a")),
        ),
        Look(
            "contrast",
            "white on black, nothing dimmed",
            "polaris-contrast",
            _tones("#ffffff", "#ffff00", Style(italic=True)),
        ),
        Look(
            "colour-blind",
            "blue and orange instead of green and red",
            "polaris-dark",
            _tones("#56b4e9", "#e69f00"),
        ),
    )
}
"""All themes. Blue and orange are of the palette by Okabe and Ito, which most people can tell apart."""

CURSOR = Style(reverse=True)
MARK = Style(bold=True)

BREAKPOINTS = [(0, "-narrow"), (WIDE, "-wide")]


def themes() -> list[Theme]:
    """Textual's themes for those that don't use the terminal's colours."""
    return [
        Theme(
            name=name,
            primary=foreground,
            foreground=foreground,
            background=background,
            surface=background,
            dark=dark,
        )
        for name, foreground, background, dark in (
            ("polaris-dark", "#d8dee4", "#10151a", True),
            ("polaris-light", "#16191d", "#ffffff", False),
            ("polaris-contrast", "#ffffff", "#000000", True),
        )
    ]


CSS = """
Screen { background: $background; color: $foreground; }
#title, #status, #line { height: 1; }
#line { layout: horizontal; }
#sign { width: auto; }
#prompt, #prompt:focus {
    width: 1fr; border: none; background: $background; color: $foreground;
    background-tint: $background 0%;
}
#prompt > .input--cursor { background: $background; color: $foreground; text-style: reverse; }
#body { height: 1fr; layout: vertical; }
#left { height: 1fr; }
#main, #side { height: 1fr; }
.-wide #body { layout: horizontal; }
.-wide #left { width: 3fr; }
.-wide #answers, .-wide #menu { width: 2fr; }
#body.-answers #left { display: none; }
#body.-answers #answers { width: 1fr; }
"""
