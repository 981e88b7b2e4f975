"""The edits that many students of a class need, on a terminal: each with an example as a diff."""

from collections.abc import Iterator, Sequence
from textwrap import dedent

from rich.console import Console
from rich.text import Text

from grader.classroom.gradebook.fixes import CommonFix
from grader.report.console import wrapped
from grader.source import Edit
from grader.text import counted, counted_points, enumerated, printable

_NOTE = "Each edit was tested: the listed criteria pass, and no other criterion fails."
_INDENT = 8
_MAX_EDITS, _MAX_LINES, _MAX_NAMED = 4, 6, 4
_MAX_WIDTH = 200  # characters of a line of a student's file


def print_fixes(fixes: Sequence[CommonFix], console: Console) -> None:
    """Print edits with the number of students who need them. Text of submissions is never interpreted as markup."""
    console.print()
    console.print(Text("Edits that would fix the most", style="bold"))
    wrapped(console, Text(_NOTE, style="dim"), 2)
    for fix in fixes:
        who = Text(f"{counted(fix.count, 'student')}: ", style="bold")
        wrapped(console, who + Text(printable(fix.action)), 4, Text("  "))
        for sign, style, line in _diff(fix.example):
            wrapped(
                console, Text(printable(line), style=style), _INDENT + 2, Text(f"{' ' * _INDENT}{sign} ", style=style)
            )
        wrapped(console, Text(_gain(fix), style="dim"), _INDENT)


def _gain(fix: CommonFix) -> str:
    gain = f", +{counted_points(fix.points)}" if fix.points else ""
    return printable(f"{enumerated(fix.criteria, _MAX_NAMED)} {'passes' if len(fix.criteria) == 1 else 'pass'}{gain}")


def _lines(text: str) -> list[str]:
    """Return the lines of an edit, which begins within a line, without the indent that the others have in common."""
    first, _, others = text.partition("\n")
    return [line for line in (first.strip(), *dedent(others).splitlines()) if line.strip()]


def _diff(edits: Sequence[Edit]) -> Iterator[tuple[str, str, str]]:
    """Yield the lines of edits, each with its sign and style."""
    for edit in edits[:_MAX_EDITS]:
        if edit.renamed:
            yield " ", "dim", f"rename {edit.path} to {edit.renamed}"
        for sign, style, text in (("-", "red", edit.old), ("+", "green", edit.new)):
            lines = _lines(text)
            for line in lines[:_MAX_LINES]:
                yield sign, style, line if len(line) <= _MAX_WIDTH else f"{line[: _MAX_WIDTH - 3]}..."
            if len(lines) > _MAX_LINES:
                yield " ", "dim", f"... {len(lines) - _MAX_LINES} more lines"
    if len(edits) > _MAX_EDITS:
        yield " ", "dim", f"... {counted(len(edits) - _MAX_EDITS, 'more edit')}"
