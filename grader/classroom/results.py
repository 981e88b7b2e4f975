"""The file `results.jsonl` of a gradebook: one line a graded submission and one line a run.

A line of a submission comes before that of its run, and the newest of a student counts. The texts of Word and PDF
files, which are slow to read, are on lines of their own. The file can be computed again from the submissions: without
it only the comparison of runs and some seconds are lost. A last line that was not written to its end is ignored, and
cut before the next one is appended.
"""

import json
import os
from collections.abc import Iterator
from json.decoder import scanstring  # type: ignore[attr-defined,unused-ignore]
from pathlib import Path
from typing import Self

from grader.classroom.graded import Graded, Run, graded_from, values_in
from grader.errors import InputError
from grader.text import printable_path

_START, _TEXTS = b'{"student":"', b'{"texts":"'
_RUN = b'{"run":'


class Results:
    """The results in a file: the newest line of each student, up to a run, and the runs."""

    def __init__(self, file: Path, until: int | None = None) -> None:
        self._file = file
        self.end = 0  # where the last whole line ends
        self.runs: list[Run] = []
        self._texts: dict[str, int] = {}
        self._places: dict[str, int] = {}  # a hundred thousand students fit into memory, but not all of their results
        for place, line in self._lines():
            if line.startswith(_RUN):
                self.runs.append(Run(**values_in(line)))
                if self.runs[-1].run == until:
                    break
            elif line.startswith((_START, _TEXTS)):
                places = self._places if line.startswith(_START) else self._texts
                places[scanstring(line.decode(), line.index(b":") + 2, True)[0]] = place
            self.end = place + len(line)

    def _lines(self) -> Iterator[tuple[int, bytes]]:
        """Yield the whole lines and where they begin, up to one that was not written to its end."""
        if not self._file.exists():
            return
        place = 0
        try:
            with self._file.open("rb") as file:
                for line in file:
                    if not line.endswith(b"\n") or b"\0" in line:  # a power failure leaves holes
                        return
                    yield place, line
                    place += len(line)
        except OSError as error:
            raise InputError(f"cannot read {printable_path(self._file)}: {error.strerror}") from None

    @property
    def next_run(self) -> int:
        """The number of the next run."""
        return self.runs[-1].run + 1 if self.runs else 1

    @property
    def students(self) -> list[str]:
        """The keys of the students with a result, sorted."""
        return sorted(self._places)

    def all(self) -> Iterator[Graded]:
        """Yield the newest result of each student, in the order of the keys."""
        if self._places:
            with self._file.open("rb") as file:
                for key in self.students:
                    file.seek(self._places[key])
                    yield graded_from(file.readline())

    def of(self, key: str) -> Graded | None:
        """Return the newest result of a student."""
        return graded_from(self._line_at(self._places[key])) if key in self._places else None

    def texts(self, graded: Graded) -> dict[str, str]:
        """Return the texts of the Word and PDF files in a submission as it was graded, by path."""
        if graded.student not in self._texts:
            return {}
        found = json.loads(self._line_at(self._texts[graded.student]))
        return dict(found["files"]) if found["digest"] == graded.digest else {}

    def _line_at(self, place: int) -> bytes:
        with self._file.open("rb") as file:
            file.seek(place)
            return file.readline()


class ResultsWriter:
    """Appends lines to a file of results, behind its last whole line. Raises InputError if it cannot be written."""

    def __init__(self, file: Path, end: int) -> None:
        self._shown = printable_path(file)
        try:
            self._handle = os.open(file, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o600)
            os.ftruncate(self._handle, end)
        except OSError as error:
            raise InputError(f"cannot write {self._shown}: {error.strerror}") from None

    def append(self, *lines: bytes) -> None:
        """Append lines in one write."""
        data = b"".join(lines)
        try:
            if os.write(self._handle, data) != len(data):
                raise InputError(f"cannot write {self._shown}: the disk is full")
        except OSError as error:
            raise InputError(f"cannot write {self._shown}: {error.strerror}") from None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._handle)

    def sync(self) -> None:
        """Write to the disk what the system still holds."""
        os.fsync(self._handle)
