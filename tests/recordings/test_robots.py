"""Recordings of other robots than a cart: an arm with a gripper, whose states several nodes publish, and a car that steers."""

import math
from collections.abc import Mapping
from typing import Any

import pytest

from grader.lab.checks.recorded_frames import recorded_frames_agree
from grader.lab.checks.recorded_motion import wheels_agree
from grader.lab.checks.recordings import recorded_value
from grader.ros.api import Configuration, read_urdf
from tests.checks.outcomes import graded
from tests.checks.submissions import Submitted
from tests.recordings.writing import Recorded, encode, write_mcap

_LIMIT = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
ARM = f"""\
<robot name="arm"><link name="world"/><link name="base"/><link name="upper"/><link name="slide"/><link name="left_finger"/><link name="right_finger"/><link name="tool"/>
<joint name="fixed" type="fixed"><parent link="world"/><child link="base"/><origin xyz="0 0 0.1"/></joint>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0.1 0 0.3" rpy="0.3 0.2 0.1"/><axis xyz="0 1 1"/>{_LIMIT}</joint>
<joint name="lift" type="prismatic"><parent link="upper"/><child link="slide"/><origin xyz="0 0 0.30"/><axis xyz="0 0 1"/>{_LIMIT}</joint>
<joint name="gripper" type="prismatic"><parent link="slide"/><child link="left_finger"/><origin xyz="0 0.01 0"/><axis xyz="0 1 0"/>{_LIMIT}</joint>
<joint name="follower" type="prismatic"><parent link="slide"/><child link="right_finger"/><origin xyz="0 -0.01 0"/><axis xyz="0 1 0"/><mimic joint="gripper" multiplier="-1"/>{_LIMIT}</joint>
<joint name="tool_joint" type="floating"><parent link="slide"/><child link="tool"/></joint>
</robot>
"""


def _stamp(time: float) -> dict[str, int]:
    return {"sec": int(time), "nanosec": round(time % 1 * 1e9)}


def _message(topic: str, kind: str, time: float, content: Mapping[str, Any]) -> Recorded:
    return Recorded(topic, kind, round((1_000 + time) * 1e9), encode(kind, content))


def _arm_recording(urdf: str = ARM, every: int = 1) -> bytes:
    """Return an arm that moves for 4 s: two nodes publish its joints, and their times overlap."""
    read = read_urdf(urdf).robot
    assert read is not None
    robot = Configuration(read)
    messages = [_message("/robot_description", "std_msgs/msg/String", 0, {"data": urdf})]
    for step in range(80):
        time = 5 + step / 20
        positions = {
            "shoulder": math.sin(time),
            "lift": 0.1 * math.cos(time),
            "gripper": 0.02 * step / 80,
        }
        states = [(time, ("shoulder", "lift")), (time - 0.01, ("gripper",))]
        for stamp, names in states:
            values = [positions[name] for name in names]
            content = {"header": {"stamp": _stamp(stamp)}, "name": names, "position": values}
            if step % every == 0:
                messages.append(
                    _message("/joint_states", "sensor_msgs/msg/JointState", time, content)
                )
        for stamp, names in (
            (time, ("base", "upper", "slide")),
            (time - 0.01, ("left_finger", "right_finger")),
        ):
            transforms = []
            for name in names:
                joint = robot.parent_joints[name]
                pose = robot.at(positions).pose(name, relative_to=joint.parent)
                moved = {
                    "translation": dict(zip("xyz", pose.translation, strict=True)),
                    "rotation": dict(zip("xyzw", pose.quaternion, strict=True)),
                }
                header = {"stamp": _stamp(stamp), "frame_id": joint.parent}
                transforms.append({"header": header, "child_frame_id": name, "transform": moved})
            messages.append(
                _message("/tf", "tf2_msgs/msg/TFMessage", time, {"transforms": transforms})
            )
    return write_mcap(messages)


@pytest.mark.parametrize("every", [1, 2], ids=["each state", "every second state"])
def test_an_arm_is_where_its_joints_are(every: int) -> None:
    """Joints that turn, slide and mimic are compared by their times, also between two states; a floating one is not."""
    submitted = Submitted({"arm.urdf": ARM, "move.mcap": _arm_recording(every=every)})
    outcome = graded(recorded_frames_agree, submitted)
    assert outcome.status == "passed", outcome


def test_another_arm_was_recorded() -> None:
    """A link that is elsewhere is named with both places, or with its distance if no description was recorded."""
    longer = ARM.replace('xyz="0 0 0.30"', 'xyz="0 0 0.32"')
    submitted = Submitted({"arm.urdf": longer, "move.mcap": _arm_recording()})
    outcome = graded(recorded_frames_agree, submitted)
    places = "'slide' is at 0 0 0.3, submitted 0 0 0.32 in 'upper'"
    assert outcome.message == f"the recorded robot is another: {places}"


def test_a_joint_is_asked_for_by_its_name() -> None:
    """Whatever its place in the message; states of other joints do not have it."""
    submitted = Submitted({"arm.urdf": ARM, "move.mcap": _arm_recording()})
    arguments = {"topic": "/joint_states", "field": "position[gripper]", "largest": 0.05}
    outcome = graded(recorded_value, submitted, **arguments)
    assert outcome.status == "passed", outcome


CAR = """\
<robot name="car"><link name="base_link"/>
{wheels}
</robot>
"""
_LENGTH, _WIDTH, _RADIUS = 0.6, 0.4, 0.1


def _car() -> str:
    wheels = []
    for place, x in (("front", _LENGTH), ("rear", 0.0)):
        for side, y in (("left", _WIDTH / 2), ("right", -_WIDTH / 2)):
            name, parent = f"{place}_{side}", "base_link"
            if place == "front":
                wheels.append(
                    f'<link name="{name}_knuckle"/><joint name="{name}_steering" type="revolute"><parent link="base_link"/><child link="{name}_knuckle"/><origin xyz="{x} {y} 0.1"/><axis xyz="0 0 1"/>{_LIMIT}</joint>'
                )
                parent, x, y = f"{name}_knuckle", 0.0, 0.0
            shape = f'<visual><origin rpy="1.5708 0 0"/><geometry><cylinder radius="{_RADIUS}" length="0.05"/></geometry></visual>'
            wheels.append(
                f'<link name="{name}">{shape}</link><joint name="{name}_wheel" type="continuous"><parent link="{parent}"/><child link="{name}"/><origin xyz="{x} {y} 0"/><axis xyz="0 1 0"/></joint>'
            )
            x = _LENGTH if place == "front" else 0.0
    return CAR.format(wheels="\n".join(wheels))


@pytest.mark.parametrize(("scale", "status"), [(1.0, "passed"), (0.85, "failed")])
def test_a_car_rolls_on_its_rear_wheels(scale: float, status: str) -> None:
    """Wheels that steer roll farther in a turn, and do not count."""
    messages = []
    speed, turn = 0.5, 0.6
    for step in range(81):
        time = step / 20
        yaw = turn * time
        place = {"x": speed / turn * math.sin(yaw), "y": speed / turn * (1 - math.cos(yaw))}
        pose = {"position": place, "orientation": {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}}
        header = {"stamp": _stamp(10 + time), "frame_id": "odom"}
        content = {"header": header, "pose": {"pose": pose}}
        messages.append(_message("/odom", "nav_msgs/msg/Odometry", time, content))
        rolled = {}
        for side, y in (("left", _WIDTH / 2), ("right", -_WIDTH / 2)):
            along = speed - turn * y
            rolled[f"rear_{side}_wheel"] = along * time / _RADIUS * scale
            rolled[f"front_{side}_wheel"] = (
                math.hypot(along, turn * _LENGTH) * time / _RADIUS * scale
            )
        states = {"header": header, "name": list(rolled), "position": list(rolled.values())}
        messages.append(_message("/joint_states", "sensor_msgs/msg/JointState", time, states))
    outcome = graded(
        wheels_agree, Submitted({"car.urdf": _car(), "drive.mcap": write_mcap(messages)})
    )
    assert outcome.status == status, outcome
