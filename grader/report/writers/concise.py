"""One line for each finding, `path:line:column: CODE message`.

Editors, grep and problem matchers read them. The paths begin in the current folder; without a
finding there is no line.
"""

from collections.abc import Iterable

from grader.base.source import Base, SourceOf
from grader.base.text import printable
from grader.report.findings import Finding


def render_concise(findings: Iterable[Finding], base: Base, _: SourceOf) -> str:
    """Return the findings; those of a report have the ids of criteria in place of codes."""
    text = ""
    for finding in findings:
        where = finding.location
        path = printable(base.here + where.path) or "."
        text += f"{path}:{where.line}:{where.column}: {finding.rule.label} {finding.message}\n"
    return text
