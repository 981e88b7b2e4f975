"""A review: one person goes through the items of a class. Each mark is saved immediately.

An item is opened by reading its submission again: what was found for its criterion, and its
pictures. Instead of the page, a person can fill in a sheet of the open items, a CSV file, which
`grader mark --import` records.
"""

import os
from collections import defaultdict
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

from grader.base.errors import InputError
from grader.base.text import (
    MAX_NAMED,
    counted,
    counted_points,
    cut,
    enumerated,
    format_points,
    printable,
    printable_path,
    shell_quoted,
)
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades_file import write_grades_with
from grader.classroom.gradebook.review_items import (
    UNMARKED,
    Place,
    ReviewFilter,
    ReviewItem,
    review_items,
)
from grader.classroom.gradebook.student_grade import pending_words
from grader.classroom.marks import gradebook_folder as names
from grader.classroom.marks.gradebook_folder import CLASS_FILE
from grader.classroom.marks.marks import Key, Mark, append_marks, mark_file, mark_in, maxima
from grader.classroom.review.opened_item import open_item
from grader.classroom.review.review_pages import NO_ANSWER, SimilarItem
from grader.classroom.review.similar_answers import share_of_words, split_words
from grader.classroom.roster.roster import plain
from grader.classroom.roster.typed_names import find_criterion
from grader.classroom.tables import write_table
from grader.lab.rubric.criterion import GRADE
from grader.lab.rubric.model_answers import load_with_answers
from grader.report.criteria import alike
from grader.report.writing import save

CONFIRMED = "!"  # ends what the page sends to replace marks that it was asked about
_READ = (names.RESULTS, CLASS_FILE, names.ROSTER, f"{names.RUBRIC}/**/*.toml", f"{names.MARKS}/*")
_SHEET_COLUMNS = ("criterion", "answer", "points", "maximum", "comment", "text", "students")
_PRIVATE = 0o600
_MAX_TEXT = 30_000  # characters; a cell of Excel has at most 32,767


class ReviewSession:
    """The items of a review, which keep their positions.

    `by` is the name that reports show, `answers` the file of the model answers. `own` are the
    newest marks that the review has given.
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
        self.folder = folder
        self.by = by
        self.answers = answers
        self.is_anonymous = is_anonymous
        self.own = dict[Key, Mark]()
        self._kept = set[Key]()  # marked since the filter was chosen: these stay in the list
        self.filter = shown
        self.places: Sequence[Place] = ()
        self._stamps: object = None
        self.refresh()
        self.show_only(shown)

    @cached_property
    def file(self) -> Path:
        """The file of the marks. Raises InputError if nothing names the grader."""
        return mark_file(self.folder / names.MARKS, self.by)

    def refresh(self) -> None:
        """Read the gradebook again if it has changed. Raises InputError."""
        statuses = ((path, path.stat()) for pattern in _READ for path in self.folder.glob(pattern))
        stamps = [
            (path, status.st_ino, status.st_size, status.st_mtime_ns) for path, status in statuses
        ]
        if stamps != self._stamps:
            self.book = Gradebook(self.folder)
            rubric = str(self.folder / self.book.settings.rubric)
            self.book.rubric = load_with_answers(rubric, self.answers)
            self.items = review_items(self.book, is_anonymous=self.is_anonymous)
            self.places = tuple(dict.fromkeys((*self.places, *self.items)))
            self._stamps = stamps
            self._arrange()

    def _arrange(self) -> None:
        """Find the items that are shown.

        Join those of the same students that are open for the same reason.
        """
        self.shown = {}
        for at, place in enumerate(self.places):
            item = self.items.get(place)
            members = self.filter.members(item, self._kept) if item else ()
            if item and members:
                self.shown[at] = item._replace(members=members)
        self._joined = {}
        self.listed = []
        for _, positions in alike(self.shown, lambda at: self.shown[at].reason):
            first, *others = positions
            also = tuple(self.shown[at] for at in others)
            joined = self.shown[first]._replace(also=also)
            self._joined.update(dict.fromkeys(positions, joined))
            self.listed.append(first)

    @property
    def sections(self) -> dict[str, str]:
        """The sections of the roster, by their names without differences of spelling."""
        students = self.book.roster.students if self.book.roster else ()
        return {plain(one.section): one.section for one in students if one.section}

    @property
    def left(self) -> int:
        """The number of results that need manual grading.

        Only those of the question and section that are shown count.
        """
        unmarked = ReviewFilter(*self.filter[:2])
        return sum(len(unmarked.members(item)) for item in self.items.values())

    def item_at(self, at: int) -> ReviewItem:
        """Return an item with the students that are shown, with others if none is.

        Raises InputError if it is gone.
        """
        if at in self._joined:
            return self._joined[at]
        item = self.items.get(self.places[at])
        if not item:
            raise InputError(
                "this answer has changed, or its students have final marks: go to the next item"
            )
        return item._replace(
            members=ReviewFilter("", self.filter.section, "").members(item) or item.members
        )

    def following(self, position: int = -1) -> int:
        """Return the position of the next item that is shown, beyond the last one at the end."""
        return next((at for at in self.listed if at > position), len(self.places))

    def previous(self, position: int) -> int:
        """Return the position of the previous item that is shown.

        It is the same position if there is none.
        """
        return max((at for at in self.listed if at < position), default=position)

    def next_question(self, position: int) -> int:
        """Return the position of the student's next item.

        After the last one, it is that of the next student's first.

        An item of several students is that of the first one.
        """
        if position >= len(self.places):
            return position
        here = self.item_at(position).members[0].order, position
        shown = ((self._joined[at].members[0], at) for at in self.listed)
        later = [(one.order, at) for one, at in shown if (one.order, at) > here]
        if later:
            return min(later)[1]
        return len(self.places)

    def people(self, position: int) -> list[tuple[str, int, int]]:
        """Return the students with items of the question and section that are shown.

        Their state does not matter.

        Each has a label, the number of unmarked criteria, and the position of an item: of the same
        question as that at a position, else the first unmarked one.
        """
        question = self.places[position][0] if position < len(self.places) else ""
        of_any_state = self.filter._replace(state="")
        items_of = defaultdict(list)
        for at, place in enumerate(self.places):
            if place in self.items:
                for student in of_any_state.members(self.items[place]):
                    items_of[student.order].append((at, student))
        people = []
        for _, items in sorted(items_of.items()):
            first, student = items[0]
            unmarked = [at for at, member in items if member.state == UNMARKED]
            same = [at for at, _ in items if self.places[at][0] == question]
            people.append((student.label, len(unmarked), next(iter(same + unmarked), first)))
        return people

    def so_far(self, item: ReviewItem) -> str:
        """Return the points of a student so far, and how many need manual grading.

        It is empty for several students.
        """
        grade = self.book.grade(item.members[0].student.key)
        if item.members[1:] or grade.total is None:
            return ""
        points = f"{format_points(grade.total)} of {counted_points(grade.report.max_score)} so far"
        if grade.pending:
            return f"{points}; {pending_words(grade.pending)}"
        return points

    @property
    def lms(self) -> str:
        """The LMS that the class came from, as its submissions or roster say.

        It is empty if they do not.
        """
        students = (self.book.student(one.student, one) for one in self.book.results.all())
        return next(
            (name for one in students for name in ("canvas", "moodle") if getattr(one, name)), ""
        )

    def show_only(self, wanted: ReviewFilter) -> None:
        """Show the items that a filter lets through. Raises InputError."""
        sections = self.sections
        if wanted.criterion:
            find_criterion(self.book.rubric, wanted.criterion)
        if wanted.section and plain(wanted.section) not in sections:
            known = enumerated(map(repr, sorted(sections.values())), MAX_NAMED) or "none"
            raise InputError(
                f"no student has the section {wanted.section!r} in the roster; it has {known}"
            )
        self.filter = wanted._replace(section=sections.get(plain(wanted.section), ""))
        self._kept.clear()
        self._arrange()

    def similar(self, at: int) -> list[SimilarItem]:
        """Return the unmarked items of the same question with similar answers.

        The most similar come first.
        """
        item = self.item_at(at)
        similar_items = []
        own_words = split_words(self._written(item))
        for position, other in self.shown.items():
            is_same = other.criterion.id == item.criterion.id and position != at
            is_alone = not (item.also or self._joined[position].also)
            if is_same and is_alone and other.members[0].state == UNMARKED:
                text = self._written(other)
                share = share_of_words(own_words, split_words(text))
                if share:
                    similar_items.append(SimilarItem(position, other, text, share))
        return sorted(similar_items, key=lambda one: -one.share)

    def _written(self, item: ReviewItem) -> str:
        """Return the written answer of an item; empty if it is not, or not only, words."""
        answers = self.book.results.written_answers(item.members[0].stored)
        return answers.get(item.criterion.id, "")

    def mark(
        self,
        at: int,
        points: str,
        comment: str,
        shown: str,
        similar: Sequence[tuple[int, str]] = (),
    ) -> list[Mark] | None:
        """Append a mark for each student of an item; `-` as points withdraws marks.

        The items of `similar`, positions with the views that the person saw, get the same mark.

        Of criteria that are shown together, `points` has a word for each.
        `shown` is the item's view that the person saw: without effect, returns None if it is
        another one. Returns the marks of others that would be replaced; nothing is saved then,
        unless `shown` ends with CONFIRMED. Raises InputError.
        """
        item = self.item_at(at)
        self._check_rows()
        items = self._similar_items(item, similar)
        if items is None or shown.removesuffix(CONFIRMED) != item.view:
            return None
        values = points.split() if item.also else [points.strip()]
        if len(values) != len(item.all) or not all(values):
            raise InputError("points are missing")
        new = dict[Key, Mark]()
        replaced = []
        for one, value in zip([*item.all, *items], values + values * len(similar), strict=True):
            new |= self._make_marks(one, value, comment)
            for member in one.members:
                if member.mark and member.mark.points is not None:
                    replaced.append(member.mark)
        others = [mark for mark in replaced if mark.by != self.by]
        if others and not shown.endswith(CONFIRMED):
            return others
        append_marks(self.file, new.values())
        self.own |= new
        self._kept |= new.keys()
        self.refresh()
        write_grades_with(len(new), self.book)
        return []

    def _similar_items(
        self, item: ReviewItem, similar: Sequence[tuple[int, str]]
    ) -> list[ReviewItem] | None:
        """Return the items at these positions; None if one is not as the person saw it.

        They are of the same criterion as the item, which is alone.
        """
        items = []
        for position, view in similar:
            items.append(self.item_at(position))
            is_other = items[-1].criterion.id != item.criterion.id or bool(item.also)
            if is_other or items[-1].view != view:
                return None
        return items

    def _make_marks(self, item: ReviewItem, points: str, comment: str) -> dict[Key, Mark]:
        """Return the new mark of each student of an item. Raises InputError."""
        cells = {"time": "", "by": self.by, "points": points, "comment": comment, "": ""}
        marks = {}
        for one in item.members:
            key = one.student.key, item.criterion.id
            mark = mark_in(
                {**cells, "submission": one.stored.digest}, key, item.criterion.points, ""
            )
            marks[key] = mark._replace(time=self.book.marks.next_time(key))
        return marks

    def _check_rows(self) -> None:
        """Raise InputError, once, if rows that this review wrote are no longer in the file."""
        newest = self.book.marks.newest
        lost = [
            key
            for key, mark in self.own.items()
            if key not in newest or "" < newest[key].time < mark.time
        ]
        lost_marks = [self.own.pop(key) for key in lost]
        if lost_marks:
            rows = [f"{one.criterion} {one.value}" for one in lost_marks]
            if not self.is_anonymous:
                rows = [
                    f"{row} of {one.student}" for row, one in zip(rows, lost_marks, strict=True)
                ]
            shown = printable_path(Path(names.MARKS, self.file.name))
            why = (
                f"rows of this review are no longer in {shown}, which another program has replaced"
            )
            raise InputError(
                f"Not saved: {why}: {enumerated(rows, MAX_NAMED)}. Save again to go on "
                "without them."
            )


def write_sheet(session: ReviewSession, file: Path) -> str:
    """Write the items that are shown into a new file, and return what to do with it.

    Raises InputError.
    """
    if os.path.lexists(file):
        raise InputError(
            f"{printable_path(file)} exists, perhaps with marks in it: name another file "
            "for --sheet"
        )
    undecided = _list_undecided(session)
    items = []
    for item in session.shown.values():
        members = [one for one in item.members if one.student.key not in undecided]
        if members:
            items.append(item._replace(members=members))
    by_student = sorted(
        items, key=lambda item: item.members[0].student.key
    )  # a submission is read once
    texts = {item.place: _sheet_text(session.book, item) for item in by_student}
    rows = []
    for item in items:
        most = format_points(item.criterion.maximum)
        rows.append((*item.place, "", most, "", texts[item.place], _students(item)))
    most = format_points(maxima(session.book.rubric)[GRADE])
    for key, files in undecided.items():
        rows.append((GRADE, "", "", most, "", f"no robot and no package, but {files}", key))
    save(
        file,
        write_table(_SHEET_COLUMNS, rows),
        session.book.roots,
        _PRIVATE,
    )
    command = (
        f"grader mark --import {shell_quoted(file)} --gradebook {shell_quoted(session.folder)}"
    )
    unmarked = ReviewFilter(*session.filter[:2])
    left = sum(len(unmarked.members(item)) for item in items) + len(undecided)
    return (
        f"{counted(len(rows), 'item')} written for {counted(left, 'mark')}; fill in the points, "
        f"then: {command}\n"
    )


def _list_undecided(session: ReviewSession) -> dict[str, str]:
    """Return the files of students without a robot, a package and answers, who need a grade."""
    if session.is_anonymous or session.filter != ReviewFilter():
        return {}
    undecided = {}
    for grade in session.book:
        stored = grade.stored
        if not stored or not grade.is_without_robot or len({*stored.answers.values()}) != 1:
            continue
        if not session.book.results.written_answers(stored):
            undecided[grade.student.key] = stored.no_robot
    return undecided


def _students(item: ReviewItem) -> str:
    return "; ".join(one.label if one.number else one.student.key for one in item.members)


def _sheet_text(book: Gradebook, item: ReviewItem) -> str:
    """Return the answer, else what was found, and the files, which may show more."""
    try:
        opened = open_item(book, item)
    except InputError as error:
        return f"Not shown: {error}"
    lines = list(filter(str.strip, opened.answer)) or [opened.message or NO_ANSWER]
    return cut("\n".join(map(printable, [*lines, *opened.paths])), _MAX_TEXT)
