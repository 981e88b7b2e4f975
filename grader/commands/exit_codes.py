"""The exit codes of the commands, and how a report decides them."""

import re
from decimal import Decimal
from enum import IntEnum
from typing import TYPE_CHECKING

from grader.errors import GraderError

if TYPE_CHECKING:
    from grader.grading.report import Report

_THRESHOLD = r"[0-9]{1,9}(?:\.[0-9]{1,9})?%?"
_MAX_PERCENT = 100


class ExitCode(IntEnum):
    """The exit code of a command."""

    PASSED = 0
    FAILED = 1
    NOT_GRADED = 2
    FAULT = 3
    INTERRUPTED = 130


def read_threshold(text: str) -> tuple[Decimal, bool]:
    """Return the score of `--fail-under`, such as 58.5 or 80%, and whether it is in percent. Raises GraderError."""
    if not re.fullmatch(_THRESHOLD, text) or (text.endswith("%") and Decimal(text[:-1]) > _MAX_PERCENT):
        raise GraderError(f"--fail-under takes points or a percentage from 0% to 100%, not {text!r}")
    return Decimal(text.removesuffix("%")), text.endswith("%")


def exit_code(report: "Report", threshold: tuple[Decimal, bool] | None) -> ExitCode:
    """Return the exit code for a report.

    A faulty check takes precedence. With a threshold, only the score decides, but a file that ROS 2 rejects never
    passes. Without one, every automatic criterion must have passed, except extra credit and adjusted criteria. A
    criterion that could not be decided has not passed.
    """
    if report.fault:
        return ExitCode.FAULT
    if threshold is not None:
        least, is_percent = threshold
        is_passed = report.score * 100 >= least * (report.max_score if is_percent else 100)
        is_passed = is_passed and report.submission.verdict != "rejected"
    else:
        short = [result for result in report.results if result.is_lost] + report.pending_automatic
        is_passed = all(result.criterion.bonus for result in short)
    return ExitCode.PASSED if is_passed else ExitCode.FAILED
