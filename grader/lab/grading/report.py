"""The report: the outcome and the points of every criterion. Renderers only lay it out."""

from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from typing import TYPE_CHECKING, NamedTuple

from grader import __version__
from grader.base.grouping import Strings
from grader.base.problems import Problem
from grader.base.records import Named
from grader.base.slips import Slip
from grader.base.source import Certainty, Edits, Location
from grader.base.text import printable
from grader.lab.checks.manual import MANUAL_CHECKS
from grader.lab.checks.outcome import Outcome
from grader.lab.rubric.criterion import Criterion, Evidence
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.submission import Submission

if TYPE_CHECKING:
    from grader.lab.documents.evidence import EvidenceFile

INCOMPLETE_HINTS = "the search for hints ended at its limit: there may be more"
_NOTHING = Decimal(0)


class ManualMark(Named):
    """A manual mark or override.

    It has the points of a criterion, the name of the grader if given, and a comment.
    """

    points: Decimal
    by: str
    comment: str = ""


class ManualComment(Named):
    """A comment of a grader that changes no points, with the grader's name if given."""

    text: str
    by: str


class Hint(Named):
    """A change of the submission that was tried.

    With it the criteria in `gains` pass, and none that passed fails.
    """

    message: str  # the change, in a sentence
    at: Location
    gains: Mapping[str, Decimal]  # criteria with their points
    edits: Edits = ()  # empty where the rubric does not want to show them, as is the cause
    cause: str = ""  # what is wrong: "the sign of the roll of the joint origin of 'right_wheel'"
    shown_by: str = ""  # the criterion that shows the hint; the others that it fixes name that one
    certainty: Certainty = "preferred"  # whether other edits were proven
    after: Sequence[str] = ()  # the criteria whose hints have to be followed first
    fixed_with: Sequence[str] = ()  # the criteria whose hints are enough together


class Result(NamedTuple):
    """The outcome of a criterion, and what decides its points besides.

    >>> from grader.lab.rubric.rubric import load_rubric
    >>> outcome = Outcome("failed", "the robot has no <link>")
    >>> result = Result(load_rubric("lab6").criteria[0], outcome)
    >>> result, result.points, result.outcome.message
    (<Result urdf-loads: failed, 0/3>, Decimal('0'), 'the robot has no <link>')
    """

    criterion: Criterion
    outcome: Outcome
    because: str | None = None  # the criterion that a skip is due to
    traceback: str = ""  # of a fault, for the maintainers
    manual_mark: ManualMark | None = None
    # the criterion whose mistake alone makes this one fail, so that its points are given
    carried: str = ""
    hint: Hint | None = None  # criteria that one edit makes pass have the same
    comment: ManualComment | None = None  # of a grader, without points

    def __repr__(self) -> str:
        """Return the criterion, the status and the points.

        This is what one wants to see of a list of results.
        """
        return (
            f"<Result {self.criterion.id}: {self.outcome.status}, "
            f"{self.points}/{self.criterion.points}>"
        )

    @property
    def id(self) -> str:
        """The id of the criterion."""
        return self.criterion.id

    @property
    def points(self) -> Decimal:
        """The points earned: those of the manual mark, else all or none.

        All points are earned if the check passed, an error is carried forward, or an adjustment
        gives them.
        """
        if self.manual_mark:
            return self.manual_mark.points
        is_given = self.outcome.status == "passed" or self.carried or self.criterion.is_given
        return self.criterion.points if is_given else _NOTHING

    @property
    def why_given(self) -> str:
        """Why the outcome does not decide the points: the adjustment, or an error carried forward.

        It is empty if it does.
        """
        if self.manual_mark:
            return ""
        if self.criterion.adjustment:
            return self.criterion.adjustment.message
        if not self.carried:
            return ""
        return f"No points lost for {self.criterion.id}: it fails only because of {self.carried}."

    @property
    def is_adjusted(self) -> bool:
        """Return whether the rubric adjusts the criterion.

        The outcome and manual marks then do not count.
        """
        return self.criterion.adjustment is not None

    @property
    def is_lost(self) -> bool:
        """Return whether the criterion has no points because of a mistake."""
        return self.outcome.status in ("failed", "skipped") and not (
            self.carried or self.is_adjusted
        )

    @property
    def is_open(self) -> bool:
        """Return whether the criterion still needs manual grading."""
        return self.outcome.status == "pending" and not self.manual_mark and not self.is_adjusted


Results = tuple[Result, ...]  # in the order of the rubric


class PaidSlip(Named):
    """A slip, and the criterion that loses its points for it."""

    slip: Slip
    payer: str


class Meant(Named):
    """A submission with the words that are meant.

    It has the results on it, and the slips that it corrects.
    """

    submission: Submission
    results: Results
    paid: tuple[PaidSlip, ...]


class EvidenceResult(NamedTuple):
    """A piece of evidence, the files that were found for it, and those that are perhaps meant."""

    evidence: Evidence
    files: "tuple[EvidenceFile, ...]"
    possible: "tuple[EvidenceFile, ...]" = ()


class Grade(Named):
    """A student's grade in a class.

    It has the points that count, None if excused, and the late penalty in them (0 or less).

    `is_final` says that a final mark replaces the points of the criteria.
    """

    points: Decimal | None
    late: Decimal = Decimal(0)
    is_final: bool = False


class Report(Named):
    """The points of one submission under one rubric, and everything that is said about them.

    `grade` makes it, `hinted` adds hints to its results, and a class adds marks and the grade of
    the student. Each format of `grader.report` lays it out; none of them decides anything.

    >>> from grader.lab.grading.grade import grade
    >>> from grader.lab.rubric.rubric import load_rubric
    >>> from grader.lab.submission.opening import read_submission
    >>> submission = read_submission(b'<robot name="r"/>', identity="ash", path="r.urdf")
    >>> report = grade(load_rubric("lab6"), submission)
    >>> report
    <Report ash: lab6, 0/70, 0 points need manual grading>
    >>> report.score, report.results[0]
    (Decimal('0'), <Result urdf-loads: failed, 0/3>)
    >>> report.results[0].outcome.message
    'the robot has no <link>; ROS 2 rejects the file'
    """

    submission: Submission
    rubric: Rubric
    parts: Strings  # the ids of the graded ones
    results: Results  # one for each criterion of these parts, in the rubric's order
    problems: tuple[Problem, ...] = ()  # of the URDF and, where a package is graded, of its files
    evidence: tuple[EvidenceResult, ...] = ()
    other_pictures: "tuple[EvidenceFile, ...]" = ()  # that no piece of evidence asks for
    notes: Strings = ()  # sentences on how the submission was read
    another_robot: str = ""  # why the robot looks like that of another lab; empty if it does not
    by_convention: frozenset[str] = (
        frozenset()
    )  # the criteria that one decision on all frames costs; no hint is on one
    meant: Meant | None = None  # what was judged where words are surely others
    hints_complete: bool = True  # whether the search for hints ended before its budget did
    version: str = __version__  # of the grader
    grade: Grade | None = None  # in a class, where a person or the late penalty changes the score
    student: str = ""  # the name, in a class
    class_page: str = ""  # its address as seen from the student's page, if there is one

    def __repr__(self) -> str:
        """Return the submission, the rubric and the points."""
        points = f"{self.score}/{self.max_score}, {self.pending} points need manual grading"
        return f"<Report {printable(self.submission.id)}: {self.rubric.id}, {points}>"

    @property
    def all_notes(self) -> Strings:
        """The notes of the report.

        The first is on a robot that looks like another one, the last on hints that are
        missing.
        """
        notes = list(self.notes)
        if self.another_robot:
            notes.insert(0, self.another_robot)
        if not self.hints_complete:
            notes.append(INCOMPLETE_HINTS)
        return tuple(notes)

    @property
    def score(self) -> Decimal:
        """The points earned so far, without those that need manual grading."""
        return sum_points(result.points for result in self.results)

    @property
    def counting(self) -> Decimal | None:
        """The points that count for the student: the grade, else the score.

        It is None for an excused student.
        """
        if self.grade:
            return self.grade.points
        return self.score

    @property
    def is_bare(self) -> bool:
        """Whether the criteria say nothing.

        The student is excused, or the submission could not be read.
        """
        return self.counting is None or bool(self.submission.unread and not self.submission.path)

    @property
    def open_points(self) -> Decimal:
        """The points that need manual grading and can change what counts.

        There are none with a final mark or an excuse.
        """
        is_decided = self.grade is not None and (self.grade.is_final or self.grade.points is None)
        return _NOTHING if is_decided else self.pending

    @property
    def unearned(self) -> Results:
        """The automatic criteria that did not pass, except adjusted ones and extra credit."""
        automatic = (
            result
            for result in self.results
            if result.criterion.check.function not in MANUAL_CHECKS
        )
        counting = (
            result for result in automatic if not (result.is_adjusted or result.criterion.bonus)
        )
        return tuple(result for result in counting if result.outcome.status != "passed")

    @property
    def pending_automatic(self) -> list[Result]:
        """The automatic criteria that need manual grading here.

        Their subject could not be read.
        """
        return [
            result
            for result in self.results
            if result.is_open and result.criterion.check.function not in MANUAL_CHECKS
        ]

    @property
    def has_failures(self) -> bool:
        """Return whether a criterion has no points because of a mistake."""
        return any(result.is_lost for result in self.results)

    @property
    def max_score(self) -> Decimal:
        """The maximum of the graded parts, without extra credit."""
        return sum_points(result.criterion.maximum for result in self.results)

    @property
    def pending(self) -> Decimal:
        """The points that still need manual grading."""
        return sum_points(result.criterion.points for result in self.results if result.is_open)

    @property
    def bonus(self) -> Decimal:
        """The points of extra credit that were earned: they are part of the score."""
        return sum_points(result.points for result in self.results if result.criterion.bonus)

    @property
    def fault(self) -> str:
        """The message of the first failure of a check or the grader, except on adjusted criteria.

        It is empty without one.
        """
        errored = (
            one for one in self.results if one.outcome.status == "errored" and not one.is_adjusted
        )
        return next((one.outcome.message for one in errored), "")


def without_gifts(results: Iterable[Result], submission: Submission) -> Results:
    """Return results in which no adjustment gives points to a submission that could not be read."""
    if not submission.unread:
        return tuple(results)
    return tuple(
        one._replace(criterion=one.criterion._replace(adjustment=None))
        if one.criterion.is_given
        else one
        for one in results
    )


def sum_points(points: Iterable[Decimal]) -> Decimal:
    """Return the sum of points."""
    return sum(points, _NOTHING)
