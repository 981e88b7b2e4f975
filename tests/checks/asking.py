"""Ways to ask a check about a robot or a submission: alone, as a criterion of a rubric, and where it cannot answer."""

import re
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.checks.outcome import Outcome, Status
from grader.checks.registry import describe
from grader.errors import MissingElement
from grader.grading.grade import grade
from grader.grading.rubric import Criterion, Part, Rubric
from grader.source import Location
from grader.submission.submission import read_submission
from tests.checks.robots import PATH, Scene
from tests.checks.submitted import Submitted

AnyCheck = Callable[..., Outcome]
Arguments = dict[str, Any]
Finding = tuple[Status, str, Location | None]
Lack = tuple[str, str, str, Location | None]

_EXPLANATION = re.compile(r" \(URDF\d{3}: .*\)\Z", re.DOTALL)


def ask(check: AnyCheck, of: Scene | Submitted, /, **arguments: Any) -> Outcome:
    """What a check finds."""
    return check(_subject(check, of), **arguments)


def finds(check: AnyCheck, submitted: Submitted, /, **arguments: Any) -> Finding:
    """What a check finds in a submission: status, message and place."""
    outcome = ask(check, submitted, **arguments)
    return outcome.status, outcome.message, outcome.location


def missing(check: AnyCheck, of: Scene | Submitted, /, **arguments: Any) -> MissingElement:
    """What a check misses; fails the test if it finds an answer."""
    with pytest.raises(MissingElement) as caught:
        ask(check, of, **arguments)
    return caught.value


def lacks(check: AnyCheck, submitted: Submitted, /, **arguments: Any) -> Lack:
    """What a check misses in a submission: kind, name, message and place."""
    error = missing(check, submitted, **arguments)
    assert error.location is None or isinstance(error.location, Location)
    return error.kind, error.name, str(error), error.location


def graded(check: AnyCheck, of: Scene | Submitted, /, **arguments: Any) -> Outcome:
    """The outcome of a rubric's only criterion, which names this check."""
    criterion = Criterion("only", "The only one", "all", Decimal(1), describe(check), arguments)
    rubric = Rubric("test", "Test", (Part("all", "All"),), (criterion,), "robot.urdf", "", b"", Path("test.toml"))
    single = of.text.encode() if isinstance(of, Scene) else b""
    submission = of.submission if isinstance(of, Submitted) else read_submission(single, identity="test", path=PATH)
    return grade(rubric, submission).results[0].outcome


def passes(check: AnyCheck, scene: Scene, **arguments: Any) -> str:
    """The message of a check, which must pass and point to no place."""
    outcome = ask(check, scene, **arguments)
    assert outcome.status == "passed", outcome
    assert outcome.location is None, outcome
    return outcome.message


def fails(check: AnyCheck, scene: Scene, *, at: str | None = None, **arguments: Any) -> str:
    """The own message of a check, which must fail; `at` begins at the place that it must point to."""
    outcome = graded(check, scene, **arguments)
    assert outcome.status == "failed", outcome
    expected: Location | None = scene.place(at) if at is not None else outcome.location
    assert outcome.location == expected, (outcome, expected)
    return own_words(outcome)


def _subject(check: AnyCheck, of: Scene | Submitted) -> object:
    subject = describe(check).subject
    if isinstance(of, Submitted):
        return of.package if subject == "package" else of.submission
    return of.reading if subject == "urdf" else of.robot


def own_words(outcome: Outcome) -> str:
    """A message without what a grade run adds to it: the reader's problem at the same place, in parentheses."""
    return _EXPLANATION.sub("", outcome.message)
