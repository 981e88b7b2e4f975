"""A criterion as `grader review` shows it: the answer, the model answer, where the pictures are."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from rich.console import Console
from rich.text import Text

from grader.checks.manual import MANUAL_CHECKS, answered
from grader.classroom.gradebook.manual_queue import QueuedMember, QueuedResult
from grader.classroom.gradebook.marks import Mark
from grader.classroom.lateness import time_text
from grader.grading.criterion import Criterion
from grader.grading.pictures import evidence_files
from grader.report.console import wrapped
from grader.report.details import answer_lines, counts_lines, model_lines
from grader.report.order import status_of
from grader.text import counted, counted_points, format_points, named, printable

_INDENT = 2


def render_item(
    item: QueuedResult, position: str, pictures: Sequence[str], comments: Mapping[int, str], console: Console
) -> None:
    """Print a criterion of a student, at `position` in the review, and earlier comments with their numbers.

    Text of the submission is never interpreted as markup.
    """
    criterion = item.result.criterion
    console.print()
    head = f"{position}  {who_together(item)}: {printable(criterion.title)} ({counted_points(criterion.points)})"
    wrapped(console, Text(head, style="bold"), 0)
    if item.others:
        _print_block(together_text(item), ["; ".join(map(who, item.members))], console)
    if not item.is_empty_group:
        wrapped(console, Text(message_text(item)), 0)
    if marked := marked_text(item):
        wrapped(console, Text(f"Marked: {marked}", style="bold"), 0)
    _print_block("Found", [] if item.is_empty_group else answer_lines(item.result.outcome), console)
    _print_block("Look at", files_text(item), console)
    _print_block("Pictures", pictures, console)
    _print_block("Model answer", model_lines(criterion), console)
    if place := place_text(item):
        wrapped(console, Text(f"in {place}", "dim"), 0)
    deductions = (f"d{number} {words}" for number, words in enumerate(choice_words(criterion), 1))
    _print_block("Usual deductions", deductions, console)
    lines = (f"#{number} {' '.join(comment.split())}" for number, comment in comments.items())
    _print_block("Earlier comments", lines, console)


def who(one: QueuedMember) -> str:
    """Return the name and key of the student, or the number of an anonymous one; printable."""
    student = one.grade.student
    if one.number is not None:
        return f"submission {one.number}"
    return printable(named(student.key, student.name))


def who_together(item: QueuedResult) -> str:
    """Return the student of an item, or the number of its students."""
    return f"{len(item.members)} students" if item.others else who(item.first)


def together_text(item: QueuedResult) -> str:
    """Return why one mark serves the students of an item."""
    if not item.content:
        return "No answer" if item.result.criterion.check.function is answered else "No evidence"
    is_team = len({one.grade.files.digest for one in item.members}) == 1
    return "The same files" if is_team else "The same answer"


def choice_words(criterion: Criterion) -> list[str]:
    """Return the usual deductions of a criterion with what they cost, printable."""
    return [printable(f"{text} ({format_points(points)})") for text, points in criterion.choices.items()]


def message_text(item: QueuedResult) -> str:
    """Return what was found; without the names of files, which students choose, if the student is anonymous."""
    outcome = item.result.outcome
    if item.first.number is None:
        return printable(outcome.message)
    if outcome.status != "pending":
        return f"the check: {outcome.status}"
    if outcome.problem and item.result.criterion.check.function in MANUAL_CHECKS:
        found = f"{outcome.problem}, needs manual grading"
    elif isinstance(outcome.measured, str):
        found = "a written answer, needs manual grading"
    elif files := evidence_files(item.result):
        found = f"{counted(len(files), 'file')}, {'needs' if len(files) == 1 else 'need'} manual grading"
    else:
        found = "nothing to show, needs manual grading"
    return printable(f"{item.result.criterion.arguments.get('question', '')} {found}".strip())


def marked_text(item: QueuedResult) -> str:
    """Return the mark or comment that counts, and whether a mark gives a part of the points; empty without one."""
    if item.first.mark is None or (item.result.manual_mark is None and item.result.comment is None):
        return ""
    is_partial = status_of(item.result) == "partial"
    return f"{mark_text(item.first.mark)}{' (partial points)' if is_partial else ''}"


def mark_text(mark: Mark) -> str:
    """Return a mark in one printable line: points, name, time, comment."""
    points = counted_points(mark.points) if mark.points is not None else mark.entry.kind
    parts = [points, f"by {mark.by}" if mark.by else "by an unnamed person", f"at {time_text(mark.at)}"]
    comment = " ".join(mark.comment.split())
    return printable(f"{' '.join(parts)}: {comment}" if comment else " ".join(parts))


def files_text(item: QueuedResult) -> list[str]:
    """Return where the files are that a criterion is about, printable."""
    return [printable(_where(item, file)) for file in evidence_files(item.result)] if item.first.number is None else []


def place_text(item: QueuedResult) -> str:
    """Return where the answer is, printable: the file, and the line if editors count lines; else the submission.

    Empty if the files are named elsewhere, or the student is anonymous.
    """
    location = item.result.outcome.location
    if item.first.number is not None or item.is_empty_group:
        return ""
    if location is None:
        submitted = (str(Path(item.grade.files.root, path)) for path in item.grade.files.paths)
        return "" if evidence_files(item.result) else printable(", ".join(submitted))
    line = f", line {location.line}" if counts_lines(location) else ""
    return printable(f"{_where(item, location.path)}{line}")


def _print_block(title: str, lines: Iterable[str], console: Console) -> None:
    """Print lines under a title; nothing if there are none."""
    shown = [*filter(str.strip, lines)]
    if shown:
        wrapped(console, Text(f"{title}:", style="bold"), 0)
    for line in shown:
        wrapped(console, Text(printable(line)), _INDENT)


def _where(item: QueuedResult, path: str) -> str:
    """Return the path of a file of the submission on this machine."""
    origin = item.grade.files
    if len(origin.paths) == 1 and origin.paths[0].rpartition("/")[2] == path:  # a single document
        return str(Path(origin.root, origin.paths[0]))
    if len(origin.paths) == 1:
        return str(Path(origin.root, origin.paths[0], path))
    named = dict(zip(origin.names or [name.rpartition("/")[2] for name in origin.paths], origin.paths, strict=True))
    file = next((name for name in named if path == name or path.startswith(f"{name}/")), path)
    return str(Path(origin.root, named.get(file, file) + path.removeprefix(file)))
