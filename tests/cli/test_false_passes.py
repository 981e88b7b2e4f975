"""What looks correct number by number, and is not: each mistake costs the criterion that it is about, and says why."""

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import ROOT, run

REFERENCE = ROOT / "rubrics/lab6/my_robot"
URDF, LAUNCH, SETUP = "urdf/my_robot.urdf", "launch/my_robot_rviz.launch.py", "setup.py"
LEFT = '<child link="left_wheel"/>\n    <origin xyz="-0.15 0.2 0" rpy="-1.57 0 0"/>'
RIGHT = '<parent link="base_link"/>\n    <child link="right_wheel"/>\n    <origin xyz="-0.15 -0.2 0" rpy="-1.57 0 0"/>'
ON_THE_LEFT_WHEEL = '<parent link="left_wheel"/><child link="right_wheel"/><origin xyz="0 0 -0.4" rpy="-1.57 0 0"/>'
LIDAR = '<origin xyz="0.15 0 0.225" rpy="0 0 0"/>'
OPEN = "open(os.path.join(share, 'my_robot.urdf'))"
CP1252 = "<!-- Räder", "<!-- Wheels"


def graded(folder: Path, changes: Mapping[str, tuple[str, str]]) -> dict[str, Any]:
    """Return the JSON report on the reference with a text replaced in some files, which are saved in cp1252."""
    shutil.copytree(REFERENCE, folder, dirs_exist_ok=True)
    for path, (new, old) in changes.items():
        text = (folder / path).read_text(encoding="utf-8")
        assert old in text
        (folder / path).write_text(text.replace(old, new, 1), encoding="cp1252")
    found: dict[str, Any] = json.loads(run(("grade", folder, "--format", "json", "--hints", "none")).stdout)
    return found


def failures(found: Mapping[str, Any]) -> dict[str, str]:
    """Return the message of each criterion that fails and loses its points, with the line."""
    rows = [row for row in found["results"] if row["status"] == "failed" and not row["carried"]]
    return {row["id"]: f"{row['message']} [{(row['location'] or {}).get('line')}]" for row in rows}


@pytest.mark.parametrize(
    ("new", "old", "criterion", "message"),
    [
        (LIDAR.replace("0 0 0", "0 3.14 0"), LIDAR, "lidar-frame", "its orientation is 180 degrees off rpy 0 0 0 [39]"),
        (f'{LEFT}<mimic joint="base_right_wheel_joint"/>', LEFT, "left-wheel-continuous", "mimics another joint; it"),
        (f'{LEFT}<mimic joint="base_left_wheel_joint"/>', LEFT, "left-wheel-continuous", "_joint') [56]"),
        (f'{LEFT}<limit effort="1" velocity="0"/>', LEFT, "left-wheel-continuous", "is 0; it should be more than 0"),
        ('"0.9 0.9 0.9 0"', '"0.9 0.9 0.9 1"', "lidar-white", "alpha is 0, so it is invisible; it should be at least"),
        (ON_THE_LEFT_WHEEL, RIGHT, "right-wheel-forward", "about an axis 89.9 degrees off level; at most 45 degrees"),
        ("0.6 -0.4 0.2", "0.6 0.4 0.2", "base-box", "0.6 -0.4 0.2 m; it should be 0.6 0.4 0.2 m (x, y, z) [20]"),
    ],
)
def test_a_mistake_that_the_numbers_hide(new: str, old: str, criterion: str, message: str, tmp_path: Path) -> None:
    """The criterion fails at the attribute that is wrong, with what was measured and expected."""
    assert message in failures(graded(tmp_path, {URDF: (new, old)}))[criterion]


@pytest.mark.parametrize(
    ("how", "is_read"),
    [("", False), (", encoding='utf-8'", False), (", 'r', -1, 'UTF_8', 'strict'", False),
     (", encoding='cp1252'", True), (", errors='replace'", True), (", 'rb'", True)],
)  # fmt: skip
def test_a_urdf_that_the_launch_file_cannot_decode(how: str, is_read: bool, tmp_path: Path) -> None:
    """Python reads a text as UTF-8 unless it is told otherwise."""
    found = failures(graded(tmp_path, {URDF: CP1252, LAUNCH: (f"{OPEN[:-1]}{how})", OPEN)}))
    why = "reading the URDF stops the launch file with a UnicodeDecodeError: it is not UTF-8"
    expected = {"launch-finds-files": f"{why} (line 42 of my_robot.urdf); save it as UTF-8 [17]"}
    assert found == ({} if is_read else expected)


@pytest.mark.parametrize("read", ["Path(share, 'my_robot.urdf').read_text({})", "codecs.open({}, 'r', 'utf-8').read()"])
def test_other_ways_to_read_a_text(read: str, tmp_path: Path) -> None:
    """A path reads with the encoding as its first argument; the module codecs has it third."""
    code = "import codecs\n    from pathlib import Path\n    robot_description = "
    given = OPEN[5:-1] if read.startswith("codecs") else ""
    loop = f"with {OPEN} as file:\n        robot_description = file.read()"
    broken = failures(graded(tmp_path / "a", {URDF: CP1252, LAUNCH: (code + read.format(given), loop)}))
    assert [*broken] == ["launch-finds-files"]
    fixed = read.replace("utf-8", "cp1252").format(given or "'cp1252'")
    assert failures(graded(tmp_path / "b", {URDF: CP1252, LAUNCH: (code + fixed, loop)})) == {}


ENTRY = "        (os.path.join('share', package_name), ['package.xml']),\n"


@pytest.mark.parametrize(
    ("new", "old"),
    [("", ""), ("['rviz/other.rviz']", "glob('rviz/*')"), ("'robot'", "'my_robot'"), ("input()", "glob('rviz/*')")],
)
def test_a_missing_entry_for_package_xml_is_always_reported(new: str, old: str, tmp_path: Path) -> None:
    """Also if another entry stops the build or is not known, or the names differ."""
    shutil.copytree(REFERENCE, tmp_path, dirs_exist_ok=True)
    text = (tmp_path / SETUP).read_text(encoding="utf-8")
    (tmp_path / SETUP).write_text(text.replace(ENTRY, "").replace(old, new, 1), encoding="utf-8")
    assert b"PKG015 warning setup.py:8" in run(("grade", tmp_path)).stdout
