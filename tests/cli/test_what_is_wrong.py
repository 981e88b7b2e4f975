"""grader grade names the element, the loss and the type that are wrong, not something near them."""

import json
from pathlib import Path

import pytest

from tests.command_line import ROOT, run

ROBOT = """\
<robot name="r">
<link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="1"/></geometry></collision></link>
<link name="tool"/>
<joint name="slide" type="prismatic"><parent link="base"/><child link="tool"/>
<limit lower="0" upper="0.3" effort="1" velocity="1"/></joint>
<ros2_control name="c" type="system">
<joint name="joint1"><command_interface name="position"/></joint>
<joint name="joint2"><command_interface name="position"/></joint>
</ros2_control>
</robot>
"""
RUBRIC = """\
id = "r"
title = "R"
[[part]]
id = "p"
title = "P"
[[criterion]]
id = "interface"
part = "p"
title = "joint2 has an interface"
points = 1
check = "element_present"
with = { tag = "ros2_control", path = "joint", values = { "@name" = "joint2", "command_interface/@name" = "position" } }
[[criterion]]
id = "ball"
part = "p"
title = "The base collides as a ball"
points = 1
check = "element_present"
with = { tag = "link", attributes = { name = "base" }, path = "collision", values = { "geometry/sphere/@radius" = 1 } }
[[criterion]]
id = "limits"
part = "p"
title = "The tool slides by 0.3 m"
points = 1
check = "joint_limits"
with = { link = "tool", lower = 0, upper = 0.3, tolerance = 0.002 }
"""


@pytest.mark.parametrize(
    ("old", "new", "lost", "message"),
    [
        ("", "", "", ""),
        (
            'joint2"><command_interface name="position"/>',
            'joint2">',
            "interface",
            "'command_interface/@name' is missing; it should be 'position'.",
        ),
        (
            'name="joint2"',
            'name="joint3"',
            "interface",
            "No <joint> in <ros2_control> has the '@name' 'joint2'; the file has 'joint1' and 'joint3'.",
        ),
        (
            '<joint name="joint2"><command_interface name="position"/></joint>\n',
            "",
            "interface",
            "No <joint> in <ros2_control> has the '@name' 'joint2'; the file has 'joint1'.",
        ),
        (
            'izz="1"',
            'izz="x"',
            "ball",
            "is not a number; ROS 2 drops all visuals and collisions of link 'base'.",
        ),
        (
            "prismatic",
            "revolute",
            "limits",
            "The joint that moves 'tool' is revolute; it should be prismatic, with a range of 0 to 0.3 m (joint 'slide').",
        ),
    ],
)
def test_the_report_names_what_is_wrong(tmp_path: Path, old: str, new: str, lost: str, message: str) -> None:
    """The sibling that is meant, what ROS 2 drops with an inertial, a joint of the wrong type."""
    (tmp_path / "r.toml").write_text(RUBRIC, "utf-8")
    (tmp_path / "r.urdf").write_text(ROBOT.replace(old, new) if old else ROBOT, "utf-8")
    done = run(("grade", tmp_path / "r.urdf", "--rubric", tmp_path / "r.toml", "--hints", "none"))
    text = " ".join(done.stdout.decode().split())
    assert (done.returncode, text.count(" -1 point ")) == ((1, 1) if lost else (0, 0))
    assert f"✗ {lost} -1 point" in text if lost else True
    assert message in text


REFERENCE = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_text("utf-8")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("0 0.6 0 1", "0 153 0 1", '(URDF052: cannot read rgba="0 153 0 1": 153 is outside 0..1; ROS 2 shows black).'),
        ("0.6 0.4 0.2", "0.6,0.4,0.2", "'0.6,0.4,0.2' contains a comma: separate numbers by spaces"),
        (
            "0.15 0 0.225",
            "0,15 0 0.225",
            "'0,15' contains a comma: write a decimal point, or a space between two numbers",
        ),
        ("<sphere radius", "<sphere raduis", "no visual with a size: ROS 2 ignores the unknown attribute 'raduis'"),
        ("0.6 0.4 0.2", "600 400 200", "it should be 0.6 0.4 0.2 m (a URDF is in metres, not in millimetres)."),
        ("0.15 0 0.225", "15 0 22.5", "it should be at 0.15 0 0.225 m (a URDF is in metres, not in centimetres)."),
        ('radius="0.05"', 'radius="50"', "it should be 0.05 m (a URDF is in metres, not in millimetres)."),
        ('<material name="green"/>', '<matrial name="green"/>', "ROS 2 ignores <matrial> in <visual>; did you mean"),
        (
            '<origin xyz="0.15 0',
            '<orgin xyz="0.15 0',
            "(URDF091: ROS 2 ignores <orgin> in <joint>; did you mean <origin>?).",
        ),
        (
            '<origin xyz="0.15 0',
            '<origin xzy="0.15 0',
            "(URDF091: ROS 2 ignores the unknown attribute 'xzy' of <origin>;",
        ),
        (
            '-0.15 0.2 0" rpy="-1.57',
            '-0.15 0.2 0" rpy="-90',
            "(URDF092: rpy is in radians, and -90 is more than a full turn",
        ),
    ],
)
def test_the_message_has_its_cause(tmp_path: Path, old: str, new: str, words: str) -> None:
    """What the reader of the URDF knows is in the failure, and not at the end of the report."""
    assert old in REFERENCE
    (tmp_path / "r.urdf").write_text(REFERENCE.replace(old, new, 1), "utf-8")
    text = " ".join(run(("grade", tmp_path / "r.urdf")).stdout.decode().split())
    failure, end = text.split(" \u2717 ")[1], text.split(" \u2717 ")[-1]
    assert words in failure
    assert "warning" not in end


def test_the_cause_is_of_the_same_element(tmp_path: Path) -> None:
    """A mistake of another link or joint explains nothing."""
    text = REFERENCE.replace("0.6 0.4 0.2", "0.6 0.4 0.3").replace('<origin xyz="0.2 0', '<orgin xyz="0.2 0')
    (tmp_path / "r.urdf").write_text(text, "utf-8")
    report = json.loads(run(("grade", tmp_path / "r.urdf", "--format", "json", "--hints", "none")).stdout)
    found = {result["id"]: result["message"] for result in report["results"]}
    assert "orgin" in found["caster-placed"]
    assert "orgin" not in found["base-box"]


def test_three_mistakes_fit_24_rows(tmp_path: Path) -> None:
    """Each has its fact, its source line and its hint, with what the same edit fixes; the score is the last row."""
    changes = {
        "0.15 0 0.225": "0.15 0 0.2",
        "0 0.6 0 1": "0 153 0 1",
        '<child link="caster_wheel"/>': '<child link="castor"/>',
    }
    text = REFERENCE
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new, 1)
    (tmp_path / "r.urdf").write_text(text, "utf-8")
    rows = run(("grade", tmp_path / "r.urdf")).stdout.decode().splitlines()
    assert len(rows) <= 24
    assert rows[-1].endswith("/70  IRP Lab 6: a wheeled base")
    words = " ".join(" ".join(rows).split())
    heads = [row.split()[1] for row in rows if row.startswith("\u2717 ") and " point" in row]
    assert heads == ["urdf-loads", "lidar-frame", "base-green"]
    assert 'Change `xyz="0.15 0 0.2"` to `xyz="0.15 0 0.225"` (line 39). Also fixes lidar-on-top, -2.' in words
    for old, new in list(changes.items())[:2]:
        assert f"it should be {old}" in words or f"it should be at {old}" in words
        assert f'="{new}"' in words


def test_what_is_about_a_missing_package_comes_last(tmp_path: Path) -> None:
    """In a folder without `package.xml` the robot is what to look at first, although the package costs more."""
    (tmp_path / "lab").mkdir()
    (tmp_path / "lab/my_robot.urdf").write_text(REFERENCE.replace("0.15 0 0.225", "0.15 0 0.2"), "utf-8")
    text = run(("grade", tmp_path / "lab")).stdout.decode()
    assert 0 < text.index("\u2717 lidar-frame  -6 points") < text.index("\u2717 package-found")
    page = run(("grade", tmp_path / "lab", "--format", "markdown")).stdout.decode()
    assert 0 < page.index("`lidar-frame`") < page.index("`package-found`")
