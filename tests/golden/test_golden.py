"""The golden cases, run through the real command line, and the outcomes of the samples."""

import pytest

from tests.command_line import run
from tests.golden.cases import GOLDEN, Golden
from tests.golden.outcomes import FILES, ROWS


@pytest.mark.parametrize("case", GOLDEN, ids=lambda case: case.name)
def test_output_is_unchanged(case: Golden) -> None:
    """Output and exit code are the approved ones; standard error is empty."""
    done = run(case.arguments, **case.variables)
    assert done.stdout.decode() == case.file.read_text(encoding="utf-8")
    assert (done.returncode, done.stderr) == (case.exit_code, b"")


@pytest.mark.parametrize("name", ROWS)
def test_outcomes_are_unchanged(name: str) -> None:
    """What the checks find in the samples and in references is approved, with all that they measure and where."""
    assert [*ROWS[name]()] == FILES[name].read_text(encoding="utf-8").splitlines()
