"""The words of a URDF that surely stand for others, and the words that may be several."""

import pytest

from grader.ros.package.robot_file import read_as_ros
from grader.ros.urdf.words import meant_value

pytestmark = pytest.mark.slow

_JOINT = '<link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
_MANY = " ".join(f'a{number}="1"' for number in range(60))


def _assumed(body: str, path: str = "robot.urdf") -> list[str]:
    """Return what is assumed of a robot with a link `a` and these elements in it."""
    text = f'<robot name="r" xmlns:xacro="x"><link name="a">{body}</link></robot>'
    return [slip.assumption for slip in read_as_ros(text.encode(), path).slips]


def _shown(shape: str, material: str = "") -> str:
    return f"<visual><geometry>{shape}</geometry>{material}</visual>"


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (_shown('<box size="1, 2, 3"/>'), ["size is read as '1 2 3'"]),
        (_shown('<box sise="1, 2, 3"/>'), ["the attribute sise of <box> is read as size='1 2 3'"]),
        (_shown('<boxx size="1 2 3"/>'), ["<boxx> is read as <box>"]),
        (_shown('<boxx sise="1 2 3"/>'), ["<boxx> is read as <box>", "the attribute sise of <box> is read as size"]),
        (_shown('<cylinder radius="O.1" lenght="1"/>'), ["radius is read as '0.1'", "the attribute lenght of <cylinder> is read as length"]),
        (_shown('<sphere diameter="0.1"/>'), []),
        (_shown('<box sise="1 2"/>'), []),
        (_shown('<sphere size="1 2 3"/>'), []),
        (_shown('<box size="0.22.5 1 1"/>'), []),
        (_shown('<box size="1 2"/>'), []),
        (_shown('<box x="1" y="2" z="3"/>'), []),
        (_shown('<box size="1,\n2,\n3"/>'), []),
        (_shown(f'<box size="1, 2, 3" {_MANY}/>'), []),
        (_shown('<sphere radius="1"/><boxx size="1 1 1"/>') + "<inertial/>", []),
        (_shown('<sphere radius="1"/>', '<material name="red"><color rgba="0 0.6 0"/></material>') + "<inertial/>", []),
        (_shown('<sphere radius="1"/>', '<material name=""/>') + "<inertial/>", []),
    ],
)  # fmt: skip
def test_what_is_meant(body: str, expected: list[str]) -> None:
    """A word is read as another one only if no other can be meant, and if nothing is there already."""
    assert _assumed(body) == expected


def test_another_vector() -> None:
    """An element with one vector is read with it, whatever other vector's name is written."""
    joint = _JOINT.replace("fixed", "continuous").replace("</joint>", '<axis rpy="0 0 1"/></joint>')
    text = f'<robot name="r"><link name="a"/>{joint}</robot>'
    assumed = [slip.assumption for slip in read_as_ros(text.encode(), "r.urdf").slips]
    assert assumed == ["the attribute rpy of <axis> is read as xyz"]


def test_materials() -> None:
    """A misspelt material is read as the defined one, or its definition as the name that is used."""
    red = '<material name="{}"><color rgba="1 0 0 1"/></material>'
    used = [
        _shown('<sphere radius="1"/>', f'<material name="{name}"/>')
        for name in ("redish", "redish")
    ]
    text = '<robot name="r">{}<link name="a">{}</link></robot>'
    for defined, body, expected in (
        ("reddish", used[0], ["the material 'redish' is read as 'reddish'"]),
        ("reddish", "".join(used), ["the material 'reddish' is read as 'redish'"]),
        ("blue", used[0], []),
        ("reddish", used[0].replace("redish", "${'redish'}"), []),
    ):
        plain = f'{red.format(defined)}<material name="unused"/>'
        data = text.format(plain, body).encode()
        assert [slip.assumption for slip in read_as_ros(data, "r.urdf.xacro").slips] == expected


def test_of_a_rejected_file() -> None:
    """What cannot be read hides no other words."""
    box = _shown('<box size="1, 2, 3"/>')
    for joint, expected in (
        (
            _JOINT.replace("<child link", "<chidl link"),
            ["size is read as '1 2 3'", "<chidl> is read as <child>"],
        ),
        (_JOINT.replace('"b"/></joint>', '"zzzz"/></joint>'), ["size is read as '1 2 3'"]),
    ):
        text = f'<robot name="r"><link name="a">{box}</link>{joint}</robot>'
        assert [it.assumption for it in read_as_ros(text.encode(), "r.urdf").slips] == expected
    broken = f'<robot name="r"><link name="a">{_shown("<box sise=1 2 3 />")}\n{box}</link></robot>'
    assumed = [it.assumption for it in read_as_ros(broken.encode(), "r.urdf").slips]
    assert assumed == ["size is read as '1 2 3'"]


def test_there_are_not_too_many() -> None:
    """Of very many slips, only the first are looked at: each is graded without the others."""
    boxes = "".join(_shown(f'<box size="{number}, 2, 3"/>') for number in range(30))
    assert len(_assumed(boxes)) == 20


def test_xacro() -> None:
    """Separators between expressions of xacro are slips where they are written; what a macro repeats is one."""
    text = """<robot name="r" xmlns:xacro="x"><xacro:property name="w" value="2"/>
    <xacro:macro name="part" params="n"><link name="${n}"><visual><geometry><box size="${w}, ${max(1, w)}; 3"/></geometry></visual>
    </link></xacro:macro><xacro:part n="a"/><xacro:part n="b"/><part n="c"/><part n="d" m="e"/><include filename="x" y="z"/>
    <xacro:macro name="other" params="'"/></robot>"""
    slips = read_as_ros(text.encode(), "r.urdf.xacro").slips
    assert [slip.edits[0].new for slip in slips] == ["<xacro:part", 'size="${w}  ${max(1, w)}  3"']


@pytest.mark.parametrize(
    ("text", "attribute", "meant"),
    [
        ("0,1", "radius", "0.1"),
        ("0.1 ", "radius", "0.1"),
        ("0.1 0.2", "radius", None),
        ("1", "radius", None),
        ("0,1 0,2 0,3", "xyz", "0.1 0.2 0.3"),
        ("0.1,0.2,0.3", "xyz", "0.1 0.2 0.3"),
        ("(1; 2; 3)", "xyz", "1 2 3"),
        ("l O 0", "xyz", None),
        ("1 2 3 4 5 6", "xyz", None),
        ("pi/2 0 0", "rpy", "1.57079632679 0 0"),
        ("x" * 100, "xyz", None),
        ("a.stl", "filename", None),
    ],
)
def test_numbers(text: str, attribute: str, meant: str | None) -> None:
    """How numbers are written may change, and never what they are."""
    assert meant_value(text, attribute) == meant
