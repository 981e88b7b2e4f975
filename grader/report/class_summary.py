"""The statistics of a class on a terminal, and the words for them that other outputs share."""

from collections.abc import Iterator, Sequence
from decimal import Decimal

from rich.console import Console
from rich.table import Table
from rich.text import Text

from grader.classroom.statistics import ClassStatistics, CriterionFigures
from grader.classroom.student_grade import Reason
from grader.report.console import wrapped
from grader.text import counted, format_points, named, people_text, printable

_BAR_WIDTH = 40
_MAX_MISTAKES, _MAX_GROUPS = 10, 20
_MAX_NAMED = 12
EQUAL_NOTE = (
    "The same robot may differ in names, order, comments and the spelling of numbers. This is no verdict: students who"
    " follow the handout and make the same mistake have the same robot."
)
SHARE_NOTE = "Share: the mean share of the points that students earned."


def render_class(found: ClassStatistics, console: Console, *, verbose: bool = False) -> None:
    """Print the statistics. Text of submissions is never interpreted as markup or control codes."""
    wrapped(console, Text(printable(found.rubric.title), style="bold"), 0)
    for line in head_lines(found):
        wrapped(console, Text(printable(line)), 0)
    most = max(map(len, found.tenths))
    for tenth, keys in enumerate(found.tenths if most else ()):
        bar = "#" * -(-len(keys) * min(_BAR_WIDTH, console.width - 30) // most)
        console.print(Text(f"  {span(found, tenth):>14} {len(keys):>6}  {bar}"), no_wrap=True, crop=False)
    if most:
        _print_criteria(found.criteria, console)

    def name(key: str) -> str:
        return named(key, found.names[key])

    mistakes = [f"{len(one.students):>4}  {one.criterion}: {one.message}" for one in found.mistakes[:_MAX_MISTAKES]]
    equal = [f"{people_text([*map(name, one.students)], _MAX_NAMED)}: {one.equal}" for one in found.equal[:_MAX_GROUPS]]
    attention = [
        attention_line(reason, [(name(key), detail) for key, detail in those], verbose=verbose)
        for reason, those in found.attention.items()
    ]
    sections = (
        ("Common mistakes", mistakes, 8, ""),
        ("Equal work", equal, 4, EQUAL_NOTE),
        ("Needs attention", attention, 4, ""),
    )
    for title, lines, indent, note in sections:
        if lines:
            console.print()
            console.print(Text(title, style="bold"))
            if note:
                wrapped(console, Text(note, style="dim"), 2)
        for line in lines:
            wrapped(console, Text(printable(line)), indent, Text("  "))


def head_lines(found: ClassStatistics) -> Iterator[str]:
    """Yield how many students were graded and how many not, the grades in one line, what is open, and the sections."""
    words = {"graded": "graded", "unreadable": "could not be graded", "errored": "errored", "excused": "excused"}
    words["missing"] = "without a submission"
    counts = [f"{found.statuses[status]} {text}" for status, text in words.items() if status in found.statuses]
    yield ", ".join([*counts, *([f"{found.late} late"] if found.late else [])]) or "no students"
    if found.all is not None:
        yield f"Grades of {format_points(found.maximum)}: {means(found.all.mean, found.all.median)}"
    if found.open:
        yield f"{counted(found.open, 'grade')} still {'needs' if found.open == 1 else 'need'} manual grading"
    for name, one in found.sections.items():
        yield f"Section {name or '(none)'}: {means(one.mean, one.median)} ({counted(one.students, 'student')})"


def means(mean: Decimal | float, median: Decimal | float) -> str:
    """Return a mean and a median to one decimal."""
    return f"mean {mean:.1f}, median {median:.1f}"


def span(found: ClassStatistics, tenth: int) -> str:
    """Return the grades of a tenth of the maximum: "10 to 20"."""
    step = found.maximum / len(found.tenths)
    return f"{format_points(step * tenth)} to {format_points(step * (tenth + 1))}"


def percent(share: float) -> str:
    """Return a share in percent, not rounded up to 100 % or down to 0 %."""
    return f"{share:.0%}" if share in (0, 1) else f"{min(99, max(1, round(100 * share)))}%"


def attention_line(reason: Reason, who: Sequence[tuple[str, str]], *, verbose: bool = False) -> str:
    """Return the students who need attention for one reason, each with a detail."""
    names = [f"{name} ({detail})" if detail else name for name, detail in who]
    return f"{reason[:1].upper()}{reason[1:]} ({len(who)}): {people_text(names, len(who) if verbose else _MAX_NAMED)}"


def _print_criteria(rows: Sequence[CriterionFigures], console: Console) -> None:
    optional = [name for name in ("carried", "marked", "pending", "errored") if any(row.counts[name] for row in rows)]
    columns = ["passed", "failed", *optional]
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    table.add_column("criterion", no_wrap=True)
    for name in ("points", *columns, "share"):
        title = "not deducted" if name == "carried" else name
        table.add_column(title, justify="right", no_wrap=name != "carried")
    for row in rows:
        name = printable(f"{row.criterion.id}{' (bonus)' * row.criterion.bonus}")
        counts = (str(row.counts[column]) for column in columns)
        share = percent(row.share) if row.share is not None else ""
        table.add_row(name, format_points(row.criterion.points), *counts, share)
    console.print()
    console.print(table)
    wrapped(console, Text(SHARE_NOTE, style="dim"), 0)
