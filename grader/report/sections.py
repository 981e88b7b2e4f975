"""The sections of a class side by side, on a terminal."""

from rich.console import Console
from rich.table import Table
from rich.text import Text

from grader.classroom.gradebook.sections import Section, SectionComparison
from grader.report.class_words import DECIDED, percent
from grader.report.console import wrapped
from grader.text import format_points, printable

_NOTE = "Means and medians do not include late penalties, which are subtracted when grades are exported."


def render_sections(comparison: SectionComparison, console: Console) -> None:
    """Print a row for each section, and the criteria that differ most with the share of each section."""
    table = _table(comparison.by, "students", "graded", "mean", "median", "late", "late penalty")
    for section in comparison.sections:
        table.add_row(
            _name(section, comparison),
            str(section.students),
            str(section.graded),
            *(f"{number:.1f}" if number is not None else "" for number in (section.mean, section.median)),
            str(section.late),
            format_points(section.late_points),
        )
    wrapped(console, Text(f"Grades out of {format_points(comparison.out_of)}{DECIDED}", style="bold"), 0)
    console.print(table)
    wrapped(console, Text(_NOTE, style="dim"), 0)
    if comparison.differing:
        _print_criteria(comparison, console)


def _print_criteria(comparison: SectionComparison, console: Console) -> None:
    console.print()
    wrapped(console, Text("Criteria that differ most: mean share of the points earned", style="bold"), 0)
    for position in comparison.differing:
        criterion = comparison.criteria[position]
        shares = ((_name(section, comparison), section.shares[position]) for section in comparison.sections)
        listed = ", ".join(f"{name} {percent(share)}" for name, share in shares if share is not None)
        head = f"{criterion.id} ({format_points(criterion.points)})"
        wrapped(console, Text(printable(f"{head}: {listed}")), 4, Text("  "))


def _table(first: str, *others: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column(first)
    for name in others:
        table.add_column(name, justify="right", no_wrap=True)
    return table


def _name(section: Section, comparison: SectionComparison) -> str:
    return printable(section.name) or f"(no {comparison.by})"
