"""The proven edits that would gain points in a class, each with the number of students who need it and an example."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from pathlib import PurePosixPath

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.graded_students import manual_units
from grader.classroom.gradebook.hints import Mistaken, mistaken
from grader.classroom.gradebook.result import units_of
from grader.grading.hints.record import hints_from_record, own_edits
from grader.grading.report import Hint
from grader.grading.rubric import Rubric
from grader.source import Edit, Edits

_MAX_FIXES = 20


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
    examples: dict[tuple[str, tuple[str, ...]], tuple[Mistaken, Hint, tuple[Hint, ...]]] = {}
    marks = manual_units(book)
    for submission, example, hints in _with_hints(book, rubric):
        given = {row.id for row in rubric.criteria if marks[submission.student].get(row.id) == units_of(row.points)}
        for hint in hints:
            action, gained = hint.action, tuple(hint.gains)
            if action and not given.issuperset(gained):
                needed.setdefault(action, {}).setdefault(submission.key, gained)
                examples.setdefault((action, gained), (example, hint, hints))
    fixes = []
    for action, gains in needed.items():
        kinds = Counter(gains.values())
        gained = min(kinds, key=lambda names: (-kinds[names], names))
        example, hint, hints = examples[action, gained]
        edits = tuple(_nameless(edit, example, rubric) for edit in own_edits(hint, hints))
        fixes.append(CommonFix(action, tuple(gains), gained, sum(hint.gains.values(), Decimal(0)), edits))
    return tuple(sorted(fixes, key=lambda fix: (-fix.count, -fix.points, fix.action))[:_MAX_FIXES])


def _with_hints(book: Gradebook, rubric: Rubric) -> Iterator[tuple[Mistaken, Mistaken, tuple[Hint, ...]]]:
    """Yield submissions, each with the first that has the same robot and the same failures, and with its hints."""
    submissions = mistaken(book, rubric)
    first = {one.robot: one for one in reversed(submissions) if one.hints is not None}
    hints = {robot: hints_from_record(one.hints) for robot, one in first.items() if one.hints is not None}
    for submission in submissions:
        if submission.robot in first:
            yield submission, first[submission.robot], hints[submission.robot]


def _nameless(edit: Edit, example: Mistaken, rubric: Rubric) -> Edit:
    """Return an edit with the rubric's path of the URDF, or one in the package: folders may have students' names."""
    if not edit.path:
        return edit._replace(path=rubric.urdf)
    package = example.submission.package
    folder = f"{package.folder}/" if package is not None and package.folder else ""
    is_inside = package is not None and edit.path.startswith(folder)
    return edit._replace(path=edit.path[len(folder) :] if is_inside else PurePosixPath(edit.path).name)
