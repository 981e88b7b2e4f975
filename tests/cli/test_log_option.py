"""`grader inspect --log`: a file, a folder or a pipe, beside the findings."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from grader.base.errors import InputError
from grader.files import log_file
from grader.files.log_file import read_log, read_piped_log
from grader.workspace.api import MAX_LOG
from tests.command_line import GRADER, ROOT, Done, run, run_with_input

SAMPLE = ROOT / "submissions/diffdrive/spawner-misspelt"
LOG = b"[ERROR] [launch]: Caught exception in launch: package 'diffdrive_robot' not found, searching: []\n"
ANSWER = "diffdrive_robot/package.xml:1 explains line 1 of the log: the package is in"


def words(done: Done) -> str:
    """Return the standard output of a command, without its line breaks."""
    return " ".join(done.stdout.decode().split())


def test_a_log_is_explained_above_the_findings(tmp_path: Path) -> None:
    """The findings and the exit code are those without it."""
    (tmp_path / "a.log").write_bytes(LOG)
    done = run(("inspect", SAMPLE, "--log", tmp_path / "a.log"))
    text, without = words(done), run(("inspect", SAMPLE))
    assert done.returncode == without.returncode == 1
    assert -1 < text.find(ANSWER) < text.find("Problems")
    for form in ("concise", "sarif"):
        option = ("inspect", SAMPLE, "--format", form)
        assert run((*option, "--log", tmp_path / "a.log")).stdout == run(option).stdout


def test_json_has_the_answers(tmp_path: Path) -> None:
    """Each with its line, and a location or null; without a log there is no key."""
    (tmp_path / "a.log").write_bytes(LOG + b"[ERROR] [1.5] [a]: unheard of\n")
    option = ("inspect", SAMPLE, "--format", "json")
    data = json.loads(run((*option, "--log", tmp_path / "a.log")).stdout)
    first, second = data["log"]
    assert (first["line"], first["output"], first["code"]) == (1, "package-not-found", None)
    assert (first["location"]["path"], first["location"]["line"]) == (
        "diffdrive_robot/package.xml",
        1,
    )
    assert (second["output"], second["location"]) == (None, None)
    assert second["message"] == "no explanation is known"
    del data["log"]
    assert data == json.loads(run(option).stdout)


def test_a_log_without_failures_is_said(tmp_path: Path) -> None:
    """So is a message that no row knows."""
    (tmp_path / "a.log").write_bytes(b"[INFO] [1.5] [a]: all is well\n")
    log = ("inspect", SAMPLE, "--log", tmp_path / "a.log")
    assert "no line of the log says that something fails" in words(run(log))
    (tmp_path / "a.log").write_bytes(b"[ERROR] [1.5] [a]: unheard of\n")
    assert "line 1 of the log: no explanation is known" in words(run(log))


@pytest.mark.parametrize("option", [(), ("--robot", "diffdrive")])
def test_a_pipe_is_passed_on(option: tuple[str, ...]) -> None:
    """To standard error, as it is; also of one robot, and of a URDF on its own."""
    log = b"\x1b[31m" + LOG
    robots = [*SAMPLE.rglob("*.urdf"), *SAMPLE.rglob("*.xacro")]
    for path in (SAMPLE, robots[0]):
        done = run_with_input(("inspect", path, "--log", "-"), log)
        assert log in done.stderr
        assert (ANSWER in words(done)) == (path == SAMPLE), option


def test_path_and_log_are_not_both_standard_input() -> None:
    """That is wrong usage, as is a log that is not there."""
    done = run_with_input(("inspect", "-", "--log", "-"), b"<robot name='a'/>")
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"cannot both be standard input" in done.stderr
    assert run(("inspect", SAMPLE, "--log", "no-such.log")).returncode == 2


def test_a_folder_of_logs_is_read(tmp_path: Path) -> None:
    """Of a build what went to standard error, else every log, that of launch last; links lead nowhere new."""
    for name in ("latest/z.log", "latest/launch.log", "build/cell/stderr.log", "build/cell/x.log"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name, encoding="utf-8")
    assert read_log(str(tmp_path / "latest"), MAX_LOG) == b"latest/z.log\nlatest/launch.log"
    assert read_log(str(tmp_path / "build"), MAX_LOG) == b"build/cell/stderr.log"
    assert read_log(str(tmp_path / "latest/z.log"), 3) == b"log"
    (tmp_path / "none").mkdir()
    done = run(("inspect", SAMPLE, "--log", tmp_path / "none"))
    assert done.returncode == 2
    assert b"has no log file (*.log)" in done.stderr


@pytest.mark.slow
def test_ctrl_c_ends_the_reading_and_not_the_answer() -> None:
    """It reaches both programs of a pipe; what came before is explained."""
    with subprocess.Popen(
        [*GRADER, "inspect", str(SAMPLE), "--log", "-"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as program:
        assert program.stdin is not None
        assert program.stdout is not None
        assert program.stderr is not None
        program.stdin.write(LOG)
        program.stdin.flush()
        assert program.stderr.readline() == LOG  # so it is read
        program.send_signal(signal.SIGINT)
        text = " ".join(program.stdout.read().decode().split())
        assert program.wait() == 1
    assert ANSWER in text


def _standard_input(*parts: bytes | BaseException) -> SimpleNamespace:
    """Return a stream that gives these parts, or raises them."""
    left = [*parts, b""]

    def read1(_: int) -> bytes:
        part = left.pop(0)
        if isinstance(part, BaseException):
            raise part
        return part

    return SimpleNamespace(buffer=SimpleNamespace(read1=read1))


def test_the_end_of_a_pipe_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """All of it is passed on, and an interrupt ends it; that it cannot be read is an error."""
    passed: list[bytes] = []
    monkeypatch.setattr(sys, "stdin", _standard_input(b"abc", b"def", KeyboardInterrupt(), b"g"))
    assert read_piped_log(4, passed.append) == b"cdef"
    assert passed == [b"abc", b"def"]
    monkeypatch.setattr(sys, "stdin", _standard_input(OSError(5, "Input/output error")))
    with pytest.raises(InputError, match="cannot read standard input: Input/output error"):
        read_piped_log(4, passed.append)
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(InputError, match="standard input is closed"):
        read_piped_log(4, passed.append)


def test_a_large_folder_and_a_file_that_is_none_have_limits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No more than so many files are read, and what is no file hides no other one."""
    monkeypatch.setattr(log_file, "_MAX_FILES", 2)
    for name in "abcd":
        (tmp_path / f"{name}.log").write_text(name, encoding="utf-8")
    assert read_log(str(tmp_path), MAX_LOG) == b"a\nb"
    (tmp_path / "a.log").unlink()
    (tmp_path / "a.log").symlink_to(tmp_path / "none")
    assert read_log(str(tmp_path), MAX_LOG) == b"b"

    def broken(handle: int, _: str) -> None:
        os.close(handle)
        raise OSError(21, "Is a directory")

    monkeypatch.setattr(os, "fdopen", broken)
    with pytest.raises(InputError, match="Is a directory"):
        read_log(str(tmp_path / "b.log"), MAX_LOG)
