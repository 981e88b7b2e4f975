"""The findings of a report: failed criteria, most points first, then problems that no criterion has reported."""

import hashlib
from collections import Counter
from collections.abc import Callable, Iterator
from decimal import Decimal
from functools import cache
from typing import Literal, NamedTuple

from grader.grading.report import Hint, Report
from grader.report.content import earned_text, other_problems, points_of, undecided
from grader.report.details import location_text, result_details, sentence
from grader.report.locations import Base, RepositoryLocation, archive_around, in_repository
from grader.report.order import Failure, failures, is_failure
from grader.source import Location, Source
from grader.text import printable

Level = Literal["error", "warning", "note"]
_ORDER: tuple[Level, ...] = ("error", "warning", "note")


class Finding(NamedTuple):
    """One thing to fix.

    `rule` is the id of the criterion or the code of the problem, `text` is printable and has several lines, `lost` includes the
    points of criteria that are skipped because of it. `location` is None where the whole submission is meant; `fallback` is the
    location for formats that require one. `fingerprint` does not depend on the number of the line. `hints` are changes that fix it.
    """

    rule: str
    level: Level
    text: str
    lost: Decimal
    location: RepositoryLocation | None
    fallback: RepositoryLocation
    fingerprint: str = ""
    hints: tuple[Hint, ...] = ()


def findings(report: Report, base: Base) -> list[Finding]:
    """Return the findings of a submission; `base` is where that is in its repository."""
    source_of = cache(report.submission.source)  # reads each file once
    found = [_of_criterion(failure, report, source_of, base) for failure in failures(report)]
    found += _undecided(report, base)
    found += _remarks(report, base)
    for problem in sorted(other_problems(report), key=lambda problem: _ORDER.index(problem.severity)):
        text = _text((printable(problem.message),), problem.location, base)
        location = in_repository(problem.location, source_of(problem.location.path), base)
        found.append(Finding(problem.code, problem.severity, text, Decimal(0), location, location))
    seen: Counter[str] = Counter()
    return [finding._replace(fingerprint=_fingerprint(finding, seen)) for finding in found]


def _fallback(report: Report, base: Base, *, of_package: bool) -> RepositoryLocation:
    """Return the location for a finding without one: the URDF, the package.xml, or the submission's folder."""
    submission = report.submission
    path = submission.path
    if submission.package is not None and (of_package or path is None):
        path = f"{submission.package.folder}/package.xml".lstrip("/")
    return RepositoryLocation(
        base.archive or (base.folder + path if path is not None else base.folder.rstrip("/")) or "."
    )


def _of_criterion(failure: Failure, report: Report, source_of: Callable[[str], Source | None], base: Base) -> Finding:
    result = failure.result
    criterion, details = result.criterion, result_details(result, report)
    lines = [*details.words, *details.advice, details.expected]
    if criterion.bonus:
        lines.append(f"Extra credit: {earned_text((result,))}.")
    if failure.skipped:
        lines.append(f"Skipped because of it: {len(failure.skipped)} more, {points_of(failure.skipped)}.")
    where = details.location
    location = in_repository(where, source_of(where.path), base) if where is not None else None
    fallback = location or _fallback(report, base, of_package=criterion.check.subject == "package")
    level: Level = "note" if result.why_given or criterion.bonus else "error"
    text = _text(tuple(lines), where, base)
    return Finding(criterion.id, level, text, failure.lost, location, fallback, hints=details.hints)


def _undecided(report: Report, base: Base) -> Iterator[Finding]:
    """Yield one finding for all automatic criteria that need manual grading here, with the reasons."""
    results = undecided(report)
    if results:
        points = points_of(results)
        reasons = dict.fromkeys(sentence(result.outcome.message) for result in results)
        names = ", ".join(result.criterion.id for result in results)
        text = "\n".join((*reasons, f"Could not be decided ({points}): {names}"))
        is_package = all(result.criterion.check.subject == "package" for result in results)
        fallback = _fallback(report, base, of_package=is_package)
        yield Finding(results[0].criterion.id, "warning", text, Decimal(0), None, fallback)


def _remarks(report: Report, base: Base) -> Iterator[Finding]:
    """Yield a note for each criterion that is adjusted, or has a comment and is no failure."""
    for result in report.results:
        if is_failure(result) or not (result.is_adjusted or result.comment):
            continue
        details, criterion = result_details(result, report), result.criterion
        words = details.words if result.is_adjusted else (details.comment,)
        fallback = _fallback(report, base, of_package=criterion.check.subject == "package")
        yield Finding(criterion.id, "note", "\n".join(words), Decimal(0), None, fallback)


def _text(lines: tuple[str, ...], where: Location | None, base: Base) -> str:
    """Return the lines, and the location as well where that is in a macro, or not in a file of the repository."""
    is_file = where is None or not (base.archive or base.is_outside or archive_around(where.path) or where.calls)
    inside = () if is_file or where is None else (f"In {location_text(where)}.",)
    return "\n".join((*lines, *inside))


def _fingerprint(finding: Finding, seen: Counter[str]) -> str:
    location = finding.location
    parts = (finding.rule, location.path, location.text) if location is not None else (finding.rule, "", "")
    digest = hashlib.sha256("\0".join(parts).encode("utf-8", "surrogatepass")).hexdigest()[:16]
    seen[digest] += 1
    return f"{digest}:{seen[digest]}"
