"""Lists that code sets fields to: up to Iron, rclpy refuses integers among floats."""

import json
from pathlib import Path

import pytest

from tests.command_line import run
from tests.workspace.rule_examples import files_of_variant

_CODE = """\
from sensor_msgs.msg import Imu
imu = Imu()
imu.orientation_covariance = [0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1]
"""


@pytest.mark.parametrize(
    ("options", "severity"),
    [(("--distro", "humble"), ["error"]), ((), ["warning"]), (("--distro", "jazzy"), [])],
)
def test_an_integer_among_floats(
    tmp_path: Path, options: tuple[str, ...], severity: list[str]
) -> None:
    """It is an error in Humble, none in Jazzy, and a warning where no release is stated."""
    for path, text in files_of_variant({"of": "field-value", "text": _CODE}).items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    data = json.loads(run(("inspect", tmp_path, "--format", "json", *options)).stdout)
    problems = [each for each in data["problems"] if each["rule"] == "field-value"]
    assert [each["severity"] for each in problems] == severity
    assert all("an item is '0', an integer" in each["message"] for each in problems)
