"""A check that reads what xacro leaves open needs manual grading, whatever it does with it; other fields are as any."""

from collections.abc import Callable
from decimal import Decimal
from pathlib import Path

import pytest

from grader.lab.checks.check import describe
from grader.lab.checks.outcome import Outcome, judged
from grader.lab.grading.grade import grade
from grader.lab.rubric.criterion import Criterion, Part
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.opening import read_submission
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Link, Robot

MASS = """<robot name="r" xmlns:xacro="x">
<link name="base_link"><inertial><mass value="$(env MASS)"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<link name="wheel"/>
<joint name="j" type="continuous"><parent link="base_link"/><child link="wheel"/><xacro:if value="$(env M)"><mimic joint="k"/></xacro:if></joint>
</robot>"""
INCLUDE = '<robot name="r" xmlns:xacro="x"><xacro:include filename="$(find other)/a.xacro"/><link name="base_link"/></robot>'

# What a check asks of a robot, the robot, and the status of its criterion.
ASKED: dict[str, tuple[Callable[[Configuration], object], str, str]] = {
    "a sum over all links": (
        lambda it: sum(link.inertial.mass for link in it.robot.links if link.inertial is not None),
        MASS,
        "pending",
    ),
    "whether a joint mimics another": (
        lambda it: it.robot.joint("j").mimic is None,
        MASS,
        "pending",
    ),
    "the text of a part": (lambda it: f"{it.link('base_link').inertial}", MASS, "pending"),
    "another field of the link": (lambda it: it.link("base_link").visuals, MASS, "passed"),
    "the type of the joint": (lambda it: it.robot.joint("j").type, MASS, "passed"),
    "the pose of the link": (lambda it: it.pose("base_link"), MASS, "passed"),
    "all links": (lambda it: [*it.robot.links], INCLUDE, "pending"),
    "all joints": (lambda it: len(it.robot.joints), INCLUDE, "pending"),
    "whether a link is there": (lambda it: it.robot.has_link("lidar"), INCLUDE, "pending"),
    "a link that may be there": (lambda it: it.link("lidar"), INCLUDE, "pending"),
    "a link that is there": (lambda it: it.link("base_link"), INCLUDE, "passed"),
}


@pytest.mark.parametrize("name", ASKED)
def test_what_is_open_needs_manual_grading(name: str) -> None:
    """No check asks whether a value is open: reading it is enough, and its criterion needs manual grading."""
    ask, text, status = ASKED[name]

    def reads(robot: Configuration) -> Outcome:
        """A check that reads a value."""
        ask(robot)
        return judged(True, "it was read")

    criterion = Criterion("only", "Only", "a", Decimal(1), describe(reads), {})
    rubric = Rubric(
        "r", "R", (Part("a", "A"),), (criterion,), "robot.urdf", "", b"", Path("r.toml")
    )
    submission = read_submission(text.encode(), identity="a", path="my_robot.urdf.xacro")
    assert grade(rubric, submission).results[0].outcome.status == status


@pytest.mark.parametrize("value", [Link("a"), Robot("r")])
def test_a_field_that_does_not_exist(value: object) -> None:
    """It is an AttributeError, as of any object."""
    assert not hasattr(value, "colour")
