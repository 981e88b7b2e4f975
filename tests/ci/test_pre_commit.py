"""pre-commit runs the check before a commit in a student's repository."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.ci.conftest import git, repository
from tests.command_line import HANG_TIMEOUT, ROOT

pytestmark = pytest.mark.exhaustive


def test_a_commit_with_a_mistake_is_rejected(tmp_path: Path, published: Path) -> None:
    """A robot with a mistake cannot be committed, a correct one can; the hook's arguments are those of the grader."""
    work = tmp_path / "work"
    shutil.copytree(ROOT / "submissions/lab6/several-mistakes/my_robot/urdf", work)
    (work / ".pre-commit-config.yaml").write_text(
        f"repos:\n  - repo: {published.as_uri()}/YOUR-ORG/grader\n    rev: v1\n    hooks:\n"
        "      - id: grader\n        args: [--rubric, lab6, --part, task1]\n",
        encoding="utf-8",
    )
    repository(work)
    held = _commit(work, tmp_path / "home")
    assert held.returncode == 1
    assert "lidar-frame" in held.stdout
    assert "43/70" in held.stdout
    (work / "my_robot.urdf").write_bytes(
        (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_bytes()
    )
    git(work, "add", "--all")
    let_through = _commit(work, tmp_path / "home")
    assert let_through.returncode == 0, let_through.stdout + let_through.stderr


def _commit(work: Path, home: Path) -> subprocess.CompletedProcess[str]:
    """Run pre-commit as at a commit; installed hooks are cached for the next run."""
    return subprocess.run(
        [sys.executable, "-m", "pre_commit", "run", "--all-files"],
        cwd=work,
        env={**os.environ, "PRE_COMMIT_HOME": str(home)},
        capture_output=True,
        text=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )
