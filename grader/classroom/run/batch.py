"""Grade a class: send new and changed submissions to the workers, write each result into the gradebook at once."""

import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from functools import partial
from itertools import chain
from typing import NamedTuple

from grader import __version__
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import GradingResult, parts_text, storable
from grader.classroom.gradebook.run_writer import RunWriter, save_student
from grader.classroom.gradebook.stored import Enrolment, StoredSubmission
from grader.classroom.intake.fingerprint import fingerprint
from grader.classroom.intake.intake import Intake
from grader.classroom.intake.roster import Roster, entry_to_json
from grader.classroom.run.class_check import assignments_text, check_same_class
from grader.classroom.run.pool import WorkerError
from grader.classroom.run.progress import Progress
from grader.classroom.run.queue import Queue
from grader.classroom.run.stored_students import Identities, StoredStudents
from grader.classroom.run.worker import ClassContext, Task, grade_all, reference_record, undecided_result
from grader.classroom.students import ClassSubmission, Student
from grader.files.reading import URDF_LIMIT
from grader.grading.rubric import Rubric


class RunSettings(NamedTuple):
    """The settings of a run.

    `root` is the absolute path of the class, `max_size` the limit for a URDF in bytes. With `add` the class is added to
    whatever the gradebook holds. `parts` are the ids of those that every submission is graded on; default: all.
    `handed_out` are hashes of URDFs and robots that the course handed out.
    """

    root: str
    layout: str
    force: bool = False
    roster: Roster | None = None
    deadline: str = ""
    add: bool = False
    max_size: int = URDF_LIMIT
    parts: tuple[str, ...] = ()
    handed_out: tuple[str, ...] = ()


class Batch:
    """One run over a class. `notes` has the unclear matches of submissions to students."""

    def __init__(
        self,
        book: Gradebook,
        rubric: Rubric,
        settings: RunSettings,
        executor: Executor,
        workers: int,
        listener: Callable[[Progress], None] = lambda _: None,
    ) -> None:
        self._book, self._rubric, self._settings, self._listener = book, rubric, settings, listener
        self._sha256 = rubric.sha256  # which is computed
        used = {criterion.part for criterion in rubric.criteria}
        self._parts = parts_text(rubric, used.intersection(settings.parts or used))
        self._executor, self._workers = executor, workers
        self._at_work: dict[str, tuple[ClassSubmission, StoredSubmission | None]] = {}
        self.has_begun = False  # whether the run is in the gradebook
        self.progress = Progress(0)
        self.notes: list[str] = []

    def grade(self, intake: Intake) -> Progress:
        """Grade all new or changed submissions. Raises InputError for a class that belongs to another gradebook."""
        settings, book = self._settings, self._book
        identities = Identities(book, settings.root, settings.roster, intake.keys)
        if not settings.add:
            check_same_class(book, intake, identities, self._rubric.id)
        details = settings.deadline, assignments_text(intake.assignments), settings.max_size
        writer = RunWriter(book, settings.root, settings.layout, self._rubric, *details)
        self.has_begun = True
        writer.add_handed_out(settings.handed_out)
        self.progress = Progress(len(intake))
        self._report(())  # the total, before the first result
        students = StoredStudents(identities, writer, self.notes)
        contested = {student.key for student in intake.contested}
        self._grade_all(writer, self._tasks(intake, students, contested))
        for student in intake.absent:
            students.recognise(student)
        with book.transaction():
            for stored in students.gone():
                self._add_gone(writer, stored, is_contested=stored.key in contested)
            for student in (*intake.absent, *(intake.contested if settings.roster is not None else ())):
                save_student(book, student, self._enrolment(student))
        writer.finish()
        return self.progress

    def _tasks(self, intake: Intake, students: StoredStudents, contested: set[str]) -> Iterator[Task]:
        """Yield the submissions to grade: those that have no valid result, or have changed."""
        for submission in intake.submissions():
            stored = students.find(submission)
            if stored is not None and students.is_doubtful(submission, stored):
                path = submission.paths[0]
                self.notes.append(f"{path} may belong to {stored.key}, who had another submission: left unassigned")
                contested.add(stored.key)
                self._report(("unchanged",))
                continue
            stored = stored if stored is not None and self._is_valid(stored) else None
            if stored is not None and self._is_unchanged(submission, stored):
                self._report(("unchanged",))
                continue
            self._at_work[submission.student.key] = (submission, stored)
            digest = stored.digest if stored is not None else ""
            yield Task(submission.student.key, submission.paths, submission.names, digest)

    def _grade_all(self, writer: RunWriter, tasks: Iterator[Task]) -> None:
        """Grade submissions, and write their results as they come.

        A submission whose grading is lost is graded without its documents; if that is lost as well, it is `errored`.
        """
        first = next(tasks, None)
        if first is None:
            return
        context = self._context(writer)  # only if there is something to grade: grading the reference takes a while

        def lost(task: Task, error: Exception) -> GradingResult | None:
            if isinstance(error, WorkerError) and not task.no_documents:  # a document may be the cause
                queue.put_back(task._replace(no_documents=str(error)))
                return None
            reason = str(error) if isinstance(error, WorkerError) else f"{type(error).__name__}: {error}"
            return undecided_result(context, task, GradingResult(task.key, "errored", "", "", reason=reason))

        queue = Queue(self._executor, self._workers, partial(grade_all, context), lost)
        for results in queue.all(chain([first], tasks)):
            with self._book.transaction():
                for result in results:
                    self._save(writer, result)
            for result in results:
                del self._at_work[result.key]
            self._report(result.verdict for result in results)

    def _add_gone(self, writer: RunWriter, stored: StoredSubmission, *, is_contested: bool) -> None:
        """Record that a stored submission was not found, and whether its student has left the roster."""
        roster = self._settings.roster
        if not is_contested:
            writer.add_gone(stored)
        if stored.enrolment.is_on_roster and roster is not None and roster.entry(stored.key) is None:
            writer.remove_from_roster(stored.student_id)

    def _context(self, writer: RunWriter) -> ClassContext:
        """Return the data of all tasks, and store what the reference solution is for them."""
        settings, rubric = self._settings, (self._rubric.data, str(self._rubric.path))
        try:
            record, hashes = self._executor.submit(reference_record, *rubric).result()
        except WorkerError:  # the limits of time and memory are for submissions
            record = b""
        if not record:  # a worker of a cluster may not see the folder of the rubric
            record, hashes = reference_record(*rubric)
        writer.add_handed_out(hashes)
        writer.use_dictionary(record)
        return ClassContext(settings.root, *rubric, record, settings.max_size, settings.parts)

    def _is_valid(self, stored: StoredSubmission) -> bool:
        """Return whether a result may be kept: it is of the same rubric, parts and grader, and not errored."""
        is_same = (stored.rubric, stored.version, stored.parts) == (self._sha256, __version__, self._parts)
        return is_same and stored.verdict != "errored" and not self._settings.force

    def _is_unchanged(self, submission: ClassSubmission, stored: StoredSubmission) -> bool:
        """Return whether the file system and the roster say the same as in the run before."""
        root, max_size = self._settings.root, self._settings.max_size
        return (
            stored.fingerprint != ""
            and stored.max_size == max_size
            and stored.is_same(submission, self._enrolment(submission.student))
            and fingerprint(root, submission.paths, time.time_ns()) == stored.fingerprint
        )

    def _save(self, writer: RunWriter, result: GradingResult) -> None:
        submission, stored = self._at_work[result.key]
        student = save_student(self._book, submission.student, self._enrolment(submission.student))
        is_kept = result.verdict == "unchanged" and stored is not None
        number = stored.result if is_kept and stored is not None else writer.add_result(student, result)
        writer.add_submission(student, number, submission, result.fingerprint)

    def _enrolment(self, student: Student) -> Enrolment | None:
        """Return what the roster says about a student; None without a roster."""
        if self._settings.roster is None:
            return None
        entry = self._settings.roster.entry(student.key)
        if entry is None:
            return Enrolment(0)
        days_late = 0.0 if entry.is_late is False and entry.days_late is None else entry.days_late
        profile = storable(entry.section), storable(entry.marker)
        return Enrolment(1, entry.due, entry.extension_days, days_late, entry_to_json(entry), *profile)

    def _report(self, verdicts: Iterable[str]) -> None:
        for verdict in verdicts:
            self.progress = self.progress.with_result(verdict)
        self._listener(self.progress)
