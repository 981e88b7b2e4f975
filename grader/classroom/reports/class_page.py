"""The class's page: statistics, and a table of students with links.

The table shows those behind each figure.
"""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from grader import __version__
from grader.base.grouping import StringsByName
from grader.base.text import enumerated, format_points, printable
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.statistics import ClassStatistics
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.reports import class_words as words
from grader.report.drawing.still import HEIGHT, WIDTH, Still
from grader.report.pages.shell import Assets, render_page

_ASSETS = Assets("class.css", "sheet.js class.js", folder=Path(__file__).parent / "files")
_MAX_ATTENTION = 100  # students for one reason
_MAX_STILLS = 200  # different pictures of robots
_MAX_LOST = 2  # criteria in a row
_MAX_HEIGHT, _CUT_AT = 3, 1.5  # of a bar of the second highest: a higher one is cut


class _StudentRow(NamedTuple):
    """A student in the table: the cells as text, which may be empty.

    `link` is the address of the student's page.
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
    """A group of students that the table can show.

    It has its label, their keys, and the word by which a search finds them.
    """

    label: str
    keys: Collection[str]
    word: str = ""


def render_class_page(
    book: Gradebook,
    grades: Sequence[StudentGrade],
    figures: ClassStatistics,
    links: StringsByName,
    stills: Mapping[str, Still],
) -> str:
    """Return the class's page.

    `links` are the addresses of students' pages by key, relative to this page, and `stills`
    small pictures of their robots.
    """
    rows = [_row(grade, links) for grade in grades]
    rows.sort(key=lambda row: words.family_name_order(row.name, row.key))
    numbers = {row.key: number for number, row in enumerate(rows)}
    groups = {}
    shown = {}
    for name, group in _groups(grades, figures):
        if group.keys:
            groups[name] = group
            members = [numbers[key] for key in group.keys]
            shown[name] = [printable(group.label), group.word, members]
    values = {
        **_figures(figures),
        "version": __version__,
        "ignored": book.marks.ignored,
        "people": {row.key: row for row in rows},
        "rows": rows,
        "columns": _columns(rows, figures),
        "groups": groups,
    }
    distinct: dict[Still, int] = {}
    robots = []  # of each row the number of its picture, -1 without one
    for row in rows:
        still = stills.get(row.key, ())
        if still and len(distinct) < _MAX_STILLS:
            distinct.setdefault(still, len(distinct))
        robots.append(distinct.get(still, -1))
    values["has_stills"] = bool(distinct)
    data = {"groups": shown, "robots": robots, "stills": list(distinct), "size": [WIDTH, HEIGHT]}
    return render_page("class.html", values, data, _ASSETS)


def _figures(figures: ClassStatistics) -> dict[str, Any]:
    """Return what the page shows of the statistics."""
    bars, cut = _bars(figures)
    attention = [
        (str(reason), students[:_MAX_ATTENTION], len(students))
        for reason, students in figures.attention.items()
    ]
    mistakes = [
        (mistake.criterion, mistake.message, len(mistake.students))
        for mistake in figures.common_mistakes
    ]
    return {
        "title": figures.rubric.title,
        "rubric": figures.rubric,
        "lines": list(words.head_lines(figures)),
        "bars": bars,
        "cut": cut,
        "out_of": format_points(figures.maximum),
        "criteria": _criteria(figures),
        "criteria_note": words.SHARE_NOTE,
        "mistakes": mistakes,
        "equal": figures.equal,
        "equal_note": words.EQUAL_NOTE,
        "attention": attention,
    }


def _bars(figures: ClassStatistics) -> tuple[list[tuple[str, str, int, int, bool]], str]:
    """Return the bars of the grades.

    Each has the group, the grades, the students, the height in percent, and whether it is cut.

    The highest one is cut, as the text that is returned with them says, where all others would be
    flat.
    """
    counts = [len(students) for students in figures.tenths]
    second, most = sorted(counts)[-2:]
    if not most:
        return [], ""
    is_flat = 0 < _MAX_HEIGHT * second < most
    scale = _CUT_AT * second if is_flat else most
    bars = []
    for at, count in enumerate(counts):
        height = min(100, round(100 * count / scale))
        is_cut = is_flat and count == most
        bars.append((f"grade-{at}", words.span(figures, at), count, height, is_cut))
    if not is_flat:
        return bars, ""
    highest = words.span(figures, counts.index(most))
    return bars, f"The bar of {highest} is cut: it would be {most / scale:.1f} times as high."


def _row(grade: StudentGrade, links: StringsByName) -> _StudentRow:
    student = grade.student
    lost = [name for _, name in grade.losses]
    status = f"{grade.status}, final mark" if grade.final_points is not None else grade.status
    return _StudentRow(
        student.key,
        student.shown_name,
        links.get(student.key, ""),
        student.section,
        status,
        grade.total_text,
        format_points(grade.pending) if grade.pending else "",
        words.late_text(grade),
        enumerated(lost, _MAX_LOST) if lost else "",
    )


def _columns(rows: Sequence[_StudentRow], figures: ClassStatistics) -> list[tuple[str, str, str]]:
    """Return the columns that are not empty.

    Each is the field of a row, the heading, and the class of its cells.
    """
    columns = [
        ("section", "section", ""),
        ("status", "status", ""),
        ("grade", f"grade of {format_points(figures.maximum)}", "number"),
        ("open", "needs manual grading", "number"),
        ("late", "late", "text"),
        ("lost", "lost points in", "text"),
    ]
    if any(row.name != row.key for row in rows):
        columns.insert(0, ("key", "id", ""))
    filled = {field for row in rows for field, cell in row._asdict().items() if cell}
    return [column for column in columns if column[0] in filled]


def _list_filters(grade: StudentGrade, *, has_sections: bool) -> Iterator[tuple[int, str]]:
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


def _groups(
    grades: Sequence[StudentGrade], figures: ClassStatistics
) -> Iterator[tuple[str, _Group]]:
    """Yield the groups of students on the page with the id that its buttons use.

    The first ones are the filters at the top.
    """
    filtered = defaultdict(list)
    lost = defaultdict(list)
    has_sections = len({grade.student.section for grade in grades}) > 1
    for grade in grades:
        key = grade.student.key
        for place in _list_filters(grade, has_sections=has_sections):
            filtered[place].append(key)
        for _, name in grade.losses:
            lost[name].append(key)
    for (_, label), keys in sorted(filtered.items()):
        yield f"filter-{label}", _Group(label, keys, label)
    for at, students in enumerate(figures.tenths):
        yield f"grade-{at}", _Group(f"a grade of {words.span(figures, at)}", students)
    for row in figures.criteria:
        name = row.criterion.id
        yield f"criterion-{name}", _Group(f"lost points in {name}", lost[name], name)
    for at, mistake in enumerate(figures.common_mistakes):
        label = f"{mistake.criterion}: {mistake.message}"
        yield f"mistake-{at}", _Group(label, mistake.students)
    for at, work in enumerate(figures.equal):
        yield f"same-{at}", _Group("equal work", work.students)


def _criteria(figures: ClassStatistics) -> list[dict[str, Any]]:
    """Return the rows of the criteria, the hardest first."""
    asked = [row for row in figures.criteria if row.share is not None or row.counts["pending"]]
    asked.sort(key=lambda row: (2.0 if row.share is None else row.share, -row.criterion.points))
    return [
        {
            "row": row,
            "group": f"criterion-{row.criterion.id}",
            "points": format_points(row.criterion.points),
            "share": words.percent(row.share) if row.share is not None else "",
            "width": round(100 * (row.share or 0)),
        }
        for row in asked
    ]
