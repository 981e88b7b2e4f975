"""Completion: the words offered to each shell, in its format, and never an error while the user types."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.command_line import HANG_TIMEOUT, ROOT


@pytest.mark.exhaustive
def test_closed_standard_output_is_no_error() -> None:
    """A shell that closes standard output causes no error."""
    requested = {**os.environ, "_GRADER_COMPLETE": "complete_bash", "COMP_WORDS": "grader g", "COMP_CWORD": "1"}
    for redirected in (">&-", "> /dev/full"):
        command = ["bash", "-c", f'"{sys.executable}" -m grader {redirected}']
        done = subprocess.run(command, cwd=ROOT, env=requested, capture_output=True, check=False, timeout=HANG_TIMEOUT)
        assert (done.returncode, done.stderr) == (0, b"")


def in_shell(tmp_path: Path, shell: str, *lines: str) -> "subprocess.CompletedProcess[bytes]":
    """Run lines in bash under the name of a shell, which the grader detects, with `grader` on the path."""
    (tmp_path / "bin").mkdir(exist_ok=True)
    program = tmp_path / "bin" / "grader"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m grader "$@"\n')
    program.chmod(0o755)
    named = tmp_path / shell
    named.symlink_to(shutil.which("bash") or "bash")
    variables = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}", "HOME": str(tmp_path)}
    command = [str(named), "--norc", "--noprofile", "-c", "\n".join((*lines, "exit $code"))]
    return subprocess.run(command, cwd=ROOT, env=variables, capture_output=True, check=False, timeout=HANG_TIMEOUT)


ASK = """
ask() {
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    _grader_completion "$1"
    echo "${COMPREPLY[*]}"
}
"""


@pytest.mark.exhaustive
def test_a_real_bash(tmp_path: Path) -> None:
    """It sources the script that is shown for it, and completes."""
    lines = ("ask grader ex", "ask grader rubric sh")
    done = in_shell(tmp_path, "bash", 'eval "$(grader --show-completion; true)"', ASK, *lines, "code=0")
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.decode().splitlines() == ["export explain", "show"]


@pytest.mark.exhaustive
def test_installation(tmp_path: Path) -> None:
    """The rest of the shell's start-up file is kept; a shell that is not known is refused."""
    (tmp_path / ".bashrc").write_text("alias ll='ls -l'\n")
    done = in_shell(tmp_path, "bash", "grader --install-completion", "code=$?")
    assert (done.returncode, done.stderr) == (0, b"")
    assert f"bash completion installed in {tmp_path / '.bash_completions/grader.sh'}" in done.stdout.decode()
    lines = (tmp_path / ".bashrc").read_text().split("\n")
    assert [line for line in lines if line] == [
        "alias ll='ls -l'",
        f"source '{tmp_path / '.bash_completions/grader.sh'}'",
    ]
    refused = in_shell(tmp_path, "sh", "grader --install-completion", "code=$?")
    assert refused.returncode == 2
    assert b"Shell sh is not supported." in refused.stdout + refused.stderr
