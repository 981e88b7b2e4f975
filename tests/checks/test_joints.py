"""The joint that moves a link: limits, axis, mimic, dynamics; whatever is fixed below it, and however it is written."""

from math import radians
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.joints import joint_axis, joint_dynamics, joint_limits
from grader.checks.mimics import mimics
from grader.errors import MissingElement, NotDecided
from grader.robot.kinematics import Configuration
from grader.robot.transforms import Transform, Vector, rotation_from_rpy
from grader.source import LazyLocation
from grader.submission.opening import read_submission
from grader.submission.urdf import Read
from tests.checks.cases import CASE, gripping, swinging
from tests.checks.outcomes import Arguments, ask, fails, graded, missing, passes
from tests.checks.robots import Scene, joint, link, numbers, scene
from tests.examples import examples

LIMITS: Arguments = {"link": "tip", "lower": -90.0, "upper": 45.0, "tolerance": 0.5}
AXIS: Arguments = {"link": "tip", "relative_to": "base", "direction": (0.0, 1.0, 0.0), "tolerance": 1.0}
THROUGH: Arguments = {**AXIS, "through": (0.1, -3.0, 0.2)}
MIMIC: Arguments = {"link": "right", "leader": "left"}
JOINT = " (joint 'shoulder')"
RANGE = "the range of the joint that moves 'tip' is"

every_check = pytest.mark.parametrize("name", ["joint_limits", "joint_axis", "mimics", "joint_dynamics"])


def limited(limit: str, kind: str = "revolute") -> Scene:
    """Return an arm whose joint has a <limit> with these attributes."""
    return swinging(kind=kind, limit=f'{limit} effort="10" velocity="2"')


# --- The joint that moves a link --------------------------------------------------------------------------------------


@every_check
def test_the_joint_is_found_from_every_link_that_is_fixed_below_it(name: str) -> None:
    """The last joint that is not fixed counts, whatever the joints are called."""
    case = CASE[name]
    renamed = Scene(case.passing.text.replace("shoulder", "j1").replace("_joint", "_axis"))
    more = scene(link("far"), joint("far_joint", "fixed", case.arguments["link"], "far", xyz="1 2 3", rpy="1 2 3"))
    below = Scene(renamed.text.replace("</robot>", more.text.partition("\n")[2]))
    assert ask(case.check, below, **{**case.arguments, "link": "far"}).status == "passed"


@every_check
def test_a_joint_above_does_not_count(name: str) -> None:
    """Only the last joint that moves the link is examined: a link that is fixed to the root has none."""
    case = CASE[name]
    error = missing(
        case.check,
        Scene(case.passing.text.replace("revolute", "fixed").replace("prismatic", "fixed")),
        **case.arguments,
    )
    assert (error.kind, error.name) == ("moving joint", case.arguments["link"])
    assert "no joint above" in str(error)


@every_check
def test_a_type_that_does_not_exist(name: str) -> None:
    """ROS 2 rejects the file: the joint is missing, and its type is quoted."""
    case = CASE[name]
    error = missing(
        case.check,
        Scene(case.passing.text.replace("revolute", "hinge").replace("prismatic", "hinge")),
        **case.arguments,
    )
    assert (error.kind, error.name) == ("moving joint", case.arguments["link"])
    assert "has the type 'hinge', which does not exist" in str(error)


# --- joint_limits -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "limit",
    ['lower="-1.5708" upper="0.7854"', 'upper="0.785398163" lower="-1.570796327"', 'lower=" -157e-2" upper=".785"'],
)
def test_limits_are_compared_in_degrees(limit: str) -> None:
    """However the numbers are written; effort and velocity are not checked unless the rubric gives them."""
    assert passes(joint_limits, limited(limit), **LIMITS).startswith(RANGE)


def test_limits_of_a_sliding_joint_are_compared_in_metres() -> None:
    """The tolerance is in metres, too."""
    wanted: Arguments = {"link": "tip", "lower": 0.0, "upper": 0.1, "tolerance": 0.002}
    assert passes(joint_limits, limited('upper="0.1"', "prismatic"), **wanted) == f"{RANGE} 0 to 0.1 m"
    wrong = fails(joint_limits, limited('lower="0" upper="0.103"', "prismatic"), at="upper=", **wanted)
    assert wrong == f"{RANGE} 0 to 0.103 m; it should be 0 to 0.1 m{JOINT}"


@pytest.mark.parametrize(
    ("limit", "at", "shown"),
    [
        ('lower="-90" upper="45"', "lower=", "-5156.6 to 2578.3"),
        ('lower="0.7854" upper="-1.5708"', "lower=", "45 to -90"),
        ('lower="-1.5708" upper="-0.7854"', "upper=", "-90 to -45"),
        ('upper="0.7854"', "<limit", "0 to 45"),
        ('lower="-1.5708" upper="1e308"', "upper=", "-90 to inf"),
    ],
)
def test_wrong_limits(limit: str, at: str, shown: str) -> None:
    """The message has the measured and the expected range, and the attribute that is wrong is the place to look at."""
    wrong = fails(joint_limits, limited(limit), at=at, **LIMITS)
    assert wrong == f"{RANGE} {shown} degrees; it should be -90 to 45 degrees{JOINT}"


@pytest.mark.parametrize("kind", ["continuous", "planar", "floating"])
def test_a_joint_without_limits(kind: str) -> None:
    """A joint of another type has no limits, even if it has a <limit>."""
    unlimited = swinging(kind=kind, more='<limit lower="-1.5708" upper="0.7854" effort="1" velocity="1"/>')
    message = f"the joint that moves 'tip' is {kind}, so it has no limits; they should be -90 to 45{JOINT}"
    assert fails(joint_limits, unlimited, at=f'type="{kind}"', **LIMITS) == message


def test_a_missing_limit() -> None:
    """ROS 2 rejects the file; the check says what is missing. A failure names the reader's note on degrees."""
    message = f"the joint that moves 'tip' has no limits; it should be -90 to 45 degrees{JOINT}"
    assert fails(joint_limits, swinging(limit=""), at='<joint name="shoulder"', **LIMITS) == message
    outcome = graded(joint_limits, limited('lower="-90" upper="45"'), **LIMITS)
    assert "(URDF079: lower is in radians, and -90 is more than a full turn: is it in degrees?)" in outcome.message


@pytest.mark.parametrize(("name", "value"), [("effort", 10.0), ("velocity", 2.0)])
def test_effort_and_velocity_are_exact(name: str, value: float) -> None:
    """They may be off by 1e-6, whatever the tolerance of the range."""
    for off, status in ((9e-7, "passed"), (-9e-7, "passed"), (2e-6, "failed"), (-2e-6, "failed")):
        assert ask(joint_limits, swinging(), **LIMITS, **{name: value + off}).status == status


def test_a_number_that_cannot_be_read_fails_alone() -> None:
    """A limit without effort is rejected by ROS 2; its range is still compared, and only a check of the effort fails."""
    rejected = swinging(limit='lower="-1.5708" upper="0.7854" velocity="fast"')
    assert ask(joint_limits, rejected, **LIMITS).status == "passed"
    outcome = graded(joint_limits, rejected, **LIMITS, effort=10.0)
    assert (outcome.status, outcome.measured) == ("failed", None)
    assert "its effort is missing or unreadable; it should be 10" in outcome.message
    assert graded(joint_limits, rejected, **LIMITS, velocity=2.0).status == "failed"


# --- joint_axis -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("rpy", "axis"),
    [
        ("", "0 1 0"),
        ("", "0 5e-3 0"),
        ("", "0 1e200 0"),
        ("0 1.3 0", "0 1 0"),
        ("3.14159 0 0", "0 -1 0"),
        ("0 0 1.5708", "1 0 0"),
        ("-1.5708 0 0", "0 0 1"),
        ("1.5708 6.28319 0", "0 0 -3"),
    ],
)
def test_equivalent_axes(rpy: str, axis: str) -> None:
    """A turned frame with its axis turned back, an axis of another length, a frame turned about the axis."""
    passes(joint_axis, swinging(rpy=rpy, axis=axis), **THROUGH)


@pytest.mark.parametrize("kind", ["revolute", "continuous", "prismatic", "planar"])
def test_every_type_with_an_axis(kind: str) -> None:
    """The type does not matter; a floating joint has no axis."""
    passes(joint_axis, swinging(kind=kind), **THROUGH)
    message = f"the joint that moves 'tip' is floating, so it has no axis{JOINT}"
    assert fails(joint_axis, swinging(kind="floating"), at='type="floating"', **AXIS) == message


def test_the_other_way() -> None:
    """The opposite direction is wrong, unless the rubric allows it."""
    wrong = fails(joint_axis, swinging(axis="0 -1 0"), at='xyz="0 -1 0"', **AXIS)
    assert "points along 0 -1 0 in 'base'; it should point along 0 1 0 (180 degrees off)" in wrong
    passes(joint_axis, swinging(axis="0 -1 0"), **AXIS, either_way=True)
    assert ask(joint_axis, swinging(axis="1 0 0"), **AXIS, either_way=True).status == "failed"


def test_the_place_of_a_turned_frame() -> None:
    """If the axis is z of a frame that is turned, its rpy is the place to look at; without an <axis> the joint is."""
    fails(joint_axis, swinging(rpy="1.57 0 0", axis="0 0 1"), at='rpy="1.57 0 0"', **AXIS)
    assert "points along 1 0 0" in fails(joint_axis, swinging(axis=""), at='<joint name="shoulder"', **AXIS)


def test_axes_without_a_direction_or_far_away() -> None:
    """An axis of length zero is missing; absurd distances are neither a crash nor within a distance."""
    error = missing(joint_axis, swinging(axis="0 0 0"), **AXIS)
    assert (error.kind, str(error)) == ("pose below joint", f"the pose is undefined: the joint's axis is 0 0 0{JOINT}")
    assert graded(joint_axis, swinging(xyz="1e300 0 1e300"), **THROUGH).status == "failed"


@pytest.mark.parametrize("along", [-3.0, 0.0, 0.5])
def test_where_on_the_axis_the_frame_is(along: float) -> None:
    """It does not matter; beside the axis it does."""
    passes(joint_axis, swinging(xyz=(0.1, along, 0.2)), **THROUGH)
    beside = swinging(xyz=(0.1, along, 0.25))
    wrong = fails(joint_axis, beside, at="xyz=" + f'"{numbers((0.1, along, 0.25))}"', **THROUGH)
    assert wrong.endswith(f"and passes 50 mm from 0.1 -3 0.2 m; it should pass through that point{JOINT}")
    passes(joint_axis, beside, **AXIS)
    passes(joint_axis, beside, **THROUGH, distance=0.06)


def two_joints() -> Scene:
    """Return an arm of two joints: the second axis is horizontal, and turns with the first joint."""
    return scene(
        link("base"),
        link("upper"),
        link("lower"),
        joint("yaw", "continuous", "base", "upper", axis="0 0 1"),
        joint("pitch", "continuous", "upper", "lower", xyz="1 0 0", axis="0 1 0"),
    )


def test_the_axis_is_measured_in_the_pose_of_the_robot() -> None:
    """Joints above turn the axis and move it; the joint itself does not."""
    robot = two_joints().robot.robot
    turned_robot = Configuration(robot, {"yaw": radians(90), "pitch": 1.0})
    wanted: Arguments = {"link": "lower", "relative_to": "base", "tolerance": 0.1}
    assert joint_axis(turned_robot, **wanted, direction=(-1.0, 0.0, 0.0), through=(7.0, 1.0, 0.0)).status == "passed"
    assert (
        joint_axis(Configuration(robot), **wanted, direction=(0.0, 1.0, 0.0), through=(1.0, 7.0, 0.0)).status
        == "passed"
    )
    seen = joint_axis(
        turned_robot, **{**wanted, "relative_to": "lower"}, direction=(0.0, 1.0, 0.0), through=(0.0, 0.0, 0.0)
    )
    assert seen.status == "passed"


_angles = st.floats(-4, 4)
_lengths = st.floats(-2, 2)
_directions = st.tuples(_lengths, _lengths, _lengths).filter(lambda axis: sum(map(abs, axis)) > 0.1)


@examples(10)
@given(
    rpy=st.tuples(_angles, _angles, _angles),
    inner=st.tuples(_angles, _angles, _angles),
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
    arguments: dict[str, Any] = {**THROUGH, "direction": wanted, "tolerance": 40.0, "distance": 1.0}
    before = ask(joint_axis, swinging(xyz=frame.translation, rpy=frame.rpy, axis=axis), **arguments)
    after = ask(joint_axis, swinging(xyz=along, rpy=moved[0].rpy, axis=(x, y, z)), **arguments)
    assert (before.status, before.unit) == (after.status, after.unit)
    assert before.measured == pytest.approx(after.measured, abs=1e-6)


# --- mimics -----------------------------------------------------------------------------------------------------------

LEFT = 'joint="left_joint"'


@pytest.mark.parametrize(
    ("kind", "limit", "wanted", "message"),
    [
        ("revolute", 'upper="0.3"', (0.0, 0.3, 0.002),
         "is revolute; it should be prismatic, with a range of 0 to 0.3 m"),
        ("prismatic", 'lower="-1.5708" upper="0.7854"', (-90.0, 45.0, 1.0),
         "is prismatic; it should be revolute, with a range of -90 to 45 degrees"),
        ("revolute", 'upper="0.4"', (0.0, 0.3, 0.002), "range of the joint that moves 'tip' is 0 to 22.918 degrees"),
        ("revolute", 'lower="-90" upper="45"', (-90.0, 45.0, 1.0), "is -5156.6 to 2578.3 degrees; it should be -90 to"),
    ],
)  # fmt: skip
def test_a_joint_of_the_wrong_type(kind: str, limit: str, wanted: tuple[float, float, float], message: str) -> None:
    """If the limits are the expected ones in the other unit, and not degrees in place of radians, the message names the type."""
    lower, upper, tolerance = wanted
    found = limited(limit, kind)
    at = f'type="{kind}"' if "should be" in message and "range of " in message else None
    outcome = fails(joint_limits, found, at=at, link="tip", lower=lower, upper=upper, tolerance=tolerance)
    assert message in outcome


def test_what_is_absent_in_the_rubric_is_not_checked() -> None:
    """Multiplier and offset count only if they are given; the file's defaults are 1 and 0."""
    passes(mimics, gripping(LEFT, 'multiplier="7" offset="3"'), **MIMIC)
    passes(mimics, gripping(LEFT), **MIMIC, multiplier=1.0, offset=0.0)
    wrong = fails(mimics, gripping(LEFT, 'offset="0.2"'), at="offset=", **MIMIC, multiplier=1.0, offset=0.1)
    assert wrong.endswith("; its offset is 0.2; it should be 0.1 (joint 'right_joint')")


def test_the_default_tolerance_is_tight() -> None:
    """1e-6, in the values of the file."""
    for off, status in ((9e-7, "passed"), (2e-6, "failed")):
        assert ask(mimics, gripping(LEFT), **MIMIC, multiplier=1.0 + off).status == status


def hand(*rules: tuple[str, str, str, str]) -> Scene:
    """Return a palm with fingers named by letters; each rule is a finger, its leader, its multiplier and its offset."""
    leaders = {
        finger: f'<mimic joint="{leader}" multiplier="{by}" offset="{off}"/>' for finger, leader, by, off in rules
    }
    fingers = [
        joint(f"j{name}", "prismatic", "palm", name, axis="0 1 0", more=leaders.get(name, "")) for name in "abcd"
    ]
    return scene(link("palm"), *map(link, "abcd"), *fingers)


CHAIN = (("b", "ja", "2", "0.1"), ("c", "jb", "-3", "0.5"), ("d", "jc", "0.5", "1"))


@pytest.mark.parametrize(
    ("link", "leader", "multiplier", "offset"),
    [("b", "a", 2.0, 0.1), ("c", "a", -6.0, 0.2), ("c", "b", -3.0, 0.5), ("d", "a", -3.0, 1.1), ("d", "b", -1.5, 1.25)],
)
def test_chains_of_mimics_are_composed(link: str, leader: str, multiplier: float, offset: float) -> None:
    """The position of the follower is that of forward kinematics."""
    chained = hand(*CHAIN)
    passes(mimics, chained, link=link, leader=leader, multiplier=multiplier, offset=offset)
    assert ask(mimics, chained, link=link, leader=leader, multiplier=multiplier + 0.01).status == "failed"
    assert ask(mimics, chained, link=link, leader=leader, offset=offset - 0.01).status == "failed"
    posed = Configuration(chained.robot.robot, {"ja": 0.7} if leader == "a" else {"jb": 0.7})
    y = posed.pose(link, relative_to="palm").translation[1]
    assert y == pytest.approx(multiplier * 0.7 + offset)


MISSING = "the joint that moves 'right' mimics a joint that does not exist"
NOT = "the joint that moves 'right' does not mimic the joint that moves 'left'"


@pytest.mark.parametrize(
    ("mimic", "message", "at"),
    [
        ((), f"{NOT} (joint 'right_joint')", '<joint name="right_joint"'),
        (
            ('joint="right_jiont"',),
            f"{MISSING} (joint 'right_joint' mimics 'right_jiont', not 'left_joint'); did you mean 'right_joint'?",
            'joint="right_jiont"',
        ),
        (
            ('joint="right_joint"',),
            "the joint that moves 'right' mimics itself, directly or through others (joint 'right_joint')",
            'joint="right_joint"',
        ),
    ],
)
def test_a_joint_that_does_not_mimic(mimic: tuple[str, ...], message: str, at: str) -> None:
    """No mimic, a joint that does not exist, itself."""
    assert fails(mimics, gripping(*mimic), at=at, **MIMIC) == message


def test_the_wrong_leader_and_the_wrong_way_round() -> None:
    """The message names the joint that is mimicked; that of the other finger mimics nothing."""
    chained = hand(*CHAIN[:2])
    wrong = fails(mimics, chained, at='joint="jb"', link="c", leader="d")
    assert wrong.endswith("(joint 'jc' mimics 'jb', not 'jd')")
    assert fails(mimics, chained, at='<joint name="ja"', link="a", leader="b").endswith("(joint 'ja')")
    assert ask(mimics, chained, link="a", leader="a").status == "failed"


def test_what_follows_nothing() -> None:
    """A loop of mimics, a joint with the name of its leader, which ROS 2 rejects, and a fixed joint move nothing."""
    error = missing(mimics, hand(("a", "jb", "1", "0"), ("b", "ja", "1", "0")), link="a", leader="b")
    assert (error.kind, "mimics itself, directly or through others" in str(error)) == ("mimicked joint", True)
    copied = Scene(gripping(LEFT).text.replace("right_joint", "left_joint"))
    assert "mimics itself" in str(missing(mimics, copied, **MIMIC))
    with pytest.raises(MissingElement, match="no joint above 'right' moves"):
        ask(mimics, gripping(LEFT, kind="fixed"), **MIMIC)


def test_multipliers_that_overflow_fail() -> None:
    """Composed numbers can become infinite or NaN."""
    huge = hand(("b", "ja", "0", "1"), ("c", "jb", "1e200", "0"), ("d", "jc", "1e200", "0"))
    infinite = graded(mimics, huge, link="d", leader="b", multiplier=1.0)
    undefined = graded(mimics, huge, link="d", leader="a", multiplier=0.0)
    assert [(found.status, found.measured) for found in (infinite, undefined)] == [("failed", None)] * 2


# --- joint_dynamics ---------------------------------------------------------------------------------------------------

DYNAMICS = "the joint that moves 'tip' has <dynamics>"
NONE = "the joint that moves 'tip' has no <dynamics>"


@pytest.mark.parametrize(
    ("written", "arguments", "message"),
    [
        ('<dynamics friction="0.5" damping="2"/>', {"friction": 0.5, "damping": 2.0}, DYNAMICS),
        ('<dynamics friction="0.5" damping="2"/>', {"friction": 0.5}, DYNAMICS),
        ('<dynamics friction="0.5"/>', {"friction": 0.5, "damping": 0.0}, DYNAMICS),
        ('<dynamics damping="2"/>', {}, DYNAMICS),
        ("", {"friction": 0.0, "damping": 0.0}, NONE),
        ("", {"friction": 1e-7}, NONE),
        ("", {"damping": 0.05, "tolerance": 0.1}, NONE),
    ],
)
def test_dynamics_that_pass(written: str, arguments: Arguments, message: str) -> None:
    """What the file does not give is 0; what the rubric does not give is not checked."""
    assert passes(joint_dynamics, swinging(more=written), link="tip", **arguments) == message


@pytest.mark.parametrize(
    ("written", "arguments", "message", "at"),
    [
        ("", {}, f"{NONE}; it should have one", '<joint name="shoulder"'),
        ("", {"friction": 0.5}, f"{NONE}; its friction is 0; it should be 0.5", '<joint name="shoulder"'),
        ("<dynamics/>", {}, f"{NONE}; it should have one", '<joint name="shoulder"'),
        ('<dynamics damping="2"/>', {"friction": 0.5}, f"{DYNAMICS}; its friction is 0; it should be 0.5", "<dynamics"),
        (
            '<dynamics damping="2" friction="1"/>',
            {"friction": 2.0, "damping": 1.0},
            f"{DYNAMICS}; its friction is 1; it should be 2; its damping is 2; it should be 1",
            "friction=",
        ),
        (
            '<dynamics damping="x" friction="1"/>',
            {"damping": 1.0},
            f"{DYNAMICS}; its damping is missing or unreadable; it should be 1",
            "damping=",
        ),
    ],
)
def test_dynamics_that_fail(written: str, arguments: Arguments, message: str, at: str) -> None:
    """Each wrong number is named, with the expected one."""
    assert fails(joint_dynamics, swinging(more=written), at=at, link="tip", **arguments) == message + JOINT


# --- Parts that xacro leaves open -------------------------------------------------------------------------------------


def expanded(written: str, by: str, robot: Scene | None = None) -> Configuration:
    """Return the arm, or another robot, in a file of xacro, in which this text is replaced."""
    text = (robot or swinging(more='<dynamics friction="0.5"/>')).text
    assert text.count(written) == 1
    xacro = text.replace(written, by).replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    urdf = read_submission(xacro.encode(), identity="ash", path="robot.urdf.xacro").urdf
    assert isinstance(urdf, Read)
    assert urdf.reading.robot is not None
    return Configuration(urdf.reading.robot, is_guarded=True)


@every_check
@pytest.mark.parametrize(
    ("written", "by"), [('type="revolute"', 'type="$(env X)"'), ('child link="arm"', 'child link="$(env X)"')]
)
def test_a_joint_that_xacro_leaves_open(name: str, written: str, by: str) -> None:
    """Where the type of a joint or its child is known only at run time, it is not known what moves the link."""
    arguments = {**CASE[name].arguments, "link": "tip"} | ({"leader": "tip"} if name == "mimics" else {})
    with pytest.raises(NotDecided, match="is known only at run time"):
        CASE[name].check(expanded(written, by), **arguments)


@pytest.mark.parametrize("mimic", ["left_joint", "right_joint2"])
def test_a_leader_whose_name_is_open(mimic: str) -> None:
    """Whether the joint that is mimicked is that of the leader is known only at run time."""
    robot = gripping(f'joint="{mimic}"')
    more = joint("right_joint2", "prismatic", "palm", "third", axis="0 1 0")
    text = Scene(robot.text.replace("</robot>", f'<link name="third"/>{more}</robot>'))
    with pytest.raises(NotDecided, match="is known only at run time"):
        mimics(expanded('joint name="left_joint"', 'joint name="$(env X)"', text), **MIMIC)


def test_what_xacro_refuses_is_missing() -> None:
    """ROS 2 gets no robot: the element is missing, at its place."""
    with pytest.raises(MissingElement, match="xacro cannot expand the limit of joint 'shoulder'") as raised:
        joint_limits(expanded('upper="0.7854"', 'upper="${top}"'), **LIMITS)
    assert isinstance(raised.value.location, LazyLocation)
    assert raised.value.location.resolve().line == 10
