"""Read the submission of an item again: what was found for its criterion, and the pictures that belong to it."""

from functools import lru_cache
from itertools import starmap
from typing import NamedTuple

from grader.checks.outcome import Outcome
from grader.classroom.grades import Class
from grader.classroom.reopening import reopened
from grader.classroom.review_items import ReviewItem
from grader.documents.pictures import EmbeddedPicture, NotShown
from grader.errors import InputError
from grader.grading.grade import grade
from grader.grading.pictures import may_have_pictures, pictures_of
from grader.grading.report import Report, Result
from grader.submission.submission import Submission
from grader.text import shell_quoted


class OpenedItem(NamedTuple):
    """The result as the check finds it, and the pictures, with files that are not shown."""

    result: Result
    pictures: tuple[EmbeddedPicture | NotShown, ...] = ()


@lru_cache(maxsize=1)
def _graded_again(book: Class, key: str) -> tuple[Submission, Report]:
    """Return a student's submission as it was graded, and its report. Raises InputError."""
    graded = book.results.of(key)
    submission = reopened(book, graded) if graded is not None else None
    if submission is None:
        command = f"`grader batch NEWPATH --gradebook {shell_quoted(book.folder)}` with its class folder"
        raise InputError(f"the submission has moved or changed since it was graded: run {command}")
    return submission, grade(book.rubric, submission, book.settings.parts, is_one_of_class=True)


def open_item(book: Class, item: ReviewItem) -> OpenedItem:
    """Return what a person looks at for an item. Raises InputError if its submission has moved or changed."""
    if item.is_empty_group:
        return OpenedItem(Result(item.criterion, Outcome("pending", "")))
    submission, report = _graded_again(book, item.first.student.key)
    result = next((one for one in report.results if one.criterion.id == item.criterion.id), None)
    if result is None:
        raise InputError("this criterion is no longer graded for this student")
    found = pictures_of(result, submission) if may_have_pictures(result) else ()
    return OpenedItem(result, found if item.first.number is None else tuple(starmap(_anonymous, enumerate(found, 1))))


def _anonymous(number: int, found: EmbeddedPicture | NotShown) -> EmbeddedPicture | NotShown:
    """Return a picture, or why it is not shown, without the name of its file, which students choose."""
    if isinstance(found, EmbeddedPicture):
        return found._replace(where=f"picture {number}")
    return NotShown(f"file {number}", found.reason.replace(found.where, f"file {number}"))
