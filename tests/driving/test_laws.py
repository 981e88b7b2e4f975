"""Laws of how a robot rests and rolls, for all numbers."""

from math import atan2, cos, degrees, pi, sin, tan

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.base.transforms import unit
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf
from grader.ros.urdf.resting import find_rest, make_body
from grader.ros.urdf.standing_robot import StandingRobot
from tests.examples import examples

pytestmark = pytest.mark.slow

_SIZES = st.floats(0.05, 1.0)
_SHIFTS = st.floats(-0.6, 0.6)
_INSIDE = st.floats(-0.5, 0.5)  # of the size of a box
_STILL = 1e-6  # radians, with a mass at most a metre away


def configuration(*elements: str) -> Configuration:
    """Return a robot whose parts are fixed to its base, or turn."""
    robot = read_urdf(f'<robot name="r">{"".join(elements)}</robot>'.encode(), "r.urdf").robot
    assert robot is not None
    return Configuration(robot)


def part(name: str, geometry: str, xyz: str, rpy: str = "0 0 0", axis: str = "") -> str:
    """Return a link and the joint that connects it to the base."""
    kind = "continuous" if axis else "fixed"
    link = f'<link name="{name}"><visual><geometry>{geometry}</geometry></visual></link>'
    ends = f'<parent link="base"/><child link="{name}"/><origin xyz="{xyz}" rpy="{rpy}"/>'
    return f'{link}<joint name="{name}_joint" type="{kind}">{ends}{axis}</joint>'


def base(size: str, mass_at: str) -> str:
    """Return the link of the base: a box with its mass at a point."""
    inertial = (
        f'<inertial><origin xyz="{mass_at}"/><mass value="1"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
    )
    visual = f'<visual><geometry><box size="{size}"/></geometry></visual>'
    return f'<link name="base">{visual}{inertial}</link>'


@examples(60)
@example(
    size=(1.0, 1.0, 0.3046875),
    shift=(0.0, -0.4566063700122188, 0.0),
    ball=(-0.09291311132743107, 0.0, 0.0, 0.2940003977798505),
    roll=2.921875,
)
@given(
    size=st.tuples(_SIZES, _SIZES, _SIZES),
    shift=st.tuples(_INSIDE, _INSIDE, _INSIDE),
    ball=st.tuples(_SHIFTS, _SHIFTS, _SHIFTS, _SIZES),
    roll=st.floats(-3.0, 3.0),
)
def test_a_robot_at_rest_cannot_fall(
    size: tuple[float, float, float],
    shift: tuple[float, float, float],
    ball: tuple[float, float, float, float],
    roll: float,
) -> None:
    """Wherever its mass is inside of it, no small turn of the ground lets the mass go down by more than a turn of one
    microradian, which is no motion; the ground is below all shapes; and the mass is not higher than when the robot was set down.
    """
    x, y, z, radius = ball
    mass_at = [where * length for where, length in zip(shift, size, strict=True)]
    robot = configuration(
        base(" ".join(map(repr, size)), " ".join(map(repr, mass_at))),
        part("ball", f'<sphere radius="{radius / 2}"/>', f"{x} {y} {z}"),
        part(
            "rod", f'<cylinder radius="{radius / 3}" length="0.4"/>', f"{y} {z} {x}", f"{roll} 1 0"
        ),
    )
    body = make_body(robot, "base")
    rest = find_rest(body)
    if rest.has_fallen:
        return
    assert body.mass_height(rest.up) <= body.mass_height((0.0, 0.0, 1.0)) + 1e-9
    assert min(rest.heights.values()) == pytest.approx(0.0, abs=1e-9)
    for number in range(16):
        angle = number * pi / 8.0
        nearby = unit((rest.up[0] + 1e-3 * cos(angle), rest.up[1] + 1e-3 * sin(angle), rest.up[2]))
        assert nearby is not None
        assert body.mass_height(nearby) > body.mass_height(rest.up) - _STILL


@examples(40)
@given(radius=st.floats(0.02, 0.5), reach=st.floats(0.1, 1.0), lift=st.floats(-0.03, 0.03))
def test_the_lean_is_that_of_the_plane_through_the_contacts(
    radius: float, reach: float, lift: float
) -> None:
    """On two wheels and a ball of one radius, the base leans by the slope of the line between their middles."""
    wheel = f'<cylinder radius="{radius}" length="0.02"/>'
    across = f"{-pi / 2!r} 0 0"
    axis = '<axis xyz="0 0 1"/>'
    robot = configuration(
        base("0.01 0.01 0.01", f"{reach / 3} 0 0"),
        part("left", wheel, "0 0.3 0", across, axis),
        part("right", wheel, "0 -0.3 0", across, axis),
        part("ball", f'<sphere radius="{radius}"/>', f"{reach} 0 {lift}"),
    )
    rest = StandingRobot(robot, ["left", "right", "ball"]).rest
    assert rest.tilt == pytest.approx(degrees(abs(atan2(lift, reach))), abs=0.01)
    assert sorted(rest.contacts) == ["ball", "left", "right"]


@examples(40)
@given(
    left=st.floats(0.05, 0.2),
    share=st.floats(0.7, 1.4),
    track=st.floats(0.2, 1.0),
    yaw=st.floats(-40.0, 40.0),
)
def test_two_wheels_roll_about_the_point_that_their_radii_give(
    left: float, share: float, track: float, yaw: float
) -> None:
    """The speed is the mean of the radii, the turn their difference over the track, in the direction of the wheels."""
    right = left * share
    turn = yaw * pi / 180.0
    y, x = 0.5 * track * cos(turn), -0.5 * track * sin(turn)
    axis, across = '<axis xyz="0 0 1"/>', f"{-pi / 2!r} 0 {turn!r}"
    robot = configuration(
        base("0.01 0.01 0.01", "0 0 0"),
        part("left", f'<cylinder radius="{left}" length="0.01"/>', f"{x} {y} {left}", across, axis),
        part(
            "right",
            f'<cylinder radius="{right}" length="0.01"/>',
            f"{-x} {-y} {right}",
            across,
            axis,
        ),
        part("front", '<sphere radius="0.001"/>', "0.5 0 0.001"),
        part("back", '<sphere radius="0.001"/>', "-0.5 0 0.001"),
    )
    standing = StandingRobot(robot, ["left", "right"])
    course = standing.drive(standing.wheels(), [1.0, 1.0], (1.0, 0.0, 0.0))
    assert course.speed == pytest.approx((left + right) / 2, rel=1e-6)
    assert course.turn == pytest.approx((right - left) / track, abs=1e-6)
    assert course.off == pytest.approx(yaw, abs=1e-5)
    assert max(course.slips) == pytest.approx(0.0, abs=1e-8)


@examples(20)
@given(
    angle=st.sampled_from((45.0, 30.0, 60.0)), ahead=st.floats(0.1, 0.5), aside=st.floats(0.1, 0.5)
)
def test_four_mecanum_wheels_drive_sideways(angle: float, ahead: float, aside: float) -> None:
    """With the wheels of each diagonal turning alike, it drives sideways at the speed of the rims times the tangent of
    the roller angle, and does not turn.
    """
    axis, across = '<axis xyz="0 0 1"/>', f"{-pi / 2!r} 0 0"
    wheel = '<cylinder radius="0.1" length="0.05"/>'
    places = {"fl": (1, 1), "fr": (1, -1), "rl": (-1, 1), "rr": (-1, -1)}
    robot = configuration(
        base("0.1 0.1 0.1", "0 0 0"),
        *(
            part(name, wheel, f"{x * ahead} {y * aside} 0", across, axis)
            for name, (x, y) in places.items()
        ),
    )
    standing = StandingRobot(robot, [*places])
    rollers = [-angle, angle, angle, -angle]
    course = standing.drive(standing.wheels(rollers), [-1.0, 1.0, 1.0, -1.0], (1.0, 0.0, 0.0))
    assert course.turn == pytest.approx(0.0, abs=1e-9)
    assert course.forward == pytest.approx(0.0, abs=1e-9)
    assert abs(course.left) == pytest.approx(0.1 * tan(angle * pi / 180.0), rel=1e-6)
    straight = standing.drive(standing.wheels(rollers), [1.0] * 4, (1.0, 0.0, 0.0))
    assert (straight.forward, straight.left) == pytest.approx((0.1, 0.0), abs=1e-6)


@examples(20)
@given(reach=st.floats(0.0, 1.0))
def test_the_positions_of_joints_count(reach: float) -> None:
    """A mass that slides beyond the contacts tips the robot over, and one that stays between them does not."""
    slide = (
        '<link name="mass"><visual><geometry><box size="0.01 0.01 0.01"/></geometry></visual><inertial><mass value="99"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>'
        '<joint name="slide" type="prismatic"><parent link="base"/><child link="mass"/><axis xyz="1 0 0"/>'
        '<limit lower="0" upper="1" effort="1" velocity="1"/></joint>'
    )
    robot = configuration(base("0.4 0.4 0.1", "0 0 0"), slide).moved("slide", reach)
    rest = find_rest(make_body(robot, "base"))
    centre = 0.99 * reach
    if abs(centre - 0.2) > 1e-3:
        assert (rest.tilt < 0.01) == (centre < 0.2)
