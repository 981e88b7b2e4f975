"""The whole report on a terminal: each criterion with all that is said about it."""

from collections.abc import Iterator, Sequence
from itertools import groupby

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report, Result
from grader.problems import Problem
from grader.report import content
from grader.report.console import INDENT, LOOKS, Page, block, excerpt_block, show_entry
from grader.report.criteria import Section, earned_text, groups, status_of
from grader.report.document import Document
from grader.report.locations import SourceOf, calls_text
from grader.text import first_lines, printable

_MAX_PROBLEMS = 30


def show_everything(report: Report, found: Document, page: Page) -> None:
    """Add a report, without its last lines."""
    for line in content.head(report):
        page.line(line.text, LOOKS[line.role])
    for section in found.sections:
        _show_section(section, report, page)
    _show_parts(report, page)
    for section in content.closing(report):
        _show_section(section, report, page)
    page.leave_row()
    if report.submission.has_urdf:
        page.line("grader inspect shows the whole robot.", "dim")


def _show_section(section: Section, report: Report, page: Page) -> None:
    page.title(section.title)
    for number, entry in enumerate(section.entries):
        if number and section.title == "Failed":
            page.leave_row()
        show_entry(entry, report, page)
    if section.lines and section.lines[0].role in ("error", "warning", "note"):
        problems, submission = content.other_problems(report), report.submission
        page.rows.extend(problem_rows(page.console, problems, submission.source, submission.path))
        return
    for line in section.lines:
        page.inset(line.text, LOOKS[line.role], 2 * INDENT if line.role in ("found", "missing") else INDENT)


def _show_parts(report: Report, page: Page) -> None:
    """Add each part with its groups and all their criteria."""
    for part, of_part in groupby(groups(report), key=lambda group: group.part):
        found, title = list(of_part), report.rubric.part(part).title
        if len(report.parts) > 1:
            points = earned_text(*(result for group in found for result in group.results))
            page.title(f"{printable(title)}  {points}", "bold underline")
        for group in found:
            if len(found) > 1 or group.title != title:
                page.title(Text.assemble((printable(group.title), "bold"), (f"  {group.points}", "dim")))
            for result in group.results:
                start = Text.assemble("  ", page.mark(status_of(result)), f" {earned_text(result):<5} ")
                page.inset(_row(result), indent=len(start), head=start)


def _row(result: Result) -> Text:
    """Return a criterion in a line: its title if it passed, else its name, because a title would read as a fact."""
    status = status_of(result)
    if status == "passed":
        return Text(printable(result.criterion.title))
    is_consequence = status == "skipped" and result.because is not None
    reason = f"  skipped because {printable(result.because or '')} failed" if is_consequence else ""
    return Text.assemble(printable(result.criterion.id), (reason, "dim"))


def problem_rows(
    console: Console, problems: Sequence[Problem], source_of: SourceOf, main: str | None
) -> Iterator[Text]:
    """Yield problems with their code and location, errors with their source line. In `main` only the line is named."""
    for problem in problems[:_MAX_PROBLEMS]:
        where, style = problem.location, LOOKS[problem.severity]
        head = Text.assemble("  ", (f"{problem.code} {problem.severity:<7} ", style))
        named = f"line {where.line}" if where.path == main else f"{printable(where.path)}:{where.line}"
        message = Text.assemble((f"{named}{calls_text(where)}: ", "dim"), printable(problem.message))
        yield block(console, message, len(head), head)
        source = source_of(where.path) if problem.severity == "error" else None
        if source is not None:
            yield excerpt_block(console, source, where, min(len(head), console.width // 5))
    for text in first_lines([problem.code for problem in problems], _MAX_PROBLEMS)[_MAX_PROBLEMS:]:
        yield block(console, Text(text), INDENT)
