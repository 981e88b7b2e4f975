"""package.xml compared with catkin_pkg, by which colcon and ros2 decide what is a package of ROS 2."""

import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.ros.installation.manifest import read_manifest
from grader.ros.installation.manifest_conditions import evaluate_condition
from tests.examples import examples
from tests.oracles.example_robots import MISSING

pytestmark = [
    pytest.mark.exhaustive,
    pytest.mark.filterwarnings("ignore::DeprecationWarning"),
]  # of pyparsing

condition: Any = pytest.importorskip("catkin_pkg.condition", reason=MISSING)
package: Any = pytest.importorskip("catkin_pkg.package", reason=MISSING)

JAZZY = {"ROS_VERSION": "2", "ROS_DISTRO": "jazzy", "ROS_PYTHON_VERSION": "3"}
# What catkin_pkg adds to an error that is listed already, and the details that it words in another way.
CONSEQUENCES = (
    "Error(s)",
    "Maintainers must have an email address",
    "Please replace",
    "Either update to a newer",
    "Package name must not be empty",
)
WORDS = {
    "Package '": "must declare at least one maintainer",
    'The package "': "with the same name as this package",
    'The manifest of package "': "must not contain the following tags",
    "The manifest contains invalid XML": "package.xml is not readable as XML",
    'The manifest must contain a single "package" root tag': "the root of package.xml is",
}
LINES = (
    "<name>my_robot</name>",
    "<version>0.0.0</version>",
    "<description>TODO: Package description</description>",
    '<maintainer email="user@todo.todo">user</maintainer>',
    "<license>TODO: License declaration</license>",
    "<exec_depend>rclpy</exec_depend>",
    "<test_depend>python3-pytest</test_depend>",
    "<export><build_type>ament_python</build_type></export>",
)
OTHERS = (
    "<name>rover_2</name>",
    "<name>My-Robot</name>",
    "<name>my robot</name>",
    "<name/>",
    "<name>_x</name>",
    "<name>my_robot<b/></name>",
    "<version>1.0</version>",
    "<version>01.0.0</version>",
    "<version/>",
    "<version> 1.2.3 </version>",
    '<version compatibility="1.0">1.0.0</version>',
    "<version>1.0.0-1</version>",
    "<description/>",
    "<description><b>a</b></description>",
    "<maintainer>me</maintainer>",
    '<maintainer email="">me</maintainer>',
    '<maintainer email="me">me</maintainer>',
    '<maintainer email="me@host">me</maintainer>',
    '<maintainer email="me.you+1@a-b.example.org"/>',
    '<maintainer mail="a@b.org">me</maintainer>',
    '<maintainer email="mé@example.org">me</maintainer>',
    '<maintainer email=" me@example.org">me</maintainer>',
    '<author email="you">you</author>',
    "<author>you</author>",
    "<license/>",
    '<license file="LICENSE">MIT</license>',
    "<licence>MIT</licence>",
    "<depend>rclpy</depend>",
    '<depend version_gte="1.0.0">rclpy</depend>',
    "<build_depend>rclpy</build_depend>",
    "<exec_depend>my_robot</exec_depend>",
    "<run_depend>rclpy</run_depend>",
    "<depends>rclpy</depends>",
    "<depend>my_robot</depend>",
    '<depend version="2">rclpy</depend>',
    "<test_depend>rclpy</test_depend>",
    "<doc_depend>doxygen</doc_depend>",
    "<buildtool_depend>ament_cmake</buildtool_depend>",
    '<depend condition="$ROS_VERSION == 1">roscpp</depend>',
    '<depend condition="$ROS_VERSION = 1">roscpp</depend>',
    "<group_depend>a</group_depend>",
    "<member_of_group>a</member_of_group>",
    "<conflict>my_robot</conflict>",
    "<url>https://a</url>",
    '<url type="website" x="1">https://a</url>',
    "<build_type>ament_python</build_type>",
    "<export/>",
    "<export>text<a/></export>",
    '<export><build_type condition="$ROS_VERSION == 2">ament_python</build_type></export>',
    '<export x="1"/>',
    "text",
    "<!-- <name>a</name> -->",
    "<depend>rclpy<depend>",
    "</package>",
    "<name>a</nam>",
    "&amp;",
    "&nbsp;",
    "<a:b/>",
    '<a:b xmlns:a="urn:a"/>',
    '<name xmlns="urn:a">rover</name>',
)
ROOTS = (
    *['<package format="3">'] * 6,
    '<package format="2">',
    "<package>",
    '<package format="1">',
    '<package format="4">',
    '<package format="three">',
    '<package format="3" name="my_robot">',
    '<package xmlns="urn:a" format="3">',
    "<robot>",
)


@st.composite
def manifests(draw: st.DrawFn) -> str:
    """Return a package.xml as ros2 pkg create writes it, without some lines, or with lines added or repeated."""
    lines = [line for line in LINES if draw(st.integers(0, 11)) > 0]
    for other in draw(st.lists(st.sampled_from((*OTHERS, *LINES)), max_size=3)):
        lines.insert(draw(st.integers(0, len(lines))), other)
    root = draw(st.sampled_from(ROOTS))
    return '<?xml version="1.0"?>\n' + "\n".join(
        [root, *lines, f"</{root[1:].split()[0].rstrip('>')}>"]
    )


@given(text=manifests())
@examples(1_500)
def test_package_xml_is_refused_where_catkin_pkg_refuses_it(
    text: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """A package.xml is refused exactly where catkin_pkg raises, for the same reasons; else the build type is the same."""
    _compare(text.encode(), tmp_path_factory.mktemp("manifest"))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"name: my_robot",
        b"\xef\xbb\xbf<package/>",
        "<package>\xe9</package>".encode("latin-1"),
        "<package/>".encode("utf-16"),
    ],
)
def test_other_files_are_refused(data: bytes, tmp_path: Path) -> None:
    """What is no XML, or no UTF-8 text, is refused as well."""
    _compare(data, tmp_path)


def _compare(data: bytes, folder: Path) -> None:
    found = read_manifest(data, "package.xml")
    words = "\n".join(problem.message for problem in found.refusals)
    path = folder / "package.xml"
    path.write_bytes(data)
    try:
        expected = package.parse_package(str(path), warnings=[])
        expected.evaluate_conditions(JAZZY)
    except package.InvalidPackage as error:
        lines = [line.removeprefix("- ") for line in error.msg.splitlines()]
        lines = [
            re.sub(r"\b(\w+)(, \1)+", r"\1", line)
            for line in lines
            if not line.startswith(CONSEQUENCES)
        ]
        for line in lines[:1] if "invalid XML" in error.msg else lines:
            assert (
                next((text for start, text in WORDS.items() if line.startswith(start)), line)
                in words
            )
        assert words
    except (
        AssertionError,
        ValueError,
    ):  # another format, a condition that is not valid, a file that is not UTF-8
        assert words
    else:
        assert not words
        assert (found.name, found.build_type) == (expected.name, expected.get_build_type())


def terms() -> st.SearchStrategy[str]:
    """Return what conditions compare."""
    return st.sampled_from(
        [
            "$ROS_VERSION",
            "$ROS_DISTRO",
            "$NOT_SET",
            "1",
            "2",
            '"2"',
            "'jazzy'",
            "humble",
            "''",
            "and",
            "$",
            "a b",
            "True",
        ]
    )


@st.composite
def conditions(draw: st.DrawFn) -> str:
    """Return a condition, valid or not."""
    parts = []
    for index in range(draw(st.integers(1, 4))):
        operator = draw(st.sampled_from(["==", "!=", "<", ">", "<=", ">=", "=", ""]))
        parts += [draw(st.sampled_from([" and ", " or ", "and", " "]))] if index else []
        parts += ["("] * draw(st.integers(0, 1))
        parts += [
            draw(terms()),
            draw(st.sampled_from(["", " "])),
            operator,
            draw(st.sampled_from(["", " "])),
            draw(terms()),
        ]
        parts += [")"] * draw(st.integers(0, 1))
    return "".join(parts)


@given(text=conditions())
@examples(1_500)
def test_conditions_hold_where_they_hold_for_catkin_pkg(text: str) -> None:
    """A condition has the value that catkin_pkg gives it, and is refused where it raises."""
    try:
        expected = condition.evaluate_condition(text, JAZZY)
    except ValueError:
        expected = None
    assert evaluate_condition(text) == expected
