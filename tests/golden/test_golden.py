"""The golden cases, run through the real command line."""

import pytest

from tests.command_line import run_process
from tests.golden.cases import GOLDEN, Golden


@pytest.mark.parametrize("case", GOLDEN, ids=lambda case: case.name)
def test_output_is_unchanged(case: Golden) -> None:
    """Output and exit code are the approved ones; standard error is empty."""
    done = run_process(case.arguments, variables=case.variables)
    assert done.stdout.decode() == case.file.read_text(encoding="utf-8")
    assert (done.returncode, done.stderr) == (case.exit_code, b"")


@pytest.mark.parametrize("kind", ["json", "html", "svg"])
def test_output_is_deterministic(kind: str) -> None:
    """Hash seeds, time zones and locales change nothing."""
    arguments = ("grade", "submissions/several-mistakes/my_robot.urdf", "--format", kind)
    one = run_process(arguments, variables={"PYTHONHASHSEED": "1", "TZ": "UTC", "LANG": "C"})
    other = run_process(arguments, variables={"PYTHONHASHSEED": "2", "TZ": "Asia/Tokyo", "LANG": "C.UTF-8"})
    assert one.stdout == other.stdout
