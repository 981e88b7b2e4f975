"""The table of students on the class's page, and the groups of students that it can show."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from grader.classroom.gradebook.statistics import ClassStatistics, Member
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.gradebook.summary import ClassSummary
from grader.classroom.typed_names import without_accents
from grader.grading.criterion import Criterion
from grader.report.class_words import VERDICTS, span
from grader.text import counted, enumerated, format_points, printable

_MAX_LOST = 2  # criteria in a row


class StudentRow(NamedTuple):
    """A student in the table: the cells as text, which may be empty; `link` is the address of the student's page."""

    key: str
    name: str
    link: str
    verdict: str
    grade: str
    status: str
    pending: str
    late: str
    lost: str


class Group(NamedTuple):
    """A group of students that the table can show: its label, their keys, and the word by which a search finds them."""

    label: str
    keys: Collection[str]
    word: str = ""


def student_rows(
    grades: Sequence[StudentGrade], summary: ClassSummary, members: Mapping[str, Member], links: Mapping[str, str]
) -> list[StudentRow]:
    """Return a row for each student, sorted by name, letters with accents as those without."""
    rows = [_row(grade, summary, members.get(grade.student.key), links) for grade in grades]
    return sorted(rows, key=lambda row: (without_accents(row.name.casefold())[0], row.key))


def _row(grade: StudentGrade, summary: ClassSummary, member: Member | None, links: Mapping[str, str]) -> StudentRow:
    key, is_graded = grade.student.key, grade.result is not None
    points = format_points(grade.total) if is_graded or grade.final is not None else ""
    maximum = "" if not is_graded or grade.out_of == summary.statistics.out_of else f" of {format_points(grade.out_of)}"
    status = grade.why_attention or VERDICTS[grade.verdict]
    if grade.final is not None:
        status += f"; final mark{f' instead of {format_points(grade.score)} points' if is_graded else ''}"
    penalty = f", {format_points(grade.late.points)}" if grade.late.points else ""
    return StudentRow(
        key,
        grade.student.name or key,
        links.get(key, ""),
        grade.verdict,
        "excused" if grade.is_excused else f"{points}{maximum}",
        status,
        format_points(grade.pending) if _needs_marks(grade) else "",
        f"{counted(grade.late.days, 'day')}{penalty}" if is_graded and grade.late.days else "",
        enumerated([criterion.id for criterion in _costliest(summary, member)], _MAX_LOST),
    )


def _costliest(summary: ClassSummary, member: Member | None) -> list[Criterion]:
    """Return the criteria in which a student lost points, the highest maximum first."""
    lost = [summary.rubric.criteria[position] for position in (member.lost if member is not None else ())]
    return sorted((row for row in lost if not row.bonus), key=lambda criterion: -criterion.points)


def _needs_marks(grade: StudentGrade) -> bool:
    return bool(grade.pending) and not grade.has_final


# Groups of students by a state of their grade: the id, the words, whether a student is in it.
_STATES: tuple[tuple[str, str, Callable[[StudentGrade], bool]], ...] = (
    ("attention", "need attention", lambda one: bool(one.why_attention)),
    ("pending", "need manual grading", _needs_marks),
    ("late", "late", lambda one: bool(one.late.days)),
    ("final", "a final mark", lambda one: one.final is not None),
    ("excused", "excused", lambda one: one.is_excused),
)


def row_groups(
    grades: Sequence[StudentGrade], summary: ClassSummary, members: Mapping[str, Member]
) -> Iterator[tuple[str, Group]]:
    """Yield the groups of students on the page, each with the id that its buttons use."""
    statistics = summary.statistics
    for verdict, words in VERDICTS.items():
        keys = [one.student.key for one in grades if one.verdict == verdict and not one.is_excused]
        yield f"status-{verdict}", Group(words, keys)
    for name, words, is_in in _STATES:
        yield name, Group(words, [one.student.key for one in grades if is_in(one)], words)
    yield from _by_figure(statistics, members)
    for number, fix in enumerate(summary.fixes):
        yield f"edit-{number}", Group(f"need the edit: {fix.action}", fix.students)
    for number, work in enumerate(summary.identical):
        yield f"same-{number}", Group("identical work", work.students)


def _by_figure(statistics: ClassStatistics, members: Mapping[str, Member]) -> Iterator[tuple[str, Group]]:
    """Yield the students behind the figures: each tenth of the grades, each criterion, each common mistake."""
    for tenth in range(len(statistics.bins)):
        keys = [key for key, member in members.items() if member.tenth == tenth]
        yield f"grade-{tenth}", Group(f"a grade of {span(statistics, tenth)}", keys)
    for row in statistics.criteria:
        criterion = row.criterion
        keys = [key for key, member in members.items() if criterion.position in member.lost]
        yield f"criterion-{criterion.position}", Group(f"lost points in {criterion.id}", keys, criterion.id)
    for number, failure in enumerate(statistics.failures):
        keys = [key for key, member in members.items() if number in member.mistakes]
        yield f"mistake-{number}", Group(f"{failure.criterion.id}: {failure.message}", keys)


def group_data(rows: Sequence[StudentRow], found: Mapping[str, Group]) -> dict[str, Any]:
    """Return the data of the script: for each group its label, its search word, and the numbers of its rows.

    Of each number but the first, it is the difference to the one before: a large class has many of them.
    """
    numbers = {row.key: number for number, row in enumerate(rows)}
    return {
        "groups": {
            name: [printable(label), word, [after - before for before, after in pairwise((0, *shown))]]
            for name, (label, keys, word) in found.items()
            for shown in [sorted(numbers[key] for key in keys)]
        }
    }


def columns(rows: Sequence[StudentRow], statistics: ClassStatistics) -> list[tuple[str, str, str]]:
    """Return the columns of the table that are not empty: the field of a row, the heading, the class of its cells."""
    found = (
        ("grade", f"grade of {format_points(statistics.out_of)}", "number"),
        ("key", "id" if any(row.name != row.key for row in rows) else "", ""),
        ("status", "status", ""),
        ("pending", "needs manual grading", "number"),
        ("late", "late", "number"),
        ("lost", "lost points in", "text"),
    )
    return [column for column in found if column[1] and any(getattr(row, column[0]) for row in rows)]
