"""The commands that get faults, and the files that they find."""

import shutil
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import NamedTuple

from grader.classroom.review.review_session import CONFIRMED
from tests.classroom.gradebooks import batch, grader, make_class, write_submission
from tests.command_line import Done, run_process, run_with_input
from tests.edits_rubric import copy_with_edits
from tests.review_server import running
from tests.samples import ROOT

_CANVAS = """\
Student,ID,SIS User ID,SIS Login ID,Section,A small lab (900)
    Points Possible,,,,,11
"Ek, Anna",101,,ae1,S,
"Oh, Ben",102,,bo2,S,
"Fi, Dora",104,,df4,S,
"""
_MOODLE = """\
Identifier,Full name,Email address,Status,Grade,Maximum grade,Grade can be changed,Last modified (submission),\
Last modified (grade),Feedback comments
Participant 501,Anna Ek,anna@example.org,Submitted for grading,,11.00,Yes,-,-,
Participant 503,Cleo Ray,cleo@example.org,Submitted for grading,,11.00,Yes,-,-,
"""
_MARKS = (
    "student,criterion,points,comment\nanna,essay,3,good\nemil,essay,1,short\nben,total,5,late\n"
)

Fault = AbstractContextManager[object]  # armed while the command runs


class Scenario(NamedTuple):
    """A command over the files of `prepare`. `is_process` means that it runs as a user starts it, with its workers.

    Without `words`, `act` does the work. `goes_on` says that it warns of a mark that is not saved, and ends as usual.
    """

    name: str
    words: Sequence[str] = ()
    stdin: bytes = b""
    is_process: bool = False
    act: Callable[[Path, Fault], Done] | None = None
    goes_on: bool = False

    def run(self, top: Path, fault: Fault) -> Done:
        """Run the command in the folder with the files."""
        if self.act is not None:
            return self.act(top, fault)
        if self.is_process:
            with fault:
                return run_process(self.words, self.stdin, folder=top)
        return run_with_input(self.words, self.stdin, folder=top, inside=fault)


def prepare(top: Path) -> None:
    """Make a class, its gradebook, and the files that commands read."""
    make_class(top)
    shutil.copytree(
        ROOT / "submissions/lab6/reference",
        top / "lab6",
        ignore=shutil.ignore_patterns("expected.toml"),
    )
    (urdf,) = (top / "lab6").rglob("*.urdf")
    (top / "robot.urdf").write_text(urdf.read_text().replace("0.15 0 0.225", "0.15 0 0.2"))
    write_submission(top / "zipped" / "finn")
    shutil.make_archive(str(top / "class/finn"), "zip", top / "zipped/finn")
    shutil.rmtree(top / "zipped")
    assert batch(top).returncode == 0
    (top / "canvas.csv").write_text(_CANVAS)
    (top / "moodle.csv").write_text(_MOODLE)
    (top / "marks.csv").write_text(_MARKS)
    (top / "report.json").write_text("old")
    copy_with_edits(top / "edits")
    assert (
        grader(
            "mark", "anna", "picture", "1", "--gradebook", top / "book", "--by", "Kim"
        ).returncode
        == 0
    )


def _mark_on_the_page(top: Path, fault: Fault) -> Done:
    """Mark the first item on the page of `review`; the answer is the output, and an error the exit code 2."""
    with running(top / "book") as review:
        sent = {"do": "mark", "points": "1", "comment": "seen", **review.seen("1")}
        with fault:
            answer = review.post("1", sent)
            if b'"newer"' in answer.body:  # an earlier mark is replaced
                answer = review.post("1", {**sent, "shown": sent["shown"] + CONFIRMED})
        is_saved = b'"go"' in answer.body
        error = "" if is_saved else f"grader: {answer.status} {answer.body[:200]!r}\n"
        return Done([], 0 if is_saved else 2, answer.body if is_saved else b"", error.encode())


_BOOK = ("--gradebook", "book")
_BATCH = ("batch", "class", "--rubric", "small.toml", "--roster", "roster.csv", "--jobs", "2")
_FEEDBACK = ("--feedback", "feedback.zip")
_OUTPUT = ("--reports", "reports")

SCENARIOS = (
    Scenario(
        "grade", ("grade", "lab6", "--save", "json=report.json", "--save", "html=report.html")
    ),
    Scenario(
        "grade-fix", ("grade", "robot.urdf", "--rubric", "edits/rubric.toml", "--fix", "fixed.urdf")
    ),
    Scenario("batch", (*_BATCH, "--gradebook", "new", *_OUTPUT)),
    Scenario("batch-again", (*_BATCH, *_BOOK, "--force")),
    Scenario("mark", ("mark", "anna", "essay", "3.5", "--comment", "good", *_BOOK)),
    Scenario("mark-import", ("mark", "--import", "marks.csv", *_BOOK)),
    Scenario("mark-new", ("mark", "anna", "deadline", "2026-11-25", "--by", "Ada", *_BOOK)),
    Scenario("review", act=_mark_on_the_page),
    Scenario("review-sheet", ("review", *_BOOK, "--sheet", "sheet.csv")),
    Scenario("export-csv", ("export", "csv", *_BOOK, "--output", "grades.csv")),
    Scenario(
        "export-into",
        ("export", "canvas", *_BOOK, "--into", "canvas.csv", "--output", "upload.csv"),
    ),
    Scenario("export-html", ("export", "html", *_BOOK, "--output", "pages")),
    Scenario(
        "export-feedback",
        ("export", "moodle", *_BOOK, "--into", "moodle.csv", "--output", "filled.csv", *_FEEDBACK),
    ),
    Scenario("batch-workers", (*_BATCH, "--gradebook", "new", *_OUTPUT), is_process=True),
    Scenario("pages-workers", ("export", "html", *_BOOK, "--output", "pages"), is_process=True),
)
IN_PROCESSES = ("spawn", "send")  # the kinds that concern these scenarios only
