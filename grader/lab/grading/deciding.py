"""Decide criteria: run the rubric's checks in order, and attribute each failure.

Evidence may take the place of work that a submission lacks, its URDF or its package, in manual
grading.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

from grader.base.errors import MachineError, MissingElement, NotDecided, OutOfTime, RubricError
from grader.base.grouping import StringsByName
from grader.base.names import near
from grader.base.source import LazyLocation, Location
from grader.base.text import enumerated
from grader.lab.checks.check import Check
from grader.lab.checks.loading import urdf_loads
from grader.lab.checks.outcome import Outcome, compute_location, find_fault, pending
from grader.lab.grading.report import Result
from grader.lab.grading.subjects import Subjects
from grader.lab.rubric.criterion import Carried, Criterion
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Absent
from grader.ros.urdf.model import Robot
from grader.ros.urdf.shapes import UnknownShape

_MAX_PICTURES = 50
_MAX_LISTED = 6


def decide(rubric: Rubric, submission: Submission, wanted: Collection[str]) -> Iterator[Result]:
    """Yield the results of criteria in the rubric's order.

    What a criterion requires counts if it is wanted, too.
    """
    grading = _Grading(rubric, submission)
    left = {criterion.id for criterion in rubric.criteria if criterion.id in wanted}
    waiting = []  # one that a criterion below may still excuse, and those after it
    for criterion in (asked for asked in rubric.criteria if asked.id in wanted):
        grading.decide(criterion)
        left.discard(criterion.id)
        waiting.append(criterion.id)
        while waiting and not grading.may_be_excused(waiting[0], left):
            yield grading.results[waiting.pop(0)]


def _manual_subjects(rubric: Rubric, submission: Submission) -> StringsByName:
    """Return what a submission lacks, and why.

    Criteria about it then need manual grading by the rubric.

    Without a URDF, `without_urdf` decides for the package as well.
    """
    is_wanted = "manual" in (rubric.without_urdf, rubric.without_package)
    lacking = _missing_work(rubric, submission) if is_wanted else {}
    if rubric.without_urdf == "manual" and "URDF" in lacking:
        return lacking
    if rubric.without_package == "manual" and "package" in lacking:
        return {"package": lacking["package"]}
    return {}


class _Grading:
    """The criteria decided so far, and which of them was the first that misses a thing."""

    def __init__(self, rubric: Rubric, submission: Submission) -> None:
        self._rubric = rubric
        self.submission = submission
        self._manual = _manual_subjects(rubric, submission)
        if "URDF" in self._manual:
            submission = replace(submission, urdf=Absent())
        if "package" in self._manual:
            submission = replace(submission, package=None, lab_packages={})
        self._subjects = Subjects(rubric, submission)
        self.results: dict[str, Result] = {}
        self.missed: dict[tuple[str, str, str], str] = {}
        # by each criterion, those whose points its failure may carry forward
        self._excused_by: dict[str, list[str]] = {}
        for criterion in rubric.criteria:
            for cause in {cause for carried in criterion.carried for cause in carried.causes}:
                self._excused_by.setdefault(cause, []).append(criterion.id)

    def decide(self, criterion: Criterion) -> None:
        """Run the check of a criterion, or skip it because of another that failed."""
        cause = self._blocking_cause(criterion)
        if cause:
            result = Result(criterion, _skip_outcome(cause), cause)
        else:
            result = self._decide_by_check(criterion)
        self.results[criterion.id] = self._carry_from_any(result)
        for name in self._excused_by.get(criterion.id, ()):
            if name in self.results:
                self.results[name] = self._carry_from_any(self.results[name])

    def may_be_excused(self, name: str, undecided: set[str]) -> bool:
        """Return whether an undecided criterion's mistake may be why this one is lost."""
        result = self.results[name]
        if not result.criterion.carried or not result.is_lost:
            return False
        return any(not undecided.isdisjoint(carried.causes) for carried in result.criterion.carried)

    def _carry_from_any(self, result: Result) -> Result:
        for carried in result.criterion.carried:
            result = self._carry(result, carried) if result.is_lost else result
        return result

    def _blocking_cause(self, criterion: Criterion) -> str | None:
        """Return the criterion because of which this one is skipped, if there is one."""
        for name in criterion.requires:
            required = self.results.get(name)
            if required and required.is_lost:
                return required.because or name
        if self._subjects.robot or criterion.check.subject != "robot":
            return None
        for result in self.results.values():
            is_of_loading = result.criterion.check.function is urdf_loads
            if is_of_loading and result.outcome.status == "failed":
                return result.criterion.id
        return None

    def _decide_by_check(self, criterion: Criterion) -> Result:
        try:
            result = self._run_check(criterion, criterion.check, criterion.arguments)
        except MissingElement as missing:
            return self._fail_or_skip(criterion, missing)
        return self._with_reasons(result)

    def _with_reasons(self, result: Result) -> Result:
        """Return a failure with what explains it."""
        if result.outcome.status != "failed":
            return result
        criterion = result.criterion
        outcome = result.outcome
        if not all(self._is_unbuilt(name) for name in outcome.absent if name in self._rubric.links):
            outcome = outcome._replace(absent=())
        outcome = self._explain(outcome, looks_at=criterion.check.about.looks_at)
        return result._replace(outcome=self._with_place(outcome, criterion))

    def _with_place(self, outcome: Outcome, criterion: Criterion) -> Outcome:
        """Return a failure of the robot with a place.

        Without an own one, it gets that of the link that is examined.
        """
        robot = self.submission.robot
        link = criterion.arguments.get("link")
        if outcome.location or outcome.absent or not robot or criterion.check.subject != "robot":
            return outcome
        named = (
            [robot.link(link)] if isinstance(link, str) and robot.has_link(link) else robot.links
        )
        locations = [compute_location(examined.known.location) for examined in named[:1]]
        return outcome._replace(location=next(iter(locations), None))

    def _explain(self, outcome: Outcome, *thing: str, looks_at: Collection[str] = ()) -> Outcome:
        from grader.lab.grading.explanation import explain  # late: many submissions lose nothing

        return explain(outcome, self._subjects.problems, self._subjects.source, looks_at, *thing)

    def _carry(self, result: Result, carried: Carried) -> Result:
        """Return a failure, or a skip because of a cause, as carried.

        It is carried only if the fact that then counts instead holds.
        """
        cause = self._find_cause(result, carried.causes)
        if not cause:
            return result
        try:
            other = self._run_check(carried.of(result.criterion), carried.check, carried.arguments)
            other = other._replace(criterion=result.criterion)
        except MissingElement:
            return result
        name = cause.criterion.id
        outcome = result.outcome
        if outcome.status == "skipped":
            outcome = Outcome("failed", f"it cannot be measured, because {name} failed")
        if other.outcome.status == "pending":
            reason = (
                f"whether this is due to {name} alone cannot be decided: {other.outcome.message}"
            )
            return other._replace(
                outcome=pending(f"{outcome.message}; {reason}", other.outcome.mistake)
            )
        if other.outcome.status == "passed":  # the place to look at is that of the mistake
            outcome = outcome._replace(location=cause.outcome.location)
            return Result(result.criterion, outcome, carried=cause.carried or name)
        if self._is_shown(result) and other.outcome.status != "errored":
            return result
        return self._with_reasons(other)

    def _is_shown(self, result: Result) -> bool:
        """Return whether a report shows why a criterion is lost."""
        if result.outcome.location:
            return True
        if not result.because:
            return False
        # What is skipped because of a failure is shown there, unless that is carried as well.
        return not self.results[result.because].carried

    def _is_excused(self, criterion: Criterion, cause: str) -> bool:
        """Return whether what counts instead passes.

        It does so only if another criterion is the cause of a failure.
        """
        for carried in (
            carried_failure
            for carried_failure in criterion.carried
            if cause in carried_failure.causes
        ):
            with suppress(MissingElement):
                if (
                    self._run_check(
                        carried.of(criterion), carried.check, carried.arguments
                    ).outcome.status
                    == "passed"
                ):
                    return True
        return False

    def _find_cause(self, result: Result, causes: Sequence[str]) -> Result | None:
        """Return the failure that made the first of these criteria fail or be skipped.

        The failure counts only if it made the result so, too.

        A skip because of a criterion that is itself carried from that failure counts, too.
        """
        because = result.because
        cause = self.results.get(because) if because else None
        origins = [because]
        if cause:
            origins.append(cause.carried)
        for name in causes:
            if name not in self.results:
                continue
            before = self.results[name]
            # None for one that is below
            mistake = self.results.get(before.because or before.criterion.id)
            if not mistake or mistake.outcome.status != "failed":
                continue
            if not because or mistake.criterion.id in origins:
                return mistake
        return None

    def _run_check(
        self, criterion: Criterion, check: Check, arguments: Mapping[str, Any]
    ) -> Result:
        """Return the result of a check.

        Raise MissingElement, or RubricError for a mistake of the rubric.
        """
        try:
            subjects = self._subjects.under(criterion.args)
            examined = subjects.of(check, criterion)
            arguments = subjects.named(check, arguments) if criterion.has_selectors else arguments
            outcome = check.outcome(examined, arguments)
            fault = find_fault(outcome) if check.distribution else ""
            conditions = [f"{name}:={value}" for name, value in criterion.args.items()]
            if criterion.at and not fault:
                conditions.append(subjects.pose_text(criterion.at))
            if conditions:
                outcome = outcome._replace(
                    message=f"{outcome.message} (with {enumerated(conditions)})"
                )
            return Result(criterion, _fault_outcome(check, fault) if fault else outcome)
        except (MissingElement, MachineError):
            raise
        except RubricError as error:
            place = self._rubric.find_place(("criterion", criterion.position, "with"))
            raise RubricError(
                tuple(f"{place}: {criterion.id}: {line}" for line in error.complaints)
            ) from None
        except (UnknownShape, NotDecided) as reason:
            cause = reason.cause if isinstance(reason, NotDecided) else "mesh files are not opened"
            return Result(criterion, pending(f"{reason}; needs manual grading", cause))
        except (KeyboardInterrupt, OutOfTime):
            raise
        # A faulty check, even one that exits, affects only its own criterion.
        except BaseException as error:  # noqa: BLE001
            from traceback import format_exc  # needed only for a fault of the grader

            return Result(
                criterion, _fault_outcome(check, _describe_error(error)), traceback=format_exc()
            )

    def _fail_or_skip(self, criterion: Criterion, missing: MissingElement) -> Result:
        """Return a failure for the first criterion that misses a thing.

        Later ones would repeat it and are skipped.
        """
        if missing.kind in self._manual:
            return Result(criterion, _by_evidence(self.submission, self._manual[missing.kind]))
        if missing.kind == "link":
            missing = another_robot(self._rubric, self.submission.robot, missing.name) or missing
        within = "" if missing.kind == "package" else criterion.package
        first = self._first_miss(criterion, (missing.kind, missing.name, within))
        if first != criterion.id and not missing.costs_once:
            return Result(criterion, _skip_outcome(first), first)
        at = missing.location if isinstance(missing.location, Location | LazyLocation) else None
        outcome = Outcome(
            "failed",
            str(missing),
            location=compute_location(at),
            mistake=missing.mistake,
            problem=missing.problem,
            absent=self._list_absent(missing),
            cause=missing.cause,
        )
        if first != criterion.id:
            return Result(criterion, outcome, carried=first)
        outcome = self._explain(outcome, missing.kind, missing.name)
        return Result(criterion, self._with_place(outcome, criterion))

    def _list_absent(self, missing: MissingElement) -> Sequence[str]:
        """Return what is not built yet, if that is all."""
        if missing.kind == "link":
            if missing.name in self._rubric.links and self._is_unbuilt(missing.name):
                return (missing.name,)
            return ()
        return (missing.absent,) if missing.absent else ()

    def _is_unbuilt(self, name: str) -> bool:
        """Return whether no link of the robot may be meant by the name of a missing one."""
        robot = self.submission.robot
        wanted = self._rubric.links
        others = []
        for link in robot.links if robot else ():
            if link.known.name in wanted:
                continue
            if link.known.visuals:
                return False
            others.append(link.known.name)
        return not near(name, others, "link")

    def _first_miss(self, criterion: Criterion, thing: tuple[str, str, str]) -> str:
        """Return the first criterion that misses a thing, which may be this one.

        An adjusted one excuses no other.

        One that is carried from this one is skipped in its place, although it stands above.
        """
        first = self.missed.get(thing, criterion.id)
        before = self.results.get(first)
        if before and self._is_excused(before.criterion, criterion.id):
            self.results[first] = Result(
                before.criterion, _skip_outcome(criterion.id), criterion.id
            )
            first = criterion.id
        if not criterion.adjustment:
            self.missed[thing] = first
        return first


def _skip_outcome(cause: str) -> Outcome:
    return Outcome("skipped", f"skipped because {cause} failed")


def _describe_error(error: BaseException) -> str:
    """Return the type and text of an exception, or only its type where making the text fails."""
    try:
        return f"{type(error).__name__}: {error}"
    except (KeyboardInterrupt, OutOfTime):
        raise
    except BaseException:  # noqa: BLE001  another package's code
        return type(error).__name__


def _fault_outcome(check: Check, fault: str) -> Outcome:
    """Return the outcome of a faulty check.

    The message names the installed package that it comes from.
    """
    if check.distribution:
        return Outcome(
            "errored",
            f"the check {check.name} of the package {check.distribution} is faulty: {fault}",
        )
    return Outcome(
        "errored", f"the grader itself failed ({fault.partition(':')[0]}); please report it"
    )


def another_robot(rubric: Rubric, robot: Robot | None, link: str = "") -> MissingElement | None:
    """Return the error for a robot that is another one, and so has no `link`.

    It is None if it may be that of the lab.
    """
    if not robot or not robot.is_foreign(rubric.links):
        return None
    missing = f"there is no link {link!r}, and " if link else ""
    message = f"{missing}this looks like another robot: it has {_known_links_text(rubric, robot)}"
    names = enumerated([repr(link.name) for link in robot.links], _MAX_LISTED) or "no link"
    detail = f" ({enumerated(sorted(rubric.links), _MAX_LISTED)}); it has {names}"
    location = robot.links[0].location if robot.links else None
    return MissingElement("robot of the lab", "", message=message, detail=detail, location=location)


def _known_links_text(rubric: Rubric, robot: Robot) -> str:
    count = robot.known_links(rubric.links)
    return (
        f"{f'only {count} of the {len(rubric.links)}' if count else 'none of the'} links of the "
        f"rubric {rubric.id}"
    )


def _missing_work(rubric: Rubric, submission: Submission) -> StringsByName:
    """Return what a submission with evidence lacks, and why.

    This is the `URDF` or the `package` of this lab.
    """
    missing = {}
    robot = submission.robot
    if isinstance(submission.urdf, Absent):
        missing["URDF"] = submission.urdf.reason
    elif robot and robot.is_another(rubric.links):
        another = another_robot(rubric, robot)
        lacking = f"the robot has {_known_links_text(rubric, robot)}"
        missing["URDF"] = another.mistake if another else lacking
    package = submission.package
    if not package:
        missing["package"] = submission.no_package.message
    elif (
        package.name != rubric.package
        and submission.other_lab
        and package.folder.startswith(submission.other_lab)
    ):
        missing["package"] = (
            f"no package was submitted for this lab; {package.name!r} is in the folder of "
            "another lab"
        )
    if missing and not submission.is_single and submission.evidence_files:
        return missing
    return {}


def _by_evidence(submission: Submission, reason: str) -> Outcome:
    """Return the outcome of a criterion of what a submission lacks, for this reason.

    It is for where evidence takes the place of the thing.
    """
    paths = tuple(file.path for file in submission.evidence_files[:_MAX_PICTURES])
    verb = "was" if len(paths) == 1 else "were"
    message = (
        f"{reason}, but {enumerated(paths, _MAX_LISTED)} {verb} submitted; needs manual grading"
    )
    return pending(message, f"{reason}, but evidence")._replace(measured=paths)
