"""The report: every criterion with what was found and what it is worth. Renderers only lay it out."""

from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING, NamedTuple, Protocol

from grader import __version__
from grader.checks.outcome import Outcome
from grader.grading.rubric import Criterion, Evidence, Rubric
from grader.problems import Problem
from grader.robot.reader import Verdict
from grader.source import Source
from grader.submission.urdf import OtherCandidate

if TYPE_CHECKING:
    from grader.documents.evidence import Exhibit

_NOTHING = Decimal(0)


class ManualMark(NamedTuple):
    """What a person has decided of a criterion: its points, whatever the check has found; who says so, if they gave a name, and why."""

    points: Decimal
    by: str
    comment: str = ""


class Result(NamedTuple):
    """One criterion's outcome. `because` is the criterion that a skip is due to; `traceback` is for the maintainers."""

    criterion: Criterion
    outcome: Outcome
    because: str | None = None
    traceback: str = ""
    manual_mark: ManualMark | None = None

    @property
    def points(self) -> Decimal:
        """What the criterion earns: all or nothing, unless a person has said what."""
        if self.manual_mark is not None:
            return self.manual_mark.points
        return self.criterion.points if self.outcome.status == "passed" else _NOTHING

    @property
    def is_open(self) -> bool:
        """Whether a person still has to decide."""
        return self.outcome.status == "pending" and self.manual_mark is None


class Exhibits(NamedTuple):
    """The files that were found for a piece of evidence, if any."""

    evidence: Evidence
    files: "tuple[Exhibit, ...]"


class Named(Protocol):
    """The package that is graded: the folder that it stands in, empty for the submission itself, and its name."""

    @property
    def folder(self) -> str:
        """Its folder."""

    @property
    def name(self) -> str:
        """Its name."""


class GradedSubmission(Protocol):
    """What a report says of the submission itself: a Submission, or what has been kept of one."""

    @property
    def id(self) -> str:
        """What it is called."""

    @property
    def path(self) -> str | None:
        """The path of the URDF in it."""

    @property
    def sha256(self) -> str | None:
        """The hash of the URDF's bytes."""

    @property
    def package(self) -> Named | None:
        """The package that is graded."""

    @property
    def other_candidates(self) -> tuple[OtherCandidate, ...]:
        """Files that might have been graded."""

    @property
    def ignored(self) -> tuple[str, ...]:
        """What was not taken in, and why."""

    @property
    def has_urdf(self) -> bool:
        """Whether there is a URDF that could be read."""

    @property
    def verdict(self) -> Verdict | None:
        """What ROS 2 makes of it."""

    @property
    def is_single(self) -> bool:
        """Whether it is a URDF on its own."""

    @property
    def unread(self) -> str:
        """Why the URDF could not be read."""

    def source(self, path: str) -> Source | None:
        """The text of one of its files, for quoting; None where it cannot be read."""


@dataclass(frozen=True, slots=True)
class Report:
    """What one submission earns under one rubric, part by part.

    `problems` are those of the URDF and, where a package is graded, of its files. `others` are pictures that no piece of
    evidence asks for. `notes` say in a sentence each what is worth knowing of how the submission was read.
    """

    submission: GradedSubmission
    rubric: Rubric
    parts: tuple[str, ...]
    results: tuple[Result, ...]
    problems: tuple[Problem, ...] = ()
    exhibits: tuple[Exhibits, ...] = ()
    others: "tuple[Exhibit, ...]" = ()
    notes: tuple[str, ...] = ()
    version: str = __version__  # of the grader that has decided

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
        return _sum(result.criterion.points for result in self.results if result.is_open)

    def counts(self, *statuses: str) -> int:
        """How many criteria have one of these statuses."""
        return sum(result.outcome.status in statuses for result in self.results)


def _sum(points: Iterable[Decimal]) -> Decimal:
    return sum(points, _NOTHING)
