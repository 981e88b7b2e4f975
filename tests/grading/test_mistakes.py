"""Mistakes: the same text for all students who made the same mistake, so that statistics can count them."""

import pytest

from grader.lab.grading.grade import grade
from grader.lab.submission.opening import read_submission
from tests.samples import LAB6, ROOT

pytestmark = pytest.mark.slow

SAMPLES = (
    "lidar-buried",
    "right-wheel-mirrored",
    "wheel-joint-fixed",
    "wheels-rolling-sideways",
    "lidar-turning",
)
JOINTS = (
    "base_lidar_joint",
    "base_left_wheel_joint",
    "base_right_wheel_joint",
    "base_caster_wheel_joint",
)


def mistakes(text: str) -> dict[str, str]:
    """Return the mistake of each failed criterion of a URDF."""
    report = grade(LAB6, read_submission(text.encode(), identity="student", path="my_robot.urdf"))
    outcomes = {result.criterion.id: result.outcome for result in report.results}
    return {
        name: outcome.mistake or outcome.message
        for name, outcome in outcomes.items()
        if outcome.status == "failed"
    }


@pytest.mark.parametrize("name", SAMPLES)
def test_names_and_lines_do_not_split_a_group(name: str) -> None:
    """The same mistake in a file with other names of joints, and with more lines before it, is the same group."""
    text = (ROOT / "submissions/lab6" / name / "my_robot/urdf/my_robot.urdf").read_text()
    other = text.replace("<link", "\n\n\n<link")
    for number, joint in enumerate(JOINTS):
        other = other.replace(joint, f"it's #{number}" if number % 2 else f"j{number}")
    mine, theirs = mistakes(text), mistakes(other)
    assert mine
    assert mine == {name: mistake for name, mistake in theirs.items() if name != "joint-names"}
