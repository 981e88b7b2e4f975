"""joint_limits without a range: the effort and velocity of a joint alone."""

from typing import Any

import pytest

from grader.base.errors import RubricError
from grader.lab.checks.joints import joint_limits
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf

_ROBOT = (
    '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="{}">'
    '<parent link="a"/><child link="b"/>{}</joint></robot>'
)
_LIMIT = '<limit lower="0" upper="1" effort="10" velocity="2"/>'


def _configuration(kind: str, limit: str) -> Configuration:
    robot = read_urdf(_ROBOT.format(kind, limit)).robot
    assert robot is not None
    return Configuration(robot)


CASES = [
    ("revolute", _LIMIT, {"effort": 10.0, "velocity": 2.0}, "passed"),
    ("continuous", _LIMIT, {"effort": 10.0}, "passed"),
    ("revolute", _LIMIT, {"velocity": 3.0}, "failed"),
    ("continuous", "", {"effort": 10.0}, "failed"),
]


@pytest.mark.parametrize(("kind", "limit", "arguments", "status"), CASES)
def test_effort_and_velocity_need_no_range(
    kind: str, limit: str, arguments: dict[str, Any], status: str
) -> None:
    """A joint that turns without end has them as well."""
    outcome = joint_limits(_configuration(kind, limit), link="b", **arguments)
    assert outcome.status == status


@pytest.mark.parametrize("arguments", [{}, {"lower": 1.0}, {"upper": 1.0, "effort": 1.0}])
def test_limits_need_both_ends_or_another_number(arguments: dict[str, Any]) -> None:
    """A rubric that asks for half a range, or for nothing, is wrong."""
    with pytest.raises(RubricError):
        joint_limits(_configuration("revolute", _LIMIT), link="b", **arguments)
