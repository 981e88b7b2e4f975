"""The proven hints in a gradebook: which submissions need them, which are stored, and the edits that many need."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from decimal import Decimal
from pathlib import PurePosixPath
from typing import Literal, NamedTuple

from grader import __version__
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.graded_students import manual_units
from grader.classroom.gradebook.result import units_of
from grader.classroom.gradebook.submission_files import SubmissionFiles
from grader.grading.graded_submission import GradedSubmission
from grader.grading.hints.record import hints_from_record, own_edits
from grader.grading.record import graded_submission_from
from grader.grading.report import Hint
from grader.grading.rubric import Rubric
from grader.source import Edit, Edits

_MAX_FIXES = 20
_QUERY = """
SELECT grade.id AS student, grade.result, urdf, robot, parts, is_gone, hint.hints,
    key, digest, source, files, fingerprint, max_size
FROM grade LEFT JOIN hint ON hint.result = grade.result
WHERE verdict = 'graded' AND rubric = ? AND version = ? ORDER BY is_gone, key
"""
_RUBRICS = "SELECT DISTINCT rubric FROM grade WHERE result IS NOT NULL AND version = ? ORDER BY rubric"
_ROBOT = ("urdf", "robot")  # what a check examines that depends on the URDF alone


class HintKey(NamedTuple):
    """What submissions with the same hints have in common: the hash of a file, all files or a robot, and the statuses.

    Such as ("file", "9b71...", "{3: 'failed', 7: 'skipped'}", "task1 task2").
    """

    kind: Literal["file", "digest", "robot"]
    sha256: str
    statuses: str
    parts: str = ""


class LossySubmission(NamedTuple):
    """A submission that lost points. `hints` are those that are stored, as JSON; None if they have not been searched.

    Submissions with the same `content` have the same hints. Those with the same `robot` and the same failed criteria
    need the same changes, at other places of their texts.
    """

    student: int
    result: int
    files: SubmissionFiles
    parts: tuple[str, ...]
    is_gone: bool
    hints: str | None
    submission: GradedSubmission
    content: HintKey
    robot: HintKey


def lossy_submissions(book: Gradebook, rubric: Rubric) -> list[LossySubmission]:
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
            content = HintKey("digest", row["digest"], str(statuses), row["parts"])
            if submission.is_single and row["urdf"]:
                content = content._replace(kind="file", sha256=row["urdf"])
            of_robots = str({position: statuses.get(position) for position in of_robot})
            robot = content if is_package_wrong or not row["robot"] else HintKey("robot", row["robot"], of_robots)
            parts, is_gone = tuple(row["parts"].split()), bool(row["is_gone"])
            known = row["student"], row["result"], SubmissionFiles.of(row), parts, is_gone, row["hints"]
            found.append(LossySubmission(*known, submission, content, robot))
    return found


def _positions(rubric: Rubric) -> tuple[list[int], list[int]]:
    """Return the criteria of the robot and those of the package, without those of other files."""
    from_files = {part.id for part in rubric.parts if part.needs == "files"}
    criteria = [criterion for criterion in rubric.criteria if criterion.part not in from_files]
    of_robot = [row.position for row in criteria if row.check.subject in _ROBOT]
    return of_robot, [row.position for row in criteria if row.position not in of_robot]


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


@dataclass(frozen=True, slots=True)
class CommonFix:
    """A change that several students need; `students` are their keys.

    `criteria` that pass and `points` gained are those of most students. `example` contains the edits of one student,
    without file names.
    """

    action: str
    students: tuple[str, ...]
    criteria: tuple[str, ...]
    points: Decimal
    example: Edits

    @property
    def count(self) -> int:
        """The number of students."""
        return len(self.students)


def common_fixes(book: Gradebook, rubric: Rubric) -> tuple[CommonFix, ...]:
    """Return the changes that most students need, the most frequent first, as far as hints have been searched."""
    needed: dict[str, dict[str, tuple[str, ...]]] = {}  # what each student gains by an action
    examples: dict[tuple[str, tuple[str, ...]], tuple[LossySubmission, Hint, tuple[Hint, ...]]] = {}
    marks = manual_units(book)
    for submission, example, hints in _with_stored_hints(book, rubric):
        given = {row.id for row in rubric.criteria if marks[submission.student].get(row.id) == units_of(row.points)}
        for hint in hints:
            action, gained = hint.action, tuple(hint.gains)
            if action and not given.issuperset(gained):
                needed.setdefault(action, {}).setdefault(submission.files.key, gained)
                examples.setdefault((action, gained), (example, hint, hints))
    fixes = []
    for action, gains in needed.items():
        kinds = Counter(gains.values())
        gained = min(kinds, key=lambda names: (-kinds[names], names))
        example, hint, hints = examples[action, gained]
        edits = tuple(_nameless(edit, example, rubric) for edit in own_edits(hint, hints))
        fixes.append(CommonFix(action, tuple(gains), gained, sum(hint.gains.values(), Decimal(0)), edits))
    return tuple(sorted(fixes, key=lambda fix: (-fix.count, -fix.points, fix.action))[:_MAX_FIXES])


def _with_stored_hints(
    book: Gradebook, rubric: Rubric
) -> Iterator[tuple[LossySubmission, LossySubmission, tuple[Hint, ...]]]:
    """Yield submissions, each with the first that has the same robot and the same failures, and with its hints."""
    submissions = lossy_submissions(book, rubric)
    first = {one.robot: one for one in reversed(submissions) if one.hints is not None}
    hints = {robot: hints_from_record(one.hints) for robot, one in first.items() if one.hints is not None}
    for submission in submissions:
        if submission.robot in first:
            yield submission, first[submission.robot], hints[submission.robot]


def _nameless(edit: Edit, example: LossySubmission, rubric: Rubric) -> Edit:
    """Return an edit with the rubric's path of the URDF, or one in the package: folders may have students' names."""
    if not edit.path:
        return edit._replace(path=rubric.urdf)
    package = example.submission.package
    folder = f"{package.folder}/" if package is not None and package.folder else ""
    is_inside = package is not None and edit.path.startswith(folder)
    return edit._replace(path=edit.path[len(folder) :] if is_inside else PurePosixPath(edit.path).name)
