"""Hints for elements of simulators: each mistake is undone by an edit that was tried."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run

pytestmark = pytest.mark.slow

RUBRIC = """\
id = "camera"
title = "Camera"
reference = "camera"
hints = "edit"
[[part]]
id = "a"
title = "A"
[[criterion]]
id = "sensor"
part = "a"
title = "Sensor"
points = 2
check = "entry_is"
with = { at = "gazebo[@reference='@tip']/sensor", values = { "@type" = "camera", rate = 30, "camera/image/width" = 640 } }
[[criterion]]
id = "control"
part = "a"
title = "Control"
points = 2
check = "entry_is"
with = { at = "ros2_control/joint", values = { "@name" = "j", "command/@name" = ["position", "velocity"] } }
"""
SENSOR = """\
<sensor name="eye" type="camera">
<rate>30</rate>
<camera><image><width>640</width></image></camera>
</sensor>"""
ROBOT = f"""\
<robot name="camera">
<link name="base"/>
<link name="camera_link"/>
<joint name="j" type="fixed"><parent link="base"/><child link="camera_link"/></joint>
<gazebo reference="camera_link">
{SENSOR}
</gazebo>
<ros2_control name="all" type="system">
<joint name="j"><command name="position"/><command name="velocity"/></joint>
</ros2_control>
</robot>
"""
XACRO = ROBOT.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')


def hints_of(folder: Path, robot: str, name: str = "robot.urdf") -> list[dict[str, Any]]:
    """Return the hints for a robot, with the criteria that each of them gains."""
    (folder / "camera").mkdir()
    (folder / "camera/robot.urdf").write_text(ROBOT)
    (folder / "rubric.toml").write_text(RUBRIC)
    (folder / name).write_text(robot)
    done = run(("grade", folder / name, "--rubric", folder / "rubric.toml", "--format", "json"))
    assert done.returncode == 1, done
    return [hint for result in json.loads(done.stdout)["results"] for hint in result["hints"]]


@pytest.mark.parametrize(
    ("old", "new", "edit", "criterion"),
    [
        ("<rate>30<", "<rate>10<", ("10", "30"), "sensor"),
        ('type="camera"', 'type="depth"', ('type="depth"', 'type="camera"'), "sensor"),
        (' type="camera"', "", ("<sensor", '<sensor type="camera"'), "sensor"),
        ("<rate>30</rate>\n", "", ("", "\n<rate>30</rate>"), "sensor"),
        ("<width>640</width>", "", ("", "<width>640</width>"), "sensor"),
        (
            "<camera><image><width>640</width></image></camera>",
            "",
            ("", "<camera><image><width>640</width></image></camera>"),
            "sensor",
        ),
        (
            'reference="camera_link"',
            'reference="camera"',
            ('reference="camera"', 'reference="camera_link"'),
            "sensor",
        ),
        (SENSOR, "", ("", SENSOR), "sensor"),
        ('<command name="velocity"/>', "", ("", '<command name="velocity"/>'), "control"),
        ('"velocity"', '"effort"', ('name="effort"', 'name="velocity"'), "control"),
    ],
)
def test_a_mistake_is_undone(
    tmp_path: Path, old: str, new: str, edit: tuple[str, str], criterion: str
) -> None:
    """The hint changes exactly what is wrong, and is verified."""
    assert ROBOT.count(old) == 1
    (hint,) = hints_of(tmp_path, ROBOT.replace(old, new))
    assert hint["verified"]
    assert hint["gains"] == {criterion: 2}
    (found,) = hint["edits"]
    assert found["old"].strip() == edit[0]
    assert "".join(edit[1].split()) in "".join(found["new"].split())  # however it is indented


def test_no_text_is_written_into_an_empty_element(tmp_path: Path) -> None:
    """There is none to replace."""
    assert hints_of(tmp_path, ROBOT.replace("<rate>30</rate>", "<rate/>")) == []


def test_several_values_are_corrected_together(tmp_path: Path) -> None:
    """One hint corrects all values that a criterion needs."""
    (hint,) = hints_of(tmp_path, ROBOT.replace("<rate>30<", "<rate>5<").replace("640", "320"))
    assert [(found["old"], found["new"]) for found in hint["edits"]] == [
        ("5", "30"),
        ("320", "640"),
    ]


def test_no_second_sensor_is_added(tmp_path: Path) -> None:
    """A sensor at another link, with another rate, is corrected where it is."""
    robot = ROBOT.replace('reference="camera_link"', 'reference="base"').replace(
        "<rate>30<", "<rate>10<"
    )
    (hint,) = hints_of(tmp_path, robot)
    assert [found["new"] for found in hint["edits"]] == ['reference="camera_link"', "30"]


def test_xacro_is_edited_where_it_is_written(tmp_path: Path) -> None:
    """The value of an attribute is changed in the property that it comes from; an expression is left to words."""
    robot = XACRO.replace('type="camera"', 'type="${kind}"').replace(
        '<link name="base"/>', '<link name="base"/>\n<xacro:property name="kind" value="depth"/>'
    )
    (hint,) = hints_of(tmp_path, robot, "robot.urdf.xacro")
    assert "camera" in hint["edits"][0]["new"]
    other = tmp_path / "other"
    other.mkdir()
    (hint,) = hints_of(other, XACRO.replace(">30<", ">${2 * 5}<"), "robot.urdf.xacro")
    assert hint["message"] == "Correct the expression in `${2 * 5}` (line 7) so that it gives `30`."
    assert not hint["edits"]
