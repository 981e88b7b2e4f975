"""Findings as a code quality report of GitLab, which merge requests show.

https://docs.gitlab.com/ci/testing/code_quality/#code-quality-report-format
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from grader.base.problems import Severity
from grader.base.source import Base
from grader.report.findings import (
    Finding,
    findings_in_inspection,
    fingerprints,
    message_in_repository,
    place_in_repository,
)
from grader.report.inspection import Inspection
from grader.report.json_data import list_to_json

if TYPE_CHECKING:
    from grader.lab.grading.report import Report

_SEVERITIES: dict[Severity, str] = {"error": "major", "warning": "minor", "note": "info"}


def render_codequality(report: "Report", base: Base) -> str:
    """Return the findings of a report, with the ids of criteria as names of checks."""
    from grader.report.mistakes import findings_in_report  # late: only a report has criteria

    return _issues(findings_in_report(report), base)


def codequality_inspection(inspection: Inspection) -> str:
    """Return the findings of an inspection."""
    return _issues(findings_in_inspection(inspection), inspection.base)


def _issues(findings: Sequence[Finding], base: Base) -> str:
    issues = []
    for finding, fingerprint in zip(findings, fingerprints(findings, base), strict=True):
        path, where = place_in_repository(finding, base)
        description = message_in_repository(finding, base)
        if finding.rule.name:
            description = f"{finding.rule.label}: {description}"
        issue = {
            "description": description,
            "check_name": finding.rule.id,
            "fingerprint": fingerprint,
            "severity": _SEVERITIES[finding.severity],
            "location": {"path": path, "lines": {"begin": where.line if where is not None else 1}},
        }
        issues.append(issue)
    return list_to_json(issues)
