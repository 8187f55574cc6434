"""Robot profiles: names, limits, modes and deadlines of one kind of robot, as data files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

from polaris_nl.execution.ros.primitive_kinds import PRIMITIVES
from polaris_nl.model.errors import FormatError, RunError, did_you_mean
from polaris_nl.model.schema import check_schema
from polaris_nl.model.yaml_lines import Lined, read_yaml

SCHEMA = "polaris-robot/1"
FOLDER = Path(__file__).parent / "profiles"
TOPICS = (
    "cmd_vel", "joint_states", "joint_pose_cmd", "odom", "battery", "mode", "is_homed",
    "is_runstopped", "is_streaming_position", "tf", "tf_static", "markers", "perceived", "heard", "say", "said",
    "skill", "skill_result",
)  # fmt: skip
SERVICES = ("navigation_mode", "position_mode", "streaming", "stop", "runstop")
ACTIONS = ("trajectory", "navigate")
MEANS = ("navigation", "arm", "speech", "skill")
"""What can do a primitive, besides a service, which is given by its name."""

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Arm:
    """The arm, in metres.

    Attributes:
        side_m: from the middle of the base to the fingers, to the right, with the arm drawn in.
        base_m: the height of the fingers above the floor with the lift down.
        reach_lift: where the lift goes to reach what has no known height.
        stowed_lift, stowed_extension: where the arm goes before the base drives.
        tolerance: how far off a joint may stay.
    """

    side_m: float
    base_m: float
    reach_lift: float
    stowed_lift: float
    stowed_extension: float
    tolerance: float


@dataclass(frozen=True, slots=True)
class Base:
    """How the base drives: greatest speeds (m/s, rad/s), how exactly it arrives, and how near to things."""

    linear: float
    angular: float
    tolerance_m: float
    tolerance_rad: float
    standoff_m: float


@dataclass(frozen=True, slots=True)
class Times:
    """Deadlines in seconds; nothing is waited for without one."""

    ready: float
    service: float
    accept: float
    navigate: float
    trajectory: float
    skill: float
    say: float
    cancel: float


@dataclass(frozen=True, slots=True)
class Safety:
    """When the robot counts as silent (s), its battery as low (V), and the base as moving (m/s, rad/s)."""

    heartbeat_s: float
    battery_v: float
    moving_m_s: float
    moving_rad_s: float


@dataclass(frozen=True, slots=True)
class Sight:
    """How perception goes; see `perception.perceive`."""

    sight: str
    stale_s: float
    settle_s: float
    memory_s: float
    near_m: float
    detects: tuple[str, ...] = ()


@dataclass(frozen=True)
class Profile:
    """One kind of robot.

    Attributes:
        name: what `run --robot` takes.
        title: what it is called in sentences.
        simulated: nothing real moves.
        topics, services, actions: names on the robot, by what they are for.
        primitives: what does each primitive: one of `MEANS`, or the name of a service.
        joints: lower and upper limit of each joint, in m or rad.
    """

    name: str
    title: str
    simulated: bool
    topics: Mapping[str, str]
    services: Mapping[str, str]
    actions: Mapping[str, str]
    primitives: Mapping[str, str]
    joints: Mapping[str, tuple[float, float]]
    arm: Arm
    base: Base
    times: Times
    safety: Safety
    perception: Sight

    def beyond(self, joints: Mapping[str, float]) -> str:
        """What is wrong with joint positions: an unknown joint or one beyond its limits; "" if nothing."""
        for name, value in joints.items():
            if name not in self.joints:
                return f"{self.title} has no joint {name}"
            low, high = self.joints[name]
            if not low <= value <= high:
                return f"{value:g} is beyond the limits of {name}, {low:g} to {high:g}"
        return ""


def profile_names() -> tuple[str, ...]:
    """The robots that there are profiles for."""
    return tuple(sorted(p.stem for p in FOLDER.glob("*.yaml")))


def profile_for(name: str) -> Profile:
    """The profile of a robot: a shipped one, or a file.

    Args:
        name: a shipped name, `stretch` for the newest one, or a path to a profile file.

    Raises:
        RunError: there is none.
        FileError, FormatError: the file can't be read or isn't right; the line is named.
    """
    if name.endswith((".yaml", ".yml")):
        return read_profile(Path(name).expanduser())
    path = FOLDER / f"{'stretch-3' if name == 'stretch' else name}.yaml"
    if not path.is_file():
        raise RunError(f"There is no robot called {name}.{did_you_mean(name, profile_names())}")
    return read_profile(path)


def read_profile(path: Path) -> Profile:
    """Reads a profile file.

    Raises:
        FileError: it can't be read.
        FormatError: it isn't right; file and line are named.
    """
    try:
        root, _ = read_yaml(path)
        return _profile(root)
    except FormatError as error:
        raise FormatError(error.reason, path, error.line) from error


def _profile(root: Lined) -> Profile:
    names = ("schema", *(f.name for f in fields(Profile)))
    given = root.mapping("A robot profile", names)
    check_schema(
        given.get("schema", Lined("", 1)).text("schema") if "schema" in given else "",
        SCHEMA,
        "robot profile",
    )
    for name in names[1:]:
        if name not in given:
            raise FormatError(f"The field {name} is missing.", line=root.line)
    return Profile(
        name=given["name"].text("name"),
        title=given["title"].text("title"),
        simulated=given["simulated"].flag("simulated"),
        topics=_names(given["topics"], "topics", TOPICS),
        services=_names(given["services"], "services", SERVICES),
        actions=_names(given["actions"], "actions", ACTIONS),
        primitives=_primitives(given["primitives"]),
        joints=_joints(given["joints"]),
        arm=_record(Arm, given["arm"], "arm"),
        base=_record(Base, given["base"], "base"),
        times=_record(Times, given["times"], "times"),
        safety=_record(Safety, given["safety"], "safety"),
        perception=_sight(given["perception"]),
    )


def _names(lined: Lined, what: str, known: tuple[str, ...]) -> dict[str, str]:
    given = lined.mapping(what, known)
    for name in known:
        if name not in given:
            raise FormatError(f"{what} lacks {name}.", line=lined.line)
    return {name: _ros_name(value, name) for name, value in given.items()}


def _ros_name(value: Lined, what: str) -> str:
    text = value.text(what)
    if not text.startswith("/"):
        raise FormatError(
            f"{what} is a full name and starts with /, not {text!r}.", line=value.line
        )
    return text


def _primitives(lined: Lined) -> dict[str, str]:

    found: dict[str, str] = {}
    for name, value in lined.mapping("primitives", PRIMITIVES).items():
        means = value.text(name)
        if means not in MEANS and not means.startswith("/"):
            raise FormatError(
                f"{name} is done by {', '.join(MEANS)} or a service (/name), not by {means!r}.",
                line=value.line,
            )
        found[name] = means
    return found


def _joints(lined: Lined) -> dict[str, tuple[float, float]]:
    if not isinstance(lined.value, dict):
        raise FormatError("joints is a list of fields (name: [lower, upper]).", line=lined.line)
    found: dict[str, tuple[float, float]] = {}
    for name, value in lined.value.items():
        limits = [item.number(f"a limit of {name}") for item in value.items(name)]
        if len(limits) != 2 or limits[0] >= limits[1]:
            raise FormatError(f"{name} has a lower and an upper limit.", line=value.line)
        found[str(name)] = (limits[0], limits[1])
    return found


def _record(kind: type[T], lined: Lined, what: str) -> T:
    """Numbers by name, all of them above or at zero."""
    names = [f.name for f in fields(kind)]  # type: ignore[arg-type] # kinds are dataclasses
    given = lined.mapping(what, names)
    values: dict[str, Any] = {}
    for name in names:
        if name not in given:
            raise FormatError(f"{what} lacks {name}.", line=lined.line)
        values[name] = given[name].number(name)
        if values[name] < 0:
            raise FormatError(f"{name} can't be less than zero.", line=given[name].line)
    return kind(**values)


def _sight(lined: Lined) -> Sight:
    hints = get_type_hints(Sight)
    given = lined.mapping("perception", hints)
    values: dict[str, Any] = {}
    for entry in fields(Sight):
        if entry.name not in given:
            if entry.default is MISSING:
                raise FormatError(f"perception lacks {entry.name}.", line=lined.line)
            continue
        value = given[entry.name]
        if entry.name == "sight":
            values["sight"] = value.text("sight")
            if values["sight"] not in ("region", "marker"):
                raise FormatError("sight is region or marker.", line=value.line)
        elif entry.name == "detects":
            values["detects"] = value.texts("detects")
        else:
            values[entry.name] = value.number(entry.name)
    return Sight(**values)
