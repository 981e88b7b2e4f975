"""grader export replaces neither the gradebook nor the file of the LMS, and says little about a large class."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.lms.preflight import Overwrite, Preflight, RowNote
from grader.usecases.grade_files import preflight_lines
from tests.classroom.gradebooks import grader, refusal
from tests.samples import ROOT


def export(top: Path, target: str, *more: object) -> Any:
    """Export from the class's gradebook."""
    return grader("export", target, "--gradebook", top / "book.db", *more)


# --- For Canvas and Moodle --------------------------------------------------------------------------------------------


def canvas(points: str = "11", **numbers: str) -> str:
    """Return a Canvas gradebook with these students."""
    rows = "".join(f'"{key.title()}, X",{number},,{key},S1,\n' for key, number in numbers.items())
    return f"Student,ID,SIS User ID,SIS Login ID,Section,A small lab (77)\n    Points Possible,,,,,{points}\n{rows}"


@pytest.mark.parametrize("name", ["book.db", "../small/book.db", "link.db", "hard.db", "book.db-wal", "book.db-shm"])
def test_the_gradebook_is_never_replaced(name: str, top: Path) -> None:
    """Nor SQLite's files beside it, under any name; it contains all manual marks."""
    assert grader("mark", "anna", "essay", "3.5", "--gradebook", top / "book.db").returncode == 0
    (top / "link.db").symlink_to("book.db")
    (top / "hard.db").hardlink_to(top / "book.db")
    before = {path.name: path.read_bytes() for path in top.iterdir() if path.is_file()}
    why = "this would overwrite the gradebook and all its manual marks"
    assert refusal(export(top, "csv", "--output", top / name)) == f"cannot write {top / name}: {why}"
    book = ("--gradebook", top / "link.db")
    assert refusal(grader("export", "csv", *book, "--output", top / name)).endswith(why)
    assert {path.name: path.read_bytes() for path in top.iterdir() if path.is_file()} == before


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ["lms.csv", "link.csv", "hard.csv"])
def test_standard_output_is_no_way_to_replace_the_file_of_the_lms(name: str, top: Path) -> None:
    """Nor is it appended to."""
    lms = top / "lms.csv"
    lms.write_text(canvas(ben="102", nobody="9"))
    (top / "link.csv").symlink_to("lms.csv")
    (top / "hard.csv").hardlink_to(lms)
    before = lms.read_bytes()
    with lms.open("ab") as stdout:
        command = [sys.executable, "-m", "grader", "export", "canvas", "--gradebook", str(top / "book.db")]
        done = subprocess.run([*command, "--into", str(top / name)], cwd=ROOT, stdout=stdout, check=False)
    assert done.returncode == 2
    assert lms.read_bytes() == before


def test_the_output_for_a_large_class_is_short() -> None:
    """Students without a grade are one line for each reason, and every kind of line is limited."""
    pending = [RowNote(number, f"Student {number}", "10 points need manual grading") for number in range(3, 41)]
    late = [RowNote(number, f"Doe, {number}", "nothing was submitted") for number in (41, 42)]
    one = [RowNote(43, "Zoe", "has a grade that is locked in Moodle")]
    unknown = [RowNote(number, "x\x1b", "nobody") for number in range(50, 103)]
    conflicts = [Overwrite(number, "y", "1", "2") for number in range(50)]
    found = Preflight("Grade", 0, 0, conflicts, [*pending, *late, *one], unknown, warnings=["warned"])
    lines = list(preflight_lines(found))
    assert lines[0] == "column 'Grade': 0 filled in, 0 already the same"
    assert lines[1:12] == [*(f"row {number}, y: was 1, becomes 2" for number in range(10)), "... and 40 more"]
    assert lines[12:15] == [
        "without a grade: 38 (Student 3, Student 4, Student 5 and 35 more): 10 points need manual grading",
        "without a grade: 2 (Doe, 41 and Doe, 42): nothing was submitted",
        "without a grade: Zoe: has a grade that is locked in Moodle",
    ]
    unknown_rows = "row 50, x\\x1b; row 51, x\\x1b; row 52, x\\x1b and 50 more"
    assert lines[16:] == [f"in the file, but not in the gradebook: 53 ({unknown_rows}): nobody", "warned"]
