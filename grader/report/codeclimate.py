"""A report as the part of Code Climate's JSON that GitLab shows beside a merge request: one issue for each finding.

https://docs.gitlab.com/ci/testing/code_quality/#code-quality-report-format
"""

from grader.grading.report import Report
from grader.report.findings import Level, findings
from grader.report.json_data import to_json_list
from grader.report.locations import Base
from grader.text import counted_points, printable

_SEVERITIES: dict[Level, str] = {"error": "major", "warning": "minor", "note": "info"}


def render_codeclimate(report: Report, base: Base) -> str:
    """The findings of a report; an empty list where there is nothing to mend."""
    issues = []
    for each in findings(report, base):
        place = each.place or each.whole
        cost = f" ({counted_points(each.lost)} lost)" if each.lost else ""
        issues.append(
            {
                "description": each.text.replace("\n", " ") + cost,
                "check_name": each.rule,
                "fingerprint": each.fingerprint,
                "severity": _SEVERITIES[each.level],
                "location": {"path": printable(place.path), "lines": {"begin": place.line or 1}},
            }
        )
    return to_json_list(issues)
