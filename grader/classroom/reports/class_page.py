"""The class's page: statistics, and a table of students with links, which shows those behind each
figure.
"""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from grader import __version__
from grader.base.text import enumerated, format_points, printable
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.statistics import ClassStatistics
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.reports import class_words as words
from grader.report.pages.shell import Assets, render_page

_ASSETS = Assets("class.css", "class.js", folder=Path(__file__).parent / "files")
_MAX_ATTENTION = 100  # students for one reason
_MAX_LOST = 2  # criteria in a row
_MAX_HEIGHT, _CUT_AT = 3, 1.5  # of a bar of the second highest: a higher one is cut


class _StudentRow(NamedTuple):
    """A student in the table: the cells as text, which may be empty; `link` is the address of the
    student's page.
    """

    key: str
    name: str
    link: str
    section: str
    status: str
    grade: str
    open: str
    late: str
    lost: str


class _Group(NamedTuple):
    """A group of students that the table can show: its label, their keys, and the word by which a
    search finds them.
    """

    label: str
    keys: Collection[str]
    word: str = ""


def render_class_page(
    book: Gradebook,
    grades: Sequence[StudentGrade],
    found: ClassStatistics,
    links: Mapping[str, str],
) -> str:
    """Return the class's page; `links` are the addresses of students' pages by key, relative to
    this page.
    """
    rows = sorted(
        (_row(grade, links) for grade in grades),
        key=lambda row: words.family_name_order(row.name, row.key),
    )
    groups = {name: group for name, group in _groups(grades, found).items() if group.keys}
    numbers = {row.key: number for number, row in enumerate(rows)}
    bars, cut = _bars(found)
    shown = {
        name: [printable(label), word, [numbers[key] for key in keys]]
        for name, (label, keys, word) in groups.items()
    }
    values = {
        "version": __version__,
        "title": found.rubric.title,
        "rubric": found.rubric,
        "lines": [*words.head_lines(found)],
        "bars": bars,
        "cut": cut,
        "out_of": format_points(found.maximum),
        "criteria": _criteria(found),
        "criteria_note": words.SHARE_NOTE,
        "mistakes": [(one.criterion, one.message, len(one.students)) for one in found.mistakes],
        "equal": found.equal,
        "equal_note": words.EQUAL_NOTE,
        "attention": [
            (str(reason), those[:_MAX_ATTENTION], len(those))
            for reason, those in found.attention.items()
        ],
        "ignored": book.marks.ignored,
        "people": {row.key: row for row in rows},
        "rows": rows,
        "columns": _columns(rows, found),
        "groups": groups,
    }
    return render_page("class.html", values, {"groups": shown}, _ASSETS)


def _bars(found: ClassStatistics) -> tuple[list[tuple[str, str, int, int, bool]], str]:
    """Return the bars of the grades: the group, the grades, the students, the height in percent,
    and whether it is cut.

    The highest one is cut, as the text that is returned with them says, where all others would be
    flat.
    """
    counts = [*map(len, found.tenths)]
    second, most = sorted(counts)[-2:]
    is_flat = 0 < _MAX_HEIGHT * second < most
    scale = _CUT_AT * second if is_flat else max(most, 1)
    bars = [
        (
            f"grade-{at}",
            words.span(found, at),
            count,
            min(100, round(100 * count / scale)),
            is_flat and count == most,
        )
        for at, count in enumerate(counts if most else ())
    ]
    highest = words.span(found, counts.index(most))
    return (
        bars,
        f"The bar of {highest} is cut: it would be {most / scale:.1f} times as high."
        if is_flat
        else "",
    )


def _row(grade: StudentGrade, links: Mapping[str, str]) -> _StudentRow:
    student, lost = grade.student, [name for _, name in grade.losses]
    return _StudentRow(
        student.key,
        student.name or student.key,
        links.get(student.key, ""),
        student.section,
        f"{grade.status}, final mark" if grade.final_points is not None else grade.status,
        grade.total_text,
        format_points(grade.pending) if grade.pending else "",
        words.late_text(grade),
        enumerated(lost, _MAX_LOST) if lost else "",
    )


def _columns(rows: Sequence[_StudentRow], found: ClassStatistics) -> list[tuple[str, str, str]]:
    """Return the columns that are not empty: the field of a row, the heading, the class of its
    cells.
    """
    columns = (
        ("key", "id" if any(row.name != row.key for row in rows) else "", ""),
        ("section", "section", ""),
        ("status", "status", ""),
        ("grade", f"grade of {format_points(found.maximum)}", "number"),
        ("open", "needs manual grading", "number"),
        ("late", "late", "text"),
        ("lost", "lost points in", "text"),
    )
    return [
        column for column in columns if column[1] and any(getattr(row, column[0]) for row in rows)
    ]


def _filters_of(grade: StudentGrade, *, has_sections: bool) -> Iterator[tuple[int, str]]:
    """Yield the filters that show a student: the place of each among the others, and its label."""
    yield 0, grade.status
    if has_sections:
        yield 1, f"section {grade.student.section or '(none)'}"
    if grade.concerns:
        yield 2, "needs attention"
    if grade.pending:
        yield 3, "needs manual grading"
    if grade.late.days and not grade.has_final:
        yield 4, "late"
    if grade.final_points is not None:
        yield 5, "a final mark"


def _groups(grades: Sequence[StudentGrade], found: ClassStatistics) -> dict[str, _Group]:
    """Return the groups of students on the page by the id that its buttons use; those at the top
    are filters.
    """
    keys, lost = defaultdict[tuple[int, str], list[str]](list), defaultdict[str, list[str]](list)
    has_sections = len({one.student.section for one in grades}) > 1
    for one in grades:
        for place in _filters_of(one, has_sections=has_sections):
            keys[place].append(one.student.key)
        for _, name in one.losses:
            lost[name].append(one.student.key)
    filters = {
        f"filter-{label}": _Group(label, those, label) for (_, label), those in sorted(keys.items())
    }
    tenths = {
        f"grade-{at}": _Group(f"a grade of {words.span(found, at)}", of)
        for at, of in enumerate(found.tenths)
    }
    rows = (row.criterion for row in found.criteria)
    criteria = {
        f"criterion-{row.id}": _Group(f"lost points in {row.id}", lost[row.id], row.id)
        for row in rows
    }
    mistakes = {
        f"mistake-{at}": _Group(f"{one.criterion}: {one.message}", one.students)
        for at, one in enumerate(found.mistakes)
    }
    same = {
        f"same-{at}": _Group("equal work", work.students) for at, work in enumerate(found.equal)
    }
    return {**filters, **tenths, **criteria, **mistakes, **same}


def _criteria(found: ClassStatistics) -> list[dict[str, Any]]:
    """Return the rows of the criteria, the hardest first."""
    asked = sorted(
        found.criteria,
        key=lambda row: (2.0 if row.share is None else row.share, -row.criterion.points),
    )
    return [
        {
            "row": row,
            "group": f"criterion-{row.criterion.id}",
            "points": format_points(row.criterion.points),
            "share": words.percent(row.share) if row.share is not None else "",
            "width": round(100 * (row.share or 0)),
        }
        for row in asked
        if row.share is not None or row.counts["pending"]
    ]
