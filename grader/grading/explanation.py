"""Explain a failure by the problem of the file that causes it."""

from collections.abc import Iterable

from grader import markup
from grader.checks.outcome import Outcome
from grader.problems import Problem
from grader.robot import catalogue
from grader.source import Location, Source

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


def explained(
    outcome: Outcome, problems: Iterable[Problem], source: Source | None, part: str = "", link: str = ""
) -> Outcome:
    """Return a failure with the problem that explains it: why ROS 2 drops a part of a link, or a mistake at its place.

    `source` is the file in which that place may be an element: a mistake inside it explains the failure, too.
    """
    if outcome.problem:  # the check has said it
        return outcome
    lost, dropping = outcome.message, _DROPPING.get(part, ())
    mistake = outcome.mistake or lost
    dropped = next((it for it in problems if it.kind in dropping and it.subject == link), None)
    if dropped is not None:
        message = f"{lost}: {dropped.message}"
        outcome = outcome._replace(message=message, location=dropped.location, mistake=mistake, problem=dropped.message)
    place, inside = outcome.location, _extent(outcome.location, source)
    for problem in problems:
        kind, where = problem.kind, problem.location
        explains = kind in _EXPLAINING or (kind is catalogue.DEFAULT_AXIS and outcome.unit == "deg")
        is_cause = kind is catalogue.MISSPELT or (explains and not dropping)
        if where == place and dropped is not None:
            continue
        if (where == place and (is_cause or kind.is_before_ros)) or (is_cause and _is_in(where, place, inside, source)):
            if dropped is not None:  # because of this
                return outcome._replace(message=f"{lost}: {problem.message}")
            message = f"{outcome.message} ({problem.code}: {problem.message})"
            return outcome._replace(message=message, location=where, mistake=mistake, problem=problem.message)
    return outcome


def _extent(place: Location | None, source: Source | None) -> range:
    """Return the offsets of the element at a place, or of the tag if an attribute is there."""
    if place is None or source is None or place.path != source.path:
        return range(0)
    text, at = source.text, source.offset(place.line, place.column)
    start = text.rfind("<", 0, at + 1)
    if start < 0 or text.startswith("<robot", start):
        return range(0)
    return range(start, markup.element_end(text, start) if start == at else markup.head_end(text, start)[0])


def _is_in(where: Location, place: Location | None, inside: range, source: Source | None) -> bool:
    if source is None or place is None or (where.path, where.calls) != (place.path, place.calls):
        return False
    return source.offset(where.line, where.column) in inside
