"""Checks of other packages: signatures that are no schema, entry points that cannot be used, and faulty results."""

from collections.abc import Callable
from decimal import Decimal
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import pytest

from grader.base.errors import InputError
from grader.lab.checks import registry
from grader.lab.checks.check import describe
from grader.lab.checks.outcome import Outcome, passed
from grader.lab.grading.grade import grade
from grader.lab.rubric.criterion import Criterion, Part
from grader.lab.rubric.keys import rubric_schema
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.opening import read_submission
from grader.ros.urdf.kinematics import Configuration
from tests.checks.robots import BASE, PATH, scene


def takes_any(robot: Configuration, *names: str) -> Outcome:
    """A check with arguments that have no names."""
    return passed("it is so")


def unannotated(robot: Configuration, *, name) -> Outcome:  # type: ignore[no-untyped-def]  # noqa: ANN001
    """A check with an argument of no type."""
    return passed("it is so")


def with_default(robot: Configuration, *, size: float = float("nan")) -> Outcome:  # noqa: D417  as checks are documented
    """A check whose default JSON cannot hold.

    Args:
        size: How large it is.
    """
    return passed("it is so")


def entry(value: str, name: str = "other") -> EntryPoint:
    """Return the entry point of a check of another package."""
    return EntryPoint(name, value, registry.ENTRY_POINTS)


def installed(monkeypatch: pytest.MonkeyPatch, *entries: EntryPoint) -> None:
    """Let these entry points be the only ones."""
    monkeypatch.setattr("importlib.metadata.entry_points", lambda **_: entries)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((f"{__name__}:takes_any",), "its argument \\*names: str cannot be given by name"),
        ((f"{__name__}:unannotated",), "its argument name has no annotation"),
        (("tests.nowhere:check",), "ModuleNotFoundError: No module named 'tests.nowhere'"),
        (
            ("one:check", "two:check"),
            "the check other is in several packages, one and two: uninstall all but one",
        ),
    ],
    ids=["no-names", "no-type", "no-module", "twice"],
)
def test_a_check_that_cannot_be_used(
    monkeypatch: pytest.MonkeyPatch, values: tuple[str, ...], message: str
) -> None:
    """A rubric that names it is refused with the reason; for anything else it does not exist."""
    installed(monkeypatch, *map(entry, values))
    with pytest.raises(InputError, match=message):
        registry.find_check("other")
    assert registry.usable_check("other") is None


def test_an_interrupt_is_no_fault_of_a_package(monkeypatch: pytest.MonkeyPatch) -> None:
    """The user's Ctrl-C while a package is imported ends the run."""
    stopped = entry(f"{__name__}:with_default")
    monkeypatch.setattr(EntryPoint, "load", lambda _: (_ for _ in ()).throw(KeyboardInterrupt))
    installed(monkeypatch, stopped)
    with pytest.raises(KeyboardInterrupt):
        registry.find_check("other")


def test_a_default_that_json_cannot_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    """The schema of rubrics has the argument without its default."""
    installed(monkeypatch, entry(f"{__name__}:with_default", "with_default"))
    argument = rubric_schema()["$defs"]["with_default"]["properties"]["size"]
    assert (argument["description"], "default" in argument) == ("How large it is.", False)


class Unreadable(Exception):
    """An error whose text cannot be made."""

    def __str__(self) -> str:
        raise ValueError


class Interrupting(Exception):
    """An error during whose text the user stops the run."""

    def __str__(self) -> str:
        raise KeyboardInterrupt


WRONG: Any = [3.0]  # what no Outcome holds


def graded(result: Callable[[], Any]) -> Outcome:
    """Return the outcome of a rubric's only criterion, whose check, of another package, gives a result."""

    def check(robot: Configuration) -> Outcome:
        found: Outcome = result()
        return found

    criterion = Criterion(
        "only", "Only", "a", Decimal(1), describe(check)._replace(distribution="labs"), {}
    )
    rubric = Rubric(
        "r", "R", (Part("a", "A"),), (criterion,), "robot.urdf", "", b"", Path("r.toml")
    )
    return (
        grade(rubric, read_submission(scene(BASE).text.encode(), identity="me", path=PATH))
        .results[0]
        .outcome
    )


def raising(error: Exception) -> Callable[[], Any]:
    """Return a function that raises an error."""

    def fail() -> Any:
        raise error

    return fail


@pytest.mark.parametrize(
    ("result", "fault"),
    [
        (lambda: True, "it returned bool, not an Outcome"),
        (
            lambda: Outcome("skipped", "no"),
            "it returned the status 'skipped'; a check returns passed, failed or pending",
        ),
        (
            lambda: passed("so")._replace(message=WRONG),
            "it returned an Outcome with an invalid message",
        ),
        (
            lambda: Outcome("passed", "so", measured=(1.0, float("inf"))),
            "it returned an Outcome with an invalid measured",
        ),
        (
            lambda: Outcome("passed", "so")._replace(expected=WRONG),
            "it returned an Outcome with an invalid expected",
        ),
        (raising(KeyError("x")), "KeyError: 'x'"),
        (raising(Unreadable()), "Unreadable"),
    ],
    ids=["bool", "status", "message", "measured", "expected", "error", "no-text"],
)
def test_a_faulty_check_is_named_with_its_package(result: Callable[[], Any], fault: str) -> None:
    """Whatever it returns or raises, only its own criterion is errored."""
    outcome = graded(result)
    assert (outcome.status, outcome.message) == (
        "errored",
        f"the check check of the package labs is faulty: {fault}",
    )


@pytest.mark.parametrize("measured", [None, 1.0, "a", (1.0, 2.0), ("a", "b"), {"a": "b"}])
def test_every_kind_of_value_is_valid(measured: Any) -> None:
    """Numbers, texts, several of one kind, and texts by their names."""
    assert graded(lambda: Outcome("passed", "so", measured=measured)).status == "passed"


def test_an_interrupt_is_no_fault_of_a_check() -> None:
    """Also while the text of an error is made."""
    with pytest.raises(KeyboardInterrupt):
        graded(raising(Interrupting()))
