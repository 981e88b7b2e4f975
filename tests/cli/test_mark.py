"""grader mark: a manual mark on one criterion is kept, whatever is graded again."""

import json
import subprocess
import sys
import threading
from decimal import Decimal
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.report.formats import Format, OutputFormat, json_schema
from grader.usecases.class_summary import SummaryRequest, class_summary
from tests.classroom.gradebooks import (
    ENVIRONMENT,
    HOSTILE,
    batch,
    grader,
    lab_text,
    make_class,
    refusal,
    urdf,
    write_submission,
)
from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT

GRADE = ("score", "max_score", "pending")
EVERYONE = "; `grader export csv --gradebook TOP/book.db` lists all students"
CRITERIA = " (`grader rubric show TOP/small.toml` lists them)"


def mark(top: Path, *arguments: object, **more: Any) -> subprocess.CompletedProcess[str]:
    """Mark in the class's gradebook."""
    return grader("mark", *arguments, "--gradebook", top / "book.db", **more)


def student(top: Path, key: str) -> dict[str, Any]:
    """Return a student's grade from `grader export json`, which equals the view."""
    with Gradebook(top / "book.db") as book:
        data = json.loads(class_summary(Grades(book), SummaryRequest(OutputFormat.JSON)))
        (found,) = [student for student in data["students"] if student["id"] == key]
        ((score, out_of, pending, marks),) = book.rows(
            "SELECT score, out_of, pending, marks FROM grade WHERE key = ?", key
        )
    numbers = [None if found[name] is None else Decimal(str(found[name])) * 10_000 for name in GRADE]
    assert [score, out_of, pending, marks] == [*numbers, found["manual_marks"]]
    return dict(found)


def marks(top: Path) -> list[tuple[Any, ...]]:
    """Return all marks ever given."""
    with Gradebook(top / "book.db") as book:
        return list(book.rows("SELECT criterion, points, comment, author, at, result FROM mark ORDER BY id"))


@pytest.mark.parametrize("name", ["anna", "ae1", "anna@example.org", "101", "Anna Ek"])
def test_who_is_marked(name: str, top: Path) -> None:
    """A student is found by key, login, address, number or name; one line gives the new score, key and name."""
    done = mark(top, name, "essay", "3,5", "--comment", "the roots are missing", "--by", "Kim")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "anna, Anna Ek: 9.5 of 11 points; needs manual grading: 1 point\n"
    ((criterion, points, comment, author, at, _),) = marks(top)
    assert (criterion, points, comment, author) == ("essay", 35_000, "the roots are missing", "Kim")
    assert at.startswith("20")
    assert at.endswith("+00:00")


@pytest.mark.parametrize(
    ("who", "what", "points", "why"),
    [
        (
            "Ben Oh",
            "essay",
            "1",
            "'Ben Oh' is ambiguous: it may be 'ben' (Ben Oh), 'emil' (Ben Oh); use one of these ids",
        ),
        ("ana", "essay", "1", "there is no student 'ana' in the gradebook; did you mean 'anna'?"),
        ("\x1b[31m", "essay", "1", rf"there is no student '\x1b[31m' in the gradebook{EVERYONE}"),
        (b"\xff", "essay", "1", rf"there is no student '\\udcff' in the gradebook{EVERYONE}"),
        (
            "dora",
            "essay",
            "1",
            "dora has submitted nothing that could be marked; `grader mark dora total POINTS` gives a final mark",
        ),
        ("anna", "esay", "1", f"the rubric small has no criterion 'esay'; did you mean 'essay'?{CRITERIA}"),
        ("anna", "essay", "4.5", "essay is worth 0 to 4 points, not 4.5"),
        ("anna", "essay", "nan", "points are a number from 0 to 4, with at most 4 decimals, not 'nan'"),
        ("anna", "essay", "1.00001", "points are a number from 0 to 4, with at most 4 decimals, not '1.00001'"),
        ("anna", "essay", "-1", "essay is worth 0 to 4 points, not -1"),
        ("anna", "essay", "-,5", "essay is worth 0 to 4 points, not -,5"),
        ("anna", "essay", "-x", "No such option: -x (`grader mark --help` shows the usage)"),
        ("anna", "essay", "--1", "No such option: --1 (`grader mark --help` shows the usage)"),
        ("anna", "essay", "1e400", "essay is worth 0 to 4 points, not 1e400"),
    ],
)
def test_what_is_refused(who: str, what: str, points: str, why: str, graded_class: Path) -> None:
    """One plain line, and nothing is recorded."""
    assert refusal(mark(graded_class, who, what, points)) == why.replace("TOP", str(graded_class))
    assert marks(graded_class) == []


def test_a_number_below_zero_as_a_comment(top: Path) -> None:
    """A value after an option belongs to it, and options may follow the points."""
    assert mark(top, "anna", "essay", "1", "--comment", "-1", "--by", "-2").returncode == 0
    assert marks(top)[0][1:4] == (10_000, "-1", "-2")
    assert refusal(mark(top, "anna", "essay", "-3", "--comment", "-1")) == "essay is worth 0 to 4 points, not -3"
    done = grader("mark", "--gradebook", top / "book.db", "--", "anna", "essay", "-3")
    assert refusal(done) == "essay is worth 0 to 4 points, not -3"


def test_the_late_penalty_is_part_of_the_output(tmp_path: Path) -> None:
    """The points of the criteria come first, then what is left of them."""
    make_class(tmp_path, "percent_per_day = 10\n")
    (tmp_path / "roster.csv").write_text("id,late\nanna,1 day\nben,\n")
    assert batch(tmp_path).returncode == 0
    done = mark(tmp_path, "anna", "essay", "4")
    assert done.stdout == "anna: 10 of 11 points; 8.9 after the late penalty; needs manual grading: 1 point\n"
    assert mark(tmp_path, "ben", "essay", "4").stdout == "ben: 10 of 11 points; needs manual grading: 1 point\n"


def test_a_later_mark_replaces_an_earlier_one(top: Path) -> None:
    """Both are kept; `-` removes it, and another `-` changes nothing."""
    before = student(top, "anna")
    for points, score in (("3", 9), ("0", 6), ("4", 10), ("-", 6), ("-", 6), ("1", 7)):
        assert mark(top, "anna", "essay", points).returncode == 0
        assert student(top, "anna")["score"] == score
    assert [row[1] for row in marks(top)] == [30_000, 0, 40_000, None, None, 10_000]
    mark(top, "anna", "essay", "-")
    assert student(top, "anna") == before


@pytest.mark.parametrize(
    ("key", "criterion", "points", "score", "out_of", "pending"),
    [
        ("emil", "box", "1.25", 4.25, 11, 5),  # failed
        ("emil", "tall", "0.5", 3.5, 11, 5),  # skipped
        ("anna", "loads", "0", 3, 11, 5),  # passed
        ("anna", "picture", "1", 7, 11, 4),  # pending
        ("ben", "essay", "4", 10, 11, 1),  # of a single URDF as well
        ("cleo", "box", "2.5", 2.5, 11, 8.5),  # nothing could be read
    ],
)
def test_a_mark_overrides_a_check(
    key: str, criterion: str, points: str, score: float, out_of: float, pending: float, top: Path
) -> None:
    """The mark counts instead of the check, and is shown beside it."""
    assert mark(top, key, criterion, points, "--comment", "seen").returncode == 0
    found = student(top, key)
    assert (found["score"], found["max_score"], found["pending"]) == (score, out_of, pending)
    assert (found["manual_marks"], found["total"]) == (1, score)


@pytest.mark.usefixtures("hostile_checks")
def test_a_mark_on_an_errored_criterion(tmp_path: Path) -> None:
    """A mark replaces the result of a check that failed with an error; the grade is final then."""
    (tmp_path / "class").mkdir()
    text = urdf().replace('name="r"', 'name="raises"')
    (tmp_path / "class" / "anna.urdf").write_text(text)
    (tmp_path / "roster.csv").write_text("id\nanna\n")
    arguments = ("--rubric", HOSTILE / "hostile.toml", "--gradebook", tmp_path / "book.db")
    assert grader("batch", tmp_path / "class", *arguments).returncode == 0
    book = ("--gradebook", tmp_path / "book.db")

    def status() -> tuple[Any, ...]:
        (found,) = json.loads(grader("export", "json", *book).stdout)["students"]
        return found["status"], found["score"], found["is_final"]

    assert status() == ("errored", 1, False)
    assert "nothing needs manual grading" in grader("review", *book).stdout
    done = grader("mark", "anna", "behaves", "1.5", *book)
    assert (done.returncode, done.stdout) == (0, "anna: 2.5 of 3 points\n")
    assert status() == ("errored", 2.5, True)
    assert "could not be graded, and was marked manually (1): anna" in grader("stats", *book).stdout


def test_no_run_loses_a_mark(top: Path) -> None:
    """Not the same run, --force, another submission, another rubric, or a removed submission."""
    mark(top, "anna", "essay", "3", "--comment", "good", "--by", "Kim")
    mark(top, "anna", "box", "1", "--by", "Kim")
    kept = marks(top)

    def score_after(*more: object, rubric: object = None) -> float:
        assert batch(top, *more, rubric=rubric).returncode == 0
        assert marks(top) == kept
        return float(student(top, "anna")["score"])

    assert score_after() == 7.5
    assert score_after("--force") == 7.5
    (top / "class" / "anna" / "robot.urdf").write_text(urdf("2 2 2"))
    assert score_after() == 7  # the check that needs the box is skipped now
    listed = grader("stats", "--gradebook", top / "book.db").stdout
    assert "marked before the submission changed (1) Anna Ek (anna): box, essay" in " ".join(listed.split())
    (top / "other.toml").write_text(lab_text(loads="2", extra="0.5"))
    assert score_after(rubric=top / "other.toml") == 6.5
    (top / "without.toml").write_text(lab_text().replace('"essay"', '"answer"'))
    assert score_after(rubric=top / "without.toml") == 4  # the rubric has no essay any more
    assert score_after() == 7
    write_submission(top / "elsewhere" / "zoe")
    added = ("batch", top / "elsewhere", "--gradebook", top / "book.db", "--rubric", top / "small.toml", "--add")
    assert grader(*added).returncode == 0
    assert (marks(top), student(top, "anna")["score"]) == (kept, 7)


HARMFUL = "[bold]x[/bold] \x1b]0;gone\x07\x1b[2J\u202eabc\r\n=1+1\t</p><script>"


def test_a_comment_is_data(top: Path) -> None:
    """It is kept as typed, and is neutralised wherever it is shown."""
    assert mark(top, "anna", "essay", "1", "--comment", HARMFUL, "--by", "[red]\x1b[31mme").returncode == 0
    assert marks(top)[0][2:4] == (HARMFUL, "[red]\x1b[31mme")
    done = batch(top, "--reports", top / "reports", "--report-format", "terminal", "--report-format", "json")
    assert done.returncode == 0
    text = (top / "reports" / "anna.txt").read_text()
    assert r"Marked by [red]\x1b[31mme: [bold]x[/bold] \x1b]0;gone\x07\x1b[2J\u202eabc" in " ".join(text.split())
    assert not set(text) & set("\x1b\x07\r\u202e")
    report = json.loads((top / "reports" / "anna.json").read_text())
    jsonschema.validate(report, json_schema("report"))
    (essay,) = [result for result in report["results"] if result["id"] == "essay"]
    assert essay["mark"] == {"points": 1, "by": "[red]\x1b[31mme", "comment": HARMFUL}


def test_undecodable_bytes(top: Path) -> None:
    """A comment in another encoding is kept as far as it can be read."""
    assert mark(top, "anna", "essay", "1", "--comment", b"gr\xfcn", "--by", b"\xff").returncode == 0
    assert marks(top)[0][2:4] == ("gr\\udcfcn", "\\udcff")


def test_the_default_author(top: Path) -> None:
    """The author is the account that is logged in."""
    assert mark(top, "anna", "essay", "1", LOGNAME="kim").returncode == 0
    assert marks(top)[0][3] == "kim"


@pytest.mark.exhaustive
def test_concurrent_marks(top: Path) -> None:
    """Several graders, and a batch that grades everything meanwhile: nothing is lost."""
    expected = [(key, name) for key in ("anna", "emil") for name in ("essay", "picture", "box", "loads")]
    command = [sys.executable, "-m", "grader"]
    book = str(top / "book.db")
    started = [
        subprocess.Popen(
            [*command, "mark", *words, "0.5", "--gradebook", book],
            cwd=ROOT,
            env=ENVIRONMENT,
            stdout=subprocess.DEVNULL,
        )
        for words in expected
    ]
    done = batch(top, "--force")
    assert done.returncode == 0, done.stderr
    assert [process.wait(HANG_TIMEOUT) for process in started] == [0] * len(expected)
    assert len(marks(top)) == len(expected)
    assert student(top, "anna")["score"] == 2.5
    assert student(top, "emil")["score"] == 2


@pytest.mark.exhaustive
def test_marks_of_several_threads_wait_for_each_other(top: Path) -> None:
    """A slow write does not break another one."""
    with Gradebook(top / "book.db") as book:
        with book.transaction():
            other: list[int] = []
            thread = threading.Thread(target=lambda: other.append(mark(top, "anna", "essay", "1").returncode))
            thread.start()
            thread.join(0.5)
            assert other == []
        thread.join()
    assert other == [0]


def test_a_replaced_mark_is_reported(top: Path) -> None:
    """There is no question, and a removed mark is not reported as replaced."""
    assert mark(top, "anna", "essay", "3", "--by", "Kim", "--comment", "no\nroots").stderr == ""
    second = mark(top, "anna", "essay", "1")
    assert second.stdout == "anna, Anna Ek: 7 of 11 points; needs manual grading: 1 point\n"
    assert second.stderr.startswith("grader: this replaces the newest mark of essay: 3 points by Kim at 20")
    assert second.stderr.endswith(": no roots\n")
    third = mark(top, "anna", "essay", "-")
    assert "essay: 1 point by an unnamed person at 20" in third.stderr
    assert mark(top, "anna", "essay", "2").stderr == ""


def test_no_report_names_an_account(top: Path) -> None:
    """Without `--by` no report, table or feedback names an author; with it, that name.

    The gradebook keeps the account.
    """
    account = {"LOGNAME": "jdoe47"}
    assert mark(top, "anna", "essay", "3", "--comment", "fine", **account).returncode == 0
    assert mark(top, "emil", "essay", "3", "--by", "Kim", **account).returncode == 0
    assert grader("review", "--gradebook", top / "book.db", stdin="1\nq\n", **account).returncode == 0
    formats = [part for kind in Format if kind.needs != "identity" for part in ("--report-format", kind)]
    out = top / "out"
    done = batch(top, "--reports", out, *formats, "--csv", out.with_suffix(".csv"))
    assert done.returncode == 0, done.stderr
    worksheet = top / "moodle.csv"
    worksheet.write_text(
        "Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed,Last modified (grade),Feedback comments\n"
        "Participant 1,Anna Ek,anna@example.org,Submitted,-,11.00,Yes,-,\n",
        encoding="utf-8",
    )
    book = ("--gradebook", top / "book.db")
    output = [done.stdout, done.stderr]
    for arguments in (("csv",), ("json",), ("moodle", "--into", worksheet, "--pending-as-zero")):
        shown = grader("export", *arguments, *book)
        assert shown.returncode == 0, shown.stderr
        output.append(shown.stdout + shown.stderr)
    assert "fine" in output[-1]
    files = [path.read_text(encoding="utf-8") for path in (*out.iterdir(), out.with_suffix(".csv"))]
    assert len(files) > len(Format)
    assert all("jdoe47" not in text for text in (*files, *output))
    assert "Marked manually: fine." in (out / "anna.md").read_text(encoding="utf-8")
    assert "Marked by Kim." in (out / "emil.md").read_text(encoding="utf-8")
    assert [row[3] for row in marks(top)] == ["jdoe47", "Kim", "jdoe47"]


def test_a_rerun_counts_what_could_not_be_graded(top: Path) -> None:
    """Unchanged submissions that cannot be read are not hidden among the others."""
    assert "grader: 4 graded, 0 unchanged\n" in batch(top, "--force").stderr
    assert "grader: 0 graded, 4 unchanged (1 could not be graded)\n" in batch(top).stderr
