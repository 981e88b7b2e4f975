"""What filling an LMS file would do, before anyone imports it: what changes, what is left out and why, and who is not matched."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RowNote:
    """Someone without a new grade, and why. `row` counts from 1 in the LMS file; 0 for a student who has no row there."""

    row: int
    who: str
    why: str


@dataclass(frozen=True, slots=True)
class Conflict:
    """A row that has a grade already, and another one than ours: it is filled, and `was` becomes `becomes`."""

    row: int
    who: str
    was: str
    becomes: str


@dataclass(frozen=True, slots=True)
class Preflight:
    """What the filled file does when it is imported.

    `filled` rows are changed and `unchanged` ones have our grade already; all other rows of students are left out of the file,
    so that nothing of theirs can change. `ungraded` are rows of students of ours that get no grade; `unknown` rows are of
    nobody whom we know; `missing` are students with a grade who have no row; `ambiguous` are rows and students that could be
    matched in more than one way, which is never guessed. `kept_feedback` are rows whose comment a person has written.
    """

    column: str
    filled: int
    unchanged: int
    conflicts: tuple[Conflict, ...]
    ungraded: tuple[RowNote, ...]
    unknown: tuple[RowNote, ...]
    missing: tuple[RowNote, ...]
    ambiguous: tuple[RowNote, ...]
    kept_feedback: tuple[RowNote, ...]
    warnings: tuple[str, ...]

    @property
    def matches(self) -> bool:
        """Every row has its student and every grade its row; whether each of them is graded is another question."""
        return not (self.unknown or self.missing or self.ambiguous)


@dataclass(frozen=True, slots=True)
class Filled:
    """A filled LMS file, byte for byte as it was but for the cells that were written, and what was found on the way."""

    data: bytes
    preflight: Preflight
