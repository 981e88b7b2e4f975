"""The report: every criterion with what was found and what it is worth. Renderers only lay it out."""

from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING, NamedTuple

from grader.checks.outcome import Outcome
from grader.grading.rubric import Criterion, Evidence, Rubric
from grader.robot.catalogue import Problem
from grader.submission.submission import Submission

if TYPE_CHECKING:
    from grader.submission.evidence import Exhibit

_NOTHING = Decimal(0)


class Result(NamedTuple):
    """One criterion's outcome. `because` is the criterion that a skip is due to; `traceback` is for the maintainers."""

    criterion: Criterion
    outcome: Outcome
    because: str | None = None
    traceback: str = ""

    @property
    def points(self) -> Decimal:
        """What the criterion earns: all or nothing."""
        return self.criterion.points if self.outcome.status == "passed" else _NOTHING


class Exhibits(NamedTuple):
    """The files that were found for a piece of evidence, if any."""

    evidence: Evidence
    files: "tuple[Exhibit, ...]"


@dataclass(frozen=True, slots=True)
class Report:
    """What one submission earns under one rubric, part by part.

    `problems` are those of the URDF and, where a package is graded, of its files. `others` are pictures that no piece of
    evidence asks for. `notes` say in a sentence each what is worth knowing of how the submission was read.
    """

    submission: Submission
    rubric: Rubric
    parts: tuple[str, ...]
    results: tuple[Result, ...]
    problems: tuple[Problem, ...] = ()
    exhibits: tuple[Exhibits, ...] = ()
    others: "tuple[Exhibit, ...]" = ()
    notes: tuple[str, ...] = ()

    @property
    def score(self) -> Decimal:
        """The points earned; what a person still has to decide is not in it."""
        return _sum(result.points for result in self.results)

    @property
    def max_score(self) -> Decimal:
        """The points that can be earned in the graded parts."""
        return _sum(result.criterion.points for result in self.results)

    @property
    def pending(self) -> Decimal:
        """The points that a person still has to give or refuse."""
        return _sum(result.criterion.points for result in self.results if result.outcome.status == "pending")

    def counts(self, *statuses: str) -> int:
        """How many criteria have one of these statuses."""
        return sum(result.outcome.status in statuses for result in self.results)


def _sum(points: Iterable[Decimal]) -> Decimal:
    return sum(points, _NOTHING)
