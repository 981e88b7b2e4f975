"""What the reader keeps of a joint, the note on limits in degrees, and the joint that moves a link."""

from math import isnan

import pytest

from grader.base.errors import MissingElement
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Calibration, Dynamics, Joint, Limit, Mimic, SafetyController
from grader.ros.urdf.reader import read_urdf
from tests.urdf.builders import joint, links, one_joint, robot

pytestmark = pytest.mark.slow


def only_joint(body: str, kind: str = "continuous") -> Joint:
    """Return the joint that contains this, as it is read."""
    read = read_urdf(one_joint(body, kind).encode()).robot
    assert read is not None
    return read.joints[0]


def test_every_element_is_kept() -> None:
    """With its values, ROS 2's defaults, and its place."""
    found = only_joint(
        '\n<limit effort="3" velocity="4" upper="2"/>\n<mimic joint="j"/>\n<dynamics friction="0.5"/>'
        '\n<safety_controller k_velocity="6" soft_upper_limit="7"/>\n<calibration rising="8"/>'
    )
    kept = (found.limit, found.mimic, found.dynamics, found.safety_controller, found.calibration)
    assert kept == (
        Limit(0.0, 2.0, 3.0, 4.0),
        Mimic("j", 1.0, 0.0),
        Dynamics(0.0, 0.5),
        SafetyController(6.0, 0.0, 7.0, 0.0),
        Calibration(8.0, None),
    )
    assert [
        element.location.resolve().line for element in kept if element and element.location
    ] == [2, 3, 4, 5, 6]


def test_a_joint_without_them_has_none() -> None:
    """An absent element is no element of zeros."""
    found = only_joint("")
    assert [
        found.limit,
        found.mimic,
        found.dynamics,
        found.safety_controller,
        found.calibration,
    ] == [None] * 5


def test_an_unreadable_number_does_not_hide_the_others() -> None:
    """ROS 2 rejects the file; the numbers that can be read are kept, and the others are NaN."""
    found = only_joint(
        '<limit lower="-1" upper="1"/><dynamics damping="a" friction="2"/>', "revolute"
    )
    assert found.limit is not None
    assert (found.limit.lower, found.limit.upper, isnan(found.limit.effort)) == (-1.0, 1.0, True)
    assert found.dynamics is not None
    assert (isnan(found.dynamics.damping), found.dynamics.friction) == (True, 2.0)
    assert only_joint("<dynamics/>").dynamics is None


@pytest.mark.parametrize(
    ("kind", "lower", "upper", "noted"),
    [
        ("revolute", "-90", "90", True),
        ("revolute", "-1.5708", "10", True),
        ("revolute", "-720", "720", True),
        ("revolute", "-6.28", "6.28", False),
        ("revolute", "-7", "12.566", False),
        ("revolute", "-5", "5", False),
        ("revolute", "-1e16", "1e16", False),
        ("prismatic", "-90", "90", False),
        ("continuous", "-90", "90", False),
    ],
)
def test_limits_in_degrees_get_a_note(kind: str, lower: str, upper: str, noted: bool) -> None:
    """A multiple of 5 above a full turn, of a revolute joint, is taken for degrees; the verdict stays."""
    body = f'<axis xyz="0 0 1"/><limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>'
    read = read_urdf(one_joint(body, kind).encode())
    assert read.verdict == "clean"
    assert [problem.code for problem in read.problems] == ["URDF079"] * noted


def moving(link: str, *kinds: str) -> Joint:
    """Return the joint that moves a link of a chain a, b, c, ... with joints of these types, named by both ends."""
    names = "abcdef"[: len(kinds) + 1]
    ends = [(one, other, kind) for one, other, kind in zip(names, names[1:], kinds, strict=False)]
    text = robot(
        links(*names)
        + "".join(joint(one, other, one + other, kind=kind) for one, other, kind in ends)
    )
    read = read_urdf(text.encode()).robot
    assert read is not None
    return Configuration(read).moving_joint(link)


@pytest.mark.parametrize(
    ("kinds", "name"),
    [
        (["continuous"], "ab"),
        (["continuous", "fixed", "fixed"], "ab"),
        (["continuous", "fixed", "planar", "fixed"], "cd"),
        (["continuous", "continuous"], "bc"),
    ],
)
def test_the_moving_joint_is_the_last_that_is_not_fixed(kinds: list[str], name: str) -> None:
    """Fixed joints below it do not count."""
    assert moving("abcdef"[len(kinds)], *kinds).name == name


@pytest.mark.parametrize(
    ("link", "kinds", "message"),
    [
        ("a", ["continuous"], "no joint above 'a' moves; one should turn or slide"),
        ("b", ["fixed", "continuous"], "no joint above 'b' moves; one should turn or slide"),
        (
            "c",
            ["continuous", "hinge"],
            "the joint that moves 'c' has the type 'hinge', which does not exist",
        ),
        ("x", ["continuous"], "there is no link 'x'"),
    ],
)
def test_a_link_that_nothing_moves(link: str, kinds: list[str], message: str) -> None:
    """The error says why; all checks that need the moving joint of a link fail for the same reason."""
    with pytest.raises(MissingElement) as raised:
        moving(link, *kinds)
    assert raised.value.mistake == message
    assert raised.value.kind == ("link" if link == "x" else "moving joint")
