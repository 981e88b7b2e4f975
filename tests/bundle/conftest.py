"""Fixtures: one bundle for all tests, unpacked once with an environment; each test gets its own folders around it."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.bundle.gradescope import Autograder, environment_for, unpacked
from tests.classroom.gradebooks import grader


@pytest.fixture(scope="session")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the zip that the command line writes."""
    path = tmp_path_factory.mktemp("bundle") / "autograder.zip"
    done = grader("bundle", "gradescope", path)
    assert (done.returncode, done.stderr) == (0, "")
    return path


@pytest.fixture(scope="session")
def source(bundle: Path) -> Path:
    """Return the folder of the unpacked bundle. Tests must not change it."""
    return unpacked(bundle, bundle.parent / "source")


@pytest.fixture(scope="session")
def environment(source: Path) -> Path:
    """Return a virtual environment with the bundle's dependencies. Tests must not change it."""
    return environment_for(source, source.parent / "venv")


@pytest.fixture
def autograder(tmp_path: Path, source: Path, environment: Path) -> Autograder:
    """Return Gradescope's folders with the bundle in them."""
    return Autograder(tmp_path / "autograder", source, environment)


@pytest.fixture
def with_grader(tmp_path: Path, source: Path) -> Callable[..., Autograder]:
    """Return a function that makes Gradescope's folders with another program in place of the grader."""

    def make(program: str, seconds: float = 60) -> Autograder:
        other = tmp_path / "source"
        (other / "grader").mkdir(parents=True)
        (other / "grader" / "__main__.py").write_text(program)
        (other / "autograder.json").write_text(
            f'{{"rubric": "lab6", "sha256": "", "seconds": {seconds}}}'
        )
        for name in ("autograder.py", "run_autograder"):
            (other / name).write_bytes((source / name).read_bytes())
            (other / name).chmod(0o755)
        return Autograder(tmp_path / "autograder", other, environment_for(other, tmp_path / "venv"))

    return make
