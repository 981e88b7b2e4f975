"""The check that links move as those of the reference solution."""

from math import pi
from typing import Any

import pytest

from grader.checks.outcome import Outcome
from grader.checks.reference import kinematics_match_reference
from grader.errors import MissingElement, NotDecided, RubricError
from grader.robot.kinematics import Configuration
from grader.submission.opening import read_submission
from tests.checks.outcomes import ask
from tests.checks.robots import ARM, Scene, arm, joint, link, scene
from tests.work import limited_work


def compared(own: Scene, other: Scene, *links: str, **arguments: Any) -> Outcome:
    """Return the outcome for a robot and a reference; default: their only tips are compared."""
    given: dict[str, Any] = {"samples": 20, **arguments}
    return kinematics_match_reference(own.robot, other.robot, links=[*links] or ["@tip"], **given)


def serial(*axes: str, names: str = "j{}", kind: str = "revolute", first: str = "l0", length: float = 0.3) -> Scene:
    """Return an arm with a joint about each axis."""
    links = [first, *(f"l{index}" for index in range(1, len(axes) + 1))]
    joints = [
        joint(names.format(index + 1), kind, links[index], links[index + 1], xyz=(0.0, 0.1, length), axis=axis)
        for index, axis in enumerate(axes)
    ]
    return scene(*map(link, links), *joints)


AXES = ("0 0 1", "0 1 0", "0 1 0", "1 0 0")
SERIAL = serial(*AXES)


def gripper(*, rule: str = '<mimic joint="left" multiplier="-1"/>', right: str = "prismatic") -> Scene:
    """Return a hand with two fingers, the right of which follows the left."""
    return scene(
        link("hand"), link("left_finger"), link("right_finger"),
        joint("left", "prismatic", "hand", "left_finger", axis="0 1 0"),
        joint("right", right, "hand", "right_finger", axis="0 1 0", more=rule),
    )  # fmt: skip


# --- Equivalent robots ------------------------------------------------------------------------------------------------


def test_frames_between_do_not_matter() -> None:
    """Links on fixed joints in the chain, and axes that are scaled or turned with their frame, change nothing."""
    text = arm().text.replace('<child link="arm"/>', '<child link="mid"/>')
    between = scene(link("mid"), joint("extra", "fixed", "mid", "arm"))
    longer = Scene(text.replace("</robot>\n", "") + between.text.replace('<robot name="test">\n', ""))
    assert compared(longer, ARM, "wheel").status == "passed"
    assert compared(arm(axis="0 3 0"), ARM, "wheel").status == "passed"
    turned = Scene(
        ARM.text.replace('xyz="0.0 0.0 0.2"', f'xyz="0 0 0.2" rpy="0 0 {pi / 2!r}"')
        .replace('xyz="0 1 0"', 'xyz="1 0 0"')
        .replace('<origin xyz="0.5 0.0 0.0"/>', f'<origin xyz="0 -0.5 0" rpy="0 0 {-pi / 2!r}"/>')
    )
    assert compared(turned, ARM, "wheel").status == "passed"
    assert compared(turned, ARM, "arm").status == "failed"


def test_order_pairs_joints_whatever_their_names() -> None:
    """With "order", names of joints and the order of the file do not matter; with "name", they are named."""
    other = arm(shoulder="axis_1", spin="axis_2")
    lines = other.text.split("\n<joint ")
    swapped = Scene("\n<joint ".join([lines[0], lines[2].replace("</robot>\n", ""), lines[1] + "\n</robot>\n"]))
    for robot in (other, swapped):
        assert compared(robot, ARM, "wheel", match="order").status == "passed"
        with pytest.raises(
            MissingElement, match="there is no joint 'shoulder' and no joint 'spin'; the file has: 'axis_"
        ) as error:
            compared(robot, ARM, "wheel")
        assert error.value.kind == "joint"
    with pytest.raises(MissingElement, match="there is no joint 'shoulder'; did you mean 'sholder'"):
        compared(arm(shoulder="sholder"), ARM, "wheel")


def test_order_counts_joints() -> None:
    """Another number of moving joints on the chains fails."""
    outcome = compared(serial(*AXES[:3]), SERIAL, match="order")
    assert outcome.status == "failed"
    assert outcome.message == "3 joints on the chains to 'l3'; there should be 4 (joints 'j1', 'j2' and 'j3')"


def test_selectors_are_resolved_on_each_robot() -> None:
    """The tip of each robot is compared, whatever it is called."""
    renamed = Scene(ARM.text.replace('"wheel"', '"hand"'))
    assert compared(renamed, ARM, "@tip").status == "passed"
    with pytest.raises(MissingElement, match="there is no link 'wheel'"):
        compared(renamed, ARM, "wheel")


def test_the_frame_of_comparison() -> None:
    """Poses are relative to the reference's root, to the robot's root without a link of that name, or to a given link."""
    footprint = scene(link("footprint"), joint("foot", "fixed", "footprint", "base", xyz=(0.0, 0.0, 0.3)))
    below = Scene(ARM.text.replace("</robot>\n", "") + footprint.text.replace('<robot name="test">\n', ""))
    assert compared(below, ARM, "wheel").status == "passed"
    assert compared(below, ARM, "wheel", relative_to="@root").status == "failed"
    assert compared(ARM, below, "wheel").status == "failed"
    assert compared(ARM, below, "wheel", relative_to="base").status == "passed"
    renamed = Scene(ARM.text.replace('"base"', '"stand"'))
    assert compared(renamed, ARM, "wheel").status == "passed"


def test_mimic_joints_follow_in_both_robots() -> None:
    """A finger that mimics another one moves with it, also if only that finger is compared; a wrong or missing rule fails."""
    for links in (("right_finger",), ("left_finger", "right_finger")):
        assert compared(gripper(), gripper(), *links).status == "passed"
        assert compared(gripper(rule='<mimic joint="left"/>'), gripper(), *links).status == "failed"
        outcome = compared(gripper(rule=""), gripper(), *links)
        assert outcome.status == "failed"
        assert "has no counterpart in the reference (joint 'right')" in outcome.message
    assert compared(gripper(), gripper(rule=""), "right_finger").status == "failed"


# --- Wrong robots -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("moved", [1, 2, 3, 4])
@pytest.mark.parametrize("kind", ["revolute", "continuous", "prismatic"])
def test_a_reversed_axis_is_named(moved: int, kind: str) -> None:
    """The message names the joint, because the robots agree once it moves the other way."""
    axes = [axis.replace("1", "-1") if index == moved else axis for index, axis in enumerate(AXES, 1)]
    own = serial(*axes, kind=kind)
    outcome = compared(own, serial(*AXES, kind=kind))
    assert outcome.status == "failed"
    assert outcome.message.endswith(f"it differs as soon as 'j{moved}' moves: its axis is reversed")
    assert outcome.location == own.location_of(f'<axis xyz="{axes[moved - 1]}"')


def test_another_axis_is_not_called_reversed() -> None:
    """The joint is named, but not a cause that is not certain."""
    outcome = compared(serial(AXES[0], "1 0 0", *AXES[2:]), SERIAL)
    assert outcome.message.endswith("it differs as soon as 'j2' moves")
    two = compared(serial("0 0 -1", "0 -1 0", *AXES[2:]), SERIAL)
    assert two.message.endswith("it differs as soon as 'j1' or 'j2' moves: their axes are reversed")
    both = compared(serial("0 0 -1", "1 0 0", *AXES[2:]), SERIAL)
    assert both.message.endswith("it differs as soon as 'j1' or 'j2' moves")


def test_the_message_has_the_positions() -> None:
    """It names the worst link, how far it is off and the positions of the joints, in degrees or metres."""
    outcome = compared(arm(axis="1 0 0"), ARM, "arm", "wheel")
    assert outcome.message.startswith("'wheel' does not move as in the reference: it is ")
    assert "'shoulder' at " in outcome.message
    assert " degrees" in outcome.message
    assert outcome.unit == "m"
    outcome = compared(serial("0 0 1", kind="prismatic"), serial("0 0 -1", kind="prismatic"))
    assert outcome.message == (
        "'l1' does not move as in the reference: it is 2000 mm and 0 degrees off with 'j1' at -1 m; "
        "it differs as soon as 'j1' moves: its axis is reversed"
    )
    assert (outcome.measured, outcome.expected, outcome.tolerance) == (2.0, 0.0, 0.002)


def test_a_joint_of_another_type_fails() -> None:
    """A joint that slides or is fixed instead of turning fails; revolute and continuous joints turn alike."""
    for kind in ("prismatic", "fixed", "planar", "floating"):
        outcome = compared(Scene(ARM.text.replace('"continuous"', f'"{kind}"')), ARM, "wheel")
        assert outcome.message.startswith(f"the joint is {kind}; it should be continuous (joint 'spin')")
        assert outcome.status == "failed"
    text = arm().text.replace('"continuous">', '"revolute">\n<limit lower="-1" upper="1" effort="1" velocity="1"/>')
    assert compared(Scene(text), ARM, "wheel").status == "passed"


def test_a_joint_that_the_reference_does_not_have_fails() -> None:
    """A link that can also move otherwise does not move as in the reference."""
    fixed = Scene(ARM.text.replace('"continuous"', '"fixed"'))
    outcome = compared(ARM, fixed, "wheel")
    assert outcome.message == "a joint on the chains to 'wheel' has no counterpart in the reference (joint 'spin')"
    assert compared(ARM, fixed, "arm").status == "passed"


def test_a_link_that_is_not_connected_is_missed() -> None:
    """Without a chain of joints from the root there is nothing to compare."""
    with pytest.raises(MissingElement):
        compared(ARM.without_joints(), ARM, "wheel")
    with pytest.raises(MissingElement, match="the pose is undefined"):
        compared(arm(axis="0 0 0"), ARM, "wheel")


def test_a_mistake_of_the_reference_is_not_the_students() -> None:
    """A link that the reference lacks is a mistake of the rubric, not a failure."""
    with pytest.raises(RubricError, match="the reference solution cannot be compared with: there is no link 'nowhere'"):
        compared(Scene(ARM.text.replace('"wheel"', '"nowhere"')), ARM, "nowhere")


def test_what_cannot_be_determined_is_pending() -> None:
    """Several tips leave a selector open."""
    with pytest.raises(NotDecided):
        compared(gripper(rule=""), gripper(), "@tip")


_ASIDE = """<link name="aside"/>
<joint name="spin" type="$(env KIND)"><parent link="base"/><child link="aside"/></joint>
<joint name="glue" type="fixed">"""


@pytest.mark.parametrize(
    ("robot", "old", "new", "link"),
    [
        (ARM, '"continuous"', '"$(env KIND)"', "wheel"),
        (ARM, '<joint name="spin" type="continuous">', _ASIDE, "wheel"),
        (gripper(), 'mimic joint="left"', 'mimic joint="$(env LEADER)"', "right_finger"),
    ],
    ids=["type", "type of a joint elsewhere", "mimic"],
)
def test_what_only_a_run_tells_is_pending(robot: Scene, old: str, new: str, link: str) -> None:
    """Whether a joint whose type or leader xacro leaves open moves as that of the reference is not guessed."""
    text = robot.text.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ').replace(old, new)
    urdf = read_submission(text.encode(), identity="me", path="arm.urdf.xacro").needed_urdf()
    assert urdf.robot is not None
    with pytest.raises(NotDecided, match="is known only at run time"):
        kinematics_match_reference(Configuration(urdf.robot, is_guarded=True), robot.robot, links=[link])


def test_joints_that_follow_nothing() -> None:
    """A joint that mimics itself, or one that does not exist, never moves, unlike that of the reference."""
    for rule in ('<mimic joint="right"/>', '<mimic joint="nobody"/>'):
        outcome = compared(gripper(rule=rule), gripper(), "right_finger")
        assert outcome.status == "failed", outcome


def test_joints_stay_within_the_limits_of_the_reference() -> None:
    """Outside of the reference's range robots may differ: an offset of a full turn, or of what is never reached."""
    narrow = Scene(SERIAL.text.replace('lower="-1" upper="1"', 'lower="0" upper="0"'))
    outcome = compared(serial("0 0 -1", *AXES[1:]), narrow)
    assert outcome.status == "passed"


def test_the_result_is_always_the_same() -> None:
    """Random positions depend on nothing."""
    wrong = serial("0 0 1", "0 1 1", *AXES[2:])
    assert compared(wrong, SERIAL) == compared(Scene(wrong.text), Scene(SERIAL.text))
    assert ask(kinematics_match_reference, arm(axis="1 1 0"), links=["wheel"]).status == "failed"


def test_hostile_robots_are_bounded() -> None:
    """A chain of thousands of joints needs manual grading; numbers that overflow are a failure."""
    long = serial(*["0 0 1"] * 600)
    with pytest.raises(NotDecided, match="more than 500 joints lead to 'l600'"):
        compared(long, SERIAL)
    huge = Scene(ARM.text.replace('xyz="0.5 0.0 0.0"', 'xyz="1e300 0 0"'))
    assert compared(huge, ARM, "wheel").status == "failed"


def test_its_work_is_bounded() -> None:
    """100 samples of an arm with 7 joints take a thousand lines of Python each."""
    robot: Configuration = serial(*AXES, *AXES[:3]).robot
    with limited_work(400_000):
        assert kinematics_match_reference(robot, robot, links=["l7"]).status == "passed"


def test_no_link_hides_another() -> None:
    """A link that is turned within the tolerance does not hide another that is off by more than its own."""
    turned_arm = arm(rpy=(0.0, 0.0, 0.015))  # 0.86 degrees
    moved_too = Scene(turned_arm.text.replace('xyz="0.0 0.0 0.2"', 'xyz="0.0 0.0 0.203"'))
    assert compared(turned_arm, ARM, "arm", "wheel").status == "passed"
    assert compared(moved_too, ARM, "arm", "wheel").status == "failed"
