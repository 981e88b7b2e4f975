"""`grader inspect` and `grader grade` of xacro that is refused or cannot be determined: never an internal error."""

import json
from pathlib import Path

import pytest

from tests.command_line import run

OPEN = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base_link"/>'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('<link name="$(env ROBOT)"/>', "the environment variable ROBOT is known only at run time"),
        ('<link name="$(arg name)"/>', "the argument name has no default; give it with --arg name=VALUE"),
        ('<link name="${9**9**9**9}"/>', "a number grows too large"),
    ],
)
def test_a_link_of_an_unknown_name_has_no_pose(text: str, message: str, tmp_path: Path) -> None:
    """A robot that may have more links than are known is inspected: the pose of an unconnected link is undefined."""
    path = tmp_path / "robot.urdf.xacro"
    path.write_text(f"{OPEN}{text}</robot>")
    done = run(("inspect", path, "--format", "json"))
    found = json.loads(done.stdout)
    assert (done.returncode, found["verdict"], [problem["message"] for problem in found["problems"]]) == (
        1,
        "undecided",
        [message],
    )
    assert found["robot"]["links"][0] == "base_link"
    assert list(found["poses"].values())[1:] == [None]
    shown = run(("inspect", path))
    assert shown.returncode == 1
    assert b"robot.urdf.xacro: xacro that cannot be determined statically, robot 'r'" in shown.stdout
    joint = run(("inspect", path, "--joint", "wheel=1"))
    assert (joint.returncode, joint.stdout) == (2, b"")
    assert joint.stderr.endswith(f"grader: --joint: {message}\n".encode())


def test_xacro_that_cannot_be_expanded_has_no_poses(tmp_path: Path) -> None:
    """Without any link there is neither a tree nor a frame: the verdict and the reason are shown, and nothing else."""
    path = tmp_path / "robot.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="$(find a)/b"/></robot>'
    )
    done = run(("inspect", path))
    assert (done.returncode, done.stdout.count(b"XACRO006"), b"Poses" in done.stdout) == (1, 1, False)
    assert b"the part that can be determined of what xacro expands it to" in done.stderr
    page = run(("inspect", path, "--format", "html"))
    assert b"xacro that cannot be determined statically" in page.stdout


def test_a_required_attribute_is_missing_beside_one_that_xacro_refuses(tmp_path: Path) -> None:
    """An element with an attribute that xacro refuses is read: that a required one is missing is a problem too."""
    joint = '<joint name="j" type="continuous"><parent link="base_link"/><child link="a"/><limit x="${y}"/></joint>'
    path = tmp_path / "robot.urdf.xacro"
    path.write_text(f'{OPEN}<link name="a"/>{joint}</robot>')
    done = run(("inspect", path, "--format", "json"))
    codes = {problem["code"] for problem in json.loads(done.stdout)["problems"]}
    assert (done.returncode, codes) == (1, {"URDF065", "URDF072", "XACRO002"})


def test_a_misspelt_name_of_xacro_itself(tmp_path: Path) -> None:
    """An undefined name that is like a constant or function of xacro has it as a suggestion."""
    path = tmp_path / "robot.urdf.xacro"
    path.write_text(f'{OPEN}<link name="${{PI}}"/></robot>')
    done = run(("inspect", path, "--format", "json"))
    messages = [problem["message"] for problem in json.loads(done.stdout)["problems"]]
    wanted = "there is no property PI at this place; did you mean 'pi'? xacro stops here, and ROS 2 gets no robot"
    assert wanted in messages
