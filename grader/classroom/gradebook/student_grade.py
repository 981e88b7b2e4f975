"""The grade of one student: what counts, what is open, and why a person should look at it."""

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from enum import StrEnum
from functools import cached_property
from typing import cast

from grader.base.text import counted_points, format_points
from grader.classroom.marks.marks import EXCUSED, Mark
from grader.classroom.results.results import StoredResult
from grader.classroom.roster.lateness import Lateness
from grader.classroom.roster.roster import Student
from grader.lab.grading.report import Report, Result

_ON_TIME = Lateness()


class Reason(StrEnum):
    """Why a grade needs attention, the most urgent reason first.

    The last two only keep it from being published.

    UNCLEAR means that there are possible submissions, of which none was graded, GONE that the
    newest run did not find the submission, and OUTDATED that it was graded by another rubric or
    version, or on other parts.
    """

    FAILED = "the grader failed"
    UNREADABLE = "could not be graded"
    DAMAGED = "its result is damaged: run `grader batch` again"
    UNCLEAR = "it is unclear which submission counts"
    MISSING = "nothing was submitted"
    NO_ROBOT = "has no robot and no package: not in the mean until it has a mark"
    SEVERAL = "several robots fit: check that the correct one was graded"
    GONE = "no longer in the class folder"
    OUTDATED = "graded with another rubric or version: run `grader batch` again"
    NOT_ON_ROSTER = "not on the roster"
    OLDER_MARKS = "marked before the submission changed"
    EARLY_MARK = "marked before there was a submission"
    UNKNOWN_TIME = "late, time unknown: give `submitted` or `late` in the roster"
    PENDING = "needs manual grading"
    EXCUSED = "excused"


# They keep a grade from being published; of a final mark only GONE needs attention. A mark that is
# older than the submission does, too, if it replaces what a check finds in the newer one.
_OBSTACLES = {
    *(
        Reason.FAILED,
        Reason.UNREADABLE,
        Reason.DAMAGED,
        Reason.UNCLEAR,
        Reason.MISSING,
        Reason.GONE,
        Reason.OUTDATED,
    )
}


def pending_words(points: Decimal) -> str:
    """Return that points need manual grading."""
    return f"{counted_points(points)} {'needs' if points == 1 else 'need'} manual grading"


class SharedResult(Result):
    """The result of a criterion in a class.

    Most students share it, so what follows from it is computed once.
    """

    @cached_property
    def points(self) -> Decimal:
        """The points earned."""
        return super().points

    @cached_property
    def is_open(self) -> bool:
        """Whether the criterion still needs manual grading."""
        return super().is_open

    @cached_property
    def is_faulty(self) -> bool:
        """Whether the grader failed on the criterion, and nobody has marked it."""
        return self.outcome.status == "errored" and not self.manual_mark and not self.is_adjusted

    @cached_property
    def kinds(self) -> Sequence[str]:
        """What it counts as in the figures of a class.

        This is a mark, a given point, or the status of the check.
        """
        if self.manual_mark:
            return "marked", "decided"
        if self.carried or self.is_adjusted:
            return "carried", "decided"
        status = self.outcome.status
        if status in ("pending", "errored"):
            return (status,)
        return (status, "decided")

    @cached_property
    def mistake(self) -> str:
        """The message about a mistake of the student, as a check found it; empty without one."""
        is_mistake = self.is_lost and not self.manual_mark and not self.criterion.bonus
        return self.outcome.message if is_mistake else ""

    @cached_property
    def cell(self) -> str:
        """The points in a table; empty if they are not decided."""
        if self.is_open or self.is_faulty:
            return ""
        return format_points(self.points)


@dataclass(frozen=True)
class StudentGrade:
    """The grade of one student: what counts, what is open, and why a person should look at it.

    A `Gradebook` makes it from the stored result, the marks and the roster, and nothing else
    decides what a student
    gets: `grades.csv`, exports, reports, statistics and pages read it. `total` is the grade as it
    is now, `published` what may leave the house, `obstacle` what is in the way, and `concerns` all
    that a person should look at.

    A student who submitted nothing has no grade until a person gives a final mark:

    >>> from dataclasses import replace
    >>> from grader.lab.rubric.rubric import load_rubric
    >>> from grader.lab.submission.submission import Absent, Submission
    >>> nothing = Report(Submission("ann", Absent(), is_single=False), load_rubric("lab6"), (), ())
    >>> missing = StudentGrade(Student("ann"), None, nothing)
    >>> missing.status, missing.published, missing.why_open
    ('missing', None, 'nothing was submitted')
    >>> mark = Mark(time="", by="Kim", student="ann", criterion="grade", value="12.5")
    >>> replace(missing, final=mark).published
    Decimal('12.5')
    """

    student: Student
    stored: StoredResult | None  # None without a submission
    report: Report  # its points with the manual marks; without a submission no results
    late: Lateness = _ON_TIME
    final: Mark | None = None  # the mark, comment or excuse of the whole submission
    # the criteria (or `grade`) that were marked before the submission changed
    older: Sequence[str] = ()
    known: frozenset[Reason] = (
        frozenset()
    )  # what the class says: NOT_ON_ROSTER, UNCLEAR, DAMAGED, GONE, OUTDATED

    @property
    def is_excused(self) -> bool:
        """Whether the student is excused."""
        return self.final is not None and self.final.value == EXCUSED

    @property
    def final_points(self) -> Decimal | None:
        """The points of the final mark; None without one."""
        if self.final:
            return self.final.points
        return None

    @property
    def has_final(self) -> bool:
        """Whether a person has decided the whole grade: then there is no late penalty."""
        return self.is_excused or self.final_points is not None

    @property
    def is_marked_early(self) -> bool:
        """Whether the whole grade was decided when there was no submission.

        The mark has a time, but no digest.
        """
        mark = self.final if self.stored and self.has_final else None
        return mark is not None and bool(mark.time) and not mark.submission

    @property
    def is_without_robot(self) -> bool:
        """Whether the submission has nothing that is graded automatically, and has no mark."""
        if not self.stored or not self.stored.no_robot or self.has_final:
            return False
        return all(not one.manual_mark for one in self.results)

    @property
    def is_gone(self) -> bool:
        """Whether the newest run did not find the submission."""
        return Reason.GONE in self.known

    @property
    def status(self) -> str:
        """How the submission went: graded, unreadable, errored, missing or excused."""
        if self.is_excused:
            return "excused"
        if Reason.DAMAGED in self.known:
            return "errored"
        if self.stored:
            return self.stored.verdict
        return "missing"

    @property
    def results(self) -> Sequence[SharedResult]:
        """The results of the criteria."""
        return cast("tuple[SharedResult, ...]", self.report.results)

    @cached_property
    def score(self) -> Decimal:
        """The points of the criteria, without a submission 0."""
        return self.report.score

    @cached_property
    def total(self) -> Decimal | None:
        """The final mark, else the points after the late penalty.

        It is None for an excuse, and without a submission.
        """
        if self.has_final or not self.stored:
            return self.final_points
        return self.score + self.late.points

    @cached_property
    def pending(self) -> Decimal:
        """The points that still need manual grading and can change the grade."""
        if not self.has_final:
            return self.report.pending
        return Decimal(0)

    @cached_property
    def is_undecided(self) -> bool:
        """Whether nothing is decided yet.

        All criteria need manual grading, or nothing could be graded.
        """
        if not self.obstacle or self.has_final or self.total:
            return False
        is_ungraded = self.status in ("unreadable", "errored")
        return is_ungraded or all(one.is_open or one.is_faulty for one in self.results)

    @property
    def shown_total(self) -> Decimal | None:
        """The grade; None where there is none or nothing is decided yet."""
        return None if self.is_undecided else self.total

    @property
    def total_text(self) -> str:
        """The grade; empty where there is none or nothing is decided yet."""
        if self.shown_total is None:
            return ""
        return format_points(self.shown_total)

    @cached_property
    def losses(self) -> list[tuple[Decimal, str]]:
        """The points that were lost by mistakes or marks, and the criterion.

        The most points come first, and after all others what was skipped because of another
        criterion.
        """
        lost = [
            (one.outcome.status == "skipped", one.points - one.criterion.maximum, one.criterion.id)
            for one in (self.results if not self.has_final else ())
            if (one.is_lost or one.manual_mark) and one.points < one.criterion.maximum
        ]
        return [(-points, name) for _, points, name in sorted(lost)]

    @cached_property
    def concerns(self) -> dict[Reason, str]:
        """Why a person should look at this grade, each reason with its details."""
        reason = self.stored.reason if self.stored else ""
        reasons = self._reasons(reason)
        details = dict.fromkeys((Reason.FAILED, Reason.UNREADABLE, Reason.SEVERAL), reason)
        if self.stored:
            details[Reason.NO_ROBOT] = self.stored.no_robot
        details[Reason.OLDER_MARKS] = ", ".join(self.older)
        if self.final:
            details[Reason.EARLY_MARK] = (
                f"{self.final.value} instead of {format_points(self.score)}"
            )
        return {one: details.get(one, "") for one in Reason if one in reasons}

    def _reasons(self, reason: str) -> set[Reason]:
        """Return why a person should look at this grade; `reason` is that of the result."""
        reasons = {*self.known}
        if any(one.is_faulty for one in self.results):
            reasons.add(Reason.FAILED)
        if self.status == "unreadable" and self.pending:
            reasons.add(Reason.UNREADABLE)
        if self.status == "graded" and reason:
            reasons.add(Reason.SEVERAL)
        if self.is_without_robot:
            reasons.add(Reason.NO_ROBOT)
        if not self.stored and reasons.isdisjoint((Reason.UNCLEAR, Reason.DAMAGED)):
            reasons.add(Reason.MISSING)
        if self.has_final:
            reasons -= _OBSTACLES - {Reason.GONE}
        if self.older:
            reasons.add(Reason.OLDER_MARKS)
        if self.is_marked_early:
            reasons.add(Reason.EARLY_MARK)
        if self.late.is_guess and self.late.points:
            reasons.add(Reason.UNKNOWN_TIME)
        return reasons

    @cached_property
    def obstacle(self) -> Reason | None:
        """What keeps this grade from being published; None if it is final."""
        if self.has_final:
            return Reason.EXCUSED if self.is_excused else None
        obstacles = _OBSTACLES | {Reason.OLDER_MARKS} if self._has_older_override else _OBSTACLES
        pending = Reason.PENDING if self.pending else None
        return next((one for one in self.concerns if one in obstacles), pending)

    @property
    def _has_older_override(self) -> bool:
        """Whether a mark replaces other points that the changed submission has by the checks."""
        for one in self.results:
            if one.manual_mark and one.criterion.id in self.older:
                by_check = one._replace(manual_mark=None)
                if not by_check.is_open and by_check.points != one.points:
                    return True
        return False

    @property
    def why_open(self) -> str:
        """Why this grade must not be published yet; empty if it is final."""
        if self.obstacle is Reason.PENDING:
            return pending_words(self.pending)
        if self.obstacle is None:
            return ""
        detail = self.concerns.get(self.obstacle)
        if detail:
            return f"{self.obstacle}: {detail}"
        return str(self.obstacle)

    @property
    def published(self) -> Decimal | None:
        """The grade that is published: the total, unless something is open."""
        return self.total if not self.obstacle else None

    @property
    def is_counted(self) -> bool:
        """Whether the grade is in the figures of the class.

        One that is open counts, too, if something of it is decided. One without a robot does
        not, until it has a mark.
        """
        if self.is_without_robot:
            return False
        is_graded = self.status == "graded" and not self.is_gone and not self.is_undecided
        return self.student.is_on_roster and (is_graded or self.published is not None)
