"""Annotations and the job summary of GitHub Actions, which `grade` writes without an option."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from grader.base.errors import InputError
from grader.base.text import printable
from grader.report.writing import Warn, refuse_symlinks

if TYPE_CHECKING:
    from grader.base.source import Base
    from grader.lab.grading.report import Report

_Annotate = Callable[[str], None]  # writes workflow commands
_MAX_SUMMARY = 1024 * 1024  # bytes: GitHub does not show a longer step summary


def publish_report(report: "Report", base: "Base", annotate: _Annotate | None, warn: Warn) -> None:
    """Annotate the findings of a report, and add it to the job summary.

    Annotations are workflow commands for standard error, where GitHub reads them as well: standard
    output is for the report.
    """
    from grader.report.writers.annotations import render_github
    from grader.report.writers.markdown import cut_markdown

    if annotate is not None:
        annotate(render_github(report, base))
    _add_to_summary(lambda room: cut_markdown(report, room), warn)


def publish_refusal(reason: str, annotate: _Annotate, warn: Warn) -> None:
    """Annotate why nothing was graded, and add it to the job summary."""
    from grader.report.writers.escaped_markdown import escape
    from grader.report.writers.workflow_commands import command

    lines = [printable(line) for line in reason.splitlines()]
    annotate(command("error", {}, "Nothing was graded", "\n".join(lines)))
    text = "\n\n".join(("# Nothing was graded", *map(escape, lines))) + "\n"
    _add_to_summary(lambda room: text if len(text.encode()) <= room else "", warn)


def _add_to_summary(text: Callable[[int], str], warn: Warn) -> None:
    """Append a text, made for the bytes that are left, to the step's summary."""
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    if not summary:
        return
    try:
        refuse_symlinks(Path(summary))
        no_symlinks = getattr(os, "O_NOFOLLOW", 0)
        with open(
            summary, "ab", opener=lambda path, flags: os.open(path, flags | no_symlinks, 0o666)
        ) as file:
            size = file.tell()
            added = text(_MAX_SUMMARY - size - 1).encode("utf-8", "backslashreplace")
            if added:
                file.write(b"\n" + added if size else added)
    except OSError as error:
        warn(f"cannot write the job summary: {error.strerror or error}")
    except InputError as error:
        warn(f"job summary: {error}")
