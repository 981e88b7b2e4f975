"""Checks of robot arms, for the rubrics of grader."""

from math import hypot

from grader.plugin import Configuration, NonNegative, Outcome, measured, place


def distance_between(
    robot: Configuration,
    *,
    link: str,
    relative_to: str,
    distance: NonNegative,
    tolerance: NonNegative,
) -> Outcome:
    """The origins of the frames of two links are at a given distance from each other.

    Args:
        link: The link that is examined.
        relative_to: The link from which the distance is measured.
        distance: The distance, in metres.
        tolerance: How far the distance may be off, in metres.
    """
    actual = hypot(*robot.pose(link, relative_to=relative_to).translation)
    what = f"the distance of {link!r} from {relative_to!r} is"
    return measured(what, actual, distance, tolerance, at=place(robot.link(link).location))
