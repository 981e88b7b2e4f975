"""A failure is explained by a mistake inside its element only."""

import pytest

from grader.base.source import Location
from grader.lab.checks.outcome import failed
from grader.lab.grading.explanation import explain
from grader.ros.urdf.reader import read_urdf

pytestmark = pytest.mark.slow

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


STRAY = '<robot name="a">\n<link name="x"><visual/><material/></link>\n<link name="y"><material/></link></robot>\n'


@pytest.mark.parametrize(
    ("column", "looks_at", "part", "is_explained"),
    [
        (16, ("material",), "", True),
        (16, ("visual",), "", False),
        (1, ("material",), "", True),
        (1, ("visual",), "", False),
        (1, ("material",), "connection", False),
        (1, ("material",), "robot of the lab", False),
    ],
)
def test_a_material_in_a_wrong_place_explains_a_missing_colour_of_its_link_only(
    column: int, looks_at: tuple[str, ...], part: str, is_explained: bool
) -> None:
    """It explains no shape, no missing link and no missing joint."""
    reading = read_urdf(STRAY.encode(), "my_robot.urdf")
    outcome = failed("it is wrong", Location("my_robot.urdf", 2, column))
    explained = explain(outcome, reading.problems, reading.source, looks_at, part, "x")
    assert explained.location == (
        Location("my_robot.urdf", 2, 25) if is_explained else outcome.location
    )
