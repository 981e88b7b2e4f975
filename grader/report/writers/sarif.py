"""Findings as SARIF 2.1.0, for GitHub's code scanning and other viewers.

https://docs.oasis-open.org/sarif/sarif/v2.1.0/sarif-v2.1.0.html, and what GitHub reads of it:
https://docs.github.com/en/code-security/code-scanning/integrating-with-code-scanning/sarif-support-for-code-scanning
"""

import json
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from grader import __version__
from grader.base.extents import ended
from grader.base.source import Base, SourceOf
from grader.report.findings import (
    DOCUMENTATION,
    Finding,
    findings_in_inspection,
    fingerprints,
    message_in_repository,
    place_in_repository,
)
from grader.report.inspection import Inspection
from grader.report.json_data import to_json

if TYPE_CHECKING:
    from grader.lab.grading.report import Report

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_ROOT = "%SRCROOT%"  # of the repository, as GitHub calls it


def render_sarif(report: "Report", base: Base) -> str:
    """Return the findings of a report; their rules are criteria and kinds of problems."""
    from grader.report.mistakes import findings_in_report  # late: only a report has criteria

    return _log(findings_in_report(report), base, cache(report.submission.source))


def sarif_inspection(inspection: Inspection) -> str:
    """Return the findings of an inspection; their rules are kinds of problems."""
    return _log(findings_in_inspection(inspection), inspection.base, cache(inspection.source))


def _log(findings: Sequence[Finding], base: Base, source_of: SourceOf) -> str:
    """Return a log of one run, with the rules that have a result.

    Several rules may share a code, which is their id: `ruleIndex` says which of them is meant.
    """
    rules: dict[tuple[str, str], dict[str, Any]] = {}
    for finding in findings:
        rules.setdefault((finding.rule.id, finding.rule.name), _rule(finding))
    names = sorted(rules)
    results = []
    for finding, fingerprint in zip(findings, fingerprints(findings, base), strict=True):
        index = names.index((finding.rule.id, finding.rule.name))
        result = {
            "ruleId": finding.rule.id,
            "ruleIndex": index,
            "level": finding.severity,
            "message": {"text": message_in_repository(finding, base)},
            "locations": [{"physicalLocation": _physical_location(finding, base, source_of)}],
            "partialFingerprints": {"grader/v1": fingerprint},
        }
        results.append(result)
    driver = {
        "name": "grader",
        "version": __version__,
        "informationUri": DOCUMENTATION,
        "rules": [rules[name] for name in names],
    }
    tool = {"driver": driver}
    run = to_json({"tool": tool, "columnKind": "unicodeCodePoints", "results": results})
    start = f'{{\n "$schema": {json.dumps(_SCHEMA)},\n "version": "2.1.0",\n "runs": ['
    return f"{start}{run.rstrip()}]\n}}\n"


def _rule(finding: Finding) -> dict[str, Any]:
    """Return the rule of a finding; GitHub requires each of its texts."""
    rule = finding.rule
    data: dict[str, Any] = {
        "id": rule.id,
        "shortDescription": {"text": rule.title},
        "fullDescription": {"text": rule.explanation},
        "help": {"text": rule.explanation},
        "defaultConfiguration": {"level": finding.severity},
    }
    if rule.name:
        data["name"] = rule.name
    if rule.page:
        data["helpUri"] = rule.page
    return data


def _physical_location(finding: Finding, base: Base, source_of: SourceOf) -> dict[str, Any]:
    path, where = place_in_repository(finding, base)
    place: dict[str, Any] = {"artifactLocation": {"uri": quote(path), "uriBaseId": _ROOT}}
    if where is not None:
        end = ended(where, source_of)
        place["region"] = {
            "startLine": where.line,
            "startColumn": where.column,
            "endLine": end.end_line,
            "endColumn": end.end_column,
        }
    return place
