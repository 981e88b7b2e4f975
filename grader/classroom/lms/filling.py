"""The account that is kept while an LMS file is filled, row by row."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from decimal import Decimal

from grader.classroom.lms.grades import LmsGrade, exact_words, read_points
from grader.classroom.lms.matching import Matches
from grader.classroom.lms.preflight import Conflict, Filled, Preflight, RowNote
from grader.classroom.lms.tables import Table, TableRow
from grader.errors import InputError


@dataclass(slots=True)
class Filling:
    """What has been filled so far and what has not; `result` makes the values of it that others see."""

    column: str
    found: Matches
    filled: int = 0
    unchanged: int = 0
    unknown: tuple[RowNote, ...] = ()
    ungraded: list[RowNote] = field(default_factory=list)
    conflicts: list[Conflict] = field(default_factory=list)
    kept_feedback: list[RowNote] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.unknown = self.found.unknown

    def grade_of(self, row: TableRow, who: str, width: int) -> LmsGrade | None:
        """The grade that belongs into a row; None, and noted why, where there is none or where cells are out of place."""
        grade = self.found.matched.get(row.number)
        if grade is None:
            return None
        if grade.total is None:
            self.leave(row, who, grade.why_not or "has no grade")
            return None
        if len(row.cells) != width:
            self.leave(row, who, f"the row has {len(row.cells)} cells and the header {width}")
            return None
        return grade

    def leave(self, row: TableRow, who: str, why: str) -> None:
        """A student of ours gets no grade in this row."""
        self.ungraded.append(RowNote(row.number, who, why))

    def overwrite(self, row: TableRow, who: str, was: str, becomes: str) -> None:
        """A grade that is not ours is overwritten."""
        self.conflicts.append(Conflict(row.number, who, was, becomes))

    def keep_feedback(self, row: TableRow, who: str, why: str) -> None:
        """A comment that is not ours stays."""
        self.kept_feedback.append(RowNote(row.number, who, why))

    def result(self, table: Table, rows: Sequence[TableRow]) -> Filled:
        """The filled file and the account of it."""
        preflight = Preflight(
            column=self.column,
            filled=self.filled,
            unchanged=self.unchanged,
            conflicts=tuple(self.conflicts),
            ungraded=tuple(self.ungraded),
            unknown=self.unknown,
            missing=self.found.missing,
            ambiguous=self.found.ambiguous,
            kept_feedback=tuple(self.kept_feedback),
            warnings=tuple(self.warnings),
        )
        return Filled(replace(table, rows=tuple(rows)).encoded(), preflight)


def same_maximum(what: str, stated: Sequence[str], out_of: Decimal) -> None:
    """Raises InputError where a maximum in an LMS file is a number other than ours: 9.33 of 100 is not 9.33 of 10."""
    for each in stated:
        maximum = read_points(each)
        if maximum is not None and maximum != out_of:
            raise InputError(
                f"{what} is {exact_words(maximum)}, and the rubric's points are {exact_words(out_of)}: change the maximum"
                " in the LMS and export again, or write the points as they are with --any-maximum"
            )
