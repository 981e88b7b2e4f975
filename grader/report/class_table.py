"""What `grader batch` prints: a table of the class, one row a student, then the mean and what needs attention."""

from collections import Counter, defaultdict
from collections.abc import Sequence
from decimal import Decimal

from rich.console import Console
from rich.table import Table
from rich.text import Text

from grader.classroom.statistics import summary
from grader.classroom.student_grade import Reason, StudentGrade
from grader.grading.rubric import Rubric
from grader.report.class_summary import attention_line, means
from grader.report.console import wrapped
from grader.text import counted, counted_points, format_points, printable

_MAX_ROWS = 40
_MAX_COSTS = 3  # criteria named in a row


class ClassTable:
    """The rows and figures of a class; `add` takes the grades one by one, so that a large class is never held whole."""

    def __init__(self, rubric: Rubric, *, verbose: bool = False) -> None:
        self.rubric, self.verbose = rubric, verbose
        self.rows: list[Sequence[str]] = []
        self.count = 0
        self._totals = Counter[Decimal]()
        self._concerns: defaultdict[Reason, list[tuple[str, str]]] = defaultdict(list)

    def add(self, grade: StudentGrade) -> None:
        """Add the next student."""
        self.count += 1
        name = grade.student.name or grade.student.key
        if self.verbose or len(self.rows) < _MAX_ROWS:
            pending = counted_points(grade.pending) if grade.obstacle is Reason.PENDING else ""
            self.rows.append((name, grade.total_text or "–", _costs(grade), pending or grade.obstacle or ""))
        if grade.total is not None and grade.is_counted:
            self._totals[grade.total] += 1
        for reason, detail in grade.concerns.items():
            self._concerns[reason].append((name, detail))

    def print(self, console: Console) -> None:
        """Print the table. Text of submissions is never interpreted as markup or control codes."""
        wrapped(console, Text(printable(self.rubric.title), style="bold"), 0)
        table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
        table.add_column("student", overflow="fold")
        table.add_column(f"of {format_points(self.rubric.points)}", justify="right", no_wrap=True)
        table.add_column("lost", overflow="fold", ratio=1)
        table.add_column("open", overflow="fold")
        for row in self.rows:
            table.add_row(*(Text(printable(cell)) for cell in row))
        console.print(table)
        if rest := self.count - len(self.rows):
            console.print(Text(f"... and {counted(rest, 'more student')} (--verbose lists all)", style="dim"))
        console.print()
        if self._totals:
            found = summary(self._totals.elements())
            words = means(found.mean, found.median).capitalize()
            console.print(Text(f"{words} ({counted(found.students, 'student')})"))
        for reason in filter(self._concerns.get, Reason):
            wrapped(console, Text(printable(attention_line(reason, self._concerns[reason], verbose=self.verbose))), 2)


def _costs(grade: StudentGrade) -> str:
    """Return the criteria that cost most, with their points, and the late penalty."""
    costs = [*grade.losses[:_MAX_COSTS]]
    if rest := grade.losses[_MAX_COSTS:]:
        costs.append((sum((points for points, _ in rest), Decimal(0)), f"{len(rest)} more"))
    if grade.late.points:
        costs.append((-grade.late.points, "late"))
    return ", ".join(f"{name} {format_points(-points)}" for points, name in costs)
