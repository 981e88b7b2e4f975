"""Robots that lean, or that their wheels do not drive straight ahead.

`grader inspect` alone warns of them: no rubric asks for them by `names_agree`.
"""

from grader.base.problems import Problem
from grader.base.source import Location
from grader.ros.urdf.driving import DescribedDriving
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    Rule,
)

_ROBOT_STANDS = Rule(
    "robot-stands",
    "values",
    OTHER_VALUE,
    "A robot stands level on its wheels, and they drive it straight ahead.",
    why=(
        "In Gazebo the robot tilts until it rests on other parts, or drives a curve. Its "
        "sensors point up or down, and a lidar may see the ground."
    ),
    wrong='<origin xyz="0.15 0 -0.06"/>',
    right='<origin xyz="0.15 0 -0.03"/>',
    frame="standing/rover.urdf",
)


def standing_problem(path: str, driving: DescribedDriving, *, with_course: bool) -> Problem | None:
    """Return what is wrong with how a robot stands and drives; None if nothing is known to be.

    Args:
        path: The file of the robot.
        driving: How it stands and drives.
        with_course: Whether it counts that it does not drive straight ahead.
    """
    faults = list(driving.rest_faults)
    texts = []
    if faults:
        texts.append(f"on level ground, {'; '.join(fault.text for fault in faults)}")
    if with_course and driving.course_faults:
        course = "; ".join(fault.text for fault in driving.course_faults)
        texts.append(f"when its wheels turn forward, {course}")
        faults += driving.course_faults
    if not texts:
        return None
    places = [fault.at.resolve() for fault in faults if fault.at]
    at = next(iter(places), Location(path, 1, 1))
    return _ROBOT_STANDS.problem("; ".join(texts), at, is_certain=False)
