"""A report as SARIF 2.1.0, as GitHub reads it: a result for each finding, a rule for each criterion or code.

https://docs.github.com/code-security/reference/code-scanning/sarif-files/sarif-support
"""

from typing import Any
from urllib.parse import quote

from grader.grading.report import Hint, Report
from grader.report.as_json import GRADE
from grader.report.content import explain_command, submission_lines
from grader.report.details import criterion_lines
from grader.report.examples import explanation_of
from grader.report.findings import Finding, findings
from grader.report.json_data import exact, to_json
from grader.report.locations import RepositoryLocation, archive_around
from grader.report.order import alike
from grader.report.rubrics import kind_of
from grader.source import Base, Edit
from grader.text import printable

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_MAX_RESULTS = 5000  # results of a run that GitHub shows


def render_sarif(report: Report, base: Base) -> str:
    """Return the report: findings as results, everything else in the run's properties."""
    found = findings(report, base)
    rules = list(dict.fromkeys(finding.rule for finding in found))
    run: dict[str, Any] = {
        "tool": {
            "driver": {
                "name": "grader",
                "semanticVersion": report.version,
                "rules": [_rule(name, report) for name in rules],
            }
        },
        "columnKind": "unicodeCodePoints",
        "automationDetails": {"id": f"grader/{printable(report.rubric.id)}/"},
        "results": [_result(finding, rules.index(finding.rule), base) for finding in found[:_MAX_RESULTS]],
        "properties": _properties(report, len(found)),
    }
    return to_json({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]})


def _rule(name: str, report: Report) -> dict[str, Any]:
    """Return the rule of a criterion or a problem code. GitHub requires each of the texts, not empty."""
    for criterion in report.rubric.criteria:
        if criterion.id == name:
            title, command = printable(criterion.title), explain_command(name, report)
            fact = printable(f"Passes when: {criterion.title}. {criterion.check.documentation.fact}")
            return _describe(name, title, fact, printable(criterion.feedback) or fact, "error", command)
    kind = kind_of(name)
    if kind is not None:
        explanation = explanation_of(kind)
        return _describe(name, kind.title, explanation, explanation, kind.severity, f"grader explain {name}")
    return _describe(name, name, name, name, "warning", f"grader explain {name}")


def _describe(name: str, title: str, text: str, advice: str, level: str, command: str) -> dict[str, Any]:
    return {
        "id": name,
        "shortDescription": {"text": title},
        "fullDescription": {"text": text},
        "help": {"text": f"{advice}\n\n`{command}` explains it."},
        "defaultConfiguration": {"level": level},
        "properties": {"tags": ["grading"]},
    }


def _result(finding: Finding, index: int, base: Base) -> dict[str, Any]:
    hint = finding.hint
    cost = {"properties": {"points": exact(finding.lost)}} if finding.lost else {}
    return {
        "ruleId": finding.rule,
        "ruleIndex": index,
        "level": finding.level,
        "message": {"text": _plain(finding.text)},
        "locations": [{"physicalLocation": _physical(finding.location or finding.fallback)}],
        "partialFingerprints": {"primaryLocationLineHash": finding.fingerprint},
        **({"fixes": [_fix(hint, base)]} if hint is not None and _is_replacement(hint, base) else {}),
        **cost,
    }


def _is_replacement(hint: Hint, base: Base) -> bool:
    """Return whether the edits of a hint replace text of files in the repository: SARIF renames no file."""
    files = [edit.path for edit in hint.edits if not edit.renamed]
    return bool(files) and len(files) == len(hint.edits) and not (base.archive or any(map(archive_around, files)))


def _fix(hint: Hint, base: Base) -> dict[str, Any]:
    changes = alike(hint.edits, lambda edit: edit.path)
    return {
        "description": {"text": _plain(hint.message)},
        "artifactChanges": [
            {"artifactLocation": _artifact(base.folder + path), "replacements": list(map(_replacement, edits))}
            for path, edits in changes
        ],
        "properties": {"certainty": hint.certainty},
    }


def _replacement(edit: Edit) -> dict[str, Any]:
    """Return an edit; the column after the old text counts from the last line break in it."""
    *lines, last = edit.old.split("\n")
    region = {
        "startLine": edit.line,
        "startColumn": edit.column,
        "endLine": edit.line + len(lines),
        "endColumn": len(last) + (1 if lines else edit.column),
    }
    return {"deletedRegion": region, "insertedContent": {"text": edit.new}}


def _artifact(path: str) -> dict[str, str]:
    return {"uri": quote(path.encode("utf-8", "surrogateescape")), "uriBaseId": "%SRCROOT%"}


def _plain(text: str) -> str:
    """Return text without links in the syntax of SARIF's messages."""
    return text.replace("](", "] (")


def _physical(location: RepositoryLocation) -> dict[str, Any]:
    region: dict[str, Any] = {"startLine": 1}
    if location.line is not None:
        region = {
            "startLine": location.line,
            "startColumn": location.column,
            "endLine": location.line,
            "endColumn": max(location.end, location.column),
            **({"snippet": {"text": printable(location.meant)}} if location.meant else {}),
        }
    return {"artifactLocation": _artifact(location.path), "region": region}


def _properties(report: Report, count: int) -> dict[str, Any]:
    """Return what code scanning has no field for: points, criteria, provenance."""
    return {
        "score": exact(report.score),
        "maxScore": exact(report.max_score),
        "pending": exact(report.pending),
        **GRADE.data(report),
        "rubric": {"id": printable(report.rubric.id), "sha256": report.rubric.sha256},
        "submission": {"id": printable(report.submission.id), "sha256": report.submission.sha256},
        "said": submission_lines(report),
        "leftOut": max(0, count - _MAX_RESULTS),
        "criteria": [
            {
                "id": result.criterion.id,
                "title": printable(result.criterion.title),
                "status": result.outcome.status,
                "points": exact(result.points),
                "maxPoints": exact(result.criterion.points),
                **({"bonus": True} if result.criterion.bonus else {}),
                "said": criterion_lines(result, report),
            }
            for result in report.results
        ],
    }
