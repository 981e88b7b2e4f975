"""What `grader batch` refuses gives one clear line on standard error and exit code 2, and nothing is lost."""

import os
from pathlib import Path

import pytest

from tests.classroom.class_runs import counted, grader, urdf_class, verdicts


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Make a class of three."""
    return urdf_class(tmp_path / "class", 3)


def refused(*arguments: str | Path) -> str:
    """Return the single line in which a command is refused."""
    done = grader(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    *before, line = done.stderr.splitlines()
    assert all(message.startswith("grader: ") for message in (*before, line))
    assert "Traceback" not in done.stderr
    return line.removeprefix("grader: ")


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is closed to root")
def test_a_read_only_gradebook(folder: Path, tmp_path: Path) -> None:
    """A file without write permission is reported."""
    path = tmp_path / "lab6"
    assert grader("batch", folder, "--gradebook", path).returncode == 0
    (path / "results.jsonl").chmod(0o400)
    assert "results.jsonl: Permission denied" in refused("batch", folder, "--gradebook", path, "--force")


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is closed to root")
def test_a_submission_without_read_permission(folder: Path, tmp_path: Path) -> None:
    """It is unreadable, the others are graded, and it is graded once it may be read."""
    (folder / "closed").mkdir()
    (folder / "closed").chmod(0)
    book = tmp_path / "lab6"
    done = grader("batch", folder, "--gradebook", book)
    assert (done.returncode, verdicts(book)["closed"]) == (0, "unreadable")
    (folder / "closed").chmod(0o700)
    (folder / "closed/my_robot.urdf").write_text("<robot name='a'><link name='b'/></robot>")
    assert counted(grader("batch", folder, "--gradebook", book)) == "1 graded, 3 unchanged"
