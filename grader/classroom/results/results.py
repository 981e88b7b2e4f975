"""The file `results.jsonl` of a gradebook: one line a graded submission and one line a run.

A line of a submission comes before that of its run, and the newest of a student counts. The texts
of Word and PDF files, which are slow to read, are on lines of their own. The file can be computed
again from the submissions: without it only the comparison of runs and some seconds are lost. A last
line that was not written to its end is ignored, and cut before the next one is appended.

Each line ends with its checksum, and that of a run names the students whose lines it wrote: what is
damaged or lost counts for nobody.
"""

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from itertools import chain
from json.decoder import scanstring  # type: ignore[attr-defined,unused-ignore]
from pathlib import Path
from typing import Any, Literal, NamedTuple, Self
from zlib import crc32

from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.text import MAX_NAMED, enumerated, printable_path
from grader.files.reading import hash_bytes, read_error
from grader.lab.checks.outcome import Status

Verdict = Literal["graded", "unreadable", "errored", "unchanged"]
# What is kept of a criterion: points, status, the mistake in words, the criterion that carries it,
# and of a length that was measured how far it is off, in metres.
StoredCriterion = (
    tuple[float | None, Status, str, str] | tuple[float | None, Status, str, str, float]
)
_DIGITS = 16  # of a hash
_RUN = b'{"run":'
_GRADED = b'{"student":'
_TEXTS = b'{"texts":'
_CHECKSUM = b',"crc32":'  # of all bytes before it


class StoredResult(NamedTuple):
    """The result of one submission: where it is, how it went, and what each criterion has."""

    student: str
    run: int
    verdict: Verdict
    digest: str = ""  # of the submission; empty if it could not be read at all
    context: str = ""  # the hash of all that a result depends on besides the submission
    reason: str = ""  # for the verdict, in words
    root: int = 0  # the position of its class folder in the settings of the class
    paths: Strings = ()  # below the class folder
    names: Strings = ()  # the student's own of several files
    is_late: bool = False
    submitted: str = ""  # ISO 8601
    person: Mapping[str, str] = {}  # what the names of the files say of the student
    parts: Strings = ()
    results: Mapping[str, StoredCriterion] = {}
    work: Mapping[str, str] = {}  # hashes of the robot in several forms, for equal work
    answers: Mapping[
        str, str
    ] = {}  # by criterion: students with the same answer have the same key, empty without one
    no_documents: str = ""  # why its documents were not read
    no_robot: str = ""  # what it has in place of the robot and the package that are graded
    timeout: float = 0  # the limit of processor time that it reached, in seconds
    texts: Mapping[str, str] = {}  # those of Word and PDF files by path, in a new result only
    written: Mapping[str, str] = {}  # the answers by criterion, in a new result only

    @property
    def line(self) -> bytes:
        """The line of the file, without what is empty, and before it that of the texts."""
        values = self._asdict()
        files = values.pop("texts")
        answers = values.pop("written")
        line = json_line(
            {name: value for name, value in values.items() if value or name in ("student", "run")}
        )
        if files or answers:
            texts = {"texts": self.student, "digest": self.digest}
            return json_line({**texts, "files": files, "answers": answers}) + line
        return line


class RunGrade(NamedTuple):
    """The grade of a student in a run, as all tables show it, and what it follows from."""

    total: str | None = None  # points; None where nothing could be graded
    obstacle: str = ""  # the name of the reason for which it is not final
    pending: str = ""  # points that need manual grading
    days_late: int = 0
    penalty: str = ""  # points
    deadline: str = ""  # the student's own
    marks: Mapping[str, str] = {}  # by criterion


class Run(NamedTuple):
    """A finished run, the first of which has the number 1."""

    run: int
    time: str  # ISO 8601
    version: str  # of the grader
    rubric: str  # its hash
    context: str  # the hash of all that results depend on besides the submissions
    totals: Mapping[str, str | None]  # of the students who submitted
    unclear: Sequence[str] = ()  # students with possible submissions of which none was graded
    others: Mapping[str, str] = {}  # totals of the students without a submission
    written: Sequence[str] = ()  # the students whose results were written since the run before
    maximum: str = ""  # of the grades
    # By student, what its RunGrade has besides the total.
    details: Mapping[str, Mapping[str, Any]] = {}
    due: str = ""  # the deadline of the class, ISO 8601

    @property
    def line(self) -> bytes:
        """The line of the file."""
        return json_line(self._asdict())

    @property
    def students(self) -> Iterable[str]:
        """The students who submitted, and those who have a total without a submission."""
        return chain(self.totals, self.others)

    def grade(self, student: str) -> RunGrade:
        """Return the grade of a student, without anything if the run has none."""
        total = self.totals.get(student, self.others.get(student))
        return RunGrade(total, **self.details.get(student, {}))

    def has_equal_grades(self, other: "Run") -> bool:
        """Return whether another run has the same grades, computed by the same rubric and rules."""
        return self._replace(run=other.run, time=other.time, written=other.written) == other


def json_line(values: Mapping[str, Any]) -> bytes:
    """Return values as a line of a file, with its checksum."""
    line = json.dumps(values, separators=(",", ":")).encode()[:-1]
    return line + _checksum(line)


def _checksum(line: bytes) -> bytes:
    return b"%s%d}\n" % (_CHECKSUM, crc32(line))


def is_whole(line: bytes) -> bool:
    """Return whether a line is as it was written."""
    values, _, _ = line.rpartition(_CHECKSUM)
    return line == values + _checksum(values)


def values_in(line: bytes) -> dict[str, Any]:
    """Return the values in a whole line, lists as tuples."""
    values = json.loads(line.rpartition(_CHECKSUM)[0] + b"}")
    return {
        key: tuple(value) if isinstance(value, list) else value for key, value in values.items()
    }


def hash_values(*parts: object) -> str:
    """Return the hash of some values.

    It begins with a letter, so that no spreadsheet takes it for a number.
    """
    return f"d{hash_bytes(repr(parts).encode())[:_DIGITS]}"


def time_of_run() -> str:
    """Return the time now, as runs have it."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


class Results:
    """The results in a file: the newest line of each student, up to a run, and the runs."""

    def __init__(self, file: Path, until: int | None = None) -> None:
        self._file = file
        self.end = 0  # where the last whole line ends
        self.runs: list[Run] = []
        self.turns: list[int] = []  # the numbers of the runs that changed something
        self.damaged: list[int] = []  # the numbers of lines, from 1
        self.unfinished = set[str]()  # the students whose results were written since the newest run
        # whether a line since the newest run is damaged, which may be that of a run
        self._is_torn = False
        # A hundred thousand students fit into memory, but not all of their results.
        self._places = dict[str, int]()
        self._texts = dict[str, int]()
        with self._refuse_damage():
            self._find(until)

    def _find(self, until: int | None) -> None:
        """Find the place of each line, up to the end of a run."""
        for number, line in enumerate(self._whole_lines(), 1):
            if not is_whole(line):
                self.damaged.append(number)
                self._is_torn = True
            elif line.startswith(_RUN):
                self._end_run(Run(**values_in(line)))
            else:
                self._place(line)
            self.end += len(line)
            if until is not None and self.runs and self.runs[-1].run == until:
                break

    def _place(self, line: bytes) -> None:
        """Keep the place of a line of a student."""
        for start, places in ((_GRADED, self._places), (_TEXTS, self._texts)):
            if line.startswith(start):
                key = scanstring(line.decode(), len(start) + 1, True)[0]
                places[key] = self.end
                if start == _GRADED:
                    self.unfinished.add(key)

    def _end_run(self, run: Run) -> None:
        """Keep a run.

        A student whose line of it is lost has no result: an older one is that of other
        work.
        """
        for key in {*run.written} - self.unfinished:
            self._places.pop(key, None)
        self.unfinished.clear()
        self._is_torn = False
        if run.written or not self.runs or not run.has_equal_grades(self.runs[-1]):
            self.turns.append(run.run)
        # Only the newest are compared.
        self.runs[-1:] = [
            older._replace(totals={}, others={}, details={}, written=()) for older in self.runs[-1:]
        ]
        self.runs.append(run)

    @property
    def damage(self) -> str:
        """Which lines are damaged; empty without any."""
        lines = enumerated(map(str, self.damaged), MAX_NAMED)
        noun, verb = ("line", "does") if len(self.damaged) == 1 else ("lines", "do")
        if lines:
            where = f"{noun} {lines} of {printable_path(self._file)}"
            return f"{where} cannot be read, and {verb} not count"
        return ""

    def check_newest(self) -> None:
        """Raise InputError if the newest run may be lost."""
        if self._is_torn:
            raise InputError(f"{self.damage}: run `grader batch` again")

    @contextmanager
    def _refuse_damage(self) -> Iterator[None]:
        """Read whole lines; raises InputError if one is not of this version."""
        try:
            yield
        except (ValueError, TypeError, KeyError, AttributeError):
            shown = printable_path(self._file)
            raise InputError(
                f"{shown} is damaged: delete it, and rerun `grader batch`, which makes it again"
            ) from None

    def _whole_lines(self) -> Iterator[bytes]:
        """Yield the whole lines, up to one that was not written to its end."""
        if not self._file.exists():
            return
        try:
            with self._file.open("rb") as file:
                for line in file:
                    if not line.endswith(b"\n"):
                        return
                    yield line
        except OSError as error:
            raise read_error(error, printable_path(self._file)) from None

    @property
    def next_run(self) -> int:
        """The number of the next run."""
        if self.runs:
            return self.runs[-1].run + 1
        return 1

    @property
    def students(self) -> list[str]:
        """The keys of the students with a result, sorted."""
        return sorted(self._places)

    def all(self) -> Iterator[StoredResult]:
        """Yield the newest result of each student, in the order of the keys."""
        return (one for one in self.each(self.students) if one)

    def each(self, keys: Iterable[str]) -> Iterator[StoredResult | None]:
        """Yield the newest result of each of some students, None for one without."""
        for values in self._read_values(self._places, keys):
            with self._refuse_damage():
                result = StoredResult(**values) if values else None
            yield result

    def of(self, key: str) -> StoredResult | None:
        """Return the newest result of a student."""
        return next(self.each([key]))

    def texts(self, stored: StoredResult) -> dict[str, str]:
        """Return the texts of the Word and PDF files in a submission as it was graded, by path."""
        return self._read_texts(stored, "files")

    def written_answers(self, stored: StoredResult) -> dict[str, str]:
        """Return the written answers in a submission as it was graded, by criterion."""
        return self._read_texts(stored, "answers")

    def _read_texts(self, stored: StoredResult, kind: str) -> dict[str, str]:
        [values] = self._read_values(self._texts, [stored.student])
        if values and values["digest"] == stored.digest:
            return dict(values[kind])
        return {}

    def _read_values(
        self, places: Mapping[str, int], keys: Iterable[str]
    ) -> Iterator[dict[str, Any]]:
        """Yield the values in a line for each key, none for a key without."""
        if not places:
            yield from ({} for _ in keys)
            return
        try:
            with self._file.open("rb") as file:
                for key in keys:
                    if key in places:
                        file.seek(places[key])
                    yield values_in(file.readline()) if key in places else {}
        except OSError as error:
            raise read_error(error, printable_path(self._file)) from None


class ResultsWriter:
    """Appends lines to a file of results, behind its last whole line.

    Raises InputError if it cannot be written.
    """

    def __init__(self, file: Path, end: int) -> None:
        self._shown = printable_path(file)
        try:
            self._handle = os.open(file, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o600)
            os.ftruncate(self._handle, end)
        except OSError as error:
            raise InputError(f"cannot write {self._shown}: {error.strerror}") from None

    @property
    def end(self) -> int:
        """Where the file ends."""
        return os.fstat(self._handle).st_size

    def append(self, *lines: bytes) -> None:
        """Append lines in one write."""
        data = b"".join(lines)
        try:
            is_written = os.write(self._handle, data) == len(data)
        except OSError as error:
            raise InputError(f"cannot write {self._shown}: {error.strerror}") from None
        if not is_written:
            raise InputError(f"cannot write {self._shown}: the disk is full")

    def sync(self) -> None:
        """Write to the disk what the system still holds."""
        os.fsync(self._handle)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._handle)
