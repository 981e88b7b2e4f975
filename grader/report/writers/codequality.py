"""Findings as a code quality report of GitLab, which merge requests show.

https://docs.gitlab.com/ci/testing/code_quality/#code-quality-report-format
"""

from collections.abc import Sequence

from grader.base.source import Base, SourceOf
from grader.report.findings import (
    Finding,
    fingerprints,
    message_in_repository,
    place_in_repository,
)
from grader.report.json_data import list_to_json

_SEVERITIES = {"error": "major", "warning": "minor", "note": "info"}


def render_codequality(findings: Sequence[Finding], base: Base, _: SourceOf) -> str:
    """Return the findings; those of a report have the ids of criteria as names of checks."""
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
            "location": {"path": path, "lines": {"begin": where.line if where else 1}},
        }
        issues.append(issue)
    return list_to_json(issues)
