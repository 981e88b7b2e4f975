"""Helpers that run a check on a robot or a submission: alone, as a criterion of a rubric, or if something is missing."""

import re
from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.base.errors import InputError, MissingElement
from grader.lab.checks.check import Subject, describe
from grader.lab.checks.outcome import Outcome
from grader.lab.grading.grade import grade
from grader.lab.rubric.criterion import Criterion, Part
from grader.lab.rubric.rubric import ReferenceSolution, Rubric
from grader.lab.submission.submission import Lab, Submission
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Robot
from tests.checks.robots import ARM, Scene
from tests.checks.submissions import Submitted

AnyCheck = Callable[..., Outcome]
Arguments = dict[str, Any]

_EXPLANATION = re.compile(r" \(URDF\d{3}: .*\)\Z", re.DOTALL)


def ask(
    check: AnyCheck, of: Scene | Submitted, reference: Scene = ARM, /, **arguments: Any
) -> Outcome:
    """Return the outcome of a check."""
    described = describe(check).for_arguments(arguments)
    return described.outcome(
        (_subject(name, of, reference) for name in described.examined), arguments
    )


def missing(check: AnyCheck, of: Scene | Submitted, /, **arguments: Any) -> MissingElement:
    """Return the message of the MissingElement that a check raises; fail the test if it returns an outcome."""
    with pytest.raises(MissingElement) as caught:
        ask(check, of, **arguments)
    return caught.value


def graded(
    check: AnyCheck, of: Scene | Submitted, reference: Scene = ARM, /, **arguments: Any
) -> Outcome:
    """Return the outcome of a rubric's only criterion, which uses this check."""
    described = describe(check).for_arguments(arguments)
    criterion = Criterion("only", "The only one", "all", Decimal(1), described, arguments)
    rubric = Rubric(
        "test",
        "Test",
        (Part("all", "All"),),
        (criterion,),
        "robot.urdf",
        "",
        b"",
        Path("test.toml"),
    )
    submission = _subject("submission", of, reference)
    assert isinstance(submission, Submission)
    return grade(replace(rubric, solution=_Solution(reference)), submission).results[0].outcome


class _Solution(ReferenceSolution):
    """A reference solution without a file."""

    def __init__(self, of: Scene) -> None:
        super().__init__(Path(), Lab(""), InputError)
        self._of = of

    @property
    def robot(self) -> Configuration:
        """Return the robot."""
        return self._of.robot


def passes(check: AnyCheck, scene: Scene, **arguments: Any) -> None:
    """Assert that a check passes, without a location."""
    outcome = ask(check, scene, **arguments)
    assert (outcome.status, outcome.location) == ("passed", None), outcome


def fails(check: AnyCheck, scene: Scene, **arguments: Any) -> None:
    """Assert that a check fails."""
    outcome = graded(check, scene, **arguments)
    assert outcome.status == "failed", outcome


class NoSubject(LookupError):
    """A submission has no package, or its URDF no robot, so a check of one cannot be called on its own."""


def _subject(name: Subject, of: Scene | Submitted, reference: Scene) -> object:
    if name == "reference":
        return reference.robot
    submission = of.submission
    if name == "submission":
        return submission
    if name == "package":
        if submission.package is None:
            raise NoSubject(name)
        return submission.package
    reading = of.reading if isinstance(of, Scene) else submission.needed_urdf()
    if name == "urdf":
        return reading
    if reading.robot is None and isinstance(of, Scene):
        raise NoSubject(name)
    return Configuration(reading.robot or Robot(""), is_guarded=True)


def own_message(outcome: Outcome) -> str:
    """Return a message without the problem of the reader that a grade run adds in parentheses."""
    return _EXPLANATION.sub("", outcome.message)
