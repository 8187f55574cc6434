"""The message definitions, and the script that builds them."""

from __future__ import annotations

import importlib
import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

SCRIPT = Path(__file__).parents[2] / "scripts" / "build_interfaces.py"


@pytest.fixture(scope="module")
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("build_interfaces", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_what_is_built_has_the_fields_of_the_definitions_in_their_order(script: ModuleType) -> None:
    parts = {"msg": [""], "srv": ["Request", "Response"], "action": ["Goal", "Result", "Feedback"]}
    names = [p.name for p in script.packages()]
    assert names == ["control_msgs", "nav2_msgs", "tf2_msgs"]
    assert script.importable(names) == names
    for package in script.packages():
        for path in script.definitions(package):
            kind = path.parent.name
            built = getattr(importlib.import_module(f"{package.name}.{kind}"), path.stem)
            for part, text in zip(parts[kind], path.read_text().split("---"), strict=True):
                message = getattr(built, part) if part else built
                written = re.findall(r"^([\w/]+(?:\[\])?) +(\w+)$", text, re.MULTILINE)
                fields = message.get_fields_and_field_types()
                assert [name for _, name in written] == list(fields), path.name


def test_packages_name_what_they_depend_on(script: ModuleType, tmp_path: Path) -> None:
    folder = tmp_path / "control_msgs"
    script.write_project(script.DEFINITIONS / "control_msgs", folder)
    depends = {"builtin_interfaces", "std_msgs", "trajectory_msgs"}
    assert set(script.dependencies(script.DEFINITIONS / "control_msgs")) == depends
    cmake, package = (folder / name for name in ("CMakeLists.txt", "package.xml"))
    assert '"action/FollowJointTrajectory.action"' in cmake.read_text()
    for name in depends:
        assert f"find_package({name} REQUIRED)" in cmake.read_text()
        assert f"<depend>{name}</depend>" in package.read_text()


def test_foreign_paths_are_mended_once(script: ModuleType, tmp_path: Path) -> None:
    path = tmp_path / "x" / "cmake" / "x.cmake"
    path.parent.mkdir(parents=True)
    base = "/opt/python/cp311-cp311"
    path.write_text(
        f"a;{base}/include/python3.11;{base}/lib/python3.11/site-packages/numpy/_core/include;b"
    )
    assert script.mend_paths(tmp_path) == 1
    assert base not in path.read_text()
    assert path.read_text().startswith("a;")
    assert path.read_text().endswith(";b")
    assert script.mend_paths(tmp_path) == 0


def test_a_missing_compiler_is_named_with_a_way_out(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CXX", "no-such-compiler")
    with pytest.raises(
        script.BuildError, match=r"no-such-compiler is missing.*install-system robot"
    ):
        script.build_environment()
