"""What went wrong is told in words that are the same for all who made the same mistake."""

import pytest

from grader.checks.outcome import Outcome
from grader.classroom.gradebook.failures import kind_of_miss
from grader.grading.grade import grade
from grader.submission.submission import read_submission
from tests.samples import LAB6, ROOT

SAMPLES = ("lidar-buried", "right-wheel-mirrored", "wheel-joint-fixed", "wheels-rolling-sideways", "lidar-turning")
JOINTS = ("base_lidar_joint", "base_left_wheel_joint", "base_right_wheel_joint", "base_caster_wheel_joint")


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("joint 'a' is fixed, expected continuous", "the joint is fixed, expected continuous"),
        ("there is no joint 'a'", "there is no joint 'a'"),  # that is what is wrong
        ("it is red, in line 12", "it is red"),
        ("joint \"it's\" and joint 'a\\'b\"c' turn", "the joint and the joint turn"),
        ("it is white (URDF031: the colour has 3 numbers)", "it is white"),
        ("there is no link 'lidar'; the robot has: 'lidr', 'base_link'", "there is no link 'lidar'"),
        ("there is no link 'lidar'; did you mean 'lidr'?", "there is no link 'lidar'"),
        ("x" * 1000, "x" * 200),
    ],
)
def test_what_differs_between_students_is_left_out(said: str, told: str) -> None:
    """Names of joints, line numbers, ROS 2's reasons, what else there is."""
    assert kind_of_miss(Outcome("failed", said)) == told


def misses(text: str) -> dict[str, str]:
    """What each failed criterion of a URDF came to."""
    report = grade(LAB6, read_submission(text.encode(), identity="student", path="my_robot.urdf"))
    failed = [each for each in report.results if each.outcome.status == "failed"]
    return {each.criterion.id: kind_of_miss(each.outcome) for each in failed}


@pytest.mark.parametrize("name", SAMPLES)
def test_names_and_lines_do_not_split_a_group(name: str) -> None:
    """The same mistake in a file with other names of joints, and with more lines before it, is the same group."""
    text = (ROOT / "submissions" / name / "my_robot.urdf").read_text()
    other = text.replace("<link", "\n\n\n<link")
    for number, joint in enumerate(JOINTS):
        other = other.replace(joint, f"it's #{number}" if number % 2 else f"j{number}")
    mine, theirs = misses(text), misses(other)
    assert mine
    assert mine == {name: words for name, words in theirs.items() if name != "joint-names"}
