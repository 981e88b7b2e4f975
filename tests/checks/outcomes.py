"""Helpers that run a check on a robot or a submission: alone, as a criterion of a rubric, or if something is missing."""

import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.checks.check import Subject, describe
from grader.checks.outcome import Outcome, Status
from grader.errors import MissingElement, NotDecided
from grader.grading.criterion import Criterion, Part
from grader.grading.grade import grade
from grader.grading.reference import ReferenceSolution
from grader.grading.rubric import Rubric
from grader.robot.kinematics import Configuration
from grader.robot.model import Robot
from grader.source import LazyLocation, Location
from grader.submission.opening import read_submission
from grader.submission.submission import Lab, Submission
from tests.checks.robots import ARM, PATH, Scene
from tests.checks.submissions import Submitted

AnyCheck = Callable[..., Outcome]
Arguments = dict[str, Any]
Finding = tuple[Status, str, Location | None]
Lack = tuple[str, str, str, Location | None]

ANYTHING = "..."  # a message that a test does not look at
FOUND: dict[str, str] = {}  # what the checks found in this test: a row by its wording
_DATA = re.compile(r"'[^']*'|\"[^\"]*\"|[-\d.]+|\S*/\S*")  # names in quotes, numbers and paths
_EXPLANATION = re.compile(r" \(URDF\d{3}: .*\)\Z", re.DOTALL)


def ask(check: AnyCheck, of: Scene | Submitted, /, **arguments: Any) -> Outcome:
    """Return the outcome of a check."""
    subjects = [_subject(name, of) for name in describe(check).examined]
    try:
        outcome = check(*subjects, **arguments)
    except (MissingElement, NotDecided) as error:
        _record(row(check.__name__, {"message": str(error), **vars(error)}))
        raise
    return _recorded(check, outcome)


def _recorded(check: AnyCheck, outcome: Outcome) -> Outcome:
    _record(row(check.__name__, outcome._asdict()))
    return outcome


def _record(found: str) -> None:
    FOUND.setdefault(wording(found), found)


def wording(found: str) -> str:
    """Return what a row says after its name and status, without the data of one robot."""
    return _DATA.sub("", found.partition("message ")[2])


def row(name: str, fields: Mapping[str, object]) -> str:
    """Return the fields of an outcome or an error in one line, but those that are empty."""
    return f"{name}: " + "; ".join(
        f"{key} {_shown(value)}" for key, value in fields.items() if value is not None and value not in ("", ())
    )


def _shown(value: object) -> str:
    match value:
        case Location():
            return f"{value.path}:{value.line}:{value.column}"
        case LazyLocation():
            return _shown(value.resolve())
        case tuple():
            return f"({', '.join(map(_shown, value))})"
        case Mapping():
            return f"{{{', '.join(f'{key}: {_shown(one)}' for key, one in value.items())}}}"
        case float():
            return f"{round(value, 9) + 0.0:.6g}"
        case _:
            return str(value).replace("\n", "\\n")


def finds(check: AnyCheck, submitted: Submitted, /, **arguments: Any) -> Finding:
    """Return status, message and location of a check's outcome for a submission."""
    outcome = ask(check, submitted, **arguments)
    return outcome.status, outcome.message, outcome.location


def missing(check: AnyCheck, of: Scene | Submitted, /, **arguments: Any) -> MissingElement:
    """Return the message of the MissingElement that a check raises; fail the test if it returns an outcome."""
    with pytest.raises(MissingElement) as caught:
        ask(check, of, **arguments)
    return caught.value


def lacks(check: AnyCheck, submitted: Submitted, /, **arguments: Any) -> Lack:
    """Return kind, name, message and location of the MissingElement that a check raises for a submission."""
    error = missing(check, submitted, **arguments)
    assert error.location is None or isinstance(error.location, Location)
    return error.kind, error.name, str(error), error.location


def graded(check: AnyCheck, of: Scene | Submitted, /, **arguments: Any) -> Outcome:
    """Return the outcome of a rubric's only criterion, which uses this check; what the check raises is approved, too."""
    with suppress(Exception):
        ask(check, of, **arguments)
    criterion = Criterion("only", "The only one", "all", Decimal(1), describe(check), arguments)
    rubric = Rubric("test", "Test", (Part("all", "All"),), (criterion,), "robot.urdf", "", b"", Path("test.toml"))
    submission = _subject("submission", of)
    assert isinstance(submission, Submission)
    return _recorded(check, grade(replace(rubric, solution=_Solution()), submission).results[0].outcome)


class _Solution(ReferenceSolution):
    """A reference solution without a file: the arm."""

    def __init__(self) -> None:
        super().__init__(Path(), Lab(""), str)

    @property
    def robot(self) -> Configuration:
        """Return the robot."""
        return ARM.robot


def passes(check: AnyCheck, scene: Scene, **arguments: Any) -> str:
    """Return the message of a check, which must pass without a location."""
    outcome = ask(check, scene, **arguments)
    assert outcome.status == "passed", outcome
    assert outcome.location is None, outcome
    return outcome.message


def fails(check: AnyCheck, scene: Scene, *, at: str | None = None, **arguments: Any) -> str:
    """Return the message of a check, which must fail; `at` is the text at its location."""
    outcome = graded(check, scene, **arguments)
    assert outcome.status == "failed", outcome
    expected: Location | None = scene.location_of(at) if at is not None else outcome.location
    assert outcome.location == expected, (outcome, expected)
    return own_message(outcome)


def says(check: AnyCheck, scene: Scene, message: str, at: str | None, arguments: Arguments) -> None:
    """Assert the message of a check that passes, where `at` is None, or fails at this text, anywhere if that is empty."""
    found = passes(check, scene, **arguments) if at is None else fails(check, scene, at=at or None, **arguments)
    assert message in (found, ANYTHING)


def _subject(name: Subject, of: Scene | Submitted) -> object:
    if name == "reference":
        return ARM.robot
    if isinstance(of, Submitted):
        if name in ("urdf", "robot"):
            reading = of.submission.needed_urdf()
            return reading if name == "urdf" else Configuration(reading.robot or Robot(""), is_guarded=True)
        return of.package if name == "package" else of.submission
    if name == "submission":
        return read_submission(of.text.encode(), identity="test", path=PATH)
    return of.reading if name == "urdf" else of.robot


def own_message(outcome: Outcome) -> str:
    """Return a message without the problem of the reader that a grade run adds in parentheses."""
    return _EXPLANATION.sub("", outcome.message)
