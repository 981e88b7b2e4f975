"""Poses of links: each kind of joint, mimics, several roots, limited effects of defects, loops, size."""

import sys
from collections.abc import Sequence
from contextlib import suppress
from math import hypot, inf, isfinite
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import MissingElement
from grader.base.transforms import (
    IDENTITY,
    Transform,
    Vector,
    rotation_about,
    rotation_from_rpy,
    unit,
)
from grader.ros.urdf.joint_reader import MOVING_TYPES
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint, Link, Mimic, Origin, Robot
from grader.ros.urdf.reader import read_urdf
from tests.examples import examples
from tests.work import limited_work

Z: Vector = (0.0, 0.0, 1.0)

angles = st.floats(-7, 7)
lengths = st.floats(-10, 10)
vectors = st.tuples(lengths, lengths, lengths)
origins = st.builds(Origin, vectors, st.tuples(angles, angles, angles))
axes = vectors.filter(lambda axis: hypot(*axis) > 1e-6)
scales = st.floats(-150, 150).map(lambda exponent: 10.0**exponent)


def joint(ends: str, kind: str = "fixed", **more: Any) -> Joint:
    """Return a joint between two links of one letter each, named by these letters."""
    return Joint(ends, kind, ends[0], ends[1], **more)


def robot(*joints: Joint, alone: str = "") -> Robot:
    """Return a robot of these joints, with the links that they name in this order, and others."""
    names = dict.fromkeys(
        [*(end for joint in joints for end in (joint.parent, joint.child)), *alone]
    )
    return Robot("r", tuple(Link(name) for name in names if name), joints)


def at(*xyz: float) -> Origin:
    """Return an origin without a rotation."""
    x, y, z = xyz
    return Origin((x, y, z))


def transform(origin: Origin) -> Transform:
    """Return T_parent_child of an origin."""
    return Transform(rotation_from_rpy(origin.rpy), origin.xyz)


def scaled(axis: Vector, scale: float) -> Vector:
    """Return an axis of another length: KDL normalises it."""
    return (axis[0] * scale, axis[1] * scale, axis[2] * scale)


def motion(joint: Joint, position: float) -> Transform:
    """Return the motion that a joint adds to its origin: a turn, a slide, or none."""
    x, y, z = unit(joint.axis or Z) or Z
    match joint.type:
        case "continuous" | "revolute":
            return Transform(rotation_about((x, y, z), position))
        case "prismatic":
            return Transform(translation=(x * position, y * position, z * position))
    return IDENTITY


def near(one: Transform, other: Transform, within: float = 1e-9) -> bool:
    """Return whether two poses are equal up to rounding."""
    return bool(np.allclose(np.array(one), np.array(other), rtol=0, atol=within))


# --- Joints -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["fixed", *MOVING_TYPES, "Fixed", ""])
def test_every_joint_at_zero_is_at_its_origin(kind: str) -> None:
    """At 0 a joint of any type, known or not, adds nothing."""
    origin = Origin((1.0, 2.0, 3.0), (0.1, 0.2, 0.3))
    assert Configuration(robot(joint("ab", kind, origin=origin, axis=Z))).pose("b") == transform(
        origin
    )


@pytest.mark.parametrize("kind", ["fixed", "", "Continuous", "planar", "floating"])
def test_positions_of_joints_that_cannot_move_are_refused(kind: str) -> None:
    """Also those of planar and floating joints, which ROS 2 does not move; the message names the joint."""
    with pytest.raises(ValueError, match="joint 'ab'"):
        Configuration(robot(joint("ab", kind)), {"ab": 1.0})
    with pytest.raises(ValueError, match="joint 'ab'"):
        Configuration(robot(joint("ab", kind))).moved("ab", 1.0)


def test_positions_of_unknown_joints_are_refused() -> None:
    """The error lists the existing joints."""
    with pytest.raises(MissingElement, match=r"'ba'.*'ab'"):
        Configuration(robot(joint("ab")), {"ba": 1.0})


def test_moved_changes_one_joint() -> None:
    """The other positions stay, and so does the original configuration, whose poses are not reused."""
    still = Configuration(robot(joint("ab", "prismatic"), joint("bc", "prismatic")), {"ab": 1.0})
    assert still.pose("c", relative_to="b") == IDENTITY
    moved = still.moved("bc", 2.0)
    assert moved.pose("c").translation == (3.0, 0.0, 0.0)
    assert moved.pose("c", relative_to="b").translation == (2.0, 0.0, 0.0)
    assert still.pose("c").translation == (1.0, 0.0, 0.0)
    assert moved.moved("ab", 0.0).pose("c").translation == (2.0, 0.0, 0.0)
    with pytest.raises(MissingElement):
        still.moved("cd", 1.0)


# --- Mimics -----------------------------------------------------------------------------------------------------------


@given(multiplier=lengths, offset=lengths, second=lengths, start=lengths)
def test_mimics_follow_through_a_chain(
    multiplier: float, offset: float, second: float, start: float
) -> None:
    """A mimic of a mimic follows both rules, whatever the order in the file."""
    following = robot(
        joint("ad", "prismatic", mimic=Mimic("ac", second, -1.0)),
        joint("ac", "prismatic", mimic=Mimic("ab", multiplier, offset)),
        joint("ab", "prismatic"),
    )
    configuration = Configuration(following, {"ab": start})
    middle = multiplier * start + offset
    assert configuration.pose("c").translation[0] == pytest.approx(middle, abs=1e-9)
    assert configuration.pose("d").translation[0] == pytest.approx(second * middle - 1.0, abs=1e-9)
    assert Configuration(following).pose("c").translation[0] == pytest.approx(offset, abs=1e-12)


def test_a_mimic_that_is_moved_directly_does_not_follow() -> None:
    """Its own position counts, and joints that mimic it follow it."""
    following = robot(
        joint("ab", "prismatic"),
        joint("ac", "prismatic", mimic=Mimic("ab", 2.0)),
        joint("ad", "prismatic", mimic=Mimic("ac", 3.0)),
    )
    configuration = Configuration(following, {"ab": 1.0, "ac": 5.0})
    assert [configuration.pose(name).translation[0] for name in "bcd"] == [1.0, 5.0, 15.0]
    assert Configuration(following, {"ab": 1.0}).moved("ac", 0.0).pose("d").translation[0] == 0.0


@pytest.mark.parametrize("length", [1, 2, 3, 500])
def test_cyclic_mimics_stay_at_zero(length: int) -> None:
    """Joints that mimic each other stay at 0, and so does a joint that mimics them."""
    circle = [
        Joint(
            f"j{index}",
            "prismatic",
            "a",
            f"b{index}",
            mimic=Mimic(f"j{(index + 1) % length}", 2.0, 1.0),
        )
        for index in range(length)
    ]
    names = ("a", *(joint.child for joint in circle))
    configuration = Configuration(Robot("r", tuple(map(Link, names)), tuple(circle)))
    assert all(configuration.pose(joint.child) == IDENTITY for joint in circle)


def test_a_cycle_of_mimics_is_opened_by_a_position() -> None:
    """If one of them is moved, the others follow."""
    circle = robot(
        joint("ab", "prismatic", mimic=Mimic("ac", 2.0)),
        joint("ac", "prismatic", mimic=Mimic("ab", 3.0, 1.0)),
    )
    configuration = Configuration(circle, {"ab": 1.0})
    assert [configuration.pose(name).translation[0] for name in "bc"] == [1.0, 4.0]


def test_a_mimic_of_a_missing_joint_is_at_its_offset() -> None:
    """Nothing moves it; only the offset remains."""
    configuration = Configuration(robot(joint("ab", "prismatic", mimic=Mimic("nothing", 2.0, 0.5))))
    assert configuration.pose("b").translation == (0.5, 0.0, 0.0)


# --- Trees ------------------------------------------------------------------------------------------------------------


@st.composite
def trees(draw: st.DrawFn) -> Robot:
    """Draw robots of 1 to 15 links under one root, joints of all types, with axes of any length, in random order."""
    count = draw(st.integers(1, 15))
    joints = [
        Joint(
            f"j{child}",
            draw(
                st.sampled_from(
                    ("fixed", "continuous", "revolute", "prismatic", "planar", "floating")
                )
            ),
            f"l{draw(st.integers(0, child - 1))}",
            f"l{child}",
            draw(origins),
            draw(st.builds(scaled, axes, scales)),
        )
        for child in range(1, count)
    ]
    links = draw(st.permutations([Link(f"l{index}") for index in range(count)]))
    return Robot("r", tuple(links), tuple(draw(st.permutations(joints))))


@pytest.mark.slow
@given(tree=trees(), draw=st.data())
def test_poses_are_products_along_the_tree(tree: Robot, draw: st.DataObject) -> None:
    """A child's pose is its parent's times the joint's origin times the joint's motion, in any order of the queries."""
    positions = {joint.name: draw.draw(angles) for joint in tree.joints if joint.has_position}
    configuration = Configuration(tree, positions)
    assert configuration.roots == ("l0",)
    assert configuration.pose("l0") == IDENTITY
    for joint in draw.draw(st.permutations(tree.joints)):
        assert joint.origin is not None
        step = transform(joint.origin) @ motion(joint, positions.get(joint.name, 0.0))
        expected = configuration.pose(joint.parent) @ step
        assert near(configuration.pose(joint.child), expected, within=1e-8)
        assert configuration.find_root(joint.child) == "l0"


@pytest.mark.slow
@given(tree=trees(), draw=st.data())
def test_relative_poses_are_consistent(tree: Robot, draw: st.DataObject) -> None:
    """T_b_c is the inverse of T_a_b times T_a_c, T_b_a undoes T_a_b, and a link in its own frame is at the identity."""
    links = st.sampled_from([link.name for link in tree.links])
    configuration = Configuration(tree)
    a, b, c = draw.draw(links), draw.draw(links), draw.draw(links)
    T_a_b, T_a_c = configuration.pose(b, relative_to=a), configuration.pose(c, relative_to=a)
    assert near(configuration.pose(c, relative_to=b), T_a_b.inverse() @ T_a_c, within=1e-8)
    assert near(configuration.pose(a, relative_to=b) @ T_a_b, IDENTITY, within=1e-8)
    assert configuration.pose(a, relative_to=a) == IDENTITY
    assert near(configuration.pose(b), configuration.pose(b, relative_to="l0"), within=0)


@given(tree=trees(), draw=st.data())
def test_paths_between_links(tree: Robot, draw: st.DataObject) -> None:
    """The path leads up to the common ancestor and down again; no joint twice; backwards it is the same path."""
    links = st.sampled_from([link.name for link in tree.links])
    configuration = Configuration(tree)
    one, other = draw.draw(links), draw.draw(links)
    way = configuration.between(one, other)
    assert len(set(way)) == len(way)
    assert configuration.between(other, one) == way[::-1]
    current = one
    for step in way:
        assert current in (step.parent, step.child)
        current = step.child if current == step.parent else step.parent
    assert current == other


@given(tree=trees(), draw=st.data())
def test_chains_lead_down(tree: Robot, draw: st.DataObject) -> None:
    """From the root, or from a link above, to the link; None from a link that is not above."""
    links = st.sampled_from([link.name for link in tree.links])
    configuration = Configuration(tree)
    link, above = draw.draw(links), draw.draw(links)
    chain = configuration.chain(link)
    assert chain is not None
    passed = ["l0", *(joint.child for joint in chain)]
    assert [joint.parent for joint in chain] == passed[:-1]
    assert passed[-1] == link
    part = configuration.chain(link, above=above)
    assert part == (chain[passed.index(above) :] if above in passed else None)


def test_missing_links_and_joints() -> None:
    """Unknown links and joints raise MissingElement, which lists existing ones or a suggestion."""
    configuration = Configuration(robot(joint("ab")))
    for ask in (
        lambda: configuration.pose("x"),
        lambda: configuration.pose("b", relative_to="x"),
        lambda: configuration.chain("x"),
        lambda: configuration.chain("b", above="x"),
        lambda: configuration.between("a", "x"),
        lambda: configuration.between("x", "a"),
        lambda: configuration.find_root("x"),
        lambda: configuration.link("x"),
        lambda: configuration.joint("x"),
        lambda: configuration.axis("x"),
    ):
        with pytest.raises(
            MissingElement, match=r"no (link|joint) 'x'; the file has: '(a', 'b|ab)'$"
        ):
            ask()


def test_axes_are_unit() -> None:
    """The axis of a joint in its child's frame has length 1; a zero or unreadable one has no direction."""
    named = robot(
        joint("ab", "continuous", axis=(0.0, -3.0, 4.0)),
        joint("ac", "continuous", axis=(0.0, 0.0, 0.0)),
        joint("ad", "continuous", axis=None),
    )
    configuration = Configuration(named)
    assert configuration.axis("ab") == pytest.approx((0.0, -0.6, 0.8))
    with pytest.raises(
        MissingElement, match=r"is undefined: the joint's axis is 0 0 0 .joint 'ac'"
    ):
        configuration.axis("ac")
    with pytest.raises(
        MissingElement, match=r"is undefined: the joint's axis cannot be read .joint 'ad'"
    ):
        configuration.axis("ad")


# --- Defects, each of which stays where it is -------------------------------------------------------------------------


def test_several_roots_are_solved_separately() -> None:
    """Each root's tree has its poses; between two trees there is no pose, and the message names both links."""
    forest = robot(joint("ab", origin=at(1, 0, 0)), joint("cd", origin=at(0, 1, 0)), alone="e")
    configuration = Configuration(forest)
    assert configuration.roots == ("a", "c", "e")
    assert configuration.pose("b").translation == (1.0, 0.0, 0.0)
    assert configuration.pose("d").translation == (0.0, 1.0, 0.0)
    assert configuration.pose("e") == IDENTITY
    for one, other in (("b", "d"), ("a", "e"), ("c", "b")):
        with pytest.raises(
            MissingElement, match=f"'{one}' is not connected to '{other}'"
        ) as caught:
            configuration.pose(one, relative_to=other)
        assert caught.value.kind == "connection"
        with pytest.raises(MissingElement):
            configuration.between(one, other)


def test_an_unreadable_origin_begins_a_frame_group() -> None:
    """Below it poses are known relative to each other; other links are not affected."""
    broken = robot(
        joint("ab", origin=at(1, 0, 0)),
        joint("bc", origin=None),
        joint("cd", origin=at(0, 0, 1)),
        joint("ce", origin=at(0, 0, 2)),
    )
    configuration = Configuration(broken)
    assert configuration.pose("b").translation == (1.0, 0.0, 0.0)
    assert configuration.pose("e", relative_to="d").translation == (0.0, 0.0, 1.0)
    assert configuration.pose("d", relative_to="c").translation == (0.0, 0.0, 1.0)
    for one, other in (("c", None), ("d", None), ("d", "b"), ("a", "e")):
        with pytest.raises(
            MissingElement, match=r"is undefined: the joint's origin cannot be read .joint 'bc'"
        ):
            configuration.pose(one, relative_to=other)
    assert configuration.find_root("e") == "a"
    assert [joint.name for joint in configuration.between("e", "a")] == ["ce", "bc", "ab"]


def test_two_frame_groups_name_a_joint_between_them() -> None:
    """Between two frame groups the message names one of the joints with an unreadable origin."""
    broken = robot(
        joint("ab", origin=None), joint("ac", origin=None), joint("cd", origin=at(1, 0, 0))
    )
    with pytest.raises(
        MissingElement, match=r"is undefined: the joint's origin cannot be read .joint '(ab|ac)'"
    ):
        Configuration(broken).pose("b", relative_to="d")


@pytest.mark.parametrize("kind", ["continuous", "revolute", "prismatic", "planar"])
@pytest.mark.parametrize("position", [None, 0.0, 0.5])
def test_a_zero_axis_hides_what_is_below_it(kind: str, position: float | None) -> None:
    """At any position, 0 included, as KDL divides by the axis' length; links elsewhere have their poses."""
    broken = robot(
        joint("ab", kind, origin=at(1, 0, 0), axis=(0.0, 0.0, 0.0)),
        joint("bc"),
        joint("ad", origin=at(0, 1, 0)),
    )
    configuration = Configuration(
        broken, {"ab": position} if position is not None and kind != "planar" else {}
    )
    for link in "bc":
        with pytest.raises(
            MissingElement, match=r"is undefined: the joint's axis is 0 0 0 .joint 'ab'"
        ):
            configuration.pose(link)
    assert configuration.pose("c", relative_to="b") == IDENTITY
    assert configuration.pose("d").translation == (0.0, 1.0, 0.0)


@pytest.mark.parametrize("kind", ["fixed", "floating", "unknown"])
def test_a_zero_axis_does_not_matter_if_none_is_used(kind: str) -> None:
    """Fixed and floating joints have no axis."""
    assert Configuration(robot(joint("ab", kind, axis=(0.0, 0.0, 0.0)))).pose("b") == IDENTITY


@pytest.mark.parametrize("names", [("j1", "j2"), ("j2", "j1"), ("J2", "j1"), ("a", "é")])
def test_of_two_parent_joints_the_last_by_name_counts(names: tuple[str, str]) -> None:
    """Whatever the order in the file, the joint whose name sorts last counts, as in urdfdom's map of joints."""
    joints = [Joint(name, "fixed", "a", "b", at(index, 0, 0)) for index, name in enumerate(names)]
    for order in (joints, joints[::-1]):
        configuration = Configuration(robot(*order))
        assert configuration.parent_joints["b"].name == max(names)
        assert configuration.pose("b").translation[0] == names.index(max(names))


@pytest.mark.parametrize("ring", ["a", "ab", "abcdefgh"])
def test_links_on_a_loop_have_no_pose(ring: str) -> None:
    """Loops, and links below them, raise MissingElement and terminate; other trees are not affected."""
    loop = [joint(f"{one}{other}") for one, other in zip(ring, ring[1:] + ring[0], strict=True)]
    configuration = Configuration(
        robot(*loop, joint(f"{ring[0]}y"), joint("yz"), joint("uv", origin=at(1, 0, 0)))
    )
    for link in (*ring, "y", "z"):
        with pytest.raises(MissingElement, match=f"'{link}' is on or below a loop of joints"):
            configuration.pose(link)
        with pytest.raises(MissingElement):
            configuration.pose(link, relative_to="v")
        with pytest.raises(MissingElement):
            configuration.find_root(link)
        with pytest.raises(MissingElement):
            configuration.between(link, "v")
        assert configuration.chain(link, above="v") is None
        configuration.chain(link)
    assert configuration.pose("v").translation == (1.0, 0.0, 0.0)
    assert configuration.roots == ("u",)


def test_a_joint_without_links_is_no_parent_joint() -> None:
    """A joint whose parent or child does not exist, or is not given, is ignored."""
    robot_with_gaps = Robot(
        "r",
        (Link("a"), Link("b"), Link("")),
        (
            Joint("j1", "fixed", "a", "x"),
            Joint("j2", "fixed", "x", "b"),
            Joint("j3", "fixed", "", "a"),
            joint("ab"),
        ),
    )
    configuration = Configuration(robot_with_gaps)
    assert configuration.roots == ("a", "")
    assert configuration.pose("b") == IDENTITY


# --- Size and extremes ------------------------------------------------------------------------------------------------


def chain_of(count: int) -> bytes:
    """Return a URDF of so many links in a chain, each 1 mm along x of the last and turned a little."""
    links = "".join(f'<link name="l{index}"/>\n' for index in range(count))
    joints = "".join(
        f'<joint name="j{index}" type="continuous"><parent link="l{index}"/><child link="l{index + 1}"/>'
        f'<origin xyz="0.001 0 0"/><axis xyz="1 0 0"/></joint>\n'
        for index in range(count - 1)
    )
    return f'<robot name="chain">{links}{joints}</robot>'.encode()


@pytest.mark.exhaustive
def test_a_chain_of_20000_links() -> None:
    """It is read and solved in linear time, and without recursion, whose depth Python limits."""
    assert sys.getrecursionlimit() < 20_000
    data = chain_of(20_000)
    with limited_work(30_000_000):
        read = read_urdf(data)
        assert read.verdict == "clean"
        assert read.robot is not None
        configuration = Configuration(read.robot, {"j7": 0.5})
        last = configuration.pose("l19999")
        assert last.translation == pytest.approx((19.999, 0.0, 0.0), abs=1e-9)
        assert last.rotation == pytest.approx(rotation_about((1.0, 0.0, 0.0), 0.5), abs=1e-9)
        assert configuration.pose("l0", relative_to="l19999").translation[0] == pytest.approx(
            -19.999, abs=1e-9
        )
        assert len(configuration.between("l19999", "l1")) == 19_998


def ask_all(links: int, joints: list[Joint]) -> None:
    """Compute the pose of every link, ignoring missing ones."""
    configuration = Configuration(
        Robot("r", tuple(Link(f"l{index}") for index in range(links)), tuple(joints))
    )
    for index in range(links):
        with suppress(MissingElement):
            configuration.pose(f"l{index}")


@pytest.mark.slow
def test_links_on_a_long_loop_are_refused_in_linear_time() -> None:
    """Computing the poses of 6,000 links on a loop does not walk the loop 6,000 times."""
    count = 6000
    joints = [
        Joint(f"j{index}", "fixed", f"l{index}", f"l{(index + 1) % count}")
        for index in range(count)
    ]
    with limited_work(2_000_000):
        ask_all(count, joints)


@pytest.mark.slow
def test_links_below_a_defect_are_refused_in_linear_time() -> None:
    """Computing the poses of 6,000 links below a zero axis does not walk up to it 6,000 times."""
    count = 6000
    joints = [
        Joint(f"j{index}", "fixed", f"l{index}", f"l{index + 1}") for index in range(1, count - 1)
    ]
    joints.append(Joint("j0", "continuous", "l0", "l1", axis=(0.0, 0.0, 0.0)))
    with limited_work(3_000_000):
        ask_all(count, joints)


def assert_finite_or_missing(configuration: Configuration) -> None:
    """Assert that every pose, from the root and between any two links, is finite or missing."""
    names: Sequence[str] = [link.name for link in configuration.robot.links]
    for link in names:
        for relative_to in (None, *names):
            try:
                pose = configuration.pose(link, relative_to=relative_to)
            except MissingElement:
                continue
            assert all(isfinite(number) for number in (*pose.rotation, *pose.translation)), (
                link,
                relative_to,
            )


huge = st.sampled_from((1.7e308, -1.7e308, 1e308, 1e300, 1e154, 1.0, 0.0, -1e-300)) | st.floats(
    allow_nan=False, allow_infinity=False
)
huge_vectors = st.tuples(huge, huge, huge)


@examples(20)
@given(
    xyz=st.lists(huge_vectors, min_size=3, max_size=3),
    rpy=st.lists(huge_vectors, min_size=3, max_size=3),
    axis=huge_vectors,
    kind=st.sampled_from(("fixed", "continuous", "prismatic")),
    position=huge,
)
def test_huge_numbers_never_give_nan(
    xyz: list[Vector], rpy: list[Vector], axis: Vector, kind: str, position: float
) -> None:
    """A pose is finite or missing; the link beside the huge ones keeps its own."""
    extreme = robot(
        joint("ab", origin=Origin(xyz[0], rpy[0])),
        joint("bc", kind, origin=Origin(xyz[1], rpy[1]), axis=axis),
        joint("ad", origin=Origin(xyz[2], rpy[2])),
        joint("ae", origin=at(1, 2, 3)),
    )
    configuration = Configuration(extreme, {"bc": position} if kind != "fixed" else {})
    assert_finite_or_missing(configuration)
    assert configuration.pose("e").translation == (1.0, 2.0, 3.0)


@given(
    multipliers=st.lists(huge, min_size=2, max_size=2),
    offsets=st.lists(huge, min_size=2, max_size=2),
    start=huge,
)
def test_huge_mimics_never_give_nan(
    multipliers: list[float], offsets: list[float], start: float
) -> None:
    """If a mimic overflows, the pose is missing like any other undefined pose."""
    following = robot(
        joint("ab", "continuous", axis=Z),
        joint("ac", "continuous", axis=Z, mimic=Mimic("ab", multipliers[0], offsets[0])),
        joint("ad", "continuous", axis=Z, mimic=Mimic("ac", multipliers[1], offsets[1])),
        joint("ae", "prismatic", axis=Z, mimic=Mimic("ac", multipliers[1], offsets[1])),
    )
    assert_finite_or_missing(Configuration(following))
    assert_finite_or_missing(Configuration(following, {"ab": start}))


@pytest.mark.parametrize("position", [inf, -inf, float("nan")])
@pytest.mark.parametrize("kind", ["continuous", "prismatic"])
def test_positions_that_are_not_finite(kind: str, position: float) -> None:
    """An infinite or undefined position is refused, at once or when the pose is computed."""
    moving = robot(joint("ab", kind, axis=Z))
    with pytest.raises((ValueError, MissingElement)):
        Configuration(moving, {"ab": position}).pose("b")
