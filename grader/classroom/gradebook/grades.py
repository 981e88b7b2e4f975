"""The current grades in a gradebook: look up students, list those that need attention, build their reports."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from datetime import datetime
from decimal import Decimal
from functools import cache, cached_property, partial
from typing import Any

from grader.checks.outcome import Outcome
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.marks import EXTENSION
from grader.classroom.gradebook.result import criterion_points, points_from_units, storable
from grader.classroom.gradebook.stored import STUDENT_COLUMNS
from grader.classroom.gradebook.student_grade import DoubtfulMarks, StudentGrade
from grader.classroom.gradebook.submission_files import SubmissionFiles, SubmissionSources
from grader.classroom.lateness import Lateness, SubmissionTimes, lateness, read_time
from grader.classroom.students import Student
from grader.classroom.typed_names import find_typed
from grader.errors import InputError
from grader.grading.criterion import Criterion
from grader.grading.hints.record import add_stored_hints
from grader.grading.record import from_record
from grader.grading.report import ManualComment, ManualMark, Report, Result
from grader.grading.rubric import Rubric
from grader.text import shell_quoted

# Columns of the view `grade` that are taken as they are, points, and truth values.
_PLAIN = ("id", "run", "result", "faults", "marks", "rubric", "verdict", "reason", "submitted", "section", "marker")
_POINTS = ("score", "out_of", "pending")
_TRUTHS = ("is_gone", "is_excused", "final_is_older")
_EXTENDED = f"SELECT comment FROM current_mark WHERE student = grade.id AND criterion = '{EXTENSION}'"


class Grades:
    """The current grades in a gradebook. Rubrics contain model answers only with `answers`, for those who grade."""

    def __init__(self, book: Gradebook, deadline: datetime | None = None, *, answers: bool = False) -> None:
        self.book = book
        newest = book.newest_run()
        self._newest_sha256 = newest.rubric if newest is not None else ""
        self._deadline = read_time(newest.deadline) if newest and newest.deadline and deadline is None else deadline
        self.rubric = cache(partial(book.rubric, answers=answers))

    def newest_rubric(self) -> Rubric:
        """Return the rubric of the newest run; raises InputError if there is no run."""
        if not self._newest_sha256:
            raise self.book.nothing_graded()
        return self.rubric(self._newest_sha256)

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """The parts that the newest run has graded every submission on."""
        rubric = self.newest_rubric()
        newest = "SELECT parts FROM grade WHERE rubric = ? AND result IS NOT NULL ORDER BY result DESC LIMIT 1"
        row = self.book.first(newest, rubric.sha256)
        return tuple(row[0].split()) if row is not None else tuple(part.id for part in rubric.parts)

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """The criteria of these parts."""
        return tuple(row for row in self.newest_rubric().criteria if row.part in self.parts)

    @property
    def has_deadline(self) -> bool:
        """Return whether late submissions lose points after a deadline of the class."""
        policy = self.newest_rubric().late
        return policy is not None and (self._deadline or policy.due) is not None

    def points(self, grade: StudentGrade, *, automatic: bool = False) -> dict[str, Decimal]:
        """Return the points of each criterion that has a result or a manual mark, or only those of checks."""
        if grade.result is None:
            return {}
        marks = {} if automatic else {name: mark.points for name, mark in self._manual_marks(grade).items()}
        points = criterion_points(self.rubric(grade.rubric), self.book.outcomes(grade.result), marks)
        return {name: value for name, value in points.items() if value is not None}

    def carried(self, grade: StudentGrade) -> list[str]:
        """Return the criteria that failed because of an earlier mistake alone, and whose points are given."""
        outcomes = self.book.outcomes(grade.result).values() if grade.result is not None else ()
        criteria = [self.rubric(grade.rubric).criteria[one.position] for one in outcomes if one.status == "carried"]
        marks = self._manual_marks(grade) if criteria else {}
        return [row.id for row in criteria if row.id not in marks]

    def all(self) -> Iterator[StudentGrade]:
        """Yield all grades, in the order of the keys."""
        return self.where("TRUE")

    def between(self, first: str, last: str) -> Iterator[StudentGrade]:
        """Yield the grades with keys from `first` to `last`, both included, in the order of the keys."""
        return self.where("key BETWEEN ? AND ?", first, last)

    def where(self, condition: str, *values: Any) -> Iterator[StudentGrade]:
        """Yield the grades that meet a condition on the view `grade`, in the order of the keys."""
        query = f"SELECT *, ({_EXTENDED}) AS extended FROM grade WHERE {condition} ORDER BY key"
        return map(self._grade, self.book.records(query, *values))

    def find(self, name: str) -> StudentGrade:
        """Return the grade of the student with this key, else of the only match of a typed name; raises InputError."""
        name = storable(name)
        for grade in list(self.where("key = ?", name)):
            return grade
        advice = f"; `grader export csv --gradebook {shell_quoted(self.book.shown)}` lists all students"
        return self.find(find_typed(list(self.book.students()), name, advice).key)

    def report(self, grade: StudentGrade) -> Report:
        """Return the report on the newest submission with the manual marks; raises InputError if there is none."""
        if grade.result is None:
            raise InputError(f"{grade.student.key} has submitted nothing")
        rubric = self.rubric(grade.rubric)
        report = from_record(self.book.record(grade.result), rubric, SubmissionSources(grade.files, rubric))
        hints = self.book.first("SELECT hints FROM hint WHERE result = ?", grade.result)
        report = add_stored_hints(report, hints[0]) if hints is not None else report
        results = _with_marks(report, self._manual_marks(grade), self._comments(grade))
        return report._replace(results=results)

    def _manual_marks(self, grade: StudentGrade) -> dict[str, ManualMark]:
        """Return the manual marks by criterion; marks of adjusted criteria do not count."""
        if not grade.marks:
            return {}
        query = "SELECT criterion, points, grader_name, comment FROM manual_mark WHERE student = ?"
        adjusted = {row.id for row in self.rubric(grade.rubric).criteria if row.adjustment is not None}
        return {
            name: ManualMark(points_from_units(points), by, comment)
            for name, points, by, comment in self.book.rows(query, grade.id)
            if name not in adjusted
        }

    def _comments(self, grade: StudentGrade) -> dict[str, ManualComment]:
        """Return the comments of criteria without manual points."""
        query = "SELECT criterion, comment, grader_name FROM current_mark WHERE student = ? AND kind = 'comment'"
        return {name: ManualComment(comment, by) for name, comment, by in self.book.rows(query, grade.id)}

    def _grade(self, row: dict[str, Any]) -> StudentGrade:
        values = {name: row[name] for name in _PLAIN} | {name: bool(row[name]) for name in _TRUTHS}
        values |= {name: points_from_units(row[name] or 0) for name in _POINTS}
        final = None if row["final"] is None else points_from_units(row["final"])
        is_outdated = bool(row["rubric"]) and row["rubric"] != self._newest_sha256
        is_current = bool(row["rubric"]) and not is_outdated
        return StudentGrade(
            **values,
            doubtful=DoubtfulMarks(
                older=self._in_order(row["rubric"], row["older_marks"]),
                revalued=self._in_order(row["rubric"], row["revalued_marks"]),
                over=self._in_order(row["rubric"], row["over_marks"]),
                removed=tuple(sorted(row["removed_marks"].split())),
            ),
            student=Student(*(row[name] for name in STUDENT_COLUMNS)),
            is_on_roster=None if row["is_on_roster"] is None else bool(row["is_on_roster"]),
            is_outdated=is_outdated,
            has_other_parts=is_current and tuple(row["parts"].split()) != self.parts,
            files=SubmissionFiles.of(row),
            late=self._lateness(row, values["score"]),
            final=final,
        )

    def _lateness(self, row: dict[str, Any], score: Decimal) -> Lateness:
        """Return the lateness; a final mark and an excuse have no penalty."""
        if not row["rubric"]:
            return Lateness()
        times = SubmissionTimes(
            bool(row["is_late"]), row["submitted"], row["deadline"], row["extension"], row["days_late"]
        )
        times = times.extended(row["extended"] or "")
        late = lateness(self.rubric(row["rubric"]), times, score, self._deadline)
        return replace(late, points=Decimal(0)) if row["final"] is not None or row["is_excused"] else late

    def _in_order(self, rubric: str, names: str) -> tuple[str, ...]:
        """Return the criteria in a text between spaces, in the order of the rubric."""
        found = names.split()
        return tuple(row.id for row in self.rubric(rubric).criteria if row.id in found) if found else ()


def _with_marks(
    report: Report, marks: Mapping[str, ManualMark], comments: Mapping[str, ManualComment]
) -> tuple[Result, ...]:
    """Return the results with manual marks and comments, also those of criteria in parts that were not submitted."""
    results = {result.criterion.id: result for result in report.results}
    not_submitted = Outcome("skipped", "not graded: this part was not submitted")
    for name in comments.keys() & results.keys():
        results[name] = results[name]._replace(comment=comments[name])
    for criterion in report.rubric.criteria:
        if criterion.id in marks:
            result = results.get(criterion.id) or Result(criterion, not_submitted)
            results[criterion.id] = result._replace(manual_mark=marks[criterion.id], hint=None)
    return tuple(results[criterion.id] for criterion in report.rubric.criteria if criterion.id in results)
