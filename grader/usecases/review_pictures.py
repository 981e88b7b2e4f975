"""Write the pictures of all items that need manual grading to files, for a review without a browser."""

from collections.abc import Callable
from itertools import starmap
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.manual_queue import QueuedResult
from grader.classroom.gradebook.submission_files import SubmissionSources
from grader.classroom.review.items import QueuedItem
from grader.classroom.review.session import ReviewSession
from grader.documents.pictures import EmbeddedPicture, NotShown
from grader.errors import InputError
from grader.grading.pictures import may_have_pictures, pictures_of
from grader.grading.rubric import Rubric
from grader.report.review import who
from grader.text import printable, printable_path
from grader.usecases.class_reports import refuse_report_folder
from grader.usecases.report_names import file_names, report_names, update_index
from grader.usecases.writing import make_folder, save_bytes

_CHANGED = "the files have changed or moved since they were graded: run `grader batch` again"


def item_pictures(item: QueuedResult, rubric: Rubric) -> tuple[EmbeddedPicture | NotShown, ...]:
    """Return an item's pictures, and files that are not shown; the submission is reopened and must be unchanged."""
    if item.is_empty_group or not may_have_pictures(item.result):
        return ()
    submission = SubmissionSources(item.grade.files, rubric).submission
    found = (NotShown("pictures", _CHANGED),) if submission is None else pictures_of(item.result, submission)
    return found if item.first.number is None else tuple(starmap(_anonymous, enumerate(found, 1)))


def _anonymous(number: int, found: EmbeddedPicture | NotShown) -> EmbeddedPicture | NotShown:
    """Return a picture, or why it is not shown, without the name of its file, which students choose."""
    if isinstance(found, EmbeddedPicture):
        return found._replace(where=f"picture {number}")
    return NotShown(f"file {number}", found.reason.replace(found.where, f"file {number}"))


class PictureFolder:
    """Writes pictures as FOLDER/CRITERION/STUDENT.NUMBER.ENDING.

    The ending is that of the verified format. No symlink in the folder is followed, and no file of another student is
    overwritten. An anonymous review needs an empty folder, because it must not show whose files are there. Raises
    InputError.
    """

    def __init__(self, session: ReviewSession, book: Gradebook, folder: Path) -> None:
        self._session, self._folder = session, folder
        refuse_report_folder(folder, (), sorted({Path(run.source) for run in book.runs()}))
        self._folders = file_names([criterion.id for criterion in session.criteria])
        self._names = {} if session.scope.anonymous else report_names(book)
        make_folder(folder)
        if not session.scope.anonymous:
            keys = {key for item in session.queue.items for key, _ in item.students}
            update_index(folder, {key: self._names[key] for key in sorted(keys)})
        elif any(folder.iterdir()):
            raise InputError(f"{printable_path(folder)} is not empty: --anonymous needs a new folder for --pictures")

    def write(self, item: QueuedResult) -> list[str]:
        """Write the pictures of an item; return a line for each, also for those that are not shown."""
        key, criterion = item.grade.student.key, item.result.criterion.id
        name = self._names[key] if item.first.number is None else f"submission-{item.first.number}"
        start = self._folder / self._folders[criterion] / name
        found = item_pictures(item, self._session.rubric_of(item))
        return [_write_picture(one, start, number, item) for number, one in enumerate(found, 1)]


def write_all_pictures(
    session: ReviewSession, folder: PictureFolder, show: Callable[[str], None]
) -> dict[QueuedItem, list[str]]:
    """Write the pictures of all items, and print the student of each; return those of each item."""
    found: dict[QueuedItem, list[str]] = {}
    for position in session.queue.listed():
        item, queued = session.queue.item_at(position), session.queue.items[position]
        if item is None or not item.content:
            continue
        found[queued] = folder.write(item)
        for line in found[queued]:
            show(f"{who(item.first)}, {printable(queued.criterion)}: {line}\n")
    session.start()
    return found


def _write_picture(found: EmbeddedPicture | NotShown, start: Path, number: int, item: QueuedResult) -> str:
    """Write a picture, unless it is not shown, and return the line about it."""
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
