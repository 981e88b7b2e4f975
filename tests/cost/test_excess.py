"""What costs more than its row of the table is said, with the names of the modules that came."""

from typing import Any

import pytest

from tests.cost.__main__ import excess

_ROW = {"modules": [f"grader.m{n}" for n in range(40)], "instructions": 1000, "packages": ["lxml"]}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({}, []),
        ({"instructions": 1030}, []),
        ({"instructions": 1031}, ["1.031 times as many instructions; new modules: none"]),
        ({"modules": [*_ROW["modules"], "grader.x"]}, []),  # type: ignore[misc]
        (
            {"modules": [*_ROW["modules"], "grader.x", "grader.y"]},  # type: ignore[misc]
            ["42 modules, not 40; new: ['grader.x', 'grader.y']"],
        ),
        ({"packages": ["lxml", "numpy"]}, ["packages that it did not load: ['numpy']"]),
        ({"instructions": 10, "modules": [], "packages": []}, []),
    ],
)
def test_excess(change: dict[str, Any], said: list[str]) -> None:
    """Up to 3 % more is allowed, and any less."""
    assert excess(_ROW, {**_ROW, **change}) == said
