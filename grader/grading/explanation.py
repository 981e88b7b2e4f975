"""Explain a failure by the problem of the file that causes it."""

from collections.abc import Iterable

from grader.checks.outcome import Outcome
from grader.problems import Problem
from grader.robot import catalogue

# Problems that explain a measurement at the same place, and those with which ROS 2 drops a part of a link.
_EXPLAINING = (
    catalogue.BAD_COLOUR,
    catalogue.COLOUR_COUNT,
    catalogue.DEGREES,
    catalogue.UNDEFINED_MATERIAL,
    catalogue.BAD_LIMIT,
    catalogue.BAD_DYNAMICS,
    catalogue.EMPTY_RANGE,
    catalogue.LIMIT_IN_DEGREES,
)
_DROPPING = {
    "inertial": (catalogue.BAD_INERTIAL,),
    "visual": (catalogue.BAD_VISUAL, catalogue.BAD_INERTIAL),
    "collision": (catalogue.BAD_COLLISION, catalogue.BAD_VISUAL, catalogue.BAD_INERTIAL),
}


def explained(outcome: Outcome, problems: Iterable[Problem], part: str = "", link: str = "") -> Outcome:
    """Return a failure with the problem that explains it: at its place, or why ROS 2 drops a part of a link."""
    mistake, dropping = outcome.mistake or outcome.message, _DROPPING.get(part, ())
    for problem in problems:
        if problem.kind in dropping and problem.subject == link:
            message = f"{outcome.message}: {problem.message}"
            return outcome._replace(
                message=message, location=problem.location, mistake=mistake, problem=problem.message
            )
        explains = problem.kind in _EXPLAINING or (problem.kind is catalogue.DEFAULT_AXIS and outcome.unit == "deg")
        if ((not dropping and explains) or problem.kind.is_before_ros) and problem.location == outcome.location:
            message = f"{outcome.message} ({problem.code}: {problem.message})"
            return outcome._replace(message=message, mistake=mistake, problem=problem.message)
    return outcome
