"""Positions: frames, centres and bottoms, just inside and just outside their tolerances."""

from itertools import product
from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.contact import clear_of, stands_on
from grader.checks.placement import centre_at, frame_at
from grader.robot.kinematics import Configuration
from tests.checks.cases import BASE, CASTER, FOOT, FORWARD, LIDAR, WHEEL, mounted, rolling
from tests.checks.outcomes import Arguments, ask, fails, graded, missing, passes
from tests.checks.robots import Scene, box, cylinder, joint, link, mesh, numbers, scene, turned, visual
from tests.examples import examples

FRAME: Arguments = {"link": "lidar", "relative_to": "base", "xyz": (0.15, 0.0, 0.225), "tolerance": 0.002}
CENTRE: Arguments = {"link": "wheel", "relative_to": "base", "xyz": (-0.15, 0.225, 0.0), "tolerance": 0.002}
BOTTOM: Arguments = {"link": "base", "relative_to": "base", "height": 0.0, "tolerance": 0.002}
BOTTOMS: Arguments = {"links": ["wheel", "caster"], "relative_to": "foot", "height": 0.0, "tolerance": 0.002}
ON: Arguments = {"link": "lidar", "on": "base", "tolerance": 0.002}
CLEAR: Arguments = {"link": "wheel", "of": "base", "tolerance": 0.002}
UNDER: Arguments = {"link": "foot", "base": "base", "wheels": ["wheel"], "tolerance": 0.002, "angle": 1.0}

# Offsets in metres from the expected value, and whether they are within a tolerance of 2 mm.
OFFSETS = [(0.0, True), (0.0019, True), (0.002, True), (-0.002, True), (0.0021, False), (-0.0021, False)]


def hanging(kind: str, **more: str) -> Scene:
    """Return a base with a wheel on a joint that is broken in some way."""
    return scene(BASE, WHEEL, joint("wheel_joint", kind, "base", "wheel", **more))


def far_away() -> Scene:
    """Return a base with a wheel so far away that its position is not finite."""
    far = numbers((1e308, 1e308, 1e308))
    mount, wheel = (
        joint("mount_joint", "fixed", "base", "m", xyz=far),
        joint("wheel_joint", "fixed", "m", "wheel", xyz=far),
    )
    return scene(BASE, WHEEL, link("m"), mount, wheel)


@pytest.mark.parametrize(
    ("found", "reason", "at"),
    [
        (hanging("continuous", axis="0 0 0"), "the joint's axis is 0 0 0", 'xyz="0 0 0"'),
        (hanging("fixed", xyz="1 2"), "the joint's origin cannot be read", '<origin xyz="1 2"'),
        (hanging("fixed", rpy="a b c"), "the joint's origin cannot be read", '<origin rpy="a b c"'),
        (far_away(), "the joint's numbers are too large", '<joint name="wheel_joint"'),
    ],
    ids=["zero-axis", "two-numbers", "letters", "overflow"],
)
def test_poses_below_a_joint_without_a_pose_are_unknown(found: Scene, reason: str, at: str) -> None:
    """If a joint's pose is undefined, every check below it misses the same thing, with the reason."""
    for check, arguments in ((frame_at, {**FRAME, "link": "wheel"}), (centre_at, CENTRE), (clear_of, CLEAR)):
        error = missing(check, found, **arguments)
        assert (error.kind, error.name) == ("pose below joint", "wheel_joint")
        assert fails(check, found, at=at, **arguments) == f"the pose is undefined: {reason} (joint 'wheel_joint')"


def test_a_joint_without_a_pose_hides_nothing_above_it() -> None:
    """Links above the broken joint are measured as usual, and so are links of one frame group below it."""
    broken = joint("a", "fixed", "foot", "base", xyz="0 0")
    found = scene(FOOT, BASE, LIDAR, broken, joint("b", "fixed", "base", "lidar", xyz="0.15 0 0.225"))
    passes(frame_at, found, **FRAME)
    passes(stands_on, found, **ON)
    assert missing(frame_at, found, **{**FRAME, "relative_to": "foot"}).name == "a"


@pytest.mark.parametrize("kind", ["continuous", "revolute", "prismatic", "planar", "floating", "fixed", "Fixed", ""])
def test_joints_of_every_type_are_at_zero(kind: str) -> None:
    """Positions are measured with every joint at 0, whatever its type, even an unknown one."""
    joined = joint("j", kind, "base", "wheel", xyz=(-0.15, 0.225, 0.0), rpy=FORWARD, axis="0 0 1")
    passes(centre_at, scene(BASE, WHEEL, joined), **CENTRE)


# --- frame_at ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("axis", "offset"), list(product(range(3), OFFSETS)))
def test_a_frame_has_a_tolerance_along_each_axis(axis: int, offset: tuple[float, bool]) -> None:
    """Each coordinate may be off by the tolerance, inclusive; beyond it the message says which and how far."""
    off, fine = offset
    xyz = [0.15, 0.0, 0.225]
    xyz[axis] += off
    outcome = ask(frame_at, mounted((xyz[0], xyz[1], xyz[2])), **FRAME)
    assert (outcome.status == "passed") == fine
    assert outcome.measured == pytest.approx(tuple(xyz))
    assert outcome.expected == (0.15, 0.0, 0.225)
    if not fine:
        side = "large" if off > 0 else "small"
        assert outcome.message.endswith(
            f" m in 'base'; it should be at 0.15 0 0.225 m ({'xyz'[axis]} 2.1 mm too {side})"
        )


def test_a_frame_without_an_origin_points_to_its_joint() -> None:
    """If no origin is given, the failure points to the joint."""
    found = scene(BASE, LIDAR, joint("j", "fixed", "base", "lidar"))
    message = fails(frame_at, found, at="<joint", **FRAME)
    assert message.endswith("it should be at 0.15 0 0.225 m (x 150 mm too small, z 225 mm too small)")


def test_an_origin_without_xyz_points_to_its_tag() -> None:
    """If an origin has no xyz, the failure points to the whole origin."""
    fails(frame_at, scene(BASE, LIDAR, joint("j", "fixed", "base", "lidar", rpy="0 0 1")), at="<origin rpy", **FRAME)


def test_the_offset_of_a_visual_does_not_move_the_frame() -> None:
    """The visual is correct but the frame is not: that is what the check is for."""
    found = scene(BASE, link("lidar", visual(cylinder(), xyz="0.15 0 0.225")), joint("j", "fixed", "base", "lidar"))
    fails(frame_at, found, **FRAME)
    passes(stands_on, found, **ON)


def test_frames_are_measured_in_the_named_frame() -> None:
    """If the other frame is turned and moved, the point is given in it, also from child to parent."""
    found = mounted((1.0, 2.0, 3.0), turned(yaw=90))
    passes(frame_at, found, link="lidar", relative_to="base", xyz=(1.0, 2.0, 3.0), tolerance=1e-9)
    passes(frame_at, found, link="base", relative_to="lidar", xyz=(-2.0, 1.0, -3.0), tolerance=1e-9)
    passes(frame_at, found, link="base", relative_to="base", xyz=(0.0, 0.0, 0.0), tolerance=0.0)


def test_a_misplaced_root_points_to_its_link() -> None:
    """The root's frame has no parent joint: the failure points to its link."""
    arguments: Arguments = {"link": "base", "relative_to": "lidar", "xyz": (0.0, 0.0, 0.0), "tolerance": 0.002}
    fails(frame_at, mounted(), at='<link name="base"', **arguments)


positions = st.tuples(*[st.floats(-1.0, 1.0, width=16)] * 3)
angles = st.tuples(*[st.floats(-4.0, 4.0, width=16)] * 3)


@examples(10)
@given(steps=st.lists(st.tuples(positions, angles), min_size=1, max_size=4), moves=st.booleans())
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


# --- centre_at --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("axis", "offset"), list(product(range(3), OFFSETS)))
def test_a_centre_has_a_tolerance_along_each_axis(axis: int, offset: tuple[float, bool]) -> None:
    """Each coordinate may be off by the tolerance, inclusive, whichever origin it comes from."""
    off, fine = offset
    xyz = [-0.15, 0.225, 0.0]
    xyz[axis] += off
    by_joint = rolling(xyz=(xyz[0], xyz[1], xyz[2]))
    shifted = link("wheel", visual(cylinder(), xyz=(xyz[0] + 0.15, xyz[1] - 0.225, xyz[2])))
    by_visual = scene(BASE, shifted, joint("j", "continuous", "base", "wheel", xyz="-0.15 0.225 0"))
    for found in (by_joint, by_visual):
        outcome = ask(centre_at, found, **CENTRE)
        assert (outcome.status == "passed") == fine
        assert outcome.measured == pytest.approx(tuple(xyz))
        assert fine or f"{'xyz'[axis]} 2.1 mm too {'large' if off > 0 else 'small'}" in outcome.message


@pytest.mark.parametrize(
    ("joint_xyz", "visual_xyz", "rpy"),
    [
        ("-0.15 0.2 0", "0 0 0.025", "-1.57 0 0"),
        ("-0.15 0.225 0", "", "-1.57 0 0"),
        ("-0.15 0.25 0", "0 0 -0.025", "-1.5708 0 0"),
        ("-0.15 0.2 0", "0 0 -0.025", "1.57 0 0"),
        ("-0.15 0.2 0", "0 0.025 0", ""),
        ("0 0 0", "-0.15 0.225 0", ""),
    ],
)
def test_joint_and_visual_place_the_centre_together(joint_xyz: str, visual_xyz: str, rpy: str) -> None:
    """It does not matter how the path to the centre is split between the two origins."""
    wheel = link("wheel", visual(cylinder(), xyz=visual_xyz))
    found = scene(BASE, wheel, joint("j", "continuous", "base", "wheel", xyz=joint_xyz, rpy=rpy))
    assert passes(centre_at, found, **CENTRE) == "the centre of the visual of 'wheel' is at -0.15 0.225 0 m in 'base'"


def test_a_wrong_centre_points_to_what_moved_it() -> None:
    """The failure points to the visual's origin if that moves the shape, else to the joint's origin, else to the joint."""
    moved = link("wheel", visual(cylinder(), xyz="0 0 -0.025"))
    joined = joint("j", "continuous", "base", "wheel", xyz="-0.15 0.2 0", rpy=FORWARD)
    fails(centre_at, scene(BASE, moved, joined), at='xyz="0 0 -0.025"', **CENTRE)
    unmoved = link("wheel", visual(cylinder(), xyz="0 0 0"))
    fails(centre_at, scene(BASE, unmoved, joined), at='xyz="-0.15 0.2 0"', **CENTRE)
    fails(centre_at, scene(BASE, WHEEL, joint("j", "fixed", "base", "wheel")), at="<joint", **CENTRE)


def test_a_centre_in_the_frame_of_its_own_link_points_to_the_visual() -> None:
    """No joint moves a visual in the frame of its link, so the failure never points to one."""
    joined, own = (
        joint("j", "fixed", "base", "wheel", xyz="1 2 3"),
        {**CENTRE, "relative_to": "wheel", "xyz": (0.0, 0.0, 0.1)},
    )
    for visuals, at in ((visual(cylinder(), xyz="0 0 0"), 'xyz="0 0 0"'), (visual(cylinder()), "<visual")):
        fails(centre_at, scene(link("base"), link("wheel", visuals), joined), at=at, **own)


def test_a_wrong_centre_points_along_its_error() -> None:
    """A visual moved perpendicular to the error is not the cause; the failure points to the joint's origin."""
    moved = link("wheel", visual(cylinder(), xyz="0 0 0.025"))
    for xyz in ("-0.1 0.2 0", "-0.15 0.2 0.1"):
        joined = joint("j", "continuous", "base", "wheel", xyz=xyz, rpy=FORWARD)
        fails(centre_at, scene(BASE, moved, joined), at=f'xyz="{xyz}"', **CENTRE)
    unturned = joint("j", "continuous", "base", "wheel", xyz="-0.15 0.225 0")
    fails(centre_at, scene(BASE, moved, unturned), at='xyz="0 0 0.025"', **CENTRE)


def test_the_centre_of_the_expected_shape_counts() -> None:
    """If the rubric names a shape, a larger shape of another kind beside the wheel does not move the centre."""
    wheel, fender = visual(cylinder()), visual(box(0.5, 0.5, 0.5), xyz="0 0 1")
    for order in ((wheel, fender), (fender, wheel)):
        found = scene(BASE, link("wheel", *order), joint("j", "continuous", "base", "wheel", xyz="-0.15 0.225 0"))
        passes(centre_at, found, **CENTRE, shape="cylinder")
        for shape in ("any", "box", "sphere"):
            message = fails(centre_at, found, at='xyz="0 0 1"', **CENTRE, shape=shape)
            assert message.endswith(" (z 1000 mm too large)")
    with_mesh = link("wheel", visual(mesh()), wheel)
    found = scene(BASE, with_mesh, joint("j", "continuous", "base", "wheel", xyz="-0.15 0.225 0"))
    passes(centre_at, found, **CENTRE, shape="cylinder")
    assert graded(centre_at, found, **CENTRE).status == "pending"


def test_a_rigid_link_has_no_moving_joint_above_it() -> None:
    """With `rigid` a link must also be fixed; the position alone is not enough."""
    loose = rolling()
    message = fails(centre_at, loose, at='type="continuous"', **CENTRE, rigid=True)
    assert message == "a joint between 'base' and 'wheel' is continuous; it should be fixed (joint 'wheel_joint')"
    passes(centre_at, loose, **CENTRE, rigid=False)
    passes(centre_at, rolling(kind="fixed"), **CENTRE, rigid=True)


def test_a_rigid_link_has_no_moving_parent() -> None:
    """A caster fixed to a wheel turns with it: the parent in the caster's joint is wrong, not the wheel's type."""
    on_wheel = joint("caster_joint", "fixed", "wheel", "caster")
    found = Scene(rolling().text.replace("</robot>", f"{CASTER}\n{on_wheel}\n</robot>"))
    arguments: Arguments = {**CENTRE, "link": "caster", "rigid": True}
    message = fails(centre_at, found, at='link="wheel"/>\n<child link="caster"', **arguments)
    assert (
        message
        == "'caster' is a child of 'wheel', which moves: a joint above it is continuous; it should be fixed (joint 'wheel_joint')"
    )
    passes(centre_at, found, **{**arguments, "rigid": False})


def test_the_centre_of_the_largest_visual_counts() -> None:
    """A hub or a marker beside the wheel does not move its centre."""
    hub = visual(cylinder(0.01, 0.02), xyz="0 0 0.5")
    for order in ((hub, visual(cylinder())), (visual(cylinder()), hub)):
        found = scene(BASE, link("wheel", *order), joint("j", "continuous", "base", "wheel", xyz="-0.15 0.225 0"))
        passes(centre_at, found, **CENTRE)


# --- bottom_at_height, bottoms_at_height ------------------------------------------------------------------------------


def test_positions_do_not_depend_on_the_wheel_angle() -> None:
    """A check measures the given configuration: turning a wheel leaves its centre where it is."""
    robot = rolling().robot
    turned_robot = Configuration(robot.robot, {"wheel_joint": pi / 3})
    assert centre_at(turned_robot, **CENTRE).status == "passed"
