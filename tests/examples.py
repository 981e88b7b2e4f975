"""How many examples are tried: few in the suite, where they are always the same, more where CI searches for others."""

from collections.abc import Callable, Iterable
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

_MORE = 5


def spread(rows: Iterable[Any], count: int) -> list[Any]:
    """Return the rows of a long table as parameters: some from all over it, and the others for CI only."""
    listed = list(rows)
    step = max(1, len(listed) // count)
    return [row if index % step == 0 else _exhaustive(row) for index, row in enumerate(listed)]


def light(rows: Iterable[Any], is_costly: Callable[[Any], bool]) -> list[Any]:
    """Return the rows of a table as parameters, those that cost seconds for CI only."""
    return [_exhaustive(row) if is_costly(row) else row for row in rows]


def _exhaustive(row: Any) -> Any:
    values = row if isinstance(row, tuple) and not hasattr(row, "_fields") else (row,)
    return pytest.param(*values, marks=pytest.mark.exhaustive)


def examples(count: int) -> settings:
    """Return settings for so many examples, or for five times as many with the profile `random`."""
    many = count if settings().derandomize else _MORE * count
    return settings(max_examples=many, deadline=None, suppress_health_check=[HealthCheck.too_slow])
