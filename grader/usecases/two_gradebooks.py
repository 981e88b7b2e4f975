"""Compare two runs of a gradebook, or two gradebooks; merge the marks of two, and ask which of two marks counts."""

from collections.abc import Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import NamedTuple

from grader.classroom.gradebook.changes import changes
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.histories import MergeItem, compare_marks
from grader.classroom.gradebook.merge import Choice, ConflictId, Merged, conflict_of, copy_of, merge
from grader.classroom.gradebook.snapshots import Snapshot, last_two
from grader.errors import GraderError, InputError
from grader.report.changes import render_changes, render_changes_json
from grader.report.formats import OutputFormat
from grader.report.review import mark_text
from grader.report.screen import Screen, draw
from grader.text import counted, printable, printable_path
from grader.usecases.exit_codes import ExitCode
from grader.usecases.terminal import Terminal

_MAX_COMPARED = 2


class DiffRequest(NamedTuple):
    """A gradebook and a newer one, or two runs of one gradebook; default: its last two."""

    gradebooks: tuple[Path, ...]
    before: int | None
    after: int | None


def diff(request: DiffRequest, kind: OutputFormat, screen: Screen) -> str:
    """Return whose grade changed between two runs, by how much, and why. Raises GraderError."""
    if not 1 <= len(request.gradebooks) <= _MAX_COMPARED:
        raise GraderError(f"give one gradebook, or two to compare, not {len(request.gradebooks)}")
    if len(request.gradebooks) > 1 and (request.before or request.after):
        raise GraderError("--before and --after choose runs of one gradebook: give one gradebook, or omit them")
    with ExitStack() as opened:
        books = [opened.enter_context(Gradebook(path)) for path in request.gradebooks]
        if len(books) == 1:
            sides = last_two(books[0], request.before, request.after)
        else:
            sides = Snapshot(books[0]), Snapshot(books[1])
        found = changes(*sides)
        runs = sides[0].newest_run, sides[1].newest_run
    if kind is OutputFormat.JSON:
        return render_changes_json(found, runs)
    return draw(partial(render_changes, found, runs), screen)


_ANSWERS: dict[str, Choice | None] = {
    "k": "first", "keep": "first", "t": "second", "take": "second", "s": None, "skip": None,
}  # fmt: skip


def merge_gradebooks(first: Path, second: Path, keep: Choice | None, terminal: Terminal) -> tuple[str, ExitCode]:
    """Add the marks of the second gradebook to the first one; return what was merged and the exit code.

    Conflicts are decided by `keep`, else on the terminal, before anything is written. Raises InputError.
    """
    if first.exists() and second.exists() and first.samefile(second):
        raise InputError(f"{printable_path(first)} cannot be merged into itself: name two gradebooks")
    with Gradebook(first) as book, copy_of(second) as other:
        conflicts = [item for item in compare_marks(book, other).items if item.is_conflict]
        names = book.shown, other.shown
        choices = {conflict_of(item): keep for item in conflicts} if keep else _ask_choices(conflicts, names, terminal)
        merged = merge(book, other, choices)
    is_complete = not merged.conflicts and not merged.unmatched
    return "".join(f"{line}\n" for line in _lines(merged, names)), ExitCode.PASSED if is_complete else ExitCode.FAILED


def _ask_choices(conflicts: list[MergeItem], names: tuple[str, str], terminal: Terminal) -> dict[ConflictId, Choice]:
    """Ask which mark counts in each conflict, until the end of the input."""
    choices: dict[ConflictId, Choice] = {}
    prompt = f"k to keep the mark of {names[0]}, t to take that of {names[1]}, s to skip: "
    for item in conflicts:
        terminal.print("".join(f"{line}\n" for line in _conflict_lines(item, names)))
        answer = terminal.ask(prompt)
        while answer is not None and answer.strip().lower() not in _ANSWERS:
            answer = terminal.ask(prompt)
        if answer is None:
            terminal.print("\n")
            break
        if choice := _ANSWERS[answer.strip().lower()]:
            choices[conflict_of(item)] = choice
    return choices


def _lines(merged: Merged, names: tuple[str, str]) -> Iterator[str]:
    """Yield what was merged, and what was not."""
    if merged.entries:
        entries = counted(merged.entries, "entry", "entries")
        yield f"{entries} of {counted(merged.students, 'student')} merged into {names[0]}"
    elif not merged.conflicts and not merged.unmatched:
        yield f"nothing to merge: {names[0]} has all marks of {names[1]}"
    if merged.conflicts:
        reason = "both gradebooks have new marks (--keep first or --keep second decides)"
        yield f"not merged, because {reason}: {len(merged.conflicts)}"
    for item in merged.conflicts:
        yield from (f"  {line}" for line in _conflict_lines(item, names))
    if merged.unmatched:
        yield f"not merged, because {names[0]} has no such student: {len(merged.unmatched)}"
    for student in merged.unmatched:
        yield printable(f"  {student.key}: {counted(student.entries, 'entry', 'entries')}")


def _conflict_lines(item: MergeItem, names: tuple[str, str]) -> Iterator[str]:
    yield printable(f"{item.key}, {item.criterion}:")
    for name, entry in zip(names, item.newest, strict=True):
        if entry is not None:
            yield f"  {name}: {mark_text(entry.mark)}"
