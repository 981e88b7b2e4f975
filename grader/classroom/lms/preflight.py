"""A preview of the import of a filled LMS file: changes, omitted grades with the reason, and unmatched rows."""

from dataclasses import dataclass, field
from typing import NamedTuple


class RowNote(NamedTuple):
    """A row or student without a new grade, and why. `row` counts from 1 in the LMS file; 0 for a student without a row."""

    row: int
    who: str
    why: str


class Conflict(NamedTuple):
    """A row with another grade, which is overwritten: `was` becomes `becomes`."""

    row: int
    who: str
    was: str
    becomes: str


@dataclass(slots=True)
class Preflight:
    """The effects of importing the filled file.

    `filled` rows are changed and `unchanged` ones have the grade already; all other students' rows are removed from the file, so that
    nothing of theirs can change. `ungraded` are rows of students without a grade, `unknown` rows that match nobody, `missing`
    students with a grade but without a row, `ambiguous` rows and students with several possible matches, which are left
    unassigned. `kept_feedback` are rows with a comment that a person wrote.
    """

    column: str
    filled: int = 0
    unchanged: int = 0
    conflicts: list[Conflict] = field(default_factory=list)
    ungraded: list[RowNote] = field(default_factory=list)
    unknown: list[RowNote] = field(default_factory=list)
    missing: list[RowNote] = field(default_factory=list)
    ambiguous: list[RowNote] = field(default_factory=list)
    kept_feedback: list[RowNote] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    @property
    def matches(self) -> bool:
        """Return whether every row has its student and every grade its row."""
        return not (self.unknown or self.missing or self.ambiguous)


class Filled(NamedTuple):
    """A filled LMS file, unchanged except for the cells that were written, and what importing it does."""

    data: bytes
    preflight: Preflight
