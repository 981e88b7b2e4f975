"""`grader graph --recorded`: what was heard of the topics that nodes publish."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run
from tests.recordings.cart import URDF
from tests.recordings.test_inspect import _MANIFEST
from tests.recordings.writing import Recorded, encode, write_files, write_mcap, write_sqlite

_NODE = """\
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float32, String


class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.create_publisher(String, 'words', QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
        self.create_publisher(String, 'numbers', 10)
        self.create_publisher(Float32, 'silence', 10)
        self.create_publisher(Float32, 'forgotten', 10)


def main():
    rclpy.init()
    rclpy.spin(Talker())
"""
_SETUP = """\
from setuptools import setup

setup(name='cart', packages=['cart'], entry_points={'console_scripts': ['talker = cart.talker:main']},
      data_files=[('share/cart/launch', ['launch/talk.launch.py']), ('share/cart', ['package.xml'])])
"""
_LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package='cart', executable='talker')])
"""
_PACKAGE = {
    "cart/package.xml": _MANIFEST.replace("ament_cmake", "ament_python").encode(),
    "cart/setup.py": _SETUP.encode(),
    "cart/cart/__init__.py": b"",
    "cart/cart/talker.py": _NODE.encode(),
    "cart/launch/talk.launch.py": _LAUNCH.encode(),
}
_STRING, _FLOAT = "std_msgs/msg/String", "std_msgs/msg/Float32"
_HUMBLE = "- history: 3\n  depth: 0\n  reliability: 1\n  durability: 2\n"
_JAZZY = "- history: unknown\n  reliability: reliable\n  durability: volatile\n"


def _heard(folder: Path, data: bytes) -> dict[str, dict[str, Any]]:
    """Return what the JSON of the graph has of each topic of a recording."""
    write_files(
        folder, {**{f"ws/{path}": file for path, file in _PACKAGE.items()}, "talk.mcap": data}
    )
    done = run(["graph", folder / "ws", "--recorded", folder / "talk.mcap", "--format", "json"])
    return {topic["name"]: topic for topic in json.loads(done.stdout)["recorded"]}


def _messages() -> list[Recorded]:
    topics = {"/words": _STRING, "/numbers": _FLOAT, "/other": _STRING, "/rosout": _STRING}
    return [
        Recorded(topic, kind, (100 + second) * 10**9, encode(kind, {}))
        for topic, kind in topics.items()
        for second in range(5)
    ]


@pytest.mark.parametrize("qos", [_HUMBLE, _JAZZY], ids=["humble", "jazzy"])
@pytest.mark.parametrize("write", [write_mcap, write_sqlite])
def test_what_was_heard(write: Any, qos: str, tmp_path: Path) -> None:
    """Types, rates and quality of service are compared, and topics that were not heard, not recorded or not known are told."""
    heard = _heard(tmp_path, write(_messages(), topics=[("/silence", _FLOAT)], qos=qos))
    assert {name: topic["differences"] for name, topic in heard.items()} == {
        "/forgotten": ["not recorded"],
        "/numbers": ["/talker publishes std_msgs/msg/String"],
        "/other": ["nothing here publishes it"],
        "/silence": ["never heard"],
        "/words": ["/talker publishes best effort"],
    }
    assert heard["/words"] == {
        "name": "/words",
        "types": [_STRING],
        "messages": 5,
        "rate": 1.0,
        "reliability": "reliable",
        "durability": "volatile",
        "publishers": ["/talker"],
        "differences": ["/talker publishes best effort"],
    }


def test_a_recording_without_quality_of_service(tmp_path: Path) -> None:
    """It is not compared; several publishers with different ones leave it unknown as well."""
    heard = _heard(tmp_path, write_sqlite(_messages()))
    assert heard["/words"]["differences"] == []
    both = _JAZZY + _JAZZY.replace("reliable", "best_effort")
    heard = _heard(tmp_path, write_mcap(_messages(), qos=both))
    assert (heard["/words"]["reliability"], heard["/words"]["durability"]) == (None, "volatile")


def test_the_text_has_what_was_heard(tmp_path: Path) -> None:
    """A line for each topic, with its rate and its publishers."""
    _heard(tmp_path, write_mcap(_messages(), qos=_JAZZY))
    done = run(["graph", tmp_path / "ws", "--recorded", tmp_path / "talk.mcap"])
    text = " ".join(done.stdout.decode().split())
    assert (
        "Recorded /forgotten [0 messages] <- /talker not recorded "
        "/numbers [std_msgs/msg/Float32, 5 messages, 1.0 Hz] <- /talker /talker publishes" in text
    )


def test_no_recording(tmp_path: Path) -> None:
    """A path without one is refused."""
    write_files(tmp_path, {**_PACKAGE, "cart.urdf": URDF.encode()})
    done = run(["graph", tmp_path, "--recorded", tmp_path / "cart.urdf"])
    assert done.returncode == 2
    assert b"--recorded" in done.stderr
