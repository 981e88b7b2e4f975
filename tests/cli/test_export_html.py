"""grader export html, and batch --report-format html: the pages of the students and of the class, as files."""

import zipfile
from collections.abc import Callable
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.run.pool import WorkerError
from grader.classroom.run.progress import Progress
from grader.errors import InputError
from grader.report.formats import Format
from grader.usecases.class_reports import ReportRun, write_reports
from tests.classroom.gradebooks import batch, grader, lab_text, refusal
from tests.report.class_pages import ClassPageReader

NAMES = {"anna": "Anna Ek", "ben": "Ben Oh", "cleo": "Cleo Ray", "dora": "Dora Fi", "emil": "Ben Oh"}


def export(top: Path, *more: object) -> str:
    """Write the pages of the class and return what is said on standard error."""
    done = grader("export", "html", "--gradebook", top / "book.db", "--output", top / "pages", *more)
    assert (done.returncode, done.stdout) == (0, "")
    return done.stderr


def contents(folder: Path) -> dict[str, bytes]:
    """Return the files of a folder."""
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_pages_of_a_class(top: Path) -> None:
    """There is a page for each student who has submitted, and one about all; nobody's page tells of others."""
    assert export(top) == f"grader: 4 reports written to {top / 'pages'}\n"
    files = contents(top / "pages")
    assert sorted(files) == ["anna.html", "ben.html", "cleo.html", "emil.html", "index.csv", "index.html"]
    page = ClassPageReader(top / "pages/index.html")
    rows = page.table("students")
    assert [row["name"] for row in rows] == sorted(NAMES.values())
    assert {row["key"]: row["status"] for row in rows} == {
        **dict.fromkeys(("anna", "ben", "emil"), "graded"),
        "cleo": "could not be graded: cleo.zip cannot be read as an archive: File is not a zip file",
        "dora": "nothing was submitted",
    }
    assert {row["key"]: (row["grade"], row["pending"], row["lost"]) for row in rows} == {
        "anna": ("6", "5", ""),
        "ben": ("6", "5", ""),
        "cleo": ("0", "11", ""),
        "dora": ("", "", ""),
        "emil": ("3", "5", "box and tall"),
    }
    assert sorted(page.links()) == ["anna.html", "ben.html", "cleo.html", "emil.html"]
    assert page.members("status-missing") == ["Dora Fi"]
    assert page.members("attention") == ["Cleo Ray", "Dora Fi"]
    for key in ("anna", "ben", "cleo", "emil"):
        text = files[f"{key}.html"].decode()
        assert "index.html" not in text
        assert not [name for other, name in NAMES.items() if name in text and name != NAMES[key]]
    assert b"of the roots" not in b"".join(files.values())


@pytest.mark.parametrize("entry", ["0", "--excused"])
def test_a_student_without_a_submission_has_a_page(top: Path, entry: str) -> None:
    """With a final mark or an excuse: in a batch, among the pages, and in the feedback for Moodle."""
    book = ("--gradebook", top / "book.db")
    assert grader("mark", "dora", "total", entry, *book).returncode == 0
    assert batch(top, "--reports", top / "reports", "--report-format", "html").returncode == 0
    export(top)
    assert contents(top / "reports") == contents(top / "pages")
    note = b"Final mark: 0 points, given manually" if entry == "0" else b"Excused."
    assert note in (top / "pages" / "dora.html").read_bytes()
    assert "dora.html" in ClassPageReader(top / "pages/index.html").links()
    head = "Identifier,Full name,Username,Grade,Maximum grade,Last modified (grade),Feedback comments"
    (top / "moodle.csv").write_text(f"{head}\nParticipant 8,Dora Fi,dora,,11.00,-,\n")
    into = ("--into", top / "moodle.csv", "--output", top / "out.csv", "--feedback", top / "f.zip")
    assert grader("export", "moodle", *book, *into).returncode == 0
    with zipfile.ZipFile(top / "f.zip") as archive:
        (name,) = archive.namelist()
        assert note.rstrip(b".") in archive.read(name)


def test_batch_writes_the_same(top: Path) -> None:
    """Together with other formats, which are as before; and twice the same bytes."""
    export(top)
    before = contents(top / "pages")
    formats = ("--report-format", "html", "--report-format", "json")
    assert batch(top, "--reports", top / "reports", *formats).returncode == 0
    after = contents(top / "reports")
    assert {name: after.pop(name) for name in [*after] if name.endswith(".json")}.keys() == {
        "anna.json", "ben.json", "cleo.json", "emil.json",
    }  # fmt: skip
    assert after == before
    export(top)
    assert contents(top / "pages") == before


def test_late_penalties_have_columns(top: Path) -> None:
    """The days and the penalty are in the table only if somebody is late; the grade is what remains."""
    (top / "roster.csv").write_text("id,name,late\nanna,Anna Ek,\nben,Ben Oh,2\n")
    (top / "small.toml").write_text(lab_text("percent_per_day = 10\n"))
    assert batch(top).returncode == 0
    export(top)
    rows = {row["key"]: row for row in ClassPageReader(top / "pages/index.html").table("students")}
    assert (rows["ben"]["late"], rows["ben"]["grade"]) == ("2 days, -2.2", "3.8")
    assert (rows["anna"]["late"], rows["anna"]["grade"]) == ("", "6")


def test_submissions_that_are_gone_or_changed(top: Path) -> None:
    """A page of a submission that is gone stays, without a link; an earlier report of nobody is named."""
    assert batch(top).returncode == 0
    export(top)
    (top / "class/ben.urdf").unlink()
    (top / "pages/index.csv").write_text((top / "pages/index.csv").read_text() + "finn,finn\n")
    assert batch(top).returncode == 0
    (top / "class/emil/robot.urdf").write_text("<robot name='r'/>")
    said = export(top)
    assert "pages also has 1 report of students who are not in the gradebook: finn\n" in said
    page = ClassPageReader(top / "pages/index.html")
    (ben,) = [row for row in page.table("students") if row["key"] == "ben"]
    assert ben["status"] == "no longer in the class folder"
    assert sorted(page.links()) == ["anna.html", "cleo.html", "emil.html"]
    changed = "No picture: the submission has changed or moved since it was graded."
    pages = {key: (top / f"pages/{key}.html").read_text(encoding="utf-8") for key in ("anna", "ben", "emil")}
    assert [changed in pages[key] for key in pages] == [False, True, True]
    assert "Three views" in pages["anna"]


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        ((), "export html writes a folder of pages: name it with --output DIR"),
        (("--into", "book.db", "--output", "pages"), "export html does not take --into"),
        (("--output", "roster.csv"), "cannot write files to {top}/roster.csv: it is not a folder"),
        (("--output", "book.db"), "cannot write {top}/book.db: this would overwrite the gradebook"),
        (("--output", "pages", "--due", "soon"), "'soon' is not a date or time"),
        (("--output", "roster.csv/x"), "cannot make the folder {top}/roster.csv/x: Not a directory"),
    ],
)
def test_what_cannot_be_written_is_refused(arguments: tuple[str, ...], why: str, top: Path) -> None:
    """In one line, before any page is written."""
    places = [top / word if word in ("book.db", "pages") or "/" in word or "." in word else word for word in arguments]
    done = grader("export", "html", "--gradebook", top / "book.db", *places)
    assert refusal(done).startswith(why.format(top=top))
    assert not list(top.rglob("index.*"))


def test_no_page_is_written_into_the_class(top: Path) -> None:
    """The next run would take it for a submission; and no symlink of a student is followed."""
    assert batch(top).returncode == 0
    (top / "class/anna/out").symlink_to(top)
    why = {
        "pages": "the next run would take them for a submission; choose a folder outside of the class folder",
        "anna/out/x": f"{top}/class/anna/out is a symlink in the submission; choose a file outside of it",
    }
    for name, reason in why.items():
        done = grader("export", "html", "--gradebook", top / "book.db", "--output", top / "class" / name)
        assert refusal(done).endswith(f"{top}/class/{name}: {reason}")
    assert not list(top.rglob("index.*"))


def test_an_index_that_cannot_be_written(top: Path) -> None:
    """The pages are there, and no half of the index."""
    export(top)
    (top / "pages/index.html").unlink()
    (top / "pages/index.html").mkdir()
    why = refusal(grader("export", "html", "--gradebook", top / "book.db", "--output", top / "pages"))
    assert why == f"cannot write {top}/pages/index.html: Is a directory"
    assert not list((top / "pages").glob(".*"))


def test_a_foreign_index_is_not_replaced(top: Path) -> None:
    """The folder may be a web site."""
    (top / "pages").mkdir()
    (top / "pages/index.html").write_text("mine")
    why = refusal(grader("export", "html", "--gradebook", top / "book.db", "--output", top / "pages"))
    assert why.startswith(f"cannot write {top}/pages/index.html: it exists, and grader did not write it")
    assert refusal(batch(top, "--reports", top / "pages", "--report-format", "html")) == why
    assert contents(top / "pages") == {"index.html": b"mine"}


def test_a_gradebook_without_a_run(tmp_path: Path) -> None:
    """It is reported in a line, and no folder is made."""
    Gradebook(tmp_path / "book.db", create=True).close()
    done = grader("export", "html", "--gradebook", tmp_path / "book.db", "--output", tmp_path / "pages")
    assert refusal(done).startswith("nothing has been graded into ")
    assert not (tmp_path / "pages").exists()


def test_a_class_without_any_urdf(tmp_path: Path) -> None:
    """Everybody has a page, and the class's page says what is known."""
    for name in ("ash", "index"):
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "Task1_Step8.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    done = grader(
        "batch", tmp_path / "class", "--gradebook", tmp_path / "g.db", "--reports", tmp_path / "pages", "--report-format",
        "html", "--layout", "folders",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    page = ClassPageReader(tmp_path / "pages/index.html")
    assert {row["name"] for row in page.table("students")} == {"ash", "index"}
    assert all((tmp_path / "pages" / unquote(link)).is_file() for link in page.links())
    assert "index.html" not in page.links()
    assert not page.root.xpath("//figure")


class FailingWorkers(Executor):
    """An executor that fails whenever it works on the report of one student."""

    def __init__(self, error: Exception) -> None:
        self.error = error

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> "Future[Any]":
        """Run a function here and now."""
        future: Future[Any] = Future()
        if any(isinstance(given, list) and "ben" in dict(given) for given in arguments):
            future.set_exception(self.error)
        else:
            future.set_result(function(*arguments, **named))
        return future


@pytest.mark.parametrize(
    ("error", "why"),
    [
        (WorkerError("the process that graded it was killed"), "the process that graded it was killed"),
        (OverflowError("inf"), "the grader itself failed: OverflowError: inf"),
    ],
)
def test_a_crash_costs_one_page(error: Exception, why: str, top: Path) -> None:
    """The others have theirs, the class's page has no link to it, and standard error says why."""
    lines: list[str] = []
    progress: list[Progress] = []
    run = ReportRun(top / "book.db", top / "pages", (Format.HTML,))
    write_reports(FailingWorkers(error), run, lines.append, progress.append)
    assert [state.done for state in progress] == [0, 1, 2, 3, 4]
    assert lines == [
        f"3 reports written to {top / 'pages'}",
        f"no report for ben: {why}",
    ]
    assert sorted(ClassPageReader(top / "pages/index.html").links()) == ["anna.html", "cleo.html", "emil.html"]


def test_a_full_disk_ends_the_command(top: Path) -> None:
    """It concerns all pages: none is blamed on a student."""
    with pytest.raises(InputError, match="No space left"):
        run = ReportRun(top / "book.db", top / "pages", (Format.HTML,))
        write_reports(FailingWorkers(InputError("No space left")), run, print, print)
