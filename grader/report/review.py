"""A criterion as `grader review` shows it: the answer, the model answer, where the pictures are."""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.text import Text

from grader.classroom.gradebook.manual_queue import QueuedResult
from grader.classroom.gradebook.marks import Mark
from grader.classroom.students import Student
from grader.report.console import wrapped
from grader.text import counted_points, printable

_INDENT = 2
_WITHOUT_LINES = (".pdf", ".docx")  # the message names the page or the heading


def render_item(item: QueuedResult, position: str, pictures: Sequence[str], console: Console) -> None:
    """Print a criterion of a student, at `position` in the review. Text of the submission is never interpreted as markup."""
    criterion, outcome = item.result.criterion, item.result.outcome
    console.print()
    head = f"{position}  {who(item.grade.student)}: {printable(criterion.title)} ({counted_points(criterion.points)})"
    wrapped(console, Text(head, style="bold"), 0)
    wrapped(console, Text(printable(outcome.message)), 0)
    if item.result.manual_mark is not None and item.mark is not None:
        wrapped(console, Text(f"Marked: {mark_text(item.mark)}", style="bold"), 0)
    if isinstance(outcome.measured, str):
        _print_block("Found", outcome.measured, console)
    if files := files_text(item):
        _print_block("Look at", "\n".join(files), console)
    if pictures:
        _print_block("Pictures", "\n".join(pictures), console)
    if criterion.answer:
        _print_block("Model answer", criterion.answer, console)
    if place := place_text(item):
        wrapped(console, Text(f"in {place}", "dim"), 0)


def who(student: Student) -> str:
    """Return the name and key of a student, printable."""
    return printable(f"{student.name} ({student.key})" if student.name else student.key)


def mark_text(mark: Mark) -> str:
    """Return a mark in one printable line: points, name, time, comment."""
    points = counted_points(mark.points) if mark.points is not None else mark.entry.kind
    parts = [points, f"by {mark.by}" if mark.by else "by an unnamed person", f"at {mark.at}"]
    comment = " ".join(mark.comment.split())
    return printable(f"{' '.join(parts)}: {comment}" if comment else " ".join(parts))


def files_text(item: QueuedResult) -> list[str]:
    """Return where the files are that a criterion is about, printable."""
    measured = item.result.outcome.measured
    return [printable(_where(item, str(file))) for file in measured] if isinstance(measured, tuple | list) else []


def place_text(item: QueuedResult) -> str:
    """Return where the answer is, printable: the file, and the line where editors count lines. Empty if there is none."""
    location = item.result.outcome.location
    if location is None:
        return ""
    line = "" if location.path.lower().endswith(_WITHOUT_LINES) else f", line {location.line}"
    return printable(f"{_where(item, location.path)}{line}")


def _print_block(title: str, text: str, console: Console) -> None:
    wrapped(console, Text(f"{title}:", style="bold"), 0)
    for line in filter(str.strip, text.splitlines()):
        wrapped(console, Text(printable(line)), _INDENT)


def _where(item: QueuedResult, path: str) -> str:
    """Return the path of a file of the submission on this machine."""
    origin = item.grade.files
    if len(origin.paths) == 1:
        return str(Path(origin.root, origin.paths[0], path))
    named = dict(zip(origin.names or [name.rpartition("/")[2] for name in origin.paths], origin.paths, strict=True))
    file = next((name for name in named if path == name or path.startswith(f"{name}/")), path)
    return str(Path(origin.root, named.get(file, file) + path.removeprefix(file)))
