"""How the motion of a robot's links differs from that of another robot's: where most, and because of which joint."""

from collections.abc import Collection
from math import degrees

from grader.checks.outcome import SLACK, Outcome, failed, in_degrees, in_millimetres, passed, point
from grader.robot.pairing import Offset, RobotPair
from grader.robot.sampling import random_positions, singles
from grader.text import counted, enumerated, quoted

_MAX_NAMED = 8  # joints in a message


class MotionComparison:
    """The offsets of a pair of robots at the sampled positions: all joints at 0, one joint moved, and random ones."""

    def __init__(self, pair: RobotPair, samples: int) -> None:
        joints = [joint for _, joint in pair.joints]
        self._pair, self._tolerance, self._angle = pair, pair.tolerance, pair.angle
        self._zero = (0.0,) * len(joints)
        self._singles = [*singles(joints)]
        self._random = random_positions(joints, samples) if joints else []

    def outcome(self) -> Outcome:
        """Return whether all offsets are within the tolerances, else the largest one, and when the robots differ."""
        zero = self._pair.offset(self._zero)
        alone = [(index, self._pair.offset(positions)) for index, positions in self._singles]
        offsets = [zero, *(offset for _, offset in alone), *map(self._pair.offset, self._random)]
        worst = max(offsets, key=self._pair.times)  # of equal ones, that of the simplest position
        if self._is_within(worst):
            joints = counted(len(self._pair.joints), "joint")
            return passed(
                f"{self._links()} as in the reference at {counted(len(offsets), 'position')} of {joints}: at most "
                f"{self._text(worst)} off"
            )
        wrong = dict.fromkeys(index for index, offset in alone if not self._is_within(offset))
        cause, at = "", self._pair.robots[0].link(worst.link).location
        if not self._is_within(zero):
            cause = f"; it is already {self._text(zero)} off with all joints at 0" if zero is not worst else ""
        elif wrong and self._differ_only_with([*wrong]):
            differing = [self._pair.joints[index][0] for index in wrong]
            at = differing[0].axis_location or differing[0].location
            names = enumerated([quoted(joint.name) for joint in differing], _MAX_NAMED, "or")
            axes = "its axis is" if len(differing) == 1 else "their axes are"
            cause = (
                f"; it differs as soon as {names} moves{f': {axes} reversed' if self._are_reversed([*wrong]) else ''}"
            )
        message = f"{worst.link!r} does not move as in the reference: it is {self._text(worst)} off"
        detail = f" with {self._positions(worst)}{cause}"
        outcome = failed(message, at, detail=detail)
        if worst.distance <= self._tolerance + SLACK:
            return outcome._replace(measured=worst.angle, expected=0.0, tolerance=self._angle, unit="deg")
        return outcome._replace(measured=worst.distance, expected=0.0, tolerance=self._tolerance, unit="m")

    def _links(self) -> str:
        names = [quoted(link) for link, _ in self._pair.links]
        return f"{enumerated(names, _MAX_NAMED)} {'moves' if len(names) == 1 else 'move'}"

    def _is_within(self, offset: Offset) -> bool:
        return offset.distance <= self._tolerance + SLACK and offset.angle <= self._angle + SLACK

    def _differ_only_with(self, moved: Collection[int]) -> bool:
        """Return whether the robots agree wherever some joints are at 0."""
        held = (tuple(0.0 if index in moved else it for index, it in enumerate(found)) for found in self._random)
        return all(self._is_within(self._pair.offset(positions)) for positions in held)

    def _are_reversed(self, moved: Collection[int]) -> bool:
        """Return whether the robots agree everywhere once some joints move the other way."""
        everywhere = (*(positions for _, positions in self._singles), *self._random)
        return all(self._is_within(self._pair.offset(positions, moved)) for positions in everywhere)

    def _text(self, offset: Offset) -> str:
        return f"{in_millimetres(offset.distance)} and {in_degrees(offset.angle)}"

    def _positions(self, offset: Offset) -> str:
        if not any(offset.positions):
            return "all joints at 0"
        moved = [
            f"{quoted(joint.name)} at {point((position,))} m"
            if joint.type == "prismatic"
            else f"{quoted(joint.name)} at {point((degrees(position),))} degrees"
            for (joint, _), position in zip(self._pair.joints, offset.positions, strict=True)
            if position
        ]
        return enumerated(moved, _MAX_NAMED)
