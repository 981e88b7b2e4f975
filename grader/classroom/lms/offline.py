"""Fill grade files of Blackboard Learn and Brightspace (D2L), which differ only in how they name columns and students.

Blackboard, "Work offline with grade data" (help.blackboard.com): the file is tab-separated in UTF-16, or
comma-separated. `Username` identifies the student. The number after the last `|` of a header identifies the column, as
in `Lab 6 [Total Pts: 100 Score] |123456`; totals have `up to 100`. Comments (`Grading Notes`, `Feedback to Learner`) do
not change.

Brightspace, "Importing grades" (community.d2l.com, article 3538): `OrgDefinedId` or `Username` identifies the student,
and the header the grade item: `Lab 6 Points Grade <Numeric MaxPoints:100>`. The last column `End-of-Line Indicator` has
`#` in each row, and an export has `#` before ids. Points above the maximum are reduced to it, unless the item can
exceed it.

Neither documents what an empty cell does, and a file may contain some students only. So rows without a grade are
removed.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal

from grader.classroom.lms.assignments import GradeColumn, assignment_warnings, find_assignment
from grader.classroom.lms.filling import Filling, FillOptions, LmsStudent, check_maximum, first_of_each
from grader.classroom.lms.grades import LmsGrade, read_lms_points
from grader.classroom.lms.preflight import Filled
from grader.classroom.students import Student
from grader.classroom.tables import TableRow, read_table
from grader.errors import InputError
from grader.text import enumerated, format_points


@dataclass(frozen=True, slots=True)
class OfflineFormat:
    """The columns of a file: those that identify students, and the pattern of an assignment's header.

    The pattern has the groups `title` and `maximum`, and perhaps `number`. Headers in `kept` are not another
    assignment's.
    """

    lms: str
    example: str
    header: re.Pattern[str]
    login: str
    sis: str
    email: str
    kept: frozenset[str]
    above: str


BLACKBOARD = OfflineFormat(
    lms="Blackboard",
    example="Lab 6 [Total Pts: 100 Score] |123456",
    # does not match a total, which cannot be filled: Total [Total Pts: up to 100 Score] |123457
    header=re.compile(
        r"(?P<title>.*?) \[Total Pts: (?P<maximum>[0-9.,]+)(?: [^\]]*)?\](?: \|(?P<number>[0-9]+))?", re.DOTALL
    ),
    login="Username",
    sis="Student ID",
    email="Email",
    kept=frozenset({"Child Course ID", "Last Access", "Availability"}),
    above="",
)
BRIGHTSPACE = OfflineFormat(
    lms="Brightspace",
    example="Lab 6 Points Grade <Numeric MaxPoints:100>",
    header=re.compile(r"(?P<title>.*?) Points Grade(?: <Numeric MaxPoints:(?P<maximum>[0-9.,]+)[^>]*>)?", re.DOTALL),
    login="Username",
    sis="OrgDefinedId",
    email="Email",
    kept=frozenset({"End-of-Line Indicator"}),
    above='Brightspace reduces them to the maximum, unless "Can Exceed" is ticked for the grade item',
)
_NAMES = ("First Name", "Last Name")
_PREVIEW_USER = re.compile(r".*_previewuser\d*")  # the instructor's own test student in Blackboard


def fill_offline(data: bytes, grades: Sequence[LmsGrade], options: FillOptions, form: OfflineFormat) -> Filled:
    """Return a file of Blackboard or Brightspace with totals in an assignment's column, and what the import changes.

    With `options.only` it has no other assignment. Raises InputError if the file is of another kind, or the column is
    ambiguous. Unless any maximum is allowed, its maximum must be that of the rubric.
    """
    table = read_table(data, options.shown)
    titles = table.titles
    columns = [_grade_column(index, title, form) for index, title in enumerate(titles)]
    if not {form.login, form.sis} & set(titles) or not any(column.title for column in columns):
        found = enumerated([repr(title) for title in titles[:10]]) or "nothing"
        raise InputError(
            f"{options.shown} is not a grade file of {form.lms}: its first row needs {form.login} or {form.sis},"
            f" and a column such as {form.example!r}, but has {found}"
        )
    grade = find_assignment([column for column in columns if column.title], options, form.lms, form.example)
    if not options.any_maximum:
        check_maximum(f"{form.lms}'s maximum of {grade.title!r}", [grade.maximum], options.out_of)
    rows = [row for row in table.rows[1:] if any(cell.value.strip() for cell in row.cells)]
    students = [_student(row, titles, form) for row in rows]
    filling = Filling(table, grade.header, students)
    preflight = filling.preflight

    def fill_row(row: TableRow, _: LmsGrade, total: Decimal) -> TableRow | str:
        maximum = read_lms_points(grade.maximum)
        if form.above and maximum is not None and total > maximum:
            note = filling.note(row, form.above)
            preflight.warnings.append(f"row {row.number}, {note.who}: {format_points(total)} points: {note.why}")
        return filling.with_points(row, grade.index, total, "")

    kept = [*first_of_each(titles, {form.login, form.sis, form.email, *_NAMES, *form.kept}), grade.index]
    filled = filling.fill(grades, fill_row, kept=kept if options.only else None)
    previews = {student.row for student in students if _PREVIEW_USER.fullmatch(student.student.login)}
    preflight.unknown = [note for note in preflight.unknown if note.row not in previews]
    preflight.warnings += _warnings(columns, grade, options, form)
    return filled


def _grade_column(index: int, header: str, form: OfflineFormat) -> GradeColumn:
    found = form.header.fullmatch(header)
    if found is None:
        return GradeColumn(index, header)
    parts = found.groupdict("")
    return GradeColumn(index, header, parts["title"].strip(), parts.get("number", ""), parts["maximum"])


def _student(row: TableRow, titles: Sequence[str], form: OfflineFormat) -> LmsStudent:
    def value(title: str) -> str:
        return row.value(titles.index(title)) if title in titles else ""

    login, sis = value(form.login).removeprefix("#"), value(form.sis).removeprefix("#")
    first, last = map(value, _NAMES)
    name = f"{last}, {first}" if first and last else first or last
    return LmsStudent(row.number, name or login or sis, Student("", name, value(form.email), login=login, sis=sis))


def _warnings(
    columns: Sequence[GradeColumn], grade: GradeColumn, options: FillOptions, form: OfflineFormat
) -> Iterator[str]:
    maximum = read_lms_points(grade.maximum)
    if maximum is None:
        yield f"the file does not state the maximum of {grade.title!r} in {form.lms}"
    elif maximum != options.out_of:
        points = format_points(options.out_of)
        yield f"{grade.title!r} has {grade.maximum} points in {form.lms}, but the rubric has {points}"
    yield from assignment_warnings(columns, grade, options)
