"""The formats of a report, and a report in one of them."""

import os
from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING

from grader.cli.output import draw

if TYPE_CHECKING:
    from grader.grading.report import Report
    from grader.report.places import Base


class Format(StrEnum):
    """The formats of a report."""

    TERMINAL = "terminal"
    MARKDOWN = "markdown"
    JSON = "json"
    JUNIT = "junit"
    SARIF = "sarif"
    GITHUB = "github"
    GRADESCOPE = "gradescope"
    CLASSROOM50 = "classroom50"
    CODECLIMATE = "codeclimate"

    @property
    def ending(self) -> str:
        """What the name of such a file ends in; no two are alike, so that all of them can stand side by side."""
        return _ENDINGS.get(self.value, f"{self.value}.json")


_ENDINGS = {
    "terminal": "txt",
    "markdown": "md",
    "json": "json",
    "junit": "xml",
    "sarif": "sarif",
    "github": "github.txt",
}


def render(report: "Report", kind: Format, base: "Base | None" = None, *, to_file: bool = True) -> str:
    """A report as text, for standard output or for a file; `base` is where the submission stands in its repository.

    Nothing is loaded but the format that is asked for. Raises InputError for Classroom 50 where nobody says whose result it is.
    """
    from grader.report.places import Base
    from grader.text import without_commands

    base = base or Base()
    match kind:
        case Format.TERMINAL:
            from grader.report.terminal import render_terminal

            return draw(partial(render_terminal, report), to_file=to_file)
        case Format.MARKDOWN:
            from grader.report.markdown import render_markdown

            return without_commands(render_markdown(report))
        case Format.JSON:
            from grader.report.as_json import render_json

            return render_json(report)
        case Format.JUNIT:
            from grader.report.junit import render_junit

            return without_commands(render_junit(report, base))
        case Format.SARIF:
            from grader.report.sarif import render_sarif

            return render_sarif(report, base)
        case Format.GITHUB:
            from grader.report.github import render_github

            return render_github(report, base)
        case Format.GRADESCOPE:
            from grader.report.gradescope import render_gradescope

            return render_gradescope(report)
        case Format.CLASSROOM50:
            from grader.report.classroom50 import identity_from, render_classroom50

            return render_classroom50(report, identity_from(os.environ))
        case Format.CODECLIMATE:
            from grader.report.codeclimate import render_codeclimate

            return render_codeclimate(report, base)
