"""The key of a parameter in a line of YAML."""

import pytest

from grader.app.editor.parameter_keys import ParameterKey, parameter_key

_FILE = """\
/**/amcl:
  ros__parameters:
    alpha1: 0.2
    # a comment
    initial_pose:
      x: 0.0
      ya
controller_manager:
  ros__parameters:
    update_rate: 100
    list:
      - a
    arm: {type: x}
other: 1
"""


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (0, None),
        (1, None),
        (2, ParameterKey("amcl", "", "alpha1")),
        (5, ParameterKey("amcl", "initial_pose.", "x")),
        (6, ParameterKey("amcl", "initial_pose.", "ya")),
        (9, ParameterKey("controller_manager", "", "update_rate")),
        (12, ParameterKey("controller_manager", "", "arm")),
        (13, None),
    ],
)
def test_finds_the_node(number: int, expected: ParameterKey | None) -> None:
    lines = _FILE.split("\n")
    assert parameter_key(lines[:number], lines[number]) == expected


def test_has_a_whole_name() -> None:
    assert ParameterKey("amcl", "initial_pose.", "x").name == "initial_pose.x"
