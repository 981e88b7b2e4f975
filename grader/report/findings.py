"""The findings of a report: failed criteria, most points first, then problems that no criterion has reported."""

import hashlib
from collections import Counter
from collections.abc import Iterator
from decimal import Decimal
from functools import cache
from typing import Literal, NamedTuple

from grader.grading.report import Hint, Report, Result
from grader.report.content import other_problems
from grader.report.details import remarks_on, result_details, sentence
from grader.report.locations import RepositoryLocation, SourceOf, archive_around, in_repository, location_text
from grader.report.order import FailedCriterion, earned_text, failures, is_failure, points_of
from grader.source import Base, Location
from grader.text import counted_points, printable

Level = Literal["error", "warning", "note"]
_ORDER: tuple[Level, ...] = ("error", "warning", "note")


class Finding(NamedTuple):
    """One thing to fix.

    `rule` is the id of the criterion or the code of the problem, `text` is printable and has several lines, `lost`
    includes the points of criteria that are skipped because of it. `location` is None where the whole submission is
    meant; `fallback` is the location for formats that require one. `fingerprint` does not depend on the number of the
    line. `hint` is a change that fixes it.
    """

    rule: str
    level: Level
    text: str
    location: RepositoryLocation | None
    fallback: RepositoryLocation
    lost: Decimal = Decimal(0)
    hint: Hint | None = None
    fingerprint: str = ""

    @property
    def cost(self) -> str:
        """The lost points between parentheses; empty if none are lost."""
        return f" ({counted_points(self.lost)} lost)" if self.lost else ""


def findings(report: Report, base: Base) -> list[Finding]:
    """Return the findings of a submission; `base` is where that is in its repository."""
    source_of = cache(report.submission.source)  # reads each file once
    found = [_of_criterion(failure, report, source_of, base) for failure in failures(report)]
    found += _undecided_finding(report, base)
    found += _remarks(report, base)
    for problem in sorted(other_problems(report), key=lambda problem: _ORDER.index(problem.severity)):
        text = _text([printable(problem.message)], problem.location, base)
        location = in_repository(problem.location, source_of(problem.location.path), base)
        found.append(Finding(problem.code, problem.severity, text, location, location))
    seen: Counter[str] = Counter()
    return [finding._replace(fingerprint=_fingerprint(finding, seen)) for finding in found]


def _fallback(report: Report, base: Base, *results: Result) -> RepositoryLocation:
    """Return the location for a finding without one: the URDF, the package.xml, or the submission's folder."""
    submission = report.submission
    path, of_package = submission.path, all(result.criterion.check.subject == "package" for result in results)
    if submission.package is not None and (of_package or path is None):
        path = f"{submission.package.folder}/package.xml".lstrip("/")
    place = base.folder + path if path is not None else base.folder.rstrip("/")
    return RepositoryLocation(base.archive or place or ".")


def _of_criterion(failure: FailedCriterion, report: Report, source_of: SourceOf, base: Base) -> Finding:
    result, skipped, is_bonus = failure.result, failure.skipped, failure.result.criterion.bonus
    details = result_details(result, report)
    lines = [*details.words, *details.advice, details.expected]
    lines += [f"Extra credit: {earned_text(result)}."] if is_bonus else []
    lines += [f"Skipped because of it: {len(skipped)} more, {points_of(skipped)}."] if skipped else []
    where = details.location
    location = in_repository(where, source_of(where.path), base) if where is not None else None
    level: Level = "note" if result.why_given or is_bonus else "error"
    fallback = location or _fallback(report, base, result)
    return Finding(failure.id, level, _text(lines, where, base), location, fallback, failure.lost, details.hint)


def _undecided_finding(report: Report, base: Base) -> Iterator[Finding]:
    """Yield one finding for all automatic criteria that need manual grading here, with the reasons."""
    results = report.pending_automatic
    if results:
        reasons = dict.fromkeys(sentence(result.outcome.message) for result in results)
        names = ", ".join(result.criterion.id for result in results)
        text = "\n".join((*reasons, f"Could not be decided ({points_of(results)}): {names}"))
        yield Finding(results[0].criterion.id, "warning", text, None, _fallback(report, base, *results))


def _remarks(report: Report, base: Base) -> Iterator[Finding]:
    """Yield a note for each criterion that is adjusted, or has a comment and is no failure."""
    for result in report.results:
        remarks = remarks_on(result, report) if not is_failure(result) else ()
        if remarks:
            yield Finding(result.criterion.id, "note", "\n".join(remarks), None, _fallback(report, base, result))


def _text(lines: list[str], where: Location | None, base: Base) -> str:
    """Return the lines, and the location where that is in a macro, or not in a file of the repository."""
    is_hidden = where is not None and (base.archive or base.is_outside or archive_around(where.path) or where.calls)
    return "\n".join((*lines, *([f"In {location_text(where)}."] if where is not None and is_hidden else [])))


def _fingerprint(finding: Finding, seen: Counter[str]) -> str:
    location = finding.location
    parts = (finding.rule, location.path, location.text) if location is not None else (finding.rule, "", "")
    digest = hashlib.sha256("\0".join(parts).encode("utf-8", "surrogatepass")).hexdigest()[:16]
    seen[digest] += 1
    return f"{digest}:{seen[digest]}"
