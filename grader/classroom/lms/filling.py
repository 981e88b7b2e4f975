"""Fill an LMS file with grades, row by row. Rows of students without a grade are removed, so that their data does not change."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from decimal import Decimal

from grader.classroom.lms.grades import LmsGrade, exact_text, points_text, read_points
from grader.classroom.lms.matching import LmsStudent, match_rows
from grader.classroom.lms.preflight import Conflict, Filled, Preflight, RowNote
from grader.classroom.lms.tables import Table, TableRow
from grader.errors import InputError

FillRow = Callable[[TableRow, LmsGrade, Decimal, str], TableRow | str]


def fill_rows(
    table: Table, students: Iterable[LmsStudent], grades: Sequence[LmsGrade], preflight: Preflight, fill_row: FillRow
) -> Filled:
    """Return the table with the grades in it.

    `fill_row` gets a row, the grade, its total and the student's name; it returns the new row, the same row if nothing changes, or the
    reason why the grade cannot be written.
    """
    by_row = {student.row: student for student in students}
    matched = match_rows(list(by_row.values()), grades, preflight)
    rows = []
    for row in table.rows:
        if row.number not in by_row:
            rows.append(row)
        elif row.number in matched:
            who, grade = by_row[row.number].who, matched[row.number]
            new: TableRow | str = grade.why_not or "has no grade"
            if grade.total is not None:
                new = f"the row has {len(row.cells)} cells and the header {len(table.titles)}"
                if len(row.cells) == len(table.titles):
                    new = fill_row(row, grade, grade.total, who)
            if isinstance(new, str):
                preflight.ungraded.append(RowNote(row.number, who, new))
                continue
            preflight.unchanged += new is row
            preflight.filled += new is not row
            rows.append(new)
    return Filled(replace(table, rows=tuple(rows)).encoded(), preflight)


def with_points(
    table: Table, row: TableRow, column: int, total: Decimal, who: str, preflight: Preflight, *, comma: bool
) -> TableRow:
    """Return a row with the total in a column, the same row if it is there already; a grade that is overwritten is a conflict."""
    old, new = row.value(column), points_text(total, comma=comma)
    if read_points(old) == read_points(new):
        return row
    if old not in {"", "-"}:
        preflight.conflicts.append(Conflict(row.number, who, old, new))
    return table.changed(row, column, new)


def check_maximum(what: str, maxima: Iterable[str], out_of: Decimal) -> None:
    """Raise InputError if a maximum in an LMS file is not that of the rubric: 9.33 of 100 is not 9.33 of 10."""
    for text in maxima:
        maximum = read_points(text)
        if maximum is not None and maximum != out_of:
            raise InputError(
                f"{what} is {exact_text(maximum)}, but the rubric's maximum is {exact_text(out_of)}: change the maximum in the"
                " LMS and export again, or pass --any-maximum to write the points unchanged"
            )
