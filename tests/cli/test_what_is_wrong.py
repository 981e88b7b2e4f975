"""grader grade names the element, the loss and the type that are wrong, not something near them."""

from pathlib import Path

import pytest

from tests.command_line import run

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
