"""What a person has to see to decide a criterion: the answer that was found, the model answer, where the pictures are."""

from pathlib import Path

from rich.console import Console
from rich.text import Text

from grader.classroom.gradebook.marks import Mark, Pending
from grader.report.console import wrapped
from grader.text import counted_points, format_points, printable

_INDENT = 2


def render_pending(pending: Pending, place: str, console: Console) -> None:
    """Print a question of a student, `place` of all that wait. Nothing of the submission is taken for markup or control codes."""
    criterion, outcome = pending.result.criterion, pending.result.outcome
    student = pending.standing.student
    who = f"{student.name} ({student.key})" if student.name else student.key
    console.print()
    head = f"{place}  {printable(who)}: {printable(criterion.title)}  {format_points(criterion.points)} points"
    wrapped(console, Text(head, style="bold"), 0)
    wrapped(console, Text(printable(outcome.message)), 0)
    if isinstance(outcome.measured, str):
        _show("Found", outcome.measured, console)
    elif isinstance(outcome.measured, tuple | list):
        _show("Look at", "\n".join(_where(pending, str(each)) for each in outcome.measured), console)
    if criterion.answer:
        _show("Model answer", criterion.answer, console)
    if outcome.location is not None:
        place = f"in {_where(pending, outcome.location.path)}, line {outcome.location.line}"
        wrapped(console, Text(printable(place), "dim"), 0)


def mark_text(mark: Mark) -> str:
    """Return a mark in one printable line: points, by whom if they gave a name, when, and the comment."""
    what = "taken back" if mark.points is None else counted_points(mark.points)
    words = [what, f"by {mark.by}" if mark.by else "by a person without a name", f"at {mark.at}"]
    comment = " ".join(mark.comment.split())
    return printable(f"{' '.join(words)}: {comment}" if comment else " ".join(words))


def _show(what: str, text: str, console: Console) -> None:
    wrapped(console, Text(f"{what}:", style="bold"), 0)
    for line in filter(str.strip, text.splitlines()):
        wrapped(console, Text(printable(line)), _INDENT)


def _where(pending: Pending, path: str) -> str:
    """A file of the submission as a person may open it."""
    origin = pending.standing.origin
    if len(origin.paths) == 1:
        return str(Path(origin.root, origin.paths[0], path))
    called = dict(zip(origin.names or [each.rpartition("/")[2] for each in origin.paths], origin.paths, strict=True))
    file = next((name for name in called if path == name or path.startswith(f"{name}/")), path)
    return str(Path(origin.root, called.get(file, file) + path.removeprefix(file)))
