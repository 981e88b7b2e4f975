"""The exit codes of the commands, and how a report decides them."""

import re
from dataclasses import dataclass
from decimal import Decimal
from enum import IntEnum
from typing import TYPE_CHECKING

from grader.errors import GraderError

if TYPE_CHECKING:
    from grader.grading.report import Report

_THRESHOLD = re.compile(r"[0-9]{1,9}(?:\.[0-9]{1,9})?%?")
_MAX_PERCENT = 100


class ExitCode(IntEnum):
    """The exit code of a command."""

    PASSED = 0
    FAILED = 1
    NOT_GRADED = 2
    FAULT = 3
    INTERRUPTED = 130


@dataclass(frozen=True, slots=True)
class Threshold:
    """The score from which `--fail-under` lets a run pass: points, or percent of the maximum."""

    value: Decimal
    is_percent: bool

    @classmethod
    def read(cls, text: str) -> "Threshold":
        """Return the threshold of `--fail-under`, such as 58.5 or 80%. Raises GraderError."""
        if not _THRESHOLD.fullmatch(text) or (text.endswith("%") and Decimal(text[:-1]) > _MAX_PERCENT):
            raise GraderError(f"--fail-under takes points or a percentage from 0% to 100%, not {text!r}")
        return cls(Decimal(text.removesuffix("%")), text.endswith("%"))

    def is_reached(self, score: Decimal, maximum: Decimal) -> bool:
        """Return whether a score is high enough."""
        return score * 100 >= self.value * maximum if self.is_percent else score >= self.value


def exit_code(report: "Report", threshold: Threshold | None) -> ExitCode:
    """Return the exit code for a report.

    A faulty check takes precedence. With a threshold, only the score decides. Without one, every automatic criterion must have
    passed: one that could not be decided needs manual grading, and is not a pass.
    """
    from grader.report.content import undecided

    if report.counts("errored"):
        return ExitCode.FAULT
    if threshold is not None:
        is_passed = threshold.is_reached(report.score, report.max_score)
    else:
        is_passed = not report.counts("failed", "skipped") and not undecided(report)
    return ExitCode.PASSED if is_passed else ExitCode.FAILED
