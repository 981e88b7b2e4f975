"""A correct design raises no alarm, and each fault is found by the check that is for it."""

from collections.abc import Callable
from random import Random

import pytest

from grader.base.errors import MissingElement
from grader.lab.checks.driving import does_not_tip, drives_straight, stands_level, turns_in_place
from grader.lab.checks.outcome import Outcome
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf
from tests.driving.designs import FAULTS, WHEELS, Design, correct, faulty

pytestmark = pytest.mark.slow

_COUNT = 500
_BEARABLE = 0.3  # m/s^2


def failures(design: Design) -> dict[str, str]:
    """Return the messages of the checks that a design fails."""
    robot = read_urdf(design.urdf.encode(), "rover.urdf").robot
    assert robot is not None
    configuration = Configuration(robot)
    on = design.supports
    asked: dict[str, Callable[[], Outcome]] = {
        "stands_level": lambda: stands_level(configuration, on=on),
        "drives_straight": lambda: drives_straight(configuration, wheels=WHEELS),
        "turns_in_place": lambda: turns_in_place(configuration, wheels=WHEELS),
        "does_not_tip": lambda: does_not_tip(configuration, on=on, acceleration=_BEARABLE),
    }
    messages = {}
    for name, ask in asked.items():
        try:
            outcome = ask()
        except MissingElement as missing:
            messages[name] = str(missing)
        else:
            if outcome.status != "passed":
                messages[name] = outcome.message
    return messages


def test_correct_designs() -> None:
    """Whatever its size and style, a correct robot passes all four checks."""
    for seed in range(_COUNT):
        assert failures(correct(Random(seed))) == {}, seed


def test_each_fault() -> None:
    """A design with one fault fails the check that is for it."""
    names = [*FAULTS]
    for seed in range(_COUNT):
        name = names[seed % len(names)]
        design = faulty(Random(seed), name)
        assert FAULTS[name][0] in failures(design), (name, seed, design)
