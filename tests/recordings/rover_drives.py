"""The recordings of submissions/rover, which `python tests/sample_files.py` writes: a rover that drives 1 m in 4 s."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from grader.base.transforms import Transform
from grader.ros.api import Configuration, read_urdf
from tests.recordings.writing import Recorded, encode, write_mcap, write_metadata

_FOLDER = Path(__file__).parent.parent.parent / "submissions/rover"
_START, _SECONDS, _RATE = 1_764_000_000, 4, 10
# What is different from a straight drive with the submitted robot: the speeds in m/s and rad/s, how far the wheels roll as a
# part of what they should, and where the lidar is besides.
DRIVES: Mapping[str, Mapping[str, Any]] = {
    "equivalent-recorded": {},
    "recorded-bend": {"turn": 0.4},
    "recorded-with-other-wheels": {"rolled": 0.8},
    "recorded-with-lidar-aside": {"aside": 0.03},
}


def drive_files() -> Iterator[tuple[Path, bytes]]:
    """Yield the path of each file of the recordings, and its content."""
    for sample, changes in DRIVES.items():
        urdf = (_FOLDER / sample / "rover.urdf").read_text(encoding="utf-8")
        folder = _FOLDER / sample / "drive"
        yield folder / "drive_0.mcap", write_mcap(_record(urdf, **changes))
        yield folder / "metadata.yaml", write_metadata("drive_0.mcap")


def _record(
    urdf: str, turn: float = 0.0, rolled: float = 1.0, aside: float = 0.0
) -> list[Recorded]:
    """Return the messages of a drive with 0.25 m/s."""
    read = read_urdf(urdf).robot
    assert read is not None
    robot, messages = Configuration(read), []
    speed, radius, half_track = 0.25, 0.05, 0.12

    def write(topic: str, kind: str, step: int, content: Mapping[str, Any]) -> None:
        time = _START * 10**9 + step * 10**9 // _RATE
        messages.append(Recorded(topic, kind, time, encode(kind, content)))

    def header(step: int, frame: str) -> dict[str, Any]:
        seconds, rest = divmod(step, _RATE)
        stamp = {"sec": _START + seconds, "nanosec": rest * 10**9 // _RATE}
        return {"stamp": stamp, "frame_id": frame}

    fixed = []
    for joint in read.joints:
        if joint.type == "fixed":
            pose = robot.pose(joint.child, relative_to=joint.parent)
            if joint.child == "lidar":
                pose = Transform(translation=(0.0, aside, 0.0)) @ pose
            fixed.append(_transform(header(0, joint.parent), joint.child, pose))
    write("/tf_static", "tf2_msgs/msg/TFMessage", 0, {"transforms": fixed})
    write("/robot_description", "std_msgs/msg/String", 0, {"data": urdf})
    for step in range(_SECONDS * _RATE + 1):
        time = step / _RATE
        yaw, driven = turn * time, speed * time
        x = speed / turn * math.sin(yaw) if turn else driven
        y = speed / turn * (1 - math.cos(yaw)) if turn else 0.0
        wheels = {
            "left_wheel_joint": (driven - yaw * half_track) / radius * rolled,
            "right_wheel_joint": (driven + yaw * half_track) / radius * rolled,
        }
        states = {"name": [*wheels], "position": [*wheels.values()]}
        write(
            "/joint_states",
            "sensor_msgs/msg/JointState",
            step,
            {"header": header(step, ""), **states},
        )
        turned = Transform(
            (math.cos(yaw), -math.sin(yaw), 0, math.sin(yaw), math.cos(yaw), 0, 0, 0, 1), (x, y, 0)
        )
        moving = [_transform(header(step, "odom"), "base_footprint", turned)]
        for name in wheels:
            joint = read.joint(name)
            pose = robot.at(wheels).pose(joint.child, relative_to=joint.parent)
            moving.append(_transform(header(step, joint.parent), joint.child, pose))
        write("/tf", "tf2_msgs/msg/TFMessage", step, {"transforms": moving})
        place = moving[0]["transform"]
        odometry = {
            "header": header(step, "odom"),
            "child_frame_id": "base_footprint",
            "pose": {"pose": {"position": place["translation"], "orientation": place["rotation"]}},
        }
        write("/odom", "nav_msgs/msg/Odometry", step, odometry)
    return messages


def _transform(header: Mapping[str, Any], child: str, pose: Transform) -> dict[str, Any]:
    """Return a transform as /tf has it."""
    roll, pitch, yaw = pose.rpy
    (sr, cr), (sp, cp), (sy, cy) = (
        (math.sin(angle / 2), math.cos(angle / 2)) for angle in (roll, pitch, yaw)
    )
    rotation = {
        "x": sr * cp * cy - cr * sp * sy,
        "y": cr * sp * cy + sr * cp * sy,
        "z": cr * cp * sy - sr * sp * cy,
        "w": cr * cp * cy + sr * sp * sy,
    }
    translation = dict(zip("xyz", pose.translation, strict=True))
    return {
        "header": header,
        "child_frame_id": child,
        "transform": {"translation": translation, "rotation": rotation},
    }
