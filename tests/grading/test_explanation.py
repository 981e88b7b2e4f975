"""A failure is explained by a mistake inside its element only."""

import pytest

from grader.checks.outcome import failed
from grader.grading.explanation import explain
from grader.robot.reader import read_urdf
from grader.source import Location

TEXT = '<robot name="a">\n<link name="x"><visual><orign/></visual></link>\n</robot>\n'


@pytest.mark.parametrize(("line", "column", "is_explained"), [(1, 1, False), (2, 1, True)])
def test_a_mistake_somewhere_in_the_robot_explains_nothing_at_its_tag(
    line: int, column: int, is_explained: bool
) -> None:
    """At the tag of a link, it does."""
    reading = read_urdf(TEXT.encode(), "my_robot.urdf")
    outcome = failed("it is wrong", Location("my_robot.urdf", line, column))
    explained = explain(outcome, reading.problems, reading.source)
    assert ("orign" in explained.message) == is_explained
