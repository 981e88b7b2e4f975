"""What is wrong in a report or an inspection, as findings with a place each: what editors and CI
systems list.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from grader.base.problems import Problem, Severity
from grader.base.source import Base, Location
from grader.base.text import printable
from grader.files.reading import sha256_of
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.criterion import Criterion
from grader.report.content import entries, other_problems, report_sections
from grader.report.criteria import Entry, is_absent, is_failure, points_of, sentence
from grader.report.examples import explanation_of
from grader.report.inspection import Inspection
from grader.report.locations import archive_around, calls_text, location_text

_NUMBER_OF_LINE = r"\blines? \d+(?:(?:, | and )\d+)*|:\d+"
DOCUMENTATION = "https://urdf-grader.github.io/urdf-grader/"


class _Rule(NamedTuple):
    """What a finding is a case of: a kind of problem, or a criterion."""

    id: str  # the code or the id
    title: str
    explanation: str
    page: str  # of the documentation; empty without one
    name: str = ""  # of a rule of workspaces


class Finding(NamedTuple):
    """One thing that is wrong, with the place to look at."""

    rule: _Rule
    severity: Severity
    message: str  # printable, in one line
    location: Location


def findings_in_report(report: Report) -> list[Finding]:
    """Return the criteria that lose points or cannot be decided, and the other problems, in the
    order of their places.
    """
    found = [_problem_finding(problem) for problem in other_problems(report)]
    undecided = {result.criterion.id for result in report.pending_automatic}
    for entry in entries(report).values():
        is_mistake = is_failure(entry.result) and not entry.result.why_given
        if is_mistake or entry.id in undecided:
            found.append(_criterion_finding(entry, report))
    return sorted(found, key=_place)


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
    found = [
        _mistake(entry, report)
        for entry in (*sections.mistakes, *sections.unbuilt)
        if is_failure(entry.result)
    ]
    known = entries(report)
    for result in report.pending_automatic:
        entry = known[result.criterion.id]
        mistake = _mistake(entry, report)
        found.append(mistake._replace(cost=points_of([result])))
    return found


def _mistake(entry: Entry, report: Report) -> Mistake:
    besides = []
    for other in entry.also:
        message = " ".join(other.texts("finding", "comment"))
        besides.append(_criterion_finding(other, report)._replace(message=message))
    reported = set()
    for result in entry.results:
        at, problem = result.outcome.location, result.outcome.problem or result.outcome.message
        if at is not None:
            reported.add((printable(problem) + calls_text(at), at))
    return Mistake(
        _criterion_finding(entry, report),
        tuple(besides),
        frozenset(reported),
        " ".join(entry.texts("comment", "hint")),
        entry.cost,
        entry.names,
    )


def findings_in_inspection(inspection: Inspection) -> list[Finding]:
    """Return the problems of robots and packages, in the order of their places."""
    return sorted(map(_problem_finding, inspection.problems), key=_place)


def _place(finding: Finding) -> tuple[str, int, int]:
    return finding.location[:3]


def _problem_finding(problem: Problem) -> Finding:
    kind, where = problem.kind, problem.location
    page = f"{DOCUMENTATION}problems.html#{kind.code.lower()}"
    rule = _Rule(kind.code, kind.title, explanation_of(kind), page, problem.rule)
    return Finding(rule, kind.severity, printable(problem.message) + calls_text(where), where)


def _criterion_finding(entry: Entry, report: Report) -> Finding:
    """Return the finding of a criterion: what was found, and the hint."""
    result = entry.result
    severity: Severity = "error"
    if result.criterion.bonus or is_absent(result):
        severity = "note"
    elif not is_failure(result):
        severity = "warning"
    where = entry.location or result.outcome.location or Location(_main_file(result, report), 1, 1)
    message = " ".join(entry.texts("finding", "comment", "hint")) + calls_text(where)
    return Finding(_criterion_rule(result.criterion), severity, message, where)


def _criterion_rule(criterion: Criterion) -> _Rule:
    title = f"Passes when: {sentence(criterion.title)}"
    page = ""
    if not criterion.check.distribution:
        page = f"{DOCUMENTATION}checks.html#{criterion.check.name}"
    return _Rule(criterion.id, title, title, page)


def _main_file(result: Result, report: Report) -> str:
    """Return the file to look at if a criterion has no place: the package's or the URDF; empty
    without both.
    """
    package = report.submission.package
    if package is not None and result.criterion.check.subject not in ("urdf", "robot"):
        return package.path("package.xml")
    return report.submission.path or ""


def place_in_repository(finding: Finding, base: Base) -> tuple[str, Location | None]:
    """Return the file of a finding from the root of the repository, and where to look in it; of one
    in an archive the archive, and None.
    """
    path = finding.location.path
    archive = base.archive or archive_around(path)
    if not archive:
        return printable(base.folder + path) or ".", finding.location
    return printable(base.archive or base.folder + archive), None


def message_in_repository(finding: Finding, base: Base) -> str:
    """Return the message of a finding; of one in an archive with the place in it."""
    if base.archive or archive_around(finding.location.path):
        return f"{sentence(finding.message)} In {location_text(finding.location)}."
    return finding.message


def fingerprints(findings: Iterable[Finding], base: Base) -> Iterator[str]:
    """Yield what identifies each finding in later runs: it does not change with the line, and no
    two have the same.
    """
    counts = Counter[str]()
    for finding in findings:
        path, _ = place_in_repository(finding, base)
        text = f"{path}\0{finding.rule.id}\0{re.sub(_NUMBER_OF_LINE, '', finding.message)}"
        counts[text] += 1
        yield sha256_of(f"{text}\0{counts[text]}".encode("utf-8", "backslashreplace"))
