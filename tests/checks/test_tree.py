"""The tree of links: whether it loads, the joints' types and names, parents and the root."""

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.counts import counts
from grader.checks.tree import held_by, joints_named, root_of_tree, urdf_loads
from grader.xml.urdf_format import JOINT_TYPES
from tests.checks.cases import BASE, FOOT, LIDAR, WHEEL, Case, cases_of, mounted
from tests.checks.outcomes import Arguments, ask, fails, graded, missing, own_message, passes
from tests.checks.robots import Scene, joint, link, mesh, scene, visual
from tests.command_line import run
from tests.examples import examples

MOVING = [kind for kind in JOINT_TYPES if kind != "fixed"]
HELD: Arguments = {"link": "wheel", "parent": "base", "joint_type": "continuous"}
FIXED: Arguments = {"link": "wheel", "parent": "base", "joint_type": "fixed"}
ROOT: Arguments = {"link": "foot", "holds": "base"}


def joined(kind: str, **more: Any) -> Scene:
    """Return a base with a wheel on one joint."""
    return scene(BASE, WHEEL, joint("j", kind, "base", "wheel", **more))


def in_line(*kinds: str) -> Scene:
    """Return a base and a wheel with joints of these types in a chain between them, named a, b, c and so on."""
    between = [f"mount{index}" for index in range(len(kinds) - 1)]
    names = ["base", *between, "wheel"]
    held_in_line = [
        joint(letter, kind, above, below)
        for letter, kind, above, below in zip("abcdef", kinds, names, names[1:], strict=False)
    ]
    return scene(BASE, WHEEL, *map(link, between), *held_in_line)


@cases_of("tree")
def test_facts_about_joints_have_no_measurement(case: Case) -> None:
    """The outcome has no tolerance and no unit, and only counts have numbers."""
    for found in (case.passing, case.failing):
        outcome = ask(case.check, found, **case.arguments)
        assert (outcome.tolerance, outcome.unit) == (None, None)
        assert (outcome.measured is None, outcome.expected is None) == (case.name != "counts",) * 2


# --- held_by ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("required", JOINT_TYPES)
@pytest.mark.parametrize("kind", JOINT_TYPES)
def test_the_type_of_the_joint_decides(kind: str, required: str) -> None:
    """Each type of joint passes for itself and for no other."""
    outcome = graded(held_by, joined(kind), link="wheel", parent="base", joint_type=required)
    assert outcome.status == ("passed" if kind == required else "failed")
    if kind == required:
        assert outcome.message == f"the {kind} joint 'j' connects 'wheel' to 'base'"
    elif kind == "fixed":
        assert own_message(outcome) == f"'wheel' cannot move: its joint is fixed; it should be {required} (joint 'j')"
    else:
        assert own_message(outcome) == f"the joint that moves 'wheel' is {kind}; it should be {required} (joint 'j')"


def test_a_wrong_type_has_a_location() -> None:
    """The failure points to the type."""
    fails(held_by, joined("revolute"), at='type="revolute"', **HELD)
    fails(held_by, joined("continuous"), at='type="continuous"', **FIXED)
    fails(held_by, joined("fixed"), at='type="fixed"', **HELD)


def test_a_link_that_cannot_move_misses_a_moving_joint() -> None:
    """Checks of motion miss the same thing, so that they are skipped instead of failing again."""
    error = missing(held_by, joined("fixed"), **HELD)
    assert (error.kind, error.name) == ("moving joint", "wheel")


@pytest.mark.parametrize(
    ("kind", "guess"),
    [("Continuous", "continuous"), ("continous", "continuous"), ("fixd", "fixed"), ("wheel", None)],
)
def test_an_unknown_type_is_quoted(kind: str, guess: str | None) -> None:
    """An unknown type is quoted, with a suggestion."""
    for arguments in (HELD, FIXED):
        message = fails(held_by, joined(kind), at=f'type="{kind}"', **arguments)
        hint = f"; did you mean {guess!r}?" if guess else ""
        assert (
            message
            == f"a joint between 'base' and 'wheel' has the type {kind!r}, which does not exist{hint} (joint 'j')"
        )


def test_a_joint_without_a_type_has_none() -> None:
    """A type that is empty or missing is reported as missing; without the attribute the failure points to the joint."""
    without = Scene(joined("fixed").text.replace(' type="fixed"', ""))
    for found, at in ((joined(""), 'type=""'), (without, "<joint")):
        for arguments in (HELD, FIXED):
            assert (
                fails(held_by, found, at=at, **arguments)
                == "a joint between 'base' and 'wheel' has no type (joint 'j')"
            )


def test_a_grade_run_does_not_repeat_a_check() -> None:
    """The problem at the same location is added only if it is the reason for the failure."""
    outcome = graded(held_by, joined("wheel"), **FIXED)
    assert (
        outcome.message == "a joint between 'base' and 'wheel' has the type 'wheel', which does not exist (joint 'j')"
    )


def test_an_unknown_type_moves_nothing() -> None:
    """A link on a joint of an unknown type misses a moving joint."""
    error = missing(held_by, joined("Continuous"), **HELD)
    assert (error.kind, error.name) == ("moving joint", "wheel")


@pytest.mark.parametrize("kinds", [("fixed", "continuous"), ("continuous", "fixed"), ("fixed", "continuous", "fixed")])
def test_fixed_joints_may_stand_between(kinds: tuple[str, ...]) -> None:
    """A mount between base and wheel changes nothing: the message names the moving joint."""
    name = "abc"[kinds.index("continuous")]
    assert passes(held_by, in_line(*kinds), **HELD) == f"the continuous joint {name!r} connects 'wheel' to 'base'"


def test_a_chain_of_fixed_joints_counts_as_fixed() -> None:
    """A chain of fixed joints holds a link; the message names the joint next to it."""
    assert (
        passes(held_by, in_line("fixed", "fixed", "fixed"), **FIXED) == "the fixed joint 'c' connects 'wheel' to 'base'"
    )


def test_a_wrong_joint_in_a_chain_is_named() -> None:
    """In a chain the moving joint is the wrong one, whatever its position."""
    message = fails(held_by, in_line("revolute", "fixed"), at='type="revolute"', **HELD)
    assert message == "the joint that moves 'wheel' is revolute; it should be continuous (joint 'a')"


@pytest.mark.parametrize("kinds", [("continuous", "continuous"), ("revolute", "fixed", "continuous")])
def test_several_moving_joints_are_one_too_many(kinds: tuple[str, ...]) -> None:
    """A wheel that can also be steered is not on one continuous joint."""
    last = "abc"[len(kinds) - 1]
    message = fails(held_by, in_line(*kinds), **HELD)
    assert message == f"several joints move 'wheel'; there should be one continuous joint (joints 'a' and {last!r})"
    assert ask(held_by, in_line(*kinds), **FIXED).status == "failed"


def test_an_unknown_type_in_a_chain_moves_nothing() -> None:
    """A joint of an unknown type beside a moving one is not named as the one that moves the link."""
    message = fails(held_by, in_line("continuous", "Fixed"), **HELD)
    assert "several joints move" not in message
    assert "'Fixed'" in message


def test_swapped_parent_and_child_are_reported() -> None:
    """A joint with base and wheel swapped is reported as that."""
    swapped = scene(BASE, WHEEL, joint("j", "continuous", "wheel", "base"))
    message = fails(held_by, swapped, at="<joint", **HELD)
    assert (
        message
        == "the parent and child of a joint are swapped: 'wheel' is above 'base'; it should be below (joint 'j')"
    )


def test_in_a_swapped_chain_the_joint_below_the_link_is_named() -> None:
    """Of several joints between, the failure points to the one that makes the link a parent."""
    swapped = scene(
        BASE, WHEEL, link("mount"), joint("a", "fixed", "wheel", "mount"), joint("b", "fixed", "mount", "base")
    )
    assert "should be below (joint 'a')" in fails(held_by, swapped, at='<joint name="a"', **FIXED)


def test_another_parent_is_named() -> None:
    """A link with another parent fails; the message names the parent and points to it in the joint."""
    beside = scene(BASE, LIDAR, WHEEL, joint("a", "fixed", "lidar", "base"), joint("b", "continuous", "lidar", "wheel"))
    message = fails(held_by, beside, at='link="lidar"/>\n<child link="wheel"', **HELD)
    assert message == "the parent of 'wheel' is 'lidar'; it should be 'base' (joint 'b')"


def test_a_link_below_another_one_still_counts() -> None:
    """A wheel below the lidar moves with the base too, if the lidar is fixed to it."""
    below = scene(BASE, LIDAR, WHEEL, joint("a", "fixed", "base", "lidar"), joint("b", "continuous", "lidar", "wheel"))
    passes(held_by, below, **HELD)


def test_a_link_without_a_joint_misses_its_connection() -> None:
    """Without a joint the connection is missing, not the correct type."""
    error = missing(held_by, scene(BASE, WHEEL), **HELD)
    assert (error.kind, error.name) == ("connection", "base and wheel")


def test_of_two_parent_joints_the_last_by_name_counts() -> None:
    """ROS 2 keeps the joint that is last in name order, whatever the file order, and so does the check."""
    one, two = joint("a", "fixed", "base", "wheel"), joint("b", "continuous", "base", "wheel")
    for order in ((one, two), (two, one)):
        assert "'b'" in passes(held_by, scene(BASE, WHEEL, *order), **HELD)
        assert "(joint 'b')" in fails(held_by, scene(BASE, WHEEL, *order), **FIXED)


def test_other_properties_of_a_joint_are_ignored() -> None:
    """A zero axis or an unreadable origin fails other criteria."""
    passes(held_by, joined("continuous", axis="0 0 0"), **HELD)
    passes(held_by, joined("continuous", xyz="0 0"), **HELD)
    passes(held_by, joined("continuous", more='<mimic joint="nobody"/>'), **HELD)


def test_links_on_a_loop_have_no_connection() -> None:
    """A loop of joints apart from the base does not connect a link to it."""
    loop = scene(BASE, WHEEL, LIDAR, joint("a", "fixed", "lidar", "wheel"), joint("b", "fixed", "wheel", "lidar"))
    error = missing(held_by, loop, **FIXED)
    assert error.kind == "connection"
    assert "'wheel' is on or below a loop of joints" in str(error)


@examples(10)
@given(kinds=st.lists(st.sampled_from(JOINT_TYPES), min_size=1, max_size=5), required=st.sampled_from(JOINT_TYPES))
def test_a_chain_passes_exactly_for_its_moving_joints(kinds: list[str], required: str) -> None:
    """Only the moving joints of a chain count: none for a fixed one, else one of the type."""
    moving = [kind for kind in kinds if kind != "fixed"]
    outcome = graded(held_by, in_line(*kinds), link="wheel", parent="base", joint_type=required)
    assert (outcome.status == "passed") == (moving == ([] if required == "fixed" else [required]))


# --- joints_named -----------------------------------------------------------------------------------------------------

NAMED: Arguments = {"parent": "base", "joints": {"lidar_joint": "lidar", "wheel_joint": "wheel"}}


LIDAR_NAMED: Arguments = {"parent": "base", "joints": {"lidar_joint": "lidar"}}


def named(lidar: str, wheel: str) -> Scene:
    """Return a base with lidar and wheel on joints of these names."""
    return scene(
        BASE, LIDAR, WHEEL, joint(lidar, "fixed", "base", "lidar"), joint(wheel, "continuous", "base", "wheel")
    )


def test_every_wrong_name_is_reported() -> None:
    """All wrong names are reported at once, and the failure points to the first."""
    message = fails(joints_named, named("a", "b"), at='name="a"', **NAMED)
    assert (
        message
        == "the joint of 'lidar' should be named 'lidar_joint', not 'a'; the joint of 'wheel' should be named 'wheel_joint', not 'b'"
    )


def test_only_wrong_names_are_reported() -> None:
    """A correct name beside a wrong one is not mentioned."""
    message = fails(joints_named, named("lidar_joint", "Wheel_joint"), at='name="Wheel_joint"', **NAMED)
    assert message == "the joint of 'wheel' should be named 'wheel_joint', not 'Wheel_joint'"


def test_swapped_names_are_wrong() -> None:
    """The correct names on each other's links are wrong."""
    message = fails(joints_named, named("wheel_joint", "lidar_joint"), **NAMED)
    assert (
        message
        == "the joint of 'lidar' should be named 'lidar_joint', not 'wheel_joint'; the joint of 'wheel' should be named 'wheel_joint', not 'lidar_joint'"
    )


def test_a_missing_link_has_no_joint_of_the_name() -> None:
    """A missing link fails the names without hiding a wrong one."""
    half = scene(BASE, WHEEL, joint("b", "continuous", "base", "wheel"))
    message = fails(joints_named, half, at='name="b"', **NAMED)
    assert (
        message
        == "no joint 'lidar_joint' connects 'lidar'; the joint of 'wheel' should be named 'wheel_joint', not 'b'"
    )


def test_a_link_without_a_joint_has_no_name() -> None:
    """Links without a joint fail the names; the failure has no location."""
    loose = scene(BASE, LIDAR, WHEEL)
    assert (
        fails(joints_named, loose, **NAMED)
        == "no joint 'lidar_joint' connects 'lidar'; no joint 'wheel_joint' connects 'wheel'"
    )
    assert ask(joints_named, loose, **NAMED).location is None


def test_any_joint_in_the_chain_may_have_the_name() -> None:
    """With a mount between, either joint may have the name."""
    for upper, lower in (("lidar_joint", "x"), ("x", "lidar_joint")):
        mount = (joint(upper, "fixed", "base", "mount"), joint(lower, "fixed", "mount", "lidar"))
        found = scene(BASE, LIDAR, link("mount"), *mount)
        passes(joints_named, found, parent="base", joints={"lidar_joint": "lidar"})


def test_a_swapped_joint_keeps_its_name() -> None:
    """Parents are graded by another criterion: a joint at a link without a parent joint counts."""
    swapped = scene(BASE, LIDAR, joint("lidar_joint", "fixed", "lidar", "base"))
    passes(joints_named, swapped, **LIDAR_NAMED)


def test_a_joint_to_another_parent_keeps_its_name() -> None:
    """The name also counts if the parent is another link or has another name."""
    beside = scene(
        BASE, LIDAR, WHEEL, joint("a", "fixed", "base", "wheel"), joint("lidar_joint", "fixed", "wheel", "lidar")
    )
    passes(joints_named, beside, **LIDAR_NAMED)
    passes(joints_named, beside, **{**LIDAR_NAMED, "parent": "base_link"})


def test_the_joint_above_the_parent_does_not_count() -> None:
    """Joints above the parent do not connect the link to it, and without the parent there is no path."""
    found = scene(
        FOOT, BASE, LIDAR, joint("lidar_joint", "fixed", "foot", "base"), joint("b", "fixed", "base", "lidar")
    )
    for parent in ("base", "base_link"):
        message = fails(joints_named, found, at='name="b"', **{**LIDAR_NAMED, "parent": parent})
        assert message == "the joint of 'lidar' should be named 'lidar_joint', not 'b'"


def test_a_joint_below_the_link_does_not_count() -> None:
    """The name must be that of the parent joint, not that of a child joint."""
    found = scene(
        BASE, LIDAR, WHEEL, joint("a", "fixed", "base", "lidar"), joint("lidar_joint", "fixed", "lidar", "wheel")
    )
    assert (
        fails(joints_named, found, at='name="a"', **LIDAR_NAMED)
        == "the joint of 'lidar' should be named 'lidar_joint', not 'a'"
    )


def test_a_joint_to_a_missing_link_keeps_its_name() -> None:
    """A joint whose parent does not exist connects nothing but has its name."""
    found = scene(BASE, LIDAR, joint("lidar_joint", "fixed", "bas", "lidar"))
    passes(joints_named, found, **LIDAR_NAMED)


def test_a_single_name() -> None:
    """A single name is reported without a list."""
    one = scene(BASE, LIDAR, joint("lidar_joint", "fixed", "base", "lidar"))
    assert (
        passes(joints_named, one, parent="base", joints={"lidar_joint": "lidar"})
        == "the joints are named 'lidar_joint'"
    )


# --- root_of_tree -----------------------------------------------------------------------------------------------------


def test_a_chain_of_fixed_joints_may_lead_from_the_root() -> None:
    """The root need not be the direct parent."""
    chain = (joint("a", "fixed", "foot", "mount"), joint("b", "fixed", "mount", "base"))
    passes(root_of_tree, scene(FOOT, link("mount"), BASE, *chain), **ROOT)


@pytest.mark.parametrize("kind", [*MOVING, "Fixed"])
def test_a_moving_joint_does_not_fix_the_base(kind: str) -> None:
    """A joint that moves, or whose type is unknown, is not fixed."""
    message = fails(root_of_tree, scene(FOOT, BASE, joint("j", kind, "foot", "base")), at=f'type="{kind}"', **ROOT)
    assert message == f"a joint between 'foot' and 'base' is {kind}; it should be fixed (joint 'j')"


def test_the_first_moving_joint_is_named() -> None:
    """Of several joints the message names the one that is not fixed."""
    chain = (joint("a", "fixed", "foot", "mount"), joint("b", "revolute", "mount", "base"))
    message = fails(root_of_tree, scene(FOOT, link("mount"), BASE, *chain), at='type="revolute"', **ROOT)
    assert message == "a joint between 'foot' and 'base' is revolute; it should be fixed (joint 'b')"


def test_a_root_with_a_parent_is_no_root() -> None:
    """A link below another one fails, and the message names its parent."""
    above = scene(link("world"), FOOT, BASE, joint("w", "fixed", "world", "foot"), joint("j", "fixed", "foot", "base"))
    message = fails(root_of_tree, above, at='<joint name="w"', **ROOT)
    assert message == "'foot' is not the root: it is a child of 'world' (joint 'w')"


def test_a_root_beside_the_base_is_not_connected() -> None:
    """A footprint without a joint misses a connection."""
    error = missing(root_of_tree, scene(FOOT, BASE), **ROOT)
    assert (error.kind, error.name) == ("connection", "base and foot")


def test_a_loop_is_opened_at_its_last_joint() -> None:
    """If footprint and base are each other's parents, ROS 2 shows nothing; the first joint is examined."""
    a, b = joint("a", "fixed", "foot", "base"), joint("b", "fixed", "base", "foot")
    passes(root_of_tree, scene(FOOT, BASE, a, b), **ROOT)
    fails(root_of_tree, scene(FOOT, BASE, b, a), at='<joint name="b"', **ROOT)


def test_other_links_on_the_root_are_ignored() -> None:
    """Other links on the root do not matter, moving or not."""
    more = scene(FOOT, BASE, WHEEL, joint("a", "fixed", "foot", "base"), joint("b", "continuous", "foot", "wheel"))
    assert passes(root_of_tree, more, **ROOT) == "'foot' is the root, and 'base' is fixed to it"


def test_notes_and_warnings_do_not_prevent_loading() -> None:
    """Problems that ROS 2 only warns of, or ignores, are no failure here; the checks of the parts see the rest."""
    scene_ = scene(link("base", visual("<cone/>")), LIDAR, joint("j", "fixed", "base", "lidar"))
    assert scene_.reading.verdict == "degraded"
    passes(urdf_loads, scene_)


def test_all_roots_are_named() -> None:
    """Every link without a parent joint is named."""
    message = fails(urdf_loads, scene(BASE, LIDAR, WHEEL), at='name="lidar"')
    assert "'lidar'" in message and "'wheel'" in message and "'base'" in message


def test_further_problems_are_counted() -> None:
    """The first reason is given in full, followed by the number of the others."""
    one = joint("a", "Fixed", "base", "lidar")
    two = scene(BASE, LIDAR, WHEEL, one, joint("b", "Fixed", "base", "wheel"))
    assert fails(urdf_loads, two).endswith(" (and 1 more such problem)")
    three = scene(
        BASE, LIDAR, WHEEL, link("x"), one, joint("b", "Fixed", "base", "wheel"), joint("c", "Fixed", "base", "x")
    )
    assert fails(urdf_loads, three).endswith(" (and 2 more such problems)")


def test_a_single_problem_is_not_counted() -> None:
    """The message mentions no further problems if there are none."""
    assert "more such problem" not in fails(urdf_loads, scene(BASE, LIDAR, joint("a", "Fixed", "base", "lidar")))


def test_notes_are_not_counted() -> None:
    """Only problems that prevent loading are counted."""
    zero = joint("a", "continuous", "base", "lidar", axis="0 0 0")
    message = fails(
        urdf_loads, scene(BASE, LIDAR, WHEEL, zero, joint("b", "Fixed", "base", "wheel")), at='type="Fixed"'
    )
    assert "more such problem" not in message


@pytest.mark.parametrize(
    ("scene_", "at"),
    [
        (scene(BASE, LIDAR, joint("a", "fixed", "base", "lidar", xyz="0 0")), 'xyz="0 0"/>'),
        (scene(BASE, LIDAR, joint("a", "fixd", "base", "lidar")), 'type="fixd"'),
        (scene(BASE, LIDAR, joint("a", "fixed", "base", "lydar")), 'link="lydar"'),
        (scene(BASE, LIDAR, joint("a", "fixed", "base", "lidar"), joint("b", "fixed", "lidar", "base")), None),
        (scene(BASE, joint("a", "fixed", "base", "base")), None),
        (scene(), "<robot"),
    ],
    ids=["unreadable-origin", "unknown-type", "unknown-link", "loop", "joint-to-itself", "no-links"],
)
def test_what_ros_rejects_does_not_load(scene_: Scene, at: str | None) -> None:
    """A file that ROS 2 rejects fails at the location of its first problem."""
    assert scene_.reading.verdict == "rejected"
    fails(urdf_loads, scene_, at=at)


def test_links_on_a_detached_loop_are_not_in_the_tree() -> None:
    """ROS 2 loads a robot with a detached loop of joints but omits its links: not every link is in the tree."""
    loop = (joint("a", "fixed", "lidar", "wheel"), joint("b", "fixed", "wheel", "lidar"))
    scene_ = scene(BASE, LIDAR, WHEEL, *loop)
    assert scene_.reading.verdict == "degraded"
    assert "loop" in fails(urdf_loads, scene_)


def test_text_that_is_no_xml_fails() -> None:
    """A file that is not XML is a failure with a location, not an error."""
    for text in ("", "hello", "<robot", '<robot name="r"><link></robot>', "\x00"):
        outcome = ask(urdf_loads, Scene(text))
        assert outcome.status == "failed"
        assert outcome.location is not None
        assert outcome.message


def test_meshes_and_movable_joints_load() -> None:
    """The content is ignored: missing meshes, wheels without an axis, a lidar in the ground."""
    passes(urdf_loads, mounted((0.0, 0.0, -9.0)).with_shape(mesh("nowhere.stl")))
    passes(urdf_loads, scene(BASE, WHEEL, joint("j", "continuous", "base", "wheel")))


# --- counts -----------------------------------------------------------------------------------------------------------

HAND = (
    *map(link, ("palm", "left", "right", "lift", "eye")),
    joint("left_joint", "prismatic", "palm", "left", axis="0 1 0"),
    joint("right_joint", "prismatic", "palm", "right", axis="0 1 0", more='<mimic joint="left_joint"/>'),
    joint("lift_joint", "planar", "palm", "lift", axis="0 0 1"),
    joint("eye_joint", "fixed", "lift", "eye"),
)


def test_what_is_counted() -> None:
    """All types count as joints; a mimic joint does not move by itself; what the rubric does not give is not counted."""
    found = passes(counts, scene(*HAND), links=5, joints=4, moving=2, prismatic=2, fixed=1)
    assert found == "the tree has 5 links, 4 joints, 2 moving joints, 2 prismatic joints and 1 fixed joint"
    assert passes(counts, scene(*HAND), continuous=0) == "the tree has 0 continuous joints"


def test_each_wrong_count_is_named() -> None:
    """The message lists those that are wrong, with the expected number."""
    found = fails(counts, scene(*HAND), links=6, joints=4, moving=3, revolute=1, fixed=0)
    assert found == (
        "there are 5 links; there should be 6; there are 2 moving joints; there should be 3;"
        " there are 0 revolute joints; there should be 1; there is 1 fixed joint; there should be 0"
    )


def test_only_the_largest_tree_counts() -> None:
    """Links that are not connected to it are not in the tree, nor is a loop, nor the joints of both."""
    loose = (link("a"), link("b"), joint("ab", "continuous", "a", "b"))
    loop = (link("c"), link("d"), joint("cd", "fixed", "c", "d"), joint("dc", "fixed", "d", "c"))
    passes(counts, scene(*loose, *HAND), links=5, joints=4, continuous=0)
    passes(counts, scene(*HAND, *loop), links=5, joints=4, fixed=1)
    assert fails(counts, scene(*loop[:2], *loop[3:], link("palm")), links=3) == "there are 2 links; there should be 3"


def test_a_joint_with_an_unknown_type_is_a_joint() -> None:
    """It is of no type that is counted; which links there are does not depend on it."""
    text = scene(*HAND).text.replace('"planar"', '"plane"')
    passes(counts, Scene(text), links=5, joints=4, fixed=1, moving=2)


@pytest.mark.parametrize(
    ("written", "by", "wanted", "status"),
    [
        ('type="fixed"', 'type="$(env KIND)"', {"links": 5, "joints": 4}, "passed"),
        ('type="fixed"', 'type="$(env KIND)"', {"fixed": 1}, "pending"),
        ('mimic joint="left_joint"', 'mimic joint="$(env J)"', {"moving": 2}, "passed"),
        ('mimic joint="left_joint"', 'mimic joint="left_joint" multiplier="$(env J)"', {"moving": 2}, "passed"),
        (
            'mimic joint="left_joint"/',
            'xacro:if value="$(env J)"><mimic joint="left_joint"/></xacro:if',
            {"moving": 2},
            "pending",
        ),
        (
            'mimic joint="left_joint"/',
            'xacro:if value="$(env J)"><mimic joint="left_joint"/></xacro:if',
            {"joints": 4},
            "passed",
        ),
        ('link name="eye"', 'link name="$(env EYE)"', {"links": 5}, "pending"),
    ],
)
def test_counts_of_xacro_that_is_left_open(
    tmp_path: Path, written: str, by: str, wanted: Arguments, status: str
) -> None:
    """A number that depends on what only a run tells needs manual grading."""
    xacro = (
        scene(*HAND).text.replace(written, by).replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    )
    (tmp_path / "hand.urdf.xacro").write_text(xacro)
    given = ", ".join(f"{name} = {number}" for name, number in wanted.items())
    (tmp_path / "hand.toml").write_text(
        'id = "hand"\ntitle = "Hand"\nreference = "hand.urdf.xacro"\nurdf = "hand.urdf"\n'
        '[[part]]\nid = "all"\ntitle = "All"\nneeds = "urdf"\n'
        f'[[criterion]]\nid = "size"\ntitle = "Size"\npart = "all"\npoints = 1\ncheck = "counts"\nwith = {{ {given} }}\n'
    )
    done = run(("grade", tmp_path / "hand.urdf.xacro", "--rubric", tmp_path / "hand.toml", "--format", "json"))
    assert [result["status"] for result in json.loads(done.stdout)["results"]] == [status]


@pytest.mark.parametrize("number", ["-1", "1.0", '"3"'])
def test_a_count_is_a_whole_number(tmp_path: Path, number: str) -> None:
    """Anything else is a mistake of the rubric."""
    (tmp_path / "r.toml").write_text(
        'id = "r"\ntitle = "R"\nreference = "r.urdf"\nurdf = "r.urdf"\n[[part]]\nid = "all"\ntitle = "All"\nneeds = "urdf"\n'
        f'[[criterion]]\nid = "size"\ntitle = "Size"\npart = "all"\npoints = 1\ncheck = "counts"\nwith = {{ links = {number} }}\n'
    )
    done = run(("rubric", "check", tmp_path / "r.toml"))
    assert done.returncode == 2
    assert b"links" in done.stderr
