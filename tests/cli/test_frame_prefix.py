"""`grader grade` of a launch file that gives robot_state_publisher a frame_prefix: RViz has to name the frames with it."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run
from tests.samples import ROOT

PACKAGE = ROOT / "rubrics/lab6/my_robot"
LAUNCH = "launch/my_robot_rviz.launch.py"
RVIZ = "rviz/my_robot.rviz"
DESCRIPTION = "{'robot_description': robot_description"


def results(folder: Path, *, prefix: str = "", frame: str = "base_footprint", tf_prefix: str = "") -> dict[str, Any]:
    """Return the results of the reference package with a frame_prefix, as Python, and with names in its RViz file."""
    package = folder / "my_robot"
    shutil.copytree(PACKAGE, package)
    changes = [(RVIZ, "Fixed Frame: base_footprint", f"Fixed Frame: {frame}")]
    if prefix:
        changes.append((LAUNCH, DESCRIPTION, f"{DESCRIPTION}, 'frame_prefix': {prefix}"))
    if tf_prefix:
        changes.append(
            (
                RVIZ,
                "Class: rviz_default_plugins/RobotModel",
                f"Class: rviz_default_plugins/RobotModel\n      TF Prefix: {tf_prefix}",
            )
        )
    for name, old, new in changes:
        path = package / name
        assert path.read_text().count(old) == 1
        path.write_text(path.read_text().replace(old, new))
    return {result["id"]: result for result in json.loads(run(("grade", folder, "--format", "json")).stdout)["results"]}


@pytest.mark.parametrize("prefix", ["'robot1/'", "[LaunchConfiguration('name', default='robot1'), '/']"])
def test_frames_with_the_prefix(prefix: str, tmp_path: Path) -> None:
    """The Fixed Frame has the prefix as it is, and RobotModel has it without its slash, which RViz adds."""
    found = results(tmp_path, prefix=prefix, frame="robot1/base_footprint", tf_prefix="robot1")
    assert {found[name]["status"] for name in ("rviz-fixed-frame", "rviz-shows-robot", "launch-nodes")} == {"passed"}


def test_frames_without_the_prefix(tmp_path: Path) -> None:
    """The names of the links are no frames: the report says why, and the hint gives the name with the prefix."""
    found = results(tmp_path, prefix="'robot1/'")
    frame, model = found["rviz-fixed-frame"], found["rviz-shows-robot"]
    assert (frame["status"], model["status"]) == ("failed", "failed")
    assert frame["message"] == (
        "the Fixed Frame is 'base_footprint'; it should be 'robot1/base_footprint', because the frame_prefix of "
        "robot_state_publisher is 'robot1/'"
    )
    assert [(edit["old"], edit["new"]) for edit in frame["hints"][0]["edits"]] == [("", "robot1/")]
    assert model["message"] == (
        "the TF Prefix of the RobotModel display is '', so it looks for frames like 'LINK'; robot_state_publisher "
        "publishes 'robot1/LINK'"
    )


@pytest.mark.parametrize(("prefix", "frame"), [("'robot1_'", "robot1_base_footprint"), ("'r/'", "r/base_footprint")])
def test_the_prefix_is_put_before_the_name_as_it_is(prefix: str, frame: str, tmp_path: Path) -> None:
    """robot_state_publisher adds no slash."""
    assert results(tmp_path, prefix=prefix, frame=frame)["rviz-fixed-frame"]["status"] == "passed"


@pytest.mark.parametrize(("prefix", "before"), [("'/'", ""), ("'/robot1/'", "robot1")])
def test_a_slash_at_the_start_is_no_part_of_a_frame(prefix: str, before: str, tmp_path: Path) -> None:
    """tf2 drops it: with an empty namespace before a slash the frames are called like the links."""
    found = results(tmp_path, prefix=prefix, frame=f"{before}/base_footprint".removeprefix("/"), tf_prefix=before)
    assert [found[name]["status"] for name in ("rviz-fixed-frame", "rviz-shows-robot")] == ["passed", "passed"]


def test_another_frame_with_the_prefix(tmp_path: Path) -> None:
    """A wrong link is wrong with the prefix too; one that the robot has is not called missing."""
    found = results(tmp_path, prefix="'robot1/'", frame="robot1/base_link", tf_prefix="robot1")["rviz-fixed-frame"]
    assert (found["status"], "has no link" in found["message"]) == ("failed", False)


def test_a_prefix_that_is_known_only_at_run_time(tmp_path: Path) -> None:
    """A name that ends in the link's needs manual grading."""
    found = results(tmp_path, prefix="os.environ['ROBOT']", frame="robot1/base_footprint", tf_prefix="robot1")
    assert [found[name]["status"] for name in ("rviz-fixed-frame", "rviz-shows-robot")] == ["pending", "pending"]


def test_a_prefix_that_robot_state_publisher_does_not_have(tmp_path: Path) -> None:
    """Without a frame_prefix the frames are called like the links."""
    found = results(tmp_path, frame="robot1/base_footprint", tf_prefix="robot1")
    assert [found[name]["status"] for name in ("rviz-fixed-frame", "rviz-shows-robot")] == ["failed", "failed"]


def test_a_prefix_in_an_xml_launch_file(tmp_path: Path) -> None:
    """A <param> gives it as well."""
    sample = ROOT / "submissions/lab6/equivalent-launch-file-in-xml"
    shutil.copytree(sample, tmp_path / "sample")
    (launch,) = (tmp_path / "sample").rglob("*.launch.xml")
    (rviz,) = (tmp_path / "sample").rglob("*.rviz")
    param = '<param name="frame_prefix" value="robot1/"/><param name="robot_description"'
    assert '<param name="robot_description"' in launch.read_text()
    launch.write_text(launch.read_text().replace('<param name="robot_description"', param))
    rviz.write_text(rviz.read_text().replace("Fixed Frame: base_footprint", "Fixed Frame: robot1/base_footprint"))
    report = json.loads(run(("grade", tmp_path / "sample", "--format", "json")).stdout)
    (status,) = (result["status"] for result in report["results"] if result["id"] == "rviz-fixed-frame")
    assert status == "passed"
