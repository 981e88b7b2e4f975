"""The proven hints in a gradebook: which submissions need them, which of these have the same, and which are stored."""

import json
import zlib
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from grader import __version__
from grader.classroom.gradebook.gradebook import Gradebook
from grader.grading.graded_submission import GradedSubmission
from grader.grading.record import submission_of
from grader.grading.rubric import Rubric

_COLUMNS = "id, key, result, digest, urdf, robot, statuses, source, files, is_gone, marks"
_QUERY = f"""
SELECT {", ".join(f"grade.{name}" for name in _COLUMNS.split(", "))}, hint.hints, result.record FROM grade
JOIN result ON result.id = grade.result
LEFT JOIN hint ON hint.result = grade.result
WHERE grade.verdict = 'graded' AND grade.rubric = ? AND grade.version = ? ORDER BY grade.is_gone, grade.key
"""
_RUBRICS = "SELECT DISTINCT rubric FROM grade WHERE result IS NOT NULL AND version = ? ORDER BY rubric"
_ROBOT = ("urdf", "robot")  # what a check examines that depends on the URDF alone
_FAILED = "f"


class Mistaken(NamedTuple):
    """A submission that lost points. `hints` are those that are stored, as JSON; None if they have not been searched.

    Submissions with the same `content` have the same hints. Those with the same `robot` and the same failed criteria need the same
    changes, at other places of their texts.
    """

    student: int
    key: str
    result: int
    digest: str
    statuses: str
    root: str
    paths: tuple[str, ...]
    names: tuple[str, ...]
    is_gone: bool
    has_marks: bool
    hints: str | None
    submission: GradedSubmission
    content: tuple[str, ...]
    robot: tuple[str, ...]


def mistaken(book: Gradebook, rubric: Rubric) -> list[Mistaken]:
    """Return the newest submissions that this grader graded with a rubric, and that lost points in the URDF or the package.

    Those that are no longer in the class come last; otherwise they are in the order of the keys.
    """
    from_files = {part.id for part in rubric.parts if part.needs == "files"}
    criteria = [criterion for criterion in rubric.criteria if criterion.part not in from_files]
    of_robot = [row.position for row in criteria if row.check.subject in _ROBOT]
    of_package = [row.position for row in criteria if row.check.subject not in _ROBOT]
    found = []
    for row in book.rows(_QUERY, rubric.sha256, __version__):
        student, key, result, digest, urdf, robot, statuses, root, files, is_gone, marks, hints, record = row
        submission = submission_of(zlib.decompress(record).decode())
        robot_statuses = "".join(statuses[position] for position in of_robot)
        is_package_wrong = not submission.is_single and any(statuses[position] == _FAILED for position in of_package)
        if not (is_package_wrong or _FAILED in robot_statuses):
            continue
        paths, names, *_ = json.loads(files)
        content = ("file", urdf, statuses) if submission.is_single and urdf else ("digest", digest, statuses)
        same_robot = content if is_package_wrong or not robot else ("robot", robot, robot_statuses)
        place = root, tuple(paths), tuple(names), bool(is_gone), bool(marks)
        found.append(Mistaken(student, key, result, digest, statuses, *place, hints, submission, content, same_robot))
    return found


def rubrics_of(book: Gradebook) -> Iterator[Rubric]:
    """Yield the rubrics with which this grader graded the newest submissions."""
    for (sha256,) in list(book.rows(_RUBRICS, __version__)):
        yield book.rubric(sha256)


def save_hints(book: Gradebook, results: Iterable[int], hints: str) -> None:
    """Store the hints of results that have the same."""
    with book.transaction():
        rows = ((result, hints) for result in results)
        book.connection.executemany("INSERT OR REPLACE INTO hint VALUES (?, ?)", rows)


def remove_hints(book: Gradebook) -> None:
    """Remove all stored hints: they will be searched again."""
    with book.transaction():
        book.connection.execute("DELETE FROM hint")


def remove_old_hints(book: Gradebook) -> None:
    """Remove the hints of results that are not current any more, or that another version of the grader found."""
    current = "SELECT result FROM grade WHERE result IS NOT NULL AND version = ?"
    with book.transaction():
        book.connection.execute(f"DELETE FROM hint WHERE result NOT IN ({current})", (__version__,))
