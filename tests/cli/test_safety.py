"""A student's files are read and never run, whatever their names and wherever the grader starts."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.command_line import HANG_TIMEOUT, run
from tests.samples import ROOT

REFERENCE = ROOT / "submissions/lab6/reference"
# Modules that the grader or its dependencies import late.
MODULES = (
    "yaml",
    "docx",
    "pypdf",
    "ast",
    "zipfile",
    "lxml",
    "numpy",
    "rich",
    "typer",
    "glob",
    "xacro",
    "launch",
)


@pytest.fixture
def trapped(tmp_path: Path) -> Path:
    """Return a submission full of modules and code that leave a trace when imported or run."""
    folder = tmp_path / "handed-in"
    shutil.copytree(REFERENCE, folder)
    package = folder / "roscourse_sim_ws/src/my_robot"
    mark = f"open({str(tmp_path / 'ran')!r}, 'w').close()\n"
    for target in (folder, package):
        for name in MODULES:
            (target / f"{name}.py").write_text(mark)
    for path in (package / "setup.py", package / "launch/my_robot_rviz.launch.py"):
        path.write_text(mark + path.read_text())
    (folder / "more.docx").write_bytes(b"PK\x03\x04")
    (folder / "more.pdf").write_bytes(b"%PDF-1.7\n")
    return folder


_EVERYWHERE = [
    pytest.param(".", ["-m", "grader"], marks=pytest.mark.exhaustive),
    pytest.param(
        ".", ["-P", "-c", "from grader.__main__ import main; main()"], marks=pytest.mark.exhaustive
    ),
    ("roscourse_sim_ws/src/my_robot", ["-m", "grader"]),
]


@pytest.mark.parametrize(("start", "command"), _EVERYWHERE)
def test_nothing_of_a_submission_is_imported_or_run(
    trapped: Path, start: str, command: list[str]
) -> None:
    """Even if the grader starts in the student's folder, which Python searches for modules first."""
    done = subprocess.run(
        [sys.executable, *command, "grade", str(trapped), "--format", "json"],
        cwd=trapped / start,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )
    assert done.returncode == 1  # what setup.py does in the end cannot be determined statically
    assert done.stderr.startswith(
        b"grader: exit code 1: cannot be determined, and needs manual grading: "
    )
    assert done.stderr.count(b"\n") == 1
    assert not (trapped.parent / "ran").exists()


def test_nothing_is_written(trapped: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The submission is unchanged, and no temporary file remains."""
    before = sorted(trapped.rglob("*"))
    temporary = trapped.parent / "temporary"
    temporary.mkdir()
    archive = shutil.make_archive(str(trapped.parent / "lab6"), "gztar", trapped)
    monkeypatch.setattr("tempfile.tempdir", str(temporary))
    for path in (trapped, archive):
        assert run(("grade", path)).returncode == 1
    assert sorted(trapped.rglob("*")) == before
    assert list(temporary.iterdir()) == []
