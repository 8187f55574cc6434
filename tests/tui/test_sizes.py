"""The screen at three sizes, as a person has read it and found good."""

from __future__ import annotations

import pytest

from tests.golden.files import check_golden
from tests.tui.conftest import LUNCH, Play, Stage

SIZES = ((60, 20), (80, 24), (160, 45))


@pytest.mark.parametrize("size", SIZES, ids=lambda s: f"{s[0]}x{s[1]}")
def test_screens(play: Play, size: tuple[int, int]) -> None:
    async def script(stage: Stage) -> None:
        pictures = [("the start", stage.screen())]
        await stage.say(LUNCH)
        pictures.append(("a program", stage.screen()))
        await stage.say("hold the cup and the plate")
        pictures.append(("a problem", stage.screen()))
        await stage.press("f1")
        pictures.append(("help", stage.screen()))
        await stage.press("f1", "f7")
        await stage.answered()
        await stage.say("run it")
        await stage.press("f3")
        pictures.append(("the map", stage.screen()))
        for _, picture in pictures:
            lines = picture.split("\n")
            assert len(lines) == size[1]
            assert max(map(len, lines)) <= size[0]
        text = "\n".join(f"== {title}\n{picture}" for title, picture in pictures)
        check_golden(f"tui/{size[0]}x{size[1]}.txt", text)

    play(script, size=size)


def test_the_screen_follows_its_terminal(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say(LUNCH)
        for width, height in ((160, 45), (40, 10), (20, 5), (1, 1), (80, 24)):
            await stage.pilot.resize_terminal(width, height)
            await stage.pilot.pause()
        await stage.see("ok, 14 actions", "takes 14 actions.")

    play(script)


def test_ascii(play: Play, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POLARIS_NL_ASCII", "1")

    async def script(stage: Stage) -> None:
        await stage.say(LUNCH)
        await stage.say("hold the cup and the plate")
        await stage.see("! partial")
        for key in ("f3", "f1", "f4"):
            await stage.press(key)
            assert stage.screen().isascii()

    play(script)
