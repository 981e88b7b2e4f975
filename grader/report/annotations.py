"""A report as annotations of its files: workflow commands for GitHub, and Code Climate's JSON for a merge request on GitLab.

GitHub shows ten annotations of each type in a step and drops the others silently, so the last one of a type counts the rest.
https://docs.github.com/actions/reference/workflow-commands-for-github-actions
https://docs.gitlab.com/ci/testing/code_quality/#code-quality-report-format
"""

from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal

from grader.grading.report import Report
from grader.report.content import score_text
from grader.report.findings import Finding, Level, findings
from grader.report.json_data import to_json_list
from grader.report.locations import Base, RepositoryLocation
from grader.report.plain_text import note_lines, provenance, summary_lines
from grader.text import counted_points, printable

_MAX_ANNOTATIONS = 10  # of each type
_MAX_MESSAGE = 4000  # characters
_COMMANDS: dict[Level, str] = {"error": "error", "warning": "warning", "note": "notice"}


def render_github(report: Report, base: Base) -> str:
    """Return the annotations of a report: the score as a notice, then the findings, most points first."""
    found = findings(report, base)
    if base.is_outside:  # a file of the repository may have the same path
        found = [finding._replace(location=None) for finding in found]
    lines = [command("notice", None, f"{score_text(report)}: {printable(report.rubric.title)}", _overview(report))]
    for level in _COMMANDS:
        some = [finding for finding in found if finding.level == level]
        lines += _annotations(level, some, room=_MAX_ANNOTATIONS - (level == "note"))
    return "".join(lines)


def _annotations(level: Level, found: Sequence[Finding], room: int) -> Iterator[str]:
    shown = found if len(found) <= room else found[: room - 1]
    for finding in shown:
        yield command(_COMMANDS[level], finding.location, f"{finding.rule}{_cost(finding.lost)}", finding.text)
    rest = found[len(shown) :]
    if rest:
        names = ", ".join(dict.fromkeys(finding.rule for finding in rest))
        cost = _cost(sum((finding.lost for finding in rest), Decimal(0)))
        yield command(_COMMANDS[level], None, f"{len(rest)} more{cost}", f"See the report for: {names}")


def _cost(lost: Decimal) -> str:
    return f" ({counted_points(lost)} lost)" if lost else ""


def _overview(report: Report) -> str:
    """Return the lines about the whole submission and the undecided criteria."""
    pending = [result.criterion.id for result in report.results if result.is_open]
    lines = [*summary_lines(report), provenance(report)]  # first, because the rest may be cut off
    if pending:
        lines.append(f"Needs manual grading: {', '.join(pending)}")
    skipped: dict[str, list[str]] = {}
    for result in report.results:
        if result.because is not None and result.manual_mark is None and not result.is_adjusted:
            skipped.setdefault(result.because, []).append(result.criterion.id)
    lines += [f"Skipped because {cause} failed: {', '.join(names)}" for cause, names in skipped.items()]
    lines += [f"{result.criterion.id}: {result.why_given}" for result in report.results if result.carried]
    return "\n".join((*lines, *note_lines(report)))


def command(name: str, location: RepositoryLocation | None, title: str, text: str) -> str:
    """Return one annotation: `error`, `warning` or `notice` of printable text, with a line break at its end."""
    properties = [*_position(location), ("title", title)]
    listed = ",".join(f"{key}={_data(value).replace(':', '%3A').replace(',', '%2C')}" for key, value in properties)
    message = text if len(text) <= _MAX_MESSAGE else f"{text[:_MAX_MESSAGE]}..."
    return f"::{name} {listed}::{_data(message)}\n"


def _position(location: RepositoryLocation | None) -> Iterable[tuple[str, str]]:
    if location is not None:
        yield "file", printable(location.path)
    if location is not None and location.line is not None:
        yield from (("line", str(location.line)), ("endLine", str(location.line)))
        yield from (("col", str(location.column)), ("endColumn", str(max(location.column, location.end - 1))))


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


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
