"""Grade a submission: the parts that are graded, the decided criteria, and the notes of the report."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from decimal import Decimal
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.grading.deciding import decide
from grader.grading.evidence import evidence_of, not_searched
from grader.grading.graded_submission import GradedSubmission
from grader.grading.missing_work import missing_work, robot_of
from grader.grading.report import Report, Result
from grader.grading.rubric import Rubric
from grader.robot.kinematics import Configuration
from grader.submission.submission import Submission
from grader.submission.urdf import Read
from grader.text import counted_points, enumerated

if TYPE_CHECKING:
    from grader.robot.conventions import Convention

_EXPANDED = "the URDF is xacro: it was expanded, as xacro does before ROS 2 reads it"
_NOT_EXPANDED = (
    "the URDF is xacro, but is loaded without xacro; all but its loading is graded on what xacro makes of it"
)
_MIN_OF_CONVENTION = 2  # criteria that a convention decides
_NO_HINTS = "no hints were searched, because reading this robot takes too much work"
_ELSEWHERE = "the graded URDF is outside the graded package"


def grade(
    rubric: Rubric, submission: Submission, parts: Sequence[str] = (), *, is_one_of_class: bool = False
) -> Report:
    """Return the report on a submission for all parts of the rubric, or the named ones; raises InputError for others.

    A single URDF is graded only on parts that need no more, unless it `is_one_of_class`: a class is graded on the same
    parts.
    """
    is_whole = is_one_of_class or not submission.is_single
    chosen, notes = _chosen_parts(rubric, submission, parts, is_whole=is_whole)
    wanted = {criterion.id for criterion in rubric.criteria if criterion.part in chosen}
    results = tuple(decide(rubric, submission, wanted))
    problems = submission.urdf.problems if isinstance(submission.urdf, Read) else ()
    if submission.package is not None and any(rubric.part(part).needs == "package" for part in chosen):
        from grader.package.problems import package_problems  # a URDF on its own needs none of what reads a package

        problems += package_problems(submission.package)
    evidence = evidence_of(rubric, submission, chosen if is_whole else ())
    notes += not_searched(submission, evidence[0])
    notes += _note_on_convention(rubric, submission, results)
    if submission.is_costly and rubric.hints != "none" and any(result.is_lost for result in results):
        notes += (_NO_HINTS,)
    graded = GradedSubmission.of(submission, tuple(missing_work(rubric, submission)))
    return Report(graded, rubric, chosen, results, problems, *evidence, notes)


def _chosen_parts(
    rubric: Rubric, submission: Submission, named: Sequence[str], *, is_whole: bool
) -> tuple[tuple[str, ...], ...]:
    """Return the graded parts, and notes for the report: what is not whole is graded only on parts that need a URDF."""
    for name in named:
        if rubric.part(name).needs != "urdf" and not is_whole:
            raise InputError(f"{name} needs more than a URDF: give the folder or archive that was submitted")
    parts = [part for part in rubric.parts if not named or part.id in named]
    chosen = tuple(part.id for part in parts if part.needs == "urdf" or is_whole)
    notes = [*submission.notes, *_notes_on_xacro(submission)]
    package, path = submission.package, submission.path
    if package is not None and path is not None and not path.startswith(f"{package.folder}/" if package.folder else ""):
        notes.append(_ELSEWHERE)
    skipped = [part.id for part in parts if part.id not in chosen]
    if skipped:
        only, verb = enumerated(chosen) or "nothing", "need" if len(skipped) > 1 else "needs"
        notes.append(f"only {only} is graded: {enumerated(skipped)} {verb} the whole folder")
    return chosen, tuple(notes)


def _note_on_convention(rubric: Rubric, submission: Submission, results: Sequence[Result]) -> tuple[str, ...]:
    """Return a note on frames of the whole robot that are turned or moved alike, if undoing that makes criteria pass.

    The points stay: the lab says where its frames are. The note says that they are lost by one decision, not by many
    mistakes.
    """
    lost = {result.criterion.id for result in results if result.is_lost and result.criterion.check.subject == "robot"}
    found = _convention(rubric, submission) if len(lost) >= _MIN_OF_CONVENTION else None
    if found is None or not isinstance(submission.urdf, Read):
        return ()
    reading = replace(submission.urdf.reading, robot=found.robot)
    other = replace(submission, urdf=submission.urdf._replace(reading=reading))
    decided = [result for result in results if result.criterion.check.subject in ("urdf", "robot")]
    after = {result.criterion.id: result for result in decide(rubric, other, {it.criterion.id for it in decided})}
    before = {result.criterion.id for result in decided if result.outcome.status == "passed"}
    gained = [after[name].criterion.points for name in lost if after[name].outcome.status == "passed"]
    is_one = len(gained) >= _MIN_OF_CONVENTION and all(after[name].outcome.status == "passed" for name in before)
    points = counted_points(sum(gained, Decimal(0)))
    return (f"everything is {found.description} relative to the handout: one decision, {points}",) if is_one else ()


def _convention(rubric: Rubric, submission: Submission) -> "Convention | None":
    """Return how all frames of a robot are turned or moved, compared with the reference."""
    robot = robot_of(submission.urdf)
    if robot is None or rubric.solution is None:
        return None
    from grader.robot.conventions import convention_of  # late: most robots lose few points

    with suppress(InputError):
        return convention_of(Configuration(robot), rubric.solution.robot, rubric.base)
    return None


def _notes_on_xacro(submission: Submission) -> list[str]:
    if not isinstance(submission.urdf, Read) or not submission.urdf.is_expanded:
        return []
    return [_EXPANDED if submission.urdf.as_it_stands is None else _NOT_EXPANDED]
