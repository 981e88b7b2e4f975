"""grader export: the current grades as CSV, as JSON, in a Canvas gradebook and in a Moodle worksheet."""

import csv
import io
import json
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path
from typing import Any, NamedTuple

import jsonschema
import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.intake.roster_file import read_roster
from grader.classroom.lms.preflight import Overwrite, Preflight, RowNote
from grader.classroom.students import ClassSubmission
from grader.classroom.typed_names import criterion_of
from grader.errors import InputError
from grader.files.names import ARCHIVES
from grader.grading.grade import grade
from grader.usecases.grade_files import preflight_lines
from tests.classroom.gradebooks import (
    batch,
    graded_as,
    grader,
    lab,
    lab_text,
    make_class,
    record_run,
    refusal,
    urdf,
    write_submission,
)
from tests.classroom.gradebooks import mark as add_mark
from tests.classroom.lab6_class import read_class
from tests.samples import LAB6, ROOT, opened

sys.path.insert(0, str(ROOT / "benchmarks"))  # a folder of scripts
import class_generator as made_up

BROKEN = "it could not be graded: cleo.zip cannot be read as an archive: File is not a zip file"
HEADER = "id,name,email,login,sis,status,score,max_score,pending,late_days,late_points,total,not_final_because"

MORE = "carried,section,marker,submitted,final_mark,excused,comments,graded_by"
FIVE = "5 points need manual grading"
BOTH = '"automatically, and manually by me"'


def export(top: Path, target: str, *more: object) -> Any:
    """Export from the class's gradebook."""
    return grader("export", target, "--gradebook", top / "book.db", *more)


def table(text: str) -> dict[str, dict[str, str]]:
    """Return the rows of a CSV by their first cell."""
    return {next(iter(row.values())): row for row in csv.DictReader(io.StringIO(text))}


def mark(top: Path, key: str, **points: str) -> None:
    """Add manual marks to criteria."""
    with Gradebook(top / "book.db") as book:
        standings = Grades(book)
        standing = standings.find(key)
        for name, value in points.items():
            add_mark(book, standing, criterion_of(standings.rubric(standing.rubric), name), Decimal(value), "me", "")


# --- For a spreadsheet, and for programs ------------------------------------------------------------------------------


def test_csv(top: Path) -> None:
    """There is a row for every student, undecided cells are empty, and a grade that is not final has its reason."""
    mark(top, "anna", essay="3.5", picture="1")
    mark(top, "ben", essay="0", picture="0")
    mark(top, "emil", box="1.25")
    done = export(top, "csv")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines() == [
        f"{HEADER},loads,box,tall,essay,picture,{MORE}",
        f"anna,Anna Ek,anna@example.org,ae1,anna,graded,10.5,11,0,0,0,10.5,,3,2.5,0.5,3.5,1,,,,,,,,{BOTH}",
        f"ben,Ben Oh,ben@example.org,bo2,ben,graded,6,11,0,0,0,6,,3,2.5,0.5,0,0,,,,,,,,{BOTH}",
        f"cleo,Cleo Ray,cleo@example.org,cr3,cleo,unreadable,0,11,11,0,0,0,{BROKEN},,,,,,,,,,,,,",
        "dora,Dora Fi,dora@example.org,df4,dora,missing,,,,,,,nothing was submitted,,,,,,,,,,,,,",
        f"emil,Ben Oh,emil@example.org,eo5,emil,graded,4.25,11,5,0,0,4.25,{FIVE},3,1.25,0,,,,,,,,,,{BOTH}",
    ]
    again = export(top, "csv", "--output", top / "grades.csv")
    assert (again.returncode, again.stdout, again.stderr) == (0, "", "")
    assert (top / "grades.csv").read_bytes().decode().replace("\r\n", "\n") == done.stdout.replace("\r\n", "\n")
    assert batch(top, "--csv", top / "same.csv").returncode == 0
    assert (top / "same.csv").read_bytes() == (top / "grades.csv").read_bytes()


def test_an_excused_student_has_no_total(top: Path) -> None:
    """The cell is empty in the CSV, as the grade is in an LMS; the points of the criteria stay."""
    assert grader("mark", "anna", "total", "--excused", "--gradebook", top / "book.db").returncode == 0
    row = table(export(top, "csv").stdout)["anna"]
    assert (row["score"], row["total"], row["excused"], row["not_final_because"]) == ("6", "", "yes", "excused")


def test_view_csv_and_json_agree(top: Path) -> None:
    """SELECT * FROM grade gives the same as the command line, for every student."""
    mark(top, "anna", essay="1.2345", loads="0")
    mark(top, "cleo", box="2.5")
    mark(top, "ben", picture="1")
    rows = table(export(top, "csv").stdout)
    data = json.loads(export(top, "json").stdout)
    jsonschema.validate(data, json.loads(grader("schema", "class").stdout))
    reported = {student["id"]: student for student in data["students"]}
    with Gradebook(top / "book.db") as book:
        view = {row[0]: row[1:] for row in book.rows("SELECT key, verdict, score, out_of, pending FROM grade")}
    assert view.keys() == rows.keys() == reported.keys()
    for key, (verdict, *numbers) in view.items():
        assert verdict == rows[key]["status"] == reported[key]["status"]
        for name, number in zip(("score", "max_score", "pending"), numbers, strict=True):
            exact = None if number is None else Decimal(number) / 10_000
            assert exact == (Decimal(rows[key][name]) if rows[key][name] else None)
            assert exact == (None if reported[key][name] is None else Decimal(str(reported[key][name])))
        cells = [Decimal(rows[key][column] or 0) for column in ("loads", "box", "tall", "essay", "picture")]
        assert sum(cells) == Decimal(rows[key]["score"] or 0)


AWKWARD = {
    "=1+1": "'=1+1",
    "+49 170": "'+49 170",
    "-2": "'-2",
    "@sum(a1)": "'@sum(a1)",
    "\uff1d1": "'\uff1d1",
    '=HYPERLINK("http://x","y")': '\'=HYPERLINK("http://x","y")',
    'O\'Neil, "Bo"': 'O\'Neil, "Bo"',
    "a;=1": "a;'=1",
    "Zo\u00eb \u674e": "Zo\u00eb \u674e",
    "\u202eevil": "\\x202eevil",
    "x\x1b[31m[red]": "x\\x1b[31m[red]",
}


def test_no_spreadsheet_runs_students_names(tmp_path: Path) -> None:
    """Formulas get an apostrophe, escapes and bidirectional marks are escaped, all other names are unchanged."""
    write_submission(tmp_path / "class" / "anna")
    lines = io.StringIO(newline="")
    csv.writer(lines).writerows([("id", "name"), *((f"s{number}", name) for number, name in enumerate(AWKWARD))])
    (tmp_path / "roster.csv").write_bytes(lines.getvalue().encode())
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path, "--add").returncode == 0
    assert export(tmp_path, "csv", "--output", tmp_path / "grades.csv").returncode == 0
    rows = table((tmp_path / "grades.csv").read_bytes().decode())
    assert [rows[f"s{number}"]["name"] for number in range(len(AWKWARD))] == list(AWKWARD.values())


# --- What being late costs --------------------------------------------------------------------------------------------

LATE_ROSTER = """\
id,name,due,extension,submitted,late,canvas id
anna,Anna Ek,,,2026-09-12T10:00:00Z,,101
ben,Ben Oh,,1,2026-09-12T10:00:00Z,,102
cleo,Cleo Ray,2026-09-12,,2026-09-12T18:00:00,,103
dora,Dora Fi,,,,yes,104
emil,Emil So,,,,5 days,105
"""
POLICY = "due = 2026-09-10T12:00:00Z\ngrace_minutes = 60\npercent_per_day = 10\nfloor_percent = 40"


def test_the_late_penalty_is_a_line_of_its_own(tmp_path: Path) -> None:
    """In CSV, JSON, the student's report and the LMS; it changes no criterion's points."""
    for key in ("anna", "ben", "cleo", "dora", "emil"):
        write_submission(tmp_path / "class" / key)
    (tmp_path / "roster.csv").write_text(LATE_ROSTER)
    (tmp_path / "small.toml").write_text(lab_text(POLICY))
    formats = ("--report-format", "json", "--report-format", "terminal")
    assert batch(tmp_path, "--reports", tmp_path / "reports", *formats).returncode == 0
    for key in ("anna", "ben", "cleo", "dora", "emil"):
        mark(tmp_path, key, essay="4", picture="1")
    rows = table(export(tmp_path, "csv").stdout)
    late = {key: (row["score"], row["late_days"], row["late_points"], row["total"]) for key, row in rows.items()}
    assert late == {
        "anna": ("11", "2", "-2.2", "8.8"),
        "ben": ("11", "1", "-1.1", "9.9"),
        "cleo": ("11", "0", "0", "11"),
        "dora": ("11", "1", "-1.1", "9.9"),  # the time is unknown
        "emil": ("11", "5", "-5.5", "5.5"),
    }
    assert {tuple(row[name] for name in ("loads", "box", "tall", "essay", "picture")) for row in rows.values()} == {
        ("3", "2.5", "0.5", "4", "1")
    }
    reported = {student["id"]: student for student in json.loads(export(tmp_path, "json").stdout)["students"]}
    words = "2 days late: submitted 2026-09-12 10:00 (UTC), deadline 2026-09-10 12:00 (UTC)"
    assert reported["anna"]["late"] == {"days": 2, "points": -2.2, "reason": words}
    assert (reported["anna"]["score"], reported["anna"]["total"]) == (11, 8.8)
    report = json.loads((tmp_path / "reports" / "anna.json").read_text())
    jsonschema.validate(report, json.loads(grader("schema", "report").stdout))
    assert report["score"] == 6
    late_note = f"{words}: the late penalty is 1.6 points, the grade is 4.4"  # not below the floor
    assert report["notes"] == [late_note]
    assert f"Note: {late_note}" in " ".join((tmp_path / "reports" / "anna.txt").read_text().split())
    later = table(export(tmp_path, "csv", "--due", "2026-09-11T12:00:00Z").stdout)
    assert {key: row["late_days"] for key, row in later.items()} == {
        "anna": "1", "ben": "0", "cleo": "0", "dora": "1", "emil": "5",
    }  # fmt: skip
    (tmp_path / "canvas.csv").write_text(canvas(anna="101", emil="105"))
    done = export(tmp_path, "canvas", "--into", tmp_path / "canvas.csv")
    assert [row[-1] for row in csv.reader(done.stdout.splitlines()[2:])] == ["8.80", "5.50"]
    assert "is not a date or time" in refusal(export(tmp_path, "csv", "--due", "soon"))


# --- For Canvas and Moodle --------------------------------------------------------------------------------------------


def canvas(points: str = "11", **numbers: str) -> str:
    """Return a Canvas gradebook with these students."""
    rows = "".join(f'"{key.title()}, X",{number},,{key},S1,\n' for key, number in numbers.items())
    return f"Student,ID,SIS User ID,SIS Login ID,Section,A small lab (77)\n    Points Possible,,,,,{points}\n{rows}"


EVERYONE = {"anna": "101", "ben": "102", "cleo": "103", "dora": "104", "emil": "105"}


def test_who_gets_a_grade_in_canvas(top: Path) -> None:
    """Pending, unreadable and missing submissions are omitted with the reason."""
    mark(top, "anna", essay="3.5", picture="1")
    mark(top, "ben", essay="0", picture="0")
    (top / "canvas.csv").write_text(canvas(**EVERYONE))
    done = export(top, "canvas", "--into", top / "canvas.csv", "--strict")
    assert done.returncode == 0
    head, points = canvas().splitlines()
    assert done.stdout == f'{head}\n{points}\n"Anna, X",101,,anna,S1,10.50\n"Ben, X",102,,ben,S1,6.00\n'
    assert done.stderr.splitlines() == [
        "grader: column 'A small lab (77)': 2 filled in, 0 already the same",
        f"grader: without a grade: Cleo, X: {BROKEN}",
        "grader: without a grade: Dora, X: nothing was submitted",
        "grader: without a grade: Emil, X: 5 points need manual grading",
        "grader: `grader mark STUDENT total POINTS` gives a final mark; `grader review` grades what is open",
    ]
    zero = export(top, "canvas", "--into", top / "canvas.csv", "--pending-as-zero")
    assert zero.stdout == done.stdout + '"Emil, X",105,,emil,S1,3.00\n'


def test_the_column_of_other_work_is_not_filled(graded_class: Path, tmp_path: Path) -> None:
    """An only assignment with another title is filled if --column names it."""
    into = tmp_path / "canvas.csv"
    into.write_text(canvas(ben="102").replace("A small lab", "Midterm"))
    why = "no column with a title like 'small' or 'A small lab', choose one with --column: 'Midterm (77)'"
    assert refusal(export(graded_class, "canvas", "--into", into)) == f"{into} has {why}"
    named = export(graded_class, "canvas", "--into", into, "--column", "Midterm")
    assert (named.returncode, named.stderr.splitlines()[0][:28]) == (0, "grader: column 'Midterm (77)")


@pytest.mark.parametrize("target", ["canvas", "moodle", "blackboard", "brightspace"])
def test_a_spreadsheet_is_no_csv(target: str, graded_class: Path, tmp_path: Path) -> None:
    """The LMS's file has to be saved as CSV."""
    (tmp_path / "grades.xlsx").write_bytes(b"PK\x03\x04")
    done = export(graded_class, target, "--into", tmp_path / "grades.xlsx")
    assert (
        refusal(done)
        == f"{tmp_path / 'grades.xlsx'} is a spreadsheet, not a CSV file: open it and save it as CSV (UTF-8)"
    )


def test_marks_of_an_earlier_submission_are_reported(top: Path) -> None:
    """The preview names whose final mark or excuse was given before the newest submission."""
    for whole in (("anna", "total", "7"), ("ben", "total", "8"), ("emil", "total", "--excused")):
        assert grader("mark", *whole, "--gradebook", top / "book.db").returncode == 0
    (top / "canvas.csv").write_text(canvas(**EVERYONE))
    arguments = ("canvas", "--into", top / "canvas.csv")
    assert "newest submission" not in export(top, *arguments).stderr
    (top / "class" / "anna" / "robot.urdf").write_text(urdf("2 2 2"))
    (top / "class" / "emil" / "robot.urdf").write_text(urdf("2 2 2"))
    assert batch(top).returncode == 0
    assert export(top, *arguments).stderr.splitlines()[1:4] == [
        "grader: excused (EX): 1 (Emil, X)",
        "grader: given before the newest submission: Anna Ek: final mark",
        "grader: given before the newest submission: Ben Oh: excuse",
    ]


def test_only_pending_criteria_count_as_zero(top: Path) -> None:
    """With the option, students who left the class folder or have an older rubric still get no grade."""
    (top / "canvas.csv").write_text(canvas(**EVERYONE))
    assert batch(top).returncode == 0  # where the copy is
    shutil.rmtree(top / "class" / "emil")
    assert batch(top).returncode == 0
    done = export(top, "canvas", "--into", top / "canvas.csv", "--pending-as-zero")
    assert [row[3] for row in csv.reader(done.stdout.splitlines()[2:])] == ["anna", "ben"]
    assert "without a grade: Emil, X: it is no longer in the class folder\n" in done.stderr


def test_strict_writes_nothing(top: Path) -> None:
    """If a row has no student or a student no row, nothing is written; without the option the rest is."""
    mark(top, "anna", essay="3.5", picture="1")
    mark(top, "ben", essay="0", picture="0")
    (top / "canvas.csv").write_text(canvas(anna="101", zoe="999"))
    (top / "out.csv").write_text("as it was")
    arguments = ("canvas", "--into", top / "canvas.csv", "--output", top / "out.csv")
    strict = export(top, *arguments, "--strict")
    assert (strict.returncode, strict.stdout, (top / "out.csv").read_text()) == (1, "", "as it was")
    assert "in the file, but not in the gradebook: row 4, Zoe, X: no student of the gradebook" in strict.stderr
    assert "in the gradebook, but not in the file: Ben Oh: has a grade, but no row in the file" in strict.stderr
    assert strict.stderr.endswith(
        "grader: nothing was written, because of --strict: some rows or students are unmatched\n"
    )
    assert export(top, *arguments).returncode == 0
    assert (top / "out.csv").read_text().endswith("anna,S1,10.50\n")


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("canvas",), "export canvas fills in a file that the LMS exported: give it with --into"),
        (("moodle",), "export moodle fills in a file that the LMS exported: give it with --into"),
        (("csv", "--into", "small.toml"), "export csv does not take --into"),
        (("json", "--into", "small.toml"), "export json does not take --into"),
        (("canvas", "--into", "none.csv"), "cannot read none.csv: No such file or directory"),
        (("canvas", "--into", "README.md"), "README.md is not a gradebook exported from Canvas"),
        (("moodle", "--into", "README.md"), "README.md is not a grading worksheet of Moodle"),
        (
            ("csv", "--output", "/nowhere/grades.csv"),
            "cannot write /nowhere/grades.csv: there is no folder /nowhere (create it with `mkdir -p /nowhere`)",
        ),
    ],
)
def test_what_is_refused(arguments: tuple[str, ...], why: str, graded_class: Path) -> None:
    """Refused with one plain line."""
    assert refusal(export(graded_class, *arguments)).startswith(why)


def test_without_a_target(graded_class: Path) -> None:
    """The choices are on one line, without the tabs around them."""
    why = refusal(grader("export", "--gradebook", graded_class / "book.db"))
    assert (
        "Choose from: csv, canvas, moodle, blackboard, brightspace, json, html (`grader export --help` shows the usage)"
        in why
    )


@pytest.mark.parametrize("name", ["book.db", "../small/book.db", "link.db", "hard.db", "book.db-wal", "book.db-shm"])
def test_the_gradebook_is_never_replaced(name: str, top: Path) -> None:
    """Nor SQLite's files beside it, under any name; it contains all manual marks."""
    mark(top, "anna", essay="3.5")
    (top / "link.db").symlink_to("book.db")
    (top / "hard.db").hardlink_to(top / "book.db")
    before = {path.name: path.read_bytes() for path in top.iterdir() if path.is_file()}
    why = "this would overwrite the gradebook and all its manual marks"
    assert refusal(export(top, "csv", "--output", top / name)) == f"cannot write {top / name}: {why}"
    book = ("--gradebook", top / "link.db")
    assert refusal(grader("export", "csv", *book, "--output", top / name)).endswith(why)
    assert {path.name: path.read_bytes() for path in top.iterdir() if path.is_file()} == before


@pytest.mark.parametrize("name", ["lms.csv", "../small/lms.csv", "link.csv", "hard.csv"])
@pytest.mark.parametrize("target", ["canvas", "moodle"])
def test_the_file_of_the_lms_is_never_replaced(name: str, target: str, top: Path) -> None:
    """Rows without a grade are omitted in the output and would be lost. The target is refused under any name."""
    lms = top / "lms.csv"
    lms.write_text(canvas(ben="102", nobody="9"))
    (top / "link.csv").symlink_to("lms.csv")
    (top / "hard.csv").hardlink_to(lms)
    before = lms.read_bytes()
    why = f"cannot write {lms}: --into reads it, and rows without a grade would be lost; choose another file"
    assert refusal(export(top, target, "--into", lms, "--output", top / name)) == why
    assert lms.read_bytes() == before


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


def test_without_an_output_no_file_is_written(top: Path) -> None:
    """The filled file is printed, and the source file is unchanged."""
    (top / "canvas.csv").write_text(canvas(ben="102"))
    for arguments in (("csv",), ("json",), ("canvas", "--into", top / "canvas.csv")):
        before = {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in top.rglob("*") if path.is_file()}
        done = export(top, *arguments)
        assert done.returncode == 0, done.stderr
        assert done.stdout
        after = {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in top.rglob("*") if path.is_file()}
        assert after == before


def test_no_symlink_of_a_submission_is_followed(top: Path) -> None:
    """The gradebook knows the class: a student's symlink is not followed, one beside the class is."""
    assert batch(top).returncode == 0  # the gradebook comes from a copy of the class
    (top / "class" / "anna" / "grades.csv").symlink_to(top / "victim")
    (top / "class" / "anna" / "out").symlink_to(top)
    (top / "link").symlink_to(top)
    for place in ("grades.csv", "out/victim"):
        why = refusal(export(top, "csv", "--output", top / "class" / "anna" / place))
        assert why.endswith(" is a symlink in the submission; choose a file outside of it")
    assert not (top / "victim").exists()
    assert export(top, "csv", "--output", top / "link" / "victim").returncode == 0
    assert (top / "victim").exists()


def test_another_maximum_is_refused(top: Path) -> None:
    """Nothing is written unless the points are confirmed; then a warning says what the LMS makes of them."""
    mark(top, "ben", essay="0", picture="0")
    (top / "canvas.csv").write_text(canvas("100", ben="102"))
    arguments = ("canvas", "--into", top / "canvas.csv", "--output", top / "out.csv")
    assert refusal(export(top, *arguments)) == (
        "Canvas' Points Possible of 'A small lab (77)' is 100, but the rubric's maximum is 11: change the maximum in the LMS"
        " and export again, or pass --any-maximum to write the points unchanged"
    )
    assert not (top / "out.csv").exists()
    done = export(top, *arguments, "--any-maximum")
    assert done.returncode == 0
    assert "has 100 points possible in Canvas, but the rubric has 11" in done.stderr
    assert (top / "out.csv").read_text().endswith("ben,S1,6.00\n")


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


def test_almost_all_points_are_not_all(tmp_path: Path) -> None:
    """99.996 of 100 is 99.99 with two decimals, and unchanged everywhere else."""
    rubric = lab(loads="95.996", box="0.004", tall="0", essay="0", picture="4")
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, rubric, [graded_as(rubric, "anna", "pfppp")])
    (tmp_path / "canvas.csv").write_text(canvas("100", anna="101"))
    head = "Identifier,Full name,Username,Grade,Maximum grade,Last modified (grade),Feedback comments"
    (tmp_path / "moodle.csv").write_text(f"{head}\nParticipant 1,Anna,anna,,100.00,-,\n")
    done = export(tmp_path, "canvas", "--into", tmp_path / "canvas.csv")
    assert done.stdout.endswith("anna,S1,99.99\n")
    moodle = table(export(tmp_path, "moodle", "--into", tmp_path / "moodle.csv").stdout)["Participant 1"]
    assert moodle["Grade"] == "99.99"
    assert moodle["Feedback comments"].startswith("<p>Graded automatically: 99.99 of 100 points.</p>")
    assert table(export(tmp_path, "csv").stdout)["anna"]["total"] == "99.996"
    assert json.loads(export(tmp_path, "json").stdout)["students"][0]["total"] == 99.996
    text = grader("stats", "--gradebook", tmp_path / "book.db").stdout
    assert "mean 99.9, standard deviation 0.0, lowest 99.996, median 99.996, highest 99.996" in " ".join(text.split())


def test_feedback_in_moodle(tmp_path: Path) -> None:
    """Lost points with the reason, manual comments, and the late penalty; harmless in a web page."""
    make_class(tmp_path, POLICY)
    (tmp_path / "roster.csv").write_text("id,name,late\nemil,Ben Oh,2 days\n")
    assert batch(tmp_path).returncode == 0
    book = ("--gradebook", tmp_path / "book.db")
    grader("mark", "emil", "essay", "2", "--comment", "<b>Why</b> not\x1b[31m & =1;=2 \u202eso", *book)
    grader("mark", "emil", "picture", "1", "--comment", "nice", *book)
    (tmp_path / "moodle.csv").write_bytes(
        b"\xef\xbb\xbfIdentifier,Full name,Email address,Status,Grade,Maximum grade,Grade can be changed,"
        b"Last modified (submission),Last modified (grade),Feedback comments\r\n"
        b'Participant 7,"Ben Oh",b@x.org,"Submitted, for grading",,11.00,Yes,"Friday, 1 May",-,\r\n'
    )
    done = export(tmp_path, "moodle", "--into", tmp_path / "moodle.csv", "--output", tmp_path / "out.csv")
    assert done.returncode == 0, done.stderr
    filled, given = (tmp_path / "out.csv").read_bytes(), (tmp_path / "moodle.csv").read_bytes()
    assert filled.startswith(given.replace(b",,11.00", b",4.40,11.00").removesuffix(b"\r\n"))
    feedback = next(csv.reader(filled.decode().splitlines()[1:]))[-1]
    items = re.findall(r"<li>(.*?)</li>", feedback)
    assert items[0].startswith("About box: 0 of 2.5. &#x27;base&#x27; shows a box 1 1 2 m")
    assert items[2].startswith("About essay: 2 of 4. &lt;b&gt;Why&lt;/b&gt; not\\x1b[31m".replace("\\", "&#92;"))
    assert items[3] == "About picture: 1 of 1. nice"
    assert items[4] == "Late penalty: -1.6. 2 days late, as recorded by the instructor"
    assert not set(feedback) & set("\x1b\u202e")
    assert feedback.startswith("<p>Graded automatically, and manually: 4.4 of 11 points.</p>")


# --- There and back: what an LMS hands out, graded, in the LMS's own file ---------------------------------------------

SIZE = 40


class LmsClass(NamedTuple):
    """A class as an LMS provides it, unpacked and as a zip, with its roster and the LMS's file."""

    layout: str
    top: Path

    def export(self, folder: str) -> Any:
        """Grade the class in `folder`, and fill the LMS's file."""
        book = ("--gradebook", self.top / f"{folder}.db")
        done = grader("batch", self.top / folder, *book, "--roster", self.top / "roster.csv", "--jobs", 2)
        assert done.returncode == 0, done.stderr
        assert f"layout {self.layout}" in done.stderr
        lms = ("--into", self.top / "lms.csv", "--pending-as-zero", "--output", self.top / f"{folder}.csv")
        done = grader("export", self.layout, *book, *lms)
        assert done.returncode == 0, done.stderr
        return done

    def submissions(self) -> Iterator[ClassSubmission]:
        """Return the submissions of students on the roster."""
        intake = read_class(self.top / "class", read_roster(self.top / "roster.csv"))
        return (submission for submission in intake.submissions() if submission.student.key not in intake.unmatched)


@pytest.fixture(scope="module", params=["canvas", "moodle"])
def lms_class(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> LmsClass:
    """Generate a class of all kinds of submissions."""
    top = tmp_path_factory.mktemp(request.param)
    written = list(made_up.make_class(top / "class", SIZE, 5, "mixed", request.param))
    made_up.write_beside(written, SIZE, request.param, None, top / "roster.csv", top / "lms.csv")
    with zipfile.ZipFile(top / "class.zip", "w") as archive:
        for path in sorted((top / "class").rglob("*")):
            if not path.is_symlink():
                archive.write(path, path.relative_to(top / "class"))
    return LmsClass(request.param, top)


def points_alone(lms_class: LmsClass, entry: ClassSubmission, scratch: Path) -> Decimal | None:
    """Return the points of `grader grade` for one student; None if the submission is refused or unreadable."""
    path = lms_class.top / "class" / entry.paths[0]
    if len(entry.paths) > 1:
        path = scratch / entry.student.key
        path.mkdir()
        for name, file in zip(entry.names, entry.paths, strict=True):
            shutil.copy(lms_class.top / "class" / file, path / name)
    try:
        submission = opened(path)
    except InputError:
        return None
    files = [file for file in submission.tree.files.values() if file.suffix not in ARCHIVES]
    return grade(LAB6, submission).score if submission.is_single or files else None


def test_everyone_has_the_points_of_grader_grade(lms_class: LmsClass, tmp_path: Path) -> None:
    """Each graded student has a row in the LMS's file, and nobody else; the same from a zip."""
    done = lms_class.export("class")
    filled = cells(lms_class, "class.csv")
    given = cells(lms_class, "lms.csv")
    expected = {}
    for submission in lms_class.submissions():
        points = points_alone(lms_class, submission, tmp_path)
        if points is not None:
            expected[number_of(lms_class, submission)] = f"{points:.2f}"
    assert {number: row[grade_column(lms_class)] for number, row in filled.items()} == expected
    assert len(expected) > SIZE // 2
    omitted = re.findall(r"without a grade: (\d*)", done.stderr)
    assert sum(int(count or 1) for count in omitted) == len(given) - len(filled)
    for number, row in filled.items():
        same = [index for index in range(len(row)) if index not in (grade_column(lms_class), 9)]
        assert [row[index] for index in same] == [given[number][index] for index in same]
    lms_class.export("class.zip")
    assert cells(lms_class, "class.zip.csv") == filled


def grade_column(lms_class: LmsClass) -> int:
    """Return the index of the grade's column."""
    return 5 if lms_class.layout == "canvas" else 4


def number_of(lms_class: LmsClass, submission: ClassSubmission) -> str:
    """Return the student's identifier in the LMS's file."""
    return submission.student.canvas if lms_class.layout == "canvas" else f"Participant {submission.student.moodle}"


def cells(lms_class: LmsClass, name: str) -> dict[str, list[str]]:
    """Return the students' rows of a file by the LMS's number."""
    rows = list(csv.reader(io.StringIO((lms_class.top / name).read_bytes().decode("utf-8-sig"), newline="")))
    if lms_class.layout == "moodle":
        return {row[0]: row for row in rows[1:]}
    return {row[1]: row for row in rows[2:]}


def test_only_cells_of_grades_change(lms_class: LmsClass) -> None:
    """Every remaining line is unchanged byte for byte except for its points."""
    if not (lms_class.top / "class.csv").exists():
        lms_class.export("class")
    given, filled = ((lms_class.top / name).read_bytes() for name in ("lms.csv", "class.csv"))
    if lms_class.layout == "moodle":
        filled = re.sub(rb',(?:"<p>|<p>).*-->"?$', b",", filled, flags=re.MULTILINE)
        plain = re.sub(rb",\d+\.\d\d,100\.00,", b",,100.00,", filled)
    else:
        plain = re.sub(rb",\d+\.\d\d$", b",", filled, flags=re.MULTILINE).replace(
            b"Possible,,,,,", b"Possible,,,,,100.00"
        )
    before = given.splitlines(keepends=True)
    assert [line for line in before if line in set(plain.splitlines(keepends=True))] == plain.splitlines(keepends=True)


def test_a_second_import_changes_nothing(lms_class: LmsClass, tmp_path: Path) -> None:
    """After the first import every row is the same already."""
    if not (lms_class.top / "class.csv").exists():
        lms_class.export("class")
    book = ("--gradebook", lms_class.top / "class.db", "--pending-as-zero")
    done = grader(
        "export", lms_class.layout, *book, "--into", lms_class.top / "class.csv", "--output", tmp_path / "again.csv"
    )
    assert ": 0 filled in, " in done.stderr
    assert (tmp_path / "again.csv").read_bytes() == (lms_class.top / "class.csv").read_bytes()
