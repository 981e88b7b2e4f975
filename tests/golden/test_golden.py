"""The golden cases, run through the real command line."""

import pytest

from tests.command_line import run
from tests.golden.cases import GOLDEN, Golden


@pytest.mark.parametrize("case", GOLDEN, ids=lambda case: case.name)
def test_output_is_unchanged(case: Golden) -> None:
    """Output and exit code are the approved ones; standard error is empty."""
    done = run(case.arguments, **case.variables)
    assert done.stdout.decode() == case.file.read_text(encoding="utf-8")
    assert (done.returncode, done.stderr) == (case.exit_code, b"")
