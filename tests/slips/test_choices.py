"""What is written otherwise in a robot's files is read in one way, or not at all."""

from collections.abc import Mapping

import pytest

from grader.base.slips import Slip
from grader.lab.submission.edited import with_files
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read, read_as_ros
from grader.ros.package.robot_readings import RobotReadings
from grader.ros.python.budget import Budget
from tests.grading.slips import DIFFDRIVE
from tests.samples import LAB6, reference

pytestmark = pytest.mark.slow

_LINKS = '<link name="a"/><link name="b"/>'
_ENDS = '<parent link="a"/><child link="b"/>'
_JOINT = f'<joint name="j" type="fixed">{_ENDS}</joint>'


def _proven(submission: Submission) -> list[Slip]:
    """Return the slips of a submission's robot that are proven."""
    if not isinstance(submission.urdf, Read):
        return []
    return RobotReadings(submission.urdf, submission.surroundings(Budget())).find_slips()


def _assumed(text: str, path: str = "my_robot.urdf") -> list[str]:
    """Return what is assumed of a robot, which is a file alone."""
    solution = reference(LAB6)
    files: dict[str, bytes | None] = dict.fromkeys(solution.whole_tree.files)
    submission = with_files(solution, {**files, path: text.encode()})
    return [slip.assumption for slip in _proven(submission)]


def _robot(body: str) -> str:
    return f'<robot name="r">{body}</robot>'


def _shown(shape: str) -> str:
    return f'<link name="a"><visual>{shape}</visual></link>'


def _xacro(body: str) -> str:
    return f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{body}</robot>'


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (f"{_LINKS}{_JOINT}", []),
        (f'{_LINKS}<joint name="j" type="fixed"><parent link="a"/><child>b</child></joint>', ["'b' in <child> is read as link=\"b\""]),
        (f'{_LINKS}<joint name="j" type="fixed"><parent link="a"/><child>a b</child></joint>', []),
        (f'{_LINKS}<joint name="j" type="fixed"><parent link="a"/><child><link name="b"/></child></joint>', ["'b' in <child> is read as link=\"b\""]),
        (f'{_LINKS}<joint name="j"><type>fixed</type>{_ENDS}</joint>', ["'fixed' in <joint> is read as type=\"fixed\""]),
        (f'{_LINKS}<joint name="j" type="fixed">{_ENDS}<origin>0 0 1</origin></joint>', []),
        (f'{_LINKS}<joint name="j" type="fixed">{_ENDS}<origin>0 0 1 a b c</origin></joint>', []),
        (f'{_LINKS}<joint name="j" type="fixed">{_ENDS}<origin>0 0 1 0 0 0</origin></joint>', ["'0 0 1 0 0 0' in <origin> is read as xyz=\"0 0 1\" rpy=\"0 0 0\""]),
        (f'{_LINKS}<joint name="j" type="fixed">{_ENDS}<origin><xyz value="0 0 1"/></origin></joint>', ["'0 0 1' in <origin> is read as xyz=\"0 0 1\""]),
        (f'{_LINKS}<joint name="j" type="fixed">{_ENDS}<origin>xyz="0 0 1"</origin></joint>', ["'0 0 1' in <origin> is read as xyz=\"0 0 1\""]),
        (f'{_LINKS}<joint name="j" type="fixed">{_ENDS}<origin>xyz="0 1"</origin></joint>', []),
        (f'{_LINKS}<joint name="j" type="fixed">{_ENDS}<origin>xyz = 0 =</origin></joint>', []),
        (_shown("<geometry><box>1 2 3</box></geometry>"), ["'1 2 3' in <box> is read as size=\"1 2 3\""]),
        (_shown("<geometry><box>1 2</box></geometry>"), []),
        (_shown("<geometry><box>1 2 three</box></geometry>"), []),
        (_shown("<geometry><cylinder>1 2</cylinder></geometry>"), []),
        (_shown('<geometry><cube size="1 2 3"/></geometry>'), ["<cube> is read as <box>"]),
        (_shown('<geometry><cube size="1"/></geometry>'), []),
        (_shown('<geometry><cube edge="1"/></geometry>'), []),
        (_shown('<geometry><plane size="1 2 3"/></geometry>'), []),
        (_shown('<geometry><cone radius="1" length="2"/></geometry>'), []),
        (_shown('<geometry><tube radius="1" length="2"/></geometry>'), ["<tube> is read as <cylinder>"]),
        (_shown('<box size="1 2 3"/>'), ["<box> is read inside of <geometry>"]),
        (_shown('<box size="1 2 3"/><sphere radius="1"/>'), []),
        (_shown('<box size="1 2 3"/><geometry><sphere radius="1"/></geometry>'), []),
        (_shown('<geometry><origin xyz="0 0 1"/><box size="1 2 3"/></geometry>'), ["<origin> is read beside <geometry>"]),
        (_shown('<origin/><geometry><origin xyz="0 0 1"/><box size="1 2 3"/></geometry>'), []),
        (_shown('<geometry><limit/><box size="1 2 3"/></geometry>'), []),
        (f'{_LINKS}<joint name="j" type="fixed"><parent link="a" child="b"/></joint>', ["the parent is read as 'a' and the child as 'b'"]),
        (f'{_LINKS}<joint name="j" type="fixed"><child link="b" parent="a"/></joint>', ["the parent is read as 'a' and the child as 'b'"]),
        (f'{_LINKS}<joint name="j" type="fixed"><ends parent="a" child="b"/></joint>', ["the parent is read as 'a' and the child as 'b'"]),
        (f'{_LINKS}<joint name="j" type="fixed"><parent link="a" child="b"/><child link="c"/></joint>', []),
        (f'{_LINKS}<joint name="j" type="fixed" parent="a" child="b"/>', ["the attributes parent and child of <joint> are read as elements"]),
        (f'{_LINKS}joint name="j" type="fixed">{_ENDS}</joint>', ['joint name="j" type="fixed"> is read as <joint name="j" type="fixed">']),
        (f'{_LINKS} mesh name="j"> text </robot>', []),
        (f'{_LINKS}{_JOINT} note name="j"> text', []),
        (f'<link name="a"/></robot><link name="b"/>{_JOINT}', ["</robot> in line 1 is ignored"]),
        (f'{_LINKS}</robot><link name="b"/>{_JOINT}', []),
        (f"{_LINKS}{_JOINT}</robot><!-- nothing -->", []),
    ],
)  # fmt: skip
def test_a_urdf(body: str, expected: list[str]) -> None:
    """An element of another form is read only if the form of a URDF is the only other one."""
    assert _assumed(_robot(body)) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('<Robot name="r"><link name="a"/></Robot>', ["<Robot> is read as <robot>"]),
        ('<Robot name="r"><link name="a"/>', []),
        ('<roboter name="r"><link name="a"/></roboter>', ["<roboter> is read as <robot>"]),
        ('<model name="r"><link name="a"/></model>', []),
        ("", []),
        (
            '<!DOCTYPE robot [<!ENTITY a "b">]><Robot name="r"><link name="a"/></Robot>',
            ["<Robot> is read as <robot>"],
        ),
    ],
)
def test_a_root(text: str, expected: list[str]) -> None:
    """A root is read as <robot> if its word can be no other one."""
    assert _assumed(text) == expected


_MACRO = '<xacro:macro name="m" params="n"><link name="${n}"/></xacro:macro>'


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<xacro:macro name="m" params="n"><link name="${n}"/><xacro:m n="a"/>', ["the macro m ends after line 1"]),
        # The second link is of the macro or of the robot: both are read, as different robots.
        ('<xacro:macro name="m" params="n"><link name="a"/><material name="x"><color rgba="1 1 1 1"/></material>', []),
        ('<xacro:macro params="n"><link name="${n}"/>', []),
        ('<xacro:macro name="m" params="n"><xacro:macro name="o" params="n">', []),
        ('<xacro:macro name="m" params="n"><link></xacro:macro>', []),
        (_MACRO.replace("params", "param") + '<xacro:m n="a"/>', ["the attribute param of <xacro:macro> is read as params"]),
        (_MACRO.replace("params", 'what="" param') + '<xacro:m n="a"/>', ["the attribute param of <xacro:macro> is read as params"]),
        (_MACRO.replace("params", 'what="" some') + '<xacro:m n="a"/>', []),
        (_MACRO + '<xacro:m "a"/>', ['"a" is read as n="a"']),
        (_MACRO + '<xacro:m n="a" "b"/>', []),
        (_MACRO + "<xacro:m><n>a</n></xacro:m>", ['what is inside of <xacro:m> is read as n="a"']),
        (_MACRO + "<xacro:m><n>a</n><o>b</o></xacro:m>", []),
        (_MACRO + '<xacro:m n="b"><n>a</n></xacro:m>', []),
        (_MACRO + "<xacro:m><n><b/></n></xacro:m>", []),
        ('<xacro:property name="a">7</xacro:property><link name="l${a}"/>', ['what is inside of <xacro:property> is read as value="7"']),
        ('<xacro:property name="a">7<b/></xacro:property><link name="l"/>', []),
        ('<xacro:property name="a" value="7"/><link name="l{a + 1}"/>', ["l{a + 1} is read as l${a + 1}"]),
        ('<link name="l{a + 1}"/>', []),
        ('<xacro:property name="a" default="1" vale="2"/><link name="l${a}"/>', []),
        ('<xacro:property name="x" value="2"/><link name="l${2 x 3}"/>', []),
        ('<link name="l${2 x 3}"/>', ["l${2 x 3} is read as l${2 * 3}"]),
        ("<link name=\"l${'2 x 3'}\"/>", []),
        ('<link name="l$(2 / 2)"/>', ["l$(2 / 2) is read as l${2 / 2}"]),
        ('<link name="$(find"/>', []),
        ('<xacro:if value="${1 = 1}"><link name="a"/></xacro:if>', ["${1 = 1} is read as ${1 == 1}"]),
        ('<link name="l${(1 + 2"/>', []),
        ('<link name="l${1 + 2"/>', []),
        (f'<link name="a"/>{"<!-- -->" * 3}<link name="{"b" * 600}${{1 +}}"/>', []),
    ],
)  # fmt: skip
def test_xacro(body: str, expected: list[str]) -> None:
    """What xacro refuses is read only if no other way to read it gives another robot."""
    assert _assumed(_xacro(body), "my_robot.urdf.xacro") == expected


_SENSOR = '<link name="a"/><gazebo reference="a"><sensor name="s" type="imu">{}</sensor></gazebo>'


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (_SENSOR.format("<Topic>t</Topic>"), ["<Topic> is read as <topic>"]),
        (_SENSOR.format("<updateRate>t</updateRate>"), ["<updateRate> is read as <update_rate>"]),
        (_SENSOR.format("<plugin><Topic>t</Topic></plugin>"), []),
        (_SENSOR.replace("sensor", "Sensor").format(""), ["<Sensor> is read as <sensor>"]),
        (_SENSOR.replace("type", "Type").format(""), ["the attribute Type of <sensor> is read as type"]),
        (_SENSOR.replace("reference", "link").format(""), ["the attribute link of <gazebo> is read as reference"]),
        ('<link name="a"/><gazebo note="all"><Gravity>1</Gravity></gazebo>', []),
        ('<link name="a"><gazebo reference="a"/></link>', ["<gazebo> is read beside <link>"]),
        ("<gazebo><gazebo/></gazebo>", []),
    ],
)  # fmt: skip
def test_gazebo(body: str, expected: list[str]) -> None:
    """A word of SDFormat is read in another case, but not what belongs to a plugin."""
    assert _assumed(_robot(body)) == expected


def test_an_included_file() -> None:
    """A file that is included and is no XML has slips, too."""
    solution = reference(DIFFDRIVE)
    path = next(path for path in solution.whole_tree.files if path.endswith("ros2_control.xacro"))
    text = (solution.whole_tree.read(path, 1 << 20) or b"").replace(b"<robot", b"<Robot")
    changed: Mapping[str, bytes | None] = {path: text}
    slips = _proven(with_files(solution, changed))
    assert [slip.assumption for slip in slips] == ["<Robot> is read as <robot>"]


def test_an_end_tag_without_its_prefix() -> None:
    """The message says that a prefix is missing; libxml2 leaves prefixes out."""
    text = _xacro(_MACRO.replace("</xacro:macro>", "\n</macro>") + '<xacro:m n="a"/>')
    reading = read_as_ros(text.encode(), "my_robot.urdf.xacro").reading
    messages = [problem.message for problem in reading.problems]
    assert "</macro> is read as </xacro:macro>" in messages
    start = "the end tag in line 2 has not the prefix of the start tag <macro> in line 1"
    assert any(message.startswith(start) for message in messages)
