"""A report as SARIF 2.1.0, the subset that GitHub's code scanning reads: a result for each finding, a rule for each kind of it.

https://docs.github.com/code-security/reference/code-scanning/sarif-files/sarif-support
"""

from typing import Any
from urllib.parse import quote

from grader.grading.report import Report
from grader.report.content import explain_command
from grader.report.findings import Finding, findings
from grader.report.json_data import exact, to_json
from grader.report.locations import Base, RepositoryLocation
from grader.report.plain_text import criterion_lines, headline
from grader.report.rubrics import EVERY_KIND
from grader.text import printable

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_MOST = 5000  # results of a run that GitHub shows


def render_sarif(report: Report, base: Base) -> str:
    """The whole report: findings as results, everything else in the run's properties."""
    found = findings(report, base)
    rules = list(dict.fromkeys(each.rule for each in found))
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
        "results": [_result(each, rules.index(each.rule)) for each in found[:_MOST]],
        "properties": _properties(report, len(found)),
    }
    return to_json({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]})


def _rule(name: str, report: Report) -> dict[str, Any]:
    """A criterion, or a kind of problem. GitHub wants each of the texts, and none of them empty."""
    for criterion in report.rubric.criteria:
        if criterion.id == name:
            title, command = printable(criterion.title), explain_command(name, report)
            fact = printable(f"Passes when: {criterion.title}. {criterion.check.fact}")
            return _described(name, title, fact, printable(criterion.feedback) or fact, "error", command)
    for kind in EVERY_KIND:
        if kind.code == name:
            explanation = " ".join(kind.explanation.split())
            return _described(name, kind.title, explanation, explanation, kind.severity, f"grader explain {name}")
    return _described(name, name, name, name, "warning", f"grader explain {name}")


def _described(name: str, title: str, text: str, advice: str, level: str, command: str) -> dict[str, Any]:
    return {
        "id": name,
        "shortDescription": {"text": title},
        "fullDescription": {"text": text},
        "help": {"text": f"{advice}\n\n`{command}` says more."},
        "defaultConfiguration": {"level": level},
        "properties": {"tags": ["grading"]},
    }


def _result(finding: Finding, index: int) -> dict[str, Any]:
    cost = {"properties": {"points": exact(finding.lost)}} if finding.lost else {}
    return {
        "ruleId": finding.rule,
        "ruleIndex": index,
        "level": finding.level,
        "message": {"text": _no_links(finding.text)},
        "locations": [{"physicalLocation": _physical(finding.place or finding.whole)}],
        "partialFingerprints": {"primaryLocationLineHash": finding.fingerprint},
        **cost,
    }


def _no_links(text: str) -> str:
    """Text in which no viewer finds SARIF's way to write a link."""
    return text.replace("](", "] (")


def _physical(place: RepositoryLocation) -> dict[str, Any]:
    uri = quote(place.path.encode("utf-8", "surrogateescape"))
    region: dict[str, Any] = {"startLine": 1}
    if place.line is not None:
        region = {
            "startLine": place.line,
            "startColumn": place.column,
            "endLine": place.line,
            "endColumn": max(place.end, place.column),
            **({"snippet": {"text": printable(place.meant)}} if place.meant else {}),
        }
    return {"artifactLocation": {"uri": uri, "uriBaseId": "%SRCROOT%"}, "region": region}


def _properties(report: Report, count: int) -> dict[str, Any]:
    """What code scanning has no place for: the points, what was not decided, and where all this comes from."""
    return {
        "score": exact(report.score),
        "maxScore": exact(report.max_score),
        "pending": exact(report.pending),
        "rubric": {"id": printable(report.rubric.id), "sha256": report.rubric.sha256},
        "submission": {"id": printable(report.submission.id), "sha256": report.submission.sha256},
        "said": headline(report),
        "leftOut": max(0, count - _MOST),
        "criteria": [
            {
                "id": each.criterion.id,
                "title": printable(each.criterion.title),
                "status": each.outcome.status,
                "points": exact(each.points),
                "maxPoints": exact(each.criterion.points),
                "said": criterion_lines(each, report),
            }
            for each in report.results
        ],
    }
