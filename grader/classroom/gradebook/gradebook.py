"""A gradebook: the grades of a class.

They are computed from the results, the rubric, the roster and the marks of people.

The grades as a table, one row a student, are `grades.csv`, and `export csv`, which people may
change.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from functools import lru_cache
from pathlib import Path
from typing import Any

from grader import __version__
from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.text import format_points, printable_path
from grader.classroom.gradebook.student_grade import Reason, SharedResult, StudentGrade
from grader.classroom.intake.class_files import OpenedSubmission, open_class_submission
from grader.classroom.marks import gradebook_folder as names
from grader.classroom.marks.gradebook_folder import read_settings
from grader.classroom.marks.mark_import import exported_text
from grader.classroom.marks.marks import Mark, read_marks
from grader.classroom.results.results import (
    Results,
    Run,
    RunGrade,
    StoredResult,
    hash_values,
)
from grader.classroom.roster.lateness import Lateness, lateness
from grader.classroom.roster.roster import Student, read_roster
from grader.classroom.tables import SIZE_LIMIT, CellValue
from grader.files.reading import read_capped
from grader.lab.checks.outcome import Outcome, Status
from grader.lab.grading.report import ManualComment, ManualMark, Report, without_gifts
from grader.lab.rubric.criterion import DEADLINE, GRADE, Criterion
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.submission import Opening, Submission
from grader.ros.api import Absent, Unreadable

_NOT_SUBMITTED = Outcome("skipped", "not graded: this part was not submitted")
_MAX_SHARED = 10_000  # results
# The columns before and after those of the criteria; `submission` is the digest of what was graded.
_FIRST = ("id", "name", "section", "status", GRADE)
_LAST = (
    "score",
    "max_score",
    "pending",
    "late_days",
    "late_points",
    "not_final_because",
    "email",
    "submission",
)
_Cells = list[CellValue]


class Gradebook:
    """A class in a gradebook.

    Iterating yields the grade of every student, in the order of the keys.

    `batch` ends with one, and every other command on a class begins with one. It keeps nothing: the
    grades are computed again from the files of its folder.
    """

    def __init__(self, folder: Path, run: Run | None = None, answers: Path | None = None) -> None:
        """`run` is one that is not in the file yet.

        `answers` is the file of the model answers, for those who grade.
        """
        names.check_gradebook(folder)
        self.folder = folder
        self.settings = read_settings(folder)
        names.check_roster(folder, self.settings)
        rubric = folder / self.settings.rubric
        roster = folder / names.ROSTER
        self.rubric = load_rubric(rubric)
        if answers:
            from grader.lab.rubric.model_answers import load_with_answers

            self.rubric = load_with_answers(str(rubric), answers)
        self.roster = None
        if roster.exists():
            self.roster = read_roster(
                read_capped(roster, SIZE_LIMIT, advice=""), printable_path(roster)
            )
        self.results = Results(folder / names.RESULTS)
        if not run:
            self.results.check_newest()
        if not run and not self.results.runs:
            raise InputError(
                f"nothing is graded yet in {printable_path(folder)}: run `grader batch PATH`"
            )
        self.run = run or self.results.runs[-1]
        self.due = self.settings.deadline(folder)
        self._on_roster = {one.key: one for one in self.roster.students} if self.roster else {}
        others = self.results.students if not self.roster else ()
        self.keys = sorted(
            {*self._on_roster, *self.run.totals, *others}
        )  # a submission may have been assigned since
        self.marks = read_marks(folder / names.MARKS, self.keys, self.rubric)
        self._marked = {student for student, _ in (*self.marks.counting, *self.marks.comments)}
        self.is_outdated = (self.run.rubric, self.run.version) != (self.rubric.sha256, __version__)
        self._rows = {row.id: row for row in self.rubric.criteria}
        # Most results of a class are equal, and are shared: it is read in half the time.
        self._result = lru_cache(_MAX_SHARED)(self._new_result)

    def __iter__(self) -> Iterator[StudentGrade]:
        return map(self._grade, self.keys, self.results.each(self.keys))

    @property
    def roots(self) -> Sequence[Path]:
        """The class folders and zips."""
        return self.settings.roots(self.folder)

    @property
    def criteria(self) -> Sequence[Criterion]:
        """The criteria of the graded parts."""
        return tuple(
            row for row in self.rubric.criteria if row.part in (self.settings.parts or {row.part})
        )

    @property
    def maximum(self) -> Decimal:
        """The most points that are no extra credit."""
        return sum((row.maximum for row in self.criteria), Decimal(0))

    def run_with(self, grades: Mapping[str, RunGrade]) -> Run:
        """Return the newest run with these grades."""
        totals = {key: grades[key].total if key in grades else None for key in self.run.totals}
        others = {}
        details = {}
        for key, (total, *more) in grades.items():
            if key not in totals:
                if total is None:
                    continue
                others[key] = total
            named = zip(RunGrade._fields[1:], more, strict=True)
            if present := {name: value for name, value in named if value}:
                details[key] = present
        return self.run._replace(
            totals=totals,
            others=others,
            details=details,
            maximum=format_points(self.maximum),
            due=self.due.isoformat() if self.due is not None else "",
        )

    def run_grade(self, grade: StudentGrade) -> RunGrade:
        """Return a grade as a run records it."""
        student = grade.student
        late = grade.late
        pending = ""
        marks = {
            one.criterion.id: format_points(one.manual_mark.points)
            for one in grade.results
            if one.manual_mark
        }
        if grade.final and grade.has_final:
            marks[GRADE] = grade.final.value
        if grade.obstacle is Reason.PENDING:
            pending = format_points(grade.pending)
        return RunGrade(
            grade.total_text or None,
            grade.obstacle.name if grade.obstacle else "",
            pending,
            late.days,
            format_points(late.points) if late.points else "",
            self._write_deadline(student),
            marks,
        )

    def _write_deadline(self, student: Student) -> str:
        """Return a student's own deadline as a run records it; empty without one."""
        own_deadline = self.marks.counting.get((student.key, DEADLINE))
        if own_deadline:
            return own_deadline.value
        if student.extension_days:
            return f"{student.due} extension {student.extension_days:g}".lstrip()
        return student.due

    def grade(self, key: str) -> StudentGrade:
        """Return the grade of the student with a key."""
        return self._grade(key, self.results.of(key))

    def student(self, key: str, stored: StoredResult | None) -> Student:
        """Return a student as the roster has it.

        It is completed by the LMS ids in the names of the submission.
        """
        person: dict[str, Any] = dict(stored.person) if stored else {}
        listed = self._on_roster.get(key)
        if not listed:
            return Student(key, **person, is_on_roster=not self.roster)
        return listed._replace(
            **{name: value for name, value in person.items() if not getattr(listed, name)}
        )

    def report(self, stored: StoredResult) -> Report:
        """Return the points of a result: outcomes without places, values and hints."""
        unread = stored.reason if stored.verdict == "unreadable" else ""
        why = stored.reason if stored.verdict == "errored" else ""
        if unread:
            why = f"{unread}; needs manual grading"
        entries = ((name, stored.results[name]) for name in self._rows if name in stored.results)
        results = (
            self._result(name, status, words or why, *more)
            for name, (_, status, words, *more) in entries
        )
        urdf = Unreadable("", unread) if unread else Absent()
        submission = Submission(stored.student, urdf, is_single=False)
        return Report(submission, self.rubric, stored.parts, without_gifts(results, submission))

    def reopened(self, stored: StoredResult) -> Submission | None:
        """Return a submission as it was graded.

        It is None if it has moved or changed since, or cannot be read.
        """
        settings = self.settings
        try:
            opened = self._opened(stored)
            if not opened:
                return None
            known = Opening(
                0, settings.arguments, stored.no_documents, converted=self.results.texts(stored)
            )
            return opened.submission(self.rubric, known)
        except InputError:
            return None

    def is_unchanged(self, stored: StoredResult) -> bool:
        """Return whether a submission is still there as it was graded."""
        try:
            return self._opened(stored) is not None
        except InputError:
            return False

    def _opened(self, stored: StoredResult) -> OpenedSubmission | None:
        """Open a submission that is as it was graded. Raises InputError."""
        settings = self.settings
        roots = self.roots
        if stored.root >= len(roots) or not stored.paths:
            return None
        root = str(roots[stored.root].resolve())
        opened = open_class_submission(
            root, stored.paths, stored.names, stored.student, settings.max_size
        )
        return opened if hash_values(opened.digest) == stored.digest else None

    def _new_result(
        self, name: str, status: Status, words: str, carried: str, off: float | None = None
    ) -> SharedResult:
        return SharedResult(self._rows[name], Outcome(status, words, off), carried=carried)

    def _grade(self, key: str, stored: StoredResult | None) -> StudentGrade:
        whole = (key, GRADE)
        student = self.student(key, stored)
        final = self.marks.counting.get(whole) or self.marks.comments.get(whole)
        known = set()
        if not student.is_on_roster:
            known.add(Reason.NOT_ON_ROSTER)
        if key in self.run.unclear:
            known.add(Reason.UNCLEAR)
        if not stored:
            if key in self.run.totals:
                known.add(Reason.DAMAGED)
            nothing = Report(
                Submission(key, Absent(), is_single=False), self.rubric, self.settings.parts, ()
            )
            return StudentGrade(student, None, nothing, final=final, known=frozenset(known))
        if key not in self.run.totals:
            known.add(Reason.GONE)
        if self.is_outdated or stored.context != self.run.context:
            known.add(Reason.OUTDATED)
        report, older = self.with_marks(self.report(stored), stored)
        if final and _is_older(final, stored):
            older = (*older, GRADE)
        late = self._lateness(student, stored, report)
        if final and final.value:
            late = Lateness(late.days, reason=late.reason)
        return StudentGrade(student, stored, report, late, final, older, frozenset(known))

    def _lateness(self, student: Student, stored: StoredResult, report: Report) -> Lateness:
        """Return the lateness; what the roster says counts before what the LMS says."""
        own_deadline = self.marks.counting.get((stored.student, DEADLINE))
        times = student._replace(
            is_late=stored.is_late if student.is_late is None else student.is_late,
            submitted=student.submitted or stored.submitted,
            days_late=0.0
            if student.is_late is False and student.days_late is None
            else student.days_late,
        )
        return lateness(
            self.rubric,
            times,
            report.score,
            self.due,
            own_deadline.value if own_deadline else "",
        )

    def with_marks(self, report: Report, stored: StoredResult) -> tuple[Report, Strings]:
        """Return a report with marks and comments, and the criteria that were marked early.

        These were marked before the submission changed.
        """
        if stored.student not in self._marked:
            return report, ()
        results = {one.criterion.id: one for one in report.results}
        older = []
        for name, row in self._rows.items():
            key = stored.student, name
            mark = self.marks.counting.get(key)
            comment = self.marks.comments.get(key)
            if comment and name in results:
                results[name] = results[name]._replace(
                    comment=ManualComment(comment.comment, comment.by)
                )
            if not mark or mark.points is None or row.adjustment:
                continue
            given = ManualMark(mark.points, mark.by, mark.comment)
            result = results.get(name) or SharedResult(row, _NOT_SUBMITTED)
            results[name] = result._replace(manual_mark=given, hint=None, comment=None)
            if _is_older(mark, stored):
                older.append(name)
        return report._replace(
            results=tuple(results[name] for name in self._rows if name in results)
        ), tuple(older)


def _is_older(mark: Mark, stored: StoredResult) -> bool:
    return bool(mark.submission) and mark.submission != stored.digest


def grade_table(
    book: Gradebook, grades: Iterable[StudentGrade], *, is_exported: bool = False
) -> tuple[list[str], Iterator[_Cells]]:
    """Return the header, and the rows of grades; what is not decided is empty.

    A table that `is_exported` has a column by which `mark --import` knows which cells a person
    changed.
    """
    header = [*_FIRST, *(row.id for row in book.rubric.criteria), *_LAST]
    if is_exported:
        header.append("exported")
    return header, (_table_row(book, one, is_exported) for one in grades)


def list_points(book: Gradebook, grade: StudentGrade) -> dict[str, str]:
    """Return the cells of a student that `mark --import` takes for marks.

    They are by criterion and for the grade.
    """
    points = dict.fromkeys((row.id for row in book.rubric.criteria), "")
    if grade.stored and not grade.is_excused:
        points |= {one.criterion.id: one.cell for one in grade.results}
    return {**points, GRADE: grade.total_text}


def _table_row(book: Gradebook, grade: StudentGrade, is_exported: bool) -> _Cells:
    student = grade.student
    late = grade.late
    points = list_points(book, grade)
    numbers: _Cells = [None] * 5
    digest = ""
    if grade.stored:
        digest = grade.stored.digest
        if not grade.is_excused:
            numbers = [grade.score, grade.report.max_score, grade.pending, late.days, late.points]
    row: _Cells = [student.key, student.name, student.section, grade.status]
    for name in (GRADE, *(criterion.id for criterion in book.rubric.criteria)):
        row.append(Decimal(points[name]) if points[name] else None)
    row += [*numbers, grade.why_open, student.email, digest]
    if is_exported:
        return [*row, exported_text(points)]
    return row
