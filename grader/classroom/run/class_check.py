"""Check that a class belongs to a gradebook, so that the grades of another class do not end up in it by mistake."""

from collections.abc import Iterable
from itertools import chain, islice
from json import dumps, loads

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.intake.intake import Intake
from grader.classroom.run.stored_students import Identities
from grader.classroom.students import Student
from grader.errors import InputError
from grader.text import counted

_MAX_NAMED = 3
_MIN_MATCHED = 10  # one in so many submissions


def check_same_class(book: Gradebook, intake: Intake, identities: Identities, rubric_id: str) -> None:
    """Raise InputError, naming the gradebook's content, if it is for another lab, assignment or other students."""
    for (other,) in book.rows("SELECT rubric.id FROM run JOIN rubric ON sha256 = rubric ORDER BY run.id DESC LIMIT 1"):
        if other != rubric_id:
            raise _refusal(book, f"it was graded by the rubric {other}, not {rubric_id}")
    stored = {name for (text,) in book.rows("SELECT DISTINCT assignment FROM run") for name in loads(text or "[]")}
    for lms in ("Canvas ", "nbgrader "):
        theirs, ours = ({name for name in names if name.startswith(lms)} for names in (stored, intake.assignments))
        if theirs and ours and theirs.isdisjoint(ours):
            raise _refusal(book, f"it was graded for {_first(sorted(theirs))}, not {_first(sorted(ours))}")
    _check_ids(book, intake)
    if next(book.students(), None) is not None and not _has_common_student(book, intake, identities):
        raise _refusal(book, "no student of this class is in it")


def _check_ids(book: Gradebook, intake: Intake) -> None:
    """Raise InputError if the students of the gradebook have LMS ids, and none of these is in the class."""
    known, named = _numbers(book.students()), _numbers(intake.named_students())
    if known and named and known.isdisjoint(named):
        named |= _numbers(submission.student for submission in intake.submissions())  # with those of the roster
        if known.isdisjoint(named):
            names = " and ".join(sorted({lms.title() for lms, _ in known}))
            raise _refusal(book, f"the {names} ids of its students are not those of this class")


def check_roster(intake: Intake) -> None:
    """Raise InputError if the roster matches fewer than one in ten submissions."""
    total = intake.matched + len(intake.unmatched) - intake.ambiguous
    if intake.roster is not None and intake.matched * _MIN_MATCHED < total:
        raise InputError(
            f"the roster matches {intake.matched} of {counted(total, 'submission')}: is this the roster of this class?"
            " Name another one, or use --add"
        )


def _numbers(students: Iterable[Student]) -> set[tuple[str, str]]:
    """Return the LMS ids of students: an id of one LMS never equals one of another."""
    return {(lms, number) for student in students for lms in ("canvas", "moodle") if (number := getattr(student, lms))}


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
