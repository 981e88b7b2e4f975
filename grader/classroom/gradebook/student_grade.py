"""The current grade of one student: automatic points, manual marks, late penalty, and whether it is final."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from grader.classroom.gradebook.lateness import Lateness, SubmissionTimes
from grader.classroom.gradebook.result import UNITS_PER_POINT
from grader.classroom.gradebook.sources import SubmissionFiles
from grader.classroom.gradebook.stored import STUDENT_COLUMNS
from grader.classroom.students import Student
from grader.text import counted

_COUNTS = ("id", "run", "result", "faults", "marks", "older_marks", "over_marks")  # columns that are used unchanged
_POINTS = ("score", "out_of", "pending")
_TEXTS = ("rubric", "digest", "verdict", "reason", "statuses", "submitted")
_OTHERS = ("deadline", "extension", "days_late", "is_on_roster", "is_gone", "is_late", "files", "source", "fingerprint")
COLUMNS = (*_COUNTS, *_POINTS, *_TEXTS, *_OTHERS, *STUDENT_COLUMNS)


@dataclass(frozen=True, slots=True)
class StudentGrade:
    """One student's current grade. Without a submission `verdict` is `missing`, and there are no points.

    `score` includes manual marks, but not the late penalty. `faults` counts criteria on which the grader failed, `older_marks` marks
    that were given for an earlier submission or result, `over_marks` marks above the criterion's current maximum. `is_gone` means
    that the newest run did not find the submission, `is_outdated` that the rubric has changed since it was graded.
    """

    id: int
    run: int | None
    result: int | None
    faults: int
    marks: int
    older_marks: int
    over_marks: int
    score: Decimal
    out_of: Decimal
    pending: Decimal
    rubric: str
    digest: str
    verdict: str
    reason: str
    statuses: str
    submitted: str
    student: Student
    is_on_roster: bool | None
    is_gone: bool
    is_late: bool
    is_outdated: bool
    files: SubmissionFiles
    attempt: int
    earlier: tuple[str, ...]
    late: Lateness

    @property
    def total(self) -> Decimal:
        """The points after the late penalty."""
        return self.score + self.late.points

    @property
    def why_not_final(self) -> str:
        """Why this grade must not be exported yet; empty if it is final."""
        if self.verdict == "missing":
            return "nothing was submitted"
        if self.faults:
            return f"the grader failed: {self.reason}" if self.reason else "the grader failed on a criterion"
        if self.verdict == "unreadable" and self.pending:
            return f"it could not be graded: {self.reason}"
        if self.is_gone:
            return "it is no longer in the class folder"
        if self.is_outdated:
            return "it was graded with an earlier version of the rubric: run `grader batch` again"
        if self.over_marks:
            return "a manual mark exceeds the criterion's maximum"
        if self.pending:
            points = format(self.pending.normalize(), "f")
            return "1 point needs manual grading" if self.pending == 1 else f"{points} points need manual grading"
        return ""

    @property
    def why_attention(self) -> str:
        """Why an instructor should look at this grade."""
        reasons = []
        if self.verdict != "graded" or self.faults:
            reasons.append(self.why_not_final or "it could not be graded, and was marked manually")
        if self.is_gone:
            reasons.append("no longer in the class folder")
        if self.is_outdated:
            reasons.append("graded with an earlier version of the rubric")
        if self.over_marks:
            reasons.append("a manual mark exceeds the criterion's maximum")
        if self.is_on_roster is False:
            reasons.append("not on the roster")
        if self.older_marks:
            verb = "is" if self.older_marks == 1 else "are"
            marks = counted(self.older_marks, "manual mark")
            reasons.append(f"{marks} {verb} from before the submission or the points changed")
        return "; ".join(reasons)


def grade_from_row(
    row: tuple[Any, ...], newest_rubric: str, lateness_of: Callable[[str, SubmissionTimes, Decimal], Lateness]
) -> StudentGrade:
    """Return the grade in a row of COLUMNS; `lateness_of` gets the rubric, the times and the score."""
    values = dict(zip(COLUMNS, row, strict=True))
    counts = {name: values[name] for name in _COUNTS}
    points = {name: Decimal(values[name] or 0) / UNITS_PER_POINT for name in _POINTS}
    texts = {name: values[name] or "" for name in _TEXTS}
    rubric, is_late, is_on_roster = texts["rubric"], bool(values["is_late"]), values["is_on_roster"]
    times = SubmissionTimes(
        is_late, texts["submitted"], values["deadline"], float(values["extension"] or 0), values["days_late"]
    )
    paths, names, attempt, earlier = json.loads(values["files"])
    key, fingerprint = values["key"], values["fingerprint"] or ""
    return StudentGrade(
        **{**counts, **points, **texts, "faults": counts["faults"] or 0},
        student=Student(*(values[name] for name in STUDENT_COLUMNS)),
        is_on_roster=None if is_on_roster is None else bool(is_on_roster),
        is_gone=bool(values["is_gone"]),
        is_late=is_late,
        is_outdated=bool(rubric) and rubric != newest_rubric,
        files=SubmissionFiles(values["source"] or "", tuple(paths), tuple(names), key, fingerprint),
        attempt=attempt,
        earlier=tuple(earlier),
        late=lateness_of(rubric, times, points["score"]) if rubric else Lateness(),
    )
