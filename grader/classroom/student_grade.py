"""The grade of one student: what counts, what is open, and why a person should look at it."""

from dataclasses import dataclass
from decimal import Decimal
from enum import StrEnum
from functools import cached_property

from grader.classroom.graded import Graded
from grader.classroom.lateness import Lateness
from grader.classroom.marks import EXCUSED, Mark
from grader.classroom.roster import Student
from grader.grading.criterion import TOTAL
from grader.grading.report import Report, Result
from grader.text import counted_points, format_points

_ON_TIME = Lateness()


class Reason(StrEnum):
    """Why a grade needs attention, the most urgent reason first."""

    FAILED = "the grader failed"
    UNREADABLE = "could not be graded"
    UNCLEAR = "it is unclear which submission counts"
    MISSING = "nothing was submitted"
    GONE = "no longer in the class folder"
    OUTDATED = "graded with another rubric or version: run `grader batch` again"
    NOT_ON_ROSTER = "not on the roster"
    OLDER_FINAL = "final mark or excuse given before the submission changed"
    OLDER_MARKS = "marked before the submission changed"
    MARKED = "could not be graded, and was marked manually"
    PENDING = "needs manual grading"
    EXCUSED = "excused"


# They keep a grade from being published.
_OBSTACLES = {Reason.FAILED, Reason.UNREADABLE, Reason.UNCLEAR, Reason.MISSING, Reason.GONE, Reason.OUTDATED}


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

    @property
    def status(self) -> str:
        """How the submission went: graded, unreadable, errored, missing or excused."""
        if self.is_excused:
            return "excused"
        return self.graded.verdict if self.graded is not None else "missing"

    @property
    def results(self) -> tuple[Result, ...]:
        """The results of the criteria."""
        return self.report.results if self.report is not None else ()

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

    @property
    def total_text(self) -> str:
        """The grade; empty where there is none or nothing could be graded."""
        is_ungraded = self.status in ("unreadable", "errored") and self.obstacle and not self.total
        return "" if self.total is None or is_ungraded else format_points(self.total)

    @cached_property
    def losses(self) -> list[tuple[Decimal, str]]:
        """The points that were lost by mistakes or marks, and the criterion.

        The most points come first, and after all others what was skipped because of another criterion.
        """
        lost = [one for one in self.results if one.is_lost or one.manual_mark] if not self.has_final else []
        lost.sort(
            key=lambda one: (one.outcome.status == "skipped", one.points - one.criterion.maximum, one.criterion.id)
        )
        points = ((one.criterion.maximum - one.points, one.criterion.id) for one in lost)
        return [loss for loss in points if loss[0] > 0]

    @cached_property
    def concerns(self) -> dict[Reason, str]:
        """Why a person should look at this grade, each reason with its details."""
        reason = self.graded.reason if self.graded is not None else ""
        is_undecided, has_fault = not self.has_final, any(map(is_faulty, self.results))
        is_open = is_undecided and bool(has_fault or self.pending)
        is_marked = is_undecided and not is_open and self.status in ("errored", "unreadable")
        older = ", ".join(name for name in self.older if name != TOTAL)
        found = (
            (is_undecided and has_fault, Reason.FAILED, reason),
            (is_open and self.status == "unreadable", Reason.UNREADABLE, reason),
            (is_undecided and self.is_unclear, Reason.UNCLEAR, ""),
            (is_undecided and self.graded is None and not self.is_unclear, Reason.MISSING, ""),
            (self.is_gone, Reason.GONE, ""),
            (is_undecided and self.is_outdated, Reason.OUTDATED, ""),
            (not self.student.is_on_roster, Reason.NOT_ON_ROSTER, ""),
            (TOTAL in self.older, Reason.OLDER_FINAL, ""),
            (older, Reason.OLDER_MARKS, older),
            (is_marked, Reason.MARKED, ""),
        )
        return {why: detail for holds, why, detail in found if holds}

    @cached_property
    def obstacle(self) -> Reason | None:
        """What keeps this grade from being published; None if it is final."""
        if self.has_final:
            return Reason.EXCUSED if self.is_excused else None
        pending = Reason.PENDING if self.pending else None
        return next((reason for reason in self.concerns if reason in _OBSTACLES), pending)

    @property
    def why_open(self) -> str:
        """Why this grade must not be published yet; empty if it is final."""
        if self.obstacle is None:
            return ""
        if self.obstacle is Reason.PENDING:
            return f"{counted_points(self.pending)} need{'s' * (self.pending == 1)} manual grading"
        details = self.concerns.get(self.obstacle, "")
        return f"{self.obstacle}: {details}" if details else str(self.obstacle)

    @property
    def published(self) -> Decimal | None:
        """The grade that is published: the total, unless something is open."""
        return self.total if self.obstacle is None else None

    @property
    def is_counted(self) -> bool:
        """Whether the grade is in the figures of the class: also one that is open, if the submission was graded."""
        is_graded = self.status == "graded" and not self.is_gone
        return self.student.is_on_roster and (is_graded or self.published is not None)


def is_faulty(result: Result) -> bool:
    """Return whether the grader failed on a criterion, and nobody has marked it."""
    return result.outcome.status == "errored" and result.manual_mark is None and not result.is_adjusted
