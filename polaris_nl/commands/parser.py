"""The command line: sub-commands, options and an example for each. Imports little but argparse."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import NoReturn

from polaris_nl import __version__
from polaris_nl.commands.review_options import add_review_options


class _Parser(argparse.ArgumentParser):
    """Complains in one sentence."""

    def error(self, message: str) -> NoReturn:
        text = " ".join(message.split())
        print(f"polaris-nl: {text}. See: {self.prog} --help", file=sys.stderr)
        raise SystemExit(2)


def make_parser() -> argparse.ArgumentParser:
    """The parser of everything; `module` of what it returns names the module to run."""
    parser = _Parser(
        prog="polaris-nl",
        description="Say what a service robot should achieve; see at once what it will do, and why.",
        epilog="Start with:  polaris-nl demo\nor:          polaris-nl dialogue --world care-home",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"polaris-nl {__version__}")
    commands = parser.add_subparsers(
        dest="command", metavar="COMMAND", required=True, parser_class=_Parser
    )
    adder = _Adder(commands)
    _authoring(adder)
    _planning(adder)
    _speaking(adder)
    _looking(adder)
    _simulating(adder)
    return parser


class _Adder:
    def __init__(self, commands: argparse._SubParsersAction[_Parser]) -> None:
        self._commands = commands

    def add(self, name: str, summary: str, example: str, module: str = "") -> _Parser:
        parser = self._commands.add_parser(
            name,
            help=summary,
            description=f"{summary[0].upper()}{summary[1:]}.",
            epilog=f"example:\n  {example}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        parser.set_defaults(module=module or name.replace("-", "_"))
        parser.add_argument("--json", action="store_true", help="print JSON, for other programs")
        return parser


def _world(parser: _Parser, required: bool = False) -> None:
    parser.add_argument(
        "--world", metavar="W", required=required,
        help="a shipped world (see: worlds), a world file, or a PDDL problem",
    )  # fmt: skip


def _program_option(parser: _Parser) -> None:
    parser.add_argument(
        "--program",
        metavar="F",
        type=Path,
        help="the program file to change; made if it isn't there",
    )


def _program(parser: _Parser) -> None:
    parser.add_argument("program", metavar="F", type=Path, help="a program file")
    _world(parser)


def _session_log(parser: _Parser) -> None:
    parser.add_argument(
        "--log", metavar="OUT.mcap", type=Path, help="keep what is said and changed in a log"
    )
    _leave_out(parser)


def _leave_out(parser: _Parser) -> None:
    parser.add_argument(
        "--leave-out", metavar="WHAT", action="append", default=[],
        help="keep audio, text (what people said), or any other word out of the log",
    )  # fmt: skip


def _recogniser(parser: _Parser) -> None:
    parser.add_argument(
        "--recogniser", choices=("vosk", "whisper"), default="vosk",
        help="Vosk with the world's phrases (default), or Whisper tiny, which is slower",
    )  # fmt: skip
    parser.add_argument(
        "--second", action=argparse.BooleanOptionalAction,
        help="hear again with Whisper what Vosk isn't sure of (default: if it is installed)",
    )  # fmt: skip


def _authoring(adder: _Adder) -> None:
    say = adder.add(
        "say",
        "understand one utterance and change the program by it",
        'polaris-nl say --world care-home --program lunch.polaris.json "tell the resident that lunch is ready"',
    )
    say.add_argument(
        "utterance", help='what to say, in quotes; "-" reads it from the standard input'
    )
    say.add_argument(
        "--explain", action="store_true", help="show the readings, and why the first was taken"
    )
    _program_option(say)
    _world(say)
    _session_log(say)
    dialogue = adder.add(
        "dialogue",
        "answer one utterance a line, from the keyboard or a pipe",
        "polaris-nl dialogue --world dinner-party --program tidy.polaris.json",
    )
    _program_option(dialogue)
    _world(dialogue)
    _session_log(dialogue)
    tui = adder.add(
        "tui",
        "edit a program on the whole screen",
        "polaris-nl tui lunch.polaris.json --world care-home\n"
        "  polaris-nl tui lunch.polaris.json --robot stretch-sim",
    )
    tui.add_argument(
        "program",
        metavar="F",
        type=Path,
        nargs="?",
        help="a program file, made if it isn't there; or the log of a run (.mcap)",
    )
    tui.add_argument(
        "--plain", action="store_true", help="line by line, for screen readers and slow lines"
    )
    _world(tui)
    _robot(tui)
    _microphone(tui)
    tui.add_argument(
        "--mode", choices=("talk", "always", "wake"), default="talk",
        help="listen after ctrl+space (default), always, or after the words \"hey jarvis\"",
    )  # fmt: skip


def _planning(adder: _Adder) -> None:
    plan = adder.add(
        "plan",
        "plan a program and explain the plan",
        "polaris-nl plan lunch.polaris.json\n"
        "  polaris-nl plan lunch.polaris.json --full --branch home\n"
        "  polaris-nl plan lunch.polaris.json --state 7",
    )
    _program(plan)
    form = plan.add_mutually_exclusive_group()
    form.add_argument("--short", action="store_true", help="one line a branch")
    form.add_argument(
        "--full", action="store_true", help="every action with what it is for and what it changes"
    )
    form.add_argument(
        "--state", metavar="N", type=int, help="what is so after action N; 0 is the start"
    )
    plan.add_argument(
        "--branch", metavar="X", help="only the branch over a checkpoint, by its name or id"
    )
    why = adder.add(
        "why",
        "say why an action is there, or why a goal can't be reached",
        "polaris-nl why lunch.polaris.json --action 3\n"
        '  polaris-nl why lunch.polaris.json --not "the cup is on the desk"',
    )
    _program(why)
    which = why.add_mutually_exclusive_group()
    which.add_argument("--checkpoint", metavar="X", help="a checkpoint's name or id")
    which.add_argument(
        "--action", metavar="N", type=int, help="an action's number, as `plan` shows it"
    )
    which.add_argument("--not", metavar="GOAL", dest="why_not", help="a goal in words, or as PDDL")
    score = adder.add(
        "score",
        "count what a program achieves in its scenario, or what a logged run achieved",
        "polaris-nl score lunch.polaris.json\n  polaris-nl score lunch.mcap",
    )
    score.add_argument(
        "program", metavar="F", type=Path, help="a program file, or the log of a run (.mcap)"
    )
    _world(score)
    run = adder.add(
        "run",
        "carry a program out",
        "polaris-nl run lunch.polaris.json --people dismiss --log lunch.mcap",
    )
    _program(run)
    _robot(run)
    run.add_argument(
        "--yes",
        action="store_true",
        help="the clear yes without which no robot moves; else it is asked for",
    )
    run.add_argument("--log", metavar="OUT.mcap", type=Path, help="where to write the log")
    _leave_out(run)
    run.add_argument(
        "--said", metavar="LOG.mcap", type=Path,
        help="let the log begin with what was said in this one, of say, dialogue or listen",
    )  # fmt: skip
    run.add_argument(
        "--halt-without-log", action="store_true",
        help="halt where the log can't be written any more, as on a full disk; else the run goes on",
    )  # fmt: skip
    run.add_argument(
        "--resume", metavar="LOG.mcap", type=Path,
        help="go on where the run in this log was interrupted; nothing that is done is done again",
    )  # fmt: skip
    run.add_argument(
        "--people", metavar="ACTION", action="append",
        help="what simulated people prefer to do, by the names in the world file; none: they do nothing",
    )  # fmt: skip
    run.add_argument(
        "--live", action="store_true",
        help="in real time; type stop, pause, resume, or what happened (the resident acknowledges)",
    )  # fmt: skip


def _robot(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--robot", metavar="NAME", default="world",
        help="world: the simulated world (default); stretch-sim: the simulated Stretch; stretch, stretch-3, "
        "stretch-re2 or a profile file: a Stretch",
    )  # fmt: skip


def _microphone(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--mic", metavar="NAME|FILE|tcp://HOST:PORT",
        help="a microphone's name or number, a recording, a named pipe, or a Wyoming microphone",
    )  # fmt: skip
    parser.add_argument(
        "--allow-remote", action="store_true",
        help="let a microphone be on another machine without a tunnel",
    )  # fmt: skip


def _speaking(adder: _Adder) -> None:
    transcribe = adder.add(
        "transcribe",
        "turn recordings into words and what they mean",
        "polaris-nl transcribe --world care-home order.wav",
    )
    transcribe.add_argument(
        "files",
        metavar="FILE",
        nargs="+",
        type=Path,
        help="a WAV or FLAC recording, or a log with sound (listen --record)",
    )
    _program_option(transcribe)
    _world(transcribe)
    transcribe.add_argument(
        "--dialogue", action="store_true", help="each file goes on where the one before ended"
    )
    transcribe.add_argument(
        "--free", action="store_true", help="recognise any words, not just the world's"
    )
    _recogniser(transcribe)
    listen = adder.add(
        "listen",
        "author hands-free, by voice",
        "polaris-nl listen --world care-home --aloud\n"
        "  polaris-nl listen --world care-home --mic order.wav\n"
        "  polaris-nl listen --world care-home --mic tcp://127.0.0.1:10700 --mode wake",
    )
    _recogniser(listen)
    _program_option(listen)
    _world(listen)
    _microphone(listen)
    listen.add_argument(
        "--mode", choices=("always", "wake", "talk"), default="always",
        help="listen always (default), after the words \"hey jarvis\", or after Enter",
    )  # fmt: skip
    _robot(listen)
    listen.add_argument("--aloud", action="store_true", help="speak the answers, too")
    listen.add_argument(
        "--headset", action="store_true", help="listen while speaking: it can't hear itself"
    )
    _session_log(listen)
    listen.add_argument(
        "--record", action="store_true", help="keep the sound of it in the log, too"
    )
    listen.add_argument("--microphones", action="store_true", help="list the microphones")
    listen.add_argument("--level", action="store_true", help="measure how loud the microphone is")
    models = adder.add("models", "fetch the speech model", "polaris-nl models")
    models.add_argument("--force", action="store_true", help="fetch it even if it is there")


def _looking(adder: _Adder) -> None:
    review = adder.add(
        "review",
        "read a log back, or a folder of logs",
        'polaris-nl review lunch.mcap --ask "why did it halt?"',
    )
    add_review_options(review)
    adder.add(
        "domains", "list the domains that ship with Polaris NL", "polaris-nl domains", "catalogue"
    )
    adder.add(
        "worlds", "list the worlds that ship with Polaris NL", "polaris-nl worlds", "catalogue"
    )
    durations = adder.add(
        "durations",
        "show how long actions took, which later plans take into account",
        "polaris-nl durations --world care-home\n  polaris-nl durations --world care-home --reset",
    )
    _world(durations, required=True)
    durations.add_argument("--reset", action="store_true", help="forget what was learned")
    check = adder.add(
        "check", "check domain, world, grammar and program files", "polaris-nl check my-world.yaml"
    )
    check.add_argument(
        "files", metavar="F", nargs="+", type=Path, help="a .pddl, .yaml or .json file"
    )
    adder.add("doctor", "say what is installed and what is missing", "polaris-nl doctor")
    demo = adder.add(
        "demo", "the caregiving scenario from a recording to a reviewed log", "polaris-nl demo"
    )
    demo.add_argument(
        "--folder", metavar="DIR", type=Path, help="where to keep the program and the logs"
    )
    export = adder.add(
        "export",
        "write a program in another form",
        "polaris-nl export lunch.polaris.json --to isl",
        "exchange",
    )
    _program(export)
    export.add_argument(
        "--to", choices=("mermaid", "dot", "isl"), default="mermaid", help="the form"
    )
    import_ = adder.add(
        "import",
        "read a program in another form",
        "polaris-nl import lunch.isl --world care-home --program lunch.polaris.json",
        "exchange",
    )
    import_.add_argument("file", metavar="FILE", type=Path, help="an ISL file")
    _world(import_)
    import_.add_argument(
        "--program", metavar="F", type=Path,
        help="the program file to make; without it, the program is printed",
    )  # fmt: skip


def _simulating(adder: _Adder) -> None:
    sim = adder.add(
        "stretch-sim",
        "start a simulated Stretch, which runs are carried out on over ROS 2",
        "polaris-nl stretch-sim --world care-home --people dismiss\n"
        "  polaris-nl stretch-sim --world dinner-party --render run.mp4",
    )
    _world(sim, required=True)
    sim.add_argument(
        "--render", metavar="OUT", type=Path,
        help="draw it: a video (.mp4) of all that happens, or a picture (.png) when it is stopped",
    )  # fmt: skip
    sim.add_argument(
        "--people", metavar="ACTION", action="append",
        help="what people prefer to do, by the names in the world file; none: they do nothing",
    )  # fmt: skip
    sim.add_argument("--seed", metavar="N", type=int, default=0, help="makes the same run again")
    sim.add_argument(
        "--noise", metavar="M", type=float, default=0.0,
        help="noise of the cameras, as a standard deviation in metres",
    )  # fmt: skip
    sim.add_argument(
        "--dropout", metavar="P", type=float, default=0.0,
        help="the share of markers that the cameras miss, from 0 to 1",
    )  # fmt: skip
    sim.add_argument(
        "--speed", metavar="X", type=float, default=1.0,
        help="how many times as fast as real time it goes",
    )  # fmt: skip
    sim.add_argument(
        "--kinematic", action="store_true", help="without forces, even where MuJoCo is installed"
    )
