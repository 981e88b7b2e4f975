"""A cart with two wheels and a laser, and recordings of what it did: right ones and wrong ones."""

import math
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tests.recordings.writing import Recorded, encode, write_mcap, write_metadata, write_sqlite

RADIUS, TRACK, HEIGHT = 0.08, 0.4, 0.08
URDF = f"""\
<robot name="cart">
  <link name="base_footprint"/>
  <link name="base_link"/>
  <link name="left_wheel"><visual><origin rpy="1.5708 0 0"/><geometry><cylinder radius="{RADIUS}" length="0.04"/></geometry></visual></link>
  <link name="right_wheel"><visual><origin rpy="1.5708 0 0"/><geometry><cylinder radius="{RADIUS}" length="0.04"/></geometry></visual></link>
  <link name="laser"/>
  <joint name="footprint_joint" type="fixed"><parent link="base_footprint"/><child link="base_link"/><origin xyz="0 0 {HEIGHT}"/></joint>
  <joint name="left_joint" type="continuous"><parent link="base_link"/><child link="left_wheel"/><origin xyz="0 0.2 0"/><axis xyz="0 1 0"/></joint>
  <joint name="right_joint" type="continuous"><parent link="base_link"/><child link="right_wheel"/><origin xyz="0 -0.2 0"/><axis xyz="0 1 0"/></joint>
  <joint name="laser_joint" type="fixed"><parent link="base_link"/><child link="laser"/><origin xyz="0.1 0 0.15"/></joint>
</robot>
"""
_ODOMETRY, _STATES, _TF = (
    "nav_msgs/msg/Odometry",
    "sensor_msgs/msg/JointState",
    "tf2_msgs/msg/TFMessage",
)
_TYPES = {
    "/odom": _ODOMETRY,
    "/tf": _TF,
    "/tf_static": _TF,
    "/joint_states": _STATES,
    "/cmd_vel": "geometry_msgs/msg/TwistStamped",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/robot_description": "std_msgs/msg/String",
}


@dataclass
class Drive:
    """What is different from a straight drive of 2 m in 4 s."""

    speeds: Sequence[tuple[float, float, float]] = ((0.5, 0.0, 4.0),)  # m/s, rad/s, s
    rate: float = 10.0
    start: float = 50.0  # seconds of the robot's clock
    slower: float = 1.0  # how many seconds of the recorder a second of the robot takes
    wheels: float = 1.0  # how far the wheels turn, as a part of what they should
    laser: Sequence[float] = (0.1, 0.0, 0.15)
    ranges: Sequence[float] = (1.0, 2.0)
    without: Sequence[str] = ()
    no_odom_frame: bool = False
    zero_stamps: bool = False
    stamped: bool = True
    slash: str = ""
    prefix: str = ""
    namespace: str = ""
    lead: str = "/"  # how the names of topics begin
    wraps: bool = False
    jump: float = 0.0
    reset: float = 0.0  # after how many seconds everything begins again
    noise: float = 0.0
    late: float = 0.0  # seconds by which the times of joint states are later
    description: str | None = None
    extra: Sequence[str] = ()

    def header(self, time: float, frame: str) -> dict[str, Any]:
        """Return a header."""
        seconds = int(time)
        stamp = {"sec": seconds, "nanosec": round((time - seconds) * 1e9)}
        return {"stamp": {} if self.zero_stamps else stamp, "frame_id": frame}


def record(**changes: Any) -> list[Recorded]:
    """Return the messages of a drive."""
    drive = Drive(**changes)
    noise = random.Random(4)
    messages: list[Recorded] = []

    def write(topic: str, time: float, message: Mapping[str, Any], kind: str = "") -> None:
        if topic in drive.without:
            return
        kind = kind or _TYPES[topic]
        name = topic if topic.startswith("/tf") else drive.namespace + topic
        recorded = 1_700_000_000 + (time - drive.start) * drive.slower
        messages.append(
            Recorded(drive.lead + name[1:], kind, round(recorded * 1e9), encode(kind, message))
        )

    p, s = drive.prefix, drive.slash
    write(
        "/robot_description",
        drive.start,
        {"data": URDF if drive.description is None else drive.description},
    )
    fixed = [
        _transform(
            drive.header(drive.start, f"{p}base_footprint"), f"{p}base_link", (0, 0, HEIGHT)
        ),
        _transform(drive.header(drive.start, f"{p}base_link"), f"{p}laser", drive.laser),
    ]
    if "parent" in drive.extra:
        fixed.append(
            _transform(
                drive.header(drive.start, "base_footprint"), "laser", (0.1, 0, HEIGHT + 0.15)
            )
        )
    if "island" in drive.extra:
        fixed.append(_transform(drive.header(drive.start, "map"), "tower", (0, 0, 1)))
    write("/tf_static", drive.start, {"transforms": fixed})
    x = y = yaw = passed = back = 0.0
    turned = [0.0, 0.0]

    def write_state(speed: float, turn: float) -> None:
        shown = [math.remainder(one, 2 * math.pi) if drive.wraps else one for one in turned]
        now, recorded = drive.start + passed - back, drive.start + passed
        place = (x + noise.gauss(0, drive.noise), y + noise.gauss(0, drive.noise), 0.0)
        twist = {"linear": {"x": speed}, "angular": {"z": turn}}
        if drive.stamped:
            write("/cmd_vel", recorded, {"header": drive.header(now, "base_link"), "twist": twist})
        else:
            write("/cmd_vel", recorded, twist, "geometry_msgs/msg/Twist")
        pose = {"position": dict(zip("xyz", place, strict=True)), "orientation": _about("z", yaw)}
        odometry = {
            "header": drive.header(now, f"{s}{p}odom"),
            "child_frame_id": f"{s}{p}base_footprint",
            "pose": {"pose": pose},
        }
        write("/odom", recorded, odometry)
        moving = [
            _transform(
                drive.header(now, f"{s}{p}base_link"),
                f"{s}{p}{side}_wheel",
                (0, y0, 0),
                _about("y", angle),
            )
            for side, y0, angle in (("left", 0.2, shown[0]), ("right", -0.2, shown[1]))
        ]
        if not drive.no_odom_frame:
            moving.append(
                _transform(
                    drive.header(now, f"{s}{p}odom"),
                    f"{s}{p}base_footprint",
                    (x, y, 0),
                    _about("z", yaw),
                )
            )
        write("/tf", recorded, {"transforms": moving})
        states = {
            "header": drive.header(now + drive.late, ""),
            "name": ["left_joint", "right_joint"],
            "position": shown,
        }
        write("/joint_states", recorded, states)
        write("/scan", recorded, {"header": drive.header(now, f"{p}laser"), "ranges": drive.ranges})
        if "goal" in drive.extra:
            write("/goal", recorded, {"goal": {"x": 2.0}, "name": "end"}, "lab_msgs/msg/Goal")
        if "camera" in drive.extra:
            write(
                "/image",
                recorded,
                {"header": drive.header(now, "laser"), "data": bytes(2_000)},
                "sensor_msgs/msg/Image",
            )

    for speed, turn, seconds in drive.speeds:
        write_state(speed, turn)
        for _ in range(round(seconds * drive.rate)):
            passed += 1 / drive.rate
            x += speed / drive.rate * math.cos(yaw + turn / drive.rate / 2)
            y += speed / drive.rate * math.sin(yaw + turn / drive.rate / 2)
            yaw += turn / drive.rate
            if drive.jump and abs(passed - 2) < 0.5 / drive.rate:
                x += drive.jump
            for side, sign in enumerate((1, -1)):
                rolled = (speed - sign * turn * TRACK / 2) / drive.rate
                turned[side] += rolled / RADIUS * drive.wheels
            if drive.reset and passed > drive.reset and not back:
                x = y = yaw = 0.0
                back, turned = passed, [0.0, 0.0]
            write_state(speed, turn)
    return messages


def _about(axis: str, angle: float) -> dict[str, float]:
    return {axis: math.sin(angle / 2), "w": math.cos(angle / 2)}


def _transform(
    header: Mapping[str, Any],
    child: str,
    place: Sequence[float],
    turn: Mapping[str, float] | None = None,
) -> dict[str, Any]:
    moved = {"translation": dict(zip("xyz", place, strict=True)), "rotation": dict(turn or {})}
    return {"header": header, "child_frame_id": child, "transform": moved}


def files_of(name: str, options: Mapping[str, Any]) -> dict[str, bytes]:
    """Return the files of a recording in a folder with this name.

    Beside what `Drive` has, the options are `sqlite`, `metadata` (false: there is none), `empty`, `silent` (topics without
    messages), `cut` (bytes that the end lacks) and those of `write_mcap`.
    """
    changes = dict(options)
    writing: dict[str, Any] = {
        key: changes.pop(key)
        for key in ("chunked", "compression", "is_closed", "is_defined")
        if key in changes
    }
    is_sqlite, has_metadata, cut = (
        changes.pop(key, default)
        for key, default in (("sqlite", False), ("metadata", True), ("cut", 0))
    )
    silent = changes.pop("silent", [])
    messages = (
        []
        if changes.pop("empty", False)
        else record(**{**changes, "without": [*changes.get("without", ()), *silent]})
    )
    writing["topics"] = list(_TYPES.items()) if silent or not messages else []
    data = write_sqlite(messages, **writing) if is_sqlite else write_mcap(messages, **writing)
    file = f"{name}_0.{'db3' if is_sqlite else 'mcap'}"
    files = {f"{name}/{file}": data[: len(data) - cut]}
    return files | ({f"{name}/metadata.yaml": write_metadata(file)} if has_metadata else {})
