"""The result of one submission, and a finished run: lines of `results.jsonl`."""

import json
from collections.abc import Mapping, Sequence
from typing import Any, Literal, NamedTuple

from grader.checks.outcome import Outcome, Status
from grader.files.reading import sha256_of
from grader.grading.graded_submission import GradedSubmission
from grader.grading.pictures import content_of, is_empty
from grader.grading.report import Report, Result, without_gifts
from grader.grading.rubric import Rubric
from grader.text import cut

Verdict = Literal["graded", "unreadable", "errored", "unchanged"]
Entry = tuple[float | None, Status, str, str]  # points, status, the mistake in words, the criterion that carries it
_MAX_CAUSE = 200  # characters
_DIGITS = 16  # of a hash


class Graded(NamedTuple):
    """The result of one submission: where it is, how it went, and what each criterion has.

    `root` is the position of its path in the settings of the class, `paths` are below that. `person` is what the
    names of the files say of the student. `context` is the hash of all that a result depends on besides the
    submission. `work` are hashes of the robot and the package in several forms, for equal work; `answers` are the
    keys of what a person looks at for a criterion: students with the same answer have the same one, and it is empty
    without an answer. `texts` are those of Word and PDF files by path, in a new result only. `no_documents` says why
    its documents were not read. Without a `digest` the submission could not be read at all.
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
    work: Mapping[str, Any] = {}
    answers: Mapping[str, str] = {}
    no_documents: str = ""
    texts: Mapping[str, str] = {}

    @property
    def line(self) -> bytes:
        """The line of the file, without what is empty, and before it that of the texts."""
        named = zip(self._fields[:-1], self[:-1], strict=True)
        line = _line_of({name: value for name, value in named if value or name in ("student", "run")})
        texts = {"texts": self.student, "digest": self.digest, "files": self.texts}
        return _line_of(texts) + line if self.texts else line

    def report(self, rubric: Rubric) -> Report:
        """Return the points, under the rubric that it was graded by: outcomes without places, values and hints."""
        unread = self.reason if self.verdict == "unreadable" else ""
        submission = GradedSubmission(self.student, unread=unread)
        why = f"{unread}; needs manual grading" if unread else self.reason
        rows = ((row, self.results.get(row.id)) for row in rubric.criteria)
        found = ((row, entry) for row, entry in rows if entry is not None)
        results = (Result(row, Outcome(status, words or why), carried=by) for row, (_, status, words, by) in found)
        return Report(submission, rubric, self.parts, without_gifts(results, submission))


class Run(NamedTuple):
    """A finished run: its number, the time in ISO 8601, and the total of each student who submitted, None while it is
    open.

    `rubric` is its hash, `context` that of all that results depend on besides the submissions. `unclear` are the
    students with possible submissions of which none was graded.
    """

    run: int
    time: str
    version: str
    rubric: str
    context: str
    totals: Mapping[str, str | None]
    unclear: Sequence[str] = ()

    @property
    def line(self) -> bytes:
        """The line of the file."""
        return _line_of(self._asdict())


def _line_of(values: Mapping[str, Any]) -> bytes:
    return f"{json.dumps(values, separators=(',', ':'))}\n".encode()


def entries_of(report: Report) -> dict[str, Entry]:
    """Return what a line keeps of each criterion of a report."""
    return {one.criterion.id: _entry(one) for one in report.results}


def _entry(result: Result) -> Entry:
    outcome = result.outcome
    is_open = outcome.status in ("pending", "errored") and not result.is_adjusted
    words = outcome.mistake or (outcome.message if outcome.status in ("failed", "errored") else "")
    points = result.points
    number = int(points) if points == int(points) else float(points)
    return None if is_open else number, outcome.status, cut(words, _MAX_CAUSE), result.carried


def answers_of(report: Report, digest: str) -> dict[str, str]:
    """Return the key of the answer for each criterion that needs manual grading, empty if there is nothing to read.

    It is that of the words, or of the whole submission where more than words is to be looked at.
    """
    open_ones = [one for one in report.results if one.outcome.status == "pending"]
    contents = {one.criterion.id: content_of(one, report) or digest * (not is_empty(one, report)) for one in open_ones}
    return {name: content and digest_of(content) for name, content in contents.items()}


def digest_of(*parts: object) -> str:
    """Return the hash of some values: it begins with a letter, so that no spreadsheet takes it for a number."""
    return f"d{sha256_of(repr(parts).encode())[:_DIGITS]}"


def graded_from(line: bytes) -> Graded:
    """Return the result in a line."""
    return Graded(**values_in(line))


def values_in(line: bytes) -> dict[str, Any]:
    """Return the values in a line, lists as tuples."""
    return {key: tuple(value) if isinstance(value, list) else value for key, value in json.loads(line).items()}
