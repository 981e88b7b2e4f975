"""The page of `grader view` has a recording as numbers that move the robot."""

from itertools import accumulate
from pathlib import Path
from typing import Any

import pytest

from grader.app.commands.view_server import RobotPages
from grader.app.commands.viewed_robots import ViewRequest, read_robots
from grader.base.errors import InputError
from grader.files.reading import URDF_LIMIT
from tests.command_line import ROOT
from tests.recordings.cart import RADIUS, URDF, files_of
from tests.recordings.test_robots import ARM, _arm_recording
from tests.recordings.writing import write_files
from tests.view_server import Page

_LOG = """\
[talker-1] [INFO] [1700000001.500000000] [talker]: half way
[ERROR] [1600000000.0] [talker]: of another run
no time
"""


def _page(path: Path, rubric: str = "", log: str = "") -> Page:
    """Return the first page of a path."""
    pages = RobotPages()
    pages.log = log.encode() or None
    pages.show(read_robots(ViewRequest(str(path), rubric, (), URDF_LIMIT), {}, pages.log))
    page = pages(("",), None)
    return Page(page.body.decode())


def _playback(page: Page) -> dict[str, Any]:
    """Return the recording of a page, with numbers in place of steps."""
    data: dict[str, Any] = page.data["robot"]["playback"]
    for key, columns in (("joints", data["joints"]), ("pose", dict(enumerate(data["pose"])))):
        data[key] = {
            name: [step / data["unit"] for step in accumulate(steps)]
            for name, steps in columns.items()
        }
    data["times"] = [step / data["unit"] for step in accumulate(data["times"])]
    return data


def test_a_drive(tmp_path: Path) -> None:
    """It has the poses of the base, the positions of the wheels, which links are wrong, and what was printed meanwhile."""
    options = {"wraps": True, "laser": (0.1, 0, 0.17)}
    write_files(tmp_path, {"cart.urdf": URDF.encode(), **files_of("drive", options)})
    data = _playback(_page(tmp_path, log=_LOG))
    assert (len(data["times"]), data["times"][-1], data["base"]) == (41, 4, "base_footprint")
    assert data["pose"][0][-1] == pytest.approx(2)
    assert [data["pose"][axis][-1] for axis in range(1, 7)] == [0, 0, 0, 0, 0, 1]
    assert data["joints"]["left_joint"][-1] == pytest.approx(2 / RADIUS)
    (wrong,) = data["wrong"]
    assert (wrong["link"], wrong["parent"], wrong["pose"][11]) == ("laser", "base_link", 0.17)
    assert data["log"] == [[1.5, "[INFO] [1700000001.500000000] [talker]: half way"]]


def test_a_recording_without_a_urdf(tmp_path: Path) -> None:
    """The recorded robot description is the robot; without one, or without messages, there is none to show."""
    write_files(tmp_path, files_of("drive", {"namespace": "/one"}))
    assert _playback(_page(tmp_path / "drive"))["base"] == "base_footprint"
    write_files(tmp_path, files_of("other", {"without": ["/robot_description"]}))
    with pytest.raises(InputError, match="has no robot to show"):
        _page(tmp_path / "other")


def test_an_arm_has_no_base(tmp_path: Path) -> None:
    """Its joints are moved by the times of its states; joints of other types are not."""
    write_files(tmp_path, {"arm.urdf": ARM.encode(), "moves.mcap": _arm_recording()})
    data = _playback(_page(tmp_path))
    assert (data["base"], data["pose"]) == ("", {})
    assert {"shoulder", "lift", "gripper"} <= data["joints"].keys()
    assert len(data["times"]) == len(data["joints"]["shoulder"])


@pytest.mark.parametrize(
    "options",
    [
        {"prefix": "other_robot/", "without": ["/joint_states"], "no_odom_frame": True},
        {"reset": 2.0, "without": ["/joint_states"]},
        {"speeds": [(0.5, 0, 0)]},
        {"empty": True},
    ],
    ids=["another-robot", "reset", "one-message", "empty"],
)
def test_nothing_to_play(options: dict[str, Any], tmp_path: Path) -> None:
    """A page without a recording that moves the robot has no playback."""
    robot = URDF.replace("base_footprint", "base").replace("_link", "_frame")
    urdf = robot if "prefix" in options else URDF
    write_files(tmp_path, {"cart.urdf": urdf.encode(), **files_of("drive", options)})
    assert _page(tmp_path).data["robot"].get("playback") is None


def test_a_graded_robot() -> None:
    """The page of a report has the recording as well."""
    page = _page(ROOT / "submissions/rover/recorded-with-lidar-aside", "rover")
    data = _playback(page)
    assert [one["link"] for one in data["wrong"]] == ["lidar"]
    assert "recorded-robot" in page.text


def test_a_page_of_one_minute_is_small(tmp_path: Path) -> None:
    """A recording of a minute with 100 poses a second adds at most 100 kB."""
    write_files(tmp_path, {"cart.urdf": URDF.encode()})
    alone = len(_page(tmp_path).text)
    speeds = [(0.5, 0.3, 30.0), (0.4, -0.2, 30.0)]
    write_files(tmp_path, files_of("drive", {"rate": 100.0, "speeds": speeds}))
    page = _page(tmp_path)
    assert _playback(page)["times"][-1] > 59
    assert len(page.text) - alone < 100_000
