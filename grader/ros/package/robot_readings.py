"""The slips of a robot that are proven by reading its files again.

What is written can stand for one thing only if no other way to read it gives another robot.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property, partial

from grader.base.element_edits import edit_files, edits_before
from grader.base.problems import Fixes, Problem, causes, in_order
from grader.base.slips import Slip
from grader.base.source import Edits
from grader.files.reading import URDF_LIMIT
from grader.files.tree import overlaid
from grader.ros.package.robot_comparison import RobotFaults, RobotState
from grader.ros.package.robot_file import Read, Surroundings, read_as_ros
from grader.ros.python.budget import Budget
from grader.ros.xml.xml_problems import RECOVERED

_MAX_ROUNDS = 3  # in which slips are listed
_MAX_READINGS = 50  # of a robot


def read_edited(urdf: Read, surroundings: Surroundings, files: Mapping[str, bytes | None]) -> Read:
    """Return a robot read again with other files, in a budget of its own."""
    around = surroundings._replace(budget=Budget())
    if around.tree.files:
        around = around._replace(tree=overlaid(around.tree, files))
    is_renamed = files.get(urdf.path, b"") is None
    path = next((new for new, data in files.items() if data is not None and is_renamed), urdf.path)
    return read_as_ros(files.get(path) or urdf.data, path, around)


def read_as_meant(urdf: Read, surroundings: Surroundings) -> Read:
    """Return a robot that ROS 2 rejects as it can only be meant.

    It has the problems for which ROS 2 rejects it, and what is assumed.
    """
    if urdf.reading.verdict != "rejected":
        return urdf
    readings = RobotReadings(urdf, surroundings._replace(memory=None))
    slips = readings.find_slips()
    meant = readings.chosen.reading
    if not slips:
        return urdf
    problems = causes(urdf.reading.problems)
    for slip in slips:
        fixes = Fixes(partial(list, [slip.fix]))
        problems.append(Problem(RECOVERED, slip.assumption, slip.location, fixes=fixes))
    problems += meant.problems
    is_meant = meant.is_meant or meant.verdict != "rejected"
    reading = urdf.reading._replace(
        robot=meant.robot, problems=in_order(dict.fromkeys(problems)), is_meant=is_meant
    )
    return urdf._replace(reading=reading)


class RobotReadings:
    """Readings of a robot with slips corrected: those that were chosen, and another one.

    Each reading has its own budget. What `find_slips` returns is graded, and shown of a robot that
    ROS 2 rejects.
    """

    def __init__(self, urdf: Read, surroundings: Surroundings) -> None:
        self._written = urdf
        self._surroundings = surroundings
        self.chosen = urdf  # with the slips that were chosen
        self._edits: Edits = ()
        self._left = _MAX_READINGS

    @cached_property
    def _state(self) -> RobotState:
        """What is wrong with the robot with the slips that were chosen; few robots have any."""
        return self._written.state

    def find_slips(self) -> list[Slip]:
        """Return the slips that can be read in one way only, each tried on top of those before it.

        One slip hides the next: what is left is listed once more. What is written at the place of
        an earlier slip belongs to it.
        """
        slips: list[Slip] = []
        for _ in range(_MAX_ROUNDS):
            before = len(self._edits)
            for choice in self._choices():
                slip = self._choose(choice) if self._left > 0 else None
                if slip:
                    _add_slip(slips, slip)
            if len(self._edits) == before:
                break
        return slips

    def _choices(self) -> Iterator[Sequence[Slip]]:
        """Yield the choices of the robot as it is read now, with edits of what is written.

        One of which a way changes what was corrected already is none.
        """
        earlier = self._edits
        for choice in self.chosen.slip_choices:
            ways = []
            for slip in choice:
                edits = edits_before(self._content, earlier, slip.edits)
                if edits is not None:
                    ways.append(slip._replace(edits=edits))
            if len(ways) == len(choice):
                yield ways

    def _choose(self, choice: Sequence[Slip]) -> Slip | None:
        """Return the one way to read what is written that gives a robot; None if several do.

        Of all ways, those count that leave the fewest reasons to refuse or to drop something.
        """
        ways: dict[str, tuple[Slip, RobotState, Read]] = {}  # by the robots that they give
        fewest = self._state.faults
        for slip in choice:
            read = self._read(slip)
            state = read.state if read else None
            if not read or not state or not self._is_better(slip, state, fewest):
                continue
            if state.faults < fewest:
                fewest = state.faults
                ways = {}
            is_refused = state.refusals < self._state.refusals
            ways.setdefault(state.content, (slip._replace(is_refused=is_refused), state, read))
        if len(ways) != 1:
            return None
        [(slip, self._state, self.chosen)] = ways.values()
        self._edits += slip.edits
        return slip

    def _is_better(self, slip: Slip, after: RobotState, fewest: RobotFaults) -> bool:
        """Return whether a slip matters, with which the robot has no more than the fewest faults.

        It does not if the robot is read as it is meant without it.
        """
        before = self._state
        if after.faults > fewest or (after.faults == before.faults and slip.is_refused):
            return False
        if before.is_read:
            return after.content != before.content
        return after != before

    def _read(self, slip: Slip) -> Read | None:
        """Return the robot with a slip corrected; None if the edits do not fit."""
        self._left -= 1
        files = edit_files(self._content, self._edits + slip.edits)
        if files is None:
            return None
        return read_edited(self._written, self._surroundings, files)

    def _content(self, path: str) -> bytes | None:
        if path == self._written.path:
            return self._written.data
        return self._surroundings.tree.read(path, URDF_LIMIT)


def _add_slip(slips: list[Slip], slip: Slip) -> None:
    """Add a slip to others, or to the one of them at whose place it writes."""
    places = {edit.location for edit in slip.edits}
    for index, earlier in enumerate(slips):
        if not places.isdisjoint(edit.location for edit in earlier.edits):
            assumption = f"{earlier.assumption} and {slip.assumption}"
            edits = earlier.edits + slip.edits
            slips[index] = earlier._replace(edits=edits, assumption=assumption)
            return
    slips.append(slip)
