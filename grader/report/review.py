"""An item of a review in words: whose it is, what was found, where the files are, what it is marked with."""

from datetime import datetime
from pathlib import Path

from grader.checks.manual import answered
from grader.classroom.lateness import time_text
from grader.classroom.marks import Mark
from grader.classroom.review_items import Member, ReviewItem
from grader.grading.pictures import evidence_files
from grader.grading.report import Result
from grader.report.details import counts_lines
from grader.text import counted, counted_points, named, printable


def who(one: Member) -> str:
    """Return the name and key of the student, or the number of an anonymous one; printable."""
    return f"submission {one.number}" if one.number is not None else printable(named(one.student.key, one.student.name))


def together_text(item: ReviewItem) -> str:
    """Return why one mark serves the students of an item."""
    if not item.answer:
        return "No answer" if item.criterion.check.function is answered else "No evidence"
    is_team = len({(one.graded.root, one.graded.paths) for one in item.members}) == 1
    return "The same files" if is_team else "The same answer"


def message_text(item: ReviewItem, result: Result) -> str:
    """Return what was found; without the names of files, which students choose, if the student is anonymous."""
    outcome, files = result.outcome, evidence_files(result)
    if item.is_empty_group:
        return ""
    if item.first.number is None or outcome.status != "pending":
        return printable(outcome.message if item.first.number is None else f"the check: {outcome.status}")
    found = counted(len(files), "file") if files else "an answer" if isinstance(outcome.measured, str) else "nothing"
    question = item.criterion.arguments.get("question", "")
    return printable(f"{question} {outcome.problem or f'{found} to grade'}".strip())


def marked_text(item: ReviewItem) -> str:
    """Return the mark or comment that counts, and what is special about it; empty without one."""
    mark = item.first.mark
    if mark is None:
        return ""
    notes = ["partial points"] if mark.points is not None and 0 < mark.points < item.criterion.points else []
    notes += ["before the submission changed"] if item.first.state == "older" else []
    return f"{mark_text(mark)} ({', '.join(notes)})" if notes else mark_text(mark)


def mark_text(mark: Mark) -> str:
    """Return a mark in one printable line: points, name, time, comment."""
    points = counted_points(mark.points) if mark.points is not None else mark.kind
    time = f"at {time_text(datetime.fromisoformat(mark.time))}" if mark.time else f"in {mark.place}"
    words = f"{points} by {mark.by or 'an unnamed person'} {time}"
    comment = " ".join(mark.comment.split())
    return printable(f"{words}: {comment}" if comment else words)


def files_text(item: ReviewItem, result: Result, root: Path) -> list[str]:
    """Return the files that a criterion is about, else the submission, printable; nothing of an anonymous student.

    `root` is the class folder that the submission is in.
    """
    location = result.outcome.location
    if item.first.number is not None or item.is_empty_group:
        return []
    found = [_place(item, path, root) for path in evidence_files(result)]
    if location is not None:
        line = f", line {location.line}" if counts_lines(location) else ""
        found.append(f"{_place(item, location.path, root)}{line}")
    return [printable(place) for place in found or [", ".join(str(root / path) for path in item.first.graded.paths)]]


def _place(item: ReviewItem, path: str, root: Path) -> str:
    """Return where a file of the submission is on this machine."""
    paths, names = item.first.graded.paths, item.first.graded.names
    if len(paths) == 1 and paths[0].rpartition("/")[2] != path:  # not a single document
        return str(root / paths[0] / path)
    files = dict(zip(names or [name.rpartition("/")[2] for name in paths], paths, strict=True))
    file = next((name for name in files if path == name or path.startswith(f"{name}/")), path)
    return str(root / (files.get(file, file) + path.removeprefix(file)))
