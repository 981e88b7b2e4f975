"""What a person decides: the items of a class.

Each is a criterion of the students whose answer is the same.
"""

from collections import defaultdict
from collections.abc import Collection, Sequence
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.marks.marks import Key, Mark
from grader.classroom.results.results import StoredResult, hash_values
from grader.classroom.roster.roster import Student, plain
from grader.lab.rubric.criterion import GRADE, Criterion

UNMARKED = "unmarked"
OLDER = "older"
STATES = {
    UNMARKED: "unmarked",
    "marked": "marked",
    OLDER: "marked before the submission changed",
    "": "all",
}
Place = tuple[str, str]  # a criterion and the key of an answer


class _ReviewStudent(NamedTuple):
    """A student of an item."""

    student: Student
    stored: StoredResult
    mark: Mark | None = None  # the mark or comment that counts
    number: int = 0  # of an anonymous student

    @property
    def label(self) -> str:
        """The name and key of the student, or the number of an anonymous one."""
        if self.number:
            return f"submission {self.number}"
        return self.student.label

    @property
    def order(self) -> tuple[int, str, str]:
        """What students are sorted by.

        This is the number of an anonymous one, else the name and the key.
        """
        return self.number, "" if self.number else self.label.casefold(), self.student.key

    @property
    def state(self) -> str:
        """One of STATES."""
        if not self.mark or self.mark.points is None:
            return UNMARKED
        if self.mark.submission in ("", self.stored.digest):
            return "marked"
        return OLDER


class ReviewItem(NamedTuple):
    """A criterion of the students whose answers are equal: one mark serves all.

    The first student's is shown.

    `answer` is the key of the answer, empty without one. `also` are other criteria of these
    students that are open for the same reason: a page shows them together.
    """

    criterion: Criterion
    answer: str
    members: Sequence[_ReviewStudent]
    also: "tuple[ReviewItem, ...]" = ()

    @property
    def place(self) -> Place:
        """What the item is listed by."""
        return self.criterion.id, self.answer

    @property
    def view(self) -> str:
        """A text that tells whether the item is as a page shows it.

        It does not depend on the names of its students.
        """
        shown = []
        for member in self.members:
            mark = member.mark and member.mark._replace(place="")
            shown.append((member.student.key, member.stored.digest, mark))
        return hash_values(self.criterion.id, shown, *(other.view for other in self.also))

    @property
    def all(self) -> "tuple[ReviewItem, ...]":
        """The item, and those that are shown with it."""
        return self, *self.also

    @property
    def reason(self) -> Sequence[object]:
        """What items have in common that are shown together.

        This is why no check could decide them, and the students.
        """
        _, status, why, *_ = self.members[0].stored.results.get(
            self.criterion.id, (None, "pending", "", "")
        )
        alone = "" if why and self.answer and status == "pending" else self.criterion.id
        return alone, why, self.answer, *(one.student.key for one in self.members)


class ReviewFilter(NamedTuple):
    """Which items a review shows: of a criterion, of a section, and of a state, one of STATES."""

    criterion: str = ""
    section: str = ""
    state: str = UNMARKED

    def members(self, item: ReviewItem, kept: Collection[Key] = ()) -> Sequence[_ReviewStudent]:
        """Return the students of an item that are shown.

        Those in `kept` are shown whatever their state is.
        """
        if self.criterion not in ("", item.criterion.id):
            return ()
        members = []
        for member in item.members:
            is_kept = (member.student.key, item.criterion.id) in kept
            has_state = self.state in ("", member.state)
            has_section = not self.section or plain(self.section) == plain(member.student.section)
            if has_section and (has_state or is_kept):
                members.append(member)
        return tuple(members)


def review_items(
    book: Gradebook, *, is_anonymous: bool = False, with_final: bool = False
) -> dict[Place, ReviewItem]:
    """Return what needs manual grading, and what else has a mark.

    The items are in the rubric's order, each criterion by student.

    Those without an answer are the last item of a criterion. Unreadable submissions are omitted:
    they need a fix, not points. So are criteria that the rubric adjusts, and students with a final
    mark or an excuse, unless `with_final`. Students of one submission have the same answers.
    Numbers and order of anonymous students reveal no names.
    """
    keys = sorted(book.keys, key=hash_values) if is_anonymous else book.keys
    numbers = {key: number for number, key in enumerate(keys, 1)}
    counting = book.marks.counting
    comments = book.marks.comments
    results = _readable_results(book)
    # Several files are a submission named after the student, so digests of members differ, and with
    # them the keys. Those of one member serve all, whatever the order of the items.
    answers_of_files = {(stored.root, stored.paths): stored.answers for stored in results}
    rows = {row.id: row for row in book.rubric.criteria if not row.adjustment}
    groups = defaultdict(list)
    for stored in sorted(results, key=lambda stored: numbers[stored.student]):
        if (stored.student, GRADE) in counting and not with_final:
            continue
        answers = answers_of_files[stored.root, stored.paths]
        student = book.student(stored.student, stored)
        number = numbers[stored.student] if is_anonymous else 0
        for name in stored.results:
            mark = counting.get((stored.student, name))
            if name in rows and (name in answers or mark):
                counting_mark = mark or comments.get((stored.student, name))
                member = _ReviewStudent(student, stored, counting_mark, number)
                place = name, answers.get(name, stored.digest)
                groups[place].append(member)
    items = [
        ReviewItem(rows[name], answer, tuple(members)) for (name, answer), members in groups.items()
    ]
    items.sort(key=lambda item: (item.criterion.position, not item.answer))
    return {item.place: item for item in items}


def _readable_results(book: Gradebook) -> list[StoredResult]:
    """Return the results of the newest run, without submissions that could not be read."""
    return [
        stored
        for stored in book.results.all()
        if stored.verdict != "unreadable" and stored.student in book.run.totals
    ]
