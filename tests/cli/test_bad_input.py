"""Files and streams that no case of the corpus can have: one clear line on standard error, and no traceback."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.command_line import HANG_TIMEOUT, ROOT, run


@pytest.mark.parametrize("command", ["grade", "inspect"])
def test_a_file_that_cannot_be_read(command: str, tmp_path: Path) -> None:
    """A named pipe that nobody writes to, and a file without read permission, which root may read all the same."""
    os.mkfifo(tmp_path / "pipe.urdf")
    (tmp_path / "secret.urdf").touch(mode=0o000)
    for name, words in (
        ("pipe.urdf", b"not a regular file"),
        ("secret.urdf", b"Permission denied"),
    ):
        if name == "pipe.urdf" or os.geteuid() != 0:
            done = run((command, tmp_path / name))
            assert (done.returncode, done.stdout, done.stderr.count(b"\n")) == (2, b"", 1)
            assert words in done.stderr


@pytest.mark.parametrize(
    "data",
    [
        bytes(range(256)) * 40,
        b"<robot name='a'>" + b"<a>" * 100_000,
        b"<robot>" + b"<a>" * 10**5 + b"</a>" * 10**5,
    ],
)
def test_a_hostile_file_gets_a_report(data: bytes, tmp_path: Path) -> None:
    """Bytes that are no text, and tags that are nested without end."""
    (tmp_path / "my_robot.urdf").write_bytes(data)
    done = run(("grade", tmp_path / "my_robot.urdf"))
    assert (done.returncode, done.stderr) == (1, b"")
    assert b"\n0/70" in done.stdout
    assert run(("inspect", tmp_path / "my_robot.urdf")).returncode == 1


@pytest.mark.slow
@pytest.mark.parametrize("form", ["terminal", pytest.param("json", marks=pytest.mark.exhaustive)])
def test_closed_standard_output(form: str) -> None:
    """One line on standard error and exit code 2, whether it was closed before or during the output."""
    command = f'"{sys.executable}" -m grader grade submissions/lab6/reference --format {form}'
    for redirected in (
        f"{command} >&-",
        f"({command}; echo $? >&2) | true",
        f"{command} > /dev/full",
    ):
        done = _in_bash(redirected, ROOT)
        assert b"standard output" in done.stderr or b"| true" in redirected.encode(), done.stderr
        assert b"Traceback" not in done.stderr
        if "|" not in redirected:
            assert (done.returncode, done.stderr.count(b"\n")) == (2, 1)


@pytest.mark.exhaustive
def test_a_deleted_current_folder(tmp_path: Path) -> None:
    """A report needs no current folder."""
    (tmp_path / "gone").mkdir()
    urdf = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"
    done = _in_bash(
        f"rmdir ../gone; '{sys.executable}' -m grader grade {urdf} --format github",
        tmp_path / "gone",
    )
    assert (done.returncode, done.stderr) == (1, b"")


def _in_bash(line: str, folder: Path) -> "subprocess.CompletedProcess[bytes]":
    return subprocess.run(
        ["bash", "-c", line], cwd=folder, capture_output=True, check=False, timeout=HANG_TIMEOUT
    )
