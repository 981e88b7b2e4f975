"""A review: one person goes through the items of a class. Each mark is saved immediately.

An item is opened by reading its submission again: what was found for its criterion, and its pictures. Instead of the
page, a person can fill in a sheet of the open items, a CSV file, which `grader mark --import` records.
"""

import os
from functools import lru_cache
from itertools import starmap
from pathlib import Path

from grader.classroom import gradebook_folder as names
from grader.classroom.gradebook import Gradebook
from grader.classroom.gradebook_folder import CLASS_FILE
from grader.classroom.marks import Key, Mark, append_marks, mark_file, mark_in
from grader.classroom.review_items import Place, ReviewFilter, ReviewItem, review_items
from grader.classroom.roster import plain
from grader.classroom.tables import write_table
from grader.classroom.typed_names import criterion_of
from grader.commands.grade_class import write_grades_with
from grader.commands.writing import save
from grader.documents.pictures import EmbeddedPicture, NotShown
from grader.errors import InputError
from grader.grading.criterion_pictures import evidence_files, loose_lines, may_have_pictures, pictures_of
from grader.grading.grade import grade
from grader.grading.model_answers import load_with_answers
from grader.grading.report import Report
from grader.report.criteria import answer_lines, counts_lines
from grader.report.pages.review_pages import NO_ANSWER, OpenedItem
from grader.submission.submission import Submission
from grader.text import counted, cut, enumerated, format_points, printable, printable_path, shell_quoted

CONFIRMED = "!"  # ends what the page sends to replace marks that it was asked about
_MAX_NAMED = 5
_GONE = "this answer has changed, or its students have final marks: go to the next item"
_READ = (names.RESULTS, CLASS_FILE, names.ROSTER, f"{names.RUBRIC}/**/*.toml", f"{names.MARKS}/*")
_SHEET_COLUMNS = ("criterion", "answer", "points", "maximum", "comment", "text", "students")
_PRIVATE = 0o600
_MAX_TEXT = 30_000  # characters; a cell of Excel has at most 32,767


class ReviewSession:
    """The items of a review, which keep their positions.

    `by` is the name that reports show, `answers` the file of the model answers. `own` are the newest marks that the
    review has given.
    """

    def __init__(
        self,
        folder: Path,
        shown: ReviewFilter = ReviewFilter(),  # noqa: B008  it never changes
        by: str = "",
        answers: Path | None = None,
        *,
        is_anonymous: bool = False,
    ) -> None:
        self.folder, self.by, self.answers, self.is_anonymous = folder, by, answers, is_anonymous
        self.file = mark_file(folder / names.MARKS, by)
        self.own = dict[Key, Mark]()
        self._kept = set[Key]()  # marked since the filter was chosen: these stay in the list
        self.places: tuple[Place, ...] = ()
        self._stamps: object = None
        self.refresh()
        self.show_only(shown)

    def refresh(self) -> None:
        """Read the gradebook again if it has changed. Raises InputError."""
        found = ((path, path.stat()) for pattern in _READ for path in self.folder.glob(pattern))
        stamps = [(path, status.st_ino, status.st_size, status.st_mtime_ns) for path, status in found]
        if stamps != self._stamps:
            self.book = Gradebook(self.folder)
            rubric = str(self.folder / self.book.settings.rubric)
            self.book.rubric = load_with_answers(rubric, self.answers)
            self.items = review_items(self.book, is_anonymous=self.is_anonymous)
            self.places = tuple(dict.fromkeys((*self.places, *self.items)))
            self._stamps = stamps

    @property
    def sections(self) -> dict[str, str]:
        """The sections of the roster, by their names without differences of spelling."""
        students = self.book.roster.students if self.book.roster is not None else ()
        return {plain(one.section): one.section for one in students if one.section}

    @property
    def left(self) -> int:
        """The number of results that need manual grading, of the question and section that are shown."""
        unmarked = ReviewFilter(*self.filter[:2])
        return sum(len(unmarked.members(item)) for item in self.items.values())

    @property
    def listed(self) -> list[int]:
        """The positions of the items that are shown."""
        found = ((at, self.items.get(place)) for at, place in enumerate(self.places))
        return [at for at, item in found if item is not None and self.filter.members(item, self._kept)]

    def item_at(self, at: int) -> ReviewItem:
        """Return an item with the students that are shown, with others if none is. Raises InputError if it is gone."""
        item = self.items.get(self.places[at])
        if item is None:
            raise InputError(_GONE)
        of_section = ReviewFilter("", self.filter.section, "").members(item)
        return item._replace(members=self.filter.members(item, self._kept) or of_section or item.members)

    def following(self, position: int = -1) -> int:
        """Return the position of the next item that is shown, beyond the last one at the end."""
        return next((at for at in self.listed if at > position), len(self.places))

    def previous(self, position: int) -> int:
        """Return the position of the previous item that is shown, the same position if there is none."""
        return max((at for at in self.listed if at < position), default=position)

    def show_only(self, wanted: ReviewFilter) -> None:
        """Show the items that a filter lets through. Raises InputError."""
        sections = self.sections
        if wanted.criterion:
            criterion_of(self.book.rubric, wanted.criterion)
        if wanted.section and plain(wanted.section) not in sections:
            known = enumerated([*map(repr, sorted(sections.values()))], _MAX_NAMED) or "none"
            raise InputError(f"no student has the section {wanted.section!r} in the roster; it has {known}")
        self.filter = wanted._replace(section=sections.get(plain(wanted.section), ""))
        self._kept.clear()

    def mark(self, at: int, points: str, comment: str, shown: str) -> list[Mark] | None:
        """Append a mark for each student of an item; `-` as points withdraws marks.

        `shown` is the item's view that the person saw: without effect, returns None if it is another one. Returns the
        marks of others that would be replaced; nothing is saved then, unless `shown` ends with CONFIRMED. Raises
        InputError.
        """
        item = self.item_at(at)
        self._check_rows()
        if shown.removesuffix(CONFIRMED) != item.view:
            return None
        if not points.strip():
            raise InputError("points are missing")
        cells = {"time": "", "by": self.by, "points": points.strip(), "comment": comment, "": ""}
        new = dict[Key, Mark]()
        for one in item.members:
            key = one.student.key, item.criterion.id
            mark = mark_in({**cells, "submission": one.stored.digest}, key, item.criterion.points, "")
            new[key] = mark._replace(time=self.book.marks.next_time(key))
        replaced = [one.mark for one in item.members if one.mark is not None and one.mark.points is not None]
        others = [mark for mark in replaced if mark.by != self.by]
        if others and not shown.endswith(CONFIRMED):
            return others
        append_marks(self.file, new.values())
        self.own |= new
        self._kept |= new.keys()
        self.refresh()
        write_grades_with(len(new), self.book)
        return []

    def _check_rows(self) -> None:
        """Raise InputError, once, if rows that this review wrote are no longer in the file."""
        newest = self.book.marks.newest
        lost = [key for key, mark in self.own.items() if key not in newest or "" < newest[key].time < mark.time]
        found = [self.own.pop(key) for key in lost]
        if found:
            rows = [f"{one.criterion} {one.value}" for one in found]
            if not self.is_anonymous:
                rows = [f"{row} of {one.student}" for row, one in zip(rows, found, strict=True)]
            shown = printable_path(Path(names.MARKS, self.file.name))
            why = f"rows of this review are no longer in {shown}, which another program has replaced"
            raise InputError(f"Not saved: {why}: {enumerated(rows, _MAX_NAMED)}. Save again to go on without them.")


@lru_cache(maxsize=1)  # a page asks for its pictures one by one
def _graded_again(book: Gradebook, key: str) -> tuple[Submission, Report]:
    """Return a student's submission as it was graded, and its report. Raises InputError."""
    graded = book.results.of(key)
    submission = book.reopened(graded) if graded is not None else None
    if submission is None:
        command = f"`grader batch NEWPATH --gradebook {shell_quoted(book.folder)}` with its class folder"
        raise InputError(f"the submission has moved or changed since it was graded: run {command}")
    return submission, grade(book.rubric, submission, book.settings.parts, is_one_of_class=True)


def open_item(book: Gradebook, item: ReviewItem) -> OpenedItem:
    """Return what a person looks at for an item. Raises InputError if its submission has moved or changed.

    Of an anonymous student it has no names of files, because students choose them.
    """
    first = item.members[0]
    if item.members[1:] and not item.answer:
        return OpenedItem("")
    submission, report = _graded_again(book, first.student.key)
    result = next((one for one in report.results if one.criterion.id == item.criterion.id), None)
    if result is None:
        raise InputError("this criterion is no longer graded for this student")
    pictures = pictures_of(result, submission) if may_have_pictures(result) else ()
    outcome, location, places = result.outcome, result.outcome.location, [*evidence_files(result)]
    if first.number:
        answer = loose_lines(result, submission, is_anonymous=True) or answer_lines(outcome)
        question = str(item.criterion.arguments.get("question", ""))
        message = question if outcome.status == "pending" else f"the check: {outcome.status}"
        return OpenedItem(message, answer, [*starmap(_anonymous, enumerate(pictures, 1))])
    if location is not None:
        places.append(f"{location.path}, line {location.line}" if counts_lines(location) else location.path)
    root = book.settings.roots(book.folder)[first.stored.root]
    submitted = ", ".join(str(root / path) for path in first.stored.paths)
    paths = [f"{place} in {submitted}" for place in places] or [submitted]
    return OpenedItem(outcome.message, loose_lines(result, submission) or answer_lines(outcome), pictures, paths)


def _anonymous(number: int, found: EmbeddedPicture | NotShown) -> EmbeddedPicture | NotShown:
    if isinstance(found, EmbeddedPicture):
        return found._replace(where=f"picture {number}")
    return NotShown(f"file {number}", found.reason.replace(found.where, f"file {number}"))


def write_sheet(session: ReviewSession, file: Path) -> str:
    """Write the items that are shown into a new file, and return what to do with it. Raises InputError."""
    if os.path.lexists(file):
        raise InputError(f"{printable_path(file)} exists, perhaps with marks in it: name another file for --sheet")
    items = [session.item_at(at) for at in session.listed]
    by_student = sorted(items, key=lambda item: item.members[0].student.key)  # a submission is read once
    texts = {item.place: _sheet_text(session.book, item) for item in by_student}
    rows = [
        (*item.place, "", format_points(item.criterion.maximum), "", texts[item.place], _students(item))
        for item in items
    ]
    save(file, write_table(_SHEET_COLUMNS, rows), session.book.settings.roots(session.folder), _PRIVATE)
    command = f"grader mark --import {shell_quoted(file)} --gradebook {shell_quoted(session.folder)}"
    return f"{counted(len(items), 'item')} written for {session.left} marks; fill in the points, then: {command}\n"


def _students(item: ReviewItem) -> str:
    return "; ".join(one.label if one.number else one.student.key for one in item.members)


def _sheet_text(book: Gradebook, item: ReviewItem) -> str:
    """Return the answer, else what was found, and the files, which may show more."""
    try:
        opened = open_item(book, item)
    except InputError as error:
        return f"Not shown: {error}"
    lines = [*filter(str.strip, opened.answer)] or [opened.message or NO_ANSWER]
    return cut("\n".join(map(printable, [*lines, *opened.paths])), _MAX_TEXT)
