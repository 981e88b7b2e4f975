"""A report for a person at a terminal: what to fix first; the score last, where the eye is when the command ends.

Text of a submission is never interpreted as markup or control codes.
"""

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report
from grader.report import content
from grader.report.brief import show_brief
from grader.report.console import Page, Room
from grader.report.document import document
from grader.report.verbose import show_everything
from grader.text import printable

_ROWS = 24  # of a common terminal
_SHORT = Room.EVERYTHING, Room.NO_TITLES, Room.NO_EMPTY_ROWS


def render_terminal(report: Report, console: Console, *, verbose: bool = False) -> None:
    """Print a report, with `verbose` everything in it, else in 24 rows as far as possible."""
    found = document(report, everything=verbose)
    for room in [Room.ANY] if verbose else _SHORT:
        page = Page(console, room, [])
        if verbose:
            show_everything(report, found, page)
        else:
            show_brief(report, found, page)
        _show_end(report, page)
        if sum(row.plain.count("\n") + 1 for row in page.rows) <= _ROWS:
            break
    page.print()


def _show_end(report: Report, page: Page) -> None:
    """Print whether ROS 2 loads the URDF, the next command, and the score."""
    command, verdict = content.next_command(report), content.verdict_and_counts(report)
    following = f"Next: {command}" if command else content.what_is_left(report)
    lines = [f"{verdict}. {following}"] if page.is_tight else [verdict, following]
    lines += [content.bonus_line(report), content.grade_line(report)]
    for line in [following] if page.is_whole else filter(None, lines):
        page.line(line)
    counting = report.counting
    is_full = counting is not None and counting + report.open_points >= report.max_score
    score = (content.headline(report), "bold green" if is_full else "bold")
    page.inset(Text.assemble(score, "  ", (printable(report.rubric.title), "bold")), indent=0)
