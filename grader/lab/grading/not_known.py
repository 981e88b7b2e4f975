"""Judge what is written of elements that ROS 2 drops, because a value of them is not known."""

from collections.abc import Collection, Iterable
from dataclasses import replace

from grader.lab.grading.deciding import decide
from grader.lab.grading.report import Result
from grader.lab.rubric.criterion import Criterion
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.urdf.reader import read_with_dropped


def judge_known(
    rubric: Rubric,
    submission: Submission,
    results: Iterable[Result],
    wanted: Collection[str],
    paying: Collection[str] = (),
) -> Iterable[Result]:
    """Return the results with those of what is known, where an element is dropped.

    The first criterion that is lost and needs what is not known pays; without one, the first that
    is lost as written. No criterion is worse than as written, and those that are `paying` for
    slips stay as they are.
    """
    known = _with_dropped(submission)
    if not known:
        return results
    results = tuple(results)
    lost = [
        result
        for result in results
        if result.is_lost and result.criterion.id not in paying and _is_of_robot(result.criterion)
    ]
    judged = _with_payers(lost, decide(rubric, known, wanted))
    if not any(_pays(judged[result.criterion.id], result) for result in lost):
        for result in [each for each in lost if not judged[each.criterion.id].is_lost][:1]:
            judged[result.criterion.id] = result
    return [judged.get(result.criterion.id, result) for result in results]


def _is_of_robot(criterion: Criterion) -> bool:
    """Return whether a criterion may fail for what is dropped: names do not depend on it."""
    return (
        "measure" in criterion.arguments
        or criterion.arguments.get("of") == "values"
        or criterion.check.subject not in ("package", "submission")
    )


def _with_dropped(submission: Submission) -> Submission | None:
    """Return a submission whose robot has what ROS 2 drops; None if it drops nothing."""
    urdf = submission.urdf
    if not isinstance(urdf, Read):
        return None
    robot = read_with_dropped(urdf.reading, filter(None, [submission.distro]))
    if not robot:
        return None
    return replace(submission, urdf=urdf._replace(reading=urdf.reading._replace(robot=robot)))


def _pays(known: Result, written: Result) -> bool:
    """Return whether a criterion is lost for what is not known, or another one for which it is."""
    outcome = known.outcome
    is_at_place = outcome.status == "failed" and outcome.location is not None
    return bool(known.carried) or (is_at_place and outcome.mistake != written.outcome.mistake)


def _with_payers(lost: Collection[Result], known: Iterable[Result]) -> dict[str, Result]:
    """Return the results of lost criteria on what is known, by their ids.

    If the criterion that carries others passes as written, the first of these pays.
    """
    after = {result.criterion.id: result for result in known}
    names = {result.criterion.id for result in lost}
    payers: dict[str, str] = {}
    judged = {}
    for result in lost:
        name = result.criterion.id
        now = after[result.criterion.id]
        if now.carried and now.carried not in names:
            payer = payers.setdefault(now.carried, name)
            now = now._replace(carried="" if payer == name else payer)
        judged[name] = result if now.is_open else now
    return judged
