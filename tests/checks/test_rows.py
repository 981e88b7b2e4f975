"""What checks find in the rows of the corpus: as the criterion of a rubric, and alone."""

import pytest

from grader.lab.checks.registry import own_checks
from tests.checks.rows import CORPUS, Row, read_rows


@pytest.mark.every(kind=lambda row: row.check.name)
@pytest.mark.parametrize("row", list(read_rows()), ids=lambda row: row.name)
def test_a_row(row: Row) -> None:
    """Status, message, what was measured and the place are the expected ones; `python -m tests.checks` writes them again."""
    assert row.found() == row.expected


def test_every_check_has_rows() -> None:
    """A check without rows is held by nothing."""
    assert {path.stem for path in CORPUS.glob("*.toml")} == {check.name for check in own_checks()}
