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
from tests.checks.cases import BASE, FOOT, LIDAR, WHEEL, mounted
from tests.checks.outcomes import ANYTHING, Arguments, ask, fails, graded, missing, own_message, passes, says
from tests.checks.robots import Scene, joint, link, mesh, scene, visual
from tests.checks.submissions import Submitted
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


FREE: Arguments = {**HELD, "free": True}
BLOCKED = '<limit effort="1" velocity="0"/>'


@pytest.mark.parametrize(
    ("arguments", "found", "why"),
    [
        (FREE, joined("continuous", more='<limit effort="1" velocity="0.1"/>'), ""),
        ({**FIXED, "free": True}, joined("fixed"), ""),
        (HELD, joined("continuous", more=BLOCKED), ""),
        (FREE, joined("continuous", more=BLOCKED), "the velocity limit of the joint that moves 'wheel' is 0"),
        (FREE, joined("continuous", more='<mimic joint="j"/>'), "the joint that moves 'wheel' mimics itself"),
        (FREE, joined("continuous", more='<mimic joint="k"/>'), "the joint that moves 'wheel' mimics another joint"),
    ],
)
def test_a_free_joint_moves_by_itself(arguments: Arguments, found: Scene, why: str) -> None:
    """If that is asked for, it neither mimics a joint nor is kept from moving."""
    assert (fails(held_by, found, **arguments) if why else passes(held_by, found, **arguments)).startswith(why)


@pytest.mark.parametrize("kind", ["fixed", "rotary"])
def test_a_link_that_cannot_move_misses_a_moving_joint(kind: str) -> None:
    """Checks of motion miss the same thing, so that they are skipped; a joint of an unknown type moves nothing."""
    error = missing(held_by, joined(kind), **HELD)
    assert (error.kind, error.name) == ("moving joint", "wheel")


@pytest.mark.parametrize(
    ("kind", "guess"),
    [("continuous_joint", "continuous"), ("wheel", None)],
)
def test_an_unknown_type_is_quoted(kind: str, guess: str | None) -> None:
    """An unknown type is quoted, with a suggestion; the problem at the same location is not repeated in a grade run."""
    hint = f"; did you mean {guess!r}?" if guess else ""
    message = f"a joint between 'base' and 'wheel' has the type {kind!r}, which does not exist{hint} (joint 'j')"
    for arguments in (HELD, FIXED):
        says(held_by, joined(kind), message, f'type="{kind}"', arguments)
    assert graded(held_by, joined(kind), **FIXED).message == message


def test_a_joint_without_a_type_has_none() -> None:
    """A type that is empty or missing is reported as missing; without the attribute the failure points to the joint."""
    without = Scene(joined("fixed").text.replace(' type="fixed"', ""))
    for found, at in ((joined(""), 'type=""'), (without, "<joint")):
        for arguments in (HELD, FIXED):
            says(held_by, found, "a joint between 'base' and 'wheel' has no type (joint 'j')", at, arguments)


def test_an_unknown_type_in_a_chain_moves_nothing() -> None:
    """A joint of an unknown type beside a moving one is not named as the one that moves the link."""
    message = fails(held_by, in_line("continuous", "rigid"), **HELD)
    assert "several joints move" not in message
    assert "'rigid'" in message


SWAPPED = "the parent and child of a joint are swapped: {!r} is above {!r}; it should be below (joint {!r})"
BESIDE = (joint("a", "fixed", "lidar", "base"), joint("b", "continuous", "lidar", "wheel"))
BELOW = (joint("a", "fixed", "base", "lidar"), joint("b", "continuous", "lidar", "wheel"))
MOUNTED = (link("mount"), joint("a", "fixed", "wheel", "mount"), joint("b", "fixed", "mount", "base"))
CONNECTS = "the {} joint {!r} connects 'wheel' to 'base'"
# What holds a wheel, what the rubric asks for, the message, and where it points if the check fails.
HOLDING: dict[str, tuple[Scene, Arguments, str, str | None]] = {
    "wrong type": (joined("revolute"), HELD, ANYTHING, 'type="revolute"'),
    "wrong type for a fixed one": (joined("continuous"), FIXED, ANYTHING, 'type="continuous"'),
    "fixed": (joined("fixed"), HELD, ANYTHING, 'type="fixed"'),
    "mount above": (in_line("fixed", "continuous"), HELD, CONNECTS.format("continuous", "b"), None),
    "mount below": (in_line("continuous", "fixed"), HELD, CONNECTS.format("continuous", "a"), None),
    "fixed joints": (in_line("fixed", "fixed", "fixed"), FIXED, CONNECTS.format("fixed", "c"), None),
    "wrong joint in a chain": (
        in_line("revolute", "fixed"), HELD,
            "the joint that moves 'wheel' is revolute; it should be continuous (joint 'a')",
        'type="revolute"',
    ),
    "two that move": (
        in_line("continuous", "continuous"), HELD,
        "several joints move 'wheel'; there should be one continuous joint (joints 'a' and 'b')", "",
    ),
    "two of three that move": (
        in_line("revolute", "fixed", "continuous"), HELD,
        "several joints move 'wheel'; there should be one continuous joint (joints 'a' and 'c')", "",
    ),
    "two that move a fixed one": (in_line("continuous", "continuous"), FIXED, ANYTHING, ""),
    "swapped": (
        scene(BASE, WHEEL, joint("j", "continuous", "wheel", "base")), HELD, SWAPPED.format("wheel", "base", "j"),
            "<joint",
    ),
    "swapped chain": (scene(BASE, WHEEL, *MOUNTED), FIXED, SWAPPED.format("wheel", "base", "a"), '<joint name="a"'),
    "another parent": (
        scene(BASE, LIDAR, WHEEL, *BESIDE), HELD, "the parent of 'wheel' is 'lidar'; it should be 'base' (joint 'b')",
        'link="lidar"/>\n<child link="wheel"',
    ),
    "itself": (
        joined("fixed"), {"link": "base", "parent": "base", "joint_type": "fixed"},
        "'base' is itself the parent; it should be the child of a joint", '<link name="base"',
    ),
    "below another link": (scene(BASE, LIDAR, WHEEL, *BELOW), HELD, ANYTHING, None),
    "zero axis": (joined("continuous", axis="0 0 0"), HELD, ANYTHING,
        None),  # graded by other criteria, as the next two are
    "unreadable origin": (joined("continuous", xyz="0 0"), HELD, ANYTHING, None),
    "mimic": (joined("continuous", more='<mimic joint="nobody"/>'), HELD, ANYTHING, None),
}  # fmt: skip


@pytest.mark.parametrize("name", HOLDING)
def test_what_holds_a_link(name: str) -> None:
    """A mount changes nothing; the message names the joint that moves, and a failure points to what is wrong with it."""
    found, arguments, message, at = HOLDING[name]
    says(held_by, found, message, at, arguments)


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
    lidar_joint, wheel_joint = joint(lidar, "fixed", "base", "lidar"), joint(wheel, "continuous", "base", "wheel")
    return scene(BASE, LIDAR, WHEEL, lidar_joint, wheel_joint)


def chained(upper: str, lower: str) -> Scene:
    """Return a base with a lidar on a mount, and two joints of these names."""
    mount = (joint(upper, "fixed", "base", "mount"), joint(lower, "fixed", "mount", "lidar"))
    return scene(BASE, LIDAR, link("mount"), *mount)


SHOULD = "the joint of {0!r} should be named '{0}_joint', not {1!r}"
NO_JOINT = "no joint '{0}_joint' connects {0!r}"
TO_LIDAR, OTHER_PARENT = joint("lidar_joint", "fixed", "base", "lidar"), {**LIDAR_NAMED, "parent": "base_link"}
UNDER_WHEEL = scene(
    BASE, LIDAR, WHEEL, joint("a", "fixed", "base", "wheel"), joint("lidar_joint", "fixed", "wheel", "lidar")
)
ABOVE_BASE = scene(
    FOOT, BASE, LIDAR, joint("lidar_joint", "fixed", "foot", "base"), joint("b", "fixed", "base", "lidar")
)
BELOW_LIDAR = scene(
    BASE, LIDAR, WHEEL, joint("a", "fixed", "base", "lidar"), joint("lidar_joint", "fixed", "lidar", "wheel")
)
NAMES: dict[str, tuple[Scene, Arguments, str, str | None]] = {
    "both wrong": (named("a", "b"), NAMED, f"{SHOULD.format('lidar', 'a')}; {SHOULD.format('wheel', 'b')}", 'name="a"'),
    "one wrong": (
        named("lidar_joint", "Wheel_joint"), NAMED, SHOULD.format("wheel", "Wheel_joint"), 'name="Wheel_joint"',
    ),
    "swapped names": (
        named("wheel_joint", "lidar_joint"), NAMED,
        f"{SHOULD.format('lidar', 'wheel_joint')}; {SHOULD.format('wheel', 'lidar_joint')}", "",
    ),
    "no such link": (
        scene(BASE, WHEEL, joint("b", "continuous", "base", "wheel")), NAMED,
        f"{NO_JOINT.format('lidar')}; {SHOULD.format('wheel', 'b')}", 'name="b"',
    ),
    "upper of a chain": (chained("lidar_joint", "x"), LIDAR_NAMED, "the joints are named 'lidar_joint'", None),
    "lower of a chain": (chained("x", "lidar_joint"), LIDAR_NAMED, "the joints are named 'lidar_joint'", None),
    # Parents are graded by another criterion.
    "swapped joint": (scene(BASE, LIDAR, joint("lidar_joint", "fixed", "lidar", "base")), LIDAR_NAMED, ANYTHING, None),
    "other parent": (UNDER_WHEEL, LIDAR_NAMED, ANYTHING, None),
    "parent of another name": (UNDER_WHEEL, OTHER_PARENT, ANYTHING, None),
    "missing parent": (scene(BASE, LIDAR, joint("lidar_joint", "fixed", "bas", "lidar")), LIDAR_NAMED, ANYTHING, None),
    "above the parent": (ABOVE_BASE, LIDAR_NAMED, SHOULD.format("lidar", "b"), 'name="b"'),
    "above a missing parent": (ABOVE_BASE, OTHER_PARENT, SHOULD.format("lidar", "b"), 'name="b"'),
    "below the link": (BELOW_LIDAR, LIDAR_NAMED, SHOULD.format("lidar", "a"), 'name="a"'),
    "only one": (scene(BASE, LIDAR, TO_LIDAR), LIDAR_NAMED, "the joints are named 'lidar_joint'", None),
}  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_names_of_joints(name: str) -> None:
    """Any joint that leads to a link may have its name; all wrong names are reported, and a failure points to the first."""
    found, arguments, message, at = NAMES[name]
    says(joints_named, found, message, at, arguments)


def test_a_link_without_a_joint_has_no_name() -> None:
    """Links without a joint fail the names; the failure has no location."""
    loose = scene(BASE, LIDAR, WHEEL)
    says(joints_named, loose, f"{NO_JOINT.format('lidar')}; {NO_JOINT.format('wheel')}", "", NAMED)
    assert ask(joints_named, loose, **NAMED).location is None


# --- root_of_tree -----------------------------------------------------------------------------------------------------


def below_foot(*kinds: str) -> Scene:
    """Return a footprint, a mount and a base in a chain of two joints, a and b."""
    return scene(
        FOOT, link("mount"), BASE, joint("a", kinds[0], "foot", "mount"), joint("b", kinds[1], "mount", "base")
    )


LOOP = (joint("a", "fixed", "foot", "base"), joint("b", "fixed", "base", "foot"))
IS_ROOT = "'foot' is the root, and 'base' is fixed to it"
WORLD = scene(link("world"), FOOT, BASE, joint("w", "fixed", "world", "foot"), joint("j", "fixed", "foot", "base"))
BESIDE_BASE = scene(FOOT, BASE, WHEEL, LOOP[0], joint("b", "continuous", "foot", "wheel"))
ROOTS: dict[str, tuple[Scene, str, str | None]] = {
    "chain": (below_foot("fixed", "fixed"), ANYTHING, None),
    "moving joint": (
        below_foot("fixed", "revolute"),
            "a joint between 'foot' and 'base' is revolute; it should be fixed (joint 'b')",
        'type="revolute"',
    ),
    "parent": (WORLD, "'foot' is not the root: it is a child of 'world' (joint 'w')", '<joint name="w"'),
    # If both are each other's parents, ROS 2 shows nothing; the first joint is examined.
    "loop": (scene(FOOT, BASE, *LOOP), ANYTHING, None),
    "loop the other way": (scene(FOOT, BASE, *LOOP[::-1]), ANYTHING, '<joint name="b"'),
    "other links": (BESIDE_BASE, IS_ROOT, None),
}  # fmt: skip


@pytest.mark.parametrize("name", ROOTS)
def test_the_root_and_what_it_holds(name: str) -> None:
    """The root need not be the direct parent, and may have other links; the message names the joint that is wrong."""
    found, message, at = ROOTS[name]
    says(root_of_tree, found, message, at, ROOT)


@pytest.mark.parametrize("kind", [*MOVING, "rigid"])
def test_a_moving_joint_does_not_fix_the_base(kind: str) -> None:
    """A joint that moves, or whose type is unknown, is not fixed."""
    message = fails(root_of_tree, scene(FOOT, BASE, joint("j", kind, "foot", "base")), at=f'type="{kind}"', **ROOT)
    assert message == f"a joint between 'foot' and 'base' is {kind}; it should be fixed (joint 'j')"


def test_a_root_beside_the_base_is_not_connected() -> None:
    """A footprint without a joint misses a connection."""
    error = missing(root_of_tree, scene(FOOT, BASE), **ROOT)
    assert (error.kind, error.name) == ("connection", "base and foot")


def test_notes_and_warnings_do_not_prevent_loading() -> None:
    """Problems that ROS 2 only warns of, or ignores, are no failure here; the checks of the parts see the rest."""
    scene_ = scene(link("base", visual("<cone/>")), LIDAR, joint("j", "fixed", "base", "lidar"))
    assert scene_.reading.verdict == "degraded"
    passes(urdf_loads, scene_)


def test_further_problems_are_counted() -> None:
    """The first reason is given in full, and the others that prevent loading are counted; every root is named."""
    one, other = joint("a", "rigid", "base", "lidar"), joint("b", "rigid", "base", "wheel")
    zero = joint("a", "continuous", "base", "lidar", axis="0 0 0")
    assert "more such problem" not in fails(urdf_loads, scene(BASE, LIDAR, one))
    assert "more such problem" not in fails(urdf_loads, scene(BASE, LIDAR, WHEEL, zero, other), at='type="rigid"')
    two = scene(BASE, LIDAR, WHEEL, one, other)
    assert fails(urdf_loads, two).endswith(" (and 1 more such problem)")
    three = scene(BASE, LIDAR, WHEEL, link("x"), one, other, joint("c", "rigid", "base", "x"))
    assert fails(urdf_loads, three).endswith(" (and 2 more such problems)")
    message = fails(urdf_loads, scene(BASE, LIDAR, WHEEL), at='name="lidar"')
    assert all(name in message for name in ("'lidar'", "'wheel'", "'base'"))


@pytest.mark.parametrize(
    ("scene_", "at"),
    [
        (scene(BASE, LIDAR, joint("a", "fixed", "base", "lidar", xyz="0 0")), 'xyz="0 0"/>'),
        (scene(BASE, LIDAR, joint("a", "rigid", "base", "lidar")), 'type="rigid"'),
        (scene(BASE, LIDAR, joint("a", "fixed", "base", "laser")), 'link="laser"'),
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


@pytest.mark.parametrize(
    ("added", "status"),
    [
        ('<joint name="k" type="fixed"><parent link="base"/><child link="$(env X)"/></joint>', "pending"),
        ('<joint name="k" type="fixed"><parent link="$(env X)"/><child link="foot"/></joint>', "failed"),
        ('<link name="$(env X)"/>', "failed"),
        ('<gazebo><plugin><child link="$(env X)"/></plugin></gazebo>', "failed"),
    ],
)
def test_a_name_that_is_left_open_may_connect_a_link(added: str, status: str) -> None:
    """A link without a joint is wrong unless a joint whose child is not known may hold it."""
    links = '<link name="base"/><link name="lone"/>' + '<link name="foot"/>' * ("foot" in added)
    xacro = f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{links}{added}</robot>'
    assert graded(urdf_loads, Submitted({"robot.urdf.xacro": xacro})).status == status


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
        ('mimic joint="left_joint"', 'mimic joint="$(env J)"', {"moving": 2}, "pending"),
        ('mimic joint="left_joint"', 'mimic joint="left_joint" multiplier="$(env J)"', {"moving": 2}, "pending"),
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
