"""The fixes of a robot's problems: each writes the text that was meant."""

import pytest

from grader.base.element_edits import edited
from grader.base.source import Edits
from grader.files.tree import make_tree, overlaid
from grader.workspace.api import read_workspace

_PATH = "arm.urdf"
_PLAIN = """\
<robot name="arm">
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="tool"><visual><material name="grey"><color rgba="1 1 1 1"/></material></visual></link>
  <joint name="turn" type="fixed"><parent link="base"/><child link="tool"/></joint>
</robot>
"""
_XACRO = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="kind" value="fixed"/>
  <xacro:property name="width" value="0.2"/>
  <xacro:macro name="part" params="name">
    <link name="${name}"><visual><geometry><box size="1 1 ${width}"/></geometry></visual></link>
  </xacro:macro>
  <xacro:part name="base"/>
  <xacro:part name="tool"/>
  <joint name="turn" type="${kind}"><parent link="base"/><child link="tool"/></joint>
</robot>
"""


def _fixes(path: str, text: str) -> dict[Edits, str]:
    """Return the edits of all fixes of the robot in a file, with what they assume."""
    tree = overlaid(make_tree("ws", (), ()), {path: text.encode()})
    [robot] = read_workspace(tree, "ws", 100_000, {}).robots
    problems = getattr(robot, "problems")  # noqa: B009  of any state of a URDF
    return {fix.edits: fix.assumption for problem in problems for fix in problem.fixes}


@pytest.mark.parametrize(
    ("path", "right", "wrong"),
    [
        (_PATH, 'type="fixed"', 'type="fixd"'),
        (_PATH, '<child link="tool"/>', '<child link="tol"/>'),
        (_PATH, '<child link="tool"/>', '<child link="&#116;ol"/>'),
        (_PATH, '<child link="tool"/>', '<child lnk="tool"/>'),
        (_PATH, '<parent link="base"/>', '<parnt link="base"/>'),
        (_PATH, 'size="1 1 1"', 'siz="1 1 1"'),
        (_PATH, 'size="1 1 1"', 'size="1, 1, 1"'),
        (_PATH, "<box ", "<bx "),
        (_PATH, 'rgba="1 1 1 1"', 'rgb="1 1 1 1"'),
        ("arm.urdf.xacro", 'value="fixed"', 'value="fixd"'),
        ("arm.urdf.xacro", "${width}", "${widht}"),
        ("arm.urdf.xacro", 'box size="', 'box siz="'),
        ("arm.urdf.xacro", '<xacro:part name="tool"', '<xacro:prt name="tool"'),
        ("arm.urdf.xacro", '<xacro:part name="tool"', '<xacro:part nam="tool"'),
    ],
)
def test_a_fix_writes_what_was_meant(path: str, right: str, wrong: str) -> None:
    """Of words that ROS 2 refuses, that it ignores, and that xacro refuses."""
    plain = _PLAIN if path == _PATH else _XACRO
    assert plain.count(right) == 1
    text = plain.replace(right, wrong)
    fixes = _fixes(path, text)
    [(edits, assumption)] = fixes.items()
    assert edited(text, path, edits) == plain
    assert assumption


@pytest.mark.parametrize(("path", "text"), [(_PATH, _PLAIN), ("arm.urdf.xacro", _XACRO)])
def test_what_is_right_has_no_fix(path: str, text: str) -> None:
    assert _fixes(path, text) == {}


def test_what_may_be_several_things_has_no_fix() -> None:
    """A link that does not exist may be either of two."""
    text = _PLAIN.replace('<child link="tool"/>', '<child link="arm"/>')
    assert _fixes(_PATH, text) == {}


def test_a_word_of_a_broken_file_has_a_fix() -> None:
    """Of a whole tag, where another one is broken."""
    text = _PLAIN.replace("</visual></link>", "</link>", 1).replace('type="fixed"', 'type="fixd"')
    [edits] = _fixes(_PATH, text)
    assert 'type="fixed"' in (edited(text, _PATH, edits) or "")
