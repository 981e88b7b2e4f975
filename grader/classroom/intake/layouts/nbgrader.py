"""The nbgrader layout: `submitted/<student>/<assignment>/`, with the time of each submission in its `timestamp.txt`.

nbgrader writes that time as `%Y-%m-%d %H:%M:%S.%f %Z`, in UTC unless it is configured otherwise (nbgrader/exchange).
"""

from collections import defaultdict
from collections.abc import Iterable
from itertools import starmap

from grader.classroom.intake.layouts.layout import ClassFolder, Submissions
from grader.classroom.intake.names import utc_time
from grader.classroom.listing import ClassListing
from grader.classroom.students import ClassSubmission, Student
from grader.errors import InputError
from grader.names import folded
from grader.text import enumerated, printable_path

_SUBMITTED = "submitted"
_TIMESTAMP = "timestamp.txt"
_MAX_TIMESTAMP = 100  # bytes
_MAX_NAMED = 10


def find_course(folder: ClassFolder) -> str | None:
    """Return where a course has the students' folders: below `submitted`, or here if that is the name; else None."""
    listing, start = folder.listing, folder.start
    if _SUBMITTED in folder.children.folders:
        below = f"{start}{_SUBMITTED}/"
        return below if _assignments(listing, below) else None
    return start if folder.name == _SUBMITTED and _has_evidence(folder, start) else None


def is_course(folder: ClassFolder) -> bool:
    """Return whether this is certainly a course, and not a folder of a student that contains one named `submitted`."""
    course = find_course(folder)
    return course is not None and _has_evidence(folder, course)


def count_students(folder: ClassFolder) -> int:
    """Return how many students have a folder in a course."""
    course = find_course(folder)
    return 0 if course is None else len(folder.listing.children(course.rstrip("/")).folders)


def _has_evidence(folder: ClassFolder, start: str) -> bool:
    """Return whether there is a submission with a timestamp, or for the lab."""
    found = _assignments(folder.listing, start)
    has_lab = any(folded(name) == folded(folder.rubric_id) for name in found)
    return has_lab or any(
        _TIMESTAMP in folder.listing.children(f"{start}{students[0]}/{name}").files for name, students in found.items()
    )


def find_submissions(folder: ClassFolder) -> Submissions:
    """Return the submissions for one assignment; raises InputError if it is not clear which one."""
    listing, ignored, course = folder.listing, folder.ignored, find_course(folder)
    start = folder.start if course is None else course
    found = _assignments(listing, start)
    name = _choose(found, folder.assignment, folder.rubric_id)
    children = listing.children(start.rstrip("/"))
    submitters = set(found[name])
    for student in children.folders:
        if student not in submitters:
            ignored.add(start + student, f"has no submission for the assignment {printable_path(name)}")
    for file in children.files:
        ignored.add(start + file, "is not a student's folder")
    ignored.add_all(start, children.refused)
    paths = {student: f"{start}{student}/{name}" for student in found[name]}

    def submission(key: str, path: str) -> ClassSubmission:
        time = utc_time(listing.start(f"{path}/{_TIMESTAMP}", _MAX_TIMESTAMP).decode("utf-8", "replace"))
        return ClassSubmission(Student(key, login=key), (path,), submitted=time)

    return Submissions(
        starmap(submission, paths.items()),
        assignments=frozenset({f"nbgrader {printable_path(name)}"}),
        notes=_choice(name, found) if len(found) > 1 and not folder.assignment else (),
    )


def _assignments(listing: ClassListing, start: str) -> dict[str, list[str]]:
    """Return the students with a submission for each assignment."""
    found: dict[str, list[str]] = defaultdict(list)
    for student in sorted(listing.children(start.rstrip("/")).folders):
        for name in listing.children(start + student).folders:
            found[name].append(student)
    return found


def _choice(name: str, found: Iterable[str]) -> tuple[str]:
    others = enumerated([printable_path(other) for other in sorted(found) if other != name], _MAX_NAMED)
    return (f"the assignment {printable_path(name)} is graded; to grade {others}, add --assignment",)


def _choose(found: dict[str, list[str]], assignment: str, rubric_id: str) -> str:
    named = ", ".join(printable_path(name) for name in sorted(found)[:_MAX_NAMED]) or "none"
    if assignment:
        if assignment in found:
            return assignment
        raise InputError(f"there is no submission for the assignment {printable_path(assignment)}; there are: {named}")
    similar = [name for name in found if folded(name) == folded(rubric_id)]
    for names in ([name for name in found if name == rubric_id], similar, list(found)):
        if len(names) == 1:
            return names[0]
    raise InputError(f"name the assignment to grade with --assignment; there are: {named}")
