"""The formats of a report, and a report in one of them."""

from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING

from grader.cli.output import draw

if TYPE_CHECKING:
    from grader.grading.report import Report


class Format(StrEnum):
    """The formats of a report."""

    TERMINAL = "terminal"
    JSON = "json"

    @property
    def ending(self) -> str:
        """What the name of such a file ends in."""
        return "txt" if self is Format.TERMINAL else self.value


def render(report: "Report", kind: Format, *, to_file: bool) -> str:
    """A report as text, for standard output or for a file."""
    if kind is Format.JSON:
        from grader.report.as_json import render_json

        return render_json(report)
    from grader.report.terminal import render_terminal

    return draw(partial(render_terminal, report), to_file=to_file)
