"""Explain a failure by the problem of the file that causes it."""

from collections.abc import Collection, Iterator, Sequence

from grader.base import markup
from grader.base.problems import Problem
from grader.base.source import Location, Source
from grader.lab.checks.outcome import Outcome
from grader.ros.urdf import urdf_problems

# Problems that explain a measurement at the same place, and those with which ROS 2 drops a part of
# a link.
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
    "collision": (
        urdf_problems.BAD_COLLISION,
        urdf_problems.BAD_VISUAL,
        urdf_problems.BAD_INERTIAL,
    ),
}


# What is missing of these is nothing that could be inside of the element at the place.
_OUTSIDE = ("link", "connection", "robot of the lab")


def explain(
    outcome: Outcome,
    problems: Sequence[Problem],
    source: Source | None,
    looks_at: Collection[str] = (),
    part: str = "",
    link: str = "",
) -> Outcome:
    """Return a failure with the problem that explains it.

    This is why ROS 2 drops a part of a link, or a mistake at its place.

    `source` is the file in which that place may be an element: a mistake inside it explains the
    failure, too, if it is about what the check `looks_at`. A `part` of a `link` may be missing.
    """
    if outcome.problem:  # the check has said it
        return outcome
    mistake = outcome.mistake or outcome.message
    dropping = _DROPPING.get(part, ())
    dropped = next(
        (
            reported
            for reported in problems
            if reported.kind in dropping and reported.subject == link
        ),
        None,
    )
    if dropped:
        inner = next(_inside(dropped.location, problems, source), dropped)  # because of this
        message = f"{outcome.message}: {inner.message}"
        return outcome._replace(
            message=message, location=dropped.location, mistake=mistake, problem=dropped.message
        )
    place = outcome.location
    at_place = [
        reported
        for reported in problems
        if reported.location == place and _explains(reported, outcome, is_part=part in _DROPPING)
    ]
    inside: list[Problem] = []
    if part not in _OUTSIDE:
        is_of_looks = "material" in looks_at
        about = problems if is_of_looks else _without_looks(problems)
        inside += _inside(place, about, source, is_of_link=is_of_looks)
    for problem in problems:
        if problem in at_place or problem in inside:
            message = f"{outcome.message} ({problem.label}: {problem.message})"
            return outcome._replace(
                message=message, location=problem.location, mistake=mistake, problem=problem.message
            )
    return outcome


def _without_looks(problems: Sequence[Problem]) -> list[Problem]:
    """Return the problems that may explain a shape: a misspelt colour explains none."""
    return [
        problem
        for problem in problems
        if problem.kind is not urdf_problems.MISSPELT
        or problem.subject not in ("material", "color", "texture")
    ]


def _explains(problem: Problem, outcome: Outcome, *, is_part: bool) -> bool:
    """Return whether a problem at the place of a failure explains it.

    Of a missing part, only what precedes ROS 2 explains it.
    """
    if problem.kind.is_before_ros:
        return True
    is_of_axis = problem.kind is urdf_problems.DEFAULT_AXIS and outcome.unit == "deg"
    return not is_part and (problem.kind in _EXPLAINING or is_of_axis)


def _inside(
    place: Location | None,
    problems: Sequence[Problem],
    source: Source | None,
    *,
    is_of_link: bool = False,
) -> Iterator[Problem]:
    """Yield the problems around a place that explain what is around them.

    They are in the element at the place, or in the link that it is of.
    """
    candidates = [
        reported for reported in problems if reported.kind in _INSIDE and reported.location != place
    ]
    if not place or not source or not candidates:
        return
    offsets = _element_offsets(place, source, is_of_link=is_of_link)
    for problem in candidates:
        where = problem.location
        if (
            (where.path, where.calls) == (place.path, place.calls)
            and source.text.startswith(_INSIDE[problem.kind], offsets.start)
            and source.start_offset(where) in offsets
        ):
            yield problem


def _element_offsets(place: Location, source: Source, *, is_of_link: bool = False) -> range:
    """Return the offsets of the element at a place, or of its link.

    If an attribute is there, they are only those of the tag.
    """
    if place.path != source.path:
        return range(0)
    text = source.text
    at = source.start_offset(place)
    start = text.rfind("<", 0, at + 1)
    if is_of_link and text.startswith("<visual", start):
        start = at = text.rfind("<link", 0, start)
    if text.startswith("<robot", start):  # everything is inside
        return range(0)
    return range(
        start, markup.element_end(text, start) if start == at else markup.head_end(text, start)[0]
    )
