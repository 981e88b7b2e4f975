"""The findings of a report: criteria that lose points or cannot be decided, and other problems."""

from typing import NamedTuple

from grader.base.problems import Severity
from grader.base.source import Location
from grader.base.text import printable, sentence
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.criterion import Criterion
from grader.report.content import entries, other_problems, report_sections
from grader.report.criteria import Entry, is_absent, is_failure, write_points
from grader.report.findings import DOCUMENTATION, Finding, FindingKind, finding_of_problem, sort_key
from grader.report.locations import message_at


def findings_in_report(report: Report) -> list[Finding]:
    """Return the mistakes and other problems of a report, in the order of their places.

    Mistakes are the criteria that lose points or cannot be decided.
    """
    findings = [finding_of_problem(problem) for problem in other_problems(report)]
    undecided = {result.id for result in report.pending_automatic}
    for entry in entries(report).values():
        is_mistake = is_failure(entry.result) and not entry.result.why_given
        if is_mistake or entry.id in undecided:
            findings.append(_criterion_finding(entry, report))
    return sorted(findings, key=sort_key)


class Mistake(NamedTuple):
    """One mistake, with all criteria that fail because of it."""

    finding: Finding  # of the criterion that shows it
    besides: tuple[Finding, ...]  # of the other criteria that fail by it
    # messages and places of the problems of files that these report
    reported: frozenset[tuple[str, Location]]
    advice: str  # the hint, and a grader's comment
    cost: str  # in all: -8 points
    names: str  # of the criteria that cost these: lidar-frame 6, lidar-on-top 2


def mistakes_in_report(report: Report) -> list[Mistake]:
    """Return the mistakes in the order of a report, then the criteria that cannot be decided."""
    sections = report_sections(report)
    mistakes = [
        _mistake(entry, report)
        for entry in sections.mistakes + sections.unbuilt
        if is_failure(entry.result)
    ]
    known = entries(report)
    for result in report.pending_automatic:
        entry = known[result.id]
        mistake = _mistake(entry, report)
        mistakes.append(mistake._replace(cost=write_points([result])))
    return mistakes


def _mistake(entry: Entry, report: Report) -> Mistake:
    besides = []
    for other in entry.also:
        message = " ".join(other.texts("finding", "comment"))
        besides.append(_criterion_finding(other, report)._replace(message=message))
    reported = set()
    for result in entry.results:
        at = result.outcome.location
        problem = result.outcome.problem or result.outcome.message
        if at:
            reported.add((message_at(printable(problem), at), at))
    return Mistake(
        _criterion_finding(entry, report),
        tuple(besides),
        frozenset(reported),
        " ".join(entry.texts("comment", "hint")),
        entry.cost,
        entry.names,
    )


def _criterion_finding(entry: Entry, report: Report) -> Finding:
    """Return the finding of a criterion: what was found, and the hint."""
    result = entry.result
    severity: Severity = "error"
    if result.criterion.bonus or is_absent(result):
        severity = "note"
    elif not is_failure(result):
        severity = "warning"
    where = entry.location or result.outcome.location or Location(_main_file(result, report), 1, 1)
    message = message_at(" ".join(entry.texts("finding", "comment", "hint")), where)
    return Finding(_criterion_rule(result.criterion), severity, message, where)


def _criterion_rule(criterion: Criterion) -> FindingKind:
    title = f"Passes when: {sentence(criterion.title)}"
    page = ""
    if not criterion.check.distribution:
        page = f"{DOCUMENTATION}checks.html#{criterion.check.name}"
    return FindingKind(criterion.id, title, title, page)


def _main_file(result: Result, report: Report) -> str:
    """Return the file to look at if a criterion has no place: the package's or the URDF.

    It is empty without both.
    """
    package = report.submission.package
    if package and not result.criterion.check.is_of_robot:
        return package.path("package.xml")
    return report.submission.path or ""
