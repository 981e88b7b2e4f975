"""A review: one person goes through the items of a class. Each mark is saved immediately."""

from collections.abc import Iterable
from pathlib import Path

from grader.classroom import folder as names
from grader.classroom.grades import Class
from grader.classroom.mark_files import is_open_in_libreoffice, mark_file
from grader.classroom.marks import Key, Mark, append_marks, mark_in, read_marks
from grader.classroom.review_items import Member, ReviewFilter, ReviewItem, review_items
from grader.classroom.roster import plain
from grader.classroom.settings import CLASS_FILE
from grader.classroom.typed_names import criterion_of
from grader.errors import InputError
from grader.grading.answers import load_with_answers
from grader.text import enumerated, printable_path

CONFIRMED = "!"  # ends what the page sends to replace marks that it was asked about
_MAX_NAMED = 5
_GONE = "this answer has changed, or its students have final marks: go to the next item"


class ReviewSession:
    """The items of a review, which keep their positions, and the place among them.

    `by` is the name that reports show, `answers` the file of the model answers. `own` are the newest marks that the
    review has given, `models` the criteria with their model answers.
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
        self.folder, self.by, self.is_anonymous = folder, by, is_anonymous
        self.file = mark_file(folder / names.MARKS, by)
        self.own, self.position = dict[Key, Mark](), 0
        self._kept = set[Key]()  # marked since the filter was chosen: these stay in the list
        self.places: tuple[tuple[str, str], ...] = ()  # a criterion and an answer
        self._read: tuple[object, object] = None, None  # the stamps of the files
        self.refresh()
        rubric = load_with_answers(str(folder / self.book.settings.rubric), answers)
        self.models = {row.id: row for row in rubric.criteria}
        self._lacks_answers = bool(rubric.answers) and answers is None
        students = self.book.roster.students if self.book.roster is not None else ()
        self.sections = {plain(one.section): one.section for one in students if one.section}
        self.show_only(shown)

    def refresh(self) -> None:
        """Read the gradebook again if it has changed. Raises InputError."""
        inputs, marks = (names.RESULTS, CLASS_FILE, names.ROSTER, f"{names.RUBRIC}/**/*.toml"), (f"{names.MARKS}/*",)
        read = _stamps(self.folder, inputs), _stamps(self.folder, marks)
        if read == self._read:
            return
        if read[0] != self._read[0]:
            self.book = Class(self.folder)
            self._results = [one._replace(work={}) for one in self.book.results.all()]
        else:
            self.book.marks = read_marks(self.folder / names.MARKS, self.book.keys, self.book.rubric)
        items = review_items(self.book, self._results, is_anonymous=self.is_anonymous)
        self.items = {(item.criterion.id, item.answer): item for item in items}
        self.places = tuple(dict.fromkeys((*self.places, *self.items)))
        self._read = read

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
        item = self.items.get(self.places[at]) if at < len(self.places) else None
        if item is None:
            raise InputError(_GONE)
        of_section = self.filter._replace(state="", criterion="").members(item)
        return item._replace(members=self.filter.members(item, self._kept) or of_section or item.members)

    def following(self, position: int) -> int:
        """Return the position of the next item that is shown, beyond the last one at the end."""
        return next((at for at in self.listed if at > position), len(self.places))

    def previous(self, position: int) -> int:
        """Return the position of the previous item that is shown, the same position if there is none."""
        return max((at for at in self.listed if at < position), default=position)

    def show_only(self, wanted: ReviewFilter) -> None:
        """Show the items that a filter lets through, from the first one. Raises InputError."""
        if wanted.criterion:
            criterion_of(self.book.rubric, wanted.criterion)
        if wanted.section and plain(wanted.section) not in self.sections:
            known = enumerated([*map(repr, sorted(self.sections.values()))], _MAX_NAMED)
            raise InputError(f"no student has the section {wanted.section!r} in the roster; it has {known or 'none'}")
        self.filter = wanted._replace(section=self.sections.get(plain(wanted.section), ""))
        self._kept.clear()
        self.position = self.following(-1)

    def mark(self, points: str, comment: str, shown: str) -> list[Mark] | None:
        """Append a mark for each student of the current item; `-` as points withdraws marks.

        `shown` is the item's view that the person saw: without effect, returns None if it is another one. Returns the
        marks of others that would be replaced; nothing is saved then, unless `shown` ends with CONFIRMED. Raises
        InputError.
        """
        item = self.item_at(self.position)
        self._check_rows()
        if shown.removesuffix(CONFIRMED) != item.view:
            return None
        new = [self._new_mark(one, item, points, comment) for one in item.members]
        replaced = [one.mark for one in item.members if one.mark is not None and one.mark.points is not None]
        others = [mark for mark in replaced if mark.by != self.by]
        if others and not shown.endswith(CONFIRMED):
            return others
        append_marks(self.file, new)
        given = {(mark.student, mark.criterion): mark for mark in new}
        self.own |= given
        self._kept |= given.keys()
        self.refresh()
        return []

    def _new_mark(self, one: Member, item: ReviewItem, points: str, comment: str) -> Mark:
        if not points.strip():
            raise InputError("points are missing")
        key, digest = (one.student.key, item.criterion.id), one.graded.digest
        cells = {"time": "", "by": self.by, "points": points.strip(), "comment": comment, "submission": digest}
        mark = mark_in({**cells, "": ""}, key, item.criterion.points, "")
        return mark._replace(time=self.book.marks.next_time(key))

    def _check_rows(self) -> None:
        """Raise InputError, once, if rows that this review wrote are no longer in the file."""
        newest = self.book.marks.newest
        lost = [key for key, mark in self.own.items() if key not in newest or "" < newest[key].time < mark.time]
        found = [self.own.pop(key) for key in lost]
        if found:
            rows = [f"{one.criterion} {one.value}" + f" of {one.student}" * (not self.is_anonymous) for one in found]
            shown = printable_path(Path(names.MARKS, self.file.name))
            why = f"rows of this review are no longer in {shown}, which another program has replaced"
            raise InputError(f"Not saved: {why}: {enumerated(rows, _MAX_NAMED)}. Save again to go on without them.")

    @property
    def warnings(self) -> list[str]:
        """What to say at the start: no model answers are shown; LibreOffice has the file of marks open."""
        shown = printable_path(self.file)
        loss = f"{shown} is open in LibreOffice: close it, because saving it there would remove new marks"
        answers = "no model answers are shown: name their file with --answers"
        return [answers] * self._lacks_answers + [loss] * is_open_in_libreoffice(self.file)


def _stamps(folder: Path, patterns: Iterable[str]) -> list[tuple[Path, int, int, int]]:
    found = ((path, path.stat()) for pattern in patterns for path in folder.glob(pattern))
    return [(path, status.st_ino, status.st_size, status.st_mtime_ns) for path, status in found]
