"""Explain a failure by the problem of the file that causes it."""

from collections.abc import Iterable

from grader import markup
from grader.checks.outcome import Outcome
from grader.problems import Problem
from grader.robot import urdf_problems
from grader.source import Location, Source

# Problems that explain a measurement at the same place, and those with which ROS 2 drops a part of a link.
_EXPLAINING = (
    urdf_problems.BAD_COLOUR,
    urdf_problems.COLOUR_COUNT,
    urdf_problems.DEGREES,
    urdf_problems.UNDEFINED_MATERIAL,
    urdf_problems.BAD_LIMIT,
    urdf_problems.BAD_DYNAMICS,
    urdf_problems.EMPTY_RANGE,
    urdf_problems.LIMIT_IN_DEGREES,
)
# Problems that explain a measurement of the element around them, and how that begins.
_INSIDE = {
    urdf_problems.MISSPELT: "<",
    urdf_problems.DEGREES: "<origin",
    urdf_problems.BAD_COLOUR: "<material",
    urdf_problems.COLOUR_COUNT: "<material",
}
_DROPPING = {
    "inertial": (urdf_problems.BAD_INERTIAL,),
    "visual": (urdf_problems.BAD_VISUAL, urdf_problems.BAD_INERTIAL),
    "collision": (urdf_problems.BAD_COLLISION, urdf_problems.BAD_VISUAL, urdf_problems.BAD_INERTIAL),
}


def explain(
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
    place = outcome.location
    inside = _element_offsets(place, source) if any(problem.kind in _INSIDE for problem in problems) else range(0)
    for problem in problems:
        kind, where = problem.kind, problem.location
        explains = kind in _EXPLAINING or (kind is urdf_problems.DEFAULT_AXIS and outcome.unit == "deg")
        is_there = where == place and dropped is None and ((explains and not dropping) or kind.is_before_ros)
        if is_there or (where != place and _is_inside(problem, place, inside, source)):
            if dropped is not None:  # because of this
                return outcome._replace(message=f"{lost}: {problem.message}")
            message = f"{outcome.message} ({problem.code}: {problem.message})"
            return outcome._replace(message=message, location=where, mistake=mistake, problem=problem.message)
    return outcome


def _element_offsets(place: Location | None, source: Source | None) -> range:
    """Return the offsets of the element at a place, or of the tag if an attribute is there."""
    if place is None or source is None or place.path != source.path:
        return range(0)
    text, at = source.text, source.offset(place.line, place.column)
    start = text.rfind("<", 0, at + 1)
    if text.startswith("<robot", start):  # everything is inside
        return range(0)
    return range(start, markup.element_end(text, start) if start == at else markup.head_end(text, start)[0])


def _is_inside(problem: Problem, place: Location | None, inside: range, source: Source | None) -> bool:
    """Return whether a problem that explains what is around it is in the element at a place."""
    where = problem.location
    if (
        source is None
        or place is None
        or problem.kind not in _INSIDE
        or (where.path, where.calls) != (place.path, place.calls)
    ):
        return False
    return (
        source.text.startswith(_INSIDE[problem.kind], inside.start)
        and source.offset(where.line, where.column) in inside
    )
