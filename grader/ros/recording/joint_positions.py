"""The recorded positions of joints, by the times of their states."""

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from math import isfinite, pi, remainder
from typing import NamedTuple

from grader.base.grouping import group_values
from grader.ros.recording.recorded_topics import (
    RecordedTopic,
    are_times,
    find_value,
    read_stamp,
)

_TURN = 2 * pi
_ROUNDED = 0.02  # radians by which positions that wrap may exceed a turn
_MAX_STEP = 2.5  # radians between two states of which it is certain in which direction it turned
_MAX_GAP = 0.5  # seconds between two states, in which a wheel may turn by more than that
_NEAR = 0.1  # seconds: how far a time may be outside of those of the states


class _State(NamedTuple):
    """A position of a joint, the time in the header and the recorder's time."""

    stamp: float | None
    time: float
    position: float


class NearPosition(NamedTuple):
    """A position at a time, and how much it changes between the two states around it."""

    position: float
    change: float = 0.0


class JointPositions(NamedTuple):
    """The positions of a joint, in order of their times in seconds."""

    times: tuple[float, ...]
    positions: tuple[float, ...]
    by_stamp: Mapping[float, Sequence[float]]  # of several states, if a simulation was reset

    def find_near(self, time: float) -> list[NearPosition]:
        """Return the positions of the states of a time, else the one between two states.

        The result is empty outside of the times of the states.
        """
        if time in self.by_stamp:
            return [NearPosition(position) for position in self.by_stamp[time]]
        if not self.times[0] - _NEAR <= time <= self.times[-1] + _NEAR:
            return []
        index = min(bisect_left(self.times, time), len(self.times) - 1)
        change = self.positions[index] - self.positions[max(0, index - 1)]
        return [NearPosition(self.find_position(time), abs(change))]

    def find_position(self, time: float) -> float:
        """Return the position at a time, between two states; outside, that of the nearest one."""
        index = bisect_left(self.times, time)
        if index in (0, len(self.times)):
            return self.positions[min(index, len(self.times) - 1)]
        start = self.times[index - 1]
        end = self.times[index]
        change = self.positions[index] - self.positions[index - 1]
        return self.positions[index - 1] + change * (time - start) / (end - start)

    def unwrapped(self) -> "JointPositions | None":
        """Return the positions of a joint that turns on, where they are kept within one turn.

        The result is None where states are so rare that the direction is not certain.
        """
        if max(self.positions) - min(self.positions) > _TURN + _ROUNDED:
            return self
        steps = [remainder(later - earlier, _TURN) for earlier, later in pairwise(self.positions)]
        has_gap = any(later - earlier > _MAX_GAP for earlier, later in pairwise(self.times))
        if has_gap or any(abs(step) > _MAX_STEP for step in steps):
            return None
        positions = [self.positions[0]]
        for step in steps:
            positions.append(positions[-1] + step)
        return self._replace(positions=tuple(positions))


def read_joint_positions(topics: Iterable[RecordedTopic]) -> dict[str, JointPositions]:
    """Return the positions of all joints by their names.

    Several nodes may publish states of different joints on one topic, so that the times in headers
    go back from message to message: those of one joint need not.
    """
    positions = {}
    for topic in topics:  # those of the plainest name count
        states = group_values(
            (name, state) for name, state in _list_states(topic) if name not in positions
        )
        for name, listed in states.items():
            positions[name] = _order(listed)
    return positions


def _list_states(topic: RecordedTopic) -> Iterator[tuple[str, _State]]:
    """Yield each joint of each message with its state."""
    for time, message in topic.recorder_messages:
        names = find_value(message, "name")
        positions = find_value(message, "position")
        if not isinstance(names, list) or not isinstance(positions, tuple):
            continue
        if len(names) == len(positions):
            stamp = read_stamp(message)
            for name, position in zip(names, positions, strict=True):
                if isfinite(position):
                    yield str(name), _State(stamp, time, position)


def _order(states: Sequence[_State]) -> JointPositions:
    """Return the positions by the times of headers, or by the recorder's if these tell none."""
    stamps = [state.stamp for state in states]
    times = [state.time for state in states]
    if are_times(stamps):
        times = [stamp for stamp in stamps if stamp is not None]
    by_stamp = group_values((state.stamp, state.position) for state in states if state.stamp)
    return JointPositions(tuple(times), tuple(state.position for state in states), by_stamp)
