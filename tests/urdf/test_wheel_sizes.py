"""The wheels that joints turn: of which shapes they are, and where."""

import pytest

from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf
from grader.ros.urdf.wheel_sizes import WheelSize, measure_wheel

pytestmark = pytest.mark.slow

_ROUND = '<cylinder radius="0.1" length="0.04"/>'
_BALL = '<sphere radius="0.1"/>'
_BESIDE = '<origin xyz="0 0.02 0" rpy="1.5707963 0 0"/>'


def _link(name: str, geometry: str = "", origin: str = _BESIDE) -> str:
    visual = f"<visual>{origin}<geometry>{geometry}</geometry></visual>" if geometry else ""
    return f'<link name="{name}">{visual}</link>'


def _joint(
    name: str,
    parent: str,
    child: str,
    kind: str = "continuous",
    axis: str = "0 1 0",
    more: str = "",
) -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="0 0.2 0"/><axis xyz="{axis}"/>{more}</joint>'
    )


def _measured(*parts: str) -> WheelSize:
    """Return the wheel of the joint `turn` in the frame of the link `base`."""
    text = f'<robot name="r"><link name="base"/>{"".join(parts)}</robot>'
    robot = read_urdf(text.encode(), "r.urdf").robot
    assert robot is not None
    return measure_wheel(Configuration(robot), robot.joint("turn"), "base")


def test_a_wheel_is_the_largest_round_shape_about_its_axis() -> None:
    """Its middle is that of the shape, and its width that of the widest one."""
    hub = _link("hub", '<cylinder radius="0.03" length="0.1"/>')
    wheel = _measured(
        _link("wheel", _ROUND),
        hub,
        _joint("turn", "base", "wheel"),
        _joint("fix", "wheel", "hub", "fixed"),
    )
    assert wheel.radii == (0.1, 0.03)
    assert wheel.half_width == 0.05
    assert wheel.middle == pytest.approx((0.0, 0.22, 0.0))


@pytest.mark.parametrize(
    "wheel",
    [
        _link("wheel"),
        _link("wheel", '<box size="0.2 0.2 0.04"/>'),
        _link("wheel", _ROUND, ""),  # its axis stands up
        _link("wheel", _BALL, '<origin xyz="0.05 0 0"/>'),  # it is beside the axis
    ],
)
def test_other_shapes_are_no_wheel(wheel: str) -> None:
    """Then only the place of the joint is known."""
    found = _measured(wheel, _joint("turn", "base", "wheel"))
    assert (found.radii, found.half_width) == ((), None)
    assert found.middle == pytest.approx((0.0, 0.2, 0.0))


def test_a_ball_is_a_wheel_without_a_width() -> None:
    """Whatever its orientation is."""
    found = _measured(_link("wheel", _BALL, ""), _joint("turn", "base", "wheel"))
    assert (found.radii, found.half_width) == ((0.1,), 0.0)


def test_a_joint_without_a_wheel_stands_for_those_that_follow_it() -> None:
    """As a virtual joint whose wheels mimic it."""
    mimic = '<mimic joint="turn"/>'
    found = _measured(
        _link("axle"),
        _joint("turn", "base", "axle"),
        _link("wheel", _ROUND),
        _joint("follow", "base", "wheel", more=mimic),
    )
    assert found.radii == (0.1,)
    assert found.middle == pytest.approx((0.0, 0.2, 0.0))


def test_a_steering_joint_has_the_wheel_that_it_carries() -> None:
    """The axis is its own."""
    found = _measured(
        _link("other", _BALL, ""),
        _joint("elsewhere", "base", "other"),
        _link("fork"),
        _joint("turn", "base", "fork", axis="0 0 1"),
        _link("bell"),
        _joint("ring", "fork", "bell"),
        _link("wheel", _ROUND),
        _joint("roll", "fork", "wheel"),
    )
    assert found.radii == (0.1,)
    assert found.axis == pytest.approx((0.0, 0.0, 1.0))
