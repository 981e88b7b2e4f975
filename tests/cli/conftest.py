"""Fixtures: a small class that was graded once; each test gets a copy of it."""

import shutil
from pathlib import Path

import pytest

from tests.classroom.gradebooks import batch, make_class


@pytest.fixture(scope="session")
def graded_class(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a class with its roster, rubric and gradebook. Tests must not change it."""
    top = tmp_path_factory.mktemp("small")
    make_class(top)
    done = batch(top)
    assert done.returncode == 0, done.stderr
    return top


@pytest.fixture
def top(graded_class: Path, tmp_path: Path) -> Path:
    """Return a copy of the class that can be marked and graded again."""
    shutil.copytree(graded_class, tmp_path / "small")
    return tmp_path / "small"
