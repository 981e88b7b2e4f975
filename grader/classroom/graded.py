"""The result of one submission, and a finished run: lines of `results.jsonl`."""

import json
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import Any, Literal, NamedTuple

from grader.checks.outcome import Status
from grader.files.reading import sha256_of

Verdict = Literal["graded", "unreadable", "errored", "unchanged"]
Entry = tuple[float | None, Status, str, str]  # points, status, the mistake in words, the criterion that carries it
_DIGITS = 16  # of a hash


class Graded(NamedTuple):
    """The result of one submission: where it is, how it went, and what each criterion has.

    `root` is the position of its path in the settings of the class, `paths` are below that. `person` is what the
    names of the files say of the student. `context` is the hash of all that a result depends on besides the
    submission. `work` are hashes of the robot in several forms, for equal work; `answers` are the keys of what a person
    looks at for a criterion: students with the same answer have the same one, and it is empty without an answer.
    `texts` are those of Word and PDF files by path, in a new result only. `no_documents` says why its documents were
    not read. Without a `digest` the submission could not be read at all.
    """

    student: str
    run: int
    verdict: Verdict
    digest: str = ""
    context: str = ""
    reason: str = ""
    root: int = 0
    paths: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    is_late: bool = False
    submitted: str = ""
    person: Mapping[str, str] = {}
    parts: tuple[str, ...] = ()
    results: Mapping[str, Entry] = {}
    work: Mapping[str, str] = {}
    answers: Mapping[str, str] = {}
    no_documents: str = ""
    texts: Mapping[str, str] = {}

    @property
    def line(self) -> bytes:
        """The line of the file, without what is empty, and before it that of the texts."""
        values = self._asdict()
        files = values.pop("texts")
        line = _line_of({name: value for name, value in values.items() if value or name in ("student", "run")})
        return _line_of({"texts": self.student, "digest": self.digest, "files": files}) + line if files else line


class Run(NamedTuple):
    """A finished run: its number, the time in ISO 8601, and the total of each student who submitted, None while it is
    open.

    `rubric` is its hash, `context` that of all that results depend on besides the submissions. `unclear` are the
    students with possible submissions of which none was graded, `others` the totals of those without a submission.
    """

    run: int
    time: str
    version: str
    rubric: str
    context: str
    totals: Mapping[str, str | None]
    unclear: Sequence[str] = ()
    others: Mapping[str, str] = {}

    @property
    def line(self) -> bytes:
        """The line of the file."""
        return _line_of(self._asdict())

    @property
    def students(self) -> Iterable[str]:
        """The students who submitted, and those who have a total without a submission."""
        return chain(self.totals, self.others)

    def total(self, student: str) -> str | None:
        """Return the total of a student; None if there was none, or it was open."""
        return self.totals.get(student, self.others.get(student))


def _line_of(values: Mapping[str, Any]) -> bytes:
    return f"{json.dumps(values, separators=(',', ':'))}\n".encode()


def values_in(line: bytes) -> dict[str, Any]:
    """Return the values in a line, lists as tuples."""
    return {key: tuple(value) if isinstance(value, list) else value for key, value in json.loads(line).items()}


def digest_of(*parts: object) -> str:
    """Return the hash of some values: it begins with a letter, so that no spreadsheet takes it for a number."""
    return f"d{sha256_of(repr(parts).encode())[:_DIGITS]}"
