"""Reading package.xml: the package's name, its build type, what is missing, and where."""

import pytest

from grader.ros.installation.manifest import Manifest, read_manifest
from tests.work import limited_work

# As ros2 pkg create writes it, filled in.
COMPLETE = """\
<?xml version="1.0"?>
<?xml-model href="http://download.ros.org/schema/package_format3.xsd" schematypens="http://www.w3.org/2001/XMLSchema"?>
<package format="3">
  <name>my_robot</name>
  <version>0.0.0</version>
  <description>A robot</description>
  <maintainer email="me@example.org">Me</maintainer>
  <license>Apache-2.0</license>

  <test_depend>python3-pytest</test_depend>

  <export>
    <build_type>ament_python</build_type>
  </export>
</package>
"""


def read(text: str) -> Manifest:
    """Return a package.xml with this text."""
    return read_manifest(text.encode(), "my_robot/package.xml")


QUOTED = (
    "the email of <maintainer> in package.xml is in quotes, as git has it: delete the inner quotes"
)
SAME = "a package with the same name as this package"
PARSED = "failed to parse: write it as $ROS_VERSION == 2"
REFUSED = "PKG002 the tools of ROS 2 refuse package.xml: "


def problems_of(found: Manifest) -> list[str]:
    """Return its problems, each with its line and column; of one that refuses the file, the reason only."""
    return [
        f"{problem.location.line}:{problem.location.column} {problem.kind.code} {problem.message}".replace(
            REFUSED, ""
        )
        for problem in found.problems
    ]


def test_a_complete_file() -> None:
    """Name and build type have their locations, and there are no problems."""
    found = read(COMPLETE)
    assert (found.name, found.build_type, found.problems) == ("my_robot", "ament_python", ())
    assert (found.name_location.line, found.name_location.column) == (4, 3)
    assert (found.type_location.line, found.type_location.column) == (13, 5)
    assert found.name_location.path == "my_robot/package.xml"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("  <name>my_robot</name>\n", "", ['3:1 The manifest must contain exactly one "name" tag']),
        (
            "<name>my_robot</name>",
            "<name> </name>",
            ['4:3 Package name "" does not follow naming conventions'],
        ),
        (
            "<license>",
            "<name>rover</name><license>",
            ['8:3 The manifest must contain exactly one "name" tag'],
        ),
        ("<version>0.0.0</version>", "<version/>", ["5:3 Package version must not be empty"]),
        (
            ">0.0.0<",
            ">1.0<",
            [
                '5:3 Package version "1.0" does not follow version conventions: write three numbers, as 0.1.0'
            ],
        ),
        (
            "<license>Apache-2.0</license>",
            "<licence>MIT</licence>",
            [
                "8:3 The manifest (with format version 3) must not contain the following tags: licence",
                '3:1 The package node must contain at least one "license" tag',
            ],
        ),
        (
            ' email="me@example.org"',
            "",
            ['7:3 The "maintainer" tag must have the attribute "email"'],
        ),
        ("me@example.org", "me", ['7:3 Invalid email "me" for person "Me"']),
        (
            "me@example.org",
            "me@todo.todo",
            ["7:3 PKG003 <maintainer> of package.xml is still TODO"],
        ),
        ("me@example.org", "&quot;me@example.org&quot;", [f"7:3 PKG006 {QUOTED}"]),
        ("python3-pytest", "my_robot", [f'10:3 The package must not "test_depend" on {SAME}']),
        (
            "<test_depend>",
            "<test_depend condition='$ROS_VERSION = 2'>",
            [f"10:3 condition '$ROS_VERSION = 2' {PARSED}"],
        ),
        (
            "Apache-2.0",
            "TODO: License declaration",
            ["8:3 PKG003 <license> of package.xml is still TODO"],
        ),
        (
            ">A robot<",
            ">TODO: Package description<",
            ["6:3 PKG003 <description> of package.xml is still TODO"],
        ),
        (' format="3"', "", ["3:1 PKG004 package.xml has format 1; ROS 2 packages use format 3"]),
        ('"3"', '"2"', []),
        ("<description>A robot</description>", "<description>A <b>robot</b></description>", []),
        ("<name>my_robot</name>", "<!-- <name>old</name> --><name>my_robot</name>", []),
    ],
)
def test_problems(old: str, new: str, expected: list[str]) -> None:
    """What the tools of ROS 2 refuse, and what deserves a note, is reported at its expected location."""
    assert old in COMPLETE
    assert problems_of(read(COMPLETE.replace(old, new))) == expected


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("", 1, "not readable as XML"),
        (
            "<package>\n<name>a</nam>\n</package>",
            2,
            "not readable as XML: Opening and ending tag mismatch",
        ),
        ("<package>", 1, "not readable as XML"),
        ("name: my_robot", 1, "not readable as XML"),
        ("<robot/>", 1, "the root of package.xml is <robot>, not <package>"),
    ],
)
def test_unreadable_files(text: str, line: int, words: str) -> None:
    """A file that is no package.xml is reported once; the name is then unknown."""
    found = read(text)
    assert [(problem.kind.code, problem.location.line) for problem in found.problems] == [
        ("PKG001", line)
    ]
    assert words in found.problems[0].message
    assert found.refusals == found.problems


@pytest.mark.parametrize(
    "mistake",
    [("</test_depend>", "<test_depend>"), ("</name>", "</nam>"), ("<license>", "<licence>")],
)
def test_what_can_be_read_of_a_broken_file(mistake: tuple[str, str]) -> None:
    """Name and build type are read of a file that is not well-formed XML."""
    found = read(COMPLETE.replace(*mistake))
    assert (found.name, found.build_type, len(found.problems)) == ("my_robot", "ament_python", 1)
    found = read("<package>")
    assert (found.name, found.build_type) == (None, "")


@pytest.mark.parametrize(
    ("export", "kind"),
    [
        ("<export/>", "catkin"),
        ("<export><build_type> ament_cmake </build_type></export>", "ament_cmake"),
        (
            "<export><build_type condition='$ROS_VERSION == 1'>catkin</build_type><build_type>ament_python</build_type></export>",
            "ament_python",
        ),
        ("<build_type>ament_python</build_type>", "catkin"),
        (
            "<export><build_type condition='$ROS_VERSION == 2'>ament_python</build_type></export>",
            "ament_python",
        ),
        (
            "<export><build_type condition='$ROS_VERSION &lt; 2 or ($ROS_DISTRO == \"humble\")'>a</build_type></export>",
            "catkin",
        ),
        (
            "<export><build_type>ament_cmake</build_type><build_type>ament_python</build_type></export>",
            "ament_cmake and ament_python",
        ),
    ],
)
def test_build_type(export: str, kind: str) -> None:
    """The build type is that of <export>; default: colcon's catkin."""
    start, _, _ = COMPLETE.partition("  <export>")
    assert read(f"{start}{export}</package>").build_type == kind


def test_entities_are_not_resolved() -> None:
    """A DOCTYPE opens no file, expands nothing, and hides no location."""
    text = '<!DOCTYPE p [<!ENTITY e "my"><!ENTITY f SYSTEM "file:///etc/passwd">]>\n<package>&e;&e;&f;\n<name>a&f;</name></package>'
    found = read(text)
    assert found.name == "a"
    assert found.name_location.line == 3
    lines = "".join(f"<!ENTITY a{n} '&a{n - 1};&a{n - 1};'>" for n in range(1, 60))
    with limited_work(1_000):
        read(f"<!DOCTYPE p [<!ENTITY a0 'ha'>{lines}]><package><name>&a59;</name></package>")
        read(
            f"<!DOCTYPE p [<!ENTITY a0 'ha'>{lines}]><package format='&a59;'><name>a</name></package>"
        )


@pytest.mark.parametrize("encoding", ["UTF-16", "UTF-7", "ISO-8859-1", "cp037", "UTF-8"])
def test_encodings(encoding: str) -> None:
    """Another encoding is read or refused, and never an error."""
    text = COMPLETE.replace('version="1.0"', f'version="1.0" encoding="{encoding}"').replace(
        "A robot", "Ein Rääd"
    )
    assert read_manifest(text.encode(encoding), "package.xml").name in ("my_robot", None)


@pytest.mark.parametrize(
    "text",
    [
        "<package>" + "<a>" * 100_000,
        "<package>" * 200 + "</package>" * 200,
        "<package " + "a" * 250_000,
        "<" * 250_000,
        "<package>" + "<name>a</name>" * 15_000 + "</package>",
        "<!--" * 60_000,
        "<package>" + "<![CDATA[" * 20_000,
    ],
)
def test_hostile_files(text: str) -> None:
    """Depth, length and number take linear time."""
    with limited_work(500_000):
        assert isinstance(read(text).problems, tuple)
