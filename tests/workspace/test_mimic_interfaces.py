"""Command interfaces of joints that mimic others: of the stated release, or of any."""

import json
from pathlib import Path

import pytest

from tests.command_line import run
from tests.workspace.rule_examples import files_of_rule

_RELEASES = [
    ((), "from Jazzy on, ros2_control loads no robot", "warning"),
    (("--distro", "jazzy"), "ros2_control loads no robot", "error"),
    (("--distro", "humble"), "", ""),
]


@pytest.mark.parametrize(("options", "message", "severity"), _RELEASES)
def test_releases(options: tuple[str, ...], message: str, severity: str, tmp_path: Path) -> None:
    """The releases before Jazzy read no <mimic>; without a release it is a warning."""
    for path, text in files_of_rule("mimic-command", "wrong").files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    printed = run(("inspect", tmp_path, "--format", "json", *options)).stdout
    found = [each for each in json.loads(printed)["problems"] if each["rule"] == "mimic-command"]
    assert len(found) == bool(message)
    for problem in found:
        assert problem["message"].startswith(message)
        assert problem["severity"] == severity
