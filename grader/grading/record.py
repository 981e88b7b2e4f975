"""Reports as JSON text, which a gradebook stores, and back."""

import json
from dataclasses import asdict
from typing import Any

from grader.checks.outcome import Outcome
from grader.documents.evidence_files import EvidenceFile
from grader.grading.criterion import Criterion
from grader.grading.graded_submission import GradedPackage, GradedSubmission, Originals
from grader.grading.report import EvidenceResult, Report, Result, without_gifts
from grader.grading.rubric import Rubric
from grader.problems import Kind, Problem
from grader.source import Location
from grader.submission.urdf import OtherCandidate

_OF_SUBMISSION = ("id", "path", "sha256", "ignored", "has_urdf", "verdict", "is_single", "unread", "lacks")
_OF_RESULT = ("because", "traceback", "carried")
_OF_OUTCOME = Outcome._fields, tuple(map(Outcome._field_defaults.get, Outcome._fields))


def to_record(report: Report) -> str:
    """Return a report as JSON text without what the rubric holds: `from_record` needs the same one."""
    submission = report.submission
    package = submission.package
    data = {
        "submission": {
            **{name: getattr(submission, name) for name in _OF_SUBMISSION},
            "another_robot": submission.another_robot,
            "package": package._asdict() if package is not None else None,
            "other_candidates": [other._asdict() for other in submission.other_candidates],
        },
        "version": report.version,
        "parts": report.parts,
        "results": [_of_result(one) for one in report.results],
        "problems": [
            {"code": one.code, "severity": one.severity, "message": one.message, "location": _of_place(one.location)}
            for one in report.problems
        ],
        "evidence": [
            {"evidence": one.evidence.id, "files": one.files, "possible": one.possible} for one in report.evidence
        ],
        "other_pictures": report.other_pictures,
        "notes": report.notes,
    }
    return _ENCODER.encode(data)


def _of_result(result: Result) -> dict[str, Any]:
    """Return a result by the names of its fields, without those that have their default."""
    given = {name: value for name, default, value in zip(*_OF_OUTCOME, result.outcome, strict=True) if value != default}
    if isinstance(result.outcome.location, Location):
        given["location"] = _of_place(result.outcome.location)
    data = {"criterion": result.criterion.id, "outcome": given}
    return data | {name: value for name in _OF_RESULT if (value := getattr(result, name))}


def _of_place(location: Location) -> dict[str, Any]:
    place = {"path": location.path, "line": location.line, "column": location.column}
    return place | ({"calls": [(name, _of_place(at)) for name, at in location.calls]} if location.calls else {})


def from_record(text: str, rubric: Rubric, originals: Originals | None = None) -> Report:
    """Return the report that a record was made from, with the same rubric."""
    data = json.loads(text)
    criteria = {criterion.id: criterion for criterion in rubric.criteria}
    evidence = {one.id: one for one in rubric.evidence}
    submission = _submission(data["submission"], originals)
    return Report(
        submission=submission,
        rubric=rubric,
        parts=tuple(data["parts"]),
        results=without_gifts((_result(criteria, one) for one in data["results"]), submission),
        problems=tuple(_problem(one) for one in data["problems"]),
        evidence=tuple(
            EvidenceResult(evidence[one["evidence"]], _evidence_files(one["files"]), _evidence_files(one["possible"]))
            for one in data["evidence"]
        ),
        other_pictures=_evidence_files(data["other_pictures"]),
        notes=tuple(data["notes"]),
        version=data["version"],
    )


def graded_submission_from(text: str) -> GradedSubmission:
    """Return what a record says of its submission; the texts of its files are not in it.

    Only this part is decoded: all of it takes ten times as long, and some figures of a class read every record.
    """
    return _submission(_DECODER.raw_decode(text, len(_START))[0])


def _result(criteria: dict[str, Criterion], stored: dict[str, Any]) -> Result:
    criterion, outcome = criteria[stored.pop("criterion")], stored.pop("outcome")
    if outcome.get("location") is not None:
        outcome["location"] = _location(outcome["location"])
    for name in ("measured", "expected"):
        if isinstance(outcome.get(name), list):
            outcome[name] = tuple(outcome[name])
    return Result(criterion, Outcome(**outcome), **stored)


def _submission(stored: dict[str, Any], originals: Originals | None = None) -> GradedSubmission:
    package, others = stored.pop("package"), stored.pop("other_candidates")
    return GradedSubmission(
        **stored | {"ignored": tuple(stored["ignored"]), "lacks": tuple(stored["lacks"])},
        package=GradedPackage(**package) if package is not None else None,
        other_candidates=tuple(OtherCandidate(**other) for other in others),
        originals=originals,
    )


def _problem(stored: dict[str, Any]) -> Problem:
    kind = Kind(stored["code"], "", stored["severity"], "other")
    return Problem(kind, stored["message"], _location(stored["location"]))


def _evidence_files(stored: list[dict[str, Any]]) -> tuple[EvidenceFile, ...]:
    return tuple(EvidenceFile(**one) for one in stored)


def _plain(value: Any) -> Any:
    """Return what JSON cannot hold as a dictionary: a file by its fields, or a read-only mapping."""
    return asdict(value) if isinstance(value, EvidenceFile) else dict(value)


def _location(stored: dict[str, Any]) -> Location:
    calls = tuple((macro, _location(called)) for macro, called in stored.pop("calls", ()))
    return Location(**stored, calls=calls)


_START = '{"submission":'
_DECODER = json.JSONDecoder()
_ENCODER = json.JSONEncoder(separators=(",", ":"), default=_plain, check_circular=False)
