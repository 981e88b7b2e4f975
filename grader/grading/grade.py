"""Grade a submission: run the rubric's checks in order, and attribute each failure."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from grader.checks.outcome import Outcome, fault_of, location_of, pending
from grader.checks.registry import Check, Subject
from grader.errors import InputError, MissingElement, NotDecided
from grader.grading.explanation import explained
from grader.grading.report import Exhibits, GradedSubmission, Report, Result
from grader.grading.rubric import Criterion, Rubric
from grader.problems import Problem
from grader.robot.kinematics import Configuration
from grader.robot.shapes import UnknownShape
from grader.source import LazyLocation, Location
from grader.submission.submission import Submission, open_submission
from grader.submission.urdf import NeedsExpansion, Read
from grader.text import enumerated

if TYPE_CHECKING:
    from grader.documents.evidence import Exhibit

_MAX_PICTURES = 50
_EXPANDED = "the URDF is xacro: its properties and expressions were evaluated, as xacro does before ROS 2 reads it"
_ELSEWHERE = "the graded URDF is outside the graded package"


def grade(rubric: Rubric, submission: Submission, parts: Sequence[str] = ()) -> Report:
    """Return the report on a submission for all parts of the rubric, or for the named ones; raise InputError for others."""
    chosen, notes = _chosen_parts(rubric, submission, parts)
    grading = _Grading(submission)
    for criterion in rubric.criteria:
        if criterion.part in chosen:
            grading.decide(criterion)
    problems = submission.urdf.problems if isinstance(submission.urdf, Read | NeedsExpansion) else ()
    if submission.package is not None and any(rubric.part(part).needs == "package" for part in chosen):
        from grader.package.problems import package_problems  # a URDF on its own needs none of what reads a package

        problems += package_problems(submission.package)
    evidence = _evidence(rubric, submission, chosen)
    results = tuple(grading.results.values())
    return Report(GradedSubmission.of(submission), rubric, chosen, results, problems, *evidence, notes)


def _chosen_parts(rubric: Rubric, submission: Submission, named: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """Return the graded parts, and notes for the report: a single URDF is graded only on parts that need no package."""
    for name in named:
        if rubric.part(name).needs != "urdf" and submission.is_single:
            raise InputError(f"{name} needs more than a URDF: give the folder or archive that was submitted")
    parts = [part for part in rubric.parts if not named or part.id in named]
    chosen = tuple(part.id for part in parts if part.needs == "urdf" or not submission.is_single)
    notes = [_EXPANDED] if isinstance(submission.urdf, Read) and submission.urdf.is_expanded else []
    package, path = submission.package, submission.path
    if package is not None and path is not None and not path.startswith(f"{package.folder}/" if package.folder else ""):
        notes.append(_ELSEWHERE)
    skipped = [part.id for part in parts if part.id not in chosen]
    if skipped:
        only = enumerated(chosen) or "nothing"
        notes.append(
            f"a single URDF is graded on {only} only: {enumerated(skipped)} need the folder or archive it is in"
        )
    return chosen, tuple(notes)


def _evidence(
    rubric: Rubric, submission: Submission, chosen: Sequence[str]
) -> "tuple[tuple[Exhibits, ...], tuple[Exhibit, ...]]":
    """Return the evidence that the lab asks for, and the other pictures of the submission."""
    wanted = [evidence for evidence in rubric.evidence if evidence.part in chosen]
    if not wanted or submission.is_single:
        return (), ()
    from grader.documents.evidence import describe, find_evidence  # a URDF on its own has none

    found = tuple(Exhibits(evidence, find_evidence(submission.proofs, evidence.names)) for evidence in wanted)
    listed = {exhibit.path for exhibits in found for exhibit in exhibits.files}
    others = [proof for proof in submission.proofs if proof.file.path not in listed]
    return found, describe(others[:_MAX_PICTURES])


def open_reference(rubric: Rubric) -> Submission:
    """Return a rubric's own reference solution; raise InputError where it cannot be read."""
    return open_submission(str(rubric.path.parent / rubric.reference), wanted=rubric.urdf, package=rubric.package)


def grade_reference(rubric: Rubric) -> Report:
    """Return the report on a rubric's own reference solution; raise InputError where it cannot be read."""
    return grade(rubric, open_reference(rubric))


class _Grading:
    """The criteria decided so far, and which of them was the first that misses a thing."""

    def __init__(self, submission: Submission) -> None:
        self.submission = submission
        self.problems: tuple[Problem, ...] = ()
        self.robot: Configuration | None = None
        self.results: dict[str, Result] = {}
        self.missed: dict[tuple[str, str], str] = {}
        self._subjects: dict[Subject, object] = {"submission": submission}
        if isinstance(submission.urdf, Read):
            urdf = submission.urdf.reading
            self.problems = urdf.problems
            self.robot = Configuration(urdf.robot) if urdf.robot is not None else None
            self._subjects |= {"urdf": urdf, "robot": self.robot}

    def decide(self, criterion: Criterion) -> None:
        """Run the check of a criterion, or skip it because of another that failed."""
        cause = self._cause(criterion) if criterion.requires or self.robot is None else None
        result = Result(criterion, _skipped(cause), cause) if cause else self._check(criterion)
        self.results[criterion.id] = self._carried(result)

    def _cause(self, criterion: Criterion) -> str | None:
        """Return the criterion because of which this one is skipped, if there is one."""
        for name in criterion.requires:
            required = self.results.get(name)
            if required is not None and required.outcome.status in ("failed", "skipped") and not required.carried:
                return required.because or name
        if self.robot is None and criterion.check.subject == "robot":
            of_urdf = (result for result in self.results.values() if result.criterion.check.subject == "urdf")
            return next((result.criterion.id for result in of_urdf if result.outcome.status == "failed"), None)
        return None

    def _check(self, criterion: Criterion) -> Result:
        try:
            result = self._run(criterion, criterion.check, criterion.arguments)
        except MissingElement as missing:
            return self._miss(criterion, missing)
        if result.outcome.status != "failed":
            return result
        return result._replace(outcome=explained(result.outcome, self.problems))

    def _carried(self, result: Result) -> Result:
        """Return a failure, or a skip because of a cause, as carried if the fact that then counts instead holds."""
        carried = result.criterion.carried
        cause = self._cause_of(result, carried.causes) if carried is not None else None
        if carried is None or cause is None:
            return result
        try:
            other = self._run(result.criterion, carried.check, carried.arguments)
        except MissingElement:
            return result
        name, outcome = cause.criterion.id, result.outcome
        if outcome.status == "skipped":
            outcome = Outcome("failed", f"it cannot be measured, because {name} failed")
        if other.outcome.status == "pending":
            reason = f"whether this is due to {name} alone cannot be decided: {other.outcome.message}"
            return other._replace(outcome=pending(f"{outcome.message}; {reason}", other.outcome.mistake))
        if other.outcome.status == "passed":  # the place to look at is that of the mistake
            outcome = outcome._replace(location=cause.outcome.location)
            return Result(result.criterion, outcome, carried=cause.carried or name)
        return other if other.outcome.status == "errored" else result

    def _cause_of(self, result: Result, causes: Sequence[str]) -> Result | None:
        """Return the first of these criteria that failed, if the result is a failure or a skip because of one of them."""
        if result.outcome.status not in ("failed", "skipped"):
            return None
        names = [name for name in causes if result.because in (None, name)]
        before = (self.results[name] for name in names if name in self.results)
        return next((found for found in before if found.outcome.status == "failed"), None)

    def _run(self, criterion: Criterion, check: Check, arguments: Mapping[str, Any]) -> Result:
        """Return the result of a check; raise MissingElement."""
        try:
            subject = self._subjects.get(check.subject) or self._missing(check.subject)
            outcome = check.function(subject, **arguments)
            fault = fault_of(outcome) if check.distribution else ""
            return Result(criterion, _errored(check, fault) if fault else outcome)
        except MissingElement:
            raise
        except (UnknownShape, NotDecided) as reason:
            cause = reason.cause if isinstance(reason, NotDecided) else "mesh files are not opened"
            return Result(criterion, pending(f"{reason}; needs manual grading", cause))
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # noqa: BLE001  a faulty check, even one that exits, affects only its own criterion
            from traceback import format_exc  # needed only for a fault of the grader

            return Result(criterion, _errored(check, _text_of(error)), traceback=format_exc())

    def _missing(self, name: Subject) -> object:
        """Return the package; raise MissingElement or NotDecided for any other subject that the submission does not have."""
        if name == "package":
            return self.submission.needed_package()
        self.submission.needed_urdf()
        raise MissingElement("robot", "", message="ROS 2 cannot read the file, so there is no robot")

    def _miss(self, criterion: Criterion, missing: MissingElement) -> Result:
        """Return a failure for the first criterion that misses a thing; later ones would repeat it and are skipped."""
        first = self.missed.setdefault((missing.kind, missing.name), criterion.id)
        if first != criterion.id:
            return Result(criterion, _skipped(first), first)
        at = missing.location if isinstance(missing.location, Location | LazyLocation) else None
        outcome = Outcome(
            "failed", str(missing), location=location_of(at), mistake=missing.mistake, problem=missing.problem
        )
        link = missing.name if missing.kind == "visual" else None
        return Result(criterion, explained(outcome, self.problems, link))


def _skipped(cause: str) -> Outcome:
    return Outcome("skipped", f"skipped because {cause} failed")


def _text_of(error: BaseException) -> str:
    """Return the type and text of an exception, or only its type where making the text fails."""
    try:
        return f"{type(error).__name__}: {error}"
    except KeyboardInterrupt:
        raise
    except BaseException:  # noqa: BLE001  another package's code
        return type(error).__name__


def _errored(check: Check, fault: str) -> Outcome:
    """Return the outcome of a faulty check; the message names the installed package that it comes from."""
    if check.distribution:
        return Outcome("errored", f"the check {check.name} of the package {check.distribution} is faulty: {fault}")
    return Outcome("errored", f"the grader itself failed ({fault.partition(':')[0]}); please report it")
