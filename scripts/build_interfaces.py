"""Builds the ROS 2 message packages that no wheel has into this environment, from our definitions.

The definitions are in polaris_nl/execution/ros/interfaces: a folder a package. Needed are the extras `ros`
and `interfaces` (CMake, Ninja and the generators come as wheels) and a C++ compiler. What is built lies in the
environment's own folders, so nothing has to be sourced or set afterwards. It takes about half a minute:

    python scripts/build_interfaces.py             # builds what can't be imported yet
    python scripts/build_interfaces.py --again     # builds all of it
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

DEFINITIONS = Path(__file__).parents[1] / "polaris_nl" / "execution" / "ros" / "interfaces"
PREFIX = Path(sys.prefix)
VERSIONS = {"control_msgs": "4.8.0", "nav2_msgs": "1.1.0", "tf2_msgs": "0.25.0"}
"""The releases of Humble whose wire format the definitions have."""

_FOREIGN_PYTHON = re.compile(r"/opt/python/[^/;\" ]+/include/python3\.\d+")
_FOREIGN_NUMPY = re.compile(
    r"/opt/python/[^/;\" ]+/lib/python3\.\d+/site-packages/numpy/(?:_?core)/include"
)


class BuildError(Exception):
    """A package can't be built; the text says why, and a way out."""


def packages() -> list[Path]:
    """The folders of the packages."""
    return sorted(p for p in DEFINITIONS.iterdir() if p.is_dir() and not p.name.startswith("_"))


def definitions(package: Path) -> list[Path]:
    """A package's definition files."""
    return sorted(p for kind in ("msg", "srv", "action") for p in package.glob(f"{kind}/*.{kind}"))


def dependencies(package: Path) -> list[str]:
    """The other packages whose messages are fields in a package."""
    text = "\n".join(p.read_text(encoding="utf-8") for p in definitions(package))
    found = set(re.findall(r"^([a-z][a-z0-9_]*)/\w+", text, re.MULTILINE))
    return sorted(found - {package.name})


def write_project(package: Path, folder: Path) -> None:
    """Writes what a build of a package starts from: package.xml, CMakeLists.txt, the definitions."""
    shutil.copytree(package, folder, dirs_exist_ok=True)
    depends = dependencies(package)
    tags = "".join(f"  <depend>{name}</depend>\n" for name in depends)
    (folder / "package.xml").write_text(
        '<?xml version="1.0"?>\n<package format="3">\n'
        f"  <name>{package.name}</name>\n  <version>{VERSIONS[package.name]}</version>\n"
        "  <description>Messages that Polaris NL uses</description>\n"
        '  <maintainer email="polaris-nl@example.org">Polaris NL</maintainer>\n'
        "  <license>Apache-2.0</license>\n"
        "  <buildtool_depend>ament_cmake</buildtool_depend>\n"
        "  <buildtool_depend>rosidl_default_generators</buildtool_depend>\n"
        f"{tags}  <exec_depend>rosidl_default_runtime</exec_depend>\n"
        "  <member_of_group>rosidl_interface_packages</member_of_group>\n</package>\n",
        encoding="utf-8",
    )
    found = "".join(f"find_package({name} REQUIRED)\n" for name in depends)
    files = "".join(
        f'  "{path.relative_to(package).as_posix()}"\n' for path in definitions(package)
    )
    (folder / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.20)\nproject({package.name})\n"
        "find_package(ament_cmake REQUIRED)\nfind_package(rosidl_default_generators REQUIRED)\n"
        f"{found}rosidl_generate_interfaces(${{PROJECT_NAME}}\n{files}"
        f"  DEPENDENCIES {' '.join(depends)})\nament_package()\n",
        encoding="utf-8",
    )


def mend_paths(share: Path) -> int:
    """Puts our folders in the place of those of the machine on which the wheels were made.

    Returns:
        How many files were changed.
    """
    try:
        import numpy
    except ModuleNotFoundError as error:
        raise BuildError("numpy is missing; install the extra ros first.") from error
    ours = sysconfig.get_paths()["include"]
    changed = 0
    for path in share.glob("*/cmake/*.cmake"):
        text = path.read_text(encoding="utf-8")
        mended = _FOREIGN_NUMPY.sub(numpy.get_include(), _FOREIGN_PYTHON.sub(ours, text))
        if mended != text:
            path.write_text(mended, encoding="utf-8")
            changed += 1
    return changed


def build(package: Path, environment: Mapping[str, str]) -> None:
    """Builds and installs one package.

    Raises:
        BuildError: a step fails.
    """
    with tempfile.TemporaryDirectory(prefix=f"{package.name}-") as temporary:
        source, target = Path(temporary, "source"), Path(temporary, "build")
        write_project(package, source)
        cmake = [
            f"-DCMAKE_PREFIX_PATH={PREFIX}",
            f"-DCMAKE_INSTALL_PREFIX={PREFIX}",
            f"-DPython3_EXECUTABLE={sys.executable}",
            "-DCMAKE_BUILD_TYPE=MinSizeRel",
            "-DBUILD_TESTING=OFF",
        ]
        for step in (
            ["cmake", "-G", "Ninja", "-S", str(source), "-B", str(target), *cmake],
            ["cmake", "--build", str(target)],
            ["cmake", "--install", str(target)],
        ):
            result = subprocess.run(
                step, env=environment, capture_output=True, text=True, timeout=600, check=False
            )
            if result.returncode != 0:
                tail = "\n".join((result.stdout + result.stderr).splitlines()[-30:])
                raise BuildError(f"{package.name} can't be built ({' '.join(step[:2])}):\n{tail}")


def build_environment() -> Mapping[str, str]:
    """The variables that the generators need.

    Raises:
        BuildError: a tool is missing.
    """
    tools = f"{PREFIX / 'bin'}{os.pathsep}{os.environ.get('PATH', '')}"
    for tool, way_out in (
        (os.environ.get("CXX", "g++"), "On Debian or Ubuntu: scripts/install-system robot"),
        ("cmake", "Install the extra interfaces first."),
        ("ninja", "Install the extra interfaces first."),
    ):
        if shutil.which(tool, path=tools) is None:
            raise BuildError(
                f"{tool} is missing, and messages can't be built without it. {way_out}"
            )
    header = Path(sysconfig.get_paths()["include"]) / "Python.h"
    if not header.is_file():
        raise BuildError(
            "Python's own headers are missing, and messages can't be built without them. On Debian or Ubuntu: "
            "apt install python3-dev"
        )
    return {
        **os.environ,
        "PATH": tools,
        "AMENT_PREFIX_PATH": str(PREFIX),
        "LD_LIBRARY_PATH": str(PREFIX / "lib"),
        "PYTHONPATH": sysconfig.get_paths()["purelib"],
    }


def importable(names: Iterable[str]) -> list[str]:
    """Those packages whose messages can be imported and sent, asked in a process of their own."""
    found = []
    for name in names:
        kinds = [path.parent.name for path in definitions(DEFINITIONS / name)]
        code = f"from rclpy.type_support import check_for_type_support\n{_uses(name, kinds)}"
        result = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, timeout=60, check=False
        )
        if result.returncode == 0:
            found.append(name)
    return found


def _uses(name: str, kinds: Sequence[str]) -> str:
    files = definitions(DEFINITIONS / name)
    return "\n".join(
        f"import {name}.{kind}; check_for_type_support({name}.{kind}.{path.stem})"
        for kind, path in zip(kinds, files, strict=True)
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Builds what is missing and returns the exit status."""
    parser = argparse.ArgumentParser(description="Builds the ROS 2 messages that no wheel has.")
    parser.add_argument("--again", action="store_true", help="build even what can be imported")
    options = parser.parse_args(arguments)
    names = [p.name for p in packages()]
    there = [] if options.again else importable(names)
    missing = [p for p in packages() if p.name not in there]
    try:
        if missing:
            environment = build_environment()
            mend_paths(PREFIX / "share")
        for package in missing:
            print(f"Building {package.name}", flush=True)
            build(package, environment)
        left = sorted({p.name for p in missing} - set(importable(names)))
        if left:
            raise BuildError(f"{', '.join(left)} can't be imported though built; try --again.")
    except BuildError as error:
        print(f"build_interfaces: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
