"""grader extend: a student's own deadline counts instead of the roster's, until it is withdrawn."""

import json
import subprocess
from pathlib import Path

import pytest

from tests.classroom.gradebooks import batch, grader, make_class, refusal

POLICY = "percent_per_day = 10\ndue = 2026-09-10T12:00:00+02:00\n"
ROSTER = (
    "id,name,submitted,due,late\n"
    'anna,"Ek, Anna",2026-09-12T10:00+02:00,,\n'
    "ben,Ben Oh,,,2 days\n"
    "dora,,,,\n"
    "emil,Emil Ash,2026-09-13T10:00+02:00,2026-09-12,\n"
)


@pytest.fixture
def late_class(tmp_path: Path) -> Path:
    """Return a class with late submissions, graded once."""
    make_class(tmp_path, POLICY)
    (tmp_path / "roster.csv").write_text(ROSTER)
    assert batch(tmp_path).returncode == 0
    return tmp_path


def extend(top: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Extend a deadline in the class's gradebook."""
    return grader("extend", *arguments, "--gradebook", top / "book.db")


def days_late(top: Path) -> dict[str, int]:
    """Return how many days late each student is."""
    done = grader("export", "json", "--gradebook", top / "book.db")
    return {one["id"]: one["late"]["days"] for one in json.loads(done.stdout)["students"]}


def test_a_new_deadline_counts(late_class: Path) -> None:
    """The line names the student, the deadline, and how late the submission is with it."""
    done = extend(late_class, "Ek, Anna", "2026-09-11", "--by", "Kim")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == (
        "anna, Ek, Anna: deadline 2026-09-11; 1 day late: submitted 2026-09-12 10:00 (UTC+02:00),"
        " deadline 2026-09-11 23:59 (UTC+02:00); 6 of 11 points; 4.9 after the late penalty;"
        " needs manual grading: 5 points\n"
    )
    done = extend(late_class, "anna", "2026-09-12")
    assert done.stdout == "anna, Ek, Anna: deadline 2026-09-12; 6 of 11 points; needs manual grading: 5 points\n"
    assert done.stderr == "grader: this replaces the deadline 2026-09-11\n"
    assert days_late(late_class)["anna"] == 0


def test_it_replaces_what_the_roster_says(late_class: Path) -> None:
    """An earlier deadline than the roster's counts as well; a number of days late counts if the time is unknown."""
    assert days_late(late_class)["emil"] == 1
    assert "2 days late" in extend(late_class, "emil", "2026-09-11").stdout
    assert (
        "; 2 days late, as recorded by the instructor; 6 of 11 points; 3.8 after"
        in extend(late_class, "ben", "2026-12-24").stdout
    )
    assert extend(late_class, "dora", "2026-09-30").stdout == "dora: deadline 2026-09-30; no submission\n"


def test_later_runs_keep_it(late_class: Path) -> None:
    """Also with the roster of the first run, and with a roster that has another deadline."""
    extend(late_class, "anna", "2026-09-13")
    for due in ("", "2026-09-09"):
        (late_class / "roster.csv").write_text(ROSTER.replace("+02:00,,", f"+02:00,{due},"))
        done = batch(late_class)
        assert done.returncode == 0
        assert days_late(late_class)["anna"] == 0
        assert ("of `grader extend` counts, not that of the roster: Ek, Anna (anna)\n" in done.stderr) == bool(due)


def test_it_can_be_withdrawn(late_class: Path) -> None:
    """What the roster says counts again."""
    before = days_late(late_class)
    extend(late_class, "anna", "2026-09-13")
    done = extend(late_class, "anna", "-")
    assert done.stdout.startswith("anna, Ek, Anna: no deadline of their own; 2 days late: submitted")
    assert done.stderr == "grader: this replaces the deadline 2026-09-13\n"
    assert days_late(late_class) == before


def test_a_difference_between_runs_has_its_reason(late_class: Path) -> None:
    """`diff` says what became of the late penalty, and `gradebook merge` takes the deadline along."""
    (late_class / "copy.db").write_bytes((late_class / "book.db").read_bytes())
    extend(late_class, "anna", "2026-09-13")
    assert batch(late_class).returncode == 0
    assert "late penalty: 2.2 to 0" in grader("diff", late_class / "book.db").stdout
    merged = grader("gradebook", "merge", late_class / "copy.db", late_class / "book.db")
    assert (merged.returncode, merged.stdout[:28]) == (0, "1 entry of 1 student merged ")
    assert grader("export", "csv", "--gradebook", late_class / "copy.db").stdout.count(",0,0,") > 0


@pytest.mark.parametrize(
    ("student", "time", "why"),
    [
        ("anna", "tomorrow", "'tomorrow' is not a date or time: write it as 2026-11-20T23:59+01:00"),
        ("ana", "2026-09-13", "there is no student 'ana' in the gradebook; did you mean"),
    ],
)
def test_what_is_refused(student: str, time: str, why: str, late_class: Path) -> None:
    """One line, and nothing is recorded."""
    before = days_late(late_class)
    assert refusal(extend(late_class, student, time)).startswith(why)
    assert days_late(late_class) == before
