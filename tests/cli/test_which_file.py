"""Which file of one student's files is graded, as `grade` and `inspect` say it."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.checks.submissions import png
from tests.command_line import ROOT, run

REFERENCE = ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot"
URDF = (REFERENCE / "urdf/my_robot.urdf").read_text()
BOX = '<robot name="box"><link name="base_link"/></robot>'
NO_LIDAR = (ROOT / "submissions/lab6/lidar-missing/my_robot/urdf/my_robot.urdf").read_text()
PICTURE = "Lab6/Task1_Step8.png"
MANIFEST = "<package format='3'><name>my_robot</name></package>"
XACRO = '<robot name="my_robot" xmlns:xacro="http://www.ros.org/wiki/xacro">'
PART = XACRO.replace(' name="my_robot"', "") + '<link name="face"/><link name="eye"/><link name="nose"/></robot>'
MAIN = XACRO + '<link name="base_link"/></robot>'
LAUNCH = """from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([Node(package='robot_state_publisher', executable='robot_state_publisher',
                                   parameters=[{'robot_description': Command(['xacro ', FILE])}])])
"""
LAUNCHED = LAUNCH.replace("FILE", "'urdf/b.urdf.xacro'")


def written(folder: Path, files: dict[str, str]) -> Path:
    """Write a submission; a picture has no text."""
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(text.encode() or png())
    return folder


def graded(path: Path, *more: object) -> dict[str, Any]:
    """Return the JSON report on a submission."""
    return dict(json.loads(run(("grade", path, "--format", "json", "--hints", "none", *more)).stdout))


@pytest.mark.parametrize(
    ("files", "chosen"),
    [
        ({PICTURE: "", "Lab6/box.urdf": BOX, "Lab7/my_robot.urdf": URDF}, "Lab7/my_robot.urdf"),
        ({PICTURE: "", "Lab6/box.urdf": BOX, "ws/my_robot.urdf": URDF}, "ws/my_robot.urdf"),
        ({"Lab6/robot.urdf": NO_LIDAR, "Lab7/my_robot.urdf": URDF}, "Lab6/robot.urdf"),
        ({"Lab6/robot.urdf": NO_LIDAR, "Lab6/my_robot.urdf": BOX}, "Lab6/robot.urdf"),
        ({"Lab6/my_robot.urdf": NO_LIDAR, "Lab6/robot.urdf": URDF}, "Lab6/robot.urdf"),
        ({"Lab6/my_robot.urdf": URDF, "Lab6/robot.urdf": URDF}, "Lab6/my_robot.urdf"),
        ({"Lab6/my_robot.urdf": NO_LIDAR, "Lab6/build/my_robot.urdf": URDF, "Lab6/log/my_robot.urdf": URDF}, "Lab6/my_robot.urdf"),
        ({"Lab6/box.urdf": BOX, "Lab7/box.urdf": BOX}, "Lab6/box.urdf"),
        ({PICTURE: "", "Lab4/box.urdf": BOX}, "Lab4/box.urdf"),
    ],
)  # fmt: skip
def test_the_lab_and_the_links_decide(files: dict[str, str], chosen: str, tmp_path: Path) -> None:
    """A robot with half of the lab's links, then the lab's folder, then the most links, then the name; never a build."""
    assert graded(written(tmp_path / "ash", files))["submission"]["path"] == chosen


def test_the_box_of_the_prelab_costs_nothing(tmp_path: Path) -> None:
    """The robot of Lab 7 gets the points that it gets on its own, with a note; its package is graded as well."""
    path = written(tmp_path / "ash", {PICTURE: "", "Lab6/box.urdf": BOX, "Lab7/ws/my_robot.urdf": URDF})
    report = graded(path)
    assert (report["score"], report["pending"]) == (70, 30)
    why = "Lab6, the folder of this lab, has no robot of this lab: Lab7, the folder of another lab, was graded"
    assert report["notes"][0] == why
    (other,) = report["submission"]["other_candidates"]
    assert other == {"path": "Lab6/box.urdf", "reason": "it has fewer than half of the links that the rubric names"}


@pytest.mark.parametrize(
    ("files", "chosen"),
    [
        ({"face.xacro": PART, "rover.urdf.xacro": MAIN}, "rover.urdf.xacro"),
        ({"face.xacro": PART}, "face.xacro"),
        ({"package.xml": MANIFEST, "robot.urdf": URDF, "urdf/b.urdf.xacro": MAIN, "launch/a.launch.py": LAUNCHED}, "urdf/b.urdf.xacro"),
        ({"robot.urdf": URDF, "urdf/b.urdf.xacro": MAIN, "launch/a.launch.py": LAUNCHED}, "urdf/b.urdf.xacro"),
        ({"urdf/a.urdf": BOX, "urdf/b.urdf.xacro": PART, "launch/a.launch.py": LAUNCHED}, "urdf/b.urdf.xacro"),
        ({"robot.urdf": BOX, "z.urdf": URDF}, "z.urdf"),
        ({"robot.urdf": URDF, "a.urdf": URDF}, "robot.urdf"),
    ],
)  # fmt: skip
def test_inspect_chooses_without_a_rubric(files: dict[str, str], chosen: str, tmp_path: Path) -> None:
    """The file that the launch file loads, then no fragment, then the most links, then the name; `grade` does the same."""
    path = written(tmp_path / "ash", files)
    assert json.loads(run(("inspect", path, "--format", "json")).stdout)["path"] == chosen
    if all("base_link" in text for name, text in files.items() if name.endswith(("urdf", "xacro"))):
        rubric = written(tmp_path, {"r.toml": RUBRIC}) / "r.toml"
        assert graded(path, "--rubric", rubric)["submission"]["path"] == chosen


RUBRIC = """id = "r"
title = "R"
urdf = "robot.urdf"
[[part]]
id = "a"
title = "A"
[[criterion]]
id = "loads"
part = "a"
title = "It loads"
points = 1
check = "urdf_loads"
"""


def test_a_copy_that_is_not_launched(tmp_path: Path) -> None:
    """Of two files with the name that a launch file loads, the installed one is meant, whatever the other contains."""
    package = {
        path.relative_to(REFERENCE).as_posix(): path.read_text() for path in REFERENCE.rglob("*") if path.is_file()
    }
    files = {f"Lab6/my_robot/{path}": text for path, text in package.items()}
    files |= {"Lab6/my_robot/urdf/my_robot.urdf": NO_LIDAR, "Lab6/my_robot/a/my_robot.urdf": URDF}
    report = graded(written(tmp_path / "ash", files | {"Lab6/new/my_robot.urdf": URDF}))
    assert report["submission"]["path"] == "Lab6/my_robot/urdf/my_robot.urdf"
    reasons = {other["reason"] for other in report["submission"]["other_candidates"]}
    assert reasons == {"the launch file does not load it"}


@pytest.mark.parametrize("kind", ["terminal", "markdown", "json", "html"])
def test_the_top_of_a_report_names_another_robot(kind: str, tmp_path: Path) -> None:
    """Also of one that has some of the links, and where its criteria need manual grading."""
    path = written(tmp_path / "ash", {"Lab6/box.urdf": BOX, PICTURE: ""})
    found = run(("grade", path, "--format", kind)).stdout.decode()
    note = "this looks like another robot: it has only 1 of the 6 links that the rubric names"
    assert note in " ".join(found.split())
    if kind == "json":
        assert json.loads(found)["notes"][0] == note
        assert (json.loads(found)["score"], json.loads(found)["pending"]) == (0, 100)
    elif kind == "terminal":
        assert note in " ".join("".join(found.splitlines(keepends=True)[:4]).split())
    (path / PICTURE).unlink()
    assert graded(path)["score"] == 3


def test_xacro_without_a_package(tmp_path: Path) -> None:
    """A launch file that runs xacro on a file expands it, also in a folder without a package.xml."""
    text = XACRO + '<xacro:property name="n" value="base_link"/><link name="${n}"/></robot>'
    files = {"Lab6/my_robot.urdf": text, "Lab6/go.launch.py": LAUNCH.replace("FILE", "'my_robot.urdf'")}
    path = written(tmp_path / "ash", files)
    assert graded(path, "--part", "task1")["results"][0]["status"] == "passed"
    (path / "Lab6/go.launch.py").rename(path / "Lab6/go.txt")
    assert graded(path, "--part", "task1")["results"][0]["status"] == "failed"


def test_the_exact_name_of_a_launch_file(tmp_path: Path) -> None:
    """A launch file in another language counts only if there is none of the name."""
    files = {"launch/display.launch.py": LAUNCHED, "launch/display.launch.xml": "<launch/>", "package.xml": MANIFEST}
    rubric = written(tmp_path, {"r.toml": RUBRIC.replace("urdf_loads", "launch_found").replace(
        "points = 1", 'points = 1\nwith = { name = "display.launch.xml" }').replace(
        'title = "A"', 'title = "A"\nneeds = "package"')}) / "r.toml"  # fmt: skip
    path = written(tmp_path / "ash", files)
    (found,) = graded(path, "--rubric", rubric)["results"]
    assert found["message"] == "the launch file is launch/display.launch.xml"
    (path / "launch/display.launch.xml").unlink()
    assert graded(path, "--rubric", rubric)["results"][0]["status"] == "passed"
