"""The log that --log names."""

from collections.abc import Callable

from grader.base.errors import GraderError
from grader.files.log_file import read_log, read_piped_log
from grader.workspace.api import MAX_LOG, STANDARD_INPUT


def read_named_log(log: str, path: str, pass_on: Callable[[bytes], None]) -> bytes:
    """Return the end of the log that --log names. Raises GraderError.

    Args:
        log: A file, a folder of logs, or - for standard input.
        path: The path that is inspected.
        pass_on: Gets each part of standard input.
    """
    if log != STANDARD_INPUT:
        return read_log(log, MAX_LOG)
    if path == STANDARD_INPUT:
        raise GraderError("--log: PATH and the log cannot both be standard input")
    return read_piped_log(MAX_LOG, pass_on)
