"""Check that a class belongs to a gradebook, so that the grades of another class do not end up in it by mistake."""

from collections.abc import Iterable
from itertools import chain, islice
from json import dumps, loads

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.intake.intake import Intake
from grader.classroom.run.stored_students import Identities
from grader.errors import InputError

_MAX_NAMED = 3


def check_same_class(book: Gradebook, intake: Intake, identities: Identities, rubric_id: str) -> None:
    """Raise InputError, naming the content of the gradebook, if it is for another lab, another assignment or other students."""
    for (other,) in book.rows("SELECT rubric.id FROM run JOIN rubric ON sha256 = rubric ORDER BY run.id DESC LIMIT 1"):
        if other != rubric_id:
            raise _refusal(book, f"it was graded by the rubric {other}, not {rubric_id}")
    stored = {name for (text,) in book.rows("SELECT DISTINCT assignment FROM run") for name in loads(text or "[]")}
    for lms in ("Canvas ", "nbgrader "):
        theirs, ours = ({name for name in names if name.startswith(lms)} for names in (stored, intake.assignments))
        if theirs and ours and theirs.isdisjoint(ours):
            raise _refusal(book, f"it was graded for {_first(sorted(theirs))}, not {_first(sorted(ours))}")
    for lms in ("canvas", "moodle"):
        groups = (book.students(), intake.named_students())
        theirs, ours = ({getattr(student, lms) for student in students} - {""} for students in groups)
        if theirs and ours and theirs.isdisjoint(ours):
            raise _refusal(book, f"the {lms.title()} ids of its students are not those of this class")
    if next(book.students(), None) is not None and not _has_common_student(book, intake, identities):
        raise _refusal(book, "no student of this class is in it")


def assignments_text(assignments: Iterable[str]) -> str:
    """Return assignments as a gradebook stores them with a run; empty if none is known."""
    names = sorted(assignments)
    return dumps(names) if names else ""


def _has_common_student(book: Gradebook, intake: Intake, identities: Identities) -> bool:
    keys = chain(intake.keys(), (student.key for student in intake.contested))
    if any(book.first("SELECT 1 FROM student WHERE key = ?", key) for key in keys):
        return True
    return any(identities.of(submission) for submission in intake.submissions())


def _first(names: list[str]) -> str:
    return ", ".join(names[:_MAX_NAMED]) + (", ..." if len(names) > _MAX_NAMED else "")


def _refusal(book: Gradebook, reason: str) -> InputError:
    keys = [student.key for student in islice(book.students(), _MAX_NAMED + 1)]
    held = f" (it contains {_first(keys)})" if keys else ""
    return InputError(
        f"{book.shown} is the gradebook of another class: {reason}{held}; name another file, or use --add"
    )
