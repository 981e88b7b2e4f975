"""A report for a person at a terminal: the score first, failures explained, the rest short."""

from itertools import groupby
from typing import NamedTuple

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report, Result
from grader.report.console import show_excerpt, show_problems, symbol, wrapped
from grader.report.content import (
    Details,
    advice,
    earned_text,
    evidence,
    ignored_lines,
    location_text,
    notes,
    other_problems,
    package_line,
    pending_line,
    result_details,
    score_text,
    status_of,
    summary,
)
from grader.text import format_points, printable

_STYLES = {"passed": "green", "failed": "bold red", "skipped": "yellow", "pending": "cyan", "errored": "bold magenta"}
_SYMBOLS = {
    "passed": ("\u2713", "+"),
    "failed": ("\u2717", "X"),
    "skipped": ("\u2212", "-"),
    "pending": ("?", "?"),
    "errored": ("!", "!"),
}
_INDENT = 10
_MOST_LISTED = 12


class _Page(NamedTuple):
    """What is being printed, where, and which feedback is printed already."""

    report: Report
    console: Console
    shown: set[str]


def render_terminal(report: Report, console: Console) -> None:
    """Print a report. Nothing of the submission is taken for markup or control codes."""
    _show_head(report, console)
    page = _Page(report, console, set())
    titles = {part.id: part.title for part in report.rubric.parts}
    for part, of_part in groupby(report.results, key=lambda each: each.criterion.part):
        results = tuple(of_part)
        if len(report.parts) > 1:
            console.print()
            heading = f"{printable(titles[part])}  {earned_text(results)}"
            wrapped(console, Text(heading, style="bold underline"), 0)
        whole = None if len(report.parts) == 1 else titles[part]
        _show_groups(results, titles[part], whole, page)
    _show_evidence(report, console)
    problems = tuple(other_problems(report))
    if problems:
        console.print()
        what = "file" if report.submission.is_single else "files"
        console.print(Text(f"What else there is to say of the {what}", style="bold"))
        show_problems(console, problems, report.submission.source, report.submission.path)
    more = advice(report)
    if more:
        console.print()
        wrapped(console, Text(more, style="dim"), 0)


def _show_head(report: Report, console: Console) -> None:
    style = "bold green" if report.score + report.pending == report.max_score else "bold"
    title = printable(report.rubric.title)
    wrapped(console, Text.assemble((score_text(report), style), "  ", (title, "bold")), 0)
    lines = [(summary(report), ""), (package_line(report), ""), (pending_line(report), "cyan")]
    for line, line_style in (*lines, *((note, "cyan") for note in notes(report))):
        if line:
            wrapped(console, Text(line, style=line_style), 0)
    for line in ignored_lines(report):
        wrapped(console, Text(line, style="dim"), 0)


def _show_groups(results: tuple[Result, ...], title: str, whole: str | None, page: _Page) -> None:
    """Print the criteria of a part, those about one thing under one heading; a heading like the part's is left out.

    Groups in a row that are skipped, or wait, for the same reason are one line.
    """
    named = [(name, tuple(group)) for name, group in groupby(results, key=lambda each: each.criterion.about or title)]
    for reason, alike in groupby(named, key=lambda group: _shared(group[1])):
        groups = list(alike)
        alike_results = tuple(result for _, group in groups for result in group)
        if reason is None or len(alike_results) == 1:
            for name, group in groups:
                if name != whole:
                    _show_heading(name, group, page.console)
                for result in group:
                    _show_result(result, page)
        else:
            _show_heading(", ".join(name for name, _ in groups), alike_results, page.console)
            _show_alike(alike_results, reason, page.console)


def _shared(results: tuple[Result, ...]) -> str | None:
    """What all of several criteria are skipped for, or wait for, if there is such a thing."""
    reasons = {_reason(each) for each in results}
    return reasons.pop() if len(reasons) == 1 else None


def _reason(result: Result) -> str | None:
    if result.because is not None and result.ruling is None:
        return f"skipped, because {result.because} failed"
    is_open = result.is_open and not isinstance(result.outcome.measured, str)  # an answer is shown on its own
    return f"pending: {result.outcome.message}" if is_open else None


def _show_heading(name: str, results: tuple[Result, ...], console: Console) -> None:
    console.print()
    wrapped(console, Text.assemble((printable(name), "bold"), (f"  {earned_text(results)}", "dim")), 0)


def _show_alike(results: tuple[Result, ...], reason: str, console: Console) -> None:
    """One line for criteria that are skipped, or wait, for the same reason."""
    status = results[0].outcome.status
    most = earned_text(results).partition("/")[2]
    head = Text.assemble("  ", (symbol(console, *_SYMBOLS[status]), _STYLES[status]), f" 0/{most:<3} ")
    wrapped(console, Text(printable(f"{len(results)} criteria are {reason}"), style="dim"), _INDENT, head)


def _show_result(result: Result, page: _Page) -> None:
    console, criterion, status = page.console, result.criterion, status_of(result)
    points = f"{format_points(result.points)}/{format_points(criterion.points)}"
    head = Text.assemble("  ", (symbol(console, *_SYMBOLS[status]), _STYLES[status]), f" {points:<5} ")
    title = Text(printable(criterion.title))
    if status in ("passed", "skipped") and result.ruling is None:
        because = f"  skipped, because {result.because} failed" if status == "skipped" else ""
        wrapped(console, title + Text(because, style="dim"), _INDENT, head)
        return
    wrapped(console, title + Text(f"  {criterion.id}", style="dim"), _INDENT, head)
    _show_told(result_details(result, page.report), _sentence_styles(result), page)


def _sentence_styles(result: Result) -> tuple[str, ...]:
    """The styles of what is told of a criterion: a person's decision stands out, and so does a fault of ours."""
    if result.ruling is not None:
        return ("bold", "dim")
    return (_STYLES["errored"] if result.outcome.status == "errored" else "",)


def _show_told(what: Details, styles: tuple[str, ...], page: _Page) -> None:
    console = page.console
    for words, style in zip(what.sentences, styles, strict=False):
        wrapped(console, Text(words, style=style), _INDENT)
    for name, lines in (("Found", what.found), ("Model answer", what.model)):
        if lines:
            wrapped(console, Text(f"{name}:", style="bold"), _INDENT)
        for line in lines:
            wrapped(console, Text(line), _INDENT + 2)
    if what.place is not None:
        wrapped(console, Text(location_text(what.place), style="dim"), _INDENT)
        source = page.report.submission.source(what.place.path)
        if source is not None:
            show_excerpt(console, source, what.place, _INDENT)
    if what.feedback and what.feedback not in page.shown:
        page.shown.add(what.feedback)
        wrapped(console, Text(what.feedback, style="italic"), _INDENT)


def _show_evidence(report: Report, console: Console) -> None:
    if not report.exhibits:
        return
    console.print()
    console.print(Text("Evidence", style="bold"))
    for title, lines in evidence(report):
        wrapped(console, Text(title, style="dim"), 2)
        for words, is_there in lines[:_MOST_LISTED]:
            wrapped(console, Text(words, style="" if is_there else "yellow"), 4)
        if len(lines) > _MOST_LISTED:
            wrapped(console, Text(f"... and {len(lines) - _MOST_LISTED} more"), 4)
