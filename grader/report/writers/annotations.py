"""A report as annotations of its files for GitHub.

Failed criteria come first, most points first, then unreported problems.

GitHub shows ten annotations of each type in a step and drops the others silently, so the last of a
type counts the rest.
https://docs.github.com/actions/reference/workflow-commands-for-github-actions
"""

from collections.abc import Iterator
from functools import cache

from grader.base.problems import Severity
from grader.base.source import Base, SourceOf
from grader.base.text import printable
from grader.lab.grading.report import Report
from grader.report.content import closing_lines, head, other_problems, report_sections, score_text
from grader.report.criteria import Entry, earned_text, is_failure, is_manual, remarks_on
from grader.report.writers.workflow_commands import (
    Annotation,
    annotation_place,
    annotation_text,
    command,
    limited_annotations,
)


def render_github(report: Report, base: Base) -> str:
    """Return the annotations of a report.

    The score is a notice, then come the findings, most points first.
    """
    findings = list(_findings(report, base))
    lines = [
        command(
            "notice",
            {},
            f"{score_text(report)}: {printable(report.rubric.title)}",
            _overview(report),
        )
    ]
    return "".join([*lines, *limited_annotations(findings, 1)])


def _findings(report: Report, base: Base) -> Iterator[Annotation]:
    """Yield what to fix or grade manually, and remarks.

    `base` is where the submission is in its repository.
    """
    sections, source_of = (
        report_sections(report),
        cache(report.submission.source),
    )  # reads each file once
    for entry in (
        *sections.mistakes,
        *(one for one in sections.pending if not is_manual(one.result)),
    ):
        yield _entry_finding(entry, source_of, base)
    for title, lines in (
        (sections.unbuilt_title, list(sections.unbuilt_lines)),
        ("Not found", list(sections.missing)),
    ):
        if lines:
            yield Annotation(title, "note", "\n".join(line.text for line in lines))
    for result in report.results:
        remarks = remarks_on(result) if not is_failure(result) else ()
        if remarks:
            yield Annotation(result.id, "note", "\n".join(remarks))
    yield from _problem_findings(report, source_of, base)


def _problem_findings(report: Report, source_of: SourceOf, base: Base) -> Iterator[Annotation]:
    """Yield the problems that no criterion has reported."""
    for problem in other_problems(report):
        where = problem.location
        text = annotation_text([printable(problem.message)], where, base)
        yield Annotation(
            problem.label, problem.severity, text, annotation_place(where, source_of, base)
        )


def _entry_finding(entry: Entry, source_of: SourceOf, base: Base) -> Annotation:
    is_mistake = bool(entry.lost) or is_failure(entry.result)
    where = entry.location
    lines = entry.texts(
        "finding", "comment", "hint", "feedback", "expected", "alike", "also", "skipped"
    )
    level: Severity = "error" if is_mistake else "warning"
    if entry.result.criterion.bonus:
        lines.append(f"Extra credit: {earned_text(entry.result)}.")
        level = "note"
    text = annotation_text(lines, where, base)
    place = annotation_place(where, source_of, base)
    title = f"{entry.cost}: {entry.names}" if is_mistake else entry.id
    return Annotation(title, level, text, place)


def _overview(report: Report) -> str:
    """Return the lines about the whole submission and the undecided criteria."""
    sections = report_sections(report)
    lines = [line.text for line in head(report, sections)]  # first, because the rest may be cut off
    pending = ", ".join(result.id for result in report.results if result.is_open)
    if pending:
        lines.append(f"Needs manual grading: {pending}")
    lines += [line.text for line in sections.carried]
    return "\n".join(lines + closing_lines(report))
