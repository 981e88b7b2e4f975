"""Nodes in C++ as launch files start them: their names, parameters, topics and frames agree as those in Python do."""

from pathlib import Path

import pytest

from grader.files.reading import URDF_LIMIT
from grader.workspace.opening.opening import open_workspace
from grader.workspace.rules.reading import read_agreement
from tests.labs.variants import make_variant

pytestmark = pytest.mark.slow

_ORBITER, _WATCHER = "beacon/src/orbiter.cpp", "beacon/src/watcher.cpp"


def messages(folder: Path, *edits: tuple[str, str, str]) -> list[tuple[str, str, bool]]:
    """Return the families, messages and certainties of what does not agree in the lab beacon after edits."""
    workspace = make_variant("beacon", "solution", folder)
    for path, old, new in edits:
        file = workspace / path
        text = file.read_text()
        assert old in text
        file.write_text(text.replace(old, new))
    opened = open_workspace(str(workspace), URDF_LIMIT, {})
    found = read_agreement(opened.workspace)
    return [(it.family, it.message, it.is_certain) for it in found.mismatches]


def test_a_node_has_the_name_of_its_code(tmp_path: Path) -> None:
    """The parameters for a node are those of its name, which the launch file does not give."""
    [found] = messages(tmp_path, (_WATCHER, 'Node("watcher")', 'Node("guard")'))
    assert found[0] == "parameters"
    assert "none for the node 'guard'" in found[1]


OPEN = [
    (_WATCHER, 'Node("watcher")', "Node(name())"),
    (_WATCHER, 'declare_parameter("limit", 6.0);', "DECLARE_LIMIT(this);"),
    (_WATCHER, 'declare_parameter("limit", 6.0);', 'declare_parameter(prefix + "limit", 6.0);'),
    (_WATCHER, 'declare_parameter("limit", 6.0);', "helper_ = std::make_shared<Helper>(this);"),
    (_WATCHER, 'declare_parameter("limit", 6.0);', '\n#ifdef A\ndeclare_parameter("other", 6.0);\n#endif\n'),
    (_ORBITER, '"angle", rclcpp', "topic(), rclcpp"),
    (_ORBITER, "transform.child_frame_id = child_frame_id_;", "transform.child_frame_id = frame();"),
    (_ORBITER, "class Orbiter : public rclcpp::Node", "class Orbiter : public Base"),
]  # fmt: skip


@pytest.mark.parametrize("edit", OPEN)
def test_what_is_computed_is_open(edit: tuple[str, str, str], tmp_path: Path) -> None:
    """A name that is not known, a macro, and what is given the node leave names open."""
    assert messages(tmp_path, edit) == []


def test_a_frame_that_code_stamps(tmp_path: Path) -> None:
    """A message may name frames of the robot, and those that a node publishes."""
    edit = (_WATCHER, "point.header = transform.header;", 'point.header.frame_id = "{}";')
    for frame in ("world", "lamp_link", "/beacon_link"):
        changed = (edit[0], edit[1], edit[2].format(frame))
        assert messages(tmp_path / frame.strip("/"), changed) == []
    [found] = messages(tmp_path / "other", (edit[0], edit[1], edit[2].format("wrld")))
    assert (found[0], found[2]) == ("frames", True)
    assert found[1].startswith("frame_id: there is no frame 'wrld'; did you mean 'world'")


def test_frames_that_a_library_may_publish(tmp_path: Path) -> None:
    """Where a node is open, only a similar name is wrong, and it is a warning."""
    given = (
        _ORBITER,
        "start_ = now();\n\n",
        "start_ = now(); helper_ = std::make_shared<Helper>(this);\n",
    )
    other = (_WATCHER, '"lamp_link", tf2', '"lamp_lnik", tf2')
    [found] = messages(tmp_path / "near", given, other)
    assert (found[0], found[2]) == ("frames", False)
    assert messages(tmp_path / "far", given, (other[0], other[1], '"elsewhere", tf2')) == []


def test_files_of_packages(tmp_path: Path) -> None:
    """A text in C++ names a file that a build of the package has to install."""
    edit = (
        _WATCHER,
        'declare_parameter("limit", 6.0);',
        'show("package://beacon/urdf/{}"); declare_parameter("limit", 6.0);',
    )
    assert messages(tmp_path / "there", (edit[0], edit[1], edit[2].format("lamp.urdf"))) == []
    [found] = messages(tmp_path / "absent", (edit[0], edit[1], edit[2].format("lamb.urdf")))
    assert found[0] == "files"
