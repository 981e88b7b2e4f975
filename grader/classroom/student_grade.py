"""The grade of one student: what counts, why it is open, and why a person should look at it."""

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from enum import StrEnum
from functools import cached_property

from grader.classroom.graded import Graded
from grader.classroom.lateness import Lateness
from grader.classroom.marks import EXCUSED, Mark
from grader.classroom.roster import Student
from grader.grading.criterion import TOTAL
from grader.grading.report import Report
from grader.text import counted_points

_ON_TIME = Lateness()


class Reason(StrEnum):
    """Why a grade needs attention, the most urgent reason first."""

    FAILED = "the grader failed"
    UNREADABLE = "could not be graded"
    UNCLEAR = "it is unclear which submission counts"
    MISSING = "nothing was submitted"
    GONE = "no longer in the class folder"
    OUTDATED = "graded with an earlier version of the rubric or the grader"
    NOT_ON_ROSTER = "not on the roster"
    OLDER_FINAL = "final mark or excuse given before the submission changed"
    OLDER_MARKS = "marked before the submission changed"
    MARKED = "could not be graded, and was marked manually"


@dataclass(frozen=True)
class StudentGrade:
    """The grade of one student. Without a submission there is no result, and no report.

    `report` has the points with the manual marks; `final` is the mark or excuse of the whole submission; `older` are
    the criteria (or `total`) that were marked before the submission changed; `is_gone` means that the newest run did
    not find the submission, `is_outdated` that it was graded by another rubric, version, or on other parts, and
    `is_unclear` that there are possible submissions, of which none was graded.
    """

    student: Student
    graded: Graded | None
    report: Report | None
    late: Lateness = _ON_TIME
    final: Mark | None = None
    older: tuple[str, ...] = ()
    is_gone: bool = False
    is_outdated: bool = False
    is_unclear: bool = False

    @property
    def is_excused(self) -> bool:
        """Whether the student is excused."""
        return self.final is not None and self.final.value == EXCUSED

    @property
    def final_points(self) -> Decimal | None:
        """The points of the final mark; None without one."""
        return self.final.points if self.final is not None else None

    @property
    def has_final(self) -> bool:
        """Whether a person has decided the whole grade: then there is no late penalty."""
        return self.is_excused or self.final_points is not None

    @cached_property
    def score(self) -> Decimal:
        """The points of the criteria, without a submission 0."""
        return self.report.score if self.report is not None else Decimal(0)

    @cached_property
    def total(self) -> Decimal | None:
        """The final mark, else the points after the late penalty; None for an excuse, and without a submission."""
        if self.has_final or self.report is None:
            return self.final_points
        return self.score + self.late.points

    @cached_property
    def pending(self) -> Decimal:
        """The points that still need manual grading and can change the grade."""
        return self.report.pending if self.report is not None and not self.has_final else Decimal(0)

    @cached_property
    def faults(self) -> int:
        """The number of criteria on which the grader failed, and that nobody has marked."""
        rows = self.report.results if self.report is not None else ()
        return sum(row.outcome.status == "errored" and row.manual_mark is None and not row.is_adjusted for row in rows)

    @cached_property
    def why_open(self) -> str:
        """Why this grade must not be published yet; empty if it is final."""
        if self.final_points is not None:
            return ""
        reason = self.graded.reason if self.graded is not None else ""
        reasons = (
            (self.is_excused, "excused"),
            (self.is_unclear, Reason.UNCLEAR.value),
            (self.report is None, Reason.MISSING.value),
            (self.faults, f"the grader failed: {reason}" if reason else "the grader failed on a criterion"),
            (self._is("unreadable") and self.pending, f"it could not be graded: {reason}"),
            (self.is_gone, "it is no longer in the class folder"),
            (self.is_outdated, "it was graded with another rubric or version: run `grader batch` again"),
            (self.pending, f"{counted_points(self.pending)} need{'s' * (self.pending == 1)} manual grading"),
        )
        return next((why for holds, why in reasons if holds), "")

    @property
    def published(self) -> Decimal | None:
        """The grade that is published: the total, unless something is open."""
        return None if self.why_open else self.total

    @property
    def concerns(self) -> Iterator[tuple[Reason, str]]:
        """Yield why a person should look at this grade, each reason with its details."""
        reason = self.graded.reason if self.graded is not None else ""
        is_open = not self.has_final and bool(self.faults or self.pending)
        is_ungraded = not self.has_final and (self._is("errored") or self._is("unreadable"))
        older = tuple(name for name in self.older if name != TOTAL)
        reasons = (
            (not self.has_final and self.faults, Reason.FAILED, reason),
            (is_open and self._is("unreadable"), Reason.UNREADABLE, reason),
            (is_ungraded and not is_open, Reason.MARKED, ""),
            (not self.has_final and self.is_unclear, Reason.UNCLEAR, ""),
            (not self.has_final and self.graded is None and not self.is_unclear, Reason.MISSING, ""),
            (self.is_gone, Reason.GONE, ""),
            (not self.has_final and self.is_outdated, Reason.OUTDATED, ""),
            (not self.student.is_on_roster, Reason.NOT_ON_ROSTER, ""),
            (TOTAL in self.older, Reason.OLDER_FINAL, ""),
            (older, Reason.OLDER_MARKS, ", ".join(older)),
        )
        return ((reason, detail) for holds, reason, detail in reasons if holds)

    def _is(self, verdict: str) -> bool:
        return self.graded is not None and self.graded.verdict == verdict
