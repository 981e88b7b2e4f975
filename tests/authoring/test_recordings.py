"""A rubric of an instructor's run: what it asks for, and which mistakes of the recording it finds."""

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run
from tests.recordings.cart import URDF, files_of
from tests.recordings.test_robots import ARM, _arm_recording
from tests.recordings.writing import Recorded, encode, write_files, write_mcap, write_metadata


def _draft(folder: Path, *options: str) -> tuple[dict[str, dict[str, Any]], str]:
    """Return the criteria of recordings in a new rubric by their ids, and what the command prints."""
    done = run(["rubric", "new", folder / "lab.toml", "--force", *options])
    assert done.returncode == 0, done.stderr
    rubric = tomllib.loads((folder / "lab.toml").read_text())
    part = rubric["defaults"]["part"]
    return {
        row["id"]: row for row in rubric["criterion"] if row.get("part", part) == "recording"
    }, done.stdout.decode()


def _test(folder: Path) -> dict[str, Any]:
    done = run(["rubric", "test", folder / "lab.toml", "--format", "json"])
    test: dict[str, Any] = json.loads(done.stdout)
    return test


def test_a_run_becomes_a_rubric(tmp_path: Path) -> None:
    """It asks for the topics, rates, drive, frames and wheels of the run, and every mutant loses points."""
    drive = files_of("drive", {"slower": 2})
    write_files(tmp_path / "cart", {"cart.urdf": URDF.encode(), **drive})
    criteria, _ = _draft(
        tmp_path, "--from", f"{tmp_path}/cart", "--recording", f"{tmp_path}/cart/drive"
    )
    asked = {row["check"]: row.get("with", {}) for row in criteria.values()}
    assert asked["recording_found"] == {"seconds": 3.2}
    assert criteria["odom-recorded"]["with"] == {
        "topic": "/odom",
        "type": "nav_msgs/msg/Odometry",
        "rate": 8.0,
    }
    assert "rate" not in criteria["cmd-vel-recorded"]["with"]
    place = {"forward": 2.0, "ahead": 2.0, "left": 0.0, "tolerance": 0.2}
    assert criteria["drove"]["with"] == place
    assert criteria["drove-turn"]["with"] == {"turn": 0.0, "angle": 5.0}
    assert {"recorded_tree", "recorded_frames_agree", "wheels_agree"} <= asked.keys()
    assert (
        '# with = { topic = "/scan", field = "ranges", smallest = 0.8 }'
        in (tmp_path / "lab.toml").read_text()
    )
    test = _test(tmp_path)
    assert test["reference"]["score"] == 100
    assert test["survivors"] == []
    recordings = next(kind for kind in test["mutants"]["kinds"] if kind["kind"] == "recordings")
    assert recordings["caught"] == recordings["graded"] == 16


def test_mutants_that_a_rubric_does_not_find(tmp_path: Path) -> None:
    """A rubric that asks for the length alone is told which mistakes of the recording cost nothing."""
    files = files_of("drive", {"sqlite": True, "slash": "/"})
    write_files(tmp_path / "cart", {"cart.urdf": URDF.encode(), **files})
    rubric = """\
id = "lab"
title = "Lab"
reference = "cart"
[[part]]
id = "run"
title = "Run"
needs = "files"
[[criterion]]
id = "long"
part = "run"
title = "It is long enough"
points = 1
check = "recording_found"
with = { seconds = 3 }
"""
    (tmp_path / "lab.toml").write_text(rubric)
    survivors = {row["id"] for row in _test(tmp_path)["survivors"]}
    for mutant in (
        "recorded drive reversed: /odom",
        "recorded frame moved: laser",
        "recorded frame moved: left_wheel",
        "recorded rate halved: /joint_states",
        "recorded topic lost: /cmd_vel",
    ):
        assert mutant in survivors


@pytest.mark.parametrize(
    ("options", "omitted"),
    [
        ({"reset": 2.0}, "the time of /odom goes back"),
        ({"speeds": [(0.0, 0.0, 4.0)]}, "by /odom the base hardly moved"),
    ],
)
def test_a_drive_that_is_not_asked_for(
    options: dict[str, Any], omitted: str, tmp_path: Path
) -> None:
    """Of a run that does not move, or whose time goes back, the output says that its drive is omitted."""
    write_files(tmp_path, files_of("drive", options))
    criteria, output = _draft(tmp_path, "--recording", f"{tmp_path}/drive")
    assert omitted in " ".join(output.split())
    assert "drove" not in criteria
    assert "recording-found" in criteria


def test_what_is_wrong_in_a_run_is_told(tmp_path: Path) -> None:
    """Links without a transform and headers without a time make no criteria; one of several recordings is named."""
    options = {"zero_stamps": True, "without": ["/tf_static"], "speeds": [(0.5, 0.2, 4.0)]}
    two_types = [
        Recorded("/beat", kind, 10**9, encode(kind, {"data": 1}))
        for kind in ("std_msgs/msg/Int32", "std_msgs/msg/Float64")
    ]
    write_files(
        tmp_path / "cart",
        {
            "cart.urdf": URDF.encode(),
            **files_of("drive", options),
            "beats/beats_0.mcap": write_mcap(two_types),
            "beats/metadata.yaml": write_metadata("beats_0.mcap"),
        },
    )
    path = f"{tmp_path}/cart"
    recording = f"{path}/drive/drive_0.mcap"
    criteria, output = _draft(tmp_path, "--from", path, "--recording", recording)
    assert "the time in the headers of all messages of /odom is 0" in " ".join(output.split())
    assert "recorded_tree and recorded_frames_agree: /tf_static was not recorded" in output
    assert criteria["drove-turn"]["with"] == {"turn": 45.8, "angle": 5.0, "name": "drive"}
    criteria, _ = _draft(tmp_path, "--from", path, "--recording", f"{path}/beats")
    assert criteria["beat-recorded"]["with"] == {"topic": "/beat", "name": "beats"}


def test_an_arm(tmp_path: Path) -> None:
    """Where joints end is a comment, and other criteria are about its frames."""
    write_files(tmp_path / "arm", {"arm.urdf": ARM.encode(), "moves.mcap": _arm_recording()})
    path = f"{tmp_path}/arm"
    criteria, _ = _draft(tmp_path, "--from", path, "--recording", f"{path}/moves.mcap")
    assert "drove" not in criteria
    text = (tmp_path / "lab.toml").read_text()
    assert 'field = "position[gripper]"' in text


def test_no_such_recording(tmp_path: Path) -> None:
    """A path without a recording, or neither a reference nor a recording, is refused."""
    write_files(tmp_path / "cart", {"cart.urdf": URDF.encode()})
    file, path = tmp_path / "lab.toml", f"{tmp_path}/cart"
    done = run(["rubric", "new", file, "--from", path, "--recording", f"{path}/drive"])
    assert done.returncode == 2
    assert b"the reference has no recording of `ros2 bag record` at drive" in done.stderr
    done = run(["rubric", "new", file])
    assert done.returncode == 2
    assert b"give --from PATH, or --recording PATH" in done.stderr
