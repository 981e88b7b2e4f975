"""What ROS 2 Lyrical reads of URDF 1.1 and 1.2: capsules, quaternions, limits; and the release that a file needs."""

from math import pi

import pytest

from grader.lab.checks.collisions import collides_as
from grader.ros.api import StatedReleases
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Capsule
from grader.ros.urdf.reader import Reading, read_urdf
from grader.ros.urdf.resting import lowest_points
from grader.ros.urdf.shapes import PlacedShape
from grader.ros.urdf.versions import newest_version
from tests.oracles.check_urdf import LYRICAL

_ARM = """\
<robot name="arm" version="{}">
  <link name="base">
    <collision><geometry><capsule radius="0.1" length="0.4"/></geometry></collision>
  </link>
  <link name="tool"/>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
    <origin xyz="0 0 1" quat_xyzw="0 0 3 3"/><limit lower="0" upper="1"/>
  </joint>
</robot>
"""


def _read(version: str) -> Reading:
    return read_urdf(_ARM.format(version), "arm.urdf", (LYRICAL,))


def _robot(version: str) -> Configuration:
    reading = _read(version)
    assert reading.robot is not None
    return Configuration(reading.robot)


def test_a_quaternion_turns_from_version_1_1_on() -> None:
    """Of any length; in a file of version 1.0 it turns nothing."""
    turned = _robot("1.2").pose("tool", relative_to="base")
    assert turned.rpy == pytest.approx((0.0, 0.0, pi / 2))
    assert _robot("1.0").pose("tool", relative_to="base").rpy == (0.0, 0.0, 0.0)


def test_a_limit_without_effort_and_velocity_is_none() -> None:
    """In a file of version 1.2."""
    limit = _robot("1.2").robot.joint("turn").limit
    assert limit is not None
    assert (limit.lower, limit.upper, limit.effort) == (0.0, 1.0, float("inf"))


@pytest.mark.parametrize(
    ("sizes", "status"), [((0.1, 0.4), "passed"), ((0.1, 0.5), "failed"), ((0.2, 0.4), "failed")]
)
def test_collides_as_a_capsule(sizes: tuple[float, float], status: str) -> None:
    """Its radius, and its length without the half spheres."""
    outcome = collides_as(_robot("1.2"), link="base", tolerance=0.001, capsule=sizes)
    assert outcome.status == status
    assert f"a capsule of radius {sizes[0]} m and length {sizes[1]} m" in outcome.message


def test_a_capsule_touches_the_ground_with_both_ends_where_it_lies() -> None:
    """Along x it lies on two points below its ends; upright it stands on one."""
    lying = _robot("1.2")
    shape = Capsule(0.1, 0.4)
    turned = lying.pose("base")
    assert not shape.is_empty
    assert Capsule(0.0, 0.4).is_empty
    [foot] = lowest_points([PlacedShape(shape, turned)], (0.0, 0.0, 1.0))
    assert foot == pytest.approx((0.0, 0.0, -0.3))
    ends = sorted(lowest_points([PlacedShape(shape, turned)], (1.0, 0.0, 0.0)))
    assert ends == [pytest.approx((-0.1, 0.0, -0.2)), pytest.approx((-0.1, 0.0, 0.2))]


def test_the_release_that_a_file_needs() -> None:
    """The first that reads its version; none for what Jazzy reads, and for what none reads."""
    assert _read("1.2").needed_release == LYRICAL
    assert _read("1.0").needed_release is None
    assert _read("1.9").needed_release is None


def test_the_newest_version_is_that_of_the_oldest_release() -> None:
    """A robot for two releases has to be read by both; without a release it is for Jazzy."""
    assert newest_version((LYRICAL,)) == (1, 2)
    assert newest_version(("jazzy", LYRICAL)) == newest_version(StatedReleases().releases) == (1, 0)
