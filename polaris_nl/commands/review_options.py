"""The options of `review`. Imports nothing but argparse, as all of them are made at each start."""

from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path


def add_review_options(review: ArgumentParser) -> None:
    """Adds what `review` takes."""
    review.add_argument(
        "log",
        metavar="LOG.mcap",
        type=Path,
        help="a log that a run has written, or a folder of them",
    )
    review.add_argument(
        "--filter", metavar="TEXT", action="append", default=[],
        help="only events with this text, topic=NAME, severity=warning, goal=N or WORD, entity=NAME, "
        "time=FROM..TO in seconds; may be given several times",
    )  # fmt: skip
    what = review.add_mutually_exclusive_group()
    what.add_argument("--events", action="store_true", help="list every event")
    what.add_argument("--ask", metavar="QUESTION", help='ask in words: "why did it halt?"')
    what.add_argument("--timeline", action="store_true", help="draw what was done over time")
    what.add_argument("--step", metavar="N", type=int, help="show event number N whole")
    what.add_argument(
        "--next",
        metavar="N",
        type=int,
        nargs="?",
        const=0,
        help="show the next problem after event N",
    )
    what.add_argument("--chain", metavar="N", type=int, help="show what led to event N")
    what.add_argument(
        "--expected", metavar="N", type=int, help="show what was expected and seen at event N"
    )
    what.add_argument("--score", action="store_true", help="say which objectives the run has met")
    what.add_argument("--diff", metavar="OTHER.mcap", type=Path, help="compare with another run")
    what.add_argument(
        "--durations", action="store_true", help="say how long actions and waits took"
    )
    what.add_argument(
        "--replay", action="store_true", help="carry the run out again from what was perceived then"
    )
    what.add_argument(
        "--export",
        choices=("csv", "jsonl", "json", "markdown"),
        help="print the events, or a report, for other programs",
    )
    what.add_argument("--recover", action="store_true", help="mend a file that was cut off")
    what.add_argument(
        "--redact", metavar="WHAT", action="append",
        help="make a copy without audio, without text (what people said), or without any other word",
    )  # fmt: skip
    review.add_argument("--out", metavar="FILE", type=Path, help="where the copy of --redact goes")
    review.add_argument(
        "--page", metavar="N", type=int, help="only the Nth page of --events, for long logs"
    )
