"""Run commands over whole classes as a user does."""

import atexit
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from grader.app.cli.app import run as run_here
from tests.command_line import GRADER, HANG_TIMEOUT, clean_environment, run, run_process
from tests.samples import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))  # a folder of scripts
import class_generator as made_up

bomb, tarred, Item = made_up.bomb, made_up.tarred, made_up.Item

HOSTILE = Path(__file__).parent / "hostile"
WITH_HOSTILE = {"PYTHONPATH": str(HOSTILE)}
HOSTILE_RUBRIC = str(HOSTILE / "hostile.toml")

Done = subprocess.CompletedProcess[str]
_SKIPPED = ("latin-name", "links-out", "deep-folders")  # what a zip cannot hold as a folder does


def grader(*arguments: str | Path, cwd: str = "", **variables: str) -> Done:
    """Run the command line and return its result with standard output and standard error."""
    words = [*map(str, arguments)]
    done = (
        run_process(words, variables=variables, folder=Path(cwd))
        if cwd
        else run(words, **variables)
    )
    return Done(done.args, done.returncode, done.stdout.decode(), done.stderr.decode())


def environment(**variables: str) -> dict[str, str]:
    """Return the environment of a command, 80 columns wide."""
    return {**clean_environment(), **variables}


@contextmanager
def started(*arguments: str | Path, **variables: str) -> Iterator[subprocess.Popen[str]]:
    """Yield a running command in its own session; its processes are killed at the end."""
    process = subprocess.Popen(
        [*GRADER, *map(str, arguments)],
        env=environment(**variables),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    with process:
        try:
            yield process
        finally:
            for pid in session_of(process):
                with suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)


def session_of(process: "subprocess.Popen[str]") -> list[int]:
    """Return the ids of a command and of the processes that it started, without zombies."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            state = (path / "stat").read_text().rpartition(")")[2].split()[0]
            if os.getsid(int(path.name)) == process.pid and state != "Z":
                found.append(int(path.name))
        except OSError:
            continue
    return found


def eventually(condition: Callable[[], Any]) -> bool:
    """Return whether a condition comes true before the timeout."""
    end = time.monotonic() + HANG_TIMEOUT
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.005)
    return True


def shell_code(code: int) -> int:
    """Return the exit code as a shell reports it: 130 as well if CPython ends itself by the signal of Ctrl-C.

    CPython does this if Ctrl-C arrives while it executes source text, as dataclasses do on import.
    """
    return 128 - code if code < 0 else code


def lines_of(book: Path, kind: str = "student") -> list[dict[str, Any]]:
    """Return the whole lines of results, or of runs, in the order of the file, without checksums; none without a file."""
    file = book / "results.jsonl"
    lines = file.read_bytes().split(b"\n")[:-1] if file.exists() else []  # the last one may be torn
    found = [
        {key: value for key, value in json.loads(line).items() if key != "crc32"} for line in lines
    ]
    return [line for line in found if next(iter(line)) == kind]


def newest(book: Path) -> dict[str, dict[str, Any]]:
    """Return the newest result of every student."""
    return {line["student"]: line for line in lines_of(book)}


def verdicts(book: Path) -> dict[str, str]:
    """Return the verdict of every student."""
    return {key: line["verdict"] for key, line in newest(book).items()}


def reasons(book: Path) -> dict[str, str]:
    """Return the reasons of submissions that are not graded."""
    return {key: line["reason"] for key, line in newest(book).items() if "reason" in line}


def repeated(book: Path) -> list[str]:
    """Return the students with the same result twice."""
    counts = Counter(
        (line["student"], line.get("digest"), line["context"]) for line in lines_of(book)
    )
    return [student for (student, *_), count in counts.items() if count > 1]


def counted(done: Done) -> str:
    """Return the line in which a run reports how many submissions it has graded, without the unchanged unreadable ones."""
    (line,) = (line for line in done.stderr.splitlines() if re.search(r" unchanged( \(|$)", line))
    return line.removeprefix("grader: ").partition(" unchanged")[0] + " unchanged"


def contents(folder: Path) -> dict[str, bytes]:
    """Return all files of a folder by name."""
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def report_in_process(path: Path, to: Path, *more: str) -> tuple[int, bytes | str]:
    """Run `grader grade PATH --format json` in this process and return the exit code and the report or error."""
    output = io.StringIO()
    to.unlink(missing_ok=True)
    with redirect_stdout(io.StringIO()), redirect_stderr(output):
        code = run_here(
            ["grade", "--save", f"json={to}", "--format", "json", *more, "--", str(path)]
        )
    return code, to.read_bytes() if to.exists() else output.getvalue()


@cache
def without_hints() -> Path:
    """Return the rubric of Lab 6 without hints, whose search takes ten times as long as grading."""
    folder = Path(mkdtemp())
    atexit.register(shutil.rmtree, folder)
    shutil.copytree(ROOT / "rubrics/lab6", folder, dirs_exist_ok=True)
    text = (ROOT / "rubrics/lab6/rubric.toml").read_text(encoding="utf-8")
    assert text.count('hints = "cause"') == 1
    (folder / "lab6.toml").write_text(
        text.replace('hints = "cause"', 'hints = "none"'), encoding="utf-8"
    )
    return folder / "lab6.toml"


def urdf_class(folder: Path, count: int, seed: int = 1) -> Path:
    """Make a class of single URDFs."""
    for _ in made_up.make_class(folder, count, seed):
        pass
    return folder


def mixed_class(
    folder: Path, count: int, layout: str = "folders", seed: int = 1, *, for_zip: bool = False
) -> Path:
    """Make a class of all kinds of submissions; `for_zip` omits what a zip cannot hold as a folder does."""
    for submission in made_up.make_class(folder, count, seed, "mixed", layout):
        if for_zip and (submission.kind in _SKIPPED or not submission.person.name.isprintable()):
            for path in submission.paths:
                target = folder / path
                shutil.rmtree(target) if target.is_dir() else target.unlink(missing_ok=True)
    return folder


def class_with_roster(folder: Path, roster: Path, count: int) -> tuple[list[str], int]:
    """Make a class with a roster; return the keys of students who are not on it, and how many on it submitted nothing."""
    written = list(made_up.make_class(folder, count, 1, "mixed"))
    made_up.write_beside(written, count, "folders", None, roster, None)
    return [submission.person.key for submission in written[count:]], sum(
        not submission.paths for submission in written[:count]
    )


def hostile_class(folder: Path, *names: str) -> Path:
    """Make a class with robots of these names, each of a student of that name."""
    folder.mkdir()
    for name in names:
        robot = name.partition("-")[0]
        (folder / f"{name}.urdf").write_text(f'<robot name="{robot}"><link name="a"/></robot>')
    return folder
