"""`demo`: the caregiving scenario from a recording to reviewed logs, without robot, microphone or questions."""

from __future__ import annotations

import sys
import tempfile
import time
from argparse import Namespace
from pathlib import Path

from polaris_nl.automaton.program import write_program
from polaris_nl.commands import plan as plan_command
from polaris_nl.commands.common import print_json, print_rows, print_text, shown_path, width
from polaris_nl.commands.review_text import run_lines
from polaris_nl.commands.run import shower
from polaris_nl.commands.transcribe import ears_for, hear_file
from polaris_nl.logs.paths import log_folder, new_log_path
from polaris_nl.logs.reader import read_log
from polaris_nl.model.data import data_folder
from polaris_nl.model.errors import LogError, RunError
from polaris_nl.model.world_file import load_world
from polaris_nl.render.glyphs import glyphs_for
from polaris_nl.render.program import program_rows
from polaris_nl.runs import RunOrder, RunReport, run_simulated
from polaris_nl.session import Session
from polaris_nl.speech.audio import file_blocks
from polaris_nl.speech.ears import EarMaker

WORLD = "care-home"
RECORDING = "caregiving/recordings/lunch.flac"
WAYS = ("acknowledge", "dismiss")


def run(arguments: Namespace) -> int:
    """Hears, understands, plans, runs twice and reviews; 1 where any of it went wrong."""
    return _Demo(arguments.json, arguments.folder).run()


class _Demo:
    def __init__(self, as_json: bool, folder: Path | None) -> None:
        self._json = as_json
        self._folder = _writable(folder or log_folder())
        self._started = time.perf_counter()
        self._steps = 0

    def run(self) -> int:
        self._step("Loading the care home, its language and the speech model")
        maker = EarMaker()
        with Session(load_world(WORLD)) as session:
            session.warm_up()
            said = self._hear(session, maker)
            plan = session.wait().plan
            if said != "applied" or plan is None or plan.status != "ok":
                raise RunError(
                    "The demo's recording was not understood; fetch the model again: polaris-nl models --force"
                )
            program = self._folder / "demo.polaris.json"
            write_program(session.program, program)
            self._plan(session)
            reports = [self._run_with(way, session) for way in WAYS]
        for report in reports:
            self._review(report)
        seconds = time.perf_counter() - self._started
        if self._json:
            print_json(
                {
                    "program": str(program),
                    "runs": [
                        {
                            "people": way,
                            "outcome": r.result.outcome,
                            "checkpoints": r.result.checkpoints,
                            "log": str(r.log),
                        }
                        for way, r in zip(WAYS, reports, strict=True)
                    ],
                    "seconds": round(seconds, 1),
                }
            )
        else:
            print()
            print_text(f"That was all, in {seconds:.0f} s. Go on with your own words:")
            print(f"  polaris-nl dialogue --world {WORLD}")
            print(f"  polaris-nl tui {shown_path(program)}")
        return 0 if all(r.result.outcome == "done" for r in reports) else 1

    def _step(self, title: str) -> None:
        self._steps += 1
        stream = sys.stderr if self._json else sys.stdout
        lead = "" if self._steps == 1 else "\n"
        dash = glyphs_for(stream).dash
        print(f"{lead}{dash * 2} {self._steps}. {title}", file=stream, flush=True)

    def _hear(self, session: Session, maker: EarMaker) -> str:
        recording = data_folder("domains") / RECORDING
        seconds = sum(map(len, file_blocks(recording))) / 32_000
        self._step(f"Hearing {recording.name}, {seconds:.0f} s of speech")
        said, answer = hear_file(recording, ears_for(session, maker), session)
        if not self._json:
            print_text(f'"{said.text}"')
            self._step("What was understood")
            print_text(answer.say)
            snapshot = session.wait()
            print_rows(
                program_rows(
                    snapshot.automaton, snapshot.plan, session.wording, glyphs_for(), width()
                )
            )
        return answer.interpretation.outcome

    def _plan(self, session: Session) -> None:
        snapshot = session.snapshot
        self._step("The branching plan, step by step and in words")
        if snapshot.plan is not None and not self._json:
            plan_command.show(snapshot.automaton, snapshot.plan, session.wording)

    def _run_with(self, way: str, session: Session) -> RunReport:
        self._step(f"A run in the simulated world: the resident will {way}")
        snapshot = session.snapshot
        assert snapshot.plan is not None
        order = RunOrder(
            snapshot.automaton, snapshot.plan, session.planner, (way,), before=session.past,
            log=new_log_path(f"demo-{way}", self._folder),
        )  # fmt: skip
        return run_simulated(order, confirmed=True, show=shower(self._json))

    def _review(self, report: RunReport) -> None:
        self._step(f"The log {report.log.name}, read back")
        if not self._json:
            log = read_log(report.log)
            for line in run_lines(log):
                print_text(line)
            print(f"More: polaris-nl review {shown_path(report.log)}")


def _writable(folder: Path) -> Path:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder):
            return folder
    except OSError as error:
        raise LogError(
            f"Can't write to {folder}: {error.strerror}. Name another place with --folder DIR."
        ) from error
