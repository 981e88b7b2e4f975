"""What the description of a report is made of: sections of entries and lines. An entry, about a criterion, has blocks.

A writer decides how a block looks in its medium and which roles it leaves out, but neither words nor order.
"""

from decimal import Decimal
from typing import Literal, NamedTuple

from grader.grading.report import Result
from grader.report.order import earned_text, is_failure, status_of
from grader.source import Edits, Location
from grader.text import format_points, signed_points

# Of a submission, of a criterion, and of the list of evidence, problems and files.
Role = Literal[
    "summary", "pending", "provenance",
    "finding", "comment", "hint", "feedback", "expected", "skipped", "alike",
    "part", "found", "missing", "error", "warning", "note", "ignored",
]  # fmt: skip


class Line(NamedTuple):
    """A printable sentence, and what it is."""

    role: Role
    text: str


class Answer(NamedTuple):
    """The lines of an answer, and whose it is."""

    title: Literal["Found", "Model answer"]
    lines: tuple[str, ...]


class Diff(NamedTuple):
    """The lines that edits change."""

    edits: Edits


Block = Line | Location | Answer | Diff  # a location is a place and its source line


class Entry(NamedTuple):
    """A criterion with what is said about it, and the criteria that are skipped because it failed.

    `also` are the criteria that the same edit fixes, each of which names this one as `first`, or about which the same
    is said.
    """

    result: Result
    skipped: tuple[Result, ...] = ()
    also: tuple["Entry", ...] = ()
    first: str = ""
    blocks: tuple[Block, ...] = ()

    @property
    def id(self) -> str:
        """The id of the criterion."""
        return self.result.criterion.id

    @property
    def status(self) -> str:
        """The status of the criterion."""
        return status_of(self.result)

    @property
    def lost(self) -> Decimal:
        """The points that a failure costs, with those of what is skipped because of it; extra credit costs nothing."""
        own = self.result.criterion.maximum - self.result.points if not self.result.criterion.bonus else Decimal(0)
        return sum((other.criterion.maximum for other in self.skipped), own)

    @property
    def points(self) -> str:
        """The points and the maximum, 3/4; of a failure the points that it costs: -6 points.

        Those of what is skipped because of it are apart: -3 points, and 21 for what depends on it. Of extra credit it
        is what was earned.
        """
        if not is_failure(self.result):
            return earned_text(self.result)
        others = sum((other.criterion.maximum for other in self.skipped), Decimal(0))
        own = self.lost - others
        lost = f"{signed_points(-own) if own else '0'} point{'' if own == 1 else 's'}"
        lost = f"{lost}, and {format_points(others)} for what depends on it" if others else lost
        if not self.result.criterion.bonus:
            return lost
        return earned_text(self.result) + (f", {lost}" if self.lost else "")

    @property
    def location(self) -> Location | None:
        """Where to look, if the criterion failed."""
        return next((block for block in self.blocks if isinstance(block, Location)), None)

    def texts(self, *roles: Role) -> list[str]:
        """Return the sentences with these roles."""
        return [block.text for block in self.blocks if isinstance(block, Line) and block.role in roles]


class Section(NamedTuple):
    """A part of a report under a title: entries, then lines."""

    title: str
    entries: tuple[Entry, ...] = ()
    lines: tuple[Line, ...] = ()
