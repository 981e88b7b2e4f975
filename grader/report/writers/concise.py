"""One line for each finding, `path:line:column: CODE message`.

Editors, grep and problem matchers read them. The paths begin in the current folder; without a
finding there is no line.
"""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from grader.base.source import Base
from grader.base.text import printable
from grader.report.findings import Finding, findings_in_inspection
from grader.report.inspection import Inspection

if TYPE_CHECKING:
    from grader.lab.grading.report import Report


def render_concise(report: "Report", base: Base) -> str:
    """Return the findings of a report, with the ids of criteria in place of codes."""
    from grader.report.mistakes import findings_in_report  # late: only a report has criteria

    return _lines(findings_in_report(report), base)


def concise_inspection(inspection: Inspection) -> str:
    """Return the findings of an inspection."""
    return _lines(findings_in_inspection(inspection), inspection.base)


def _lines(findings: Iterable[Finding], base: Base) -> str:
    text = ""
    for finding in findings:
        where = finding.location
        path = printable(base.here + where.path) or "."
        text += f"{path}:{where.line}:{where.column}: {finding.rule.label} {finding.message}\n"
    return text
