"""Write the pictures of all items that need manual grading to files, for a review without a browser."""

from collections.abc import Callable
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.manual_queue import QueuedCriterion, QueuedResult
from grader.classroom.review.session import ReviewSession, item_pictures
from grader.documents.pictures import NotShown, Picture
from grader.errors import InputError
from grader.report.review import who
from grader.text import printable, printable_path
from grader.usecases.class_reports import refuse_report_folder
from grader.usecases.report_names import file_names, report_names, update_index
from grader.usecases.writing import make_folder, save_bytes

PicturesOfItems = dict[QueuedCriterion, list[str]]


def write_pictures(
    session: ReviewSession, book: Gradebook, folder: Path, show: Callable[[str], None]
) -> PicturesOfItems:
    """Write each picture as FOLDER/CRITERION/STUDENT.NUMBER.ENDING, and print the student of each; return the lines of each item.

    The ending is that of the verified format. No symlink in the folder is followed, and no file of another student is overwritten.
    Raises InputError.
    """
    refuse_report_folder(folder, (), sorted({Path(run.source) for run in book.runs()}))
    names = report_names(book)
    folders = file_names([criterion.id for criterion in session.criteria])
    make_folder(folder)
    update_index(folder, {key: names[key] for key in sorted({queued.key for queued in session.queue})})
    lines: PicturesOfItems = {}
    for position, queued in enumerate(session.queue):
        item = session.item_at(position)
        if item is None:
            continue
        start = folder / folders[queued.criterion] / names[queued.key]
        found = item_pictures(item, session.rubric_of(item))
        lines[queued] = [_written(one, start, number, item) for number, one in enumerate(found, 1)]
        for line in lines[queued]:
            show(f"{who(item.grade.student)}, {printable(queued.criterion)}: {line}\n")
    session.start()
    return lines


def _written(found: Picture | NotShown, start: Path, number: int, item: QueuedResult) -> str:
    """Write a picture and return the line about it; a picture that is not shown has only the line."""
    if isinstance(found, NotShown):
        return printable(str(found))
    path = start.with_name(f"{start.name}.{number}.{found.kind.ending}")
    make_folder(path.parent)
    _refuse_symlink(path)
    save_bytes(path, found.data, [item.grade.files.root])
    return f"{printable_path(path)}  {printable(found.words)}"


def _refuse_symlink(path: Path) -> None:
    for place in (path.parent, path):
        if place.is_symlink():
            raise InputError(f"cannot write {printable_path(path)}: {printable_path(place)} is a symlink")
