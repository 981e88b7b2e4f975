"""What a person decides: the items of a class, each a criterion of the students whose answer is the same."""

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from grader.classroom.graded import Graded, digest_of
from grader.classroom.grades import Class
from grader.classroom.marks import Key, Mark
from grader.classroom.roster import Student, plain
from grader.grading.criterion import TOTAL, Criterion

UNMARKED, OLDER = "unmarked", "older"
STATES = {UNMARKED: "unmarked", "marked": "marked", OLDER: "marked before the submission changed", "": "all"}


class Member(NamedTuple):
    """A student of an item, what was graded, the mark or comment that counts, and a number if anonymous."""

    student: Student
    graded: Graded
    mark: Mark | None = None
    number: int | None = None

    @property
    def state(self) -> str:
        """One of STATES."""
        if self.mark is None or self.mark.points is None:
            return UNMARKED
        return "marked" if self.mark.submission in ("", self.graded.digest) else OLDER

    @property
    def order(self) -> tuple[int, str]:
        """What students are sorted by: it says nothing about the name of an anonymous one."""
        return self.number or 0, self.student.key


class ReviewItem(NamedTuple):
    """A criterion of the students whose answers are equal: one mark serves all.

    `answer` is the key of the answer, empty without one.
    """

    criterion: Criterion
    answer: str
    members: tuple[Member, ...]

    @property
    def first(self) -> Member:
        """The student whose submission is shown."""
        return self.members[0]

    @property
    def is_empty_group(self) -> bool:
        """Whether it has several students without an answer."""
        return len(self.members) > 1 and not self.answer

    @property
    def view(self) -> str:
        """A text that tells whether the item is as a page shows it, without the names of its students."""
        shown = ((one.student.key, one.graded.digest, one.mark and one.mark._replace(place="")) for one in self.members)
        return digest_of(self.criterion.id, [*shown])


class ReviewFilter(NamedTuple):
    """Which items a review shows: of a criterion, of a section, and of a state, one of STATES."""

    criterion: str = ""
    section: str = ""
    state: str = UNMARKED

    def members(self, item: ReviewItem, kept: Collection[Key] = ()) -> tuple[Member, ...]:
        """Return the students of an item that are shown; those in `kept` whatever their state is."""
        return tuple(
            one
            for one in (item.members if self.criterion in ("", item.criterion.id) else ())
            if (self.state in ("", one.state) or (one.student.key, item.criterion.id) in kept)
            and (not self.section or plain(self.section) == plain(one.student.section))
        )


def review_items(book: Class, results: Iterable[Graded], *, is_anonymous: bool = False) -> list[ReviewItem]:
    """Return what needs manual grading, and what else has a mark: in the rubric's order, each criterion by student.

    Those without an answer are the last item of a criterion. Unreadable submissions are omitted: they need a fix, not
    points. So are students with a final mark or an excuse, and criteria that the rubric adjusts.
    """
    groups: defaultdict[tuple[str, str], list[Member]] = defaultdict(list)
    numbers = {key: number for number, key in enumerate(sorted(book.keys, key=digest_of), 1)}  # by no name
    counting, marked = book.marks.counting, defaultdict[str, list[str]](list)
    for key, criterion in counting:
        marked[key].append(criterion)
    for one, answers in _answers(book, results):
        overridden = {name: one.digest for name in marked[one.student] if name in one.results}
        for name, answer in {**overridden, **answers}.items() if TOTAL not in marked[one.student] else ():
            mark = counting.get((one.student, name)) or book.marks.comments.get((one.student, name))
            student, number = book.student(one.student, one), numbers[one.student] if is_anonymous else None
            groups[name, answer].append(Member(student, one, mark, number))
    rows = {row.id: row for row in book.rubric.criteria if row.adjustment is None}
    items = [
        ReviewItem(rows[name], answer, tuple(sorted(members, key=lambda one: one.order)))
        for (name, answer), members in groups.items()
        if name in rows
    ]
    return sorted(items, key=lambda item: (item.criterion.position, not item.answer, item.first.order))


def _answers(book: Class, results: Iterable[Graded]) -> Iterator[tuple[Graded, Mapping[str, str]]]:
    """Yield what can be marked, and the key of each answer; several students of one submission have the same keys."""
    of_files: dict[tuple[int, tuple[str, ...]], Mapping[str, str]] = {}
    for one in results:
        if one.verdict != "unreadable" and one.student in book.run.totals:
            yield one, of_files.setdefault((one.root, one.paths), one.answers)


def answers_of(book: Class) -> Mapping[tuple[str, str], Sequence[str]]:
    """Return the students with each answer, by criterion and the key of the answer."""
    found: defaultdict[tuple[str, str], list[str]] = defaultdict(list)
    for one, answers in _answers(book, book.results.all()):
        for criterion, key in answers.items():
            found[criterion, key].append(one.student)
    return found
