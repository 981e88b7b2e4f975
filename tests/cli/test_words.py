"""Where ROS 2 or xacro rejects a file for one unambiguous word, the rest is graded as the file is meant."""

import json
import shutil
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.names import near
from tests.command_line import ROOT, run
from tests.examples import examples

ROWS = tomllib.loads((Path(__file__).parent / "words.toml").read_text(encoding="utf-8"))
PLAIN = ROOT / "rubrics/lab6/my_robot/urdf"
XACRO = ROOT / "submissions/lab6/equivalent-xacro-macros/my_robot/urdf"


def graded(kind: str, edits: list[list[str]], folder: Path) -> dict[str, Any]:
    """Return the JSON report on Task 1 of an edited robot, without hints."""
    shutil.copytree(PLAIN if kind == "plain" else XACRO, folder / "urdf")
    for old, new in edits:
        texts = {path: path.read_text(encoding="utf-8") for path in (folder / "urdf").iterdir()}
        assert any(old in text for text in texts.values()), old
        for path, text in texts.items():
            path.write_text(text.replace(old, new), encoding="utf-8")
    main = folder / "my_robot.urdf.xacro" if kind == "xacro" else folder / "my_robot.urdf"
    (folder / "urdf/my_robot.urdf").rename(main)
    for path in (folder / "urdf").glob("*"):
        path.rename(folder / path.name)
    done = run(("grade", main, "--format", "json", "--hints", "none", "--fail-under", "1"))
    report: dict[str, Any] = json.loads(done.stdout)
    return {**report, "exit": done.returncode}


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, rows in ROWS.items() for name in rows])
def test_a_word_costs_once(kind: str, name: str, tmp_path: Path) -> None:
    """Only `urdf-loads` fails if one word is the reason and clear; else nothing is assumed. `--fail-under` never passes."""
    row = ROWS[kind][name]
    report = graded(kind, row["edits"], tmp_path)
    first, *others = report["results"]
    lost = [one["id"] for one in others if one["status"] in ("failed", "skipped") and not one["carried"]]
    assert report["score"] == row["score"]
    if "verdict" in row:
        assert (first["status"], lost, report["exit"]) == ("passed", row["lost"], 0)
        return
    assert (first["status"], report["exit"]) == ("failed", 1)
    assert first["message"].partition("Not deducted elsewhere: ")[2] == row.get("told", "")


def test_the_report_says_that_ros_rejects_the_file(tmp_path: Path) -> None:
    """The head of the report says so, and an assumption is told once."""
    text = (PLAIN / "my_robot.urdf").read_text(encoding="utf-8")
    path = tmp_path / "my_robot.urdf"
    path.write_text(text.replace('<child link="lidar"/>', '<child link="Lidar"/>'), encoding="utf-8")
    shown = " ".join(run(("grade", path, "--hints", "none", "--verbose")).stdout.decode().split())
    assert "my_robot.urdf, which ROS 2 rejects" in shown[:100]
    assert shown.count("is read as 'lidar'") == 1
    inspected = json.loads(run(("inspect", path, "--format", "json")).stdout)
    assert inspected["verdict"] == "rejected"
    assert [row["message"] for row in inspected["problems"] if row["code"] == "URDF015"] == [
        "the link 'Lidar' is read as 'lidar'"
    ]


def test_nothing_is_assumed_about_a_file_of_many_unknown_names(tmp_path: Path) -> None:
    """Comparing them all would take long, and nobody misspells as many."""
    path = tmp_path / "my_robot.urdf"
    joints = (
        f'<joint name="j{i}" type="fixed"><parent link="lidar"/><child link="lidr_{i}"/></joint><link name="lidar_{i}"/>'
        for i in range(21)
    )
    text = (PLAIN / "my_robot.urdf").read_text(encoding="utf-8")
    path.write_text(text.replace("</robot>", f"{''.join(joints)}</robot>"), encoding="utf-8")
    report = json.loads(run(("grade", path, "--format", "json", "--hints", "none")).stdout)
    assert "Not deducted" not in report["results"][0]["message"]


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_utf_16_costs_the_loading(encoding: str, tmp_path: Path) -> None:
    """ROS 2 cannot read UTF-16; the report says what to do, and the robot is graded."""
    path = tmp_path / "my_robot.urdf"
    path.write_bytes((PLAIN / "my_robot.urdf").read_text(encoding="utf-8").encode(encoding))
    report = json.loads(run(("grade", path, "--format", "json")).stdout)
    assert (report["score"], report["results"][0]["location"]["line"]) == (67, 1)
    assert report["results"][0]["message"] == "the file is UTF-16 text, which ROS 2 cannot read; save it as UTF-8"


SAME = [
    ("wheel_lenght", "wheel_length", ""), ("Left_wheel", "left_wheel", ""), ("leftWheel", "left_wheel", ""),
    ("baselink", "base_link", ""), ("base", "base_link", "link"), ("lidr", "lidar_link", "link"),
    ("lidar_jiont", "lidar_joint", "joint"), ("rigth_wheel", "right_wheel", ""), ("fotoprnit", "footprint", ""),
]  # fmt: skip
OTHER = [
    ("y_offset", "x_offset", ""), ("link_4", "link_0", ""), ("link_11", "link_1_1", ""), ("right_wheel", "front_wheel", ""),
    ("lower_arm", "upper_arm", ""), ("wheel_width", "wheel_height", ""), ("arm_l", "arm_r", ""), ("art", "arm", ""),
    ("whl", "wheel", ""), ("base", "base_link", ""), ("base_wheel", "base", "link"), ("max_speed", "min_speed", ""),
]  # fmt: skip


@pytest.mark.parametrize("row", SAME)
def test_near_names(row: tuple[str, str, str]) -> None:
    """Letter case, one or two letters of a long word, and the suffix of the kind may differ."""
    assert near(row[0], [row[1], "another_name"], row[2]) == row[1]


@pytest.mark.parametrize("row", OTHER)
def test_other_names(row: tuple[str, str, str]) -> None:
    """Numbers, single letters and words of side, place, axis or measure never stand for one another."""
    assert near(row[0], [row[1]], row[2]) is None


@examples(60)
@given(st.text("ab1_", max_size=6), st.sets(st.text("ab1_", max_size=6), max_size=4))
def test_the_nearest_is_another_known_name(name: str, known: set[str]) -> None:
    """What a name stands for is one of the known ones, does not depend on their order, and has the same numbers."""
    found = near(name, sorted(known))
    assert found == near(name, sorted(known, reverse=True))
    assert found is None or (found in known - {name} and [*filter(str.isdigit, found)] == [*filter(str.isdigit, name)])
