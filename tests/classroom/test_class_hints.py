"""Hints in the reports of a class, through the command line."""

import json
import re
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from tests.classroom.class_runs import WITH_HOSTILE, Done, grader
from tests.edits_rubric import copy_with_edits
from tests.samples import ROOT

pytestmark = pytest.mark.exhaustive
LAB = ROOT / "rubrics/lab6"
REFERENCE = (LAB / "my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
_RIGHT = 'xyz="-0.15 -0.2 0" rpy="-1.57 0 0"'
MIRRORED = REFERENCE.replace(_RIGHT, _RIGHT.replace("-1.57", "1.57"))
BURIED = REFERENCE.replace('xyz="0.15 0 0.225"', 'xyz="0.15 0 0.2"')
BOTH = MIRRORED.replace('xyz="0.15 0 0.225"', 'xyz="0.15 0 0.2"')
BRIGHT = REFERENCE.replace('rgba="0 0.6 0 1"', 'rgba="0 1 0 1"')
OTHER_LINES = MIRRORED.replace("<link", "<!-- mine -->\n\n  <link").replace(
    'rpy="1.57 0 0"', 'rpy="1.570 0 0"'
)
CLASS = {
    "ash.urdf": MIRRORED,
    "birch.urdf": OTHER_LINES,
    "cedar.urdf": MIRRORED,
    "elm/my_robot.urdf": MIRRORED,
    "fir.urdf": BURIED,
    "hazel.urdf": BURIED.replace('name="my_robot"', 'name="hazels"'),
    "holly/holly.urdf": BURIED,
    "juniper.urdf": BOTH,
    "larch.urdf": BRIGHT,
    "maple.urdf": REFERENCE,
    "oak.urdf": REFERENCE.replace("0.15 0 0.225", "0.150 0.0 0.225"),
    "pine/notes.txt": "I was ill.",
}
STUDENTS = {re.split(r"[/.]", path)[0]: path for path in CLASS}


def make(folder: Path, files: dict[str, str] = CLASS) -> Path:
    """Write a class and return its folder."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def batch(top: Path, *more: str | Path) -> Done:
    """Grade the class in a folder into its gradebook."""
    done = grader("batch", top / "class", "--gradebook", top / "g", *more)
    assert done.returncode == 0, done.stderr
    return done


def reports(folder: Path, names: Iterable[str] = STUDENTS) -> dict[str, dict[str, Any]]:
    """Return the reports of students as JSON."""
    return {
        name: json.loads((folder / f"{name}.json").read_text(encoding="utf-8")) for name in names
    }


def hints(report: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the hints of a report, each once."""
    found = [hint for result in report["results"] for hint in result["hints"]]
    return [hint for index, hint in enumerate(found) if hint not in found[:index]]


@pytest.fixture(scope="module")
def top(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a class of twelve and its gradebook, of a rubric whose hints may show edits."""
    top = tmp_path_factory.mktemp("hints")
    make(top / "class")
    batch(top, "--jobs", "2", "--rubric", copy_with_edits(top / "lab6"))
    return top


def test_reports_have_hints_for_the_students_own_text(top: Path) -> None:
    """The edit is in the student's file, at the student's line; it is the hint that `grade` shows."""
    batch(top, "--reports", top / "reports", "--report-format", "json", "--jobs", "2")
    found = reports(top / "reports")
    without = {"maple", "oak", "pine"}
    assert {name for name, report in found.items() if not hints(report)} == without
    for name in STUDENTS.keys() - without:
        lines = (top / "class" / STUDENTS[name]).read_text(encoding="utf-8").splitlines()
        for hint in hints(found[name]):
            (edit,) = hint["edits"]
            assert edit["path"] == found[name]["submission"]["path"]
            assert lines[edit["line"] - 1][edit["column"] - 1 :].startswith(edit["old"])
    assert hints(found["ash"])[0]["edits"][0]["line"] < hints(found["birch"])[0]["edits"][0]["line"]
    for name in ("elm", "holly"):
        rubric = top / "lab6/rubric.toml"
        alone = grader("grade", top / "class" / name, "--rubric", rubric, "--format", "json").stdout
        assert json.loads(alone)["results"] == found[name]["results"]


@pytest.mark.parametrize("level", ["none", "place", "cause"])
def test_the_rubric_says_how_much_reports_tell(tmp_path: Path, level: str) -> None:
    """Below the level edit reports have no edit."""
    shutil.copytree(LAB / "my_robot", tmp_path / "lab/my_robot")
    text = (
        (LAB / "rubric.toml")
        .read_text(encoding="utf-8")
        .replace('hints = "cause"', f'hints = "{level}"')
    )
    rubric = tmp_path / "lab/lab6.toml"
    rubric.write_text(text, encoding="utf-8")
    make(tmp_path / "class", {"ash.urdf": MIRRORED})
    batch(
        tmp_path, "--rubric", rubric, "--reports", tmp_path / "reports", "--report-format", "json"
    )
    for hint in hints(reports(tmp_path / "reports", ["ash"])["ash"]):
        assert hint["edits"] == []
        assert "-1.57" not in hint["message"]
        assert ("the sign of the roll" in hint["message"]) == (level == "cause")
    assert bool(hints(reports(tmp_path / "reports", ["ash"])["ash"])) == (level != "none")


def test_a_manual_mark_replaces_a_hint(top: Path) -> None:
    """A person has decided the criterion: no hint promises its points."""
    assert grader("mark", "fir", "lidar-frame", "5", "--gradebook", top / "g").returncode == 0
    batch(top, "--reports", top / "reports", "--report-format", "json")
    results = {
        result["id"]: result for result in reports(top / "reports", ["fir"])["fir"]["results"]
    }
    assert results["lidar-frame"]["hints"] == []
    assert results["lidar-on-top"]["hints"]


def test_a_lost_search_costs_only_its_own_hints(tmp_path: Path) -> None:
    """A crash and a timeout while edits are tried: every report is written, and the others have hints."""
    names = {"ash": "dies_when_tried", "birch": "fine", "cedar": "loops_when_tried"}
    body = '<link name="base"><visual><geometry><box size="1 1 2"/></geometry></visual></link>'
    make(
        tmp_path / "class",
        {f"{key}.urdf": f'<robot name="{name}">{body}</robot>' for key, name in names.items()},
    )
    text = (ROOT / "tests/classroom/hostile/hostile.toml").read_text(encoding="utf-8")
    box = 'check = "shows_box"\nwith = { link = "base", size = [1, 1, 1], tolerance = 0.001 }'
    rubric = tmp_path / "lab.toml"
    (tmp_path / "correct.urdf").write_text(
        f'<robot name="r">{body.replace("1 1 2", "1 1 1")}</robot>'
    )
    rubric.write_text(
        f'reference = "correct.urdf"\n{text}\n[[criterion]]\nid = "box"\npart = "all"\ntitle = "Box"\npoints = 1\n{box}\n'
    )
    done = grader(
        "batch",
        tmp_path / "class",
        "--gradebook",
        tmp_path / "g",
        "--rubric",
        rubric,
        "--timeout",
        "3",
        "--reports",
        tmp_path / "reports",
        "--report-format",
        "json",
        "--jobs",
        "2",
        **WITH_HOSTILE,
    )
    assert done.returncode == 0, done.stderr
    found = reports(tmp_path / "reports", names)
    assert {name: report["score"] for name, report in found.items()} == dict.fromkeys(names, 3)
    assert {name: bool(hints(report)) for name, report in found.items()} == {
        "ash": False,
        "birch": True,
        "cedar": False,
    }
