"""The frames of a whole robot: whether everything in it is turned or moved alike, in comparison with a reference."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import permutations, product
from math import dist, hypot
from statistics import median
from typing import NamedTuple

from grader.errors import MissingElement, NotDecided
from grader.robot.frames import placed_by
from grader.robot.kinematics import Configuration
from grader.robot.likeness import turn_between
from grader.robot.model import Joint, Link, Origin, Robot
from grader.robot.transforms import IDENTITY, IDENTITY_ROTATION, Rotation, Transform, Vector, cross, dot, minus

_NEAR = 0.005  # metres
_MIN_POINTS = 4
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class Convention(NamedTuple):
    """How all of a robot differs from the reference, and the robot without that difference."""

    description: str
    robot: Robot


def convention_of(robot: Configuration, reference: Configuration, base: str) -> Convention | None:
    """Return how everything in the frame of `base` is turned by quarter turns or moved, if it is and most of it is alike."""
    pairs = [(ours, theirs) for ours, theirs in zip(_points(robot, base), _points(reference, base), strict=True)]
    known = [(ours, theirs) for ours, theirs in pairs if ours is not None and theirs is not None]
    if len(known) < _MIN_POINTS:
        return None
    best = max((_fit(known, rotation) for rotation in _quarter_turns()), key=lambda fit: fit[0])
    count, T_base_reference = best
    is_other = (
        turn_between(T_base_reference.rotation, IDENTITY_ROTATION) > 1.0 or hypot(*T_base_reference.translation) > _NEAR
    )
    if not is_other or count < max(_MIN_POINTS, len(known) - 1):
        return None
    return Convention(_description(T_base_reference), _reframed(robot, reference, base, T_base_reference))
