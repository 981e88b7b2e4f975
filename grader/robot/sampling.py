"""Positions of joints at which the motion of robots is compared."""

from collections.abc import Iterator, Sequence
from math import isfinite, pi

from grader.robot.model import Joint

SINGLE = ("revolute", "continuous", "prismatic")  # the types of joints whose position is one number
_SEED = 20_260_115
_BETWEEN = 0.3  # of a range: a position that is neither an end nor the middle


def singles(joints: Sequence[Joint]) -> Iterator[tuple[int, tuple[float, ...]]]:
    """Yield positions with one joint at an end of its range, or between, and the others at 0; each with its index."""
    for index, joint in enumerate(joints):
        low, high = _range(joint)
        for position in (low, high, low + _BETWEEN * (high - low)):
            yield index, tuple(position if other == index else 0.0 for other in range(len(joints)))


def random_positions(joints: Sequence[Joint], count: int) -> list[tuple[float, ...]]:
    """Return random positions within the ranges of joints, always the same ones."""
    from random import Random  # late: few rubrics need it, and it takes long to import

    random = Random(_SEED)  # noqa: S311  not for secrets
    ranges = [_range(joint) for joint in joints]
    return [tuple(low + (high - low) * random.random() for low, high in ranges) for _ in range(count)]


def _range(joint: Joint) -> tuple[float, float]:
    """Return the range of a joint in radians or metres; a joint without limits that does not turn freely stays at 0."""
    if joint.type == "continuous":
        return -pi, pi
    limit = joint.limit
    if joint.type not in SINGLE or limit is None or not isfinite(limit.upper - limit.lower):
        return 0.0, 0.0
    return limit.lower, limit.upper
