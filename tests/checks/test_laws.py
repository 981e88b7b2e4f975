"""Laws of checks that no row states: for every number that a robot may have, its outcome is the one that is computed here."""

from itertools import pairwise, permutations
from math import cos, pi, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import MissingElement, NotDecided
from grader.base.transforms import Transform, Vector, rotation_about, rotation_from_rpy
from grader.lab.checks.appearance import shows_box, shows_grey
from grader.lab.checks.collisions import collision_matches_visual
from grader.lab.checks.contact import clear_of
from grader.lab.checks.entries import entry_is
from grader.lab.checks.heights import bottom_at_height
from grader.lab.checks.inertia import inertia_plausible
from grader.lab.checks.joints import joint_axis
from grader.lab.checks.motion import axis_along, rolls_forward, turns_about_itself
from grader.lab.checks.placement import centre_at, frame_at
from grader.lab.checks.reference import kinematics_match_reference
from grader.lab.checks.structure import held_by
from grader.lab.checks.xacro_source import xacro_uses
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.mass_properties import turned as turned_inertia
from grader.ros.urdf.mass_properties import uniform_solid
from grader.ros.urdf.model import Box, Cylinder, Sphere
from grader.ros.urdf.shapes import Shape
from grader.ros.xml.urdf_format import JOINT_TYPES
from tests.checks.cases import IN_XACRO
from tests.checks.outcomes import Arguments, ask, fails, graded, passes
from tests.checks.robots import (
    ARM,
    BASE,
    CASTER,
    LIDAR,
    WHEEL,
    Scene,
    box,
    collision,
    cylinder,
    inertial,
    joint,
    link,
    paint,
    rolling,
    scene,
    sphere,
    swinging,
    turned,
    visual,
)
from tests.examples import examples
from tests.work import limited_work

pytestmark = pytest.mark.slow

SIZE = (0.6, 0.4, 0.2)
PLATE, ROD, BALL = Box(SIZE), Cylinder(0.1, 0.5), Sphere(0.1)
TEXTS = {PLATE: box(*SIZE), ROD: cylinder(0.1, 0.5), BALL: sphere(0.1)}
SYMMETRIES = {
    PLATE: ((1.0, 0.0, 0.0), pi),
    ROD: ((0.0, 0.0, 1.0), 0.7),
    BALL: ((0.6, 0.0, 0.8), 2.1),
}
SOLIDS = st.sampled_from([PLATE, ROD, BALL])
CENTRE: Arguments = {
    "link": "wheel",
    "relative_to": "base",
    "xyz": (-0.15, 0.225, 0.0),
    "tolerance": 0.002,
}
ALONG: Arguments = {
    "link": "wheel",
    "axis": (0.0, 0.0, 1.0),
    "relative_to": "base",
    "direction": (0.0, 0.0, 1.0),
}
ITSELF: Arguments = {"link": "wheel", "base": "base", "tolerance": 0.002, "angle": 1.0}

_rpys = st.tuples(*[st.floats(-4.0, 4.0)] * 3)
_places = st.tuples(*[st.floats(-1.0, 1.0, width=16)] * 3)
_turns = st.tuples(*[st.floats(-4.0, 4.0, width=16)] * 3)
_lengths = st.floats(-2, 2)
_directions = st.tuples(_lengths, _lengths, _lengths).filter(lambda axis: sum(map(abs, axis)) > 0.1)


# --- Shapes and colours -----------------------------------------------------------------------------------------------


@examples(10)
@given(order=st.permutations((0, 1, 2)), turns=st.tuples(*[st.integers(-2, 2)] * 3))
def test_a_box_passes_in_every_orientation_that_lies_right(
    order: list[int], turns: tuple[int, int, int]
) -> None:
    """Whatever quarter turns a visual has, a box passes exactly if one assignment of its edges fits."""
    size = (SIZE[order[0]], SIZE[order[1]], SIZE[order[2]])
    rpy = (turns[0] * pi / 2, turns[1] * pi / 2, turns[2] * pi / 2)
    outcome = ask(
        shows_box,
        scene(link("base", visual(box(*size), rpy=rpy))),
        link="base",
        size=SIZE,
        tolerance=0.002,
    )
    assert outcome.measured in [pytest.approx(size) for size in permutations(SIZE)]
    assert (outcome.status == "passed") == (outcome.measured == pytest.approx(SIZE))


@examples(20)
@given(channels=st.tuples(*[st.integers(0, 100)] * 3), level=st.integers(0, 100))
def test_grey_is_decided_by_the_channels_alone(channels: tuple[int, int, int], level: int) -> None:
    """For every colour in hundredths the result is that of exact arithmetic, the tolerance inclusive."""
    rgba = " ".join(f"{channel / 100:.2f}" for channel in channels) + " 1"
    shown = scene(link("lidar", visual(sphere(1.0), material=paint(rgba))))
    outcome = ask(shows_grey, shown, link="lidar", at_least=level / 100, tolerance=0.01)
    assert (outcome.status == "passed") == (
        max(channels) - min(channels) <= 1 and min(channels) >= level
    )


@examples(10)
@given(SOLIDS, _rpys)
def test_turned_solids(shape: Shape, rpy: Vector) -> None:
    """However both are turned, a symmetry changes nothing, and a shift along any axis of the link counts in full."""
    text = TEXTS[shape]
    pose = Transform(rotation_from_rpy(rpy), (0.1, 0.2, 0.3))
    same = (pose @ Transform(rotation_about(*SYMMETRIES[shape]))).rpy
    shown = visual(text, xyz=pose.translation, rpy=rpy)
    for off, status in (
        (0.0, "passed"),
        (0.0019, "passed"),
        (0.0021, "failed"),
        (-0.0021, "failed"),
    ):
        body = scene(link("arm", shown, collision(text, xyz=(0.1, 0.2 + off, 0.3), rpy=same)))
        assert ask(collision_matches_visual, body, link="arm", tolerance=0.002).status == status


@examples(10)
@given(SOLIDS, _rpys, _rpys)
def test_the_frames_do_not_matter(shape: Shape, of_shape: Vector, of_inertial: Vector) -> None:
    """However the shape and the frame of <inertial> are turned, an inertia within the tolerance passes and another fails."""
    solid = uniform_solid([(shape, Transform(rotation_from_rpy(of_shape), (0.1, 0.2, 0.3)))], 2.0)
    own = turned_inertia(
        solid.inertia, Transform(rotation_from_rpy(of_inertial)).inverse().rotation
    )
    shown = visual(TEXTS[shape], xyz="0.1 0.2 0.3", rpy=of_shape)
    for factor, status in ((1.0, "passed"), (1.08, "passed"), (1.12, "failed"), (0.88, "failed")):
        mass = inertial(2.0, [value * factor for value in own], xyz=solid.centre, rpy=of_inertial)
        assert (
            ask(
                inertia_plausible, scene(link("arm", mass, shown)), link="arm", tolerance=10.0
            ).status
            == status
        )


@examples(10)
@given(
    x=st.floats(-0.5, 0.5, width=16),
    z=st.floats(-0.5, 0.5, width=16),
    yaw=st.floats(-4.0, 4.0, width=16),
)
def test_the_depth_of_two_spheres(x: float, z: float, yaw: float) -> None:
    """For spheres the depth is known: the sum of the radii minus the distance of the centres."""
    one, other = link("base", visual(sphere(0.3))), link("wheel", visual(sphere(0.2)))
    found = scene(
        one, other, joint("j", "fixed", "base", "wheel", xyz=(x, 0.0, z), rpy=(0.0, 0.0, yaw))
    )
    depth = 0.5 - (x * x + z * z) ** 0.5
    outcome = ask(clear_of, found, link="wheel", of="base", tolerance=0.002)
    if depth < 0.0019:
        assert outcome.status == "passed"
    elif depth > 0.0021:
        assert outcome.status == "failed"
        assert outcome.measured == pytest.approx(depth, abs=2e-4)


@examples(10)
@given(rpy=_turns, height=st.floats(-2.0, 2.0, width=16))
def test_a_sphere_stands_on_its_lowest_point_however_it_is_turned(
    rpy: tuple[float, ...], height: float
) -> None:
    """A sphere's bottom is its radius below its centre, for every orientation."""
    found = scene(
        BASE, CASTER, joint("j", "fixed", "base", "caster", xyz=f"0.2 0 {height!r}", rpy=rpy)
    )
    passes(
        bottom_at_height,
        found,
        link="caster",
        relative_to="base",
        height=height - 0.05,
        tolerance=1e-9,
    )


# --- Places -----------------------------------------------------------------------------------------------------------


@examples(10)
@given(steps=st.lists(st.tuples(_places, _turns), min_size=1, max_size=4), moves=st.booleans())
def test_a_frame_passes_where_forward_kinematics_puts_it(
    steps: list[tuple[tuple[float, ...], tuple[float, ...]]], moves: bool
) -> None:
    """However many joints lead to a link, its frame is where they place it, within rounding."""
    names = ["base", *(f"m{index}" for index in range(len(steps) - 1)), "lidar"]
    kind = "continuous" if moves else "fixed"
    joined = [
        joint(f"j{index}", kind, names[index], names[index + 1], xyz=xyz, rpy=rpy)
        for index, (xyz, rpy) in enumerate(steps)
    ]
    found = scene(BASE, LIDAR, *map(link, names[1:-1]), *joined)
    xyz = _walked(steps)
    passes(frame_at, found, link="lidar", relative_to="base", xyz=xyz, tolerance=1e-9)
    beyond = (xyz[0] + 0.0021, xyz[1], xyz[2])
    fails(frame_at, found, link="lidar", relative_to="base", xyz=beyond, tolerance=0.002)


def _walked(steps: list[tuple[tuple[float, ...], tuple[float, ...]]]) -> tuple[float, float, float]:
    """Return the end of a chain of origins, computed from its tip: turn about x, y and z, then move."""
    x, y, z = 0.0, 0.0, 0.0
    for (u, v, w), (roll, pitch, yaw) in reversed(steps):
        y, z = y * cos(roll) - z * sin(roll), y * sin(roll) + z * cos(roll)
        x, z = x * cos(pitch) + z * sin(pitch), z * cos(pitch) - x * sin(pitch)
        x, y = x * cos(yaw) - y * sin(yaw), x * sin(yaw) + y * cos(yaw)
        x, y, z = x + u, y + v, z + w
    return (x, y, z)


def test_positions_do_not_depend_on_the_wheel_angle() -> None:
    """A check measures the given configuration: turning a wheel leaves its centre where it is."""
    robot = rolling().robot
    turned_robot = Configuration(robot.robot, {"wheel_joint": pi / 3})
    assert centre_at(turned_robot, **CENTRE).status == "passed"


def in_line(*kinds: str) -> Scene:
    """Return a base and a wheel with joints of these types in a chain between them, named a, b, c and so on."""
    between = [f"mount{index}" for index in range(len(kinds) - 1)]
    names = ["base", *between, "wheel"]
    held_in_line = [
        joint(letter, kind, above, below)
        for letter, kind, above, below in zip("abcdef", kinds, names, names[1:], strict=False)
    ]
    return scene(BASE, WHEEL, *map(link, between), *held_in_line)


@examples(10)
@given(
    kinds=st.lists(st.sampled_from(JOINT_TYPES), min_size=1, max_size=5),
    required=st.sampled_from(JOINT_TYPES),
)
def test_a_chain_passes_exactly_for_its_moving_joints(kinds: list[str], required: str) -> None:
    """Only the moving joints of a chain count: none for a fixed one, else one of the type."""
    moving = [kind for kind in kinds if kind != "fixed"]
    outcome = graded(held_by, in_line(*kinds), link="wheel", parent="base", joint_type=required)
    assert (outcome.status == "passed") == (moving == ([] if required == "fixed" else [required]))


# --- Motion -----------------------------------------------------------------------------------------------------------


@examples(10)
@given(yaw=st.floats(-180.0, 180.0), spin=st.floats(-4.0, 4.0), radius=st.floats(0.01, 2.0))
def test_a_wheel_drives_where_its_axis_says(yaw: float, spin: float, radius: float) -> None:
    """For every heading, size and initial turn of the wheel, it drives perpendicular to its axis, seen from above."""
    found = scene(
        BASE,
        link("wheel", visual(cylinder(radius, 0.05), rpy=(0.0, 0.0, spin))),
        joint(
            "wheel_joint",
            "continuous",
            "base",
            "wheel",
            rpy=turned(roll=-90, yaw=yaw),
            axis="0 0 1",
        ),
    )
    outcome = ask(rolls_forward, found, link="wheel", base="base", tolerance=1.0)
    assert outcome.measured == pytest.approx((cos(radians(yaw)), sin(radians(yaw)), 0.0), abs=1e-6)
    if abs(abs(yaw) - 1.0) > 1e-6:
        assert (outcome.status == "passed") == (abs(yaw) < 1.0)


@examples(10)
@given(off=st.floats(0.0, 180.0), about=st.floats(0.0, 360.0))
def test_the_angle_between_axes_is_exact(off: float, about: float) -> None:
    """However small or large, the measured angle is the one by which the frame was turned."""
    tilt = rolling(rpy=(0.0, radians(off), radians(about)))
    assert ask(axis_along, tilt, **ALONG, tolerance=off + 1e-6).status == "passed"
    assert ask(axis_along, tilt, **ALONG, tolerance=off - 1e-6).status == "failed"


@examples(10)
@given(
    rpy=_turns,
    along=st.floats(-2.0, 2.0, width=16),
    beside=st.floats(0.0, 1.0, width=16),
    around=st.floats(0.0, 6.0, width=16),
)
def test_the_eccentricity_does_not_depend_on_the_frame(
    rpy: tuple[float, float, float], along: float, beside: float, around: float
) -> None:
    """The distance of the two axes is as written, however the joint is turned and wherever the wheel is."""
    xyz = f"{beside * cos(around)!r} {beside * sin(around)!r} {along!r}"
    joined = joint("wheel_joint", "continuous", "base", "wheel", rpy=rpy, axis="0 0 -1")
    outcome = ask(
        turns_about_itself,
        scene(BASE, link("wheel", visual(cylinder(), xyz=xyz)), joined),
        **ITSELF,
    )
    assert outcome.measured == pytest.approx(beside, abs=1e-9)
    assert (outcome.status == "passed") == (beside <= 0.002)


@examples(10)
@given(tilt=st.floats(0.0, 180.0))
def test_a_wobble_is_at_most_a_right_angle(tilt: float) -> None:
    """An axis has no sign: rotated by 179 degrees it is one degree off."""
    found = rolling(wheel=link("wheel", visual(cylinder(), rpy=(radians(tilt), 0.0, 0.0))))
    outcome = ask(turns_about_itself, found, **{**ITSELF, "angle": 0.0})
    if min(tilt, 180.0 - tilt) > 1e-6:
        assert outcome.measured == pytest.approx(min(tilt, 180.0 - tilt), abs=1e-6)


@examples(10)
@given(
    rpy=_rpys,
    inner=_rpys,
    axis=_directions,
    wanted=_directions,
    slide=_lengths,
    scale=st.floats(0.01, 100),
)
def test_a_rotation_of_the_frame_with_its_contents_changes_nothing(
    rpy: Vector, inner: Vector, axis: Vector, wanted: Vector, slide: float, scale: float
) -> None:
    """Turn the joint's frame, and its axis and the frame below it back: the robot is the same, so is the outcome."""
    turn = Transform(rotation_from_rpy(inner))
    frame = Transform(rotation_from_rpy(rpy), (0.1, 0.0, 0.2))
    moved = (frame @ turn, turn.unrotate(axis))
    shift = tuple(component * slide for component in moved[1])
    along = moved[0].apply((shift[0], shift[1], shift[2]))
    x, y, z = (component * scale for component in moved[1])
    arguments: Arguments = {
        "link": "tip",
        "relative_to": "base",
        "direction": wanted,
        "tolerance": 40.0,
    }
    arguments |= {"through": (0.1, -3.0, 0.2), "distance": 1.0}
    before = ask(joint_axis, swinging(xyz=frame.translation, rpy=frame.rpy, axis=axis), **arguments)
    after = ask(joint_axis, swinging(xyz=along, rpy=moved[0].rpy, axis=(x, y, z)), **arguments)
    assert (before.status, before.unit) == (after.status, after.unit)
    assert before.measured == pytest.approx(after.measured, abs=1e-6)


def test_the_axis_is_measured_in_the_pose_of_the_robot() -> None:
    """Joints above turn the axis and move it; the joint itself does not."""
    robot = scene(
        link("base"),
        link("upper"),
        link("lower"),
        joint("yaw", "continuous", "base", "upper", axis="0 0 1"),
        joint("pitch", "continuous", "upper", "lower", xyz="1 0 0", axis="0 1 0"),
    ).robot.robot
    turned_robot = Configuration(robot, {"yaw": radians(90), "pitch": 1.0})
    wanted: Arguments = {"link": "lower", "relative_to": "base", "tolerance": 0.1}
    assert (
        joint_axis(
            turned_robot, **wanted, direction=(-1.0, 0.0, 0.0), through=(7.0, 1.0, 0.0)
        ).status
        == "passed"
    )
    assert (
        joint_axis(
            Configuration(robot), **wanted, direction=(0.0, 1.0, 0.0), through=(1.0, 7.0, 0.0)
        ).status
        == "passed"
    )
    seen = joint_axis(
        turned_robot,
        **{**wanted, "relative_to": "lower"},
        direction=(0.0, 1.0, 0.0),
        through=(0.0, 0.0, 0.0),
    )
    assert seen.status == "passed"


# --- Work -------------------------------------------------------------------------------------------------------------


def test_comparing_with_the_reference_is_bounded() -> None:
    """100 samples of an arm with 7 joints take a thousand lines of Python each; of thousands of joints nothing is compared."""
    for count in (7, 600):
        names = [f"l{index}" for index in range(count + 1)]
        pairs = enumerate(pairwise(names))
        joints = [
            joint(
                f"j{index}", "revolute", *pair, xyz="0 0.1 0.3", axis=("0 0 1", "0 1 0")[index % 2]
            )
            for index, pair in pairs
        ]
        robot = scene(*map(link, names), *joints).robot
        with limited_work(900_000):
            if count == 7:
                assert kinematics_match_reference(robot, robot, links=["l7"]).status == "passed"
            else:
                with pytest.raises(NotDecided, match="more than 500 joints lead to 'l600'"):
                    kinematics_match_reference(robot, robot, links=["@tip"])


def test_a_submission_that_used_up_its_work() -> None:
    """What is too much work to look through needs manual grading."""
    submission = IN_XACRO.with_files({}).submission  # its own: that of the sample is shared
    submission.needed_urdf()
    submission.budget.left = 0
    with pytest.raises(NotDecided, match="more work than one submission may use"):
        xacro_uses(submission, macros=1)


def test_an_element_of_a_file_that_is_no_xml() -> None:
    """It misses the robot, as everything in it does."""
    with pytest.raises(
        MissingElement, match="the file is not well-formed XML, so it has no elements"
    ):
        entry_is(ARM.robot, Scene("nothing").submission, at="gazebo")
