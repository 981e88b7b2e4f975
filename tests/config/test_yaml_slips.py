"""Lines of YAML that cannot be read, and what they can only mean."""

import pytest

from grader.base.element_edits import edited
from grader.ros.config.yaml_slips import yaml_slips

_RIGHT = """\
driver:
  ros__parameters:
    wheels: [left, right]
    radius: 0.05
    frame: "base" # of the body
    port: /dev/ttyUSB0
"""


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("wheels: [left, right]", "wheels: [left, right"),
        ("wheels: [left]", "wheels: - left"),
        ("radius: 0.05", "radius = 0.05"),
        ("radius: 0.05", "radius 0.05"),
        ("    radius: 0.05", "      radius: 0.05"),
        ("    radius: 0.05", "   radius: 0.05"),
        ("    radius: 0.05", "\tradius: 0.05"),
        ("radius: 0.05", "radius:0.05"),
        ('"base" #', '"base #'),
    ],
)
def test_a_line_is_read_as_it_can_only_be_meant(right: str, wrong: str) -> None:
    """One edit makes the file again what it was."""
    before = _RIGHT.replace("wheels: [left, right]", right) if "wheels" in right else _RIGHT
    [slip] = yaml_slips(before.replace(right, wrong).encode(), "driver.yaml")
    assert slip.is_refused
    assert edited(before.replace(right, wrong), "driver.yaml", slip.edits) == before


@pytest.mark.parametrize(
    "text",
    [
        _RIGHT,
        _RIGHT.replace("radius: 0.05", "a radius of 0.05"),
        _RIGHT.replace("radius: 0.05", "- 0.05"),
        "a: b: c\n",
        "[" * 50,
    ],
)
def test_what_may_mean_several_things_is_left(text: str) -> None:
    """No edit is made up."""
    assert yaml_slips(text.encode(), "driver.yaml") == []
