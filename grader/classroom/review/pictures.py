"""The pictures of an item of a review."""

from itertools import starmap

from grader.classroom.gradebook.manual_queue import QueuedResult
from grader.classroom.gradebook.student_grade import SubmissionSources
from grader.documents.pictures import NotShown, Picture
from grader.grading.pictures import may_have_pictures, pictures_of
from grader.grading.rubric import Rubric

_CHANGED = "the files have changed or moved since they were graded: run `grader batch` again"
_HIDDEN = "not shown here: the review without --anonymous says why"


def item_pictures(item: QueuedResult, rubric: Rubric) -> tuple[Picture | NotShown, ...]:
    """Return the pictures of an item, and files that are not shown. The submission is opened again and must be unchanged."""
    if not may_have_pictures(item.result):
        return ()
    submission = SubmissionSources(item.grade.files, rubric).submission
    found = (NotShown("pictures", _CHANGED),) if submission is None else pictures_of(item.result, submission)
    return found if item.number is None else tuple(starmap(_anonymous, enumerate(found, 1)))


def _anonymous(number: int, found: Picture | NotShown) -> Picture | NotShown:
    """Return a picture without the name of its file, which students choose."""
    if isinstance(found, Picture):
        return found._replace(where=f"picture {number}")
    return NotShown(f"picture {number}", _CHANGED if found.reason == _CHANGED else _HIDDEN)
