"""When speech is meant for the robot: push-to-talk, wake word, always, and asleep. A pure state machine."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal as OneOf

Mode = OneOf["talk", "wake", "always"]
"""`talk`: after a key; `wake`: after the wake word; `always`: whatever is said."""
State = OneOf["asleep", "waiting", "listening", "speaking"]
Happening = OneOf["key", "wake-word", "said", "sleep", "wake", "speaks", "silent"]
"""What can happen: the key or the wake word, an utterance that was taken, "go to sleep" and "wake up", and the
program's own voice starting and ending."""
Cue = OneOf["", "listening", "waiting", "asleep"]
"""The chime that tells of a change."""

WINDOW_S = 8.0
"""How long after the key, the wake word or an answer speech is still meant for the robot."""


@dataclass(frozen=True, slots=True)
class Attention:
    """Whether the robot listens now.

    Attributes:
        mode: how attention is called.
        asleep: only "stop", "pause" and waking are heard.
        until: the time until which it listens, where attention has to be called.
        speaking: the program itself speaks.
        half_duplex: nothing but "stop" and "pause" is heard meanwhile, since it might hear itself; with a
            headset it needn't be.
    """

    mode: Mode = "always"
    asleep: bool = False
    until: float = float("-inf")
    speaking: bool = False
    half_duplex: bool = True

    def state(self, now: float) -> State:
        """What is shown."""
        if self.asleep:
            return "asleep"
        if self.speaking and self.half_duplex:
            return "speaking"
        if self.mode == "always" or now < self.until:
            return "listening"
        return "waiting"

    def hears(self, now: float) -> bool:
        """Whether what is said now is meant for the robot."""
        return self.state(now) == "listening"

    def after(self, happening: Happening, now: float) -> Attention:
        """Attention after something happened."""
        match happening:
            case "sleep":
                return replace(self, asleep=True, until=float("-inf"))
            case "key" | "wake-word" | "wake":
                return replace(self, asleep=False, until=now + WINDOW_S)
            case "speaks":
                return replace(self, speaking=True)
            case "silent":
                # The window for more begins when the answer has been heard.
                open_ = self.until > float("-inf") and not self.asleep
                return replace(self, speaking=False, until=now + WINDOW_S if open_ else self.until)
        open_ = self.mode != "always" and not self.asleep
        return replace(self, until=now + WINDOW_S if open_ else self.until)

    def at(self, now: float) -> Attention:
        """Attention at a later time: a window that has passed is forgotten."""
        if self.until > float("-inf") and now >= self.until and not self.speaking:
            return replace(self, until=float("-inf"))
        return self


def cue(before: State, after: State) -> Cue:
    """The chime for a change of state; an answer needs none, it is heard itself."""
    if before == after or "speaking" in (before, after):
        return ""
    return after if after != "speaking" else ""
