"""On macOS and Windows `grade` works: it needs nothing that only POSIX systems or Linux have."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT

REFERENCE = ROOT / "submissions/lab6/reference"
# A process without everything that Windows' Python lacks.
_WITHOUT = """
import os, signal, sys
for name in ("fcntl", "resource", "pwd", "grp", "termios", "tty", "syslog"):
    sys.modules[name] = None
os.supports_dir_fd = set()
for module, names in ((os, ("O_NOFOLLOW", "O_DIRECTORY", "O_NONBLOCK", "O_CLOEXEC", "fork", "getuid", "mkfifo")),
                      (signal, ("SIGKILL", "setitimer", "pthread_sigmask", "alarm"))):
    for name in names:
        if hasattr(module, name):
            delattr(module, name)
from grader.__main__ import main
sys.argv = ["grader", *sys.argv[1:]]
main()
"""


def elsewhere(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """Run the command line as on a system without POSIX functions."""
    command = [sys.executable, "-W", "error", "-c", _WITHOUT, *map(str, arguments)]
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        timeout=HANG_TIMEOUT,
        env={**os.environ, "COLUMNS": "80"},
    )


@pytest.mark.exhaustive
@pytest.mark.parametrize("kind", ["folder", "zip", "urdf"])
def test_grade_needs_nothing_of_posix(tmp_path: Path, kind: str) -> None:
    """A folder, an archive and a URDF get the same report as here."""
    path = REFERENCE
    if kind == "zip":
        path = Path(shutil.make_archive(str(tmp_path / "lab6"), "zip", REFERENCE))
    elif kind == "urdf":
        path = ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf"
    done = elsewhere("grade", path, "--format", "json")
    assert (done.returncode, done.stderr) == (0, "")
    first = subprocess.run(
        [sys.executable, "-m", "grader", "grade", str(path), "--format", "json"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout == first.stdout


@pytest.mark.exhaustive
def test_no_symlink_is_followed(tmp_path: Path) -> None:
    """A symlink in the submission is named, wherever it leads, and its target is graded only as the file that it is."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "secret.urdf").write_text("<robot name='a'/>")
    (tmp_path / "sub/my_robot.urdf").symlink_to("../secret.urdf")
    done = elsewhere("grade", tmp_path / "sub")
    assert "my_robot.urdf' is a symlink, and was not followed" in done.stderr
    (tmp_path / "sub/inner.urdf").write_bytes(
        (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_bytes()
    )
    done = elsewhere("grade", tmp_path / "sub")
    assert "lab6: inner.urdf" in done.stdout
    assert "70/100" in done.stdout
