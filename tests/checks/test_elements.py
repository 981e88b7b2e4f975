"""The check of an XML element: which one is found, how its values are compared, and what is said of a wrong one."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from grader.checks.elements import element_present
from grader.checks.outcome import Outcome
from grader.errors import MissingElement, NotDecided
from tests.checks.cases import with_camera
from tests.checks.outcomes import ask, graded, missing
from tests.checks.robots import ARM, Scene, link, scene
from tests.checks.submissions import REFERENCE, URDF, Submitted
from tests.command_line import run

CONTROL = """\
<ros2_control name="arm" type="system">
<hardware><plugin>gazebo_ros2_control/GazeboSystem</plugin></hardware>
<joint name="joint_1">
<command_interface name="velocity"/>
<command_interface name="position"><param name="min">-1</param></command_interface>
<state_interface name="position"/>
</joint>
<joint name="joint_2"><command_interface name="effort"/></joint>
</ros2_control>"""


def found(inside: str, **arguments: Any) -> Outcome:
    """Return the outcome for a robot with this content; default: the tag is <gazebo>."""
    return ask(element_present, scene(link("base"), inside), **{"tag": "gazebo", **arguments})


def in_gazebo(inside: str, values: Mapping[str, Any], **arguments: Any) -> Outcome:
    """Return the outcome for the content of a <gazebo> and its values."""
    return found(f"<gazebo>\n{inside}\n</gazebo>", values=values, **arguments)


# --- How values are compared ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "value", "is_equal"),
    [
        ("30", 30.0, True), ("30.0", 30.0, True), ("3e1", 30.0, True), (" +30. ", "30", True), ("31", 30.0, False),
        ("30", "3e1", True), ("", 30.0, False), ("thirty", 30.0, False), ("30 Hz", 30.0, False), ("nan", 30.0, False),
        ("3_0", 30.0, False), ("0 0 .1", "0 0.0 0.1", True), ("0\n0   0.1", "0 0 0.1", True), ("0 0", "0 0 0", False),
        ("0 0 0.2", "0 0 0.1", False), ("true", True, True), ("1", True, True), ("True", True, True), ("0", True, False),
        ("false", False, True), ("0", False, True), ("1", "true", True), ("true", 1.0, True), ("yes", True, False),
        ("false", True, False), ("true", "false", False), ("a", "a", True), ("A", "a", False), ("a  b", "a b", True),
        ("1e400", 30.0, False),
    ],
)  # fmt: skip
def test_values(text: str, value: str | float | bool, is_equal: bool) -> None:
    """Numbers and lists of numbers are compared as numbers, booleans as SDF reads them, all else as text."""
    by_text, by_attribute = in_gazebo(f"<a>{text}</a>", {"a": value}), in_gazebo(f'<a b="{text}"/>', {"a/@b": value})
    assert {by_text.status, by_attribute.status} == {"passed" if is_equal else "failed"}


def test_the_tolerance_is_absolute() -> None:
    """It holds for each number of a list, and never makes false true."""
    assert in_gazebo("<a>1.4 2.6</a>", {"a": "1 3"}, tolerance=0.4).status == "passed"
    assert in_gazebo("<a>1.4 2.5</a>", {"a": "1 3"}, tolerance=0.4).status == "failed"
    assert in_gazebo("<a>false</a>", {"a": True}, tolerance=2.0).status == "failed"
    assert in_gazebo("<a>1.0000009</a>", {"a": 1.0}).status == "passed"
    assert in_gazebo("<a>1.000002</a>", {"a": 1.0}).status == "failed"


def test_repeated_elements() -> None:
    """One of several has a value; each value of a list is had by a different one, in any order."""
    arguments = {"tag": "ros2_control", "path": "joint"}
    every: tuple[tuple[dict[str, Any], str], ...] = (
        ({"@name": "joint_1", "command_interface/@name": ["position", "velocity"]}, "passed"),
        ({"@name": "joint_1", "command_interface/@name": "velocity"}, "passed"),
        ({"@name": "joint_1", "command_interface/@name": ["position", "position"]}, "failed"),
        ({"@name": "joint_1", "command_interface/@name": ["position", "effort"]}, "failed"),
        ({"@name": "joint_1", "state_interface/@name": ["position", "velocity"]}, "failed"),
        ({"command_interface/param": -1.0}, "passed"),
    )
    for values, status in every:
        assert found(CONTROL, **arguments, values=values).status == status, values
    near = "<a>1.0</a><a>1.4</a>"
    assert in_gazebo(near, {"a": [1.3, 1.0]}, tolerance=0.35).status == "passed"
    assert in_gazebo(near, {"a": [1.0, 1.3]}, tolerance=0.35).status == "passed"


def test_one_element_has_all_values() -> None:
    """Values of two elements do not add up; the best one is described, at its place."""
    outcome = found(
        CONTROL, tag="ros2_control", path="joint", values={"@name": "joint_2", "command_interface/@name": "position"}
    )
    assert outcome.status == "failed"
    assert (
        outcome.message == "<joint> in <ros2_control>: 'command_interface/@name' is 'effort'; it should be 'position'"
    )
    lists = "<a><b>1</b><c>2</c></a><a><b>1</b><c>1</c><d>4</d></a>"
    message = in_gazebo(lists, {"b": 1.0, "c": 3.0, "d": 4.0}, path="a").message
    assert message == "<a> in <gazebo>: 'c' is 1; it should be 3"


def test_the_sibling_with_the_identifying_attribute_is_described() -> None:
    """The message describes the element with the identifying attribute; if none has it, the message lists the attributes of all."""
    arguments: dict[str, Any] = {"tag": "ros2_control", "path": "joint"}
    wanted = {"command_interface/@name": "position", "state_interface/@name": "position"}
    message = found(CONTROL, **arguments, values={"@name": "joint_2", **wanted}).message
    assert message.startswith(
        "<joint> in <ros2_control>: 'command_interface/@name' is 'effort'; it should be 'position'; "
    )
    message = found(CONTROL, **arguments, values={"@name": "Joint_2", **wanted}).message
    assert message == (
        "no <joint> in <ros2_control> has the '@name' 'Joint_2'; the file has 'joint_1' and 'joint_2'"
        " (upper and lower case differ)"
    )
    sensors = '<sensor type="ray"><rate>30</rate></sensor><sensor type="camera"><rate>10</rate></sensor>'
    message = in_gazebo(sensors, {"@type": "camera", "rate": 30.0}, path="sensor").message
    assert message == "<sensor> in <gazebo>: 'rate' is 10; it should be 30"


DROPPED = {"tag": "link", "attributes": {"name": "a"}}


@pytest.mark.parametrize(
    ("inside", "arguments", "status"),
    [
        ('<inertial><mass value="x"/></inertial>{ball}', {"path": "collision"}, "failed"),
        ('<inertial><mass value="x"/></inertial>{ball}', {"path": "collision/geometry/sphere"}, "failed"),
        ('<inertial><mass value="x"/></inertial>{ball}', {"values": {"collision/geometry/sphere/@radius": 1.0}}, "failed"),
        ('<inertial><mass value="x"/></inertial>{ball}', {"path": "inertial/mass"}, "failed"),
        ('<inertial><mass value="x"/></inertial>{ball}', {}, "passed"),
        ("<collision><geometry><box/></geometry></collision>{ball}", {"path": "collision/geometry/sphere"}, "failed"),
        ("{ball}<collision><geometry><box/></geometry></collision>", {"path": "collision/geometry/sphere"}, "passed"),
        ("{ball}", {"path": "collision/geometry/sphere"}, "passed"),
    ],
)  # fmt: skip
def test_what_ros_2_drops_of_a_link_is_not_there(inside: str, arguments: dict[str, Any], status: str) -> None:
    """An invalid inertial drops the collisions of its link, an invalid collision those after it; the message says so."""
    ball = '<collision><geometry><sphere radius="1"/></geometry></collision>'
    robot = scene(link("base"), f'<link name="a">{inside.format(ball=ball)}</link>')
    outcome = graded(element_present, robot, **DROPPED, **arguments)
    assert outcome.status == status
    assert ("ROS 2 drops " in outcome.message) == (status == "failed")
    if status == "failed":
        assert outcome.problem in outcome.message and "link 'a'" in outcome.problem


# --- Which element is found -------------------------------------------------------------------------------------------


def test_any_element_of_a_robot() -> None:
    """The tag can be that of a link, a joint, a material or a transmission; without a path it is examined itself."""
    robot = with_camera()
    every: tuple[dict[str, Any], ...] = (
        {
            "tag": "link",
            "attributes": {"name": "base"},
            "path": "visual/geometry/box",
            "values": {"@size": "0.6 .4 0.2"},
        },
        {"tag": "link", "values": {"@name": "base", "visual/geometry/box/@size": "0.6 0.4 0.2"}},
        {"tag": "joint", "attributes": {"type": "fixed"}, "values": {"child/@link": "camera"}},
        {"tag": "gazebo"},
        {"tag": "gazebo", "path": "sensor/camera/image", "values": {"width": 640.0}},
        {"tag": "gazebo", "path": "sensor/update_rate", "values": {".": 30.0}},
    )
    for arguments in every:
        outcome = ask(element_present, robot, **arguments)
        assert outcome.status == "passed", outcome


def test_a_file_without_elements() -> None:
    """What is no XML misses the robot; xacro that cannot be expanded at all needs manual grading."""
    empty = Scene("nothing").submission
    with pytest.raises(MissingElement, match="the file is not well-formed XML, so it has no elements"):
        element_present(ARM.robot, empty, tag="gazebo")
    entities = (
        '<!DOCTYPE r [<!ENTITY e "a">]>\n<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">${1}</robot>'
    )
    open_ = REFERENCE.with_files({URDF: entities}).renaming(URDF, f"{URDF}.xacro")
    outcome = graded(element_present, open_, tag="gazebo")
    assert (outcome.status, "entities of a DOCTYPE are not supported" in outcome.message) == ("pending", True)
    with pytest.raises(NotDecided, match="entities of a DOCTYPE are not supported"):
        element_present(ARM.robot, open_.submission, tag="gazebo")


def test_what_is_missing_is_said_with_a_suggestion() -> None:
    """A missing tag, attribute, path or value is named, with what is there."""
    robot = with_camera()

    def message(**arguments: Any) -> str:
        outcome = ask(element_present, robot, **arguments)
        assert outcome.status == "failed"
        return outcome.message

    assert message(tag="gazbo") == "there is no <gazbo> directly in <robot>; did you mean 'gazebo'?"
    assert message(tag="sensor") == "there is no <sensor> directly in <robot>; there is one in <gazebo>"
    assert message(tag="gazebo", attributes={"reference": "lidar"}) == (
        'there is no <gazebo reference="lidar">; the file has <gazebo reference="camera">'
    )
    assert message(tag="gazebo", attributes={"reference": "Camera"}).endswith("(upper and lower case differ)")
    assert message(tag="gazebo", attributes={"reference": "camra"}).endswith("; did you mean 'camera'?")
    assert message(tag="gazebo", attributes={"name": "x"}).endswith("; the file has <gazebo>")
    assert message(tag="gazebo", path="sensor/ray") == "there is no <sensor><ray> in <gazebo>"
    assert message(tag="gazebo", path="senser/ray").endswith("; did you mean 'sensor'?")
    assert message(tag="gazebo", path="sensor", values={"topic": "image", "@type": "Camera", "update_rate": 5.0}) == (
        "<sensor> in <gazebo>: 'topic' is missing; it should be 'image'; "
        "'@type' is 'camera'; it should be 'Camera' (upper and lower case differ); 'update_rate' is 30; it should be 5"
    )


def test_the_place_is_that_of_the_value() -> None:
    """A wrong attribute is pointed at, a missing value at the element that should have it."""
    robot = with_camera(kind="depth")
    for values, at in (
        ({"@type": "camera"}, 'type="depth"'),
        ({"topic": "image"}, "<sensor"),
        ({"update_rate": 1.0}, "<update_rate>"),
    ):
        outcome = graded(element_present, robot, tag="gazebo", path="sensor", values=values)
        assert outcome.location == robot.location_of(at)


def test_comments_and_text_around_do_not_count() -> None:
    """An element in a comment is not there; a comment in a text does not split it; CDATA is text."""
    assert found("<!-- <gazebo><a>1</a></gazebo> -->").status == "failed"
    assert in_gazebo("<a>3<!-- not 4 -->0</a>", {"a": 30.0}).status == "passed"
    assert in_gazebo("<a><![CDATA[30]]></a>", {"a": 30.0}).status == "passed"


@pytest.mark.parametrize("declared", [True, False])
@pytest.mark.parametrize("start", ["", "\n\n<!-- before -->"])
def test_prefixes_are_as_written(declared: bool, start: str) -> None:
    """A name with a prefix is found whether the prefix is declared or not, and whether the text is strict XML or not."""
    xmlns = ' xmlns:gz="http://gazebosim.org/schema"' if declared else ""
    text = f'<?xml version="1.0"?>{start}<robot name="r"{xmlns}>\n<link name="a"/>\n<gazebo><gz:plugin name="p"><gz:rate>5 &amp; 6</gz:rate></gz:plugin></gazebo>\n</robot>'
    for path, status in (("gz:plugin", "passed"), ("plugin", "failed")):
        outcome = ask(element_present, Scene(text), tag="gazebo", path=path, values={"@name": "p", "gz:rate": "5 & 6"})
        assert outcome.status == status, outcome


def test_a_text_that_is_no_strict_xml_keeps_its_values() -> None:
    """What only TinyXML2 reads has the same texts, at the same places."""
    robot = with_camera()
    loose = Scene(
        "\n" + robot.text.replace("<robot", '<?xml version="1.0"?>\n<robot').replace("<sensor ", "<sensor  a='x\ny' ")
    )
    arguments: dict[str, Any] = {
        "tag": "gazebo",
        "path": "sensor",
        "values": {"update_rate": 30.0, "camera/image/width": 640.0},
    }
    assert ask(element_present, loose, **arguments).status == "passed"
    outcome = graded(element_present, loose, tag="gazebo", path="sensor", values={"update_rate": 5.0})
    assert outcome.location == loose.location_of("<update_rate>")


# --- xacro ------------------------------------------------------------------------------------------------------------

ROBOT = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">\n<link name="base"/>\n{}\n</robot>\n'


def in_xacro(inside: str) -> Submitted:
    """Return a submission whose URDF is xacro with this content."""
    return REFERENCE.without(URDF).with_files({f"{URDF}.xacro": ROBOT.format(inside)})


def test_xacro_is_expanded() -> None:
    """Values, attributes and prefixes are those of the expanded text; $(find package) stays readable."""
    submitted = in_xacro(
        '<xacro:property name="rate" value="15"/>\n<xacro:macro name="camera" params="on">\n<gazebo reference="${on}">'
        "<gz:plugin><rate>${2 * rate}</rate><file>$(find my_robot)/config/arm.yaml</file></gz:plugin></gazebo>\n"
        '</xacro:macro>\n<xacro:camera on="base"/>'
    )
    submitted = submitted.replacing(f"{URDF}.xacro", "<robot ", '<robot xmlns:gz="http://gazebosim.org/schema" ')
    arguments: dict[str, Any] = {"tag": "gazebo", "attributes": {"reference": "base"}, "path": "gz:plugin"}
    values = {"rate": 30.0, "file": "$(find my_robot)/config/arm.yaml"}
    assert ask(element_present, submitted, **arguments, values=values).status == "passed"
    outcome = graded(element_present, submitted, **arguments, values={"rate": 10.0, "file": "x"})
    assert "'rate' is 30; it should be 10; 'file' is '$(find my_robot)/config/arm.yaml'" in outcome.message
    assert outcome.location is not None
    assert (outcome.location.path, outcome.location.line) == (f"{URDF}.xacro", 5)


@pytest.mark.parametrize(
    ("inside", "status"),
    [
        ("<gazebo><rate>$(env RATE)</rate></gazebo>", "pending"),
        ('<gazebo reference="$(env LINK)"><rate>5</rate></gazebo>', "pending"),
        ('<xacro:if value="$(env ON)"><gazebo reference="base"><rate>5</rate></gazebo></xacro:if>', "pending"),
        ('<gazebo reference="base"><rate>7</rate></gazebo>', "failed"),
        ('<gazebo reference="other"><rate>$(env RATE)</rate></gazebo>', "failed"),
        ('<gazebo reference="base"><rate>5</rate><topic>$(env RATE)</topic></gazebo>', "passed"),
        ('<gazebo reference="base"><rate>${undefined}</rate></gazebo>', "failed"),
    ],
)
def test_what_xacro_leaves_open_is_pending(inside: str, status: str) -> None:
    """Only what may still be the element is open; what is certainly there, or certainly wrong, is decided."""
    submitted = in_xacro(inside.replace("<gazebo>", '<gazebo reference="base">'))
    outcome = graded(element_present, submitted, tag="gazebo", attributes={"reference": "base"}, values={"rate": 5.0})
    assert outcome.status == status, outcome


def test_without_a_robot_it_is_missed() -> None:
    """A file that is not read has no elements."""
    assert missing(element_present, REFERENCE.without(URDF), tag="gazebo").kind == "URDF"
    assert graded(element_present, Scene("<robot"), tag="gazebo").status == "failed"


# --- The rubric -------------------------------------------------------------------------------------------------------

RUBRIC = """\
id = "r"
title = "R"
[[part]]
id = "a"
title = "A"
[[criterion]]
id = "c"
part = "a"
title = "Camera"
points = 1
check = "element_present"
with = {{ tag = "gazebo", attributes = {{ reference = "@tip" }}, path = "sensor", values = {} }}
"""


@pytest.mark.parametrize(
    ("values", "code"),
    [
        ('{ "@type" = "camera", update_rate = 30, always_on = true, "camera/image/width" = [640] }', 0),
        ('{ "@type" = "lidar" }', 1),
        ("{ update_rate = { a = 1 } }", 2),
        ("{ update_rate = [[1]] }", 2),
        ("{ update_rate = [] }", 2),
        ("5", 2),
    ],
)
def test_values_in_a_rubric(tmp_path: Path, values: str, code: int) -> None:
    """Strings, numbers, booleans and lists of these are values, anything else is a mistake of the rubric; selectors work."""
    (tmp_path / "rubric.toml").write_text(RUBRIC.format(values))
    (tmp_path / "robot.urdf").write_text(with_camera().text)
    done = run(("grade", tmp_path / "robot.urdf", "--rubric", tmp_path / "rubric.toml"))
    assert done.returncode == code, done
    if code == 2:
        expected = b"must be a table of strings, numbers, booleans or lists of these, not"
        assert expected in done.stderr
