"""What numbers that ROS 2 cannot read may stand for."""

import pytest

from grader.robot.edits.readable import is_readable, readable_values

NUMBERS = (
    ("xyz", "0,15 0 0,225", "0.15 0 0.225", "a decimal comma"),
    ("xyz", "0.15,0,0.225", "0.15 0 0.225", "commas between numbers"),
    ("xyz", "0,15; 0; 0,225", "0.15 0 0.225", "commas between numbers"),
    ("xyz", "- 0.15 0.2 0", "-0.15 0.2 0", "a space after a sign"),
    ("xyz", "-0.15 -0..225 0.0", "-0.15 -0.225 0.0", "an extra decimal point"),
    ("xyz", "--0.15 0 O", "-0.15 0 0", "a double sign"),
    ("xyz", "(0.15, 0, 0.225)", "0.15 0 0.225", "quotes or brackets around numbers"),
    ("size", "600mm 400mm 200mm", "0.6 0.4 0.2", "a unit after a number"),
    ("rpy", "-90\u00b0 0 0", "-1.5708 0 0", "a unit after a number"),
    ("rpy", "pi/2 0 ${-pi / 2}", "1.5708 0 -1.5708", "an expression, which ROS 2 does not evaluate"),
    ("radius", "0.2/2", "0.1", "an expression, which ROS 2 does not evaluate"),
    ("rgba", "0,0.6,0,1", "0 0.6 0 1", "commas between numbers"),
    ("rgba", "0 153 0 255", "0 0.6 0 1", "the range of the colour: 0..255, not 0..1"),
    ("rgba", "0, 153, 0", "0 0.6 0 1", "commas between numbers"),
)


@pytest.mark.parametrize(("attribute", "text", "meant", "cause"), NUMBERS)
def test_numbers_are_written_as_ros_reads_them(attribute: str, text: str, meant: str, cause: str) -> None:
    """Numbers that ROS 2 cannot read are written as it reads them, named by the first mistake in them."""
    assert not is_readable(attribute, text)
    found, cause_of, _ = next(readable_values(attribute, text))
    assert is_readable(attribute, found)
    assert (found, cause_of) == (meant, cause)


@pytest.mark.parametrize(
    "text", ["0.15 zero 0", "0 0", "", "half of it", "${width} 0 0", "().__class__ 0 0", "9**9**9 0 0"]
)
def test_numbers_are_not_guessed(text: str) -> None:
    """What is no number stands for nothing; numbers that are there are kept, in the count that is needed."""
    assert {cause for _, cause, _ in readable_values("xyz", text)} <= {"the count of numbers in xyz"}


@pytest.mark.parametrize("text", ["0 0 0.1", " 0.15 0 .2e1", "+1 -2 3."])
def test_numbers_that_ros_reads_need_no_repair(text: str) -> None:
    """Numbers that ROS 2 reads are left as they are."""
    assert is_readable("xyz", text)
