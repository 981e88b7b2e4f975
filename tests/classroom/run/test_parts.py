"""Every submission of a class is graded on the same parts, in every report and export."""

import csv
import io
import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.classroom.class_runs import grader, rows, without_hints
from tests.samples import ROOT

REFERENCE = ROOT / "submissions/lab6/reference"
URDF = REFERENCE / "roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"
CANVAS = "Student,ID,SIS User ID,SIS Login ID,Section,IRP Lab 6: a wheeled base (77)\n    Points Possible,,,,,{}\n{}"


@pytest.fixture
def top(tmp_path: Path) -> Path:
    """Make a class of a folder, a single URDF, a broken archive and pictures."""
    shutil.copytree(REFERENCE, tmp_path / "class/ash")
    shutil.copy(ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf", tmp_path / "class/birch.urdf")
    (tmp_path / "class/cedar.zip").write_bytes(b"PK\x03\x04 broken")
    (tmp_path / "class/dale").mkdir()
    (tmp_path / "class/dale/Task1_Step8.png").write_bytes(b"\x89PNG")
    return tmp_path


def batch(top: Path, *more: str | Path) -> str:
    """Grade the class and return standard error."""
    done = grader("batch", top / "class", "--gradebook", top / "g.db", "--rubric", without_hints(), *more)
    assert done.returncode == 0, done.stderr
    return str(done.stderr)


def exported(top: Path) -> dict[str, dict[str, str]]:
    """Return the rows of the CSV export by student."""
    text = grader("export", "csv", "--gradebook", top / "g.db").stdout
    return {row["id"]: row for row in csv.DictReader(io.StringIO(text))}


def reports(top: Path) -> dict[str, dict[str, Any]]:
    """Return the JSON reports by student."""
    return {path.stem: json.loads(path.read_text()) for path in (top / "reports").glob("*.json")}


def test_all_parts(top: Path) -> None:
    """A single URDF, too: its report and its row in the export have the same score out of the same maximum."""
    batch(top, "--reports", top / "reports", "--report-format", "json")
    made = reports(top)
    assert {tuple(report["parts"]) for report in made.values()} == {("task1", "task2", "task3", "questions")}
    assert {key: (report["score"], report["max_score"], report["pending"]) for key, report in made.items()} == {
        "ash": (90, 100, 10),
        "birch": (62, 100, 10),
        "cedar": (0, 100, 100),
        "dale": (0, 100, 100),
    }
    assert made["birch"]["notes"] == []
    found = exported(top)
    assert {key: (row["score"], row["max_score"]) for key, row in found.items()} == {
        "ash": ("90", "100"),
        "birch": ("62", "100"),
        "cedar": ("0", "100"),
        "dale": ("0", "100"),
    }
    assert found["birch"]["package-found"] == "0"


def test_one_part(top: Path) -> None:
    """The report, the exports and the statistics have the criteria of this part only."""
    batch(top, "--part", "task1", "--reports", top / "reports", "--report-format", "json")
    made = reports(top)
    assert {tuple(report["parts"]) for report in made.values()} == {("task1",)}
    assert {key: (report["score"], report["max_score"], report["pending"]) for key, report in made.items()} == {
        "ash": (70, 70, 0),
        "birch": (62, 70, 0),
        "cedar": (0, 70, 70),
        "dale": (0, 70, 70),
    }
    found = exported(top)
    assert {key: (row["score"], row["max_score"]) for key, row in found.items()} == {
        "ash": ("70", "70"),
        "birch": ("62", "70"),
        "cedar": ("0", "70"),
        "dale": ("0", "70"),
    }
    assert {"lidar-frame", "package-found", "evidence-webcam"} & set(found["ash"]) == {"lidar-frame"}
    shown = json.loads(grader("stats", "--gradebook", top / "g.db", "--format", "json").stdout)
    assert len(shown["statistics"]["criteria"]) == len([name for name in found["ash"] if name.count("-")])
    assert "Grades out of 70 (" in grader("stats", "--gradebook", top / "g.db").stdout


def test_the_maximum_of_an_lms_is_that_of_the_parts(top: Path) -> None:
    """70 points possible in Canvas fit a class that is graded on Task 1, 100 do not."""
    batch(top, "--part", "task1")
    for points, code in (("70", 0), ("100", 2)):
        (top / "canvas.csv").write_text(CANVAS.format(points, "Ash,1,,ash,,\nBirch,2,,birch,,\n"))
        done = grader("export", "canvas", "--gradebook", top / "g.db", "--into", top / "canvas.csv")
        assert done.returncode == code
    assert "is 100, but the rubric's maximum is 70" in done.stderr


def test_other_parts_grade_everything_again(top: Path) -> None:
    """The same parts grade nothing again, in any order; the class is never graded on a mixture."""
    assert "4 graded, 0 unchanged" in batch(top, "--part", "task2", "--part", "task1")
    assert "0 graded, 4 unchanged" in batch(top, "--part", "task1", "--part", "task2", "--part", "task1")
    assert "4 graded, 0 unchanged" in batch(top)
    assert "0 graded, 4 unchanged" in batch(top)
    shutil.move(top / "class/birch.urdf", top / "birch.urdf")
    shutil.rmtree(top / "class/ash")
    assert "2 graded, 0 unchanged" in batch(top, "--part", "task1")
    assert exported(top)["ash"]["not_final_because"] == "it is no longer in the class folder"
    assert {row["max_score"] for row in exported(top).values()} == {"70", "100"}


def test_a_student_who_was_graded_on_other_parts_has_no_grade(top: Path) -> None:
    """A second section that is graded on one part: the first one has to be graded again."""
    batch(top)
    (top / "section").mkdir()
    shutil.copy(URDF, top / "section/elm.urdf")
    done = grader("batch", top / "section", "--gradebook", top / "g.db", "--add", "--part", "task1")
    assert done.returncode == 0
    found = exported(top)
    assert (found["elm"]["score"], found["elm"]["not_final_because"]) == ("70", "")
    assert found["birch"]["not_final_because"].startswith("it was graded on other parts: run `grader batch` again")


def test_parts_of_an_unreadable_submission(top: Path) -> None:
    """A submission that cannot be read needs manual grading on the graded parts only."""
    done = grader("batch", top / "class", "--gradebook", top / "g.db", "--part", "task1", "--max-size", "100")
    assert done.returncode == 0
    found = rows(top / "g.db", "SELECT out_of, pending FROM grade WHERE key = 'birch'")
    assert found == [(700_000, 700_000)]


def test_an_unknown_part_is_refused(top: Path) -> None:
    """Before anything is graded."""
    done = grader("batch", top / "class", "--gradebook", top / "g.db", "--part", "task9")
    assert (done.returncode, "the rubric lab6 has no part 'task9'" in done.stderr) == (2, True)
    assert not (top / "g.db").exists()


def test_a_single_urdf_is_graded_on_what_it_can_meet(top: Path) -> None:
    """By `grade`, which says so, unless a part that needs more is named: that is refused."""
    done = grader("grade", top / "class/birch.urdf", "--format", "json")
    report = json.loads(done.stdout)
    assert (report["parts"], report["score"], report["max_score"]) == (["task1"], 62, 70)
    assert report["notes"] == ["only task1 is graded: task2, task3 and questions need the whole folder"]
    done = grader("grade", top / "class/birch.urdf", "--part", "task2")
    assert (done.returncode, "task2 needs more than a URDF" in done.stderr) == (2, True)
