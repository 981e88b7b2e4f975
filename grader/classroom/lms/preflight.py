"""What importing a filled LMS file does, row by row."""

from dataclasses import dataclass, field
from typing import NamedTuple


class RowNote(NamedTuple):
    """A row or student without a new grade, and why. `row` counts from 1 in the LMS file; 0 if there is none."""

    row: int
    who: str
    why: str


class Overwrite(NamedTuple):
    """A row with another grade, which is overwritten: `was` becomes `becomes`."""

    row: int
    who: str
    was: str
    becomes: str


@dataclass(slots=True)
class Preflight:
    """The effects of importing the filled file.

    `filled` rows are changed and `unchanged` ones have the grade already. All other rows are removed from the file, so
    that the import does not change them. `excused` are the students whose excuse the file contains. `ungraded` are rows
    of students without a grade, `refused` those whose grade the LMS would not accept, `unknown` rows that match no
    student, `missing` students with a grade but without a row, `ambiguous` rows and students with several possible
    matches, which are left unassigned. `kept_feedback` are rows with a comment that a person wrote. `older` are the
    final marks and excuses in the file that were given for an earlier submission.
    """

    column: str
    filled: int = 0
    unchanged: int = 0
    conflicts: list[Overwrite] = field(default_factory=list)
    ungraded: list[RowNote] = field(default_factory=list)
    unknown: list[RowNote] = field(default_factory=list)
    missing: list[RowNote] = field(default_factory=list)
    ambiguous: list[RowNote] = field(default_factory=list)
    kept_feedback: list[RowNote] = field(default_factory=list)
    excused: list[str] = field(default_factory=list)
    refused: list[RowNote] = field(default_factory=list)
    older: list[RowNote] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    @property
    def matches(self) -> bool:
        """Whether every row has its student, every grade its row, and the LMS accepts every grade."""
        return not (self.refused or self.unknown or self.missing or self.ambiguous)


class Filled(NamedTuple):
    """A filled LMS file, unchanged except for the cells that were written, and what importing it does."""

    data: bytes
    preflight: Preflight
