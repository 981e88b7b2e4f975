"""What is wrong in a report or an inspection, as findings with a place each.

Editors and CI systems list them.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator

from grader.base.problems import NO_FIXES, Fixes, Problem, Severity
from grader.base.records import Named
from grader.base.source import Base, Location
from grader.base.text import printable, sentence
from grader.files.reading import hash_bytes
from grader.report.examples import explain_kind
from grader.report.inspection import Inspection
from grader.report.locations import archive_around, location_text, message_at

_NUMBER_OF_LINE = r"\blines? \d+(?:(?:, | and )\d+)*|:\d+"
DOCUMENTATION = "https://urdf-grader.github.io/urdf-grader/"


class FindingKind(Named):
    """What a finding is a case of: a kind of problem, or a criterion."""

    id: str  # the code or the id
    title: str
    explanation: str
    page: str  # of the documentation; empty without one
    name: str = ""  # of a rule of workspaces

    @property
    def label(self) -> str:
        """Its code or id and the name of its rule: REF003 controller-defined."""
        return f"{self.id} {self.name}".rstrip()


class Finding(Named):
    """One thing that is wrong, with the place to look at."""

    rule: FindingKind
    severity: Severity
    message: str  # printable, in one line
    location: Location
    related: Location | None = None  # of what it is compared with
    fixes: Fixes = NO_FIXES  # of a problem, for editors alone
    cause: str = ""  # what it has in common with others that one mistake makes; for editors, too


def findings_in_inspection(inspection: Inspection) -> list[Finding]:
    """Return the problems of robots and packages, in the order of their places."""
    return sorted(map(finding_of_problem, inspection.problems), key=sort_key)


def sort_key(finding: Finding) -> tuple[str, int, int]:
    """Return the path, line and column of a finding, by which findings are sorted."""
    return finding.location[:3]


def finding_of_problem(problem: Problem) -> Finding:
    """Return the finding of a problem of a file; its rule is the kind of problem."""
    kind = problem.kind
    where = problem.location
    page = f"{DOCUMENTATION}problems.html#{kind.code.lower()}"
    rule = FindingKind(kind.code, kind.title, explain_kind(kind), page, problem.rule)
    message = message_at(printable(problem.message), where)
    return Finding(
        rule, kind.severity, message, where, problem.related, problem.fixes, problem.cause
    )


def place_in_repository(finding: Finding, base: Base) -> tuple[str, Location | None]:
    """Return the file of a finding from the root of the repository, and where to look.

    Of a file in an archive, return the archive, and None.
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
    """Yield what identifies each finding in later runs.

    It does not change with the line, and no two have the same.
    """
    counts = Counter[str]()
    for finding in findings:
        path, _ = place_in_repository(finding, base)
        text = f"{path}\0{finding.rule.id}\0{re.sub(_NUMBER_OF_LINE, '', finding.message)}"
        counts[text] += 1
        yield hash_bytes(f"{text}\0{counts[text]}".encode("utf-8", "backslashreplace"))
