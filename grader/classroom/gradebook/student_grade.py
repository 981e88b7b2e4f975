"""The current grade of one student: automatic points, manual marks, late penalty, and whether it is final."""

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from enum import StrEnum
from typing import NamedTuple

from grader.classroom.gradebook.submission_files import SubmissionFiles
from grader.classroom.lateness import Lateness
from grader.classroom.students import Student
from grader.text import counted, counted_points


class Reason(StrEnum):
    """Why a grade needs attention, the most urgent reason first."""

    FAILED = "the grader failed"
    UNREADABLE = "could not be graded"
    MISSING = "nothing was submitted"
    GONE = "no longer in the class folder"
    OUTDATED = "graded with an earlier version of the rubric"
    REMOVED = "a manual mark is of a criterion that the rubric no longer has"
    OVER = "a manual mark exceeds the maximum of its criterion"
    NOT_ON_ROSTER = "not on the roster"
    OLDER_FINAL = "final mark or excuse given before the submission changed"
    OLDER_MARKS = "marked before the submission changed"
    REVALUED_MARKS = "marked before the points of the criterion changed"
    MARKED = "could not be graded, and was marked manually"


class DoubtfulMarks(NamedTuple):
    """The criteria whose manual mark may have to change.

    It was given for an `older` submission, or when the criterion had other points (`revalued`); it is `over` the
    current maximum, or the criterion was `removed` from the rubric.
    """

    older: tuple[str, ...] = ()
    revalued: tuple[str, ...] = ()
    over: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class StudentGrade:
    """One student's current grade. Without a submission `verdict` is `missing`, and there are no points.

    `score` includes manual marks, but not the late penalty. `faults` counts criteria on which the grader failed.
    `is_gone` means that the newest run did not find the submission, `is_outdated` that the rubric
    has changed since it was graded, `has_other_parts` that the parts have that a submission is graded on. `final` is
    the final mark; None if there is none, or the student is excused. `final_is_older` means that the final mark or
    excuse was given for an earlier submission. `section` and `marker` come from the roster.
    """

    id: int
    run: int | None
    result: int | None
    faults: int
    marks: int
    doubtful: DoubtfulMarks
    score: Decimal
    out_of: Decimal
    pending: Decimal
    rubric: str
    verdict: str
    reason: str
    submitted: str
    student: Student
    is_on_roster: bool | None
    is_gone: bool
    is_outdated: bool
    has_other_parts: bool
    files: SubmissionFiles
    late: Lateness
    final: Decimal | None = None
    is_excused: bool = False
    final_is_older: bool = False
    section: str = ""
    marker: str = ""

    @property
    def has_final(self) -> bool:
        """Whether a person has decided the whole grade: with a final mark or an excuse, there is no late penalty."""
        return self.final is not None or self.is_excused

    @property
    def total(self) -> Decimal:
        """The final mark, else the points after the late penalty."""
        return self.final if self.final is not None else self.score + self.late.points

    @property
    def why_not_final(self) -> str:
        """Why this grade must not be exported yet; empty if it is final."""
        if self.final is not None:
            return ""
        reasons = (
            (self.is_excused, "excused"),
            (self.verdict == "missing", "nothing was submitted"),
            (self.faults and self.reason, f"the grader failed: {self.reason}"),
            (self.faults, "the grader failed on a criterion"),
            (self.verdict == "unreadable" and self.pending, f"it could not be graded: {self.reason}"),
            (self.is_gone, "it is no longer in the class folder"),
            (self.is_outdated, "it was graded with an earlier version of the rubric: run `grader batch` again"),
            (self.has_other_parts, "it was graded on other parts: run `grader batch` again"),
            (
                self.doubtful.over,
                f"a manual mark exceeds the maximum of its criterion: {', '.join(self.doubtful.over)}",
            ),
            (self.pending, f"{counted_points(self.pending)} need{'s' * (self.pending == 1)} manual grading"),
        )
        return next((reason for holds, reason in reasons if holds), "")

    @property
    def concerns(self) -> Iterator[tuple[Reason, str]]:
        """Yield why an instructor should look at this grade, each reason with its details."""
        is_errored = self.verdict == "errored" or self.faults
        is_open = not self.has_final and (self.faults or self.pending)
        is_current = not self.has_final and self.rubric and not self.is_outdated
        is_ungraded = not self.has_final and self.verdict in ("errored", "unreadable")
        reasons = (
            (
                is_open and is_errored,
                Reason.FAILED,
                self.reason or f"on {counted(self.faults, 'criterion', 'criteria')}",
            ),
            (is_open and self.verdict == "unreadable", Reason.UNREADABLE, self.reason),
            (is_ungraded and not is_open, Reason.MARKED, ""),
            (not self.has_final and self.verdict == "missing", Reason.MISSING, ""),
            (self.is_gone, Reason.GONE, ""),
            (not self.has_final and self.is_outdated, Reason.OUTDATED, ""),
            (is_current and self.doubtful.removed, Reason.REMOVED, ", ".join(self.doubtful.removed)),
            (self.doubtful.over, Reason.OVER, ", ".join(self.doubtful.over)),
            (self.is_on_roster is False, Reason.NOT_ON_ROSTER, ""),
            (self.final_is_older, Reason.OLDER_FINAL, ""),
            (self.doubtful.older, Reason.OLDER_MARKS, ", ".join(self.doubtful.older)),
            (self.doubtful.revalued, Reason.REVALUED_MARKS, ", ".join(self.doubtful.revalued)),
        )
        return ((reason, detail) for holds, reason, detail in reasons if holds)

    @property
    def why_attention(self) -> str:
        """Why an instructor should look at this grade; empty if nothing is unusual."""
        return "; ".join(f"{reason}: {detail}" if detail else str(reason) for reason, detail in self.concerns)
