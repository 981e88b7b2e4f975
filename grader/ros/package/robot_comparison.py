"""What two readings of a robot's files are compared by."""

from typing import TYPE_CHECKING

from grader.base.records import Named
from grader.ros.xml.elements import text_in
from grader.ros.xml.urdf_format import CHILDREN

if TYPE_CHECKING:
    from grader.ros.urdf.reader import Reading


RobotFaults = tuple[tuple[int, int], int]  # refusals, with consequences, and dropped parts


class RobotState(Named):
    """What is wrong with a robot, and what it is."""

    refusals: tuple[int, int]  # reasons for which xacro or ROS 2 refuses it, and their consequences
    dropped: int  # parts of it that ROS 2 drops
    content: str  # the robot, and what other tools read of the file
    is_read: bool  # whether it is a robot that ROS 2 loads once what is certain is corrected

    @property
    def faults(self) -> RobotFaults:
        """How much is wrong: of two readings, that with less is the better one."""
        return self.refusals, self.dropped


def make_state(reading: "Reading") -> RobotState:
    """Return what a reading is compared by."""
    kinds = [problem.kind for problem in reading.problems]
    rejecting = [kind for kind in kinds if kind.effect == "rejects"]
    refusals = [kind for kind in rejecting if not kind.is_consequence]
    dropped = [kind for kind in kinds if kind.effect == "drops" and not kind.is_consequence]
    robot = reading.robot
    root = reading.elements
    content: list[object] = []
    if robot and root is not None:
        content = [sorted(map(repr, robot.links)), sorted(map(repr, robot.joints))]
        for child in root:
            if child.tag not in CHILDREN["robot"]:
                for part in child.iter():
                    inside = [inner.tag for inner in part]
                    content.append((part.tag, sorted(part.items()), text_in(part), inside))
    is_read = reading.verdict != "rejected" or reading.is_meant
    counts = len(refusals), len(rejecting) - len(refusals)
    return RobotState(counts, len(dropped), repr(content), is_read)
