"""What an editor offers at a problem: corrections that cause no other one, all of a rule, and comments that ignore it."""

import shutil
from pathlib import Path

import pytest
from lsprotocol import types as lsp

from grader.app.editor import fixes
from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.app.editor.session import EditorSession
from grader.app.editor.text_ranges import TextRanges
from grader.base.element_edits import edited
from grader.base.ignore_comments import ignoring_edit
from grader.base.source import Edit, Source
from tests.command_line import ROOT

pytestmark = pytest.mark.slow

_HOIST = "src/ferry_hoist/"
_CONTROLLERS = "src/ferry_bringup/config/controllers.yaml"


class _Desk:
    """A workspace whose files are typed in."""

    def __init__(self, root: Path) -> None:
        self.root, self._session = root, EditorSession(root)

    def type(self, path: str, old: str, new: str) -> Look:
        """Replace a text of a file, and look at the workspace."""
        text = (self.root / path).read_text(encoding="utf-8")
        assert old in text
        self._session.change(lambda files: files.type(path, text.replace(old, new, 1)))
        return self._session.look()

    def offered(self, look: Look, path: str) -> dict[str, lsp.WorkspaceEdit | None]:
        """Return what is offered anywhere in a file, by its titles."""
        lines = TextRanges(look, self.root).lines(path)
        whole = lsp.Range(lsp.Position(0, 0), lsp.Position(lines.text.count("\n") + 1, 0))
        place = TextPlace(self.root, path, lines, 1, 1)
        return {each.title: each.edit for each in fixes.actions(look, place, whole)}


@pytest.fixture
def desk(tmp_path: Path) -> _Desk:
    return _Desk(Path(shutil.copytree(ROOT / "tests/editor/ferry", tmp_path / "ws")))


@pytest.mark.parametrize(
    ("path", "old", "new", "title"),
    [
        (f"{_HOIST}CMakeLists.txt", "src/hoist.cpp", "src/host.cpp",
         "Change 'src/host.cpp' to 'src/hoist.cpp'"),
        (f"{_HOIST}CMakeLists.txt", "find_package(sensor_msgs", "find_package(sensor_msg",
         "Change 'sensor_msg' to 'sensor_msgs'"),
        (f"{_HOIST}CMakeLists.txt", "TARGETS hoist", "TARGETS hois", "Change 'hois' to 'hoist'"),
        (f"{_HOIST}CMakeLists.txt", "install(DIRECTORY launch", "install(DIRECTORY launches",
         "Change 'launches' to 'launch'"),
        ("src/ferry_deck/ferry_deck/pilot.py", "ferry_msgs.msg import Load",
         "ferry_msgs.msg import Lode", "Change 'Lode' to 'Load'"),
    ],
)  # fmt: skip
def test_offers_what_the_message_names(
    desk: _Desk, path: str, old: str, new: str, title: str
) -> None:
    """The correction is at the wrong word."""
    assert title in desk.offered(desk.type(path, old, new), path)


def test_adds_what_package_xml_lacks(desk: _Desk) -> None:
    """The element is behind the last dependency, whichever file uses the package."""
    manifest = "src/ferry_deck/package.xml"
    look = desk.type(manifest, "  <exec_depend>nav_msgs</exec_depend>\n", "")
    offered = desk.offered(look, "src/ferry_deck/ferry_deck/pilot.py")
    [title] = [each for each in offered if each.startswith("Add ")]
    assert title.startswith(f"Add '<exec_depend>nav_msgs</exec_depend>' in {manifest}:")
    assert "Ignore dependency-declared here" in offered


def test_no_correction_spreads_a_slip(desk: _Desk) -> None:
    """The name that is wrong in package.xml is not written into the launch file that has the right one."""
    look = desk.type("src/ferry_bringup/package.xml", ">xacro<", ">xaco<")
    offered = desk.offered(look, "src/ferry_bringup/launch/ferry.launch.py")
    assert not [title for title in offered if title.startswith("Change 'xacro' to 'xaco'")]
    assert [title for title in offered if title.startswith("Change 'xaco' to 'xacro'")]


def test_corrects_all_problems_of_a_rule(desk: _Desk) -> None:
    """The edits of each are one action; a file with one problem of a rule has none."""
    right = "left_wheel_names: [left_paddle_joint]\n    right_wheel_names: [right_paddle_joint]"
    look = desk.type(_CONTROLLERS, right, right.replace("paddle", "padle"))
    edit = desk.offered(look, _CONTROLLERS)["Fix all of REF002 joint-defined in this file"]
    assert edit is not None
    assert edit.changes is not None
    [changes] = edit.changes.values()
    assert sorted(each.new_text for each in changes) == ["left_paddle_joint", "right_paddle_joint"]
    look = desk.type(_CONTROLLERS, "[left_paddle_joint]", "[left_padle_joint]")
    assert not [each for each in desk.offered(look, _CONTROLLERS) if each.startswith("Fix all")]


def test_a_comment_ignores_a_problem(desk: _Desk) -> None:
    """After the edit, the problem is not shown any more."""
    wrong = "left_wheel_names: [left_padle_joint]"
    look = desk.type(_CONTROLLERS, "left_wheel_names: [left_paddle_joint]", wrong)
    assert "Ignore joint-defined here" in desk.offered(look, _CONTROLLERS)
    ignored = f"{wrong}  # grader:ignore joint-defined"
    look = desk.type(_CONTROLLERS, "left_wheel_names: [left_paddle_joint]", ignored)
    assert "joint-defined" not in {each.rule.name for each in look.findings}


@pytest.mark.parametrize(
    ("path", "text", "mark", "after"),
    [
        ("a.py", "a = 1\nb = 2\n", "a", "a = 1  # grader:ignore REF001\nb = 2\n"),
        ("a.py", "a = 1  # grader:ignore x-y\n", "a", "a = 1  # grader:ignore x-y, REF001\n"),
        ("a.py", "a = 1 + \\\n  2\n", "a", None),
        ("a.py", 'a = """1\n2"""\n', "a", None),
        ("a.cpp", "int a;", "a", "int a;  // grader:ignore REF001"),
        ("a.txt", "a", "a", None),
        ("a.xml", "<b>\n  <a\n    c='1'/>\n</b>", "c=",
         "<b>\n  <!-- grader:ignore REF001 -->\n  <a\n    c='1'/>\n</b>"),
        ("a.xml", "<b><a/></b>", "<a", "<!-- grader:ignore REF001 -->\n<b><a/></b>"),
        ("a.xml", "<!-- grader:ignore x-y -->\n<a/>", "<a/", None),
        ("a.xml", "<?xml version='1.0'?>", "<?", None),
    ],
)  # fmt: skip
def test_where_a_comment_ignores(path: str, text: str, mark: str, after: str | None) -> None:
    """It is beside the line, in XML above the tag; there is none where it would be part of a text."""
    source = Source(path, text)
    edit = ignoring_edit(source, source.at(text.index(mark)), "REF001")
    made = edited(text, path, [edit]) if isinstance(edit, Edit) else None
    assert made == after
