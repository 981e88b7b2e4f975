"""The current grades in a gradebook: look up students, list those that need attention, build their reports."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from datetime import datetime
from decimal import Decimal
from functools import cache, cached_property, partial
from typing import Any

from grader.checks.outcome import Outcome
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.lateness import Lateness, SubmissionTimes, lateness, read_time
from grader.classroom.gradebook.result import SETTLED, UNITS_PER_POINT, criterion_points, graded_on
from grader.classroom.gradebook.stored import STUDENT_COLUMNS, storable
from grader.classroom.gradebook.student_grade import StudentGrade, SubmissionFiles, SubmissionSources
from grader.classroom.students import Student
from grader.classroom.typed_names import find_typed
from grader.errors import InputError
from grader.grading.criterion import Criterion
from grader.grading.hints.record import with_hints
from grader.grading.record import Template, from_record
from grader.grading.report import ManualComment, ManualMark, Report, Result
from grader.grading.rubric import Rubric
from grader.text import shell_quoted

_COUNTS = ("id", "run", "result", "faults", "marks")  # columns that are taken as they are
_NAMES = ("older_marks", "revalued_marks", "over_marks")  # of criteria, between spaces
_REMOVED = "removed_marks"  # of criteria that are not in the rubric
_POINTS = ("score", "out_of", "pending")
_TEXTS = ("rubric", "verdict", "reason", "statuses", "submitted", "section", "marker")
_TRUTHS = ("is_gone", "is_late", "is_excused", "final_is_older")
_OTHERS = (
    "deadline",
    "extension",
    "days_late",
    "is_on_roster",
    "final",
    "files",
    "source",
    "fingerprint",
    "digest",
)
_COLUMNS = (*_COUNTS, *_NAMES, _REMOVED, *_POINTS, *_TEXTS, *_TRUTHS, *_OTHERS, *STUDENT_COLUMNS)
_QUERY = f"SELECT {', '.join(_COLUMNS)} FROM grade"


class Grades:
    """The current grades in a gradebook. Rubrics contain model answers only with `answers`, for those who grade."""

    def __init__(self, book: Gradebook, deadline: datetime | None = None, *, answers: bool = False) -> None:
        self.book = book
        newest = book.newest_run()
        self._newest_sha256 = newest.rubric if newest is not None else ""
        self._deadline = read_time(newest.deadline) if newest and newest.deadline and deadline is None else deadline
        self.rubric = cache(partial(book.rubric, answers=answers))
        self._parts_of = cache(lambda rubric, statuses: graded_on(self.rubric(rubric), statuses))
        self._template = cache(lambda rubric, text: Template(text, self.rubric(rubric)))

    def newest_rubric(self) -> Rubric:
        """Return the rubric of the newest run; raises InputError if there is no run."""
        run = self.book.newest_run()
        if run is None:
            raise self.book.nothing_graded()
        return self.rubric(run.rubric)

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """The parts that the newest run has graded every submission on."""
        rubric = self.newest_rubric()
        newest = "SELECT statuses FROM grade WHERE rubric = ? AND result IS NOT NULL ORDER BY result DESC LIMIT 1"
        for (statuses,) in list(self.book.rows(newest, rubric.sha256)):
            return graded_on(rubric, statuses)
        return tuple(part.id for part in rubric.parts)

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """The criteria of these parts."""
        return tuple(row for row in self.newest_rubric().criteria if row.part in self.parts)

    @property
    def has_deadline(self) -> bool:
        """Return whether late submissions lose points after a deadline of the class."""
        policy = self.newest_rubric().late
        return policy is not None and (self._deadline or policy.due) is not None

    def points(self, grade: StudentGrade) -> dict[str, Decimal]:
        """Return the points of each criterion that has a result or a manual mark."""
        if not grade.rubric:
            return {}
        marks = {name: mark.points for name, mark in self._manual_marks(grade).items()}
        points = criterion_points(self.rubric(grade.rubric), grade.statuses, marks)
        return {name: value for name, value in points.items() if value is not None}

    def carried(self, grade: StudentGrade) -> list[str]:
        """Return the criteria that failed because of an earlier mistake alone, and whose points are given."""
        if SETTLED not in grade.statuses:
            return []
        marks, criteria = self._manual_marks(grade), self.rubric(grade.rubric).criteria
        settled = (row for row, status in zip(criteria, grade.statuses, strict=True) if status == SETTLED)
        return [row.id for row in settled if row.adjustment is None and row.id not in marks]

    def all(self) -> Iterator[StudentGrade]:
        """Yield all grades, in the order of the keys."""
        return self._select("ORDER BY key")

    def between(self, first: str, last: str) -> Iterator[StudentGrade]:
        """Yield the grades with keys from `first` to `last`, both included, in the order of the keys."""
        return self._select("WHERE key BETWEEN ? AND ? ORDER BY key", first, last)

    def where(self, condition: str, *values: Any) -> Iterator[StudentGrade]:
        """Yield the grades that meet a condition on the view `grade`, in the order of the keys."""
        return self._select(f"WHERE {condition} ORDER BY key", *values)

    def find(self, name: str) -> StudentGrade:
        """Return the grade of the student with this key, else of the only one whom a typed name may mean; raises InputError."""
        name = storable(name)
        for grade in list(self._select("WHERE key = ?", name)):
            return grade
        advice = f"; `grader export csv --gradebook {shell_quoted(self.book.shown)}` lists all students"
        return self.find(find_typed(list(self.book.students()), name, advice).key)

    def report(self, grade: StudentGrade) -> Report:
        """Return the report on a student's newest submission with the manual marks; raises InputError without a submission."""
        if grade.result is None:
            raise InputError(f"{grade.student.key} has submitted nothing")
        rubric = self.rubric(grade.rubric)
        record, template = self.book.record(grade.result)
        sources = SubmissionSources(grade.files, rubric)
        report = from_record(record, rubric, sources, self._template(grade.rubric, template))
        hints = self.book.first("SELECT hints FROM hint WHERE result = ?", grade.result)
        report = with_hints(report, hints[0]) if hints is not None else report
        results = _with_marks(report, self._manual_marks(grade), self._comments(grade))
        return replace(report, results=results)

    def _manual_marks(self, grade: StudentGrade) -> dict[str, ManualMark]:
        """Return the manual marks by criterion; marks of adjusted criteria do not count."""
        if not grade.marks:
            return {}
        query = "SELECT criterion, points, grader_name, comment FROM manual_mark WHERE student = ?"
        adjusted = {row.id for row in self.rubric(grade.rubric).criteria if row.adjustment is not None}
        return {
            name: ManualMark(Decimal(points) / UNITS_PER_POINT, by, comment)
            for name, points, by, comment in self.book.rows(query, grade.id)
            if name not in adjusted
        }

    def _comments(self, grade: StudentGrade) -> dict[str, ManualComment]:
        """Return the comments of criteria without manual points."""
        query = "SELECT criterion, comment, grader_name FROM current_mark WHERE student = ? AND kind = 'comment'"
        return {name: ManualComment(comment, by) for name, comment, by in self.book.rows(query, grade.id)}

    def _in_order(self, rubric: str, names: str) -> tuple[str, ...]:
        """Return the criteria in a text between spaces, in the order of the rubric."""
        found = names.split()
        return tuple(row.id for row in self.rubric(rubric).criteria if row.id in found) if found else ()

    def _select(self, condition: str, *values: Any) -> Iterator[StudentGrade]:
        for row in self.book.rows(f"{_QUERY} {condition}", *values):
            yield self._grade(dict(zip(_COLUMNS, row, strict=True)))

    def _grade(self, values: dict[str, Any]) -> StudentGrade:
        counts = {name: values[name] for name in _COUNTS}
        marked = {name: self._in_order(values["rubric"], values[name] or "") for name in _NAMES}
        points = {name: Decimal(values[name] or 0) / UNITS_PER_POINT for name in _POINTS}
        texts = {name: values[name] or "" for name in _TEXTS}
        truths = {name: bool(values[name]) for name in _TRUTHS}
        rubric, is_on_roster = texts["rubric"], values["is_on_roster"]
        final = None if values["final"] is None else Decimal(values["final"]) / UNITS_PER_POINT
        extension = float(values["extension"] or 0)
        times = SubmissionTimes(
            truths["is_late"], texts["submitted"], values["deadline"], extension, values["days_late"]
        )
        paths, names, attempt, earlier = json.loads(values["files"])
        is_outdated = bool(rubric) and rubric != self._newest_sha256
        fingerprint, digest = values["fingerprint"] or "", values["digest"] or ""
        late = lateness(self.rubric(rubric), times, points["score"], self._deadline) if rubric else Lateness()
        if final is not None or truths["is_excused"]:
            late = replace(late, points=Decimal(0))
        return StudentGrade(
            **{**counts, **marked, **points, **texts, **truths, "faults": counts["faults"] or 0},
            removed_marks=tuple(sorted(values[_REMOVED].split())),
            student=Student(*(values[name] for name in STUDENT_COLUMNS)),
            is_on_roster=None if is_on_roster is None else bool(is_on_roster),
            is_outdated=is_outdated,
            has_other_parts=bool(rubric)
            and not is_outdated
            and self._parts_of(rubric, texts["statuses"]) != self.parts,
            files=SubmissionFiles(
                values["source"] or "", tuple(paths), tuple(names), values["key"], fingerprint, digest
            ),
            attempt=attempt,
            earlier=tuple(earlier),
            late=late,
            final=final,
        )


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
            results[criterion.id] = result._replace(manual_mark=marks[criterion.id], hints=())
    return tuple(results[criterion.id] for criterion in report.rubric.criteria if criterion.id in results)
