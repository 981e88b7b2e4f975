"""grader export: feedback as a zip for an LMS, what it refuses, who graded, and the columns for Excel."""

import csv
import io
import json
import os
import shutil
import zipfile
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import Entry, add_mark
from grader.classroom.gradebook.remarks import remarks_of
from grader.classroom.lms.feedback import FeedbackItem, feedback_html, is_own_feedback
from grader.grading.rubric import read_rubric
from tests.classroom.gradebooks import batch, graded_as, grader, lab_text, make_class, record_run, refusal, urdf

OWN = (
    "<p>Graded automatically: 58.5 of 100 points.</p><ul><li>The base: 2 of 4. it is 0.1 m too low</li></ul>"
    "<!-- grader 81396dd30bb0 -->"
)


def export(top: Path, *arguments: object) -> Any:
    """Export from the class's gradebook."""
    return grader("export", *arguments, "--gradebook", top / "book.db")


def mark(top: Path, key: str, criterion: str, entry: Entry, by: str = "") -> None:
    """Add an entry of a person."""
    with Gradebook(top / "book.db") as book:
        add_mark(book, Grades(book).find(key), criterion, entry, by)


def points(value: str, comment: str = "") -> Entry:
    """Return points with a comment."""
    return Entry("points", Decimal(value), comment)


def rows(top: Path, *more: object) -> dict[str, dict[str, str]]:
    """Return the rows of the exported CSV, by key."""
    done = export(top, "csv", *more)
    assert (done.returncode, done.stderr) == (0, "")
    return {row["id"]: row for row in csv.DictReader(io.StringIO(done.stdout))}


# --- Who graded, and what persons said --------------------------------------------------------------------------------


def test_who_graded(top: Path) -> None:
    """Automatic, manual, or both; with the names that were given; a final mark is that of its giver alone."""

    def graded_by(key: str) -> str:
        with Gradebook(top / "book.db") as book:
            grades = Grades(book)
            return remarks_of(grades, grades.find(key)).graders.words

    assert graded_by("emil") == "automatically"
    mark(top, "emil", "box", Entry("comment", None, "see the lab"), "Kim")
    assert graded_by("emil") == "automatically"  # no points
    mark(top, "emil", "essay", points("2"))
    assert graded_by("emil") == "automatically, and manually"
    mark(top, "emil", "picture", points("1"), "Lee")
    mark(top, "emil", "box", points("1"), "Kim")
    assert graded_by("emil") == "automatically, and manually by Kim and Lee"
    mark(top, "emil", "box", Entry("withdrawn"), "Ann")
    assert graded_by("emil") == "automatically, and manually by Lee"
    mark(top, "emil", "total", points("9"), "Ann")
    assert graded_by("emil") == "manually by Ann"
    mark(top, "dora", "total", points("0"))
    assert graded_by("dora") == "manually"


def test_reports_have_final_marks_excuses_and_comments(top: Path) -> None:
    """As notes, in every format that a batch writes for students."""
    mark(top, "anna", "total", points("7.5", "an\n interview\n"), "Kim")
    mark(top, "ben", "total", Entry("excused", None, "ill"))
    mark(top, "emil", "total", Entry("comment", None, "nice <b>colours</b>\x1b"), "Lee")
    formats = ("--report-format", "json", "--report-format", "markdown", "--report-format", "html")
    assert batch(top, "--reports", top / "reports", *formats).returncode == 0

    def notes(key: str) -> list[str]:
        return list(json.loads((top / "reports" / f"{key}.json").read_text())["notes"])

    final = "Final mark: 7.5 points, given by Kim instead of the sum of the criteria. an interview"
    assert notes("anna") == [final, "Graded manually by Kim."]
    assert notes("ben") == ["Excused. ill"]
    assert notes("emil") == ["Comment by Lee: nice <b>colours</b>\x1b"]
    assert "Comment by Lee: nice &lt;b&gt;colours&lt;/b&gt;" in (top / "reports" / "emil.md").read_text()
    assert "Comment by Lee: nice &lt;b&gt;colours&lt;/b&gt;\\x1b" in (top / "reports" / "emil.html").read_text()


def test_feedback_says_who_graded() -> None:
    """The grader's own comments are recognised; other words are a person's."""
    assert feedback_html(Decimal("58.5"), Decimal(100), [FeedbackItem("The base", Decimal(2), Decimal(4), "it is 0.1 m too low")]) == OWN  # fmt: skip
    for words in ("automatically", "manually", "automatically, and manually by =Kim & <Lee>;=1"):
        text = feedback_html(Decimal(1), Decimal(2), [FeedbackItem("Comment", None, Decimal(0), "fine")], words)
        assert is_own_feedback(text)
        assert "<li>Comment: fine</li>" in text
        assert not is_own_feedback(text.replace("fine", "not fine"))
    assert is_own_feedback(OWN)
    assert not is_own_feedback(OWN.replace("automatically", "badly"))


def test_moodle_has_comments_without_points_and_final_marks(top: Path) -> None:
    """A comment on a criterion with full points, and a zero with its reason for a student who submitted nothing."""
    mark(top, "anna", "box", Entry("comment", None, "well done"), "Kim")
    mark(top, "anna", "essay", points("4"), "Kim")
    mark(top, "anna", "picture", points("1"), "Kim")
    mark(top, "dora", "total", points("0", "never came"), "Lee")
    head = "Identifier,Full name,Username,Grade,Maximum grade,Last modified (grade),Feedback comments"
    (top / "moodle.csv").write_text(f"{head}\nParticipant 1,Anna,anna,,11.00,-,\nParticipant 2,Dora,dora,,11.00,-,\n")
    done = export(top, "moodle", "--into", top / "moodle.csv")
    anna, dora = (row["Feedback comments"].partition("<!--")[0] for row in csv.DictReader(io.StringIO(done.stdout)))
    both = "automatically, and manually by Kim"
    assert anna == f"<p>Graded {both}: 11 of 11 points.</p><ul><li>About box: 2.5 of 2.5. well done</li></ul>"
    assert dora == (
        "<p>Graded manually by Lee: 0 of 11 points.</p>"
        "<ul><li>Final mark: given instead of the sum of the criteria. never came</li></ul>"
    )


def test_extra_credit_is_not_part_of_the_maximum_in_the_lms(tmp_path: Path) -> None:
    """A bonus of 2 above 11 points: the maximum in the LMS is 11, and points above it are listed."""
    text = lab_text(extra="2").replace('id = "extra"', 'id = "extra"\nbonus = true')
    rubric = read_rubric(text.encode(), Path("small.toml"))
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, rubric, [graded_as(rubric, "anna", "pppppp")])
    (tmp_path / "d2l.csv").write_text(
        "Username,A small lab Points Grade <Numeric MaxPoints:11>,End-of-Line Indicator\n#anna,,#\n"
    )
    done = export(tmp_path, "brightspace", "--into", tmp_path / "d2l.csv")
    assert done.stdout.endswith("#anna,13.00,#\n")
    assert "row 2, anna: 13 points: Brightspace reduces them to the maximum" in done.stderr
    head = "Identifier,Full name,Username,Grade,Maximum grade,Last modified (grade),Feedback comments"
    (tmp_path / "moodle.csv").write_text(f"{head}\nParticipant 1,Anna,anna,,11.00,-,\n")
    why = "13.00 points are above the maximum of 11: raise the maximum there, or give a final mark"
    for more, code in (((), 0), (("--strict",), 1)):
        done = export(tmp_path, "moodle", "--into", tmp_path / "moodle.csv", *more)
        assert done.returncode == code
        assert f"the LMS would refuse the grade: row 2, Anna: {why}\n" in done.stderr


# --- CSV --------------------------------------------------------------------------------------------------------------


def test_the_columns_of_a_class(top: Path) -> None:
    """Section, marker, submission time, final mark, excuse, all comments and who graded, behind the criteria."""
    lines = ["id,name,section,marker,submitted,canvas id"]
    lines += [f"{key},{key.title()},Mo;=1,Kim,2026-09-12T10:00:00Z,{101 + n}" for n, key in enumerate(("anna", "ben"))]
    (top / "roster.csv").write_text("\n".join([*lines, "dora,Dora,Tu,Lee,,104"]) + "\n")
    assert batch(top).returncode == 0
    mark(top, "anna", "essay", points("2", "=too\nshort"), "Lee")
    mark(top, "anna", "total", Entry("comment", None, "see me"))
    mark(top, "ben", "total", Entry("excused", None, "ill"))
    mark(top, "dora", "total", points("0.5"), "Lee")
    found = rows(top)
    names = ("section", "marker", "submitted", "final_mark", "excused", "comments", "graded_by")
    assert [found["anna"][name] for name in names] == [
        "Mo;'=1",
        "Kim",
        "2026-09-12T10:00:00Z",
        "",
        "",
        "essay: =too short; total: see me",
        "automatically, and manually by Lee",
    ]
    assert [found["ben"][name] for name in names[3:]] == ["", "yes", "total: ill", "automatically"]
    assert found["ben"]["not_final_because"] == "excused"
    assert [found["dora"][name] for name in ("status", "total", *names[3:])] == [
        "missing", "0.5", "0.5", "", "", "manually by Lee",
    ]  # fmt: skip


def test_excel(top: Path) -> None:
    """With --excel there is a byte-order mark before the same bytes."""
    for name, more in (("plain.csv", ()), ("excel.csv", ("--excel",))):
        assert export(top, "csv", *more, "--output", top / name).returncode == 0
    plain = (top / "plain.csv").read_bytes()
    assert plain.startswith(b"id,")
    assert (top / "excel.csv").read_bytes() == b"\xef\xbb\xbf" + plain


# --- The zip ----------------------------------------------------------------------------------------------------------


def test_the_feedback_of_real_submissions(top: Path) -> None:
    """The participants of a worksheet get their reports, also one who submitted nothing and has a final mark."""
    mark(top, "dora", "total", points("0", "never came"), "Lee")
    names = "Identifier,Full name,Username,Grade,Maximum grade,Last modified (grade),Feedback comments\n"
    people = "".join(f"Participant {n},{key.title()} X,{key},,11.00,-,\n" for n, key in enumerate(("anna", "dora"), 7))
    (top / "moodle.csv").write_text(names + people)
    into = ("--into", top / "moodle.csv", "--output", top / "out.csv", "--feedback", top / "feedback.zip")
    done = export(top, "moodle", *into, "--pending-as-zero")
    assert done.returncode == 0, done.stderr
    assert (top / "out.csv").read_text().count("Participant") == 2
    with zipfile.ZipFile(top / "feedback.zip") as archive:
        assert archive.namelist() == [
            "Anna Ek_7_assignfeedback_file/small-feedback.md",
            "Dora Fi_8_assignfeedback_file/small-feedback.md",
        ]
        anna, dora = (archive.read(name).decode() for name in archive.namelist())
        assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    assert "Note: Graded automatically." in anna
    assert "Note: Graded manually by Lee." in dora
    assert "The roots of anna." in anna  # the student's answer
    assert "Because of the roots" not in anna  # the model answer
    assert "Note: Final mark: 0 points, given by Lee instead of the sum of the criteria. never came" in dora
    assert "Not graded, because nothing was submitted: loads, box, tall, essay and picture (11 points)." in dora
    assert (
        "no feedback for 3 (Ben Oh (ben), Cleo Ray (cleo) and Ben Oh (emil)): matches no row of the worksheet, or several"
        in done.stderr
    )
    assert "reports of grades that are not final yet: 1\n" in done.stderr  # of anna
    assert "2 files for 2 students" in done.stderr


def test_a_file_name_that_is_not_utf_8(tmp_path: Path) -> None:
    """Its student gets no report, and the others get theirs."""
    make_class(tmp_path)
    shutil.rmtree(tmp_path / "class")
    (tmp_path / "class").mkdir()
    for name in (b"anna_101_555_robot.urdf", b"bob_102_556_ro\xffbot.urdf"):
        Path(os.fsdecode(os.path.join(os.fsencode(tmp_path), b"class", name))).write_text(urdf())
    assert batch(tmp_path).returncode == 0
    done = export(tmp_path, "canvas", "--feedback", tmp_path / "feedback.zip")
    assert done.returncode == 0, done.stderr
    why = "Canvas would find another student, or none, by the name 'bob_102_556_ro\\udcffbot.urdf'"
    assert f"no feedback for Ben Oh (ben): {why}\n" in done.stderr
    with zipfile.ZipFile(tmp_path / "feedback.zip") as archive:
        assert archive.namelist() == ["anna_101_555_robot.urdf"]


def test_strict_writes_no_feedback(top: Path) -> None:
    """If a row has no student, neither file is written."""
    names = "Identifier,Full name,Username,Grade,Maximum grade,Last modified (grade),Feedback comments\n"
    (top / "moodle.csv").write_text(names + "Participant 7,Nobody,nobody,,11.00,-,\n")
    into = ("--into", top / "moodle.csv", "--output", top / "out.csv", "--feedback", top / "feedback.zip")
    assert export(top, "moodle", *into, "--strict").returncode == 1
    assert not (top / "out.csv").exists()
    assert not (top / "feedback.zip").exists()


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (
            ("moodle", "--only", "--into", "x.csv"),
            "export moodle does not take --only; canvas, blackboard and brightspace do",
        ),
        (("canvas", "--excel", "--into", "x.csv"), "export canvas does not take --excel; csv does"),
        (("csv", "--feedback", "f.zip"), "export csv does not take --feedback; moodle and canvas do"),
        (("blackboard", "--feedback", "f.zip"), "export blackboard does not take --feedback; moodle and canvas do"),
        (("blackboard",), "export blackboard fills in a file that the LMS exported: give it with --into"),
        (
            ("canvas", "--feedback", "f.zip", "--output", "o.csv"),
            "--output is the filled file of the LMS, which needs --into; --feedback names the zip",
        ),
        (("canvas", "--feedback", "{top}/link.zip"), "cannot write {top}/link.zip: it is a symlink"),
        (("canvas", "--feedback", "{top}/class"), "cannot write {top}/class: it is a folder"),
        (
            ("canvas", "--feedback", "{top}/roster.csv"),
            "cannot write {top}/roster.csv: it exists and is not a zip; name another file",
        ),
        (("canvas", "--feedback", "{top}/book.db"), "cannot write {top}/book.db: this would overwrite the gradebook"),
        (
            ("moodle", "--feedback", "{top}/roster.csv", "--into", "{top}/roster.csv", "--output", "{top}/o.csv"),
            "cannot write {top}/roster.csv: it is also the file of --into or --output",
        ),
        (("canvas", "--feedback", "{top}/f.zip"), "no student would get a report in Canvas: "),
        (
            ("moodle", "--feedback", "{top}/f.zip"),
            "no student would get a report in Moodle: the gradebook has no ",
        ),
    ],
)
def test_what_is_refused(arguments: tuple[str, ...], why: str, top: Path) -> None:
    """With one line; the gradebook and what a symlink leads to keep their content, and there is no zip."""
    (top / "victim").write_text("mine")
    (top / "link.zip").symlink_to("victim")
    assert refusal(export(top, *(word.format(top=top) for word in arguments))).startswith(why.format(top=top))
    assert (top / "victim").read_text() == "mine"
    assert rows(top)["anna"]["score"] == "6"
    assert not (top / "f.zip").exists()


def test_a_symlink_in_a_submission_is_not_followed(top: Path) -> None:
    """A folder that a student linked is no place for the zip."""
    assert batch(top).returncode == 0  # the gradebook comes from a copy of the class
    (top / "class" / "anna" / "out").symlink_to(top)
    why = refusal(export(top, "canvas", "--feedback", top / "class" / "anna" / "out" / "f.zip"))
    assert why.endswith(" is a symlink in the submission; choose a file outside of it")
    assert not (top / "f.zip").exists()
