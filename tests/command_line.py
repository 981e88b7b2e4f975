"""Run the command line: in this process, which takes a tenth of the time, or in a process of its own."""

import gc
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import AbstractContextManager, chdir, contextmanager, nullcontext
from math import inf
from pathlib import Path
from tempfile import TemporaryFile
from threading import current_thread, main_thread
from typing import IO, Any
from unittest.mock import patch

from grader.__main__ import main
from tests.conversion import convert_here
from tests.faults.shim import is_preloaded
from tests.parsed_rubrics import validated_once

ROOT = Path(__file__).parent.parent
HANG_TIMEOUT = 300.0  # seconds after which a command counts as hanging, even on a busy machine

GRADER = (sys.executable, "-W", "error", "-m", "grader")
Done = subprocess.CompletedProcess[bytes]
# A line every ten seconds on standard error, of what takes longer on a busy machine.
PROGRESS = re.compile(r"^grader: \d+ of \d+(, .* left.*)?\n", re.MULTILINE)

# What starts processes or threads that would outlive the command here, and variables that the interpreter reads when it starts.
_OWN_PROCESS = ("--cluster",)
_READ_AT_START = ("PYTHONPATH", "PYTHONHASHSEED", "LANG", "LC_", "TZ")


def run(arguments: Sequence[object], **variables: str) -> Done:
    """Run the command line from the project's root, in this process if the result is the same."""
    return run_with_input(arguments, b"", variables)


def run_with_input(
    arguments: Sequence[object],
    stdin: bytes,
    variables: Mapping[str, str] = {},
    folder: Path = ROOT,
    inside: AbstractContextManager[object] | None = None,
) -> Done:
    """Run the command line like `run`, with standard input, from another folder or inside of a context."""
    words = [
        os.fsdecode(argument) if isinstance(argument, bytes) else str(argument)
        for argument in arguments
    ]
    if _needs_own_process(words, variables):
        return run_process(words, stdin, variables, folder)
    with TemporaryFile() as given, TemporaryFile() as out, TemporaryFile() as err:
        given.write(stdin)
        given.seek(0)
        with (
            chdir(folder),
            _process_state(words, {**clean_environment(), **variables}, (given, out, err)),
            inside or nullcontext(),
        ):
            code = _exit_code()
        texts = []
        for stream in (out, err):
            stream.seek(0)
            texts.append(stream.read())
    return subprocess.CompletedProcess(words, code, *texts)


def _needs_own_process(words: Sequence[str], variables: Mapping[str, str]) -> bool:
    """Return whether a command gives another result in this process."""
    return (
        current_thread()
        is not main_thread()  # streams, variables and the current folder belong to the process
        or any(option in words for option in _OWN_PROCESS)
        or any(variable.startswith(_READ_AT_START) for variable in variables)
    )


def run_process(
    arguments: Sequence[str],
    stdin: bytes = b"",
    variables: Mapping[str, str] = {},
    folder: Path = ROOT,
) -> Done:
    """Run the command line as a user does, in a process of its own."""
    return subprocess.run(
        [*GRADER, *arguments],
        cwd=folder,
        env={**clean_environment(), **variables},
        input=stdin,
        capture_output=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )


def clean_environment() -> dict[str, str]:
    """Return the variables of a command: 80 columns, UTF-8, an account, and nothing else that changes the output."""
    return {**os.environ, "COLUMNS": "80", "PYTHONIOENCODING": "utf-8", "LOGNAME": "teacher"}


def _exit_code() -> int:
    try:
        main()
    except SystemExit as end:
        assert isinstance(end.code, int)
        return end.code
    raise AssertionError("the command line did not exit")


class _Pool:
    """A pool of workers, as pebble's, that does its tasks at once and in this process."""

    active = True

    def __init__(self, *_: object) -> None:
        """Take what a pool takes."""

    def schedule(
        self,
        function: Callable[..., Any],
        arguments: tuple[Any, ...],
        named: dict[str, Any],
        _timeout: float,
    ) -> "Future[Any]":
        """Call a function; its future is done."""
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments, **named))
        except Exception as error:  # noqa: BLE001  whatever it is, it is the task's
            future.set_exception(error)
        return future

    def stop(self) -> None:
        """There is nothing to stop."""

    join = stop


@contextmanager
def _process_state(
    words: list[str], variables: Mapping[str, str], files: tuple[IO[bytes], ...]
) -> Iterator[None]:
    """Set arguments, variables and standard streams as at the start of a process, and restore them."""
    with (
        patch.dict(os.environ, variables, clear=True),
        patch.object(sys, "argv", ["grader", *words]),
        patch("grader.lab.rubric.rubric._validate", validated_once),
        patch("grader.lab.documents.collection.DocumentCollection._run", convert_here),
        patch("grader.workers.pool.ProcessPool", _Pool),
        patch("grader.workers.forks.start_server", bool),
        patch("os.fsync", os.fsync if is_preloaded() else bool),
        patch(
            "grader.app.cli.streams._LINE_SECONDS", inf
        ),  # no line depends on how busy the machine is
        _redirected(0, files[0]),
        _redirected(1, files[1]),
        _redirected(2, files[2]),
        open(0, encoding="utf-8", errors="surrogateescape", closefd=False) as given,
        open(1, "w", encoding=variables["PYTHONIOENCODING"], closefd=False) as out,
        open(
            2, "w", encoding=variables["PYTHONIOENCODING"], errors="backslashreplace", closefd=False
        ) as err,
        patch.multiple(sys, stdin=given, stdout=out, stderr=err),
        patch.object(gc, "freeze"),  # what a command leaves is garbage here
    ):
        try:
            yield
        finally:
            gc.enable()  # a command disables it, because it ends soon


@contextmanager
def _redirected(descriptor: int, file: IO[bytes]) -> Iterator[None]:
    kept = os.dup(descriptor)
    os.dup2(file.fileno(), descriptor)
    try:
        yield
    finally:
        os.dup2(kept, descriptor)
        os.close(kept)
