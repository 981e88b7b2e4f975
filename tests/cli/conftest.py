"""Fixtures: a small class that was graded once; each test gets a copy of it."""

import shutil
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.classroom.gradebooks import HOSTILE, batch, make_class


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


@pytest.fixture
def hostile_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Install the plug-in whose check misbehaves as the robot's name says."""
    monkeypatch.syspath_prepend(HOSTILE)


@pytest.fixture(autouse=True)
def unwatched(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have a command that watches a file end instead of waiting: it is interrupted."""

    def interrupt(_seconds: float) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(
        "grader.app.commands.repeating.time",
        SimpleNamespace(sleep=interrupt, monotonic=time.monotonic),
    )
