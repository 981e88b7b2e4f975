"""The same students under other keys: rosters that come later, are corrected or omitted; and removed students."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.classroom.class_runs import Done, grader, without_hints
from tests.samples import ROOT

BOTH = "id,login,name\n101,alice,Alice Ash\n102,bob,Bob Birch\n"


@pytest.fixture
def top(tmp_path: Path) -> Path:
    """Make a class of two, graded without a roster, with one mark."""
    shutil.copytree(ROOT / "submissions/lab6/reference", tmp_path / "class" / "alice")
    shutil.copytree(ROOT / "submissions/lab6/lidar-buried/my_robot/urdf", tmp_path / "class" / "bob")
    assert batch(tmp_path).returncode == 0
    assert grader("mark", "alice", "answer-floating-link", "3.5", "--gradebook", tmp_path / "g.db").returncode == 0
    return tmp_path


def batch(top: Path, *more: str | Path, roster: str = "") -> Done:
    """Grade the class, with a roster if one is given."""
    if roster:
        (top / "r.csv").write_text(roster, encoding="utf-8")
        more = (*more, "--roster", top / "r.csv")
    return grader("batch", top / "class", "--gradebook", top / "g.db", "--rubric", without_hints(), *more)


def students(top: Path, *more: str) -> dict[str, dict[str, Any]]:
    """Return everyone's current grade, by key."""
    done = grader("export", "json", "--gradebook", top / "g.db", *more)
    return {student["id"]: student for student in json.loads(done.stdout)["students"]}


def test_a_roster_may_come_later(top: Path) -> None:
    """Students known by folder are then known by the roster's ids, with all marks, and none is there twice."""
    done = batch(top, roster=BOTH)
    assert "alice is 101 now, with all manual marks" in done.stderr
    assert "0 graded, 2 unchanged" in done.stderr
    assert {key: (student["score"], student["manual_marks"]) for key, student in students(top).items()} == {
        "101": (93.5, 1),
        "102": (62, 0),
    }


def test_a_roster_may_be_omitted_and_come_again(top: Path) -> None:
    """Marks stay with their students, whatever the keys in between."""
    for roster in (BOTH, "", BOTH, BOTH):
        assert batch(top, roster=roster).returncode == 0
    assert students(top)["101"]["manual_marks"] == 1
    assert len(students(top)) == 2


def test_the_roster_is_remembered(top: Path) -> None:
    """A run without --roster uses the last one, with everything in it."""
    batch(top, roster="id,login,name,late\n101,alice,Alice Ash,2\n102,bob,Bob Birch,\n103,cal,Cal Cedar,\n")
    before = students(top)
    done = batch(top)
    assert "0 graded, 2 unchanged" in done.stderr
    assert students(top) == before
    assert set(before) == {"101", "102", "103"}
    shutil.copytree(ROOT / "submissions/lab6/reference", top / "class" / "zoe")
    assert "zoe is not on the roster" in batch(top).stderr


def test_late_enrolment(top: Path) -> None:
    """An unmatched student who is added to the roster, or an empty row of it, takes over the results."""
    batch(top, roster="id,login,name\n102,bob,Bob Birch\n")
    assert set(students(top)) == {"alice", "102"}
    batch(top, roster=BOTH)
    assert set(students(top)) == {"101", "102"}
    assert students(top)["101"]["score"] == 93.5


def test_an_lms_number_is_stronger_than_a_path(tmp_path: Path) -> None:
    """A new download has other file names; the user's id is the same, and the roster comes late."""
    first, second = tmp_path / "class" / "ashalice_7_1_my_robot.urdf", tmp_path / "class" / "ashalice_7_2_my_robot.urdf"
    first.parent.mkdir()
    shutil.copy(ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf", first)
    batch(tmp_path, "--layout", "canvas")
    assert grader("mark", "ashalice_7", "lidar-frame", "6", "--gradebook", tmp_path / "g.db").returncode == 0
    first.rename(second)
    done = batch(tmp_path, "--layout", "canvas", roster="id,name,canvas id\n101,Alice Ash,7\n")
    assert "ashalice_7 is 101 now" in done.stderr
    assert {key: student["manual_marks"] for key, student in students(tmp_path).items()} == {"101": 1}


def test_a_folders_key_that_the_roster_gives_to_another(top: Path) -> None:
    """Results of a folder named like a student's id stay with the folder, and the student's own move along."""
    shutil.copytree(ROOT / "submissions/lab6/wheels-black/my_robot/urdf", top / "class" / "101")
    batch(top)
    assert grader("mark", "101", "lidar-frame", "0", "--gradebook", top / "g.db").returncode == 0
    shutil.rmtree(top / "class" / "101")
    done = batch(top, roster=BOTH)
    assert "alice is 101 now" in done.stderr
    assert {key: student["manual_marks"] for key, student in students(top).items()} == {"101": 1, "102": 0, "./101": 1}
    assert students(top)["101"]["score"] == 93.5
    assert "no longer in the class folder (1): ./101" in done.stdout


def test_removed_submissions_have_no_grade(top: Path) -> None:
    """A removed submission is listed and not exported; when it comes back, everything is as before."""
    for name in ("answer-floating-link", "answer-launch-nodes", "evidence-webcam"):
        assert grader("mark", "alice", name, "2", "--gradebook", top / "g.db").returncode == 0
    assert students(top)["alice"]["is_final"]
    (top / "class" / "alice").rename(top / "away")
    done = batch(top)
    assert "no longer in the class folder (1): alice" in done.stdout
    assert not students(top)["alice"]["is_final"]
    assert batch(top).stdout == done.stdout
    (top / "away").rename(top / "class" / "alice")
    assert "alice" not in batch(top).stdout
    assert students(top)["alice"]["is_final"]
    assert students(top)["alice"]["manual_marks"] == 3


def test_another_class_folder_removes_nobody(top: Path) -> None:
    """A run over a folder with one late submission does not affect the others."""
    shutil.copytree(ROOT / "submissions/lab6/wheels-black/my_robot/urdf", top / "late" / "carol")
    done = grader("batch", top / "late", "--gradebook", top / "g.db", "--add")
    assert "any more" not in done.stdout
    assert set(students(top)) == {"alice", "bob", "carol"}


def test_grades_by_an_older_rubric_are_not_exported(top: Path) -> None:
    """Students who were not graded by the newest rubric have no final grade."""
    text = (ROOT / "rubrics/lab6/rubric.toml").read_text(encoding="utf-8")
    (top / "lab6.toml").write_text(text.replace('reference = "my_robot"', "", 1) + "\n# newer\n", encoding="utf-8")
    shutil.copytree(ROOT / "submissions/lab6/wheels-black/my_robot/urdf", top / "late" / "carol")
    done = grader("batch", top / "late", "--gradebook", top / "g.db", "--rubric", top / "lab6.toml", "--add")
    assert done.returncode == 0, done.stderr
    done = grader("export", "csv", "--gradebook", top / "g.db")
    assert done.stdout.count("it was graded with an earlier version of the rubric") == 2


def test_the_deadline_is_remembered(tmp_path: Path) -> None:
    """The deadline given to batch applies to later exports and runs, and can be changed."""
    text = (ROOT / "rubrics/lab6/rubric.toml").read_text(encoding="utf-8")
    policy = text.replace('reference = "my_robot"', "", 1) + "\n[late]\npercent_per_day = 10\n"
    (tmp_path / "lab6.toml").write_text(policy, encoding="utf-8")
    shutil.copytree(ROOT / "submissions/lab6/lidar-buried/my_robot/urdf", tmp_path / "class" / "bob")
    roster = "id,login,submitted\n102,bob,2026-11-21T10:00+01:00\n"
    done = batch(tmp_path, "--rubric", tmp_path / "lab6.toml", "--due", "2026-11-20T23:59+01:00", roster=roster)
    assert done.returncode == 0, done.stderr
    assert students(tmp_path)["102"]["total"] == 52
    assert students(tmp_path, "--due", "2026-11-22T00:00+01:00")["102"]["total"] == 62
    again = batch(tmp_path, "--rubric", tmp_path / "lab6.toml")
    assert "grader: deadline of the last run: 2026-11-20 23:59 (UTC+01:00) (--due changes it)\n" in again.stderr
    assert students(tmp_path)["102"]["total"] == 52
    assert batch(tmp_path, "--rubric", tmp_path / "lab6.toml", "--due", "2026-11-22").returncode == 0
    assert students(tmp_path)["102"]["total"] == 62


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("--reports", "class/reports", "outside of the class folder"),
        ("--reports", "class", "outside of the class folder"),
        ("--reports", "g.db", "is not a folder"),
        ("--csv", "g.db", "would overwrite the gradebook"),
        ("--csv", "nowhere/grades.csv", "there is no folder"),
    ],
)
def test_unwritable_outputs_are_refused_first(top: Path, option: str, value: str, words: str) -> None:
    """Nothing is graded before all outputs are known to be writable, and the gradebook is never overwritten."""
    before = (top / "g.db").read_bytes()
    done = batch(top, option, top / value)
    assert (done.returncode, done.stdout) == (2, "")
    assert words in done.stderr
    assert (top / "g.db").read_bytes() == before


def test_a_corrected_id_stays_on_the_roster(top: Path) -> None:
    """A student with a new id on the roster is not reported as removed from it."""
    batch(top, roster=BOTH)
    done = batch(top, roster=BOTH.replace("102", "099"))
    assert "102 is 099 now, with all manual marks" in done.stderr
    assert "not on the roster" not in done.stdout + done.stderr
