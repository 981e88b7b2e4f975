"""Completion: the words offered to each shell, in its format, and never an error while the user types."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from grader.cli.app import COMMANDS
from grader.grading.rubric import shipped_rubrics
from grader.report.formats import Format
from grader.report.rubrics import EVERY_KIND
from tests.command_line import HANG_TIMEOUT, ROOT, run

PARTS = ["task1", "task2", "task3", "questions"]
FORMATS = [f"{kind.value}=" for kind in Format]
RUBRICS = list(shipped_rubrics())


def rubrics(start: str) -> list[str]:
    """Return the ids of the shipped rubrics that begin so."""
    return [name for name in RUBRICS if name.startswith(start)]


def codes(start: str) -> list[str]:
    """Return the codes of problems that start with this prefix."""
    return [kind.code for kind in EVERY_KIND if kind.code.startswith(start)]


def in_bash(line: str) -> list[str]:
    """Return the completions of bash for the last word of a line."""
    done = run((), _GRADER_COMPLETE="complete_bash", COMP_WORDS=line, COMP_CWORD=str(line.count(" ")))
    assert (done.returncode, done.stderr) == (0, b"")
    return done.stdout.decode().split()


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("grader ", list(COMMANDS)),
        ("grader gr", ["grade", "gradebook"]),
        ("grader --v", ["--version"]),
        ("grader rubric ", ["list", "show", "checks", "new", "copy", "check", "test"]),
        ("grader grade x --fa", ["--fail-under"]),
        ("grader grade x --rubric ", RUBRICS),
        ("grader batch x --rubric l", rubrics("l")),
        ("grader rubric show ", RUBRICS),
        ("grader rubric check la", rubrics("la")),
        ("grader grade --part ", PARTS),
        ("grader grade x --rubric lab6 --part ta", PARTS[:3]),
        ("grader grade x --rubric rubrics/lab6/rubric.toml --part q", ["questions"]),
        ("grader grade x --save ", FORMATS),
        ("grader grade x --save js", ["json="]),
        ("grader grade x --format js", ["json"]),
        ("grader explain lidar-f", ["lidar-fixed", "lidar-frame"]),
        ("grader explain URDF05", codes("URDF05")),
        ("grader explain PKG01", codes("PKG01")),
        ("grader explain frame", ["frame_at"]),
        ("grader schema r", ["report", "rubric", "rubric-test"]),
        ("grader export m", ["moodle"]),
        ("grader batch x --layout n", ["nbgrader"]),
        ("grader bundle ", ["gradescope"]),
    ],
)
def test_completions(line: str, offered: list[str]) -> None:
    """Commands, options, and the values of an option or argument."""
    assert [word for word in in_bash(line) if word in offered] == offered
    assert len(in_bash(line)) == len(set(in_bash(line)) & set(offered))


@pytest.mark.parametrize(
    "line",
    [
        "grader grade ",
        "grader grade x ",
        "grader grade x --rubric lab.to",
        "grader grade x --rubric nowhere.toml --part ",
        "grader grade x --rubric grader/errors.py --part ",
        "grader explain --rubric nowhere.toml li",
        "grader inspect x --joint ",
        "grader nothing --x '",
        "grader grade \"a 'b --part ",
        "grader grade x --save json=rep",
        "\u00fc \x1b",
        "",
    ],
)
def test_no_completions(line: str) -> None:
    """If nothing is known, the shell may complete file names."""
    assert set(in_bash(line)) <= set(COMMANDS)


@pytest.mark.parametrize(
    "variables",
    [
        {"_GRADER_COMPLETE": "complete_bash", "COMP_WORDS": "grader g", "COMP_CWORD": "one"},
        {"_GRADER_COMPLETE": "complete_tcsh", "COMP_WORDS": "grader g", "COMP_CWORD": "1"},
        {"_GRADER_COMPLETE": "nonsense"},
        {"_GRADER_COMPLETE": "_"},
        {"_GRADER_COMPLETE": "complete_fish"},
    ],
)
def test_invalid_requests_print_nothing(variables: dict[str, str]) -> None:
    """No error, no traceback."""
    done = run((), **variables)
    assert (done.stdout.strip(), done.stderr) == (b"", b"")


@pytest.mark.exhaustive
def test_closed_standard_output_is_no_error() -> None:
    """A shell that closes standard output causes no error."""
    requested = {**os.environ, "_GRADER_COMPLETE": "complete_bash", "COMP_WORDS": "grader g", "COMP_CWORD": "1"}
    for redirected in (">&-", "> /dev/full"):
        command = ["bash", "-c", f'"{sys.executable}" -m grader {redirected}']
        done = subprocess.run(command, cwd=ROOT, env=requested, capture_output=True, check=False, timeout=HANG_TIMEOUT)
        assert (done.returncode, done.stderr) == (0, b"")


def test_zsh() -> None:
    """Every word with its description; and files if nothing is known."""
    done = run((), _GRADER_COMPLETE="complete_zsh", _TYPER_COMPLETE_ARGS="grader grade x --part ta")
    assert done.stdout.decode().split("\n")[:2] == [
        '_arguments \'*: :(("task1":"A wheeled base in URDF"',
        '"task2":"A package with a launch file for RViz"',
    ]
    listed = run((), _GRADER_COMPLETE="complete_zsh", _TYPER_COMPLETE_ARGS="grader ").stdout.decode()
    assert "Grade a submission against a rubric." in listed
    assert run((), _GRADER_COMPLETE="complete_zsh", _TYPER_COMPLETE_ARGS="grader grade ").stdout == b"_files\n"


def test_fish() -> None:
    """fish first asks whether there are completions, then for them: a tab precedes the description."""
    line = {"_GRADER_COMPLETE": "complete_fish", "_TYPER_COMPLETE_ARGS": "grader explain URDF05"}
    assert run((), **line, _TYPER_COMPLETE_FISH_ACTION="is-args").returncode == 0
    words = run((), **line, _TYPER_COMPLETE_FISH_ACTION="get-args").stdout.decode().splitlines()
    assert [word.partition("\t")[0] for word in words] == codes("URDF05")
    assert all(word.partition("\t")[2] for word in words)
    line["_TYPER_COMPLETE_ARGS"] = "grader grade "
    assert run((), **line, _TYPER_COMPLETE_FISH_ACTION="is-args").returncode == 1


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
    lines = ("ask grader ex", "ask grader grade '\"my file\"' --part ta", "ask grader rubric sh")
    done = in_shell(tmp_path, "bash", 'eval "$(grader --show-completion; true)"', ASK, *lines, "code=0")
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.decode().splitlines() == ["extend export explain", "task1 task2 task3", "show"]


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
