"""Grade a submission as its words are meant.

One criterion pays for each slip, and the others are judged on what the slip surely stands for.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import starmap

from grader.base.problems import Problem
from grader.base.slips import Slip
from grader.base.text import enumerated, sentence_end
from grader.lab.checks.loading import list_with_lines, urdf_loads
from grader.lab.checks.outcome import SLIP, Outcome
from grader.lab.checks.xacro_source import xacro_uses
from grader.lab.grading.deciding import decide
from grader.lab.grading.report import Meant, PaidSlip, Result, Results, sum_points
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.edited import edited_files, with_files, with_urdf
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.xml import xml_problems

_MAX_SLIPS = 12  # because each is graded without the others
_MAX_NAMED = 3  # in a message

_Results = Mapping[str, Result]
_Slips = Sequence[Slip]
_Judged = tuple[Results, Meant | None]


def judge_as_meant(
    rubric: Rubric, submission: Submission, slips: _Slips, written: Sequence[Result]
) -> _Judged:
    """Return the results of criteria with each slip of a submission paid by one of them.

    Also return what they were judged on. `written` are those on the words as they are written.

    A slip in a file that ROS 2 loads counts only if no criterion fails with the meant word that
    passes with the written one: what ROS 2 ignores without harm is a comment.
    """
    return _Readings(rubric, submission, written).judged(slips[:_MAX_SLIPS])


class _Readings:
    """The results of a submission with some of its slips corrected, each set of them once."""

    def __init__(self, rubric: Rubric, submission: Submission, written: Sequence[Result]) -> None:
        self._rubric = rubric
        self._submission = submission
        self._written = {result.criterion.id: result for result in written}
        self._known: dict[tuple[Slip, ...], tuple[Submission, _Results]] = {
            (): (submission, self._written)
        }

    def judged(self, slips: _Slips) -> _Judged:
        """Return the results with those slips corrected that count."""
        counting = self._readable(slips)
        payers: dict[Slip, str] = {}
        while counting and len(payers) < len(counting):
            payers = {}
            for slip in counting:
                payer = self._payer(slip, counting)
                if payer is None:
                    counting = [other for other in counting if other is not slip]
                    break
                payers[slip] = payer
        if not counting:
            return tuple(self._written.values()), None
        submission, meant = self._read(counting)
        paid_by: dict[str, list[Slip]] = {}
        for slip, payer in payers.items():
            paid_by.setdefault(payer, []).append(slip)
        results = []
        for name, result in meant.items():
            if name in paid_by:
                results.append(self._paid(name, paid_by[name], counting))
            elif self._is_as_written(result, counting):
                results.append(self._written[name])
            else:
                results.append(result)
        # What is refused may pass where nothing of it is read: the marks are never lower for that.
        before = sum_points(result.points for result in self._written.values())
        is_lower = sum_points(result.points for result in results) < before
        if is_lower and _is_of_robot(counting):
            return tuple(self._written.values()), None
        paid = tuple(starmap(PaidSlip, payers.items()))
        return tuple(results), Meant(submission, tuple(meant.values()), paid)

    def _is_as_written(self, meant: Result, slips: _Slips) -> bool:
        """Return whether a criterion judges the words as they are written.

        What xacro cannot read has no words that it uses: these are judged as they are meant.
        """
        check = meant.criterion.check
        if not check.about.is_of_writing or self._written[meant.criterion.id].is_open:
            return False
        is_unread = check.function is xacro_uses and all(slip.is_refused for slip in slips)
        return not is_unread

    def _readable(self, slips: _Slips) -> list[Slip]:
        """Return the slips whose edits fit together."""
        fitting: list[Slip] = []
        for slip in slips:
            edits = [edit for one in (*fitting, slip) for edit in one.edits]
            if edited_files(self._submission, edits) is not None:
                fitting.append(slip)
        return fitting

    def _read(self, slips: _Slips) -> tuple[Submission, _Results]:
        key = tuple(slips)
        if key not in self._known:
            submission = _corrected(self._submission, key)
            results = decide(self._rubric, submission, self._written)
            self._known[key] = submission, {result.criterion.id: result for result in results}
        return self._known[key]

    def _payer(self, slip: Slip, slips: _Slips) -> str | None:
        """Return the criterion that pays for a slip beside the others.

        It is None if the slip does not count: it changes nothing, or a criterion fails with the
        word that is meant.
        """
        others = [other for other in slips if other is not slip]
        before_submission, before = self._read(others)
        after_submission, after = self._read(slips)
        changed = []
        for name, result in before.items():
            meant = after[name]
            if not slip.is_refused:
                is_unpassed = meant.outcome.status != "passed" and not meant.carried
                if result.outcome.status == "passed" and is_unpassed:
                    return None
                if result.criterion.check.about.is_of_writing:
                    continue
            if (result.is_lost or result.is_open) and _is_changed(result, meant):
                changed.append(result)
        if not (slip.is_refused or changed):
            return None
        return self._choose_payer(before_submission, after_submission, before, changed)

    def _choose_payer(
        self,
        before_submission: Submission,
        after_submission: Submission,
        before: Mapping[str, Result],
        changed: Sequence[Result],
    ) -> str | None:
        """Return the criterion that pays for a slip which changes these results, if there is one.

        The first choice is that the URDF loads, then come failures, then all other results.
        """
        loading = []
        if _list_parts(before_submission) != _list_parts(after_submission):
            loading = [
                payer for payer in before.values() if payer.criterion.check.function is urdf_loads
            ]
        failed = [result for result in changed if result.outcome.status == "failed"]
        return next((payer.criterion.id for payer in (*loading, *failed, *changed)), None)

    def _paid(self, name: str, paid: _Slips, slips: _Slips) -> Result:
        """Return the failure of a criterion that pays for slips."""
        others = [other for other in slips if other not in paid]
        written = self._read(others)[1][name]
        meant = self._read(slips)[1][name]
        outcome = written.outcome
        first = paid[0]
        message = enumerated(dict.fromkeys(slip.reaction for slip in paid), _MAX_NAMED)
        failure = Outcome(
            "failed", message, location=first.location, mistake=first.reaction, problem=message
        )
        if outcome.status == "failed":
            reported = outcome.problem or outcome.message
            failure = outcome._replace(
                absent=(), mistake=outcome.mistake or outcome.message, problem=reported
            )
            if not first.is_refused:
                problem = outcome.problem or first.reaction
                failure = failure._replace(location=first.location, problem=problem)
            if not (outcome.problem or first.is_refused):
                failure = failure._replace(message=f"{message}: {outcome.message}")
        text = f"{sentence_end(failure.message)} {_correction_text(paid)}"
        left = meant.outcome
        is_another = (left.problem or left.message) != failure.problem
        if meant.is_lost and left.status == "failed" and is_another:
            text += f". Even so, {left.message}"
        return Result(written.criterion, failure._replace(message=text, cause=SLIP))


def _correction_text(slips: Iterable[Slip]) -> str:
    places = []
    for slip in slips:
        path = slip.location.path
        changed = [edit.location for edit in slip.edits if edit.old and edit.path == path]
        places += [(slip.assumption, at) for at in changed or [slip.location]]
    assumed = list_with_lines(places)
    return f"The rest is graded with this correction: {assumed}"


def problems_as_meant(problems: Iterable[Problem], meant: Meant) -> Iterator[Problem]:
    """Yield the problems of a URDF that are left with the words that are meant.

    Also yield those at these words or for which ROS 2 rejects the file, and what is assumed about
    each.
    """
    urdf = meant.submission.urdf
    problems_left = urdf.problems if isinstance(urdf, Read) else ()
    left = {(problem.kind, problem.location.line) for problem in problems_left}
    lines = {paid.slip.location.file_and_line for paid in meant.paid}
    for problem in problems:
        at = problem.location
        is_left = at.file_and_line in lines or (problem.kind, at.line) in left
        is_cause = problem.kind.effect == "rejects" and not problem.kind.is_consequence
        if is_left or is_cause:
            yield problem
    for paid in meant.paid:
        yield Problem(xml_problems.RECOVERED, paid.slip.assumption, paid.slip.location)


def _corrected(submission: Submission, slips: _Slips) -> Submission:
    """Return a submission with the words that are meant."""
    files = edited_files(submission, [edit for slip in slips for edit in slip.edits])
    assert files is not None
    urdf = submission.urdf
    # A launch file that runs xacro fails if xacro writes a warning.
    if (
        isinstance(urdf, Read)
        and _is_of_robot(slips)
        and (not submission.package or not urdf.is_expanded)
    ):
        return with_urdf(submission, files)
    return with_files(submission, files)


def _is_of_robot(slips: Iterable[Slip]) -> bool:
    """Return whether slips are in files of the robot alone."""
    paths = [edit.path for slip in slips for edit in slip.edits]
    return all(path.endswith((".urdf", ".xacro")) for path in paths)


def _is_changed(before: Result, after: Result) -> bool:
    """Return whether a criterion has another outcome, wherever it is."""
    return (before.points, before.outcome[:6]) != (after.points, after.outcome[:6])


def _list_parts(submission: Submission) -> tuple[frozenset[str], frozenset[str]]:
    """Return the names of the links and joints of the robot."""
    robot = submission.robot
    if not robot:
        return frozenset(), frozenset()
    links = frozenset(link.name for link in robot.links)
    return links, frozenset(joint.name for joint in robot.joints)
