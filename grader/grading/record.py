"""A report as plain data that keeps all of it, and the report that such data was made from: what a gradebook stores."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from grader.checks.manual import answered
from grader.checks.outcome import Outcome
from grader.documents.evidence import Exhibit
from grader.grading.report import Exhibits, Report, Result
from grader.grading.rubric import Rubric
from grader.problems import Kind, Problem
from grader.robot.reader import Verdict
from grader.source import Location, Source
from grader.submission.urdf import OtherCandidate

Quote = Callable[[str], Source | None]  # the text of one file of a submission; None where it cannot be read


class StoredPackage(NamedTuple):
    """The package that was graded: its folder in the submission, and its name."""

    folder: str
    name: str


@dataclass(frozen=True, slots=True)
class StoredSubmission:
    """What is kept of a submission. Its files are not: nothing of them is quoted, unless `quote` has their text."""

    id: str
    path: str | None = None
    sha256: str | None = None
    package: StoredPackage | None = None
    other_candidates: tuple[OtherCandidate, ...] = ()
    ignored: tuple[str, ...] = ()
    has_urdf: bool = False
    verdict: Verdict | None = None
    is_single: bool = False
    unread: str = ""
    quote: Quote | None = field(default=None, repr=False, compare=False)

    def source(self, path: str) -> Source | None:
        """The text of one of its files, where it is at hand."""
        return self.quote(path) if self.quote is not None else None


class Template:
    """The outcomes of a report that most others resemble, such as the reference's: what is the same need not be kept again."""

    def __init__(self, record: str, rubric: Rubric) -> None:
        self.text = record
        results = from_record(record, rubric).results if record else ()
        self.outcomes = {each.criterion.id: each.outcome for each in results}

    @classmethod
    def of(cls, report: Report) -> "Template":
        """The template that a report makes."""
        return cls(to_record(report), report.rubric)


def to_record(report: Report, template: Template | None = None) -> str:
    """A report as JSON text. What the rubric or the template says is not in it: `from_record` needs the same ones."""
    same = template.outcomes if template is not None else {}
    kept = report.submission
    package = kept.package
    data = {
        "version": report.version,
        "submission": [
            kept.id, kept.path, kept.sha256, (package.folder, package.name) if package is not None else None,
            kept.other_candidates, kept.ignored, kept.has_urdf, kept.verdict, kept.is_single, kept.unread,
        ],
        "parts": report.parts,
        "results": [_result(same, each) for each in report.results],
        "problems": [(each.code, each.severity, each.message, each.location) for each in report.problems],
        "exhibits": [[_exhibit(file) for file in each.files] for each in report.exhibits],
        "evidence": [each.evidence.id for each in report.exhibits],
        "others": [_exhibit(each) for each in report.others],
        "notes": report.notes,
    }  # fmt: skip
    return _ENCODER.encode(data)


def from_record(text: str, rubric: Rubric, quote: Quote | None = None, template: Template | None = None) -> Report:
    """The report that a record was made from, with the same rubric and template."""
    same = template.outcomes if template is not None else {}
    data = json.loads(text)
    identity, path, sha256, package, other_candidates, ignored, has_urdf, verdict, is_single, unread = data[
        "submission"
    ]
    kept = StoredSubmission(
        identity,
        path,
        sha256,
        StoredPackage(*package) if package is not None else None,
        tuple(OtherCandidate(*each) for each in other_candidates),
        tuple(ignored),
        has_urdf,
        verdict,
        is_single,
        unread,
        quote,
    )
    evidence = {each.id: each for each in rubric.evidence}
    return Report(
        kept,
        rubric,
        tuple(data["parts"]),
        tuple(_read_result(rubric, same, each) for each in data["results"]),
        tuple(_read_problem(*each) for each in data["problems"]),
        tuple(
            Exhibits(evidence[name], tuple(Exhibit(*each) for each in files))
            for name, files in zip(data["evidence"], data["exhibits"], strict=True)
        ),
        tuple(Exhibit(*each) for each in data["others"]),
        tuple(data["notes"]),
        data["version"],
    )


def _result(same: dict[str, Outcome], result: Result) -> Any:
    criterion, outcome, because, traceback, _ = result
    if because is None and not traceback:
        return criterion.position if same.get(criterion.id) == outcome else (criterion.position, outcome)
    return criterion.position, outcome, because, traceback


def _read_result(rubric: Rubric, same: dict[str, Outcome], entry: Any) -> Result:
    if isinstance(entry, int):
        return Result(rubric.criteria[entry], same[rubric.criteria[entry].id])
    index, (status, message, measured, expected, tolerance, unit, place), *rest = entry
    location = Location(*place) if place is not None else None
    if rubric.criteria[index].check.function is answered:
        expected = None  # earlier graders kept the model answer here
    outcome = Outcome(status, message, _value(measured), _value(expected), tolerance, unit, location)
    return Result(rubric.criteria[index], outcome, *rest)


def _plain(value: Any) -> Any:
    """What JSON does not know by itself: a place, or a mapping that cannot be changed."""
    return _place(value) if isinstance(value, Location) else dict(value)


def _value(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


def _place(where: Location) -> tuple[str, int, int]:
    return where.path, where.line, where.column


_ENCODER = json.JSONEncoder(separators=(",", ":"), default=_plain)


def _exhibit(exhibit: Exhibit) -> tuple[Any, ...]:
    return exhibit.path, exhibit.size, exhibit.width, exhibit.height


def _read_problem(code: str, severity: Any, message: str, place: Sequence[Any]) -> Problem:
    return Problem(Kind(code, severity, "other", "", ""), message, Location(*place))
