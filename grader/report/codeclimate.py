"""A report as the part of Code Climate's JSON that GitLab shows with a merge request: one issue for each finding.

https://docs.gitlab.com/ci/testing/code_quality/#code-quality-report-format
"""

from grader.grading.report import Report
from grader.report.findings import Level, findings
from grader.report.json_data import to_json_list
from grader.report.locations import Base
from grader.text import counted_points, printable

_SEVERITIES: dict[Level, str] = {"error": "major", "warning": "minor", "note": "info"}


def render_codeclimate(report: Report, base: Base) -> str:
    """Return the findings of a report; an empty list if there is nothing to fix."""
    issues = []
    for finding in findings(report, base):
        location = finding.location or finding.fallback
        cost = f" ({counted_points(finding.lost)} lost)" if finding.lost else ""
        issues.append(
            {
                "description": finding.text.replace("\n", " ") + cost or finding.rule,
                "check_name": finding.rule,
                "fingerprint": finding.fingerprint,
                "severity": _SEVERITIES[finding.level],
                "location": {"path": printable(location.path), "lines": {"begin": location.line or 1}},
            }
        )
    return to_json_list(issues)
