"""The submission part of a report: what was graded, its files as far as they can still be read, its class grade."""

from dataclasses import dataclass, field
from decimal import Decimal
from typing import NamedTuple

from grader.robot.model import Robot
from grader.robot.reader import Verdict
from grader.source import Source
from grader.submission.submission import Submission
from grader.submission.urdf import OtherCandidate, Read


class GradedPackage(NamedTuple):
    """The graded package: its folder in the submission, empty for the submission itself, and its name."""

    folder: str
    name: str


@dataclass(frozen=True, slots=True)
class GradedSubmission:
    """The submission part of a report. `path`, `sha256` and `verdict` are those of the URDF.

    `is_single` distinguishes a single URDF from a folder or archive; `unread` says why the URDF could not be read;
    `another_robot` says why the robot looks like another one; empty if it does not. `originals` are its files.
    """

    id: str
    path: str | None = None
    sha256: str | None = None
    package: GradedPackage | None = None
    other_candidates: tuple[OtherCandidate, ...] = ()
    ignored: tuple[str, ...] = ()
    has_urdf: bool = False
    verdict: Verdict | None = None
    is_single: bool = False
    unread: str = ""
    another_robot: str = ""
    originals: Submission | None = field(default=None, repr=False, compare=False)

    @classmethod
    def of(cls, submission: Submission, another_robot: str) -> "GradedSubmission":
        """Return what a report says of a submission."""
        package = submission.package
        return cls(
            id=submission.id,
            path=submission.path,
            sha256=submission.sha256,
            package=GradedPackage(package.folder, package.name) if package is not None else None,
            other_candidates=tuple(it for it in submission.other_candidates if it.path not in submission.included),
            ignored=submission.ignored,
            has_urdf=submission.has_urdf,
            verdict=submission.verdict,
            is_single=submission.is_single,
            unread=submission.unread,
            another_robot=another_robot,
            originals=submission,
        )

    def source(self, path: str) -> Source | None:
        """Return the text of one of the files; None where it cannot be read."""
        return self.originals.source(path) if self.originals is not None else None

    @property
    def robot(self) -> Robot | None:
        """The robot that was graded; None if there is none, or the URDF can no longer be read.

        A submission in which no URDF was read is not opened again: it may be one that crashed the process that graded
        it.
        """
        urdf = self.originals.urdf if self.originals is not None and self.sha256 is not None else None
        return urdf.reading.robot if isinstance(urdf, Read) else None


class Grade(NamedTuple):
    """A student's grade in a class: the points that count, None if excused, and the late penalty in them (0 or less).

    `is_final` says that a final mark replaces the points of the criteria.
    """

    points: Decimal | None
    late: Decimal = Decimal(0)
    is_final: bool = False
