"""A robot with its joints at some positions, and what a fact reports if something is missing."""

from collections.abc import Mapping
from math import degrees
from typing import Any

import numpy as np

from tests.second_opinion.elements import Joint, Link, Matrix, Shape
from tests.second_opinion.robot import Robot

Fact = tuple[bool, Any]  # whether it holds, and the value that was measured, or None
SLACK = 1e-9  # tolerances are inclusive, and the floats 0.152 and 0.15 + 0.002 differ
UP = (0.0, 0.0, 1.0)


class Missing(Exception):
    """What a fact is about does not exist; later facts about the same are skipped."""

    def __init__(self, *thing: str) -> None:
        super().__init__(*thing)
        self.thing = thing


class Undecided(Exception):
    """A person has to look."""


class Unsure(Exception):
    """The fact depends on choices that the documentation leaves open, such as random positions: it is not compared."""


def near(actual: Any, expected: Any, tolerance: float) -> bool:
    """Return whether every number is within the tolerance."""
    return bool(np.all(np.abs(np.asarray(actual) - np.asarray(expected)) <= tolerance + SLACK))


def angle_between(one: Matrix, other: Any) -> float:
    """Return the angle between two vectors, in degrees."""
    other = np.asarray(other, float)
    return degrees(np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other))


def angle_of(turned: Matrix) -> float:
    """Return the angle of a rotation, in degrees."""
    sine = (
        np.linalg.norm(
            [turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]]
        )
        / 2
    )
    return degrees(np.arctan2(sine, (np.trace(turned) - 1) / 2))


class Posed:
    """A robot with its joints at some positions."""

    def __init__(self, robot: Robot, positions: Mapping[str, float] | None = None) -> None:
        self.robot, self._poses = robot, robot.poses(positions or {})

    def link(self, name: str) -> Link:
        """Return a link."""
        if name not in self.robot.links:
            raise Missing("link", name)
        return self.robot.links[name]

    def pose(self, name: str, relative_to: str) -> Matrix:
        """Return T_relative_link."""
        self.link(name), self.link(relative_to)
        one, other = self._poses[name], self._poses[relative_to]
        if name == relative_to:
            return np.eye(4)
        if one.root != other.root:
            raise Missing("chain", *sorted((one.root, other.root)))
        if one.below != other.below:  # of two joints without a direction, the lower one
            raise Missing(
                "pose",
                max(
                    one.below,
                    other.below,
                    key=lambda joint: len(self.way_up(self.robot.child(joint))),
                ),
            )
        found: Matrix = np.linalg.inv(other.pose) @ one.pose
        return found

    def visuals(self, link: str) -> list[Shape]:
        """Return the visuals that have a size."""
        found = [shape for shape in self.link(link).visuals if shape.has_size]
        if not found:
            raise Missing("visual", link)
        return found

    def main(self, link: str, shape: str = "any") -> Shape:
        """Return the largest visual, of the named shape if the link has one."""
        every = self.visuals(link)
        return max([one for one in every if one.kind == shape] or every, key=lambda one: one.volume)

    def root(self, name: str) -> str:
        """Return the root of the tree of a link."""
        return self._poses[name].root

    def way_up(self, name: str) -> list[Joint]:
        """Return the joints from a link up to the root."""
        way: list[Joint] = []
        while name in self.robot.parents:
            way.append(self.robot.parents[name])
            name = way[-1].parent
        return way

    def path(self, link: str, base: str) -> list[Joint]:
        """Return the joints from a link up to another above it, or up to a common link and down."""
        self.link(link), self.link(base)
        ways = [self.way_up(link), self.way_up(base)]
        if self.root(link) != self.root(base):
            self.pose(link, base)
        shared = {joint.name for joint in ways[0]} & {joint.name for joint in ways[1]}
        return [joint for way in ways for joint in way if joint.name not in shared]

    def mover(self, link: str) -> Joint:
        """Return the lowest joint above a link that is not fixed."""
        self.link(link)
        name = link
        while name in self.robot.parents:
            joint = self.robot.parents[name]
            if joint.type != "fixed":
                return joint
            name = joint.parent
        raise Missing("moving joint", link)


def below(posed: Posed, link: str, parent: str) -> list[Joint] | None:
    """Return the joints from a link up to one above it; None where that is not above it."""
    posed.link(link), posed.link(parent)
    if posed.root(link) != posed.root(parent):
        raise Missing("chain", *sorted((posed.root(link), posed.root(parent))))
    way = posed.way_up(link)
    names = [link, *(joint.parent for joint in way)]
    if parent not in names:
        posed.pose(link, parent)
    return way[: names.index(parent)] if parent in names else None
