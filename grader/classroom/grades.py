"""The grades of a class, computed from the results, the rubric, the roster and the marks of people."""

from collections.abc import Iterator
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import Any

from grader import __version__
from grader.checks.outcome import Outcome
from grader.classroom import folder as names
from grader.classroom.graded import Graded, Run
from grader.classroom.lateness import Lateness, SubmissionTimes, lateness, read_time
from grader.classroom.marks import Mark, Marks, read_marks
from grader.classroom.results import Results
from grader.classroom.roster import Roster, Student, read_roster
from grader.classroom.settings import read_settings
from grader.classroom.student_grade import StudentGrade
from grader.classroom.tables import SIZE_LIMIT
from grader.errors import InputError
from grader.files.reading import read_capped
from grader.grading.answers import load_with_answers
from grader.grading.criterion import DEADLINE, TOTAL, Criterion
from grader.grading.report import ManualComment, ManualMark, Report, Result
from grader.grading.rubric import load_rubric
from grader.text import printable_path

_NOT_SUBMITTED = Outcome("skipped", "not graded: this part was not submitted")


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
        self._marked = {student for student, _ in (*self.marks.counting, *self.marks.comments)}
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
        if graded.student not in self._marked:
            return report, ()
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
