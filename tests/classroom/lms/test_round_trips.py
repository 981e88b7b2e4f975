"""There and back with a class of 120: what each LMS would import equals the gradebook, cell by cell, and nothing else changes."""

import csv
import io
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.classroom.gradebooks import grader
from tests.classroom.lms.enrolled_class import CLASS, Enrolled, write_gradebook
from tests.classroom.lms.importers import (
    State,
    blackboard_import,
    brightspace_import,
    canvas_comments,
    canvas_import,
    moodle_feedback,
    moodle_import,
)

KEPT = "Please come to my office."  # a comment that a person wrote in Moodle


def old_grade(one: Enrolled) -> str:
    """Return the grade that the LMS has already: none, the same, or another one."""
    return ("", "", one.cell, "1.00")[one.number % 4]


def line(*cells: str, delimiter: str = ",") -> str:
    """Return a line as an LMS writes it."""
    text = io.StringIO(newline="")
    csv.writer(text, delimiter=delimiter, lineterminator="\r\n").writerow(cells)
    return text.getvalue()


def canvas_file(cells: Mapping[str, str], *, only: bool = False) -> bytes:
    """Return a Canvas gradebook with these grades, by key; with other assignments and computed columns."""
    before, after = ([], []) if only else (["9.00"], ["EX", "87.5"])
    text = line("Student", "ID", "SIS User ID", "SIS Login ID", "Section", *(["Prelab (1)"] if before else []), "A small lab (2)",
                *(["Report (3)", "Final Score"] if after else []))  # fmt: skip
    text += line("    Points Possible", "", "", "", "", *(["10.00"] if before else []), "11.00",
                 *(["20.00", "(read only)"] if after else []))  # fmt: skip
    for one in reversed(CLASS):
        if one.key in cells:
            name = f'="{one.student.name}"' if one.student.name.startswith("=") else one.student.name
            about = (name, one.canvas, one.student.sis, one.key, "S1")
            text += line(*about, *before, cells[one.key], *after)
    return text.encode()


def moodle_file(cells: Mapping[str, str], comments: Mapping[str, str]) -> bytes:
    """Return a Moodle grading worksheet with these grades and comments, by key."""
    text = line("Identifier", "Full name", "Email address", "Status", "Grade", "Maximum grade", "Grade can be changed",
                "Last modified (submission)", "Last modified (grade)", "Feedback comments")  # fmt: skip
    for one in reversed(CLASS):
        if one.key in cells:
            about = (f"Participant {one.student.moodle}", one.student.name, one.student.email, "Submitted, for grading")
            text += line(*about, cells[one.key], "11.00", "Yes", "Friday, 1 May", "-", comments.get(one.key, ""))
    return b"\xef\xbb\xbf" + text.encode()


def blackboard_file(cells: Mapping[str, str]) -> bytes:
    """Return a Blackboard file: tabs and UTF-16, with another column and columns for comments."""
    text = line("Last Name", "First Name", "Username", "Student ID", "Last Access", "Availability",
                "Prelab [Total Pts: 10 Score] |111", "A small lab [Total Pts: 11 Score] |222", "Total [Total Pts: up to 21 Score] |333",
                "Grading Notes", "Notes Format", "Feedback to Learner", "Feedback Format", delimiter="\t")  # fmt: skip
    for one in reversed(CLASS):
        if one.key in cells:
            about = (one.student.name, "", one.key, one.student.sis, "2026-09-10 12:00:00", "Yes", "9.00")
            more = ("19.00", "mine\nonly", "SMART_TEXT", 'a "word"', "SMART_TEXT")
            text += line(*about, cells[one.key], *more, delimiter="\t")
    return text.encode("utf-16")


def brightspace_file(cells: Mapping[str, str]) -> bytes:
    """Return a Brightspace export, with another grade item."""
    text = line("OrgDefinedId", "Username", "Last Name", "First Name", "Email",
                "Prelab Points Grade <Numeric MaxPoints:10 Weight:5>", "A small lab Points Grade <Numeric MaxPoints:11>",
                "End-of-Line Indicator")  # fmt: skip
    for one in reversed(CLASS):
        if one.key in cells:
            about = (f"#{one.student.sis}", f"#{one.key}", one.student.name, "", one.student.email)
            text += line(*about, "9.00", cells[one.key], "#")
    return b"\xef\xbb\xbf" + text.encode()


class Lms(NamedTuple):
    """How to write a file of an LMS, what it does with one, its id of a student, and what it calls the lab."""

    file: Callable[[Mapping[str, str]], bytes]
    imports: Callable[[bytes, State], State]
    id_of: Callable[[Enrolled], str]
    column: str
    other: str


SYSTEMS = {
    "canvas": Lms(canvas_file, canvas_import, lambda one: one.canvas, "A small lab", "Prelab"),
    "blackboard": Lms(blackboard_file, blackboard_import, lambda one: one.key, "222", "111"),
    "brightspace": Lms(brightspace_file, brightspace_import, lambda one: one.student.sis, "A small lab", "Prelab"),
}


@pytest.fixture(scope="module")
def book(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the gradebook of the class."""
    path = tmp_path_factory.mktemp("class") / "book.db"
    write_gradebook(path)
    return path


def export(book: Path, tmp_path: Path, lms: str, data: bytes, *more: object) -> tuple[bytes, str]:
    """Fill a file of an LMS; return it, and standard error."""
    (tmp_path / "lms.csv").write_bytes(data)
    into = ("--into", tmp_path / "lms.csv", "--output", tmp_path / "out.csv")
    done = grader("export", lms, "--gradebook", book, *into, *more)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    return (tmp_path / "out.csv").read_bytes(), done.stderr


def wanted(*, excuses: bool) -> dict[str, str]:
    """Return what the LMS must have after the import, of those whose row is not omitted."""
    cells = {one.key: "EX" if one.is_excused else one.cell for one in CLASS if excuses or not one.is_excused}
    return {key: cell for key, cell in cells.items() if cell}


def test_the_class_has_everything() -> None:
    """The class has what the other tests are about."""
    assert len(CLASS) == 120
    assert sum(one.is_excused for one in CLASS) >= 5
    assert sum(one.is_missing and one.final == 0 for one in CLASS) >= 3
    assert sum(one.is_missing and one.total is None for one in CLASS) >= 3
    assert sum(bool(one.days_late) for one in CLASS) >= 5
    assert sum(bool(one.essay) for one in CLASS) >= 20
    assert sum(one.partner != one.number for one in CLASS) == 10
    assert len({one.student.name for one in CLASS}) == 12


@pytest.mark.parametrize("lms", SYSTEMS)
def test_an_lms_imports_the_gradebook(lms: str, book: Path, tmp_path: Path) -> None:
    """Every grade is in the LMS afterwards, every other cell there is as it was, and the file is otherwise unchanged."""
    system = SYSTEMS[lms]
    before = {one.key: old_grade(one) for one in CLASS}
    data = system.file(before)
    out, said = export(book, tmp_path, lms, data, "--strict")
    grades = wanted(excuses=lms == "canvas")
    same = {key: before[key] if before[key] == cell else cell for key, cell in grades.items()}
    assert out == system.file(same)  # byte for byte
    state = {system.id_of(one): {system.column: before[one.key], system.other: "9.00"} for one in CLASS}
    after = system.imports(out, state)
    for one in CLASS:
        assert after[system.id_of(one)][system.column] == grades.get(one.key, before[one.key]), one
        assert after[system.id_of(one)][system.other] == "9.00"
    missing = [one for one in CLASS if one.is_missing and one.total is None and not one.is_excused]
    assert re.search(rf"without a grade: {len(missing)} \(.*\): nothing was submitted\n", said)
    excused = sum(one.is_excused for one in CLASS)
    line = rf"excused \(EX\): {excused} \(" if lms == "canvas" else rf"without a grade: {excused} \(.*\): excused\n"
    assert re.search(line, said)


def test_moodle_imports_the_gradebook(book: Path, tmp_path: Path) -> None:
    """Grades and comments; a comment of a person stays, and a student without a grade keeps everything."""
    before = {one.key: old_grade(one) for one in CLASS}
    comments = {one.key: KEPT for one in CLASS if one.number % 9 == 0}
    out, said = export(book, tmp_path, "moodle", moodle_file(before, comments), "--strict")
    grades = wanted(excuses=False)
    written = {one.key: text for one in CLASS if (text := comment_of(out, one)) is not None}
    assert out == moodle_file(grades, written)
    state = {one.student.moodle: {"Lab": before[one.key], "comment": comments.get(one.key, "")} for one in CLASS}
    after = moodle_import(out, state)
    for one in CLASS:
        assert after[one.student.moodle]["Lab"] == grades.get(one.key, before[one.key]), one
        comment = after[one.student.moodle]["comment"]
        if one.key in comments or one.key not in grades:
            assert comment == comments.get(one.key, "")
        elif one.final is not None:
            assert comment.startswith(
                f"<p>Graded manually by Kim: {one.cell.rstrip('0').rstrip('.') or '0'} of 11 points."
            )
            assert "<li>Final mark: given instead of the sum of the criteria. agreed" in comment
        else:
            people = "Kim and Lee" if one.essay else "Kim"
            assert comment.startswith(f"<p>Graded automatically, and manually by {people}: "), comment
            assert ("Late penalty: -" in comment) == (one.total != one.score)
    assert re.search(rf"without a grade: {sum(one.is_excused for one in CLASS)} \(.*\): excused\n", said)


def comment_of(data: bytes, one: Enrolled) -> str | None:
    """Return the comment in a student's row of a worksheet."""
    rows = csv.reader(io.StringIO(data.decode("utf-8-sig"), newline=""))
    return next((row[-1] for row in rows if row[0] == f"Participant {one.student.moodle}"), None)


def test_canvas_only_resets_no_other_assignment(book: Path, tmp_path: Path) -> None:
    """With --only, what was graded in Canvas after the export stays; without it a warning says that it is lost."""
    before = {one.key: "" for one in CLASS}
    out, said = export(book, tmp_path, "canvas", canvas_file(before), "--only")
    assert out == canvas_file(wanted(excuses=True), only=True)
    assert "other assignment" not in said
    state = {one.canvas: {"A small lab": "", "Prelab": "10.00", "Report": "20.00"} for one in CLASS}
    after = canvas_import(out, state)
    assert all(grades["Prelab"] == "10.00" and grades["Report"] == "20.00" for grades in after.values())
    everything, warned = export(book, tmp_path, "canvas", canvas_file(before))
    assert "2 other assignments: importing it resets their grades to those at the time of the export" in warned
    assert canvas_import(everything, state)[CLASS[1].canvas]["Prelab"] == "9.00"


@pytest.mark.parametrize("kind", ["markdown", "html"])
def test_moodle_gives_each_student_the_report(kind: str, book: Path, tmp_path: Path) -> None:
    """Each student with a result, a final mark or an excuse gets the own report, by the gradebook's participant or the worksheet's."""
    done = grader("export", "moodle", "--gradebook", book, "--feedback", tmp_path / "a.zip", "--feedback-format", kind)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    participants = {one.student.moodle: one.key for one in CLASS}
    found = moodle_feedback((tmp_path / "a.zip").read_bytes(), participants)
    expected = [one for one in CLASS if not one.is_missing or one.final is not None or one.is_excused]
    assert sorted(found) == [one.key for one in expected]
    for one in expected:
        ((name, report),) = found[one.key].items()
        assert name == f"small-feedback.{'md' if kind == 'markdown' else 'html'}"
        text = report.decode()
        assert set(re.findall(r"(?:blurred|agreed) for s\d+", text)) == {one.remark}
        assert ("Final mark: " in text) == (one.final is not None)
        assert (
            f"Note: Graded {'manually by Kim' if one.final is not None else 'automatically, and manually by '}" in text
        )
        assert ("Excused by Kim" in text) == one.is_excused
        assert (" late, as recorded by the instructor" in text) == (bool(one.days_late) and not one.is_missing)
        assert "Because of the roots" not in text  # the model answer
    if kind == "markdown":
        (tmp_path / "lms.csv").write_bytes(moodle_file({one.key: "" for one in CLASS[:60]}, {}))
        into = ("--into", tmp_path / "lms.csv", "--output", tmp_path / "out.csv", "--feedback", tmp_path / "b.zip")
        done = grader("export", "moodle", "--gradebook", book, *into)
        some = moodle_feedback((tmp_path / "b.zip").read_bytes(), participants)
        assert some == {one.key: found[one.key] for one in expected if one.number < 60}
        assert re.search(r"no feedback for \d+ \(.*\(s060\).*\): matches no row of the worksheet", done.stderr)


def test_canvas_gives_each_student_the_report(book: Path, tmp_path: Path) -> None:
    """Each gets the own report by the name of the submitted file; a group has one, unless the reports of its members differ."""
    for name in ("a.zip", "b.zip"):
        done = grader("export", "canvas", "--gradebook", book, "--feedback", tmp_path / name)
        assert (done.returncode, done.stdout) == (0, ""), done.stderr
    data = (tmp_path / "a.zip").read_bytes()
    assert data == (tmp_path / "b.zip").read_bytes()
    submitted = [one for one in CLASS if not one.is_missing]
    attachments = {(str(1000 + one.partner), str(90_000 + one.partner)): "lab.zip" for one in submitted}
    groups = {one.canvas: {one.canvas, CLASS[one.number + 1].canvas} for one in CLASS[40:60:2]}
    found = canvas_comments(data, attachments, groups)
    apart = 0
    for one in submitted:
        pair = {one, CLASS[one.partner], *([CLASS[one.partner + 1]] if 40 <= one.number < 60 else [])}
        if len({(member.is_missing, member.final, member.is_excused) for member in pair}) > 1:
            if not any(member.is_missing for member in pair):
                apart += 1
                assert one.canvas not in found
        else:
            assert one.remark.encode() in found[one.canvas], one
    assert len(found) > 90
    assert re.search(rf"no feedback for {apart} \(.*\): the members of the group have different reports", done.stderr)
    assert re.search(r"no feedback for .*\(s005\).*: submitted no file in Canvas", done.stderr)
