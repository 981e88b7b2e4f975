"""Fill an LMS file with grades: match its rows with the students, write the grades, and say what the import does.

Only pairs that are unambiguous in both directions match. Rows of students without a grade are removed, so that nothing
of theirs changes.
"""

from collections.abc import Callable, Container, Iterable, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal

from grader.classroom.lms.grades import LmsGrade, has_decimal_comma, points_text, read_lms_points
from grader.classroom.lms.preflight import Filled, Overwrite, Preflight, RowNote
from grader.classroom.matching import OF_RECORDS, People, clues_of, lms_ids_of
from grader.classroom.students import Student
from grader.classroom.tables import Table, TableRow
from grader.errors import InputError
from grader.text import format_points

_MAX_NAMED = 5
_NOT_GRADED_YET = frozenset({"", "-", "needs grading"})  # the last in Blackboard
FillRow = Callable[[TableRow, LmsGrade, Decimal], "TableRow | str | RowNote"]
FillExcuse = Callable[[TableRow], TableRow | str]


@dataclass(frozen=True, slots=True)
class FillOptions:
    """How an LMS file is filled: the rubric's maximum and names, the columns that the user names.

    `any_maximum` allows another maximum in the file. `only` omits the columns of other assignments. `shown` is the name
    of the file in messages.
    """

    out_of: Decimal
    rubric_names: tuple[str, ...] = ()
    column: str = ""
    feedback_column: str = ""
    any_maximum: bool = False
    only: bool = False
    shown: str = "the file"


@dataclass(frozen=True, slots=True)
class LmsStudent:
    """A student in an LMS file: the number of the row, the name in messages, and the data in the row."""

    row: int
    who: str
    student: Student
    aliases: tuple[str, ...] = ()


class Filling:
    """An LMS file that is filled with grades; `preflight` collects what importing it does."""

    def __init__(self, table: Table, header: str, students: Iterable[LmsStudent]) -> None:
        """`header` is that of the grade's column."""
        self.table, self.preflight = table, Preflight(header)
        self._students = {student.row: student for student in students}

    def fill(
        self,
        grades: Sequence[LmsGrade],
        fill_row: FillRow,
        *,
        fill_excuse: FillExcuse | None = None,
        kept: Sequence[int] | None = None,
    ) -> Filled:
        """Return the table with the grades in it; of its columns only those in `kept`, unless it is None.

        `fill_row` gets a row, the grade, and its total; it returns the new row, the same row if nothing changes, or the
        reason why the grade cannot be written, or a note that the LMS would refuse it. `fill_excuse` does the same for
        an excuse, in an LMS that supports excuses.
        """
        matched = match_rows(list(self._students.values()), grades, self.preflight)
        rows = []
        for row in self.table.rows:
            if row.number not in self._students:
                rows.append(row)
            elif row.number in matched:
                grade = matched[row.number]
                new = self._fill(row, grade, fill_row, fill_excuse)
                if isinstance(new, TableRow):
                    self._count(row, new, grade)
                    rows.append(new)
                elif isinstance(new, RowNote):
                    self.preflight.refused.append(new)
                else:
                    self.preflight.ungraded.append(self.note(row, new))
        filled = replace(self.table, rows=tuple(rows))
        return Filled((filled if kept is None else filled.with_columns(kept)).encoded(), self.preflight)

    def note(self, row: TableRow, why: str) -> RowNote:
        """Return a note about a row."""
        return RowNote(row.number, self._students[row.number].who, why)

    def with_points(self, row: TableRow, column: int, total: Decimal, like: str) -> TableRow:
        """Return a row with the total, written `like` another number, in a column; another old grade is a conflict."""
        old, new = row.value(column), points_text(total, comma=has_decimal_comma(like))
        return row if read_lms_points(old) == read_lms_points(new) else self.with_value(row, column, new)

    def with_value(self, row: TableRow, column: int, new: str) -> TableRow:
        """Return a row with a value in a column, the same row if it has it; another old value is a conflict."""
        old = row.value(column)
        if old.casefold() == new.casefold():
            return row
        if old.casefold() not in _NOT_GRADED_YET:
            self.preflight.conflicts.append(Overwrite(row.number, self._students[row.number].who, old, new))
        return self.table.changed(row, column, new)

    def _fill(
        self, row: TableRow, grade: LmsGrade, fill_row: FillRow, fill_excuse: FillExcuse | None
    ) -> TableRow | str | RowNote:
        titles = self.table.titles
        if (grade.total is not None or grade.is_excused) and len(row.cells) != len(titles):
            return f"the row has {len(row.cells)} cells and the header {len(titles)}"
        if grade.is_excused and fill_excuse is not None:
            return fill_excuse(row)
        return fill_row(row, grade, grade.total) if grade.total is not None else grade.why_not or "has no grade"

    def _count(self, row: TableRow, new: TableRow, grade: LmsGrade) -> None:
        found = self.preflight
        if grade.is_excused:
            found.excused.append(self._students[row.number].who)
        if grade.is_older:
            found.older.append(RowNote(row.number, grade.who, "excuse" if grade.is_excused else "final mark"))
        found.unchanged += new is row
        found.filled += new is not row


def first_of_each(titles: Sequence[str], wanted: Container[str]) -> list[int]:
    """Return where each of the wanted titles is first."""
    return [index for index, title in enumerate(titles) if title in wanted and title not in titles[:index]]


def check_maximum(what: str, maxima: Iterable[str], out_of: Decimal) -> None:
    """Raise InputError if a maximum in an LMS file is not that of the rubric: 9.33 of 100 is not 9.33 of 10."""
    for text in maxima:
        maximum = read_lms_points(text)
        if maximum is not None and maximum != out_of:
            raise InputError(
                f"{what} is {format_points(maximum)}, but the rubric's maximum is {format_points(out_of)}: "
                "change the maximum in the LMS and export again, or pass --any-maximum to write the points unchanged"
            )


def match_rows(students: Sequence[LmsStudent], grades: Sequence[LmsGrade], preflight: Preflight) -> dict[int, LmsGrade]:
    """Return the grades by row number, and report the others in `preflight`.

    A submission that is not on the roster is matched by LMS ids only: its name was written by a student.
    """
    rows = People(clues_of(student.student, student.aliases) for student in students)
    ours = People(clues_of(grade.student) if grade.is_on_roster else lms_ids_of(grade.student) for grade in grades)
    row_of = [rows.find(clues, OF_RECORDS) for clues in ours.clues]
    found: dict[int, LmsGrade] = {}
    left = set(range(len(grades)))
    for index, clues in enumerate(rows.clues):
        student, match = students[index], ours.find(clues, OF_RECORDS)
        if match.only is not None and row_of[match.only].only == index:
            found[student.row] = grades[match.only]
            left.discard(match.only)
        elif len(match.people) > 1 or any(index in row_of[grade].people for grade in match.people):
            left.difference_update(match.people)
            names = [repr(grades[grade].who) for grade in match.people[:_MAX_NAMED]]
            could_be = f"could be any of {', '.join(names)}"
            why = could_be if len(match.people) > 1 else f"{names[0]} could be this row or another one"
            preflight.ambiguous.append(RowNote(student.row, student.who, why))
        else:
            why = "no student of the gradebook matches this id, address or name"
            preflight.unknown.append(RowNote(student.row, student.who, why))
    for grade in (grades[index] for index in sorted(left)):
        if grade.total is not None or grade.is_excused:
            why = f"{'is excused' if grade.is_excused else 'has a grade'}, but no row in the file"
            preflight.missing.append(RowNote(0, grade.who, why))
    return found
