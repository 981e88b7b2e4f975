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
from tests.command_line import HANG_TIMEOUT
from tests.golden.cases import ROOT, run

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
        ("grader --show-completion ", ["bash", "zsh", "fish"]),
        ("grader rubric ", ["list", "show", "checks", "new", "check", "test"]),
        ("grader grade x --fa", ["--fail-under"]),
        ("grader grade x --rubric ", RUBRICS),
        ("grader grade x --rubric=l", rubrics("l")),
        ("grader batch x --rubric l", rubrics("l")),
        ("grader rubric show ", RUBRICS),
        ("grader rubric check la", rubrics("la")),
        ("grader grade --part ", PARTS),
        ("grader grade x --rubric lab6 --part ta", PARTS[:3]),
        ("grader grade x --rubric rubrics/lab6.toml --part q", ["questions"]),
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
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, b"", b"")


def test_closed_standard_output_is_no_error() -> None:
    """A shell that closes standard output causes no error."""
    requested = {**os.environ, "_GRADER_COMPLETE": "complete_bash", "COMP_WORDS": "grader g", "COMP_CWORD": "1"}
    for redirected in (">&-", "> /dev/full"):
        command = ["bash", "-c", f'"{sys.executable}" -m grader {redirected}']
        done = subprocess.run(command, cwd=ROOT, env=requested, capture_output=True, check=False, timeout=HANG_TIMEOUT)
        assert (done.returncode, done.stderr) == (0, b"")


def test_zsh() -> None:
    """Every word with its description, whole; and files if nothing is known."""
    done = run((), _GRADER_COMPLETE="complete_zsh", _TYPER_COMPLETE_ARGS="grader grade x --part ta")
    assert done.stdout.decode().split("\n")[:2] == [
        '_arguments \'*: :(("task1":"A wheeled base in URDF"',
        '"task2":"A package with a launch file for RViz"',
    ]
    listed = run((), _GRADER_COMPLETE="complete_zsh", _TYPER_COMPLETE_ARGS="grader ").stdout.decode()
    assert "Grade a submission against a rubric." in listed
    assert "..." not in listed
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


SOURCED = """
source <("$1" -m grader --show-completion bash)
complete -p grader
ask() {
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    _grader_completion "$1" "${@: -1}" "${@: -2:1}"
    echo "${COMPREPLY[*]}"
}
"""


def sourced(tmp_path: Path, *lines: str) -> list[str]:
    """Return the output of a bash that has sourced the script for these lines."""
    program = tmp_path / "bin" / "grader"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m grader "$@"\n')
    program.chmod(0o755)
    path = f"{program.parent}:{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "--norc", "--noprofile", "-c", "\n".join((SOURCED, *lines)), "bash", sys.executable],
        cwd=ROOT,
        env={**os.environ, "PATH": path, "HOME": str(tmp_path)},
        capture_output=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )
    assert done.stderr == b""
    return done.stdout.decode().splitlines()


def test_a_real_bash(tmp_path: Path) -> None:
    """bash splits words at equals signs, expands what is typed for bin, and shows no error."""
    program = "bin/grader"
    assert sourced(
        tmp_path,
        "ask grader ex",
        "ask grader grade '\"my file\"' --part ta",
        "ask grader grade x --rubric = la",
        "ask grader grade x --rubric = lab6 --part qu",
        "ask grader grade x --rubric =",
        "ask grader grade x --save json = re",
        f'ask "{tmp_path}/{program}" rubric sh',
        f'ask "~/{program}" rubric sh',
        "ask nowhere/grader ex",
    ) == [
        "complete -o default -F _grader_completion grader",
        "export explain",
        "task1 task2 task3",
        " ".join(rubrics("la")),
        "questions",
        " ".join(RUBRICS),
        "",
        "show",
        "show",
        "",
    ]  # fmt: skip


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_is_valid_for_its_shell(shell: str) -> None:
    """Both spellings of the option print it, and the shell finds no error in it."""
    script = run(("--show-completion", shell)).stdout
    assert script == run((f"--show-completion={shell}",)).stdout
    assert b"grader" in script
    if shutil.which(shell) is None:
        pytest.skip(f"there is no {shell} here")
    done = subprocess.run([shell, "-n"], input=script, capture_output=True, check=False, timeout=HANG_TIMEOUT)
    assert (done.returncode, done.stderr) == (0, b"")


@pytest.mark.parametrize(
    ("shell", "file"),
    [
        ("bash", ".bash_completions/grader.sh"),
        ("zsh", ".zfunc/_grader"),
        ("fish", ".config/fish/completions/grader.fish"),
    ],
)
def test_installation(shell: str, file: str, tmp_path: Path) -> None:
    """Installing twice is the same as once, and the rest of the shell's start-up file is kept."""
    (tmp_path / ".bashrc").write_text("alias ll='ls -l'\n")
    for _ in range(2):
        done = run(("--install-completion", shell), HOME=str(tmp_path))
        assert (done.returncode, done.stderr) == (0, b"")
        assert f"completion for {shell} is installed in {tmp_path / file}; " in done.stdout.decode()
    assert (tmp_path / file).read_bytes().strip() == run(("--show-completion", shell)).stdout.strip()
    lines = (tmp_path / ".bashrc").read_text().split("\n")
    assert lines[0] == "alias ll='ls -l'"
    assert [line for line in lines[1:] if line] == ([f"source '{tmp_path / file}'"] if shell == "bash" else [])


def refuse(words: str, *arguments: str, **variables: str) -> None:
    """Assert one line on standard error and exit code 2."""
    done = run(arguments, **variables)
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.startswith(b"grader: ")
    assert done.stderr.count(b"\n") == 1
    assert words in done.stderr.decode()


def test_impossible_installations(tmp_path: Path) -> None:
    """Another shell, more than one, and a home that cannot be written to; the message says what to type."""
    refuse("takes one of bash, zsh, fish, not 'tcsh'", "--show-completion", "tcsh")
    refuse("takes one of bash, zsh, fish, not 'bash zsh'", "--install-completion", "bash", "zsh")
    (tmp_path / ".bashrc").mkdir()
    (tmp_path / ".bash_completions").touch()
    advice = "`grader --show-completion bash` prints the lines to add"
    refuse(advice, "--install-completion", "bash", HOME=str(tmp_path))


def test_the_shell_is_detected(tmp_path: Path) -> None:
    """By the parent process; an unknown shell must be named."""
    command = f'"{sys.executable}" -m grader --show-completion; true'
    for shell, words in (
        ("bash", "_grader_completion() {"),
        ("sh", "`grader --show-completion bash` (or zsh or fish)"),
    ):
        program = tmp_path / shell
        program.symlink_to(shutil.which("bash") or "bash")
        done = subprocess.run(
            [program, "-c", command], cwd=ROOT, capture_output=True, check=False, timeout=HANG_TIMEOUT
        )
        assert words in (done.stdout + done.stderr).decode()
