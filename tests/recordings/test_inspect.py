"""`grader inspect` shows recordings: alone, and beside the launch file and the URDF of a workspace."""

import json
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.command_line import run
from tests.recordings.cart import URDF, files_of
from tests.recordings.writing import Recorded, encode, write_files, write_mcap

_LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='joint_state_publisher', executable='joint_state_publisher'),
        Node(package='robot_state_publisher', executable='robot_state_publisher'),
    ])
"""
_MANIFEST = """\
<package format="3"><name>cart</name><version>0.0.0</version><description>A cart</description>
<maintainer email="ann@example.com">Ann</maintainer><license>MIT</license>
<export><build_type>ament_cmake</build_type></export></package>
"""
WORKSPACE = {
    "cart/package.xml": _MANIFEST.encode(),
    "cart/urdf/cart.urdf": URDF.encode(),
    "cart/launch/cart.launch.py": _LAUNCH.encode(),
}


def _inspect(folder: Path, files: Mapping[str, bytes], *options: str) -> str:
    write_files(folder, files)
    done = run(["inspect", folder, *options])
    assert done.stderr == b""
    return " ".join(done.stdout.decode().split())


def test_a_recording_alone(tmp_path: Path) -> None:
    """Its length, motion, frames and topics are shown, with both rates if these differ."""
    shown = _inspect(tmp_path, files_of("drive", {"slower": 4, "metadata": False}))
    assert "it lasts 4.0 s, and has 207 messages" in shown
    assert "by /odom it drove 2.00 m forward on a path of 2.00 m, ended 2.00 m ahead" in shown
    assert "6 frames below 'odom'" in shown
    assert "there is no metadata.yaml" in shown
    assert (
        "/odom nav_msgs/msg/Odometry, 41 messages, 10.0 Hz (2.5 Hz by the recorder's clock)"
        in shown
    )


def test_a_file_alone(tmp_path: Path) -> None:
    """A data file is a recording, and no URDF; without any message it has neither rates nor motion."""
    path = tmp_path / "drive.mcap"
    path.write_bytes(write_mcap([], topics=[("/odom", "nav_msgs/msg/Odometry")]))
    done = run(["inspect", path])
    assert done.returncode == 0
    assert "it lasts 0.0 s, and has 0 messages" in done.stdout.decode()


def test_what_is_wrong_with_a_recording(tmp_path: Path) -> None:
    """Trees, frames that nothing publishes, and a time that goes back are told."""
    options = {"reset": 2, "extra": ["parent"], "no_odom_frame": True}
    shown = _inspect(tmp_path, files_of("drive", options))
    assert "the time of /odom goes back" in shown
    assert "'laser' has the parents base_footprint and base_link" in shown
    assert "/odom: no transform has 'odom'" in shown


def test_a_recording_in_a_workspace(tmp_path: Path) -> None:
    """It is compared with what the launch file starts, and with the URDF."""
    files = {
        **WORKSPACE,
        **files_of(
            "drive", {"laser": (0.1, 0, 0.17), "wheels": 0.5, "without": ["/robot_description"]}
        ),
    }
    shown = _inspect(tmp_path, files)
    launch = "cart/launch/cart.launch.py"
    assert f"/cmd_vel, /odom and /scan: nothing here publishes it ({launch})" in shown
    assert f"/robot_description: not recorded ({launch})" in shown
    place = "from where the URDF has it in 'base_link'"
    assert f"'laser' was recorded 20 mm {place}" in shown
    assert "by the wheels of cart/urdf/cart.urdf it drove 1.00 m, by /odom 2.00 m" in shown


@pytest.mark.parametrize("without", [["/tf_static"], ["/joint_states"]], ids=["frames", "states"])
def test_what_the_urdf_has_and_the_recording_has_not(without: list[str], tmp_path: Path) -> None:
    """Links without a transform are told; without joint states there is nothing to compare."""
    files = {"cart.urdf": URDF.encode(), **files_of("drive", {"without": without})}
    shown = _inspect(tmp_path, files)
    assert ("no transform was recorded of 'base_link' and 'laser'" in shown) == (
        without == ["/tf_static"]
    )


def test_the_json_has_recordings(tmp_path: Path) -> None:
    """Each topic has its types, its number of messages and both rates."""
    data = json.loads(_inspect(tmp_path, files_of("drive", {"slower": 4}), "--format", "json"))
    (recording,) = data["recordings"]
    topics = {topic["name"]: topic for topic in recording["topics"]}
    assert (recording["path"], recording["faults"]) == (tmp_path.name + "/drive", []) or recording[
        "path"
    ] == "drive"
    assert topics["/odom"] == {
        "name": "/odom",
        "types": ["nav_msgs/msg/Odometry"],
        "messages": 41,
        "rate": pytest.approx(10),
        "recorder_rate": pytest.approx(2.5),
    }


def test_a_recording_that_cannot_be_read(tmp_path: Path) -> None:
    """Alone it is an error in one line; beside another file it is told."""
    path = tmp_path / "drive.mcap"
    path.write_bytes(b"version https://git-lfs.github.com/spec/v1\n")
    done = run(["inspect", path])
    assert (done.returncode, done.stdout) == (2, b"")
    assert (
        done.stderr
        == b"grader: drive.mcap is a Git LFS pointer, not the recording: submit the file itself\n"
    )
    (tmp_path / "cart.urdf").write_text(URDF)
    assert "drive.mcap is a Git LFS pointer" in run(["inspect", tmp_path]).stdout.decode()


def test_a_robot_of_another_name_is_not_compared(tmp_path: Path) -> None:
    """Two robots are in the workspace, so neither is; and a metadata.yaml of something else is none."""
    message = encode("std_msgs/msg/String", {"data": "hello"})
    files = {
        "a.urdf": URDF.encode(),
        "b.urdf": URDF.replace('"cart"', '"other"').encode(),
        "metadata.yaml": b"a: 1",
        "hello.mcap": write_mcap([Recorded("/hello", "std_msgs/msg/String", 10**9, message)]),
    }
    assert "it lasts 0.0 s, and has 1 messages" in _inspect(tmp_path, files)
