"""A report as annotations of its files: workflow commands for GitHub, and Code Climate's JSON for GitLab.

GitHub shows ten annotations of each type in a step and drops the others silently, so the last of a type counts the
rest.
https://docs.github.com/actions/reference/workflow-commands-for-github-actions
https://docs.gitlab.com/ci/testing/code_quality/#code-quality-report-format
"""

from collections.abc import Iterator, Sequence
from decimal import Decimal

from grader.grading.report import Report
from grader.report.content import note_lines, provenance, score_text, summary_lines
from grader.report.findings import Finding, Level, findings
from grader.report.json_data import to_json_list
from grader.report.locations import RepositoryLocation
from grader.report.order import alike, status_of
from grader.source import Base
from grader.text import printable

_MAX_ANNOTATIONS = 10  # of each type
_MAX_MESSAGE = 4000  # characters
# The names of each level: GitHub's command, Code Climate's severity.
_NAMES: dict[Level, tuple[str, str]] = {
    "error": ("error", "major"),
    "warning": ("warning", "minor"),
    "note": ("notice", "info"),
}


def render_github(report: Report, base: Base) -> str:
    """Return the annotations of a report: the score as a notice, then the findings, most points first."""
    found = findings(report, base)
    if base.is_outside:  # a file of the repository may have the same path
        found = [finding._replace(location=None) for finding in found]
    lines = [command("notice", None, f"{score_text(report)}: {printable(report.rubric.title)}", _overview(report))]
    for level, (name, _) in _NAMES.items():
        some = [finding for finding in found if finding.level == level]
        room = _MAX_ANNOTATIONS - (level == "note")
        listed = some if len(some) <= room else [*some[: room - 1], _rest(some[room - 1 :])]
        lines += [command(name, one.location, f"{one.rule}{one.cost}", one.text) for one in listed]
    return "".join(lines)


def _rest(found: Sequence[Finding]) -> Finding:
    names = ", ".join(dict.fromkeys(finding.rule for finding in found))
    lost = sum((finding.lost for finding in found), Decimal(0))
    text = f"See the report for: {names}"
    return found[0]._replace(rule=f"{len(found)} more", text=text, lost=lost, location=None)


def _overview(report: Report) -> str:
    """Return the lines about the whole submission and the undecided criteria."""
    pending = ", ".join(result.criterion.id for result in report.results if result.is_open)
    skipped = alike((one for one in report.results if status_of(one) == "skipped"), lambda one: one.because or "")
    lines = [*summary_lines(report), provenance(report)]  # first, because the rest may be cut off
    lines += [f"Needs manual grading: {pending}"] if pending else []
    for cause, results in skipped:
        names = ", ".join(result.criterion.id for result in results)
        lines += [f"Skipped because {cause} failed: {names}"] if cause else []
    lines += [f"{result.criterion.id}: {result.why_given}" for result in report.results if result.carried]
    return "\n".join((*lines, *note_lines(report)))


def command(name: str, location: RepositoryLocation | None, title: str, text: str) -> str:
    """Return one annotation: `error`, `warning` or `notice` of printable text, with a line break at its end."""
    properties = [*_position(location), ("title", title)]
    listed = ",".join(f"{key}={_data(value).replace(':', '%3A').replace(',', '%2C')}" for key, value in properties)
    message = text if len(text) <= _MAX_MESSAGE else f"{text[:_MAX_MESSAGE]}..."
    return f"::{name} {listed}::{_data(message)}\n"


def _position(location: RepositoryLocation | None) -> Iterator[tuple[str, str]]:
    if location is not None:
        yield "file", printable(location.path)
        if location.line is not None:
            last = max(location.column, location.end - 1)
            yield from (("line", str(location.line)), ("endLine", str(location.line)))
            yield from (("col", str(location.column)), ("endColumn", str(last)))


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def render_codeclimate(report: Report, base: Base) -> str:
    """Return the findings of a report; an empty list if there is nothing to fix."""
    return to_json_list([_issue(finding, finding.location or finding.fallback) for finding in findings(report, base)])


def _issue(finding: Finding, location: RepositoryLocation) -> dict[str, object]:
    return {
        "description": finding.text.replace("\n", " ") + finding.cost or finding.rule,
        "check_name": finding.rule,
        "fingerprint": finding.fingerprint,
        "severity": _NAMES[finding.level][1],
        "location": {"path": printable(location.path), "lines": {"begin": location.line or 1}},
    }
