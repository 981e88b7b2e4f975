"""The summary of a class on a terminal: grades, criteria, common mistakes, who needs attention."""

from collections.abc import Iterable, Mapping, Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

from grader.classroom.gradebook.agreement import Agreement
from grader.classroom.gradebook.attention import Attention
from grader.classroom.gradebook.criterion_statistics import ChoiceCount, CriterionStatistics
from grader.classroom.gradebook.hints import CommonFix
from grader.classroom.gradebook.identical import IdenticalWork
from grader.classroom.gradebook.statistics import ClassStatistics, CommonFailure
from grader.classroom.gradebook.summary import ClassSummary
from grader.report import class_words as words
from grader.report.console import wrapped
from grader.text import counted, format_points, people_text, printable

_BAR_WIDTH = 40
_INDENT = 8
_STYLES = {"-": "red", "+": "green"}


def render_class(summary: ClassSummary, console: Console, *, verbose: bool = False) -> None:
    """Print the summary of a class. Text of submissions is never interpreted as markup or control codes.

    Only with `verbose`, all students who need attention are named.
    """
    statistics = summary.statistics
    wrapped(console, Text(printable(summary.rubric.title), style="bold"), 0)
    heads = words.counts_line(statistics), words.final_line(statistics), words.earlier_line(statistics)
    for line in filter(None, heads):
        wrapped(console, Text(line), 0)
    if statistics.graded:
        _print_marks(statistics, console)
        _print_criteria(statistics.criteria, words.adjusted_lines(summary.rubric), console)
        _print_failures(statistics.failures[: words.MAX_LISTED], console)
    _print_fixes(summary.fixes[: words.MAX_LISTED], console)
    _print_choices(summary.choices, console)
    _print_agreement(summary.agreement, summary.names, console)
    _print_identical(summary.identical, summary.names, console)
    _print_attention(summary.attention, summary.names, console, verbose=verbose)
    for line in filter(None, (*words.evidence_lines(summary), words.late_line(summary))):
        console.print()
        wrapped(console, Text(line), 0)


def _print_marks(statistics: ClassStatistics, console: Console) -> None:
    console.print()
    for line in words.mark_lines(statistics):
        wrapped(console, Text(line), 0)
    most = max(statistics.bins)
    for tenth, count in enumerate(statistics.bins if most else ()):
        bar = "#" * -(-count * min(_BAR_WIDTH, console.width - 30) // most)
        console.print(Text(f"  {words.span(statistics, tenth):>14} {count:>6}  {bar}"), no_wrap=True, crop=False)


def _print_failures(failures: Sequence[CommonFailure], console: Console) -> None:
    if failures:
        _print_heading("Common mistakes", console)
    for failure in failures:
        head = Text(f"{failure.count:>6}  ", style="bold")
        wrapped(console, Text(printable(f"{failure.criterion.id}: {failure.message}")), 8, head)


def _print_fixes(fixes: Sequence[CommonFix], console: Console) -> None:
    """Print edits with the number of students who need them."""
    if fixes:
        _print_heading("Edits that would fix the most", console, words.FIXES_NOTE)
    for fix in fixes:
        who = Text(f"{counted(fix.count, 'student')}: ", style="bold")
        wrapped(console, who + Text(printable(fix.action)), 4, Text("  "))
        for sign, line in words.edit_lines(fix.example):
            style = _STYLES.get(sign, "dim")
            head = Text(f"{' ' * _INDENT}{sign} ", style=style)
            wrapped(console, Text(printable(line), style=style), _INDENT + 2, head)
        wrapped(console, Text(words.gain(fix), style="dim"), _INDENT)


def _print_choices(choices: Sequence[ChoiceCount], console: Console) -> None:
    used = [choice for choice in choices if choice.students]
    if used:
        _print_heading("Usual deductions", console)
    for criterion, text, points, count in used:
        line = f"{criterion.id}: {text} ({format_points(points)})"
        wrapped(console, Text(printable(line)), 8, Text(f"{count:>6}  ", style="bold"))


def _print_agreement(agreement: Agreement, names: Mapping[str, str], console: Console) -> None:
    if not agreement.items:
        return
    _print_heading("Agreement of two graders", console)
    mean = f"mean difference {agreement.mean_difference_percent:.1f} % of the maximum"
    lines = [f"{counted(agreement.items, 'item')} marked twice, {agreement.same} with the same points, {mean}"]
    for item in agreement.largest:
        first, second, most = map(format_points, (item.first, item.second, item.max_points))
        lines.append(f"{names[item.key]}, {item.criterion}: {first} and {second} of {most} points")
    for line in lines:
        wrapped(console, Text(printable(line)), 4, Text("  "))


def _print_identical(identical: Sequence[IdenticalWork], names: Mapping[str, str], console: Console) -> None:
    if identical:
        _print_heading("Identical work", console, words.IDENTICAL_NOTE)
    for work in identical[: words.MAX_GROUPS]:
        wrapped(console, Text(printable(words.identical_line(work, names))), 4, Text("  "))
    _print_rest(len(identical) - words.MAX_GROUPS, console)


def _print_attention(attention: Attention, names: Mapping[str, str], console: Console, *, verbose: bool) -> None:
    """Print each reason with its students: names side by side, or one line each if there are details."""
    is_cut = False
    if attention.total:
        _print_heading("Needs attention", console)
    for group in attention.groups:
        has_details = any(item.detail for item in group.items)
        most = len(group.items) if verbose else words.MAX_DETAILS if has_details else words.MAX_NAMED
        head, rest = Text(f"{group.reason} ({len(group.items)})", style="bold"), len(group.items) - most
        is_cut = is_cut or rest > 0
        if has_details:
            wrapped(console, head, 4, Text("  "))
            for item in group.items[:most]:
                line = f"{names[item.key]}: {item.detail}" if item.detail else names[item.key]
                wrapped(console, Text(printable(line)), 6, Text("    "))
            _print_rest(rest, console)
        else:
            who = people_text([names[item.key] for item in group.items], most)
            wrapped(console, head + Text(printable(f": {who}"), "not bold"), 4, Text("  "))
    if is_cut:
        wrapped(console, Text(words.ATTENTION_NOTE, style="dim"), 2)


def _print_heading(title: str, console: Console, note: str = "") -> None:
    console.print()
    console.print(Text(title, style="bold"))
    if note:
        wrapped(console, Text(note, style="dim"), 2)


def _print_rest(number: int, console: Console) -> None:
    if number > 0:
        wrapped(console, Text(f"... and {number} more", style="dim"), 2)


def _print_criteria(criteria: Iterable[CriterionStatistics], adjusted: Sequence[str], console: Console) -> None:
    console.print()
    asked = [row for row in criteria if row.of]
    has_marks, has_carried = any(row.manual_marks for row in asked), any(row.carried for row in asked)
    more = [*(["not\ndeducted"] if has_carried else []), *(["manual\nmarks"] if has_marks else [])]
    # With both, ids of 26 letters fit on 80 columns.
    table = Table(box=None, pad_edge=False, padding=(0, 0, 0, 1) if len(more) > 1 else (0, 1), header_style="bold")
    table.add_column("criterion", no_wrap=True)
    for name in ("points", "passed", *more, "of", "share", "discrimination"):
        table.add_column(name, justify="right", no_wrap=True)
    for row in asked:
        table.add_row(
            words.criterion_name(row.criterion),
            format_points(row.criterion.points),
            str(row.passed),
            *([str(row.carried)] if has_carried else []),
            *([str(row.manual_marks)] if has_marks else []),
            str(row.of),
            words.percent(row.share) if row.share is not None else "",
            _discrimination_text(row.discrimination),
        )
    console.print(table)
    note = f"{words.CRITERIA_NOTE} {words.NOT_DEDUCTED_NOTE}" if has_carried else words.CRITERIA_NOTE
    wrapped(console, Text(note, style="dim"), 0)
    for line in adjusted:
        wrapped(console, Text(line), 0)


def _discrimination_text(discrimination: float | None) -> Text:
    if discrimination is None:
        return Text("")
    return Text(f"{discrimination:.2f}", style="yellow" if words.is_low(discrimination) else "")
