"""A report for a person at a terminal: the score first, failures explained, the rest short."""

from collections.abc import Iterable, Iterator
from decimal import Decimal
from itertools import groupby

from rich.console import Console
from rich.text import Text

from grader.grading.report import Exhibits, Report, Result, Ruling
from grader.report.layout import place_words, show_excerpt, show_problems, symbol, wrapped
from grader.report.points import points_words
from grader.report.text import printable
from grader.robot.catalogue import Problem

_STYLES = {"passed": "green", "failed": "bold red", "skipped": "yellow", "pending": "cyan", "errored": "bold magenta"}
_SYMBOLS = {
    "passed": ("\u2713", "+"),
    "failed": ("\u2717", "X"),
    "skipped": ("\u2212", "-"),
    "pending": ("?", "?"),
    "errored": ("!", "!"),
}
_INDENT = 10
_VERDICTS = {
    "clean": "ROS 2 loads the file",
    "degraded": "ROS 2 loads the file, but drops some of it",
    "rejected": "ROS 2 rejects the file",
}
_MOST_LISTED = 12


def render_terminal(report: Report, console: Console) -> None:
    """Print a report. Nothing of the submission is taken for markup or control codes."""
    _show_head(report, console)
    shown: set[str] = set()
    titles = {part.id: part.title for part in report.rubric.parts}
    for part, of_part in groupby(report.results, key=lambda each: each.criterion.part):
        results = tuple(of_part)
        if len(report.parts) > 1:
            console.print()
            heading = f"{printable(titles[part])}  {_earned(results)}"
            wrapped(console, Text(heading, style="bold underline"), 0)
        whole = None if len(report.parts) == 1 else titles[part]
        _show_groups(results, titles[part], whole, report, console, shown)
    _show_evidence(report, console)
    problems = tuple(_untold(report))
    if problems:
        console.print()
        what = "file" if report.submission.is_single else "files"
        console.print(Text(f"What else there is to say of the {what}", style="bold"))
        show_problems(console, problems, report.submission.source, report.submission.path)
    if report.counts("failed"):
        console.print()
        wrapped(console, Text(_advice(report), style="dim"), 0)


def _untold(report: Report) -> Iterator[Problem]:
    """The problems that no failed criterion has told already."""
    told = [(each.outcome.location, each.outcome.message) for each in report.results if each.outcome.status == "failed"]
    for problem in report.problems:
        if not any(where == problem.location and problem.message in message for where, message in told):
            yield problem


def _show_head(report: Report, console: Console) -> None:
    score = f"{points_words(report.score)} / {points_words(report.max_score)} points"
    style = "bold green" if report.score + report.pending == report.max_score else "bold"
    wrapped(console, Text.assemble((score, style), "  ", (printable(report.rubric.title), "bold")), 0)
    submission = report.submission
    decided = [each.outcome.status if each.ruling is None else "marked by hand" for each in report.results]
    statuses = ("passed", "failed", "skipped", "pending", "errored", "marked by hand")
    counted = [f"{decided.count(status)} {status}" for status in statuses if status in decided]
    graded = f"{printable(submission.path or '')}: not read" if submission.unread else "no URDF was submitted"
    if submission.path is not None and submission.has_urdf:
        verdict = _VERDICTS[submission.verdict] if submission.verdict else "xacro that a person has to expand"
        graded = f"{printable(submission.path)}: {verdict}"
    wrapped(console, Text(f"{graded}; {', '.join(counted)}"), 0)
    package = submission.package
    if package is not None and any(report.rubric.part(part).needs == "package" for part in report.parts):
        where = f" in {package.folder}" if package.folder else ""
        wrapped(console, Text(printable(f"package {package.name}{where}")), 0)
    if report.pending:
        wrapped(console, Text(f"{points_words(report.pending)} points wait for a person", style="cyan"), 0)
    for note in report.notes:
        wrapped(console, Text(f"Note: {printable(note)}", style="cyan"), 0)
    passed_over = [f"Passed over {each.path}: {each.because}" for each in submission.passed_over]
    _show_lines([*passed_over, *(f"Left out: {each}" for each in submission.left_out)], console)


def _show_lines(lines: list[str], console: Console) -> None:
    for line in lines[:_MOST_LISTED]:
        wrapped(console, Text(printable(line), style="dim"), 0)
    if len(lines) > _MOST_LISTED:
        wrapped(console, Text(f"... and {len(lines) - _MOST_LISTED} more", style="dim"), 0)


def _earned(results: tuple[Result, ...]) -> str:
    earned = sum((result.points for result in results), Decimal(0))
    most = sum((result.criterion.points for result in results), Decimal(0))
    return f"{points_words(earned)}/{points_words(most)}"


def _show_groups(
    results: tuple[Result, ...], title: str, whole: str | None, report: Report, console: Console, shown: set[str]
) -> None:
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
                    _show_heading(name, group, console)
                for result in group:
                    _show_result(result, report, console, shown)
        else:
            _show_heading(", ".join(name for name, _ in groups), alike_results, console)
            _show_alike(alike_results, reason, console)


def _shared(results: tuple[Result, ...]) -> str | None:
    """What all of several criteria are skipped for, or wait for, if there is such a thing."""
    reasons = {_reason(each) for each in results}
    return reasons.pop() if len(reasons) == 1 else None


def _reason(result: Result) -> str | None:
    if result.because is not None and result.ruling is None:
        return f"skipped, because {result.because} failed"
    is_open = result.is_open and result.outcome.expected is None
    return f"pending: {result.outcome.message}" if is_open else None


def _show_heading(name: str, results: tuple[Result, ...], console: Console) -> None:
    console.print()
    wrapped(console, Text.assemble((printable(name), "bold"), (f"  {_earned(results)}", "dim")), 0)


def _show_alike(results: tuple[Result, ...], reason: str, console: Console) -> None:
    """One line for criteria that are skipped, or wait, for the same reason."""
    status = results[0].outcome.status
    most = _earned(results).partition("/")[2]
    head = Text.assemble("  ", (symbol(console, *_SYMBOLS[status]), _STYLES[status]), f" 0/{most:<3} ")
    wrapped(console, Text(printable(f"{len(results)} criteria are {reason}"), style="dim"), _INDENT, head)


def _show_result(result: Result, report: Report, console: Console, shown: set[str]) -> None:
    criterion, outcome = result.criterion, result.outcome
    style = _STYLES[outcome.status]
    points = f"{points_words(result.points)}/{points_words(criterion.points)}"
    head = Text.assemble("  ", (symbol(console, *_SYMBOLS[outcome.status]), style), f" {points:<5}")
    title = Text(printable(criterion.title))
    if result.ruling is not None:
        _show_ruling(result, result.ruling, title, head, console)
        return
    if outcome.status == "passed":
        wrapped(console, title, _INDENT, head.append(" "))
        return
    if outcome.status == "skipped":
        wrapped(
            console, title + Text(f"  skipped, because {result.because} failed", style="dim"), _INDENT, head.append(" ")
        )
        return
    wrapped(console, title + Text(f"  {criterion.id}", style="dim"), _INDENT, head.append(" "))
    wrapped(console, Text(_sentence(outcome.message), style=style if outcome.status == "errored" else ""), _INDENT)
    if outcome.status == "pending" and isinstance(outcome.expected, str):
        _show_answer(outcome.measured, outcome.expected, console)
    if outcome.status != "failed":
        return
    if outcome.location is not None:
        wrapped(console, Text(place_words(outcome.location), style="dim"), _INDENT)
        source = report.submission.source(outcome.location.path)
        if source is not None:
            show_excerpt(console, source, outcome.location, _INDENT)
    is_there = report.submission.has_urdf or criterion.check.subject not in ("urdf", "robot")
    if criterion.feedback and criterion.feedback not in shown and is_there:
        shown.add(criterion.feedback)
        wrapped(console, Text(criterion.feedback, style="italic"), _INDENT)


def _show_ruling(result: Result, ruling: Ruling, title: Text, head: Text, console: Console) -> None:
    """What a person has decided, whatever the check has found."""
    outcome = result.outcome
    wrapped(console, title + Text(f"  {result.criterion.id}", style="dim"), _INDENT, head.append(" "))
    comment = f": {ruling.comment}" if ruling.comment else ""
    wrapped(console, Text(_sentence(f"Marked by {ruling.by}{comment}"), style="bold"), _INDENT)
    if outcome.status == "pending" and isinstance(outcome.expected, str):
        _show_answer(outcome.measured, outcome.expected, console)
    elif outcome.status != "pending":
        wrapped(console, Text(_sentence(f"The check: {outcome.status}. {outcome.message}"), style="dim"), _INDENT)


def _show_answer(found: object, model: str, console: Console) -> None:
    """What was answered, beside the model answer."""
    for words, text in (("Found", found), ("Model answer", model)):
        if not isinstance(text, str):
            continue
        wrapped(console, Text(f"{words}:", style="bold"), _INDENT)
        for line in filter(str.strip, text.splitlines()):
            wrapped(console, Text(printable(line)), _INDENT + 2)


def _show_evidence(report: Report, console: Console) -> None:
    if not report.exhibits:
        return
    console.print()
    console.print(Text("Evidence", style="bold"))
    parts = {part.id: part.title for part in report.rubric.parts}
    for part, asked in groupby(report.exhibits, key=lambda each: each.evidence.part):
        wrapped(console, Text(f"{printable(parts[part])}", style="dim"), 2)
        for found in asked:
            _show_exhibits(found, console)
    if report.others:
        wrapped(console, Text("Other pictures and documents", style="dim"), 2)
        for exhibit in report.others[:_MOST_LISTED]:
            wrapped(console, Text(f"{printable(exhibit.words)}"), 4)
        if len(report.others) > _MOST_LISTED:
            wrapped(console, Text(f"... and {len(report.others) - _MOST_LISTED} more"), 4)


def _show_exhibits(found: Exhibits, console: Console) -> None:
    names = found.files[:_MOST_LISTED]
    listed = ", ".join(printable(exhibit.words) for exhibit in names)
    style = "" if names else "yellow"
    wrapped(console, Text(f"{printable(found.evidence.title)}: {listed or 'missing'}", style=style), 4)


def _sentence(message: str) -> str:
    text = printable(message)
    if text.split(" ")[0].isalpha():  # an attribute of the file, as in xyz="0 0", stays as it is
        text = text[:1].upper() + text[1:]
    return text if text.endswith((".", "?")) else f"{text}."


def _advice(report: Report) -> str:
    first = next(_failed(report.results))
    rubric = "" if report.rubric.is_shipped else f" --rubric {printable(report.rubric.path.name)}"
    whole = ", `grader inspect` shows the whole robot" if report.submission.has_urdf else ""
    return f"`grader explain {first}{rubric}` says how it is decided{whole}."


def _failed(results: Iterable[Result]) -> Iterator[str]:
    return (result.criterion.id for result in results if result.outcome.status == "failed")
