"""The proven hints in a gradebook: which submissions need them, which of these have the same, and which are stored."""

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from grader import __version__
from grader.classroom.gradebook.gradebook import Gradebook
from grader.grading.graded_submission import GradedSubmission
from grader.grading.record import graded_submission_from
from grader.grading.rubric import Rubric

_QUERY = """
SELECT grade.id AS student, key, grade.result, digest, urdf, robot, parts, source, files, is_gone, hint.hints
FROM grade LEFT JOIN hint ON hint.result = grade.result
WHERE verdict = 'graded' AND rubric = ? AND version = ? ORDER BY is_gone, key
"""
_RUBRICS = "SELECT DISTINCT rubric FROM grade WHERE result IS NOT NULL AND version = ? ORDER BY rubric"
_ROBOT = ("urdf", "robot")  # what a check examines that depends on the URDF alone


class Mistaken(NamedTuple):
    """A submission that lost points. `hints` are those that are stored, as JSON; None if they have not been searched.

    Submissions with the same `content` have the same hints. Those with the same `robot` and the same failed criteria
    need the same changes, at other places of their texts.
    """

    student: int
    key: str
    result: int
    digest: str
    parts: tuple[str, ...]
    root: str
    paths: tuple[str, ...]
    names: tuple[str, ...]
    is_gone: bool
    hints: str | None
    submission: GradedSubmission
    content: tuple[str, ...]
    robot: tuple[str, ...]


def mistaken(book: Gradebook, rubric: Rubric) -> list[Mistaken]:
    """Return the newest submissions graded with a rubric by this grader that lost points in the URDF or the package.

    Those that are no longer in the class come last; otherwise they are in the order of the keys.
    """
    of_robot, of_package = _positions(rubric)
    found = []
    for row in list(book.records(_QUERY, rubric.sha256, __version__)):
        statuses = {position: outcome.status for position, outcome in book.outcomes(row["result"]).items()}
        failed = {position for position, status in statuses.items() if status == "failed"}
        if failed.isdisjoint(of_robot) and failed.isdisjoint(of_package):
            continue
        submission = graded_submission_from(book.record(row["result"]))
        is_package_wrong = not submission.is_single and not failed.isdisjoint(of_package)
        if is_package_wrong or not failed.isdisjoint(of_robot):
            files = ("file", row["urdf"]) if submission.is_single and row["urdf"] else ("digest", row["digest"])
            content = (*files, row["parts"], str(statuses))
            of_robots = {position: statuses.get(position) for position in of_robot}
            robot = content if is_package_wrong or not row["robot"] else ("robot", row["robot"], str(of_robots))
            found.append(_mistaken(row, submission, content, robot))
    return found


def _positions(rubric: Rubric) -> tuple[list[int], list[int]]:
    """Return the criteria of the robot and those of the package, without those of other files."""
    from_files = {part.id for part in rubric.parts if part.needs == "files"}
    criteria = [criterion for criterion in rubric.criteria if criterion.part not in from_files]
    of_robot = [row.position for row in criteria if row.check.subject in _ROBOT]
    return of_robot, [row.position for row in criteria if row.position not in of_robot]


def _mistaken(
    row: Mapping[str, Any], submission: GradedSubmission, content: tuple[str, ...], robot: tuple[str, ...]
) -> Mistaken:
    paths, names, *_ = json.loads(row["files"])
    return Mistaken(
        student=row["student"],
        key=row["key"],
        result=row["result"],
        digest=row["digest"],
        parts=tuple(row["parts"].split()),
        root=row["source"],
        paths=tuple(paths),
        names=tuple(names),
        is_gone=bool(row["is_gone"]),
        hints=row["hints"],
        submission=submission,
        content=content,
        robot=robot,
    )


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
