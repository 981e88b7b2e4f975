"""The end of what begins at a place: the tag, value or name that is meant."""

import pytest

from grader.base.extents import end_offset, ended, find_end
from grader.base.source import Location, Source

# Of each language a text in which « and » stand around what is meant.
CASES = [
    ("a.urdf", '<robot>\n  «<link name="base"/>»\n</robot>'),
    ("a.urdf", '<link «name="base"»/>'),
    ("a.urdf", "<link «name = 'base'»/>"),
    ("a.xacro", '«<joint name="a"\n   type="fixed">»\n</joint>'),
    ("a.xacro", '<link name="«${side + x}_wheel»"/>'),
    ("a.urdf", "«</link>»"),
    ("a.urdf", '«<origin»\n<link name="x"/>'),
    ("a.urdf", "«<!-- a comment»\n that goes on -->"),
    ("package.xml", "<depend>«rclpy»</depend>"),
    ("a.launch", '<node «pkg="$(find-pkg-share x)"»/>'),
    ("a.launch", '<node pkg="«$(find-pkg-share x)/y»"/>'),
    ("a.yaml", "joints:\n  - «left_wheel»\n"),
    ("a.yaml", "«left_wheel»: 1\n"),
    ("a.yaml", "topic: «/a b»   # the scan\n"),
    ("a.yaml", "joints: [«left», right]\n"),
    ("a.yaml", "joints: [left, «right»]\n"),
    ("a.yaml", "joints: [\n  left,\n  «right»]\n"),
    ("a.yaml", "joints: «[left, right]»\n"),
    ("a.yaml", 'text: «"a, \\" b"» # no\n'),
    ("a.yaml", "text: «'a ''b'' c'»\n"),
    ("a.yaml", "text: «hello, world»\n"),
    ("a.yaml", '"[": 1\ntext: «hello, world»\n'),
    ("a.yaml", "type: «nav2_navfn_planner::NavfnPlanner»\n"),
    ("a.yaml", "map: «&m left»\n"),
    ("a.rviz", "Fixed Frame: «base link»\n"),
    ("a.py", "Node(package=«'x'»)"),
    ("a.py", "«Node»(package='x')"),
    ("a.py", "«launch_ros.actions.Node»(package='x')"),
    ("a.py", "x = «f'{side}_wheel'» + y"),
    ("a.py", "x = «rb'''a\n'b'\n'''»"),
    ("a.py", "«from a import b»  # why"),
    ("a.py", "x = '«/home/me/a.yaml»'"),
    ("a.cpp", 'declare_parameter(«"rate"», 1);'),
    ("a.cpp", '«R"x(a\n)")x"»;'),
    ("a.cpp", "«node->create_subscription»(x);"),
    ("a.hpp", "«#include <a/b.hpp>»\n"),
    ("CMakeLists.txt", "install(DIRECTORY «launch/${x}» DESTINATION y)"),
    ("CMakeLists.txt", 'set(x «"a b"»)'),
    ("CMakeLists.txt", "«install»(DIRECTORY x)"),
    ("a.msg", "float32 «speed» 1"),
    ("README.md", "For «ROS» 2."),
    ("a.unknown", '<a>\n«<b c="d">»</b></a>'),
]


@pytest.mark.parametrize(("path", "marked"), CASES)
def test_it_ends_after_the_tag_value_or_name(path: str, marked: str) -> None:
    """The end is the place after the last character of what begins at the start."""
    before, _, rest = marked.partition("«")
    meant, _, after = rest.partition("»")
    source = Source(path, before + meant + after)
    start = source.at(len(before))
    line, column = find_end(source, start)
    assert source.text[len(before) : source.offset(line, column)] == meant


@pytest.mark.parametrize("text", ["", "\n", "x\n", "  "])
def test_a_place_where_nothing_begins_ends_where_it_begins(text: str) -> None:
    """A blank, the end of a line and a place beyond the text have no extent."""
    source = Source("a.yaml", text)
    for at in (Location("a.yaml", 1, 1), Location("a.yaml", 1, 9), Location("a.yaml", 9, 9)):
        if text != "x\n" or at.column > 1:
            assert find_end(source, at) == (at.line, at.column)


def test_columns_are_characters() -> None:
    """A character beyond the first plane of Unicode is one column; a byte-order mark is none."""
    source = Source("a.urdf", '\ufeff<link name="\U0001f916é"/>')
    where = source.tag(0, "name")
    assert (where.line, where.column) == (1, 7)
    assert find_end(source, where) == (1, 16)


def test_calls_have_their_ends() -> None:
    """So have the macro calls that led to a place; without the file it ends where it begins."""
    call = Location("b.xacro", 2, 1)
    where = Location("a.xacro", 1, 1, (("wheel", call),))
    found = ended(where, lambda path: Source(path, "<a/>") if path == "a.xacro" else None)
    assert (found.end_line, found.end_column) == (1, 5)
    assert found.calls[0][1][4:] == (2, 1)


@pytest.mark.parametrize("path", ["a.xml", "a.yaml", "a.py", "a.cpp", "CMakeLists.txt", "a.md"])
@pytest.mark.parametrize("unit", ["<", '"', "'", "[", "(", "{", "a ", "a=", "$(", "&a ", "#", "\\"])
def test_hostile_texts_have_an_end(path: str, unit: str) -> None:
    """Every text has an end within it."""
    source = Source(path, unit * 20_000)
    assert 0 < end_offset(source, 0) <= len(source.text)
