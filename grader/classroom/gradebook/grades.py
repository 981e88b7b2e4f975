"""Everyone's current grade: what the checks have found, what people have decided, and what being late costs."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from decimal import Decimal
from functools import cache, partial
from typing import Any, NamedTuple

from grader.checks.outcome import Outcome
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.lateness import Lateness, SubmissionTimes, lateness, read_time
from grader.classroom.gradebook.result import UNITS_PER_POINT
from grader.classroom.gradebook.sources import SubmissionFiles, SubmissionSources
from grader.classroom.gradebook.stored import storable
from grader.classroom.matching import People, clues_of
from grader.classroom.students import Student
from grader.errors import InputError
from grader.grading.record import Template, from_record
from grader.grading.report import ManualMark, Report, Result
from grader.grading.rubric import Rubric
from grader.names import did_you_mean
from grader.text import printable_path

_MAX_NAMED = 5
_MAX_GUESSED = 5_000  # students among whom a name that nobody has is looked for
_QUERY = (
    "SELECT id, key, name, email, login, sis, canvas, moodle, due, extension, days_late, expected, run, result, rubric,"
    " digest, verdict, reason, score, out_of, pending, faults, marks, older_marks, over_marks, is_gone, signs, place, is_late, submitted,"
    " source, fingerprint FROM grade"
)


@dataclass(frozen=True, slots=True)
class StudentGrade:
    """One student's current grade. Without a hand-in `verdict` is `missing`, and there are no points.

    `score` has the marks by hand in it, but not what being late costs. `faults` counts criteria on which the grader failed;
    `older_marks` those marks that were given on an earlier hand-in or result, `over_marks` those that are more than their criterion is worth
    by now. `is_gone` tells that the newest run did not find the hand-in where it was, `is_outdated` that the rubric has changed since.
    """

    id: int
    student: Student
    is_expected: bool | None
    verdict: str
    reason: str
    run: int | None
    result: int | None
    rubric: str
    digest: str
    score: Decimal
    out_of: Decimal
    pending: Decimal
    faults: int
    marks: int
    older_marks: int
    over_marks: int
    is_gone: bool
    is_outdated: bool
    signs: str
    files: SubmissionFiles
    attempt: int
    earlier: tuple[str, ...]
    late: Lateness
    is_late: bool
    submitted: str

    @property
    def total(self) -> Decimal:
        """The points after what being late costs."""
        return self.score + self.late.points

    @property
    def why_not_final(self) -> str:
        """Why this is no grade to be handed on yet, in words; empty where it is one."""
        if self.verdict == "missing":
            return "nothing was handed in"
        if self.faults:
            return f"the grader failed: {self.reason}" if self.reason else "the grader failed on a criterion"
        if self.verdict == "unreadable" and self.pending:
            return f"it could not be graded: {self.reason}"
        if self.is_gone:
            return "it is not in the class folder any more"
        if self.is_outdated:
            return "it was graded by an earlier rubric only: run grader batch again"
        if self.over_marks:
            return "a mark by hand is more than its criterion is worth by now"
        if self.pending:
            words = "1 point waits" if self.pending == 1 else f"{format(self.pending.normalize(), 'f')} points wait"
            return f"{words} for a person"
        return ""


class AttentionItem(NamedTuple):
    """Who needs a look, and why."""

    who: str
    why: str


class AttentionList(NamedTuple):
    """Those who need a look, as far as they are listed, and how many there are in all."""

    listed: tuple[AttentionItem, ...]
    total: int


class Grades:
    """The current grades in a gradebook, with the rubrics that they are made by.

    Only with `answers`, for those who grade, do these hold model answers.
    """

    def __init__(self, book: Gradebook, due: datetime | None = None, *, answers: bool = False) -> None:
        self.book = book
        told = book.due() if due is None else ""
        self._due = read_time(told) if told else due
        self.rubric = cache(partial(book.rubric, answers=answers))
        self._newest_rubric: str | None = None
        self._templates: dict[tuple[str, str], Template] = {}

    def _newest(self) -> str:
        """The hash of the newest run's rubric."""
        if self._newest_rubric is None:
            rows = list(self.book.rows("SELECT rubric FROM run ORDER BY id DESC LIMIT 1"))
            self._newest_rubric = str(rows[0][0]) if rows else ""
        return self._newest_rubric

    def newest_rubric(self) -> Rubric:
        """The rubric of the newest run; raises InputError where there was none."""
        runs = self.book.runs()
        if not runs:
            raise self.book.nothing_graded()
        return self.rubric(runs[-1].rubric)

    def points(self, standing: StudentGrade) -> dict[str, Decimal]:
        """The points of each criterion that is decided, by the check or by hand."""
        if not standing.rubric:
            return {}
        criteria = self.rubric(standing.rubric).criteria
        found = {
            criterion.id: criterion.points if sign == "p" else Decimal(0)
            for criterion, sign in zip(criteria, standing.signs, strict=True)
            if sign in "pfs"
        }
        rulings = self._rulings(standing.id) if standing.marks else {}
        known = {criterion.id for criterion in criteria}
        return found | {name: ruling.points for name, ruling in rulings.items() if name in known}

    def all(self) -> Iterator[StudentGrade]:
        """Everyone, in the order of their keys."""
        for row in self.book.rows(f"{_QUERY} ORDER BY key"):
            yield self._standing(row)

    def between(self, first: str, last: str) -> Iterator[StudentGrade]:
        """Those whose keys are not before the first and not behind the last of two, in the order of their keys."""
        for row in self.book.rows(f"{_QUERY} WHERE key BETWEEN ? AND ? ORDER BY key", first, last):
            yield self._standing(row)

    def needing_attention(self, most: int) -> AttentionList:
        """Who needs a look: nothing or nothing readable was handed in, the grader failed, a grade or mark may be out of date."""
        newest = self.newest_rubric().sha256
        where = (
            "WHERE verdict <> 'graded' OR faults OR older_marks OR over_marks OR is_gone OR expected = 0 OR rubric <> ?"
        )
        ((count,),) = self.book.rows(f"SELECT count(*) FROM grade {where}", newest)
        found = (self._standing(row) for row in self.book.rows(f"{_QUERY} {where} ORDER BY key LIMIT ?", newest, most))
        return AttentionList(tuple(AttentionItem(each.student.key, _why(each, newest)) for each in found), count)

    def find(self, name: str) -> StudentGrade:
        """The one whom a key, or else a login, address, number or full name belongs to; raises InputError, also for several."""
        name = storable(name)
        found = list(self.book.rows(f"{_QUERY} WHERE key = ?", name))
        if found:
            return self._standing(found[0])
        students = list(self.book.students())
        keys = [students[index].key for index in People(map(clues_of, students)).named(name)]
        if len(keys) == 1:
            return self.find(keys[0])
        if keys:
            more = " and others" if len(keys) > _MAX_NAMED else ""
            listed = f"{', '.join(map(repr, keys[:_MAX_NAMED]))}{more}"
            raise InputError(f"{name!r} may be any of {listed}: name one by this key")
        some = students[:_MAX_GUESSED]
        guess = did_you_mean(name, {each for student in some for each in (student.key, student.login, student.name)})
        everyone = f"grader export csv --gradebook {printable_path(self.book.path)}"
        raise InputError(f"there is no {name!r} in the gradebook{guess or f'; {everyone} lists everyone'}")

    def report(self, standing: StudentGrade) -> Report:
        """The report on a student's newest hand-in, with the marks by hand in it; raises InputError where there is none."""
        if standing.result is None:
            raise InputError(f"{standing.student.key} has handed in nothing")
        rubric = self.rubric(standing.rubric)
        record, template = self.book.record(standing.result)
        if (standing.rubric, template) not in self._templates:
            self._templates[standing.rubric, template] = Template(template, rubric)
        beside = self._templates[standing.rubric, template]
        report = from_record(record, rubric, SubmissionSources(standing.files, rubric), beside)
        rulings = self._rulings(standing.id) if standing.marks else {}
        return replace(report, results=_ruled(report, rulings)) if rulings else report

    def _rulings(self, student: int) -> dict[str, ManualMark]:
        rows = self.book.rows("SELECT criterion, points, signed, comment FROM ruling WHERE student = ?", student)
        return {
            name: ManualMark(Decimal(points) / UNITS_PER_POINT, signed, comment)
            for name, points, signed, comment in rows
        }

    def _standing(self, row: tuple[Any, ...]) -> StudentGrade:
        (
            identity, *known, due, extension, days_late, expected, run, result, rubric, digest, verdict, reason, score,
            out_of, pending, faults, marks, older, over, is_gone, signs, place, is_late, submitted,
            source, mark,
        ) = row  # fmt: skip
        earned, most, waiting = (Decimal(each or 0) / UNITS_PER_POINT for each in (score, out_of, pending))
        times = SubmissionTimes(bool(is_late), str(submitted), str(due), float(extension or 0), days_late)
        paths, names, attempt, earlier = json.loads(place)
        late = lateness(self.rubric(rubric), times, earned, self._due) if rubric else Lateness()
        return StudentGrade(
            identity, Student(*known), None if expected is None else bool(expected), verdict, reason, run, result,
            rubric or "", digest or "", earned, most, waiting, faults or 0, marks, older, over, bool(is_gone), bool(rubric) and rubric != self._newest(), signs or "",
            SubmissionFiles(source or "", tuple(paths), tuple(names), known[0], mark or ""), attempt, tuple(earlier), late, bool(is_late), submitted,
        )  # fmt: skip


def _why(standing: StudentGrade, newest: str) -> str:
    reasons = []
    if standing.verdict != "graded" or standing.faults:
        reasons.append(standing.why_not_final or "it could not be graded, and was marked by hand")
    if standing.is_gone:
        reasons.append("not in the class folder any more")
    if standing.rubric and standing.rubric != newest:
        reasons.append("graded by an earlier rubric only")
    if standing.over_marks:
        reasons.append("a mark by hand is more than its criterion is worth by now")
    if standing.is_expected is False:
        reasons.append("not on the roster")
    if standing.older_marks:
        many = f"{standing.older_marks} marks by hand are" if standing.older_marks > 1 else "a mark by hand is"
        reasons.append(f"{many} from before the submission or the points changed")
    return "; ".join(reasons)


def _ruled(report: Report, rulings: dict[str, ManualMark]) -> tuple[Result, ...]:
    """The results with what people have decided, also of criteria that the check was not asked for."""
    asked = {each.criterion.id: each for each in report.results}
    not_asked = Outcome("skipped", "not graded: it was not handed in")
    results = []
    for criterion in report.rubric.criteria:
        result = asked.get(criterion.id)
        ruling = rulings.get(criterion.id)
        if result is None and ruling is not None:
            result = Result(criterion, not_asked)
        if result is not None:
            results.append(result._replace(manual_mark=ruling))
    return tuple(results)
