"""Grade a class: what is new or changed is handed out, what comes back goes into the gradebook at once."""

import json
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import NamedTuple

from grader import __version__
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import GradingResult
from grader.classroom.gradebook.stored import Enrolment, StoredSubmission
from grader.classroom.intake.intake import Intake
from grader.classroom.intake.layouts.attempts import home_of
from grader.classroom.intake.layouts.layout import place_key
from grader.classroom.intake.opening import fingerprint
from grader.classroom.intake.roster import Roster, RosterEntry, entry_to_json
from grader.classroom.run.identity import Identities
from grader.classroom.run.queue import Queue
from grader.classroom.run.same_class import assignments_text, check_belongs
from grader.classroom.run.worker import ClassContext, Task
from grader.classroom.students import ClassSubmission, Student
from grader.errors import InputError
from grader.files.reading import URDF_LIMIT
from grader.grading.grade import grade_reference
from grader.grading.record import to_record
from grader.grading.rubric import Rubric


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a run has come. `errored` and `unreadable` are those of the hand-ins that were graded now."""

    total: int
    graded: int = 0
    unchanged: int = 0
    unreadable: int = 0
    errored: int = 0

    @property
    def done(self) -> int:
        """The hand-ins that have a result."""
        return self.graded + self.unchanged

    def with_result(self, verdict: str) -> "Progress":
        """One hand-in further."""
        if verdict == "unchanged":
            return replace(self, unchanged=self.unchanged + 1)
        return replace(
            self,
            graded=self.graded + 1,
            unreadable=self.unreadable + (verdict == "unreadable"),
            errored=self.errored + (verdict == "errored"),
        )


class RunSettings(NamedTuple):
    """How a run is done.

    `root` is the absolute path of the class, `max_size` the limit for a URDF in bytes; `add` has the class added to whatever the
    gradebook holds.
    """

    root: str
    layout: str
    total: int
    workers: int
    force: bool = False
    roster: Roster | None = None
    due: str = ""
    add: bool = False
    max_size: int = URDF_LIMIT


class Batch:
    """One run over a class."""

    def __init__(
        self,
        book: Gradebook,
        rubric: Rubric,
        settings: RunSettings,
        executor: Executor,
        listener: Callable[[Progress], None] = lambda _: None,
    ) -> None:
        self._book, self._rubric, self._settings, self._listener = book, rubric, settings, listener
        self._sha256 = rubric.sha256
        self._queue = Queue(executor, settings.workers, self._common, rubric)
        self._waiting: dict[str, tuple[ClassSubmission, StoredSubmission | None]] = {}
        self._identities: Identities | None = None
        self._passed: list[StoredSubmission] = []  # of this class folder, and not met yet
        self._renamed: set[int] = set()
        self.notes: list[str] = []
        self._before: Iterator[StoredSubmission] = iter(())
        self._next: StoredSubmission | None = None
        self._has_others = False
        self._progress = Progress(settings.total)
        self._run = 0

    def _common(self) -> ClassContext:
        """What all tasks share: made when there is something to grade, for grading the reference takes longer than looking."""
        template = _template(self._rubric)
        self._book.keep_beside(template)
        return ClassContext(
            self._settings.root, self._rubric.data, str(self._rubric.path), template, self._settings.max_size
        )

    @property
    def has_begun(self) -> bool:
        """Whether the gradebook has taken the run in."""
        return self._run > 0

    @property
    def progress(self) -> Progress:
        """How far it has come."""
        return self._progress

    def grade(self, intake: Intake) -> Progress:
        """Grade all submissions that are new or changed. Raises InputError for a class that belongs into another gradebook."""
        settings = self._settings
        self._identities = Identities(self._book, settings.root, settings.roster, intake.keys)
        if not settings.add:
            check_belongs(self._book, intake, self._identities, self._rubric.id)
        assignment = assignments_text(intake.assignments)
        self._run = self._book.begin(settings.root, settings.layout, self._rubric, settings.due, assignment)
        self._before = self._book.all_known()
        self._next = next(self._before, None)
        self._has_others = self._next is not None
        contested = {student.key for student in intake.contested}
        for hand_in in intake.submissions():
            before = self._known(hand_in)
            if before is not None and self._is_doubtful(hand_in, before):
                self.notes.append(f"{hand_in.paths[0]} may be of {before.key}, who had another before: left unassigned")
                contested.add(before.key)
                self._tell(("unchanged",))
                continue
            known = self._still_valid(before)
            if known is not None and self._is_unchanged(hand_in, known):
                self._tell(("unchanged",))
            else:
                self._hand_out(hand_in, known)
            while self._queue.is_full:
                self._take(all_in=False)
        while len(self._queue):
            self._take(all_in=True)
        self._pass_to(None)
        with self._book.transaction():
            for known in self._passed:
                if known.student not in self._renamed and known.key not in contested:
                    self._book.see_gone(known, self._run)
                if settings.roster is not None and settings.roster.entry(known.key) is None and known.is_expected:
                    self._book.leave_roster(known.student)
            for student in (*intake.absent, *(intake.contested if settings.roster is not None else ())):
                self._book.keep_student(student, self._enrolment(student))
        self._book.finish(self._run)
        return self._progress

    def _pass_to(self, key: str | None) -> None:
        """Go on in the gradebook to a key, or to its end; who is passed over is not in the class folder any more."""
        while self._next is not None and (key is None or self._next.key < key):  # both come in the order of the keys
            if self._next.source == self._settings.root and not self._next.is_gone:
                self._passed.append(self._next)
            self._next = next(self._before, None)

    def _same_person(self, hand_in: ClassSubmission) -> StoredSubmission | None:
        """Who has this hand-in under another key, and gets this one now."""
        known = self._identities.of(hand_in) if self._identities is not None else None
        key = hand_in.student.key
        if known is None or known.student in self._renamed or known.key == key:
            return None
        if not self._book.rename(known.student, key):
            self.notes.append(
                f"{known.key} and {key} seem to be the same, but both have results: their marks stay apart"
            )
            return None
        self._renamed.add(known.student)
        self.notes.append(f"{known.key} is {key} now, with all manual marks")
        return known

    def _known(self, hand_in: ClassSubmission) -> StoredSubmission | None:
        """What the gradebook has of this student."""
        key = hand_in.student.key
        self._pass_to(key)
        known = self._next if self._next is not None and self._next.key == key else None
        if known is not None:
            self._next = next(self._before, None)
        if (known is None and self._has_others) or (known is not None and self._gives_way(known, hand_in)):
            known = self._same_person(hand_in)
        return known

    def _gives_way(self, known: StoredSubmission, hand_in: ClassSubmission) -> bool:
        """Whether a key was only that of a folder until the roster gave it to somebody else, who is known as well.

        The folder's results and marks then get the key of its place.
        """
        root, roster = self._settings.root, self._settings.roster
        if roster is None or known.is_expected or known.source != root or self._identities is None:
            return False
        path = json.loads(known.place)[0][0]
        if home_of(path) == home_of(hand_in.paths[0]) or self._identities.of(hand_in) is None:
            return False
        self._passed.append(known)
        return self._book.rename(known.student, place_key(path))

    def _is_doubtful(self, hand_in: ClassSubmission, known: StoredSubmission) -> bool:
        """Whether a submission only may be of a student who had another one in this class before."""
        if hand_in.is_certain or known.source != self._settings.root:
            return False
        return home_of(json.loads(known.place)[0][0]) != home_of(hand_in.paths[0])

    def _still_valid(self, known: StoredSubmission | None) -> StoredSubmission | None:
        """A result that may still hold: of the same rubric and grader, and not errored."""
        if known is None or (known.rubric, known.version) != (self._sha256, __version__):
            return None
        return None if known.verdict == "errored" or self._settings.force else known

    def _is_unchanged(self, hand_in: ClassSubmission, known: StoredSubmission) -> bool:
        """Whether the file system and the roster say what they said before."""
        return (
            known.fingerprint != ""
            and known.is_same(hand_in, self._enrolment(hand_in.student))
            and fingerprint(self._settings.root, hand_in.paths, time.time_ns(), self._settings.max_size)
            == known.fingerprint
        )

    def _hand_out(self, hand_in: ClassSubmission, known: StoredSubmission | None) -> None:
        self._waiting[hand_in.student.key] = (hand_in, known)
        digest = known.digest if known is not None else ""
        self._queue.put(Task(hand_in.student.key, hand_in.paths, hand_in.names, digest))

    def _take(self, *, all_in: bool) -> None:
        for results in self._queue.take(all_in=all_in):
            with self._book.transaction():
                for graded in results:
                    self._keep(graded)
            for graded in results:
                del self._waiting[graded.key]
            self._tell(each.verdict for each in results)

    def _keep(self, graded: GradingResult) -> None:
        hand_in, known = self._waiting[graded.key]
        student = self._keep_student(hand_in)
        if graded.verdict == "unchanged" and known is not None:
            result = known.result
        else:
            result = self._book.keep(student, self._sha256, graded)
        self._book.see(student, self._run, result, hand_in, graded.fingerprint)

    def _keep_student(self, hand_in: ClassSubmission) -> int:
        return self._book.keep_student(hand_in.student, self._enrolment(hand_in.student))

    def _enrolment(self, student: Student) -> Enrolment | None:
        if self._settings.roster is None:
            return None
        entry = self._settings.roster.entry(student.key)
        return _enrolment_of(entry)

    def _tell(self, verdicts: Iterable[str]) -> None:
        for verdict in verdicts:
            self._progress = self._progress.with_result(verdict)
        self._listener(self._progress)


def _template(rubric: Rubric) -> str:
    """The record of the rubric's reference solution, which most records resemble; empty where there is none to be read."""
    try:
        return to_record(grade_reference(rubric)) if rubric.reference else ""
    except InputError:
        return ""


def _enrolment_of(entry: RosterEntry | None) -> Enrolment:
    """What the roster says of one; not late is not late, whatever a time says."""
    if entry is None:
        return Enrolment(0)
    days_late = 0.0 if entry.is_late is False and entry.days_late is None else entry.days_late
    return Enrolment(1, entry.due, entry.extension_days, days_late, entry_to_json(entry))
