"""A class of 120 with awkward names, groups, lateness, resubmissions, excuses and manual marks, in a gradebook, and its true grades."""

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import Entry, add_mark
from grader.classroom.gradebook.run_writer import RunWriter, save_student
from grader.classroom.gradebook.stored import Enrolment
from grader.classroom.students import ClassSubmission, Student
from tests.classroom.gradebooks import graded_as, lab

SIZE = 120
POLICY = "due = 2026-09-10T12:00:00Z\npercent_per_day = 10\nfloor_percent = 40"
RUBRIC = lab(POLICY)
MAXIMUM = Decimal(11)
NAMES = (
    "Zoë Ash",
    'Bo "Birch" O\'Neil',
    "Cedar, Jr.",
    "עץ ארז",
    "=1+1",
    "+Cedar",
    "@Ash",
    "Bjørk Løvtræ",
    "李 梣",
    "Ash;=2",
    "Birch & <Cedar>",
    "_Ash_77_",
)
_EARNED = {"pppp": "10", "pfsp": "7", "fsss": "0", "ppp?": "6"}  # without the picture, which is always marked


@dataclass(frozen=True)
class Enrolled:
    """One student. What happened to whom follows from the number alone."""

    number: int

    @property
    def key(self) -> str:
        """The key, which is the login as well."""
        return f"s{self.number:03}"

    @property
    def student(self) -> Student:
        """The student in the gradebook; every name occurs ten times."""
        number, name = self.number, NAMES[self.number % len(NAMES)]
        return Student(
            self.key, name, f"{self.key}@uni.example", self.key, f"M{number:04}", self.canvas, str(5000 + number)
        )

    @property
    def canvas(self) -> str:
        """The id in Canvas."""
        return str(1000 + self.number)

    @property
    def is_missing(self) -> bool:
        """Whether nothing was submitted."""
        return self.number % 13 == 5

    @property
    def partner(self) -> int:
        """The number of the student who submitted for the group, or the own number: 20 students are in pairs."""
        return self.number - 1 if 40 <= self.number < 60 and self.number % 2 else self.number

    @property
    def signs(self) -> str:
        """The results of the first four criteria: those of the group."""
        return (*_EARNED,)[self.partner % 4 if self.partner % 11 else 3]

    @property
    def essay(self) -> str:
        """The points of the essay that a person gives; empty for a student who waits for them."""
        return "2.5" if self.signs.endswith("?") and self.partner % 3 else ""

    @property
    def days_late(self) -> int:
        """The days late, of the group."""
        return self.partner % 5 if self.partner % 7 == 0 else 0

    @property
    def is_excused(self) -> bool:
        """Whether the student is excused, with a submission or without."""
        return self.number % 17 == 3

    @property
    def final(self) -> Decimal | None:
        """A final mark: a zero for most missing students, and another one for some."""
        if self.is_excused:
            return None
        if self.is_missing:
            return Decimal(0) if self.number % 2 else None
        return Decimal("8.125") if self.number % 29 == 8 else None

    @property
    def total(self) -> Decimal | None:
        """The grade that must be in the LMS; None for a student who has none yet, or an excuse."""
        if self.is_excused or self.final is not None:
            return self.final
        if self.is_missing or (self.signs.endswith("?") and not self.essay):
            return None
        return max(min(self.score, Decimal("4.4")), self.score - self.days_late * Decimal("1.1"))

    @property
    def score(self) -> Decimal:
        """The points before the late penalty; half a point is for the picture."""
        return Decimal(_EARNED[self.signs]) + Decimal(self.essay or 0) + Decimal("0.5")

    @property
    def cell(self) -> str:
        """The same with the two decimals of an LMS, cut off."""
        return "" if self.total is None else str(self.total.quantize(Decimal("0.01"), "ROUND_FLOOR"))

    @property
    def remark(self) -> str:
        """The comment by which the report is recognised: that of the picture, or of the final mark without a submission."""
        return f"agreed for {self.key}" if self.is_missing else f"blurred for {Enrolled(self.partner).key}"

    @property
    def path(self) -> str:
        """The newest file as in Canvas' download; those of a group carry one member's id."""
        leader = Enrolled(self.partner)
        late, again = "LATE_" if self.days_late else "", "-1" if leader.number % 6 == 0 else ""
        return f"ash_{late}{leader.canvas}_{90_000 + leader.number}_lab{again}.zip"


CLASS = tuple(map(Enrolled, range(SIZE)))


def write_gradebook(path: Path, students: Sequence[Enrolled] = CLASS) -> None:
    """Write a gradebook of the class, as a batch and persons would have."""
    with Gradebook(path, create=True) as book:
        writer = RunWriter(book, str(path.parent / "class"), "canvas", RUBRIC)
        with book.transaction():
            for one in students:
                enrolment = Enrolment(1, days_late=float(one.days_late), section="AB"[one.number % 2], marker="Kim")
                identity = save_student(book, one.student, enrolment)
                if not one.is_missing:
                    result = writer.add_result(identity, graded_as(RUBRIC, one.key, f"{one.signs}?"))
                    earlier = ("earlier.zip",) if one.partner % 6 == 0 else ()
                    late = bool(one.days_late)
                    submission = ClassSubmission(one.student, (one.path,), late, "", 1 + len(earlier), earlier)
                    writer.add_submission(identity, result, submission, "")
        writer.finish()
        grades = Grades(book)
        for one in students:
            _mark(book, grades, one)


def _mark(book: Gradebook, grades: Grades, one: Enrolled) -> None:
    grade = grades.find(one.key)
    if not one.is_missing:
        add_mark(book, grade, "picture", Entry("points", Decimal("0.5"), one.remark), "Kim")
        if one.essay:
            add_mark(book, grade, "essay", Entry("points", Decimal(one.essay), "=too short"), "Lee")
    if one.final is not None:
        add_mark(book, grade, "total", Entry("points", one.final, one.remark if one.is_missing else "agreed"), "Kim")
    elif one.is_excused:
        add_mark(book, grade, "total", Entry("excused", None, "ill"), "Kim")
