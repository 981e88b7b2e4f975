"""Grade a submission: run the rubric's checks in order and say whose fault each miss is."""

from collections.abc import Sequence

from grader.checks.outcome import Outcome, fault_of
from grader.checks.registry import Check, Subject
from grader.errors import MissingElement, NotDecided
from grader.grading.report import Report, Result
from grader.grading.rubric import Criterion, Rubric
from grader.grading.scope import chosen_parts, exhibits_of
from grader.problems import Problem
from grader.robot.catalogue import (
    BAD_COLOUR,
    BAD_INERTIAL,
    BAD_VISUAL,
    COLOUR_COUNT,
    DEFAULT_AXIS,
    DEGREES,
    RAW_XACRO,
    UNDEFINED_MATERIAL,
)
from grader.robot.kinematics import Configuration
from grader.robot.shapes import UnknownShape
from grader.source import Location, Spot
from grader.submission.submission import Submission
from grader.text import quoted

# Problems that say why a measurement came out as it did.
_TELLING = (BAD_COLOUR, COLOUR_COUNT, DEGREES, UNDEFINED_MATERIAL)


def grade(rubric: Rubric, submission: Submission, parts: Sequence[str] = ()) -> Report:
    """The report on a submission, for all parts of the rubric or those that are named (raises InputError for others)."""
    chosen, notes = chosen_parts(rubric, submission, parts)
    run = _Run(submission)
    for criterion in rubric.criteria:
        if criterion.part in chosen:
            run.decide(criterion)
    problems = submission.urdf.problems if submission.urdf is not None else ()
    if submission.xacro == "left":
        problems = tuple(problem for problem in problems if problem.kind is RAW_XACRO)
    if submission.package is not None and any(rubric.part(each).needs == "package" for each in chosen):
        from grader.package.problems import package_problems  # a URDF on its own needs none of what reads a package

        problems += package_problems(submission.package)
    exhibits, others = exhibits_of(rubric, submission, chosen)
    return Report(submission, rubric, chosen, tuple(run.results.values()), problems, exhibits, others, notes)


class _Run:
    """The criteria decided so far, and which of them was the first to miss a thing."""

    def __init__(self, submission: Submission) -> None:
        self.submission = submission
        self.urdf = submission.urdf
        robot = self.urdf.robot if self.urdf is not None else None
        self.robot = Configuration(robot) if robot is not None else None
        self.results: dict[str, Result] = {}
        self.missed: dict[tuple[str, str], str] = {}
        self._at_hand: dict[Subject, object] = {"submission": submission}
        if submission.urdf is not None and submission.xacro != "left":
            self._at_hand["urdf"] = submission.urdf
            if self.robot is not None:
                self._at_hand["robot"] = self.robot

    @property
    def _problems(self) -> tuple[Problem, ...]:
        return self.urdf.problems if self.urdf is not None else ()

    def decide(self, criterion: Criterion) -> None:
        cause = self._cause(criterion) if criterion.requires or self.robot is None else None
        result = Result(criterion, _skipped(cause), cause) if cause else self._ask(criterion)
        self.results[criterion.id] = result

    def _cause(self, criterion: Criterion) -> str | None:
        """The criterion whose failure keeps this one from being decided."""
        for name in criterion.requires:
            required = self.results.get(name)
            if required is not None and required.outcome.status in ("failed", "skipped"):
                return required.because or name
        if self.robot is None and criterion.check.subject == "robot":
            asked = (each for each in self.results.values() if each.criterion.check.subject == "urdf")
            return next((each.criterion.id for each in asked if each.outcome.status == "failed"), None)
        return None

    def _ask(self, criterion: Criterion) -> Result:
        try:
            asked = criterion.check.subject
            subject = self._at_hand.get(asked) or self._missing(asked)
            outcome = criterion.check.function(subject, **criterion.arguments)
            fault = fault_of(outcome) if criterion.check.distribution else ""
            if fault:
                return Result(criterion, _errored(criterion.check, fault))
            if outcome.status == "failed":
                outcome = self._explained(outcome)
            return Result(criterion, outcome)
        except MissingElement as missing:
            return self._miss(criterion, missing)
        except UnknownShape as unknown:
            return Result(criterion, Outcome("pending", f"{unknown}; a person has to look at it"))
        except NotDecided as reason:
            return Result(criterion, Outcome("pending", f"{reason}; a person has to look"))
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # noqa: BLE001  a faulty check, even one that exits, costs the student nothing else
            from traceback import format_exc  # only ever needed here

            fault = _words_of(error)
            return Result(criterion, _errored(criterion.check, fault), traceback=format_exc())

    def _missing(self, name: Subject) -> object:
        """The package; for whatever else is asked of and is not at hand, raises MissingElement or NotDecided."""
        if name == "package":
            return self.submission.needed_package()
        self.submission.needed_urdf()
        raise MissingElement("robot", "", message="ROS 2 cannot read the file, so there is no robot to look at")

    def _miss(self, criterion: Criterion, missing: MissingElement) -> Result:
        """The first criterion that misses a thing fails; those after it would only repeat it, and are skipped."""
        key = (missing.kind, missing.name)
        first = self.missed.setdefault(key, criterion.id)
        if first != criterion.id:
            return Result(criterion, _skipped(first), first)
        at = missing.location.location() if isinstance(missing.location, Spot) else missing.location
        outcome = Outcome("failed", str(missing), location=at if isinstance(at, Location) else None)
        if missing.kind == "visual":
            return Result(criterion, self._dropped(outcome, missing.name))
        return Result(criterion, self._explained(outcome))

    def _explained(self, outcome: Outcome) -> Outcome:
        """A failure with what ROS 2 has to say of the place that it points to."""
        for problem in self._problems:
            tells = problem.kind in _TELLING or (problem.kind is DEFAULT_AXIS and outcome.unit == "deg")
            if tells and problem.location == outcome.location:
                return outcome._replace(message=f"{outcome.message} ({problem.code}: {problem.message})")
        return outcome

    def _dropped(self, outcome: Outcome, link: str) -> Outcome:
        """A link that shows nothing, with the reason why ROS 2 has dropped what the file gives it."""
        for problem in self._problems:
            if problem.kind in (BAD_VISUAL, BAD_INERTIAL) and f"link {quoted(link)}" in problem.message:
                return outcome._replace(message=f"{outcome.message}: {problem.message}", location=problem.location)
        return outcome


def _skipped(cause: str) -> Outcome:
    return Outcome("skipped", f"not decided, because {cause} failed")


def _words_of(error: BaseException) -> str:
    """What an exception says, even one whose text cannot be made."""
    try:
        return f"{type(error).__name__}: {error}"
    except KeyboardInterrupt:
        raise
    except BaseException:  # noqa: BLE001  another package's code
        return type(error).__name__


def _errored(check: Check, fault: str) -> Outcome:
    """A criterion that nobody could decide because its check is faulty; an installed package answers for its own."""
    if check.distribution:
        return Outcome("errored", f"the check {check.name} of the package {check.distribution} is faulty: {fault}")
    return Outcome("errored", f"the grader itself failed here ({fault.partition(':')[0]}); please report it")
