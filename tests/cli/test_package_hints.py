"""Hints for packages: the mistake itself, where it is, in the student's own way of writing; the cause gives no answer away."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run
from tests.samples import ROOT

pytestmark = pytest.mark.usefixtures("shows_edits")
LAUNCH, SETUP, RVIZ = "*.launch.py", "setup.py", "*.rviz"
FRONTEND, XML = "equivalent-launch-file-in-xml", "*.launch.xml"
XACRO, PLAIN = "equivalent-xacro-command", "equivalent-f-strings-and-pathlib"

# A sample, a file of it, a text, what a student writes instead, and the old and the new text of each edit.
MISTAKES = {
    "default value of a path": (
        XACRO,
        LAUNCH,
        "my_robot.urdf",
        "my_robto.urdf",
        [("my_robto.urdf", "my_robot.urdf")],
    ),
    "fixed frame": (
        PLAIN,
        RVIZ,
        "Fixed Frame: base_footprint",
        "Fixed Frame: odom",
        [("odom", "base_footprint")],
    ),
    "two paths": (
        PLAIN,
        LAUNCH,
        "my_robot.",
        "my-robot.",
        [("my-robot.urdf", "my_robot.urdf"), ("my-robot.rviz", "my_robot.rviz")],
    ),
    "import of glob": (
        "equivalent-nested-install-paths",
        SETUP,
        "from glob import glob",
        "import glob",
        [("import glob", "from glob import glob")],
    ),
    "space after xacro": (XACRO, LAUNCH, "'xacro '", "'xacro'", [("", " ")]),
    "name that is not defined": (
        XACRO,
        LAUNCH,
        "([model, gui])",
        "([model_file, gui])",
        [("model_file", "model")],
    ),
    "name of a tag": (PLAIN, "package.xml", "name>", "nme>", [("nme", "name")] * 2),
    "substitution of ROS 1": (
        FRONTEND,
        XML,
        "$(find-pkg-share",
        "$(find",
        [("find", "find-pkg-share")] * 2,
    ),
    "name of the package in its paths": (
        "equivalent-literal-lists",
        SETUP,
        "share/my_robot",
        "share/my-robot",
        [("my-robot", "my_robot")] * 2,
    ),
}


def graded(folder: Path, *options: str) -> dict[str, Any]:
    """Return the report of a folder as JSON."""
    data: dict[str, Any] = json.loads(run(("grade", folder, "--format", "json", *options)).stdout)
    return data


def with_mistake(folder: Path, sample: str, name: str, old: str, new: str) -> Path:
    """Return a copy of a sample with another text in the file that a pattern names."""
    shutil.copytree(
        ROOT / "submissions/lab6" / sample,
        folder / "lab",
        ignore=shutil.ignore_patterns("expected.toml"),
    )
    [path] = (folder / "lab").rglob(name)
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    return folder / "lab"


def hints(report: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the different hints of a report."""
    found = {hint["message"]: hint for result in report["results"] for hint in result["hints"]}
    return list(found.values())


@pytest.mark.slow
@pytest.mark.parametrize("name", MISTAKES)
def test_the_mistake_itself_is_corrected(name: str, tmp_path: Path) -> None:
    """The only hint changes what the student got wrong and nothing else, and --fix reaches all automatic points."""
    *mistake, edits = MISTAKES[name]
    folder = with_mistake(tmp_path, *mistake)
    [hint] = hints(graded(folder))
    assert [(edit["old"], edit["new"]) for edit in hint["edits"]] == edits
    (tmp_path / "fixed").mkdir()
    run(("grade", folder, "--fix", tmp_path / "fixed"))
    shutil.copytree(tmp_path / "fixed", folder, dirs_exist_ok=True)
    assert not [result for result in graded(folder)["results"] if result["status"] == "failed"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["default value of a path", "fixed frame"])
def test_the_cause_gives_no_answer_away(name: str, tmp_path: Path) -> None:
    """Below the level edit the hint says where and what is wrong, in the words of the file's format."""
    *mistake, edits = MISTAKES[name]
    [hint] = hints(graded(with_mistake(tmp_path, *mistake), "--hints", "cause"))
    assert hint["edits"] == []
    assert not any(len(new) > 1 and new in hint["message"] for _, new in edits)
    words = {
        "default value of a path": "the path `my_robto.urdf` in the launch file",
        "fixed frame": "the value of `Fixed Frame` in the RViz file",
    }
    assert words[name] in hint["message"]


def test_the_reference_is_not_pasted_over_the_student(tmp_path: Path) -> None:
    """A launch file that is written in another way keeps its calls: only the path is replaced."""
    shutil.copytree(
        ROOT / "submissions/sensors/launch-home-path/sensor_robot", tmp_path / "sensor_robot"
    )
    shutil.copytree(ROOT / "rubrics/sensors", tmp_path / "lab")
    rubric = tmp_path / "lab/rubric.toml"
    rubric.write_text(f'hints = "edit"\n{rubric.read_text(encoding="utf-8")}', encoding="utf-8")
    [hint] = hints(graded(tmp_path / "sensor_robot", "--rubric", str(rubric)))
    assert [edit["old"] for edit in hint["edits"]] == [
        "'/home/student/ros2_ws/src/sensor_robot/urdf/sensor_robot.urdf.xacro'"
    ]
    assert "ParameterValue" not in hint["message"]


def test_a_node_that_is_created_and_not_used_is_added_by_its_name(tmp_path: Path) -> None:
    """The node is not written a second time."""
    shutil.copytree(ROOT / "submissions/lab6/launch-without-rviz/my_robot", tmp_path / "my_robot")
    [hint] = hints(graded(tmp_path / "my_robot"))
    assert [(edit["old"], edit["new"].strip(", \n")) for edit in hint["edits"]] == [("", "rviz")]


def test_the_student_s_own_node_is_not_taken_for_a_missing_one(tmp_path: Path) -> None:
    """A node that the reference does not start stays as it is when another one is missing."""
    node = "package='rviz2', executable='rviz2'"
    text = "Node(package='turtlesim', executable='turtlesim_node', output='screen'),"
    folder = with_mistake(
        tmp_path,
        "reference",
        LAUNCH,
        "        Node(\n            package='rviz2',\n            executable='rviz2',\n            arguments=['-d', os.path.join(share, 'my_robot.rviz')],\n        ),\n",
        f"        {text}\n",
    )
    [hint] = hints(graded(folder))
    [edit] = hint["edits"]
    assert edit["old"] == ""
    assert node.split(", ")[1] in edit["new"]
