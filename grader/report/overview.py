"""The whole submission in the report for a terminal: points of each group, evidence, other problems, how it was read."""

from collections.abc import Sequence
from itertools import groupby

from rich.console import Console
from rich.text import Text

from grader.grading.report import Result
from grader.problems import Problem
from grader.report import content
from grader.report.console import SEVERITY_STYLES, block, put, show_problems, wrapped
from grader.report.details import group_status, status_of
from grader.report.entries import INDENT, Page, mark
from grader.report.order import Group, alike, groups
from grader.report.plain_text import evidence, evidence_line
from grader.text import counted, first_lines, printable

_MAX_LISTED, _MAX_KINDS = 12, 3


def show_groups(page: Page) -> None:
    """Print the points of each group; without details those of which nothing is known yet are listed elsewhere."""
    report, console = page.report, page.console
    titles = {part.id: part.title for part in report.rubric.parts}
    shown = [
        group for group in groups(report) if page.is_verbose or not all(result.is_open for result in group.results)
    ]
    if not page.is_verbose:
        kinds = [kind for kind in alike(shown, group_status) if page.room > 1 or kind[0] != "passed"]
        if kinds:
            page.leave_row()
        for status, some in sorted(kinds, key=lambda kind: kind[0] == "passed"):
            names = (f"{printable(group.title)} {content.earned_text(group.results)}" for group in some)
            wrapped(console, Text(", ".join(names)), INDENT, mark(status, console) + Text(" "))
        return
    for part, of_part in groupby(shown, key=lambda group: group.part):
        found = list(of_part)
        if len(report.parts) > 1:
            console.print()
            points = content.earned_text(tuple(result for group in found for result in group.results))
            wrapped(console, Text(f"{printable(titles[part])}  {points}", "bold underline"), 0)
        for group in found:
            _show_criteria(group, page, has_title=len(found) > 1 or group.title != titles[part])


def _show_criteria(group: Group, page: Page, *, has_title: bool) -> None:
    console = page.console
    if has_title:
        console.print()
        points = Text(f"  {content.earned_text(group.results)}", "dim")
        wrapped(console, Text(printable(group.title), "bold") + points, 0)
    for result in group.results:
        start = Text("  ") + mark(status_of(result), console) + Text(f" {content.earned_text((result,)):<5} ")
        wrapped(console, _line(result), len(start), start)


def _line(result: Result) -> Text:
    """Return a criterion in a line: its title if it passed, else its name, because a title would read as a fact."""
    if status_of(result) == "passed":
        return Text(printable(result.criterion.title))
    name = Text(printable(result.criterion.id))
    if result.because is not None and result.manual_mark is None and not result.is_adjusted:
        name.append(f"  skipped because {printable(result.because)} failed", "dim")
    return name


def show_evidence(page: Page) -> None:
    """Print the evidence that was found, and what is missing."""
    console = page.console
    if not page.is_verbose:
        if page.room and (line := evidence_line(page.report)):
            wrapped(console, Text(line, "dim"), INDENT, Text())
        return
    for number, (title, lines) in enumerate(evidence(page.report)):
        if number == 0:
            console.print()
            wrapped(console, Text("Evidence", "bold"), 0)
        wrapped(console, Text(title, "dim"), INDENT)
        for text, is_found in lines[:_MAX_LISTED]:
            wrapped(console, Text(text, "" if is_found else "yellow"), 2 * INDENT)
        for text in first_lines([text for text, _ in lines], _MAX_LISTED)[_MAX_LISTED:]:
            wrapped(console, Text(text), 2 * INDENT)


def show_other_problems(page: Page) -> None:
    """Print the problems that no failed criterion has reported: one of each kind of error and warning; notes are counted."""
    report, console = page.report, page.console
    problems = tuple(content.other_problems(report))
    listed = problems if page.is_verbose else tuple(found for found in problems if found.severity != "note")
    if not page.room:
        problems = listed = tuple(found for found in listed if not found.kind.is_consequence)
    if listed:
        page.leave_row()
    if page.is_verbose and listed:
        wrapped(console, Text(content.other_problems_title(report), "bold"), 0)
        show_problems(console, problems, report.submission.source, report.submission.path)
        return
    kinds = alike(listed, lambda problem: f"{problem.code} {problem.location.path}")
    for _, some in kinds[:_MAX_KINDS]:
        put(console, _kind_block(some, console, most=2 if page.room else 1))
    rest = len(problems) - sum(len(some) for _, some in kinds[:_MAX_KINDS])
    if rest:
        noun = "problem" if len(kinds) > _MAX_KINDS else "note"
        words = counted(rest, f"more {noun}" if listed else noun)
        wrapped(console, Text(f"{words}: --verbose shows {'it' if rest == 1 else 'them'}", "dim"), 0)


def _kind_block(problems: Sequence[Problem], console: Console, most: int) -> Text:
    """Return problems of one kind in one file in few lines: code, place and message of the first, and how many more."""
    first, more = problems[0], len(problems) - 1
    where = f"{printable(first.location.path.rpartition('/')[2])}:{first.location.line}"
    text = Text.assemble((f"{first.code} {first.severity} ", SEVERITY_STYLES[first.severity]), (where, "dim"))
    text.append(f"{f' and {more} more' if more else ''}: {printable(first.message)}")
    return block(console, text, INDENT, Text(), most=most)


def show_notes(page: Page) -> None:
    """Print how the submission was read: what it was not graded on, other candidates, ignored files."""
    report = page.report
    notes = [(note, "cyan") for note in content.notes(report)]
    ignored = content.ignored_lines(report) if page.is_verbose else content.first_ignored(report)
    if page.is_verbose and (notes or ignored):
        page.console.print()
    for line, style in (*notes, *((line, "dim") for line in ignored)):
        wrapped(page.console, Text(line, style), INDENT, Text())
