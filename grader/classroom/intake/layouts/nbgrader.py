"""A course of nbgrader: `submitted/<student>/<assignment>/`, with the time of each in its `timestamp.txt`.

nbgrader writes that time as `%Y-%m-%d %H:%M:%S.%f %Z`, in UTC unless it is configured otherwise (nbgrader/exchange).
"""

from collections import defaultdict
from dataclasses import replace

from grader.classroom.intake.layouts.layout import IgnoredFiles, SubmissionList, listed
from grader.classroom.intake.listing import Children, Listing
from grader.classroom.intake.names import utc_time
from grader.classroom.students import ClassSubmission, Student
from grader.errors import InputError
from grader.text import printable_path

_SUBMITTED = "submitted"
_STAMP = "timestamp.txt"
_LONGEST_STAMP = 100  # bytes
_MAX_NAMED = 10


def find_course(listing: Listing, children: Children, start: str, top: str, rubric_id: str) -> str | None:
    """Where the students' folders are, if this is surely a course: below `submitted`, or here if this is called so."""
    if _SUBMITTED in children.folders:
        below = f"{start}{_SUBMITTED}/"
        return below if _assignments(listing, below) else None
    if top != _SUBMITTED:
        return None
    found = _assignments(listing, start)
    is_known = any(_plain(name) == _plain(rubric_id) for name in found)
    stamped = any(
        _STAMP in listing.children(f"{start}{students[0]}/{name}").files for name, students in found.items() if students
    )
    return start if is_known or stamped else None


def find_submissions(
    listing: Listing, start: str, ignored: IgnoredFiles, assignment: str, rubric_id: str
) -> SubmissionList:
    """The hand-ins for one assignment; raises InputError where it cannot be told which."""
    found = _assignments(listing, start)
    name = _chosen(found, assignment, rubric_id)
    children = listing.children(start.rstrip("/"))
    given = set(found[name])
    for student in children.folders:
        if student not in given:
            ignored.add(start + student, f"holds nothing for the assignment {printable_path(name)}")
    for file in children.files:
        ignored.add(start + file, "is not a student's folder")
    ignored.add_all((start + each, reason) for each, reason in children.refused)
    paths = {student: f"{start}{student}/{name}" for student in found[name]}
    stamps = listing.starts((f"{path}/{_STAMP}" for path in paths.values()), _LONGEST_STAMP)
    submitted = listed(
        ClassSubmission(Student(student, login=student), (path,), submitted=_time(stamps.get(f"{path}/{_STAMP}", b"")))
        for student, path in paths.items()
    )
    return replace(submitted, assignments=frozenset({f"nbgrader {printable_path(name)}"}))


def _assignments(listing: Listing, start: str) -> dict[str, list[str]]:
    """The students who have handed in something for each assignment."""
    found: dict[str, list[str]] = defaultdict(list)
    for student in sorted(listing.children(start.rstrip("/")).folders):
        for name in listing.children(start + student).folders:
            found[name].append(student)
    return found


def _chosen(found: dict[str, list[str]], assignment: str, rubric_id: str) -> str:
    named = ", ".join(printable_path(name) for name in sorted(found)[:_MAX_NAMED]) or "none"
    if assignment:
        if assignment in found:
            return assignment
        raise InputError(f"nobody has handed in the assignment {printable_path(assignment)}; there are: {named}")
    alike = [name for name in found if _plain(name) == _plain(rubric_id)]
    for names in ([name for name in found if name == rubric_id], alike, list(found)):
        if len(names) == 1:
            return names[0]
    raise InputError(f"--assignment has to say which assignment is to be graded; there are: {named}")


def _plain(name: str) -> str:
    return "".join(letter for letter in name.casefold() if letter.isalnum())


def _time(stamp: bytes) -> str:
    return utc_time(stamp.decode("utf-8", "replace"))
