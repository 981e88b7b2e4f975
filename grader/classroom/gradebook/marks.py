"""Manual marks of criteria and of whole submissions, stored in addition to the automatic points."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from decimal import Decimal
from typing import Any, Literal, NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import points_from_units, storable, units_of
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.errors import InputError
from grader.grading.criterion import TOTAL

TAKE_BACK = "-"  # in place of points: the automatic result counts again
EXTENSION = "new deadline"  # in place of a criterion's id, which is one word: its comment is the student's own deadline

Kind = Literal["points", "withdrawn", "comment", "excused", "second"]


class Entry(NamedTuple):
    """An entry of a grader: points and a comment, a comment alone, a withdrawn mark, or an excuse.

    A comment alone keeps the points that count. A second opinion has points that never count, or none if it is
    withdrawn.
    """

    kind: Kind
    points: Decimal | None = None
    comment: str = ""


WITHDRAWN = Entry("withdrawn")
WITHDRAWN_SECOND = Entry("second")


class Mark(NamedTuple):
    """An entry in the gradebook.

    `by` is the name of the grader, empty without `--by`. `at` is the time, and `result` the result that it was given
    for.
    """

    entry: Entry
    by: str
    at: str = ""
    result: int | None = None
    id: int = 0

    @property
    def points(self) -> Decimal | None:
        """The points, if it gives any."""
        return self.entry.points

    @property
    def comment(self) -> str:
        """The comment."""
        return self.entry.comment


class AddedMark(NamedTuple):
    """The id of a new mark, and the newest mark before it, if there is one."""

    id: int
    before: Mark | None


class NewerMarkError(Exception):
    """Somebody has marked the criterion since it was shown."""

    def __init__(self, mark: Mark) -> None:
        super().__init__()
        self.mark = mark


def add_mark(
    book: Gradebook, grade: StudentGrade, criterion: str, entry: Entry, by: str, *, shown: int | None = None
) -> AddedMark:
    """Add a mark for a criterion, or for the whole submission (TOTAL), to a student's newest result.

    `by` is the name that reports show. `shown` is the id of the newest mark that the person has seen, 0 for none. If
    there is a newer mark, nothing is written and NewerMarkError holds it. A comment on a mark keeps its points, their
    grader, and the result that they were given for; the audit names who commented. Raises InputError for a criterion of
    a student without a submission.
    """
    refuse_unsubmitted(grade, criterion)
    with writing(book):
        before = _newest_if_shown(book, grade, criterion, entry, by, shown)
        mark = Mark(entry, by, result=grade.result)
        if entry.kind == "comment" and before is not None and before.entry.kind in ("points", "excused"):
            mark = before._replace(entry=before.entry._replace(comment=entry.comment), at="")
        return AddedMark(insert_mark(book, grade.id, criterion, mark, by or account()), before)


def refuse_unsubmitted(grade: StudentGrade, criterion: str) -> None:
    """Raise InputError for a criterion of a student without a submission."""
    if grade.result is None and criterion not in (TOTAL, EXTENSION):
        key = grade.student.key
        raise InputError(
            f"{key} has submitted nothing that could be marked; `grader mark {key} {TOTAL} POINTS` gives a final mark"
        )


def restore_mark(
    book: Gradebook, grade: StudentGrade, criterion: str, mark: Mark | Entry, by: str, *, shown: int
) -> AddedMark:
    """Add an entry that repeats an earlier mark, with its name and result, or an entry that withdraws the newest one.

    The audit names the person who restores it. Raises NewerMarkError like `add_mark`.
    """
    mark = Mark(mark, by, result=grade.result) if isinstance(mark, Entry) else mark._replace(at="")
    with writing(book):
        before = _newest_if_shown(book, grade, criterion, mark.entry, by, shown)
        return AddedMark(insert_mark(book, grade.id, criterion, mark, by or account()), before)


def undo_mark(book: Gradebook, grade: StudentGrade, criterion: str, by: str) -> Mark:
    """Undo the newest mark, and return it: add an entry that repeats the mark before it, or withdraws the only one.

    Raises InputError if there is no mark.
    """
    marks = marks_of(book, grade.id, criterion, 2)
    if not marks:
        raise InputError(f"there is no mark of {criterion} to undo for {grade.student.key}")
    restore_mark(book, grade, criterion, marks[1] if len(marks) > 1 else WITHDRAWN, by, shown=marks[0].id)
    return marks[0]


@contextmanager
def writing(book: Gradebook) -> Iterator[None]:
    """Commit what is written inside, so that it survives a power failure; inside of another one, with that."""
    if book.connection.in_transaction:
        yield
        return
    with book.input_errors():
        book.connection.execute("PRAGMA synchronous = FULL")
    with book.transaction():
        yield


def _newest_if_shown(
    book: Gradebook, grade: StudentGrade, criterion: str, entry: Entry, by: str, shown: int | None
) -> Mark | None:
    """Return the newest mark, or for a second opinion this grader's newest; raises NewerMarkError if not shown."""
    before = (
        newest_second(book, grade, criterion, by) if entry.kind == "second" else newest_mark(book, grade.id, criterion)
    )
    if before is not None and shown is not None and before.id > shown:
        raise NewerMarkError(before)
    return before


def insert_mark(book: Gradebook, student: int, criterion: str, mark: Mark, author: str) -> int:
    """Add a row to the table of marks, without a transaction; return its id. Without a time it is made now."""
    entry = mark.entry
    row = {
        "student": student,
        "criterion": criterion,
        "kind": entry.kind,
        "points": None if entry.points is None else units_of(entry.points),
        "comment": storable(entry.comment),
        "author": storable(author),
        "grader_name": storable(mark.by),
        "at": mark.at or datetime.now(UTC).isoformat(timespec="seconds"),
        "result": mark.result,
    }
    return book.insert("mark", row)


def newest_mark(book: Gradebook, student: int, criterion: str) -> Mark | None:
    """Return the newest mark of a student's criterion, even one that withdraws another, but no second opinion."""
    return next(iter(marks_of(book, student, criterion, 1)), None)


def newest_second(book: Gradebook, grade: StudentGrade, criterion: str, by: str) -> Mark | None:
    """Return the newest second opinion of a grader on a criterion of the student's newest submission."""
    query = "SELECT * FROM second_mark WHERE student = ? AND criterion = ? AND grader_name = ? AND digest = ?"
    found = book.records(query, grade.id, criterion, storable(by), grade.files.digest)
    return next(map(mark_of, found), None)


def marks_of(book: Gradebook, student: int, criterion: str, most: int) -> list[Mark]:
    """Return the newest marks of a student's criterion, the newest first, without second opinions."""
    query = "SELECT * FROM mark WHERE student = ? AND criterion = ? AND kind <> 'second' ORDER BY id DESC LIMIT ?"
    return list(map(mark_of, book.records(query, student, criterion, most)))


def current_marks(book: Gradebook, student: int) -> dict[str, Mark]:
    """Return the marks of a student that count, by criterion; that of the whole submission is named TOTAL."""
    rows = book.records("SELECT * FROM current_mark WHERE student = ?", student)
    return {row["criterion"]: mark_of(row) for row in rows}


def mark_of(row: Mapping[str, Any]) -> Mark:
    """Return a row of the table of marks."""
    points = None if row["points"] is None else points_from_units(row["points"])
    entry = Entry(row["kind"], points, row["comment"])
    return Mark(entry, row["grader_name"], row["at"], row["result"], row["id"])


def account() -> str:
    """Return the name of the user account, or an empty string."""
    import getpass

    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):  # as in a container without accounts
        return ""
