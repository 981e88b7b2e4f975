"""A report for a person at a terminal: the score first, failures explained, the rest short."""

from collections.abc import Iterable, Iterator
from decimal import Decimal
from itertools import groupby

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report, Result
from grader.report.layout import place_words, show_excerpt, show_problems, symbol, wrapped
from grader.report.points import points_words
from grader.report.text import printable
from grader.robot.reader import Reading

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


def render_terminal(report: Report, console: Console) -> None:
    """Print a report. Nothing of the submission is taken for markup or control codes."""
    _show_head(report, console)
    shown: set[str] = set()
    titles = {part.id: part.title for part in report.rubric.parts}
    for about, results in groupby(report.results, key=lambda each: each.criterion.about or titles[each.criterion.part]):
        _show_group(about, tuple(results), report.submission.urdf, console, shown)
    told = [(each.outcome.location, each.outcome.message) for each in report.results if each.outcome.status == "failed"]
    problems = tuple(
        problem
        for problem in report.submission.urdf.problems
        if not any(where == problem.location and problem.message in message for where, message in told)
    )
    if problems:
        console.print()
        console.print(Text("What else there is to say of the file", style="bold"))
        show_problems(console, problems, report.submission.urdf.source)
    if report.counts("failed"):
        console.print()
        wrapped(console, Text(_advice(report), style="dim"), 0)


def _show_head(report: Report, console: Console) -> None:
    score = f"{points_words(report.score)} / {points_words(report.max_score)} points"
    style = "bold green" if report.score == report.max_score else "bold"
    wrapped(console, Text.assemble((score, style), "  ", (printable(report.rubric.title), "bold")), 0)
    urdf = report.submission.urdf
    counted = [
        f"{report.counts(status)} {status}" for status in ("passed", "failed", "skipped", "pending", "errored")
        if report.counts(status)
    ]  # fmt: skip
    wrapped(console, Text(f"{printable(report.submission.path)}: {_VERDICTS[urdf.verdict]}; {', '.join(counted)}"), 0)
    if report.pending:
        wrapped(console, Text(f"{points_words(report.pending)} points wait for a person", style="cyan"), 0)


def _show_group(about: str, results: tuple[Result, ...], urdf: Reading, console: Console, shown: set[str]) -> None:
    earned = points_words(sum((result.points for result in results), Decimal(0)))
    most = points_words(sum((result.criterion.points for result in results), Decimal(0)))
    console.print()
    wrapped(console, Text.assemble((printable(about), "bold"), (f"  {earned}/{most}", "dim")), 0)
    causes = {result.because for result in results}
    if len(results) > 1 and len(causes) == 1 and None not in causes:
        text = f"{len(results)} criteria are skipped, because {results[0].because} failed"
        head = Text.assemble("  ", (symbol(console, *_SYMBOLS["skipped"]), _STYLES["skipped"]), f" 0/{most:<3} ")
        wrapped(console, Text(text, style="dim"), _INDENT, head)
        return
    for result in results:
        _show_result(result, urdf, console, shown)


def _show_result(result: Result, urdf: Reading, console: Console, shown: set[str]) -> None:
    criterion, outcome = result.criterion, result.outcome
    style = _STYLES[outcome.status]
    points = f"{points_words(result.points)}/{points_words(criterion.points)}"
    head = Text.assemble("  ", (symbol(console, *_SYMBOLS[outcome.status]), style), f" {points:<5}")
    title = Text(printable(criterion.title))
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
    if outcome.status != "failed":
        return
    if outcome.location is not None:
        wrapped(console, Text(place_words(outcome.location), style="dim"), _INDENT)
        show_excerpt(console, urdf.source, outcome.location, _INDENT)
    if criterion.feedback and criterion.feedback not in shown:
        shown.add(criterion.feedback)
        wrapped(console, Text(criterion.feedback, style="italic"), _INDENT)


def _sentence(message: str) -> str:
    text = printable(message)
    if text.split(" ")[0].isalpha():  # an attribute of the file, as in xyz="0 0", stays as it is
        text = text[:1].upper() + text[1:]
    return text if text.endswith((".", "?")) else f"{text}."


def _advice(report: Report) -> str:
    first = next(_failed(report.results))
    rubric = "" if report.rubric.is_shipped else f" --rubric {printable(report.rubric.path.name)}"
    return f"`grader explain {first}{rubric}` says how it is decided, `grader inspect` shows the whole robot."


def _failed(results: Iterable[Result]) -> Iterator[str]:
    return (result.criterion.id for result in results if result.outcome.status == "failed")
