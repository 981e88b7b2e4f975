"""Links named by their place in the tree: the root, the tip, the links that moving joints move; and joints by links."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import MissingElement, NotDecided
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.link_tree import parent_joints, selected_name
from grader.ros.urdf.model import Joint, Link, Mimic, Robot

pytestmark = pytest.mark.slow

# base -fixed- mount -m1- upper -fixed- flange -m2- hand -fixed- tool, and a camera on the base
ARM = ("bm:fixed", "mu:revolute", "uf:fixed", "fh:prismatic", "ht:fixed", "bc:fixed")


def robot(*joints: str, alone: str = "", **more: dict[str, Any]) -> Robot:
    """Return a robot of joints, "ab:revolute" from link a to link b; more attributes of a joint by its ends."""
    pairs = [joint.partition(":") for joint in joints]
    names = dict.fromkeys([*(end for ends, _, _ in pairs for end in ends), *alone])
    made = (Joint(ends, kind, ends[0], ends[1], **more.get(ends, {})) for ends, _, kind in pairs)
    return Robot("r", tuple(map(Link, names)), tuple(made))


def selected(found: Robot, name: str) -> str:
    """Return the link that a selector means."""
    return selected_name(found, parent_joints(found), name)


@pytest.mark.parametrize(
    ("name", "link"),
    [
        ("@root", "b"),
        ("@moved:1", "u"),
        ("@moved:2", "h"),
        ("@tip", "t"),
        ("u", "u"),
        ("nowhere", "nowhere"),
    ],
)
def test_a_selector_means_a_link_of_the_main_chain(name: str, link: str) -> None:
    """Fixed joints and links beside the chain do not count; a name is itself."""
    assert selected(robot(*ARM), name) == link


@given(st.permutations(ARM))
def test_the_order_of_the_file_does_not_matter(joints: list[str]) -> None:
    """The links are the same in every order of the joints."""
    found = robot(*joints)
    assert [selected(found, name) for name in ("@root", "@moved:1", "@moved:2", "@tip")] == [
        "b",
        "u",
        "h",
        "t",
    ]


@pytest.mark.parametrize(
    ("link", "message"), [("b", "no joint holds 'b'"), ("x", "there is no link 'x'")]
)
def test_a_joint_is_named_by_its_link(link: str, message: str) -> None:
    """It is the parent joint; a root has none."""
    assert [selected(robot(*ARM), f"@joint:{it}") for it in "mhc"] == ["bm", "fh", "bc"]
    with pytest.raises(MissingElement) as caught:
        selected(robot(*ARM), f"@joint:{link}")
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize("name", ["@moved:3", "@moved:99"])
def test_a_moving_joint_that_is_not_there_is_missing(name: str) -> None:
    """The message says how many moving joints there are."""
    with pytest.raises(MissingElement) as caught:
        selected(robot(*ARM), name)
    assert str(caught.value) == f"there is no {name}: the longest chain has 2 moving joints"
    found = robot(*ARM)
    assert (
        Configuration(found).selected_or_name(name) == name
    )  # of which no hint can be about a link


def test_a_mimic_joint_does_not_count() -> None:
    """A gripper's second finger mimics the first: only that one moves, and it is the tip."""
    gripper = robot("bp:revolute", "pl:prismatic", "pr:prismatic", pr={"mimic": Mimic("pl")})
    assert (selected(gripper, "@moved:2"), selected(gripper, "@tip")) == ("l", "l")


def test_several_links_are_not_guessed() -> None:
    """Two links that could be meant need manual grading; what is certain above them is known."""
    gripper = robot("bp:revolute", "pl:prismatic", "pr:prismatic")
    assert selected(gripper, "@moved:1") == "p"
    for name in ("@moved:2", "@tip"):
        with pytest.raises(NotDecided, match=f"several links can be {name}: 'l' and 'r'") as caught:
            selected(gripper, name)
        assert caught.value.cause == f"several links can be {name}"


def test_of_several_trees_the_largest_counts() -> None:
    """A forgotten joint detaches a part; two trees of the same size have no root."""
    assert selected(robot("ab:revolute", "bc:revolute", "xy:revolute"), "@root") == "a"
    with pytest.raises(
        MissingElement, match=r"several links are roots of trees of the same size: 'a' and 'x'"
    ):
        selected(robot("ab:revolute", "xy:revolute"), "@root")


@pytest.mark.parametrize("name", ["@root", "@tip", "@moved:1"])
def test_a_loop_has_no_root(name: str) -> None:
    """Links that are in no tree have no place in it."""
    with pytest.raises(
        MissingElement, match=f"there is no {name}: no link is the root of the robot"
    ):
        selected(robot("ab:revolute", "ba:revolute"), name)


def test_a_robot_of_one_link() -> None:
    """The only link is the root and the tip."""
    assert {selected(robot(alone="b"), name) for name in ("@root", "@tip")} == {"b"}


def test_a_link_with_the_name_of_a_selector_is_itself() -> None:
    """A link can have any name."""
    found = Robot("r", (Link("a"), Link("@tip")), (Joint("j", "revolute", "@tip", "a"),))
    assert selected(found, "@tip") == "@tip"


def test_links_that_may_exist_are_not_ignored() -> None:
    """A robot of which a part is not known has no certain tip."""
    with pytest.raises(NotDecided, match="an argument is not known"):
        selected(Robot("r", (Link("a"),), incomplete="an argument is not known"), "@tip")


def test_a_long_chain_takes_linear_time() -> None:
    """Thousands of links are no problem."""
    links = tuple(Link(str(number)) for number in range(20_000))
    joints = tuple(
        Joint(f"j{number}", "revolute", str(number), str(number + 1)) for number in range(19_999)
    )
    assert selected(Robot("r", links, joints), "@moved:9999") == "9999"
