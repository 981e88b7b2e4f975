"""A report for a person at a terminal: the score first, failures explained, the rest short."""

from itertools import groupby
from typing import NamedTuple

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report, Result
from grader.report import content
from grader.report.console import show_excerpt, show_problems, symbol, wrapped
from grader.text import first_lines, format_points, printable

_STYLES = {"passed": "green", "failed": "bold red", "skipped": "yellow", "pending": "cyan", "errored": "bold magenta"}
_SYMBOLS = {
    "passed": ("\u2713", "+"),
    "failed": ("\u2717", "X"),
    "skipped": ("\u2212", "-"),
    "pending": ("?", "?"),
    "errored": ("!", "!"),
}
_INDENT = 10
_MAX_LISTED = 12


class _Page(NamedTuple):
    """The report, the console, and the feedback that is printed already."""

    report: Report
    console: Console
    shown: set[str]


def render_terminal(report: Report, console: Console) -> None:
    """Print a report. Text of the submission is never interpreted as markup or control codes."""
    _print_head(report, console)
    page = _Page(report, console, set())
    titles = {part.id: part.title for part in report.rubric.parts}
    for part, of_part in groupby(report.results, key=lambda result: result.criterion.part):
        results = tuple(of_part)
        if len(report.parts) > 1:
            console.print()
            heading = f"{printable(titles[part])}  {content.earned_text(results)}"
            wrapped(console, Text(heading, style="bold underline"), 0)
        _print_groups(results, titles[part], page)
    _print_evidence(report, console)
    problems = tuple(content.other_problems(report))
    if problems:
        console.print()
        console.print(Text(content.other_problems_title(report), style="bold"))
        show_problems(console, problems, report.submission.source, report.submission.path)
    if command := content.advice(report):
        console.print()
        wrapped(console, Text(command, style="dim"), 0)


def _print_head(report: Report, console: Console) -> None:
    style = "bold green" if report.score + report.pending == report.max_score else "bold"
    title = printable(report.rubric.title)
    wrapped(console, Text.assemble((content.score_text(report), style), "  ", (title, "bold")), 0)
    lines = [(content.summary(report), ""), (content.package_line(report), ""), (content.pending_line(report), "cyan")]
    lines += [(note, "cyan") for note in content.notes(report)] + [
        (line, "dim") for line in content.ignored_lines(report)
    ]
    for line, line_style in lines:
        if line:
            wrapped(console, Text(line, style=line_style), 0)


def _print_groups(results: tuple[Result, ...], title: str, page: _Page) -> None:
    """Print the criteria of a part, those about one thing under one heading.

    Of several parts, a group with the title of its part has no heading. Adjacent groups that are skipped or pending for the same
    reason are one line.
    """
    named = [
        (name, tuple(group)) for name, group in groupby(results, key=lambda result: result.criterion.about or title)
    ]
    for reasons, alike in groupby(named, key=lambda group: set(map(_reason, group[1]))):
        groups = list(alike)
        alike_results = tuple(result for _, group in groups for result in group)
        reason = next(iter(reasons)) if len(reasons) == 1 else None
        if reason is None or len(alike_results) == 1:
            for name, group in groups:
                if name != title or len(page.report.parts) == 1:
                    _print_heading(name, group, page.console)
                for result in group:
                    _print_result(result, page)
        else:
            _print_heading(", ".join(name for name, _ in groups), alike_results, page.console)
            maximum = content.earned_text(alike_results).partition("/")[2]
            start = _line_start(alike_results[0].outcome.status, f"0/{maximum:<3}", page.console)
            text = Text(printable(f"{len(alike_results)} criteria are {reason}"), style="dim")
            wrapped(page.console, text, _INDENT, start)


def _reason(result: Result) -> str | None:
    """Return the reason for which a criterion is skipped or pending, None for another one."""
    if result.because is not None and result.manual_mark is None:
        return f"skipped because {result.because} failed"
    is_open = result.is_open and not isinstance(result.outcome.measured, str)  # answers are shown one by one
    return f"pending: {result.outcome.message}" if is_open else None


def _print_heading(name: str, results: tuple[Result, ...], console: Console) -> None:
    console.print()
    wrapped(console, Text.assemble((printable(name), "bold"), (f"  {content.earned_text(results)}", "dim")), 0)


def _line_start(status: str, points: str, console: Console) -> Text:
    return Text.assemble("  ", (symbol(console, *_SYMBOLS[status]), _STYLES[status]), f" {points:<5} ")


def _print_result(result: Result, page: _Page) -> None:
    criterion, status = result.criterion, content.status_of(result)
    start = _line_start(status, f"{format_points(result.points)}/{format_points(criterion.points)}", page.console)
    title, name = Text(printable(criterion.title)), Text(criterion.id)
    if result.manual_mark is None and status == "passed":
        wrapped(page.console, title, _INDENT, start)
    elif result.manual_mark is None and status == "skipped":
        reason = Text(f"  skipped because {result.because} failed", style="dim")
        wrapped(page.console, name + reason, _INDENT, start)
    else:
        details = content.result_details(result, page.report)
        name.stylize("dim" if not details.expected else "")
        wrapped(page.console, name if details.expected else title + Text("  ") + name, _INDENT, start)
        styles = (
            _STYLES["errored"] if result.outcome.status == "errored" else "",
            "bold",
        )  # faults of the grader stand out
        _print_details(details, ("bold", "dim") if result.manual_mark is not None else styles, page)


def _print_details(details: content.Details, styles: tuple[str, ...], page: _Page) -> None:
    console = page.console
    for text, style in zip(details.sentences, styles, strict=False):
        wrapped(console, Text(text, style=style), _INDENT)
    if details.expected:
        wrapped(console, Text(details.expected), _INDENT)
    for title, lines in (("Found", details.answer), ("Model answer", details.model_answer)):
        if lines:
            wrapped(console, Text(f"{title}:", style="bold"), _INDENT)
        for line in lines:
            wrapped(console, Text(line), _INDENT + 2)
    if details.location is not None:
        wrapped(console, Text(content.location_text(details.location), style="dim"), _INDENT)
        source = page.report.submission.source(details.location.path)
        if source is not None:
            show_excerpt(console, source, details.location, _INDENT)
    if details.feedback and details.feedback not in page.shown:
        page.shown.add(details.feedback)
        wrapped(console, Text(details.feedback, style="italic"), _INDENT)


def _print_evidence(report: Report, console: Console) -> None:
    if not report.exhibits:
        return
    console.print()
    console.print(Text("Evidence", style="bold"))
    for title, lines in content.evidence(report):
        wrapped(console, Text(title, style="dim"), 2)
        for text, is_found in lines[:_MAX_LISTED]:
            wrapped(console, Text(text, style="" if is_found else "yellow"), 4)
        for text in first_lines([text for text, _ in lines], _MAX_LISTED)[_MAX_LISTED:]:
            wrapped(console, Text(text), 4)
