"""What a person looks at to give a mark: the submission is read again, as it was graded.

Of a question it is the answer, of evidence the pictures, of the robot or package the file around
the line that decides; and the views of the robot, unless several students have the same answer.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import islice, starmap
from pathlib import PurePosixPath

from grader.base.errors import InputError
from grader.base.source import Location
from grader.base.text import capitalised, shell_quoted
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.review_items import ReviewItem
from grader.classroom.review.review_pages import OpenedItem
from grader.lab.checks.outcome import compute_location
from grader.lab.documents.pictures import EmbeddedPicture, NotShown
from grader.lab.grading.criterion_pictures import (
    evidence_files,
    find_pictures,
    loose_lines,
    may_have_pictures,
)
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.criterion import Criterion
from grader.lab.submission.submission import Submission
from grader.report.criteria import answer_lines, counts_lines, is_manual
from grader.report.drawing.graded_picture import draw_report
from grader.report.drawing.picture import Picture
from grader.report.drawing.space import space_data, without_names
from grader.report.drawing.three_views import callout_lines, drawing_element
from grader.report.locations import location_text, source_lines
from grader.ros.api import SETUP

_MAX_PLACES, _AROUND = 3, 6  # places in files, and lines before and after each
# The codes of what cannot be determined, by what a check looks at.
_UNKNOWN = {SETUP: "PKG016", "launch": "LCH004"}


@lru_cache(maxsize=1)  # a page asks for its pictures one by one
def _graded_again(book: Gradebook, key: str) -> tuple[Submission, Report]:
    """Return a student's submission as it was graded, and its report. Raises InputError."""
    graded = book.results.of(key)
    submission = book.reopened(graded) if graded else None
    if not submission:
        command = (
            f"`grader batch NEWPATH --gradebook {shell_quoted(book.folder)}` with its class folder"
        )
        raise InputError(f"the submission has moved or changed since it was graded: run {command}")
    return submission, grade(book.rubric, submission, book.settings.parts, is_one_of_class=True)


def open_item(book: Gradebook, item: ReviewItem) -> OpenedItem:
    """Return what a person looks at for an item.

    Raises InputError if its submission has moved or changed.

    Of an anonymous student it has no names of files and no lines of them, because students choose
    them.
    """
    first = item.members[0]
    if item.members[1:] and not item.answer:
        return OpenedItem("")
    submission, report = _graded_again(book, first.student.key)
    graded = {one.criterion.id: one for one in report.results}
    results = [graded[one.criterion.id] for one in item.all if one.criterion.id in graded]
    if len(results) < len(item.all):
        raise InputError("this criterion is no longer graded for this student")
    result = results[0]
    outcome = results[0].outcome
    opened = OpenedItem(
        capitalised(outcome.message),
        answer_lines(outcome),
        find_pictures(result, submission) if may_have_pictures(result) else (),
        list(_paths(book, item, result)),
    )
    documents = loose_lines(result, submission, is_anonymous=bool(first.number))
    if documents:
        opened = opened._replace(answer=documents, title="Documents")
    if not is_manual(result) or not item.members[1:]:
        shown = [] if is_manual(result) else results
        opened = _with_robot(opened, report, shown, is_anonymous=bool(first.number))
    if first.number:
        return _anonymous(opened, item, result)
    return opened


def _paths(book: Gradebook, item: ReviewItem, result: Result) -> Iterator[str]:
    """Yield the places in a submission and its path below the class folder.

    The class folder is named if there are several.
    """
    stored = item.members[0].stored
    location = result.outcome.location
    root = book.roots[stored.root]
    above = PurePosixPath(root.name if len(book.settings.submissions) > 1 else "")
    submitted = ", ".join(str(above / path) for path in stored.paths)
    places = list(evidence_files(result))
    if location:
        places.append(
            f"{location.path}, line {location.line}" if counts_lines(location) else location.path
        )
    yield from (f"{place} in {submitted}" for place in places)
    if not places:
        yield submitted


def _anonymous(opened: OpenedItem, item: ReviewItem, result: Result) -> OpenedItem:
    """Return an item without what a student has named."""
    status = result.outcome.status
    question = str(item.criterion.arguments.get("question", ""))
    message = question if status == "pending" else f"the check: {status}"
    pictures = list(starmap(_without_name, enumerate(opened.pictures, 1)))
    return opened._replace(message=message, pictures=pictures, paths=(), legend=(), places=())


def _without_name(number: int, picture: EmbeddedPicture | NotShown) -> EmbeddedPicture | NotShown:
    if isinstance(picture, EmbeddedPicture):
        return picture._replace(where=f"picture {number}")
    return NotShown(f"file {number}", picture.reason.replace(picture.where, f"file {number}"))


def _with_robot(
    opened: OpenedItem, report: Report, results: Sequence[Result], *, is_anonymous: bool
) -> OpenedItem:
    """Return an item with the views of the robot.

    The item gets the files around the places that decide its criteria, too.
    """
    picture = draw_report(report)
    views = ""
    legend = []
    space = None
    if picture:
        legend = callout_lines(picture)
        space = space_data(picture, {})
        if is_anonymous and space is not None:
            space = without_names(space)
        views = drawing_element(_without_names(picture) if is_anonymous else picture, legend=False)
    problem_places = dict.fromkeys(
        place for result in results if (place := _deciding_place(report, result))
    )
    shown = (
        (location_text(one), source_lines(one, report.submission.source, _AROUND))
        for one in problem_places
    )
    places = list(islice(((words, lines) for words, lines in shown if lines), _MAX_PLACES))
    return opened._replace(views=views, space=space, legend=legend, places=places)


def _without_names(picture: Picture) -> Picture:
    """Return a picture without the names of links.

    So it has none of the numbers and sentences about them.
    """
    bodies = tuple(body._replace(link="") for body in picture.scene.bodies)
    scene = replace(picture.scene, bodies=bodies, missing=(), boxed=())
    return replace(picture, scene=scene, callouts=())


def _deciding_place(report: Report, result: Result) -> Location | None:
    """Return the place that decides a criterion of the robot or package; None if there is none.

    It is that of the outcome, else that of what cannot be determined, else that of the link that is
    examined.
    """
    outcome = result.outcome
    criterion = result.criterion
    robot = report.submission.robot
    if outcome.location:
        return outcome.location
    if outcome.status == "pending":
        unknown = _unknown_place(report, criterion)
        if unknown:
            return unknown
    if not robot or not robot.links or not criterion.check.is_of_robot:
        return None
    link = criterion.arguments.get("link")
    if isinstance(link, str) and robot.has_link(link):
        examined = robot.link(link)
    else:
        examined = robot.links[0]
    return compute_location(examined.known.location)


def _unknown_place(report: Report, criterion: Criterion) -> Location | None:
    """Return the place of what keeps a criterion from being determined.

    This is first searched in a file that its check looks at.
    """
    if criterion.check.is_of_robot:
        problems = [one for one in report.problems if one.kind.effect == "undetermined"]
    else:
        own_codes = [_UNKNOWN[name] for name in criterion.check.about.looks_at if name in _UNKNOWN]
        problems = [one for one in report.problems if one.code in _UNKNOWN.values()]
        problems.sort(key=lambda one: one.code not in own_codes)
    return problems[0].location if problems else None
