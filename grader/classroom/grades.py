"""The grades of a class, computed from the results, the rubric, the roster and the marks of people."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from decimal import Decimal
from enum import StrEnum
from functools import cached_property
from pathlib import Path
from typing import Any

from grader import __version__
from grader.checks.outcome import Outcome
from grader.classroom import folder as names
from grader.classroom.lateness import Lateness, SubmissionTimes, lateness, read_time
from grader.classroom.marks import EXCUSED, Mark, Marks, read_marks
from grader.classroom.results import Graded, Results, Run
from grader.classroom.roster import Roster, Student, read_roster
from grader.classroom.settings import read_settings
from grader.classroom.tables import SIZE_LIMIT
from grader.errors import InputError
from grader.files.reading import read_capped
from grader.grading.answers import load_with_answers
from grader.grading.criterion import DEADLINE, TOTAL, Criterion
from grader.grading.report import ManualComment, ManualMark, Report, Result
from grader.grading.rubric import load_rubric
from grader.text import counted_points, printable_path

_ON_TIME = Lateness()
_NOT_SUBMITTED = Outcome("skipped", "not graded: this part was not submitted")


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
    def total(self) -> Decimal | None:
        """The final mark, else the points after the late penalty; None for an excuse, and without a submission."""
        if self.has_final or self.report is None:
            return self.final_points
        return self.report.score + self.late.points

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


class Class:
    """A class in a gradebook: iterating yields the grade of every student, in the order of the keys."""

    def __init__(
        self, folder: Path, until: int | None = None, run: Run | None = None, answers: Path | None = None
    ) -> None:
        """`until` is the number of the run whose results count; marks, roster and deadline are those of now.

        `run` is one that is not in the file yet; `answers` is the file of the model answers, for those who grade.
        """
        names.check_gradebook(folder)
        self.folder, self.settings = folder, read_settings(folder)
        rubric = folder / self.settings.rubric
        self.rubric = load_rubric(rubric) if answers is None else load_with_answers(str(rubric), answers)
        self.roster = read_class_roster(folder)
        self.results = Results(folder / names.RESULTS, until)
        if run is None and not self.results.runs:
            raise InputError(f"nothing is graded yet in {printable_path(folder)}: run `grader batch PATH`")
        self.run: Run = run or self.results.runs[-1]
        self.due: datetime | None = read_time(self.settings.due) if self.settings.due else None
        self._on_roster = {one.key: one for one in self.roster.students} if self.roster is not None else {}
        self.keys = sorted({*self._on_roster, *self.results.students})
        self.marks: Marks = read_marks(folder / names.MARKS, self.keys, self.rubric)
        self.is_outdated = (self.run.rubric, self.run.version) != (self.rubric.sha256, __version__)

    def __iter__(self) -> Iterator[StudentGrade]:
        results = self.results.all()
        newest = next(results, None)
        for key in self.keys:
            if newest is not None and newest.student == key:
                yield self._grade(key, newest)
                newest = next(results, None)
            else:
                yield self._grade(key, None)

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """The criteria of the graded parts."""
        return tuple(row for row in self.rubric.criteria if row.part in (self.settings.parts or {row.part}))

    def grade(self, key: str) -> StudentGrade:
        """Return the grade of the student with a key."""
        return self._grade(key, self.results.of(key))

    def student(self, key: str, graded: Graded | None) -> Student:
        """Return a student as the roster has it, completed by the LMS ids in the names of the submission."""
        person: dict[str, Any] = dict(graded.person) if graded is not None else {}
        found = self._on_roster.get(key)
        if found is None:
            return Student(key, **person, is_on_roster=self.roster is None)
        return found._replace(**{name: value for name, value in person.items() if not getattr(found, name)})

    def _grade(self, key: str, graded: Graded | None) -> StudentGrade:
        whole = (key, TOTAL)
        student, final = self.student(key, graded), self.marks.counting.get(whole) or self.marks.comments.get(whole)
        if graded is None:
            return StudentGrade(student, None, None, final=final, is_unclear=key in self.run.unclear)
        report, older = self.with_marks(graded.report(self.rubric), graded)
        if final is not None and _is_older(final, graded):
            older = (*older, TOTAL)
        times = SubmissionTimes(
            is_late=graded.is_late if student.is_late is None else student.is_late,
            submitted=student.submitted or graded.submitted,
            deadline=student.due,
            extension=student.extension_days,
            days_late=0.0 if student.is_late is False and student.days_late is None else student.days_late,
        )
        own = self.marks.counting.get((key, DEADLINE))
        late = lateness(self.rubric, times.extended(own.value if own is not None else ""), report.score, self.due)
        is_gone = key not in self.run.totals
        is_outdated = self.is_outdated or graded.context != self.run.context
        grade = StudentGrade(student, graded, report, late, final, older, is_gone, is_outdated, key in self.run.unclear)
        return replace(grade, late=Lateness(late.days, reason=late.reason)) if grade.has_final else grade

    def with_marks(self, report: Report, graded: Graded) -> tuple[Report, tuple[str, ...]]:
        """Return a report with marks and comments, and the criteria that were marked before the submission changed."""
        results = {one.criterion.id: one for one in report.results}
        older: list[str] = []
        for row in self.rubric.criteria:
            key = graded.student, row.id
            mark, comment = self.marks.counting.get(key), self.marks.comments.get(key)
            if comment is not None and row.id in results:
                results[row.id] = results[row.id]._replace(comment=ManualComment(comment.comment, comment.by))
            if mark is None or mark.points is None or row.adjustment is not None:
                continue
            result = results.get(row.id) or Result(row, _NOT_SUBMITTED)
            results[row.id] = result._replace(
                manual_mark=ManualMark(mark.points, mark.by, mark.comment), hint=None, comment=None
            )
            older += [row.id] if _is_older(mark, graded) else []
        ordered = tuple(results[row.id] for row in self.rubric.criteria if row.id in results)
        return report._replace(results=ordered), tuple(older)


def _is_older(mark: Mark, graded: Graded) -> bool:
    return bool(mark.submission) and mark.submission != graded.digest


def read_class_roster(folder: Path) -> Roster | None:
    """Return the roster in a gradebook; None without one."""
    file = folder / names.ROSTER
    return read_roster(read_capped(file, SIZE_LIMIT, advice=""), printable_path(file)) if file.exists() else None
