"""The names in worlds, in files of RViz and in the commands of Markdown are found as elsewhere, or a rename says why not."""

import shutil

import pytest

from grader.app.editor.places import TextPlace
from grader.app.editor.renaming import CannotRenameError, prepared, renamed
from grader.app.editor.session import EditorSession
from grader.app.editor.text_ranges import TextRanges
from tests.command_line import ROOT

pytestmark = pytest.mark.slow

_WORLD = """\
<sdf version="1.9">
  <model name="buoy">
    <link name="buoy_link"/>
    <joint name="buoy_joint" type="fixed"><parent>world</parent><child>buoy_link</child></joint>
    <plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
      <robot_base_frame>base_link</robot_base_frame>
      <left_joint>left_paddle_joint</left_joint>
    </plugin>
  </model>
</sdf>
"""
_PAGE = """\
Start it with `ros2 launch ferry_bringup ferry.launch.py rviz:=false`, or

    ros2 run ferry_deck scale
    ros2 run turtlesim turtlesim_node
"""
_SDF, _README = "src/ferry_bringup/buoy.sdf", "src/ferry_bringup/README.md"
_RVIZ = "src/ferry_bringup/rviz/ferry.rviz"
_LAUNCH = "src/ferry_bringup/launch/ferry.launch.py"


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> EditorSession:
    root = tmp_path_factory.mktemp("texts") / "ws"
    shutil.copytree(ROOT / "tests/editor/ferry", root)
    (root / _SDF).write_text(_WORLD, encoding="utf-8")
    (root / _README).write_text(_PAGE, encoding="utf-8")
    return EditorSession(root)


def _place(desk: EditorSession, path: str, text: str, inside: str) -> TextPlace:
    """Return the place of a word inside of the first text in a file."""
    root = desk.files.root
    lines = TextRanges(desk.look(), root).lines(path)
    before = lines.text[: lines.text.index(text) + text.index(inside) + 1].split("\n")
    return TextPlace(root, path, lines, len(before), len(before[-1]))


@pytest.mark.parametrize(
    ("path", "text", "inside", "defined"),
    [
        (_SDF, "<child>buoy_link", "buoy", f"{_SDF}:3"),
        (_SDF, "<robot_base_frame>base_link", "base_link",
         "src/ferry_description/urdf/ferry.urdf.xacro:7"),
        (_SDF, "<left_joint>left_paddle", "paddle", "src/ferry_description/urdf/parts.xacro:23"),
        (_README, "launch ferry_bringup", "ferry", "src/ferry_bringup/package.xml:3"),
        (_README, "ferry.launch.py", "launch", f"{_LAUNCH}:1"),
        (_README, "rviz:=", "rviz", f"{_LAUNCH}:19"),
        (_README, "ferry_deck scale", "scale", "src/ferry_deck/setup.py:15"),
        (_RVIZ, "/initialpose", "initialpose", f"{_RVIZ}:29"),
    ],
)  # fmt: skip
def test_finds_where_a_name_is_defined(
    desk: EditorSession, path: str, text: str, inside: str, defined: str
) -> None:
    """The definition is the one that launch files and code have, too."""
    look = desk.look()
    name = look.names.at(*_place(desk, path, text, inside).triple)
    assert name is not None
    same = [one for one in look.names.same(name) if one.role == "definition"]
    assert defined in {one.location.file_and_line for one in same}


def test_other_packages_are_no_names(desk: EditorSession) -> None:
    """A command that starts a program of a package that is installed names nothing here."""
    place = _place(desk, _README, "turtlesim_node", "turtlesim")
    assert desk.look().names.at(*place.triple) is None


def test_renames_the_topic_of_a_tool(desk: EditorSession) -> None:
    """Only the file of RViz has it."""
    edit = renamed(desk.look(), _place(desk, _RVIZ, "/initialpose", "initialpose"), "start")
    assert edit.changes is not None
    [changes] = edit.changes.values()
    assert [(each.range.start.line, each.new_text) for each in changes] == [(28, "start")]


@pytest.mark.parametrize(
    ("path", "text", "inside", "reason"),
    [
        (_RVIZ, "/hook/height", "hook",
         f"{_RVIZ}:21: only the last part of the topic '/hook/height' is renamed: 'height'"),
        (_RVIZ, "Enabled", "Enabled", f"{_RVIZ}:9: it is not known what is named here"),
        (_LAUNCH, "'ferry_deck'", "ferry_deck", "named at src/ferry_deck/package.xml:3, "),
        (_LAUNCH, "'pilot'", "pilot", "src/ferry_deck/setup.py:16"),
        (_README, "ferry.launch.py", "launch", f"{_LAUNCH}:1"),
    ],
)  # fmt: skip
def test_says_which_place_is_not_renamed(
    desk: EditorSession, path: str, text: str, inside: str, reason: str
) -> None:
    """Before the new name is asked for."""
    with pytest.raises(CannotRenameError) as refusal:
        prepared(desk.look(), _place(desk, path, text, inside))
    assert reason in str(refusal.value)
