"""Motion when a joint is turned: rolling forward, the frame's axes, turning without wobble."""

from math import cos, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.motion import axis_along, rolls_forward, turns_about_itself
from tests.checks.cases import BASE, FORWARD, WHEEL, rolling
from tests.checks.outcomes import AnyCheck, Arguments, ask, fails, graded, missing, passes
from tests.checks.robots import Scene, box, cylinder, joint, link, mesh, scene, sphere, turned, visual
from tests.examples import examples

FORWARDS: Arguments = {"link": "wheel", "base": "base", "tolerance": 1.0}
ALONG: Arguments = {
    "link": "wheel",
    "axis": (0.0, 0.0, 1.0),
    "relative_to": "base",
    "direction": (0.0, 1.0, 0.0),
    "tolerance": 1.0,
}
ITSELF: Arguments = {"link": "wheel", "base": "base", "tolerance": 0.002, "angle": 1.0}

ROLLS = "a small positive turn of 'wheel' drives 'base' forward"
JOINT = " (joint 'wheel_joint')"


def with_wheel(*visuals: str, kind: str = "continuous", rpy: str = FORWARD, axis: str = "0 0 1") -> Scene:
    """Return a base with a wheel that shows these visuals."""
    return scene(
        BASE,
        link("wheel", *visuals),
        joint("wheel_joint", kind, "base", "wheel", xyz="-0.15 0.225 0", rpy=rpy, axis=axis),
    )


# --- rolls_forward ----------------------------------------------------------------------------------------------------


STEERED = scene(
    BASE,
    link("fork"),
    WHEEL,
    joint("steering", "revolute", "base", "fork", xyz="-0.15 0.225 0", axis="0 0 1"),
    joint("wheel_joint", "continuous", "fork", "wheel", rpy=FORWARD, axis="0 0 1"),
)
ON_AXLE = scene(
    BASE,
    link("axle"),
    WHEEL,
    joint("wheel_joint", "continuous", "base", "axle", xyz="-0.15 0.225 0", rpy=FORWARD, axis="0 0 1"),
    joint("mount", "fixed", "axle", "wheel", xyz="0 0 0.01"),
)
MIMIC = '<mimic joint="other" multiplier="-1"/>'
MIMICKING = scene(
    BASE,
    WHEEL,
    link("x"),
    joint("wheel_joint", "continuous", "base", "wheel", rpy=FORWARD, axis="0 0 1", more=MIMIC),
    joint("other", "continuous", "base", "x", axis="0 0 1"),
)
HUB, FENDER = visual(box(0.01, 0.01, 0.01), xyz="0.05 0 0"), visual(box(0.3, 0.3, 0.3))
BALL = visual(sphere(0.1))
# However the frame is turned, a wheel drives forward if its axis points to the base's left.
DRIVING = {
    "hand-made": with_wheel(BALL, rpy="-1.57 0 0", axis="0 0 1"),
    "negated twice": with_wheel(BALL, rpy="1.57 0 0", axis="0 0 -1"),
    "long axis": with_wheel(BALL, rpy="-1.5708 0 0", axis="0 0 5"),
    "not turned": with_wheel(BALL, rpy="", axis="0 1 0"),
    "turned round": with_wheel(BALL, rpy="0 0 3.14159", axis="0 -1 0"),
    "a quarter": with_wheel(BALL, rpy="0 0 1.5708", axis="1 0 0"),
    "about its axis": with_wheel(BALL, rpy="0 1 0", axis="0 1 0"),
    "tilted up": rolling(rpy=turned(roll=-80)),  # a cambered wheel rolls straight
    "tilted down": rolling(rpy=turned(roll=-100)),
    "hub first": with_wheel(HUB, visual(cylinder())),  # the lowest of several visuals touches the ground
    "hub last": with_wheel(visual(cylinder()), HUB),
    "mimic": MIMICKING,  # a mimic joint is turned itself, whatever it follows
    # These turn about their own axes, too.
    "revolute": rolling(kind="revolute"),  # the limits of a joint are graded by another criterion
    "steered": STEERED,  # of several moving joints the one nearest to the wheel counts
    "on an axle": ON_AXLE,
}


@pytest.mark.parametrize("name", DRIVING)
def test_an_axis_to_the_left_drives_forward(name: str) -> None:
    """The joint nearest to the wheel is turned, wherever it is, and nothing else of the robot matters."""
    assert passes(rolls_forward, DRIVING[name], **FORWARDS).startswith(ROLLS)
    if name in ("revolute", "steered", "on an axle"):
        assert passes(rolls_forward, DRIVING[name], **FORWARDS) == ROLLS + JOINT
        passes(turns_about_itself, DRIVING[name], **ITSELF)


@pytest.mark.parametrize(
    ("rpy", "axis", "at"),
    [
        (turned(roll=90), "0 0 1", "rpy="),
        (FORWARD, "0 0 -1", 'xyz="0 0 -1"'),
        ("", "0 -1 0", 'xyz="0 -1 0"'),
        (turned(yaw=180), "0 1 0", 'xyz="0 1 0"'),
    ],
    ids=["mirrored", "negated", "negated-unturned", "turned-round"],
)
def test_a_reversed_wheel_drives_backward(rpy: str, axis: str, at: str) -> None:
    """A mirrored frame or a negated axis reverses the wheel, and the failure points to it."""
    found = with_wheel(visual(sphere(0.1)), rpy=rpy, axis=axis)
    message = fails(rolls_forward, found, at=at, **FORWARDS)
    assert (
        message
        == "a small positive turn of 'wheel' drives 'base' backward; it should drive it forward (joint 'wheel_joint')"
    )
    assert ask(rolls_forward, found, **FORWARDS).measured == pytest.approx((-1.0, 0.0, 0.0))
    assert ask(rolls_forward, found, **FORWARDS).expected == (1.0, 0.0, 0.0)


def test_a_wheel_along_x_drives_sideways() -> None:
    """A wheel whose axis lies along the base's x axis rolls sideways."""
    for pitch, y in ((90, "-1"), (-90, "1")):
        message = fails(rolls_forward, rolling(rpy=turned(pitch=pitch)), at="rpy=", **FORWARDS)
        assert message == (
            f"a small positive turn of 'wheel' drives 'base' sideways, along 0 {y} 0; it should drive it forward (joint 'wheel_joint')"
        )


def test_a_wheel_that_lies_flat_does_not_roll() -> None:
    """A wheel that turns about the vertical, or about its contact, stays; with swapped links it is reversed."""
    flat = rolling(rpy="")
    message = fails(rolls_forward, flat, at='xyz="0 0 1"', **FORWARDS)
    assert message == "'wheel' does not roll when its joint turns: its lowest point does not move (joint 'wheel_joint')"
    assert ask(rolls_forward, flat, **FORWARDS).measured is None
    assert "does not roll" in fails(rolls_forward, with_wheel(BALL, rpy="", axis="0 0 1"), **FORWARDS)
    swapped = scene(BASE, WHEEL, joint("wheel_joint", "continuous", "wheel", "base", rpy=turned(roll=90), axis="0 1 0"))
    assert "backward" in fails(rolls_forward, swapped, **FORWARDS)


@pytest.mark.parametrize(
    ("yaw", "words"),
    [
        (10.0, f"{ROLLS}, 10 degrees off straight ahead; it should drive it forward"),
        (-44.0, f"{ROLLS}, 44 degrees off straight ahead; it should drive it forward"),
        (46.0, "sideways, along 0.6947 0.7193 0; it should drive it forward"),
        (134.0, "sideways, along -0.6947 0.7193 0; it should drive it forward"),
        (136.0, "backward; it should drive it forward"),
    ],
)
def test_headings_are_described_in_words(yaw: float, words: str) -> None:
    """Up to 45 degrees is forward with a deviation, from 135 backward, and between them sideways with the direction."""
    assert fails(rolls_forward, rolling(rpy=turned(roll=-90, yaw=yaw)), **FORWARDS).endswith(words + JOINT)


def test_a_small_deviation_is_reported_though_it_passes() -> None:
    """A deviation that is visible in the file is reported; rounded angles are not."""
    assert (
        passes(rolls_forward, rolling(rpy="-1.57 0 0.01"), **FORWARDS)
        == f"{ROLLS}, 0.573 degrees off straight ahead{JOINT}"
    )
    assert passes(rolls_forward, rolling(rpy="-1.57 0 0"), **FORWARDS) == ROLLS + JOINT


def test_forward_and_up_are_arguments() -> None:
    """Another lab may drive along y, or on a wall; directions need not be unit vectors."""
    sideways = rolling(rpy=turned(pitch=-90))
    passes(rolls_forward, sideways, **FORWARDS, forward=(0.0, 3.0, 0.0))
    passes(rolls_forward, sideways, **FORWARDS, forward=(0.0, 1.0, 0.0), up=(0.0, 0.0, 0.1))
    flat = rolling(rpy="")
    passes(rolls_forward, flat, **FORWARDS, up=(0.0, 1.0, 0.0), forward=(-1.0, 0.0, 0.0))
    fails(rolls_forward, flat, **FORWARDS, up=(0.0, -1.0, 0.0), forward=(-1.0, 0.0, 0.0))


def test_a_wheel_without_an_axis_points_to_its_joint() -> None:
    """ROS 2 uses x if no axis is given; the failure points to the joint."""
    found = scene(BASE, WHEEL, joint("wheel_joint", "continuous", "base", "wheel", rpy=FORWARD))
    message = fails(rolls_forward, found, at="<joint", **FORWARDS)
    assert "sideways" in message or "does not roll" in message


@pytest.mark.parametrize("kind", ["fixed", "rotary", "", "wheel"])
def test_a_wheel_without_a_moving_joint_misses_one(kind: str) -> None:
    """Fixed joints and unknown types move nothing, so the moving joint is missing."""
    for check, arguments in ((rolls_forward, FORWARDS), (turns_about_itself, ITSELF)):
        error = missing(check, rolling(kind=kind), **arguments)
        assert (error.kind, error.name) == ("moving joint", "wheel")
        assert (
            fails(check, rolling(kind=kind), at="<joint", **arguments)
            == "no joint between 'base' and 'wheel' turns; one should be continuous or revolute"
        )


def test_a_link_does_not_move_relative_to_itself() -> None:
    """If base and wheel are one link, there is no joint between them."""
    assert missing(rolls_forward, rolling(), **{**FORWARDS, "link": "base"}).kind == "moving joint"


@pytest.mark.parametrize("kind", ["planar", "floating", "prismatic"])
def test_a_joint_of_another_kind_is_the_students_fault(kind: str) -> None:
    """A prismatic or floating joint is no error of the grader: it fails, or misses a joint that turns."""
    for check, arguments in ((rolls_forward, FORWARDS), (turns_about_itself, ITSELF)):
        assert graded(check, rolling(kind=kind), **arguments).status in ("passed", "failed")
    assert graded(rolls_forward, rolling(kind=kind), **FORWARDS).status == "failed"


@pytest.mark.parametrize(
    ("found", "reason", "at"),
    [
        (rolling(axis="0 0 0"), "the joint's axis is 0 0 0", 'xyz="0 0 0"'),
        (rolling(axis="0 1"), "the joint's axis cannot be read", 'xyz="0 1"'),
        (rolling(xyz="1 2"), "the joint's origin cannot be read", '<origin xyz="1 2"'),
    ],
    ids=["zero-axis", "unreadable-axis", "unreadable-origin"],
)
def test_a_joint_without_a_pose_cannot_roll(found: Scene, reason: str, at: str) -> None:
    """If the joint's pose is undefined, that is the missing thing, with its reason."""
    error = missing(rolls_forward, found, **FORWARDS)
    assert (error.kind, error.name) == ("pose below joint", "wheel_joint")
    assert fails(rolls_forward, found, at=at, **FORWARDS) == f"the pose is undefined: {reason} (joint 'wheel_joint')"


@examples(10)
@given(yaw=st.floats(-180.0, 180.0), spin=st.floats(-4.0, 4.0), radius=st.floats(0.01, 2.0))
def test_a_wheel_drives_where_its_axis_says(yaw: float, spin: float, radius: float) -> None:
    """For every heading, size and initial turn of the wheel, it drives perpendicular to its axis, seen from above."""
    found = scene(
        BASE,
        link("wheel", visual(cylinder(radius, 0.05), rpy=(0.0, 0.0, spin))),
        joint("wheel_joint", "continuous", "base", "wheel", rpy=turned(roll=-90, yaw=yaw), axis="0 0 1"),
    )
    outcome = ask(rolls_forward, found, **FORWARDS)
    assert outcome.measured == pytest.approx((cos(radians(yaw)), sin(radians(yaw)), 0.0), abs=1e-6)
    if abs(abs(yaw) - 1.0) > 1e-6:
        assert (outcome.status == "passed") == (abs(yaw) < 1.0)


# --- axis_along -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("angle", ["roll", "yaw"])
def test_an_axis_has_a_tolerance(angle: str) -> None:
    """An axis may be off by the tolerance, inclusive; beyond it the message says by how much."""
    for off, fine in ((0.0, True), (0.99, True), (1.0, True), (-1.0, True), (1.01, False), (-1.01, False)):
        rpy = turned(roll=-90 + off) if angle == "roll" else turned(roll=-90, yaw=off)
        outcome = ask(axis_along, rolling(rpy=rpy), **ALONG)
        assert (outcome.status == "passed") == fine, off
        assert outcome.expected == (0.0, 1.0, 0.0)
    message = fails(axis_along, rolling(rpy=turned(roll=-80)), at="rpy=", **ALONG)
    assert message == (
        "the z axis of the frame 'wheel' points along 0 0.9848 0.1736 in 'base'; it should point along 0 1 0 (10 degrees off)"
    )


MAST = scene(
    BASE,
    WHEEL,
    link("mast"),
    joint("m", "fixed", "base", "mast", rpy=turned(yaw=90)),
    joint("j", "continuous", "base", "wheel", rpy=FORWARD),
)


@pytest.mark.parametrize(
    ("found", "arguments", "name"),
    [
        (rolling(), {"axis": (1.0, 0.0, 0.0), "direction": (1.0, 0.0, 0.0)}, "the x axis"),
        (rolling(), {"axis": (0.0, 1.0, 0.0), "direction": (0.0, 0.0, -1.0)}, "the y axis"),
        (rolling(), {}, "the z axis"),
        (rolling(), {"axis": (0.0, 0.0, -2.0), "direction": (0.0, -9.0, 0.0)}, "the direction 0 0 -2"),
        (rolling(), {"axis": (1.0, 0.0, 1.0), "direction": (1.0, 1.0, 0.0)}, "the direction 1 0 1"),
        (rolling(axis="0 0 -1"), {}, "the z axis"),
        (with_wheel(visual(cylinder(), rpy="1 2 3"), axis="1 0 0"), {}, "the z axis"),
        (MAST, {"relative_to": "mast", "direction": (1.0, 0.0, 0.0)}, "the z axis"),
    ],
    ids=["x", "y", "z", "negative", "diagonal", "joint-axis", "visual", "other-frame"],
)
def test_any_axis_of_a_frame_can_be_checked(found: Scene, arguments: Arguments, name: str) -> None:
    """Axes and directions of any length, in any frame, whatever the joint turns about and however the visual lies."""
    assert passes(axis_along, found, **{**ALONG, **arguments}).startswith(f"{name} of the frame 'wheel' points along ")


def test_a_frame_that_is_not_turned_has_a_location() -> None:
    """Without an rpy the failure points to the origin, without an origin to the link."""
    message = fails(axis_along, rolling(rpy=""), at='<origin xyz="-0.15 0.225 0.0"', **ALONG)
    assert message.endswith("points along 0 0 1 in 'base'; it should point along 0 1 0 (90 degrees off)")
    bare = scene(BASE, WHEEL, joint("wheel_joint", "continuous", "base", "wheel"))
    fails(axis_along, bare, at='<link name="wheel"', **ALONG)


@examples(10)
@given(off=st.floats(0.0, 180.0), about=st.floats(0.0, 360.0))
def test_the_angle_between_axes_is_exact(off: float, about: float) -> None:
    """However small or large, the measured angle is the one by which the frame was turned."""
    tilt = rolling(rpy=(0.0, radians(off), radians(about)))
    outcome = ask(axis_along, tilt, **{**ALONG, "direction": (0.0, 0.0, 1.0), "tolerance": off + 1e-6})
    assert outcome.status == "passed"
    outcome = ask(axis_along, tilt, **{**ALONG, "direction": (0.0, 0.0, 1.0), "tolerance": off - 1e-6})
    assert outcome.status == "failed"


# --- turns_about_itself -----------------------------------------------------------------------------------------------


def test_a_cylinder_may_be_moved_along_its_axis() -> None:
    """The position of the wheel on the axis and the sign of the axis do not matter."""
    for xyz in ("0 0 0.025", "0 0 -0.5", "0 0 0"):
        for axis in ("0 0 1", "0 0 -1", "0 0 3"):
            passes(turns_about_itself, with_wheel(visual(cylinder(), xyz=xyz), axis=axis), **ITSELF)


@pytest.mark.parametrize(
    ("axis", "rpy"),
    [("0 1 0", "1.5708 0 0"), ("0 1 0", "-1.5708 0 0"), ("1 0 0", "0 1.5708 0"), ("0 0 1", "3.1416 0 0")],
)
def test_the_visual_may_be_turned_instead_of_the_frame(axis: str, rpy: str) -> None:
    """Axis and cylinder must agree, wherever the turn is written."""
    passes(turns_about_itself, with_wheel(visual(cylinder(), rpy=rpy), rpy="", axis=axis), **ITSELF)


@pytest.mark.parametrize(
    ("off", "fine"), [(0.0019, True), (0.002, True), (-0.002, True), (0.0021, False), (-0.0021, False)]
)
@pytest.mark.parametrize("axis", ["x", "y"])
def test_an_eccentric_axle_has_a_tolerance(axis: str, off: float, fine: bool) -> None:
    """The axis may be off the cylinder's by the tolerance, inclusive; beyond it the message gives the distance."""
    xyz = f"{off!r} 0 0.025" if axis == "x" else f"0 {off!r} 0.025"
    found = with_wheel(visual(cylinder(), xyz=xyz))
    outcome = ask(turns_about_itself, found, **ITSELF)
    assert (outcome.status == "passed") == fine
    assert (outcome.tolerance, outcome.unit) == (0.002, "m")
    assert outcome.measured == pytest.approx(abs(off))
    if not fine:
        assert outcome.message == (
            "'wheel' turns off centre: its joint axis is 2.1 mm from the cylinder's axis; it should be on it (joint 'wheel_joint')"
        )
        assert outcome.location == found.location_of(f'xyz="{xyz}"')


def test_a_wheel_without_a_cylinder_has_no_axis() -> None:
    """Boxes, spheres and meshes have no axis: a cylinder is missing, as for the criterion of the shape."""
    for shape in (box(0.2, 0.2, 0.05), sphere(0.1), mesh()):
        found = rolling().with_shape(shape)
        error = missing(turns_about_itself, found, **ITSELF)
        assert (error.kind, error.name) == ("cylinder", "wheel")
        assert graded(turns_about_itself, found, **ITSELF).status == "failed"


def test_the_largest_cylinder_is_the_wheel() -> None:
    """Of several cylinders the largest is the wheel, not the hub; a fender larger than the wheel is no cylinder."""
    hub, wheel = visual(cylinder(0.01, 0.1)), visual(cylinder(), xyz="0.05 0 0")
    for order in ((hub, wheel), (wheel, hub)):
        message = fails(turns_about_itself, with_wheel(*order), at='xyz="0.05', **ITSELF)
        assert "50 mm from the cylinder's axis" in message
    passes(turns_about_itself, with_wheel(visual(cylinder()), FENDER), **ITSELF)


@examples(10)
@given(
    rpy=st.tuples(*[st.floats(-4.0, 4.0, width=16)] * 3),
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
    outcome = ask(turns_about_itself, scene(BASE, link("wheel", visual(cylinder(), xyz=xyz)), joined), **ITSELF)
    assert outcome.measured == pytest.approx(beside, abs=1e-9)
    assert (outcome.status == "passed") == (beside <= 0.002)


@examples(10)
@given(tilt=st.floats(0.0, 180.0))
def test_a_wobble_is_at_most_a_right_angle(tilt: float) -> None:
    """An axis has no sign: turned by 179 degrees it is one degree off."""
    found = with_wheel(visual(cylinder(), rpy=(radians(tilt), 0.0, 0.0)))
    outcome = ask(turns_about_itself, found, **{**ITSELF, "angle": 0.0})
    if min(tilt, 180.0 - tilt) > 1e-6:
        assert outcome.measured == pytest.approx(min(tilt, 180.0 - tilt), abs=1e-6)


# --- any_type ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("check", "arguments"), [(rolls_forward, FORWARDS), (turns_about_itself, ITSELF)])
def test_the_type_can_be_left_out(check: AnyCheck, arguments: Arguments) -> None:
    """With `any_type` a joint of a misspelt type turns about its axis; without it nothing turns."""
    typo, wrong = rolling(kind="rotary"), rolling(kind="rotary", axis="1 0 0")
    assert missing(check, typo, **arguments).kind == "moving joint"
    assert ask(check, typo, **arguments, any_type=True).status == "passed"
    assert ask(check, wrong, **arguments, any_type=True).status == "failed"
    assert ask(check, rolling(), **arguments, any_type=True) == ask(check, rolling(), **arguments)
