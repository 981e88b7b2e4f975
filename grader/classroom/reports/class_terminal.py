"""A class on a terminal.

Here are the table that `batch` prints, the statistics, and what changed between two runs.

Text of submissions is never interpreted as markup or control codes.
"""

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from decimal import Decimal
from operator import itemgetter
from typing import NamedTuple

from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

from grader.base.text import (
    MAX_PEOPLE,
    counted,
    counted_points,
    first_lines,
    format_points,
    named,
    people_text,
    printable,
    signed_points,
)
from grader.classroom.gradebook.grade_changes import Change, Snapshot, why_open
from grader.classroom.gradebook.statistics import (
    ClassStatistics,
    CriterionFigures,
    CriterionMistakes,
    summary,
)
from grader.classroom.gradebook.student_grade import Reason, StudentGrade, pending_words
from grader.classroom.reports.class_words import (
    EQUAL_NOTE,
    SHARE_NOTE,
    family_name_order,
    grades_text,
    head_lines,
    late_text,
    percent,
    span,
)
from grader.classroom.results.results import RunGrade
from grader.classroom.roster.lateness import time_text
from grader.lab.rubric.criterion import GRADE
from grader.report.criteria import alike
from grader.report.writers.terminal_page import INDENT, Page

_GAP = 2  # characters between two columns
_MAX_ROWS = 40
_MAX_COSTS = 3  # criteria named in a row
_BAR_WIDTH = 40
_MAX_MISTAKES = 10
_MAX_CAUSES = 3
_MAX_GROUPS = 20
_MAX_STEPS = 5  # criteria of a student that changed
_MANY_EQUAL = 3  # students with equal changes, which are said once
_TITLES = {
    "carried": "not\ndeducted",
    "marked": "manual\nmark",
    "pending": "manual\ngrading",
    "share": "mean\nearned",
}


class _Row(NamedTuple):
    """A row of the table of a class: what it is sorted by, then its cells."""

    is_fine: bool  # whether the student needs no attention
    order: Sequence[str]
    name: str
    grade: str
    late: str
    losses: Sequence[tuple[Decimal, str]]
    why_open: str


class ClassTable:
    """One row a student, first of those who need attention, then by family name.

    Below are the mean, and what needs attention.

    `add` takes the grades one by one, so that a large class is never held whole.
    """

    def __init__(self, title: str, maximum: Decimal, *, verbose: bool = False) -> None:
        self.title = title
        self.maximum = maximum
        self.verbose = verbose
        self.rows: list[_Row] = []  # in the order of the first two fields
        self.count = self.attention = self.open = (
            0  # students; of them those who need attention, or manual grading
        )
        self.ending = ""  # the last line
        self._totals = Counter[Decimal]()
        self._names = Counter[str]()
        self._concerns: defaultdict[Reason, list[tuple[str, str, str]]] = defaultdict(list)

    def add(self, grade: StudentGrade) -> None:
        """Add the next student."""
        self.count += 1
        self.attention += bool(grade.concerns)
        self.open += bool(grade.pending)
        name = grade.student.shown_name
        why_open = grade.obstacle.name.lower().replace("_", " ") if grade.obstacle else ""
        if grade.obstacle is Reason.PENDING:
            why_open = counted_points(grade.pending)
        order = family_name_order(name, grade.student.key)
        shown = grade.total_text or "–"
        row = _Row(not grade.concerns, order, name, shown, late_text(grade), grade.losses, why_open)
        self.rows.append(row)
        if not self.verbose and len(self.rows) > 2 * _MAX_ROWS:
            self._keep_first()
        if grade.total is not None and grade.is_counted:
            self._totals[grade.total] += 1
        self._names[name] += 1
        for reason, detail in grade.concerns.items():
            self._concerns[reason].append((name, grade.student.key, detail))

    def _label(self, name: str, key: str) -> str:
        """Return the name of a student, with the key if another student has this name."""
        return named(key, name) if self._names[name] > 1 else name

    def _keep_first(self) -> None:
        self.rows.sort()
        if not self.verbose:
            del self.rows[_MAX_ROWS:]

    def _table(self, width: int) -> Table:
        """Return the rows without empty columns, for a screen of so many characters."""
        table = Table(box=None, pad_edge=False, padding=(0, _GAP, 0, 0), header_style="bold")
        columns = self._columns(width)
        for title in columns:
            table.add_column(title, overflow="fold", justify="right" if title == GRADE else "left")
        for row in zip(*columns.values(), strict=True):
            table.add_row(*(Text(printable(cell)) for cell in row))
        return table

    def _columns(self, width: int) -> dict[str, list[str]]:
        """Return the cells of the columns that are not empty.

        Lost points get the rest of the width.
        """
        names = []
        grades = []
        late = []
        open_points = []
        for row in self.rows:
            names.append(self._label(row.name, row.order[-1]))
            grades.append(row.grade)
            late.append(row.late)
            open_points.append(row.why_open)
        columns = {"student": names, GRADE: grades, "late": late, "lost": []}
        columns[_TITLES["pending"]] = open_points
        for title, cells in columns.items():
            if any(cells):
                width -= _GAP + max(map(cell_len, title.splitlines() + cells))
        columns["lost"] = [_costs(row.losses, width - _GAP) for row in self.rows]
        return {title: cells for title, cells in columns.items() if any(cells)}

    def print(self, console: Console) -> None:
        """Print the table."""
        self._keep_first()
        page = Page(console, [])
        page.inset(printable(self.title), "bold", 0)
        page.table(self._table(console.width))
        rest = self.count - len(self.rows)
        if rest:
            page.inset(f"... and {counted(rest, 'more student')} (--verbose lists all)", "dim", 0)
        page.leave_row()
        if self._totals:
            figures = summary(self._totals.elements())
            words = grades_text(self.maximum, figures, is_open=bool(self.open))
            page.inset(f"{words} ({counted(figures.students, 'student')})", indent=0)
        for reason in Reason:
            if reason in self._concerns:
                concerned = self._concerns[reason]
                who = [(self._label(name, key), detail) for name, key, detail in concerned]
                _show_attention(reason, who, page, verbose=self.verbose)
        if self.ending:
            page.leave_row()
            # not wrapped: its path and command are copied
            page.rows.append(Text(printable(self.ending)))
        page.print()


def _costs(losses: Sequence[tuple[Decimal, str]], width: int) -> str:
    """Return the criteria that cost most, with their points.

    They are as many whole ones as fit, but one at least.
    """
    text = ""
    for most in range(1, _MAX_COSTS + 1):
        costs = list(losses[:most])
        rest = losses[most:]
        if rest:
            costs.append((sum((points for points, _ in rest), Decimal(0)), f"{len(rest)} more"))
        longer = ", ".join(f"{name} {format_points(-points)}" for points, name in costs)
        if not text or cell_len(longer) <= width:
            text = longer
    return text


def render_class(figures: ClassStatistics, console: Console, *, verbose: bool = False) -> None:
    """Print the statistics."""
    page = Page(console, [])
    page.inset(printable(figures.rubric.title), "bold", 0)
    for line in head_lines(figures):
        page.inset(printable(line), indent=0)
    most = max(map(len, figures.tenths))
    if most:
        for tenth, keys in enumerate(figures.tenths):
            bar = "#" * -(-len(keys) * min(_BAR_WIDTH, console.width - 30) // most)
            page.rows.append(Text(f"  {span(figures, tenth):>14} {len(keys):>6}  {bar}"))
        _show_criteria(figures.criteria, page)
    labels = {key: named(key, name) for key, name in figures.names.items()}
    _show_mistakes(figures.mistakes[:_MAX_MISTAKES], page)
    equal = []
    for work in figures.equal[:_MAX_GROUPS]:
        students = people_text([labels[key] for key in work.students])
        equal.append(f"{students}: {work.equal}")
    _show_lines("Equal work", equal, page, note=EQUAL_NOTE)
    if figures.attention:
        page.title("Needs attention")
    for reason, students_and_details in figures.attention.items():
        who = [(labels[key], detail) for key, detail in students_and_details]
        _show_attention(reason, who, page, verbose=verbose)
    page.print()


def _show_mistakes(rows: Sequence[CriterionMistakes], page: Page) -> None:
    """Print the criteria that most students did not meet, and below each of several causes."""
    if not rows:
        return
    page.title("Common mistakes")
    for row in rows:
        what = row.common[0].message if row.causes == 1 else f"{row.causes} causes"
        line = f"{row.students:>4}  {row.criterion}: {what}"
        page.inset(printable(line), indent=8, head=Text(" " * INDENT))
        if row.causes == 1:
            continue
        for cause in row.common[:_MAX_CAUSES]:
            line = f"{len(cause.students):>4}  {cause.message}"
            page.inset(printable(line), indent=12, head=Text(" " * 6))
        if row.causes > _MAX_CAUSES:
            page.inset(f"... and {counted(row.causes - _MAX_CAUSES, 'more cause')}", "dim", 12)


def _show_lines(title: str, lines: Sequence[str], page: Page, *, note: str = "") -> None:
    """Print lines below a title, nothing without lines."""
    if not lines:
        return
    page.title(title)
    if note:
        page.inset(note, "dim")
    for line in lines:
        page.inset(printable(line), indent=4, head=Text(" " * INDENT))


def _show_attention(
    reason: Reason, who: Sequence[tuple[str, str]], page: Page, *, verbose: bool
) -> None:
    """Print who needs attention for a reason: those with an equal detail in one line."""
    most = len(who) if verbose else MAX_PEOPLE
    head = f"{reason[:1].upper()}{reason[1:]} ({len(who)})"
    start = Text(" " * INDENT)
    if not any(detail for _, detail in who):
        names = people_text([name for name, _ in who], most)
        page.inset(printable(f"{head}: {names}"), indent=2 * INDENT, head=start)
        return
    page.inset(printable(f"{head}:"), indent=2 * INDENT, head=start)
    lines = []
    for detail, alike_students in alike(who, itemgetter(1)):
        names = people_text([name for name, _ in alike_students], most)
        lines.append(f"{names}: {detail}" if detail else names)
    for line in first_lines(lines, most):
        page.inset(printable(line), indent=3 * INDENT, head=Text(" " * 2 * INDENT))


def _show_criteria(rows: Sequence[CriterionFigures], page: Page) -> None:
    counted_kinds = {kind for row in rows for kind, count in row.counts.items() if count}
    optional = [
        name for name in ("carried", "marked", "pending", "errored") if name in counted_kinds
    ]
    columns = ["passed", "failed", *optional]
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    table.add_column("criterion", overflow="fold")
    for name in ("points", *columns, "share"):
        table.add_column(_TITLES.get(name, name), justify="right", no_wrap=True)
    for row in rows:
        name = row.criterion.id
        if row.criterion.bonus:
            name += " (bonus)"
        counts = (str(row.counts[column]) for column in columns)
        share = percent(row.share) if row.share is not None else ""
        table.add_row(printable(name), format_points(row.criterion.points), *counts, share)
    page.leave_row()
    page.table(table)
    page.inset(SHARE_NOTE, "dim", 0)


def render_changes(
    changes: Sequence[Change], before: Snapshot, after: Snapshot, console: Console
) -> None:
    """Print the two runs, and by reason whose grade changed, by how much, and in which criteria."""
    first = before.run
    last = after.run
    page = Page(console, [])
    times = [f"run {run.run} of {time_text(run.time)}" for run in (first, last)]
    if not after.is_recorded:
        times[1] = "now"
    page.inset(printable(f"From {times[0]} to {times[1]}"), "dim", 0)
    if first.maximum and last.maximum and first.maximum != last.maximum:
        page.inset(f"the maximum changed from {first.maximum} to {last.maximum} points", indent=0)
    if first.due != last.due:
        dues = [time_text(run.due) if run.due else "none" for run in (first, last)]
        page.inset(printable(f"the deadline changed from {dues[0]} to {dues[1]}"), indent=0)
    if not changes:
        page.inset("nothing changed", indent=0)
    by_reasons = alike(changes, lambda change: change.why)
    for why, alike_changes in sorted(by_reasons, key=lambda group: -len(group[1])):
        page.leave_row()
        students = counted(len(alike_changes), "student")
        page.inset(printable(f"{'; '.join(why)} ({students})"), "bold", 0)
        for criteria, some in alike(alike_changes, _changed_criteria):
            _show_equal_changes(criteria, some, page)
    page.print()


def _changed_criteria(change: Change) -> str:
    """Return the criteria whose points changed; of many the first."""
    steps = [f"{one.id} {_before_and_after(one.before, one.after)}" for one in change.criteria]
    return "; ".join(first_lines(steps, _MAX_STEPS))


def _show_equal_changes(criteria: str, changes: Sequence[Change], page: Page) -> None:
    """Print the students whose points of criteria changed equally.

    The criteria are said once if these are several students; equal grades are one line.
    """
    is_said_once = bool(criteria) and len(changes) >= _MANY_EQUAL
    indent = INDENT
    if is_said_once:
        page.inset(printable(f"{criteria} ({len(changes)} students):"), indent=4, head=Text("  "))
        indent += INDENT
    for grade, equal in alike(changes, lambda change: "; ".join(_changed_grade(change))):
        names = people_text([named(change.key, change.name) for change in equal], len(equal))
        text = grade if is_said_once or not criteria else f"{grade}; {criteria}"
        line = printable(f"{names}: {text}")
        page.inset(line, indent=indent + INDENT, head=Text(" " * indent))


def _changed_grade(change: Change) -> Iterator[str]:
    """Yield the grade before and after, and what else its student sees of the change."""
    old = change.old
    new = change.new
    grade = _before_and_after(
        change.before, change.after, (_without_points(old), _without_points(new))
    )
    if new.total is not None and new.pending:
        grade += f"; {pending_words(Decimal(new.pending))}"
    elif new.total is not None and why_open(new):
        grade += f"; {why_open(new)}"
    elif new.total is not None and old.total is not None and why_open(old):
        grade += ", now final"
    yield grade
    if (old.days_late, old.penalty) != (new.days_late, new.penalty):
        yield f"{_days_late(old)} to {_days_late(new)}"
    if old.deadline != new.deadline:
        yield f"own deadline {old.deadline or 'none'} to {new.deadline or 'none'}"


def _without_points(grade: RunGrade) -> str:
    """Return what stands for a grade that has no points."""
    if grade.obstacle == Reason.PENDING.name:
        return "manual grading"
    return grade.obstacle.lower().replace("_", " ") or "none"


def _days_late(grade: RunGrade) -> str:
    if not grade.days_late:
        return "on time"
    return f"{counted(grade.days_late, 'day')} late{grade.penalty and f', {grade.penalty}'}"


def _before_and_after(
    before: Decimal | None, after: Decimal | None, nothing: tuple[str, str] = ("none", "none")
) -> str:
    """Return points before and after: "50 to 60 (+10)"."""
    first = nothing[0] if before is None else format_points(before)
    last = nothing[1] if after is None else format_points(after)
    if first == last:
        return f"{first}, as before"
    if before is None or after is None:
        return f"{first} to {last}"
    return f"{first} to {last} ({signed_points(after - before)})"
