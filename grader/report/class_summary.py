"""The summary of a class on a terminal: grades, criteria, common mistakes, who needs attention."""

from collections.abc import Iterable
from decimal import ROUND_FLOOR, Decimal

from rich.console import Console
from rich.table import Table
from rich.text import Text

from grader.classroom.gradebook.grades import AttentionList
from grader.classroom.gradebook.statistics import ClassStatistics, CriterionStatistics
from grader.report.console import wrapped
from grader.text import format_points, printable

_BAR_WIDTH = 40
_MAX_FAILURES = 10
_LOW_DISCRIMINATION = 0.2


def render_class(
    title: str, statistics: ClassStatistics, looks: AttentionList, evidence_only: int, console: Console
) -> None:
    """Print the summary of a class. Text of submissions is never interpreted as markup or control codes.

    `evidence_only` counts the submissions without a URDF for which the rubric may ask for manual grading.
    """
    verdicts = statistics.verdicts
    counted = [
        (verdicts.get("graded", 0), "graded"),
        (verdicts.get("unreadable", 0), "could not be graded"),
        (verdicts.get("errored", 0), "errored"),
        (verdicts.get("missing", 0), "without a submission"),
    ]
    wrapped(console, Text(printable(title), style="bold"), 0)
    wrapped(console, Text(", ".join(f"{count} {what}" for count, what in counted if count) or "no students"), 0)
    earlier = verdicts.get("graded", 0) - statistics.graded
    if earlier:
        wrapped(console, Text(f"{earlier} graded by an earlier rubric only: not in these statistics"), 0)
    if statistics.graded:
        _print_marks(statistics, console)
        _print_criteria(statistics.criteria, console)
    if statistics.graded and statistics.failures:
        console.print()
        console.print(Text("Common mistakes", style="bold"))
        for failure in statistics.failures[:_MAX_FAILURES]:
            head = Text(f"{failure.count:>6}  ", style="bold")
            wrapped(console, Text(printable(f"{failure.criterion.id}: {failure.message}")), 8, head)
    if looks.total:
        console.print()
        console.print(Text("Needs attention", style="bold"))
        for look in looks.listed:
            wrapped(console, Text(printable(f"{look.who}: {look.why}")), 4, Text("  "))
    if looks.total > len(looks.listed):
        wrapped(console, Text(f"... and {looks.total - len(looks.listed)} more", style="dim"), 2)
    if evidence_only:
        console.print()
        wrapped(console, Text(_without_urdf(evidence_only)), 0)


def _without_urdf(count: int) -> str:
    have = "submission has" if count == 1 else "submissions have"
    return (
        f"{count} {have} pictures or documents, but no URDF: the criteria of the URDF are failed. "
        'Set `without_urdf = "manual"` in the rubric to grade them manually, or "failed" to keep this'
    )


def _print_marks(statistics: ClassStatistics, console: Console) -> None:
    console.print()
    pending = f"; {statistics.pending} need manual grading" if statistics.pending else ""
    words = (
        f"Grades out of {format_points(statistics.out_of)}: mean {_mean(statistics)}, standard deviation {statistics.deviation:.1f}, "
        f"lowest {format_points(statistics.lowest)}, median {format_points(statistics.median)}, "
        f"highest {format_points(statistics.highest)}{pending}"
    )
    wrapped(console, Text(words), 0)
    most = max(statistics.bins)
    step = statistics.out_of / len(statistics.bins)
    for index, count in enumerate(statistics.bins):
        bar = "#" * -(-count * min(_BAR_WIDTH, console.width - 30) // most)
        span = f"{format_points(step * index)} to {format_points(step * (index + 1))}"
        console.print(Text(f"  {span:>14} {count:>6}  {bar}"), no_wrap=True, crop=False)


def _print_criteria(criteria: Iterable[CriterionStatistics], console: Console) -> None:
    console.print()
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("criterion", no_wrap=True)
    asked = [row for row in criteria if row.decided or row.pending or row.errored]
    has_marks = any(row.marked for row in asked)
    for name in ("points", "passed", *(["manual"] if has_marks else []), "of", "share", "discrimination"):
        table.add_column(name, justify="right", no_wrap=True)
    for row in asked:
        table.add_row(
            printable(row.criterion.id),
            format_points(row.criterion.points),
            str(row.passed),
            *([str(row.marked)] if has_marks else []),
            str(row.decided + row.pending + row.errored),
            _percent(row.share) if row.share is not None else "",
            _discrimination_text(row.discrimination),
        )
    console.print(table)
    hint = (
        "share: mean share of the points earned; discrimination: correlation with the rest of the grade, from -1 to 1"
    )
    wrapped(console, Text(hint, style="dim"), 0)


def _mean(statistics: ClassStatistics) -> str:
    """Return the mean to one decimal, not rounded up to the maximum."""
    words = f"{statistics.mean:.1f}"
    is_full = Decimal(words) >= statistics.out_of > statistics.mean
    return format(Decimal(statistics.mean).quantize(Decimal("0.1"), ROUND_FLOOR), "f") if is_full else words


def _percent(share: float) -> str:
    """Return a share in percent, not rounded up to 100 % or down to 0 %."""
    return f"{share:.0%}" if share in (0, 1) else f"{min(99, max(1, round(100 * share)))}%"


def _discrimination_text(discrimination: float | None) -> Text:
    if discrimination is None:
        return Text("")
    return Text(f"{discrimination:.2f}", style="yellow" if discrimination < _LOW_DISCRIMINATION else "")
