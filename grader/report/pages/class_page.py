"""The class's page: statistics, and a table of students with links, which shows those behind each figure."""

import unicodedata
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from grader import __version__
from grader.classroom.grade_table import status_of
from grader.classroom.grades import Class, StudentGrade
from grader.classroom.statistics import ClassStatistics, CriterionFigures
from grader.report import class_summary as words
from grader.report.pages.shell import Assets, render_page
from grader.text import counted, enumerated, format_points, printable

_MAX_ATTENTION = 100  # students for one reason
_MAX_LOST = 2  # criteria in a row


class Row(NamedTuple):
    """A student in the table: the cells as text, which may be empty; `link` is the address of the student's page."""

    key: str
    name: str
    link: str
    section: str
    status: str
    grade: str
    open: str
    late: str
    lost: str


class Group(NamedTuple):
    """A group of students that the table can show: its label, their keys, and the word by which a search finds them."""

    label: str
    keys: Collection[str]
    word: str = ""


def render_class_page(
    book: Class, grades: Sequence[StudentGrade], found: ClassStatistics, links: Mapping[str, str]
) -> str:
    """Return the class's page; `links` are the addresses of students' pages by key, relative to this page."""
    rows = sorted((_row(grade, links) for grade in grades), key=_by_family_name)
    groups = {name: group for name, group in _groups(grades, found) if group.keys}
    values = {
        "version": __version__,
        "title": found.rubric.title,
        "rubric": found.rubric,
        "lines": [words.counts_line(found), *words.grade_lines(found), *words.section_lines(found)],
        "bars": _bars(found),
        "out_of": format_points(words.maximum_of(found)),
        "criteria": _criteria(found),
        "criteria_note": words.SHARE_NOTE,
        "mistakes": [(one.criterion.id, one.message, len(one.students)) for one in found.mistakes],
        "equal": [(work.students, words.what_is_same(work, book)) for work in found.equal],
        "equal_note": words.EQUAL_NOTE,
        "attention": [(str(one.reason), one.students[:_MAX_ATTENTION], len(one.students)) for one in found.attention],
        "ignored": book.marks.ignored,
        "people": {row.key: row for row in rows},
        "rows": rows,
        "columns": _columns(rows, found),
        "groups": groups,
    }
    return render_page("class.html", values, _data(rows, groups), Assets("class.css", "class.js"))


def _row(grade: StudentGrade, links: Mapping[str, str]) -> Row:
    student, late = grade.student, grade.late
    penalty = f", {format_points(late.points)}" if late.points else ""
    status = status_of(grade)
    report = grade.report if not grade.has_final else None
    lost = [one for one in report.results if one.points < one.criterion.maximum and not one.is_open] if report else []
    costliest = sorted(lost, key=lambda one: one.points - one.criterion.maximum)
    return Row(
        student.key,
        student.name or student.key,
        links.get(student.key, ""),
        student.section,
        f"{status}, final mark" if grade.final_points is not None else status,
        "" if grade.total is None else format_points(grade.total),
        format_points(grade.pending) if grade.pending else "",
        f"{counted(late.days, 'day')}{penalty}" if late.days else "",
        enumerated([one.criterion.id for one in costliest], _MAX_LOST) if costliest else "",
    )


def _by_family_name(row: Row) -> tuple[str, str, str]:
    """Return the family name, which is before a comma or the last word, then the name and the key."""
    family = row.name.partition(",")[0] if "," in row.name else (row.name.split() or [""])[-1]
    return _letters(family), _letters(row.name), row.key


def _letters(name: str) -> str:
    """Return a name without accents, so that Öz is not after Zed."""
    apart = unicodedata.normalize("NFKD", name.casefold())
    return "".join(letter for letter in apart if not unicodedata.combining(letter))


def _columns(rows: Sequence[Row], found: ClassStatistics) -> list[tuple[str, str, str]]:
    """Return the columns that are not empty: the field of a row, the heading, the class of its cells."""
    columns = (
        ("key", "id" if any(row.name != row.key for row in rows) else "", ""),
        ("section", "section", ""),
        ("status", "status", ""),
        ("grade", f"grade of {format_points(words.maximum_of(found))}", "number"),
        ("open", "needs manual grading", "number"),
        ("late", "late", ""),
        ("lost", "lost points in", "text"),
    )
    return [column for column in columns if column[1] and any(getattr(row, column[0]) for row in rows)]


_STATES: tuple[tuple[str, str, Callable[[StudentGrade], bool]], ...] = (
    ("attention", "need a person", lambda one: any(one.concerns)),
    ("pending", "need manual grading", lambda one: bool(one.pending)),
    ("late", "late", lambda one: bool(one.late.days)),
    ("final", "a final mark", lambda one: one.final_points is not None),
)


def _groups(grades: Sequence[StudentGrade], found: ClassStatistics) -> Iterator[tuple[str, Group]]:
    """Yield the groups of students on the page, each with the id that its buttons use."""
    for status in sorted({status_of(one) for one in grades}):
        yield f"status-{status}", Group(status, [one.student.key for one in grades if status_of(one) == status])
    for section in sorted({one.student.section for one in grades}):
        keys = [one.student.key for one in grades if one.student.section == section]
        yield f"section-{section}", Group(f"section {section or '(none)'}", keys)
    for name, label, is_in in _STATES:
        yield name, Group(label, [one.student.key for one in grades if is_in(one)], label)
    for tenth, keys in enumerate(found.tenths):
        yield f"grade-{tenth}", Group(f"a grade of {words.span(found, tenth)}", keys)
    lost = _lost(grades)
    for row in found.criteria:
        yield (
            f"criterion-{row.criterion.position}",
            Group(f"lost points in {row.criterion.id}", lost[row.criterion.id], row.criterion.id),
        )
    for number, mistake in enumerate(found.mistakes):
        yield f"mistake-{number}", Group(f"{mistake.criterion.id}: {mistake.message}", mistake.students)
    for number, work in enumerate(found.equal):
        yield f"same-{number}", Group("equal work", work.students)


def _lost(grades: Sequence[StudentGrade]) -> Mapping[str, list[str]]:
    """Return who lost points in each criterion."""
    lost: dict[str, list[str]] = {}
    for grade in grades:
        for one in grade.report.results if grade.report is not None else ():
            found = lost.setdefault(one.criterion.id, [])
            if not one.is_open and one.points < one.criterion.maximum:
                found.append(grade.student.key)
    return lost


def _data(rows: Sequence[Row], groups: Mapping[str, Group]) -> dict[str, Any]:
    """Return the data of the script: for each group its label, its search word, and the numbers of its rows.

    Of each number but the first, it is the difference to the one before: a large class has many of them.
    """
    numbers = {row.key: number for number, row in enumerate(rows)}
    return {
        "groups": {
            name: [printable(label), word, [after - before for before, after in pairwise((0, *shown))]]
            for name, (label, keys, word) in groups.items()
            for shown in [sorted(numbers[key] for key in keys if key in numbers)]
        }
    }


def _bars(found: ClassStatistics) -> list[dict[str, Any]]:
    most = max(map(len, found.tenths))
    return [
        {
            "group": f"grade-{tenth}",
            "span": words.span(found, tenth),
            "count": len(keys),
            "height": round(100 * len(keys) / most),
        }
        for tenth, keys in enumerate(found.tenths if most else ())
    ]


def _criteria(found: ClassStatistics) -> list[dict[str, Any]]:
    """Return the rows of the criteria, the hardest first."""
    asked = sorted(found.criteria, key=lambda row: (2.0 if row.share is None else row.share, -row.criterion.points))
    return [_criterion(row) for row in asked if row.share is not None or row.pending]


def _criterion(row: CriterionFigures) -> dict[str, Any]:
    return {
        "row": row,
        "group": f"criterion-{row.criterion.position}",
        "points": format_points(row.criterion.points),
        "share": words.percent(row.share) if row.share is not None else "",
        "width": round(100 * (row.share or 0)),
    }
