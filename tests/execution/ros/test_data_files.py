"""Robot profiles and skills: what is shipped is right, and what isn't is told by line and name."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from polaris_nl.cli import main
from polaris_nl.execution.ros.primitive_kinds import PRIMITIVES
from polaris_nl.execution.ros.profile import FOLDER, profile_for, profile_names, read_profile
from polaris_nl.execution.ros.skills import read_skills, skills_for
from polaris_nl.model.data import shipped_domains
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import FormatError, RunError
from polaris_nl.model.pddl import read_domain

Change = Callable[[str], Path]


@pytest.mark.parametrize("name", profile_names())
def test_shipped_profiles(name: str) -> None:
    profile = profile_for(name)
    assert profile.name == name
    assert set(profile.primitives) <= set(PRIMITIVES)
    assert profile.simulated == (name == "stretch-sim")
    arm = profile.arm
    stowed = {"joint_lift": arm.stowed_lift, "wrist_extension": arm.stowed_extension}
    assert profile.beyond(stowed) == ""
    assert profile.beyond({"joint_lift": arm.reach_lift}) == ""


def test_stretch_is_the_newest_one() -> None:
    assert profile_for("stretch").name == "stretch-3"


@pytest.mark.parametrize("name", sorted(shipped_domains()))
def test_the_simulated_robot_has_a_skill_for_every_shipped_operator(name: str) -> None:
    domain = read_domain(shipped_domains()[name])
    skills = skills_for(domain)
    assert set(skills.by_operator) == set(domain.operators)
    assert skills.missing(domain.operators, profile_for("stretch-sim")) == ()


def test_what_a_robot_has_no_means_for_is_missing_each_once_and_in_order() -> None:
    domain = read_domain(shipped_domains()["caregiving"])
    asked = ("move", "fill", "place", "fill", "alert")
    assert skills_for(domain).missing(asked, profile_for("stretch")) == ("fill", "place")


def test_steps_have_the_actions_arguments() -> None:
    domain = read_domain(shipped_domains()["caregiving"])
    steps = skills_for(domain).steps(Action("pick", ("cup", "table")), domain.operators["pick"])
    assert [str(s) for s in steps] == [
        "navigate table", "reach table", "grasp cup table", "retract",
    ]  # fmt: skip


def test_a_domain_without_skills_can_do_nothing(tmp_path: Path) -> None:
    path = tmp_path / "domain.pddl"
    shutil.copy(shipped_domains()["tidying"], path)
    domain = read_domain(path)
    able = skills_for(domain)
    assert able.missing(["move"], profile_for("stretch-sim")) == ("move",)


def test_limits() -> None:
    profile = profile_for("stretch-3")
    assert profile.beyond({"joint_lift": 1.1, "wrist_extension": 0.0}) == ""
    assert "1.2" in profile.beyond({"joint_lift": 1.2})
    assert "joint_lift" in profile.beyond({"joint_lift": -0.01})
    assert "no joint tail" in profile.beyond({"tail": 0.0})


def test_an_unknown_robot_is_named_with_those_there_are() -> None:
    with pytest.raises(RunError, match=r"no robot called strech\..*stretch"):
        profile_for("strech")


@pytest.fixture
def profile_with(tmp_path: Path) -> Callable[[str, str], Path]:
    def change(old: str, new: str) -> Path:
        text = (FOLDER / "stretch-3.yaml").read_text()
        assert old in text
        path = tmp_path / "mine.yaml"
        path.write_text(text.replace(old, new, 1))
        return path

    return change


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("  odom: /odom\n", "", "topics lacks odom"),
        ("  odom: /odom\n", "  odom: odom\n", "odom is a full name"),
        ("  odom: /odom\n", "  odo: /odom\n", "no field 'odo'.*odom"),
        ("navigate: navigation", "navigate: wheels", "navigate is done by"),
        ("  navigate: navigation", "  fly: navigation", "no field 'fly'"),
        ("joint_lift: [0.0, 1.10]", "joint_lift: [1.0]", "joint_lift has a lower and an upper"),
        ("joint_lift: [0.0, 1.10]", "joint_lift: [2, 1]", "joint_lift has a lower and an upper"),
        ("heartbeat_s: 0.5", "heartbeat_s: soon", "heartbeat_s is a number"),
        ("heartbeat_s: 0.5", "heartbeat_s: -1", "heartbeat_s can't be less"),
        ("sight: marker", "sight: x-ray", "sight is region or marker"),
        ("title: Stretch 3\n", "", "title is missing"),
        ("polaris-robot/1", "polaris-robot/9", "newer"),
    ],
)
def test_a_wrong_profile_is_told_by_line(
    profile_with: Callable[[str, str], Path], old: str, new: str, says: str
) -> None:
    path = profile_with(old, new)
    with pytest.raises(FormatError, match=says) as raised:
        read_profile(path)
    assert raised.value.line
    assert raised.value.path == path


@pytest.mark.parametrize(
    ("skill", "says"),
    [
        ("  fly:\n    - {do: retract}", "no operator fly"),
        ("  move:\n    - {do: levitate}", "no primitive levitate"),
        ("  move:\n    - {do: navigate}", "navigate lacks to"),
        ('  move:\n    - {do: navigate, to: "?where"}', r"no parameter \?where.*\?to"),
        ('  move:\n    - {do: navigate, to: "?to", fast: yes}', "no field 'fast'"),
        ('  pick:\n    - {do: grasp, object: "?s", at: "?s"}', r"\?s of pick is a surface"),
        ("  move:\n    - retract", "given as"),
    ],
)
def test_wrong_skills_are_told_by_line(tmp_path: Path, skill: str, says: str) -> None:
    domain = read_domain(shipped_domains()["caregiving"])
    path = tmp_path / "skills.yaml"
    path.write_text(f"schema: polaris-skills/1\ndomain: caregiving\nskills:\n{skill}\n")
    with pytest.raises(FormatError, match=says) as raised:
        read_skills(path, domain)
    assert raised.value.line in (4, 5)


def test_skills_of_another_domain_are_refused(tmp_path: Path) -> None:
    domain = read_domain(shipped_domains()["tidying"])
    with pytest.raises(FormatError, match="skills for caregiving, not for tidying"):
        read_skills(shipped_domains()["caregiving"].with_name("skills.yaml"), domain)


def test_check_knows_skills_and_profiles(capsys: pytest.CaptureFixture[str]) -> None:
    skills = shipped_domains()["caregiving"].with_name("skills.yaml")
    assert main(["check", str(skills), str(FOLDER / "stretch-3.yaml")]) == 0
    told = capsys.readouterr()
    assert "skills for caregiving, all right." in " ".join(told.out.split())
    assert "a robot profile, Stretch 3, all right." in " ".join(told.out.split())
    assert "Stretch 3 has no means for: place, close-container" in told.err
    assert "simulated" not in told.err


def test_check_tells_what_is_wrong_with_skills(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = shipped_domains()["tidying"].parent
    shutil.copy(folder / "domain.pddl", tmp_path)
    path = tmp_path / "skills.yaml"
    path.write_text((folder / "skills.yaml").read_text().replace("do: grasp", "do: grab", 1))
    assert main(["check", str(path)]) == 1
    assert "no primitive grab. Did you mean grasp?" in capsys.readouterr().err
    path.write_text("schema: polaris-skills/1\ndomain: tidying\nskills:\n  move: [{do: retract}]\n")
    assert main(["check", str(path)]) == 0
    assert "pick has no skill" in capsys.readouterr().err
