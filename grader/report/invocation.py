"""How a command is called and answers.

This is the values of --fail-under, --save and --arg, and its exit code.
"""

import os
import re
from collections.abc import Sequence
from decimal import Decimal
from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from grader.base.errors import GraderError
from grader.base.text import counted_points, format_points
from grader.report.formats import FormatRow

if TYPE_CHECKING:
    from grader.lab.grading.report import Report
    from grader.report.inspection import Inspection


_THRESHOLD = r"[0-9]{1,9}(?:\.[0-9]{1,9})?%?"
_MAX_PERCENT = 100
_Row = TypeVar("_Row", bound=FormatRow)
Saves = tuple[tuple[_Row, Path], ...]


class ExitCode(IntEnum):
    """The exit code of a command."""

    PASSED = 0
    FAILED = 1
    NOT_GRADED = 2
    FAULT = 3
    INTERRUPTED = 130


def read_threshold(text: str) -> tuple[Decimal, bool]:
    """Return the score of `--fail-under`, such as 58.5 or 80%, and whether it is in percent.

    Raises GraderError.
    """
    if not re.fullmatch(_THRESHOLD, text) or (
        text.endswith("%") and Decimal(text[:-1]) > _MAX_PERCENT
    ):
        raise GraderError(
            f"--fail-under takes points or a percentage from 0% to 100%, not {text!r}"
        )
    return Decimal(text.removesuffix("%")), text.endswith("%")


def check_threshold(threshold: tuple[Decimal, bool], most: Decimal) -> None:
    """Raise GraderError if no score reaches a threshold in points."""
    least, is_percent = threshold
    if least > most and not is_percent:
        raise GraderError(
            f"--fail-under {format_points(least)}: no score reaches it, because the maximum is "
            f"{counted_points(most)}; write a percentage as 80%"
        )


def exit_code(report: "Report", threshold: tuple[Decimal, bool] | None) -> ExitCode:
    """Return the exit code for a report.

    A faulty check takes precedence. With a threshold, only the score decides, but a file that ROS 2
    rejects never passes. Without one, every automatic criterion must have passed, except extra
    credit and adjusted criteria. A criterion that could not be decided has not passed.
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


def inspection_exit_code(inspection: "Inspection", *, is_known: bool = False) -> ExitCode:
    """Return the exit code of a command that inspects a workspace.

    It is 2 if none of its robots can be read, else 1 if something is certainly wrong, unless that
    `is_known` from now on.
    """
    if inspection.has_no_readable_robot:
        return ExitCode.NOT_GRADED
    return ExitCode.PASSED if inspection.is_passed or is_known else ExitCode.FAILED


def read_saves(texts: Sequence[str], formats: type[_Row]) -> Saves[_Row]:
    """Return the formats and files that `--save` names. Raises GraderError."""
    saves = tuple(_read_save(text, formats) for text in texts)
    files = [os.path.realpath(file) for _, file in saves if file.is_file() or not file.exists()]
    for _, file in saves:
        if files.count(os.path.realpath(file)) > 1:
            raise GraderError(f"--save names {file} twice, and one file cannot hold two reports")
    return saves


def _read_save(text: str, formats: type[_Row]) -> tuple[_Row, Path]:
    kind, equals, file = text.partition("=")
    if kind not in list(formats) or not equals or file in ("", "-"):
        meant = next((kind for kind in formats if text.endswith(f".{kind.ending}")), None)
        guess = ""
        if kind in list(formats):
            guess = f"; did you mean --save {kind}=report.{formats(kind).ending}?"
        elif meant is not None and not equals:
            guess = f"; did you mean --save {meant}={text}?"
        raise GraderError(
            f"--save takes FORMAT=FILE with one of the formats {', '.join(formats)}, not "
            f"{text!r}{guess}"
        )
    # The shell expands no ~ after `=`; Path.expanduser raises for an unknown user.
    return formats(kind), Path(os.path.expanduser(file))  # noqa: PTH111


def read_arguments(texts: Sequence[str]) -> dict[str, str]:
    """Return the values that `--arg` gives arguments of xacro, by their names.

    Raises GraderError.
    """
    arguments = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name.removesuffix(":"):
            raise GraderError(
                f"--arg takes NAME=VALUE, an argument of the xacro file, not {text!r}"
            )
        arguments[name.removesuffix(":")] = value  # NAME:=VALUE, as xacro takes it
    return arguments
