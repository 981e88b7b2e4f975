"""The outcomes of all checks in their cases, and the facts of references."""

import pytest

from tests.golden.outcomes import FILES, ROWS


@pytest.mark.parametrize("name", ROWS)
def test_outcomes_are_unchanged(name: str) -> None:
    """What the checks find in their cases is approved, with all that they measure and where."""
    assert [*ROWS[name]()] == FILES[name].read_text(encoding="utf-8").splitlines()
