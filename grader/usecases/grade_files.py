"""Write the current grades as CSV, or into a file that an LMS exported, and say what importing it changes."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from decimal import Decimal
from functools import partial
from pathlib import Path

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.remarks import Remarks, remarks_of
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.lms.canvas import fill_gradebook
from grader.classroom.lms.feedback import FeedbackItem, feedback_html, feedback_items
from grader.classroom.lms.filling import FillOptions
from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.moodle import fill_worksheet
from grader.classroom.lms.offline import BLACKBOARD, BRIGHTSPACE, fill_offline
from grader.classroom.lms.preflight import Filled, Preflight, RowNote
from grader.classroom.tables import SIZE_LIMIT, CellValue, write_table
from grader.files.reading import read_capped
from grader.grading.criterion import Criterion
from grader.text import first_lines, people_text, printable

_STUDENT_COLUMNS = (
    "id", "name", "email", "login", "sis", "status", "score", "max_score", "pending", "late_days", "late_points",
)  # fmt: skip
# After the criteria, so that the columns before them keep their positions.
_MORE_COLUMNS = ("carried", "section", "marker", "submitted", "final_mark", "excused", "comments", "graded_by")


def grades_csv(grades: Grades) -> str:
    """Return a row for each student: grade, late penalty, points of each decided criterion, and who graded."""
    criteria = grades.criteria
    header = [*_STUDENT_COLUMNS, "total", "not_final_because", *(criterion.id for criterion in criteria)]
    return write_table([*header, *_MORE_COLUMNS], (_row(grades, grade, criteria) for grade in grades.all()))


def _row(grades: Grades, grade: StudentGrade, criteria: Sequence[Criterion]) -> list[CellValue]:
    student = grade.student
    about: list[CellValue] = [student.key, student.name, student.email, student.login, student.sis, grade.verdict]
    if grade.result is None:
        numbers: list[CellValue] = [*[None] * 5, grade.final]
    else:
        total = None if grade.is_excused else grade.total
        numbers = [grade.score, grade.out_of, grade.pending, grade.late.days, grade.late.points, total]
    points = grades.points(grade)
    decided = (points.get(criterion.id) for criterion in criteria)
    return [*about, *numbers, grade.why_not_final, *decided, *_more(grades, grade)]


def _more(grades: Grades, grade: StudentGrade) -> list[CellValue]:
    """Return the cells after the criteria."""
    remarks = remarks_of(grades, grade)
    comments = "; ".join(f"{name}: {' '.join(comment.split())}" for name, comment in remarks.comments)
    graders = remarks.graders
    return [
        ", ".join(grades.carried(grade)),
        grade.section,
        grade.marker,
        grade.submitted,
        grade.final,
        "yes" if grade.is_excused else "",
        comments,
        graders.words if graders.is_automatic or graders.is_manual else "",
    ]


FILLERS: dict[str, Callable[[bytes, Sequence[LmsGrade], FillOptions], Filled]] = {
    "canvas": fill_gradebook,
    "moodle": fill_worksheet,
    "blackboard": partial(fill_offline, form=BLACKBOARD),
    "brightspace": partial(fill_offline, form=BRIGHTSPACE),
}
_NEXT_STEP = "`grader mark STUDENT total POINTS` gives a final mark; `grader review` grades what is open"
_MAX_NAMED, _MAX_LINES, _MAX_REASONS = 3, 10, 50


def fill_lms_file(lms: str, file: Path, grades: Grades, options: FillOptions, *, pending_as_zero: bool) -> Filled:
    """Return the file of an LMS with the grades in it, and what importing it changes. Raises InputError."""
    data = read_capped(file, SIZE_LIMIT, advice="")
    found = lms_grades(grades, feedback=lms == "moodle", excuses=lms == "canvas", pending_as_zero=pending_as_zero)
    return FILLERS[lms](data, list(found), options)


def lms_grades(grades: Grades, *, feedback: bool, excuses: bool, pending_as_zero: bool) -> Iterator[LmsGrade]:
    """Yield each student's grade for an LMS. One that is not final has no total, unless pending points count as zero.

    `excuses` says whether the LMS supports excuses.
    """
    for grade in grades.all():
        reason, is_on_roster = grade.why_not_final, grade.is_on_roster is not False
        is_graded = grade.verdict in ("graded", "errored")
        is_only_pending = is_graded and not replace(grade, pending=Decimal(0)).why_not_final
        if reason and not (is_only_pending and pending_as_zero):
            is_excused = excuses and grade.is_excused
            yield LmsGrade(grade.student, None, "", reason, is_on_roster, is_excused, grade.final_is_older)
            continue
        text = _feedback(grades, grade) if feedback else ""
        yield LmsGrade(grade.student, grade.total, text, "", is_on_roster, is_older=grade.final_is_older)


def _feedback(grades: Grades, grade: StudentGrade) -> str:
    remarks, items = remarks_of(grades, grade), list[FeedbackItem]()
    out_of = sum((row.maximum for row in grades.criteria), Decimal(0))
    if grade.result is not None:
        report = grades.report(grade)
        out_of = report.max_score
        items += feedback_items(report.results)
    if grade.late.points:
        items.append(FeedbackItem("Late penalty", grade.late.points, Decimal(0), grade.late.reason))
    return feedback_html(grade.total, out_of, [*_whole(remarks), *items], remarks.graders.words)


def _whole(remarks: Remarks) -> Iterator[FeedbackItem]:
    """Yield the final mark or the comment on the whole submission."""
    if (whole := remarks.whole) is not None and whole.points is not None:
        comment = f"given instead of the sum of the criteria. {whole.comment}"
        yield FeedbackItem("Final mark", None, Decimal(0), comment)
    elif whole is not None:
        yield FeedbackItem("Comment", None, Decimal(0), whole.comment)


def preflight_lines(found: Preflight) -> Iterator[str]:
    """Yield what filling in an LMS file changes, line by line, at most 50 lines of each kind."""
    yield f"column {found.column!r}: {found.filled} filled in, {found.unchanged} already the same"
    if found.excused:
        yield printable(f"excused (EX): {len(found.excused)} ({people_text(found.excused, _MAX_NAMED)})")
    changed = [f"row {row.row}, {row.who}: was {row.was}, becomes {row.becomes}" for row in found.conflicts]
    yield from map(printable, first_lines(changed, _MAX_LINES))
    for kind, rows in (
        ("given before the newest submission:", [row._replace(row=0) for row in found.older]),
        ("without a grade:", [row._replace(row=0) for row in found.ungraded]),
        ("the LMS would refuse the grade:", found.refused),
        ("in the file, but not in the gradebook:", found.unknown),
        ("in the gradebook, but not in the file:", found.missing),
        ("ambiguous:", found.ambiguous),
        ("kept the comment that a person wrote:", found.kept_feedback),
    ):
        yield from by_reason(kind, rows)
        if kind == "without a grade:" and any(row.why != "excused" for row in rows):
            yield _NEXT_STEP
    yield from map(printable, found.warnings)


def by_reason(kind: str, rows: Iterable[RowNote], most: int = _MAX_NAMED) -> Iterator[str]:
    """Yield a line for each reason, in the order of the rows: who has it, of several how many and the first of them."""
    names: dict[str, list[str]] = {}
    for row in rows:
        names.setdefault(row.why, []).append(f"row {row.row}, {row.who}" if row.row else row.who)
    several = {why: f"{len(who)} ({people_text(who, most)})" if who[1:] else who[0] for why, who in names.items()}
    yield from map(printable, first_lines([f"{kind} {who}: {why}" for why, who in several.items()], _MAX_REASONS))
