"""Grade a class: what is new or changed is handed out, what comes back goes into the gradebook at once."""

import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import NamedTuple

from grader import __version__
from grader.classroom.gradebook import Gradebook, Known
from grader.classroom.opening import fingerprint
from grader.classroom.queue import Queue
from grader.classroom.students import HandIn, Student
from grader.classroom.work import Class, Graded, Task
from grader.grading.rubric import Rubric

_MOST_UNWRITTEN = 500  # hand-ins that have not changed
_PATIENCE = 0.5  # seconds until such a thing is written


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


class Settings(NamedTuple):
    """How a run is done. `root` is the absolute path of the class; `expected` tells whether a student is on the roster."""

    root: str
    layout: str
    total: int
    workers: int
    force: bool = False
    expected: Callable[[Student], bool | None] = lambda _: None


class Batch:
    """One run over a class."""

    def __init__(
        self,
        book: Gradebook,
        rubric: Rubric,
        settings: Settings,
        executor: Executor,
        listener: Callable[[Progress], None] = lambda _: None,
    ) -> None:
        self._book, self._rubric, self._settings, self._listener = book, rubric, settings, listener
        self._queue = Queue(executor, settings.workers, Class(settings.root, rubric.data, str(rubric.path)), rubric)
        self._waiting: dict[str, tuple[HandIn, Known | None]] = {}
        self._unwritten: list[tuple[HandIn, Known, str]] = []
        self._written_at = time.monotonic()
        self._progress = Progress(settings.total)
        self._run = 0

    def grade(self, hand_ins: Iterable[HandIn], missing: Sequence[Student] = ()) -> Progress:
        """Grade all hand-ins that are new or changed. `missing` are students of whom there is none."""
        self._run = self._book.begin(self._settings.root, self._settings.layout, self._rubric)
        was_empty = self._book.is_empty()
        for hand_in in hand_ins:
            known = None if was_empty else self._known(hand_in)
            if not self._is_unchanged(hand_in, known):
                self._hand_out(hand_in, known)
            while self._queue.is_full:
                self._take(all_in=False)
        while len(self._queue):
            self._take(all_in=True)
        self._write_unchanged()
        with self._book.transaction():
            for student in missing:
                self._book.keep_student(student, expected=True)
        self._book.finish(self._run)
        return self._progress

    def _known(self, hand_in: HandIn) -> Known | None:
        """The result of this student that may still hold: of the same rubric and grader, and no failure of ours."""
        known = self._book.known(hand_in.student.key)
        if known is None or (known.rubric, known.version) != (self._rubric.sha256, __version__):
            return None
        return None if known.verdict == "errored" or self._settings.force else known

    def _is_unchanged(self, hand_in: HandIn, known: Known | None) -> bool:
        if known is None or not known.fingerprint:
            return False
        mark = fingerprint(self._settings.root, hand_in.paths, time.time_ns())
        if mark != known.fingerprint:
            return False
        self._unwritten.append((hand_in, known, mark))
        if len(self._unwritten) >= _MOST_UNWRITTEN or time.monotonic() - self._written_at > _PATIENCE:
            self._write_unchanged()
        return True

    def _hand_out(self, hand_in: HandIn, known: Known | None) -> None:
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

    def _keep(self, graded: Graded) -> None:
        hand_in, known = self._waiting[graded.key]
        student = self._keep_student(hand_in)
        if graded.verdict == "unchanged" and known is not None:
            result = known.result
        else:
            result = self._book.keep(student, self._rubric.sha256, graded)
        self._book.see(student, self._run, result, hand_in, graded.fingerprint)

    def _keep_student(self, hand_in: HandIn) -> int:
        return self._book.keep_student(hand_in.student, self._settings.expected(hand_in.student))

    def _write_unchanged(self) -> None:
        if self._unwritten:
            with self._book.transaction():
                for hand_in, known, mark in self._unwritten:
                    self._book.see(self._keep_student(hand_in), self._run, known.result, hand_in, mark)
            self._tell("unchanged" for _ in self._unwritten)
            self._unwritten.clear()
        self._written_at = time.monotonic()

    def _tell(self, verdicts: Iterable[str]) -> None:
        for verdict in verdicts:
            self._progress = self._progress.with_result(verdict)
        self._listener(self._progress)
