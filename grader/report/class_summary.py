"""A class for a person at a terminal: the marks, how each criterion went, what went wrong most often, who needs a look."""

from collections.abc import Iterable
from decimal import ROUND_FLOOR, Decimal

from rich.console import Console
from rich.table import Table
from rich.text import Text

from grader.classroom.gradebook.grades import Looks
from grader.classroom.gradebook.statistics import ClassStatistics, CriterionStatistics
from grader.report.console import wrapped
from grader.text import format_points, printable

_BAR = 40
_MOST_FAILURES = 10
_WEAK = 0.2


def render_class(title: str, statistics: ClassStatistics, looks: Looks, console: Console) -> None:
    """Print what there is to say of a class. Nothing of a submission is taken for markup or control codes."""
    verdicts = statistics.verdicts
    counted = [
        (verdicts.get("graded", 0), "graded"),
        (verdicts.get("unreadable", 0), "could not be graded"),
        (verdicts.get("errored", 0), "errored"),
        (verdicts.get("missing", 0), "handed in nothing"),
    ]
    wrapped(console, Text(printable(title), style="bold"), 0)
    wrapped(console, Text(", ".join(f"{count} {what}" for count, what in counted if count) or "nobody yet"), 0)
    earlier = verdicts.get("graded", 0) - statistics.graded
    if earlier:
        wrapped(console, Text(f"{earlier} of the graded by an earlier rubric only: not in what follows"), 0)
    if statistics.graded:
        _show_marks(statistics, console)
        _show_criteria(statistics.criteria, console)
        _show_failures(statistics, console)
    _show_looks(looks, console)


def _show_marks(statistics: ClassStatistics, console: Console) -> None:
    console.print()
    waits = f"; {statistics.pending} still wait for a person" if statistics.pending else ""
    words = (
        f"Marks of {format_points(statistics.out_of)}: mean {_mean(statistics)}, deviation {statistics.deviation:.1f}, "
        f"lowest {format_points(statistics.lowest)}, median {format_points(statistics.median)}, "
        f"highest {format_points(statistics.highest)}{waits}"
    )
    wrapped(console, Text(words), 0)
    most = max(statistics.bins)
    step = statistics.out_of / len(statistics.bins)
    for index, count in enumerate(statistics.bins):
        bar = "#" * -(-count * min(_BAR, console.width - 30) // most)
        span = f"{format_points(step * index)} to {format_points(step * (index + 1))}"
        console.print(Text(f"  {span:>14} {count:>6}  {bar}"), no_wrap=True, crop=False)


def _show_criteria(criteria: Iterable[CriterionStatistics], console: Console) -> None:
    console.print()
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("criterion", no_wrap=True)
    asked = [each for each in criteria if each.decided or each.pending or each.errored]
    has_marks = any(each.marked for each in asked)
    for name in ("points", "passed", *(["by hand"] if has_marks else []), "of", "share", "tells"):
        table.add_column(name, justify="right", no_wrap=True)
    for each in asked:
        table.add_row(
            printable(each.criterion.id),
            format_points(each.criterion.points),
            str(each.passed),
            *([str(each.marked)] if has_marks else []),
            str(each.decided + each.pending + each.errored),
            _percent(each.share) if each.share is not None else "",
            _tells(each.discrimination),
        )
    console.print(table)
    hint = "share: of its points earned_text; tells: how well it goes with the rest of the mark, from -1 to 1"
    wrapped(console, Text(hint, style="dim"), 0)


def _mean(statistics: ClassStatistics) -> str:
    """The mean to one decimal, but never up to full marks."""
    words = f"{statistics.mean:.1f}"
    is_full = Decimal(words) >= statistics.out_of > statistics.mean
    return format(Decimal(statistics.mean).quantize(Decimal("0.1"), ROUND_FLOOR), "f") if is_full else words


def _percent(share: float) -> str:
    """A share in percent, but never up to all or down to nothing."""
    return f"{share:.0%}" if share in (0, 1) else f"{min(99, max(1, round(100 * share)))}%"


def _tells(discrimination: float | None) -> Text:
    if discrimination is None:
        return Text("")
    return Text(f"{discrimination:.2f}", style="yellow" if discrimination < _WEAK else "")


def _show_failures(statistics: ClassStatistics, console: Console) -> None:
    if not statistics.failures:
        return
    console.print()
    console.print(Text("What went wrong most often", style="bold"))
    for failure in statistics.failures[:_MOST_FAILURES]:
        head = Text(f"{failure.count:>6}  ", style="bold")
        wrapped(console, Text(printable(f"{failure.criterion.title}: {failure.message}")), 8, head)


def _show_looks(looks: Looks, console: Console) -> None:
    if not looks.total:
        return
    console.print()
    console.print(Text("Who needs a look", style="bold"))
    for look in looks.listed:
        wrapped(console, Text(printable(f"{look.who}: {look.why}")), 4, Text("  "))
    if looks.total > len(looks.listed):
        wrapped(console, Text(f"... and {looks.total - len(looks.listed)} more", style="dim"), 2)
