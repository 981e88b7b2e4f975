"""A report as annotations of its files for GitHub: failed criteria, most points first, then
unreported problems.

GitHub shows ten annotations of each type in a step and drops the others silently, so the last of a
type counts the rest.
https://docs.github.com/actions/reference/workflow-commands-for-github-actions
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from grader.base.extents import ended
from grader.base.problems import Severity
from grader.base.source import Base, Location
from grader.base.text import printable, without_tag_commands
from grader.lab.grading.report import Report
from grader.report.content import closing_lines, head, other_problems, report_sections, score_text
from grader.report.criteria import Entry, earned_text, is_failure, is_manual, remarks_on
from grader.report.inspection import Inspection, effect
from grader.report.locations import SourceOf, archive_around, location_text

_MAX_ANNOTATIONS = 10  # of each type
_MAX_MESSAGE = 4000  # characters
_COMMANDS: dict[Severity, str] = {"error": "error", "warning": "warning", "note": "notice"}


class _Finding(NamedTuple):
    """One thing to fix."""

    # what a mistake costs and its criteria, the id of a criterion, or the code of a problem
    title: str
    level: Severity
    text: str  # printable, of several lines
    place: Mapping[str, str] = {}  # without any the whole submission is meant


def render_github(report: Report, base: Base) -> str:
    """Return the annotations of a report: the score as a notice, then the findings, most points
    first.
    """
    found = [*_findings(report, base)]
    lines = [
        command(
            "notice",
            {},
            f"{score_text(report)}: {printable(report.rubric.title)}",
            _overview(report),
        )
    ]
    return "".join([*lines, *_limited(found, 1)])


def inspection_github(inspection: Inspection) -> str:
    """Return the annotations of an inspection: what ROS 2 does as a notice, then its problems,
    errors first.
    """
    found = [
        _Finding(
            problem.code,
            problem.severity,
            _annotation_text([printable(problem.message)], problem.location, inspection.base),
            _annotation_place(problem.location, inspection.source, inspection.base),
        )
        for problem in inspection.problems
    ]
    first = command("notice", {}, printable(inspection.path), effect(inspection))
    return "".join([first, *_limited(found, 1)])


def _limited(found: Sequence[_Finding], notices: int) -> Iterator[str]:
    """Yield at most as many annotations of each type as GitHub shows, besides some notices."""
    for level, name in _COMMANDS.items():
        some = [finding for finding in found if finding.level == level]
        room = _MAX_ANNOTATIONS - notices * (level == "note")
        listed = some if len(some) <= room else [*some[: room - 1], _rest_finding(some[room - 1 :])]
        yield from (command(name, one.place, one.title, one.text) for one in listed)


def _findings(report: Report, base: Base) -> Iterator[_Finding]:
    """Yield what to fix or grade manually, and remarks; `base` is where the submission is in its
    repository.
    """
    found, source_of = (
        report_sections(report),
        cache(report.submission.source),
    )  # reads each file once
    for entry in (*found.mistakes, *(one for one in found.pending if not is_manual(one.result))):
        yield _entry_finding(entry, source_of, base)
    for title, lines in (
        (found.unbuilt_title, [*found.unbuilt_lines]),
        ("Not found", [*found.missing]),
    ):
        if lines:
            yield _Finding(title, "note", "\n".join(line.text for line in lines))
    for result in report.results:
        remarks = remarks_on(result) if not is_failure(result) else ()
        if remarks:
            yield _Finding(result.criterion.id, "note", "\n".join(remarks))
    for problem in other_problems(report):
        where = problem.location
        text = _annotation_text([printable(problem.message)], where, base)
        yield _Finding(
            problem.code, problem.severity, text, _annotation_place(where, source_of, base)
        )


def _entry_finding(entry: Entry, source_of: SourceOf, base: Base) -> _Finding:
    is_mistake, where = bool(entry.lost) or is_failure(entry.result), entry.location
    lines = entry.texts(
        "finding", "comment", "hint", "feedback", "expected", "alike", "also", "skipped"
    )
    level: Severity = "error" if is_mistake else "warning"
    if entry.result.criterion.bonus:
        lines.append(f"Extra credit: {earned_text(entry.result)}.")
        level = "note"
    text, place = _annotation_text(lines, where, base), _annotation_place(where, source_of, base)
    return _Finding(f"{entry.cost}: {entry.names}" if is_mistake else entry.id, level, text, place)


def _annotation_place(where: Location | None, source_of: SourceOf, base: Base) -> Mapping[str, str]:
    """Return the properties of an annotation at a location, as seen from the root of the
    repository; empty without.
    """
    if where is None or base.is_outside:  # a file of the repository may have the same path
        return {}
    if archive := base.archive or archive_around(where.path):
        return {"file": printable(archive if base.archive else base.folder + archive)}
    where = ended(where, source_of)
    file, end_line = printable(base.folder + where.path), str(where.end_line)
    place = {"file": file, "line": str(where.line), "endLine": end_line}
    if where.end_line == where.line:  # GitHub takes the columns of a single line only
        place["col"] = str(where.column)
        place["endColumn"] = str(max(where.column, where.end_column - 1))
    return place


def _annotation_text(lines: list[str], where: Location | None, base: Base) -> str:
    """Return the lines, and the location where that is in a macro, or not in a file of the
    repository.
    """
    if where is not None and (
        base.archive or base.is_outside or archive_around(where.path) or where.calls
    ):
        lines = [*lines, f"In {location_text(where)}."]
    return "\n".join(lines)


def _rest_finding(found: Sequence[_Finding]) -> _Finding:
    text = "\n".join(("See the report for:", *dict.fromkeys(finding.title for finding in found)))
    return found[0]._replace(title=f"{len(found)} more", text=text, place={})


def _overview(report: Report) -> str:
    """Return the lines about the whole submission and the undecided criteria."""
    lines = [line.text for line in head(report)]  # first, because the rest may be cut off
    pending = ", ".join(result.criterion.id for result in report.results if result.is_open)
    if pending:
        lines.append(f"Needs manual grading: {pending}")
    lines += [line.text for line in report_sections(report).carried]
    return "\n".join((*lines, *closing_lines(report)))


def command(name: str, place: Mapping[str, str], title: str, text: str) -> str:
    """Return one annotation: `error`, `warning` or `notice` of printable text, with a line break at
    its end.
    """
    properties = [*place.items(), ("title", title)]
    listed = ",".join(
        f"{key}={_data(value).replace(':', '%3A').replace(',', '%2C')}" for key, value in properties
    )
    message = text if len(text) <= _MAX_MESSAGE else f"{text[:_MAX_MESSAGE]}..."
    return without_tag_commands(f"::{name} {listed}::{_data(message)}\n")


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
