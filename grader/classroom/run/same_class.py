"""Whether a class belongs into a gradebook: the grades of another class must not end up in it by mistake."""

from collections.abc import Iterable
from itertools import chain, islice
from json import dumps, loads

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.intake.intake import Intake
from grader.classroom.run.identity import Identities
from grader.errors import InputError
from grader.text import printable_path

_MAX_NAMED = 3


def check_belongs(book: Gradebook, intake: Intake, identities: Identities, rubric_id: str) -> None:
    """Raises InputError, which says what the gradebook holds, for another lab, another assignment or other students."""
    for (other,) in book.rows("SELECT rubric.id FROM run JOIN rubric ON sha256 = rubric ORDER BY run.id DESC LIMIT 1"):
        if other != rubric_id:
            raise _refusal(book, f"it was graded by the rubric {other}, not {rubric_id}")
    before = {each for (text,) in book.rows("SELECT DISTINCT assignment FROM run") for each in loads(text or "[]")}
    for kind in ("Canvas ", "nbgrader "):
        theirs, ours = ({each for each in some if each.startswith(kind)} for some in (before, intake.assignments))
        if theirs and ours and theirs.isdisjoint(ours):
            raise _refusal(book, f"it was graded for {_some(theirs)}, not {_some(ours)}")
    for name in ("canvas", "moodle"):
        theirs, ours = (
            {getattr(each, name) for each in some} - {""} for some in (book.students(), intake.named_students())
        )
        if theirs and ours and theirs.isdisjoint(ours):
            raise _refusal(book, f"{name.title()} gives the students of this class other numbers")
    if next(book.students(), None) is not None and not _has_common_student(book, intake, identities):
        raise _refusal(book, "no student of this class is in it")


def assignments_text(assignments: Iterable[str]) -> str:
    """Assignments as a gradebook keeps them with a run; empty where none is known."""
    names = sorted(assignments)
    return dumps(names) if names else ""


def _has_common_student(book: Gradebook, intake: Intake, identities: Identities) -> bool:
    keys = chain(intake.keys(), (student.key for student in intake.contested))
    if any(next(book.rows("SELECT 1 FROM student WHERE key = ?", key), None) for key in keys):
        return True
    return any(identities.of(hand_in) for hand_in in intake.submissions())


def _some(names: set[str]) -> str:
    return ", ".join(sorted(names)[:_MAX_NAMED]) + (", ..." if len(names) > _MAX_NAMED else "")


def _refusal(book: Gradebook, reason: str) -> InputError:
    shown = printable_path(book.path)
    students = list(islice(book.students(), _MAX_NAMED + 1))
    names = ", ".join(each.key for each in students[:_MAX_NAMED]) + (", ..." if len(students) > _MAX_NAMED else "")
    held = f" (it holds {names})" if students else ""
    return InputError(f"{shown} is the gradebook of another class: {reason}{held}; name another file, or use --add")
