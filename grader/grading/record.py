"""Reports as JSON text, which a gradebook stores, and back."""

import json
from dataclasses import astuple
from typing import Any

from grader.checks.outcome import Outcome
from grader.documents.evidence import Exhibit
from grader.grading.graded_submission import GradedPackage, GradedSubmission, Originals
from grader.grading.report import Exhibits, Report, Result
from grader.grading.rubric import Rubric
from grader.problems import Kind, Problem
from grader.source import Location
from grader.submission.urdf import OtherCandidate

_VALUES = 7  # of an outcome: its mistake is in a column of its own, and few have a problem


class Template:
    """The outcomes of a report that most others resemble, such as the reference's; equal outcomes are stored once."""

    def __init__(self, record: str, rubric: Rubric) -> None:
        self.text = record
        results = from_record(record, rubric).results if record else ()
        self.outcomes = {result.criterion.id: result.outcome for result in results}

    @classmethod
    def of(cls, report: Report) -> "Template":
        """Return the template that a report makes."""
        return cls(to_record(report), report.rubric)


def to_record(report: Report, template: Template | None = None) -> str:
    """Return a report as JSON text without what the rubric and the template hold: `from_record` needs the same ones."""
    same = template.outcomes if template is not None else {}
    submission = report.submission
    data = {
        "version": report.version,
        "submission": [
            submission.id, submission.path, submission.sha256, submission.package, submission.other_candidates,
            submission.ignored, submission.has_urdf, submission.verdict, submission.is_single, submission.unread,
            submission.lacks,
        ],
        "parts": report.parts,
        "results": [_result(same, result) for result in report.results],
        "problems": [(it.code, it.severity, it.message, it.location) for it in report.problems],
        "exhibits": [exhibits.files for exhibits in report.exhibits],
        "perhaps": [exhibits.perhaps for exhibits in report.exhibits],
        "evidence": [exhibits.evidence.id for exhibits in report.exhibits],
        "others": report.others,
        "notes": report.notes,
    }  # fmt: skip
    return _ENCODER.encode(data)


def from_record(
    text: str, rubric: Rubric, originals: Originals | None = None, template: Template | None = None
) -> Report:
    """Return the report that a record was made from, with the same rubric and template."""
    same = template.outcomes if template is not None else {}
    data = json.loads(text)
    evidence = {proof.id: proof for proof in rubric.evidence}
    return Report(
        _submission(data, originals),
        rubric,
        tuple(data["parts"]),
        tuple(_read_result(rubric, same, entry) for entry in data["results"]),
        tuple(
            Problem(Kind(code, "", "", severity, "other"), message, _location(place))
            for code, severity, message, place in data["problems"]
        ),
        tuple(
            Exhibits(evidence[name], _exhibits(files), _exhibits(perhaps))
            for name, files, perhaps in zip(data["evidence"], data["exhibits"], data["perhaps"], strict=True)
        ),
        _exhibits(data["others"]),
        tuple(data["notes"]),
        data["version"],
    )


def submission_of(text: str) -> GradedSubmission:
    """Return what a record says of its submission; the texts of its files are not in it."""
    return _submission(json.loads(text))


def _submission(data: Any, originals: Originals | None = None) -> GradedSubmission:
    identity, path, sha256, package, others, ignored, has_urdf, verdict, is_single, unread, lacks = data["submission"]
    return GradedSubmission(
        identity,
        path,
        sha256,
        GradedPackage(*package) if package is not None else None,
        tuple(OtherCandidate(*file) for file in others),
        tuple(ignored),
        has_urdf,
        verdict,
        is_single,
        unread,
        tuple(lacks),
        originals,
    )


def _exhibits(files: Any) -> tuple[Exhibit, ...]:
    return tuple(Exhibit(*file) for file in files)


def _result(same: dict[str, Outcome], result: Result) -> Any:
    criterion, outcome, because, traceback, _, carried, *_ = result
    stored = _stored(outcome)
    if carried:
        return criterion.position, stored, because, traceback, None, carried
    if because is None and not traceback:
        template = same.get(criterion.id)
        return criterion.position if template and _stored(template) == stored else (criterion.position, stored)
    return criterion.position, stored, because, traceback


def _stored(outcome: Outcome) -> tuple[Any, ...]:
    return (*outcome[:_VALUES], outcome.problem) if outcome.problem else outcome[:_VALUES]


def _read_result(rubric: Rubric, same: dict[str, Outcome], entry: Any) -> Result:
    if isinstance(entry, int):
        return Result(rubric.criteria[entry], same[rubric.criteria[entry].id])
    index, (status, message, measured, expected, tolerance, unit, place, *problem), *rest = entry
    location = _location(place) if place is not None else None
    outcome = Outcome(status, message, _value(measured), _value(expected), tolerance, unit, location, "", *problem)
    return Result(rubric.criteria[index], outcome, *rest)


def _plain(value: Any) -> Any:
    """Return what JSON cannot hold as what it can: a location or exhibit as a list, a read-only mapping as a dict."""
    if isinstance(value, Location):
        place = (value.path, value.line, value.column)
        return (*place, value.calls) if value.calls else place
    return astuple(value) if isinstance(value, Exhibit) else dict(value)


def _location(place: list[Any]) -> Location:
    path, line, column, *rest = place
    calls = tuple((macro, _location(called)) for macro, called in (rest[0] if rest else ()))
    return Location(path, line, column, calls)


def _value(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


_ENCODER = json.JSONEncoder(separators=(",", ":"), default=_plain)
