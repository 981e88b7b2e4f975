"""The statistics of a class on a terminal: grades, criteria, mistakes, sections, equal work, who needs a person."""

from collections.abc import Iterator
from decimal import Decimal

from rich.console import Console
from rich.table import Table
from rich.text import Text

from grader.classroom.equal_work import EqualWork
from grader.classroom.grades import Class
from grader.classroom.statistics import Attention, ClassStatistics, CriterionFigures, Summary
from grader.report.console import wrapped
from grader.text import counted, format_points, named, people_text, printable

_BAR_WIDTH = 40
_MAX_MISTAKES, _MAX_GROUPS, _MAX_NAMED = 10, 20, 12
EQUAL_NOTE = (
    "The same robot may differ in names, order, comments and the spelling of numbers. This is no verdict: students who"
    " follow the handout and make the same mistake have the same robot or files."
)
SHARE_NOTE = "Share: the mean share of the points that students earned."


def render_class(book: Class, found: ClassStatistics, console: Console, *, verbose: bool = False) -> None:
    """Print the statistics. Text of submissions is never interpreted as markup or control codes."""
    wrapped(console, Text(printable(found.rubric.title), style="bold"), 0)
    for line in (counts_line(found), *grade_lines(found)):
        wrapped(console, Text(line), 0)
    most = max(map(len, found.tenths))
    for tenth, keys in enumerate(found.tenths if most else ()):
        bar = "#" * -(-len(keys) * min(_BAR_WIDTH, console.width - 30) // most)
        console.print(Text(f"  {span(found, tenth):>14} {len(keys):>6}  {bar}"), no_wrap=True, crop=False)
    if found.all.students:
        _print_criteria(found.criteria, console)
    if found.mistakes:
        _heading("Common mistakes", console)
    for mistake in found.mistakes[:_MAX_MISTAKES]:
        head = Text(f"{len(mistake.students):>6}  ", style="bold")
        wrapped(console, Text(printable(f"{mistake.criterion.id}: {mistake.message}")), 8, head)
    for line in section_lines(found):
        wrapped(console, Text(printable(line)), 4, Text("  "))
    if found.equal:
        _heading("Equal work", console)
        wrapped(console, Text(EQUAL_NOTE, style="dim"), 2)
    for work in found.equal[:_MAX_GROUPS]:
        wrapped(console, Text(printable(equal_line(work, book))), 4, Text("  "))
    if found.attention:
        _heading("Needs a person", console)
    for group in found.attention:
        wrapped(console, Text(printable(attention_line(group, book, verbose=verbose))), 4, Text("  "))


def counts_line(found: ClassStatistics) -> str:
    """Return how many students were graded, and how many were not."""
    words = {"graded": "graded", "unreadable": "could not be graded", "errored": "errored", "excused": "excused"}
    words["missing"] = "without a submission"
    counts = [f"{found.statuses[status]} {text}" for status, text in words.items() if status in found.statuses]
    return ", ".join([*counts, *([f"{found.late} late"] if found.late else [])]) or "no students"


def grade_lines(found: ClassStatistics) -> Iterator[str]:
    """Yield the grades in one line, and how many are not final."""
    if found.all.students:
        most = format_points(maximum_of(found))
        lowest, highest = found.all.lowest, found.all.highest
        assert lowest is not None and highest is not None
        yield (
            f"Grades of {most}: mean {figure(found.all.mean)}, median {figure(found.all.median)}, "
            f"lowest {format_points(lowest)}, highest {format_points(highest)}"
        )
    if found.open:
        yield f"{counted(found.open, 'grade')} still {'needs' if found.open == 1 else 'need'} manual grading"


def maximum_of(found: ClassStatistics) -> Decimal:
    """Return the maximum of the class."""
    return sum((row.criterion.maximum for row in found.criteria), Decimal(0))


def figure(value: Decimal | None) -> str:
    """Return a mean to one decimal, rounded down so that no 99.96 is shown as 100."""
    return "" if value is None else f"{int(value * 10) / 10:.1f}"


def section_lines(found: ClassStatistics) -> Iterator[str]:
    """Yield the mean and median of each section."""
    for name, one in found.sections.items():
        yield f"Section {name or '(none)'}: {_summary(one)}"


def _summary(one: Summary) -> str:
    return f"mean {figure(one.mean)}, median {figure(one.median)} ({counted(one.students, 'student')})"


def span(found: ClassStatistics, tenth: int) -> str:
    """Return the grades of a tenth of the maximum: "10 to 20"."""
    step = maximum_of(found) / len(found.tenths)
    return f"{format_points(step * tenth)} to {format_points(step * (tenth + 1))}"


def percent(share: float) -> str:
    """Return a share in percent, not rounded up to 100 % or down to 0 %."""
    return f"{share:.0%}" if share in (0, 1) else f"{min(99, max(1, round(100 * share)))}%"


def what_is_same(work: EqualWork, book: Class) -> str:
    """Return what is equal for all of the students, and who of them has the same file."""
    if work.students in work.same_file:
        return "the same file"
    files = (people_text([_name(key, book) for key in keys], _MAX_NAMED) for keys in work.same_file)
    return "; ".join([work.equal, *(f"the same file: {who}" for who in files)])


def equal_line(work: EqualWork, book: Class) -> str:
    """Return the students of one group of equal work."""
    return f"{people_text([_name(key, book) for key in work.students], _MAX_NAMED)}: {what_is_same(work, book)}"


def attention_line(group: Attention, book: Class, *, verbose: bool) -> str:
    """Return the students who need a person for one reason."""
    who = [f"{_name(key, book)} ({detail})" if detail else _name(key, book) for key, detail in group.students]
    return f"{str(group.reason)[0].upper()}{group.reason[1:]} ({len(who)}): {people_text(who, len(who) if verbose else _MAX_NAMED)}"


def _name(key: str, book: Class) -> str:
    return named(key, book.student(key, book.results.of(key)).name)


def _heading(title: str, console: Console) -> None:
    console.print()
    console.print(Text(title, style="bold"))


def _print_criteria(rows: tuple[CriterionFigures, ...], console: Console) -> None:
    console.print()
    columns = [name for name in ("carried", "marked", "pending", "errored") if any(getattr(row, name) for row in rows)]
    table = Table(box=None, pad_edge=False, padding=(0, 1), header_style="bold")
    table.add_column("criterion", no_wrap=True)
    for name in ("points", "passed", "failed", *columns, "share"):
        table.add_column("not deducted" if name == "carried" else name, justify="right", no_wrap=True)
    for row in rows:
        name = printable(f"{row.criterion.id} (bonus)" if row.criterion.bonus else row.criterion.id)
        counts = (str(getattr(row, column)) for column in ("passed", "failed", *columns))
        table.add_row(name, format_points(row.criterion.points), *counts, percent(row.share) if row.share is not None else "")
    console.print(table)
    wrapped(console, Text(SHARE_NOTE, style="dim"), 0)
