"""What has to be mended, one finding each: what costs points, the most first, then problems that no criterion has told."""

import hashlib
from collections import Counter
from collections.abc import Callable, Iterator
from decimal import Decimal
from functools import cache
from typing import Literal, NamedTuple

from grader.grading.report import Report, Result
from grader.report.content import location_text, other_problems, result_details, sentence, undecided
from grader.report.locations import Base, RepositoryLocation, archive_around, in_repository
from grader.source import Location, Source
from grader.text import counted_points, printable

Level = Literal["error", "warning", "note"]
_ORDER: tuple[Level, ...] = ("error", "warning", "note")


class Finding(NamedTuple):
    """One thing to mend. `rule` is the criterion's id or the problem's code, `text` printable, line by line.

    `place` is None where the submission as a whole is meant. `fingerprint` stays the same while the line stays the same,
    wherever in its file it moves. `lost` counts what is skipped because of it as well. `place` is where to look, `whole` what
    stands for it where that cannot be told, as far as a format has no way to leave it open.
    """

    rule: str
    level: Level
    text: str
    lost: Decimal
    place: RepositoryLocation | None
    whole: RepositoryLocation
    fingerprint: str = ""


def findings(report: Report, base: Base) -> list[Finding]:
    """All there is to mend in a submission; `base` is where that stands in its repository."""
    source_of = cache(report.submission.source)  # a file is read once, however much there is to say of it
    found = [_of_criterion(each, report, source_of, base) for each in report.results if is_failure(each)]
    found.sort(key=lambda each: -each.lost)
    found += _undecided(report, base)
    for each in sorted(other_problems(report), key=lambda each: _ORDER.index(each.severity)):
        text = _text((printable(each.message),), each.location, base)
        place = in_repository(each.location, source_of(each.location.path), base)
        found.append(Finding(each.code, each.severity, text, Decimal(0), place, place))
    seen: Counter[str] = Counter()
    return [each._replace(fingerprint=_fingerprint(each, seen)) for each in found]


def is_failure(result: Result) -> bool:
    """Whether a criterion has cost points, or has failed: what a person has decided counts, whatever the check has found."""
    if result.ruling is not None:
        return result.points < result.criterion.points
    return result.outcome.status in ("failed", "errored")


def _whole(report: Report, base: Base, *, of_package: bool) -> RepositoryLocation:
    """What stands for a finding without a place of its own: the URDF, the package, or the folder that was handed in."""
    submission = report.submission
    path = submission.path
    if submission.package is not None and (of_package or path is None):
        path = f"{submission.package.folder}/package.xml".lstrip("/")
    return RepositoryLocation(
        base.archive or (base.folder + path if path is not None else base.folder.rstrip("/")) or "."
    )


def _of_criterion(result: Result, report: Report, source_of: Callable[[str], Source | None], base: Base) -> Finding:
    criterion, what = result.criterion, result_details(result, report)
    behind = [each.criterion.points for each in report.results if each.because == criterion.id and each.ruling is None]
    aim = f"Passes when: {sentence(criterion.title)}"
    lines = [*what.sentences, *filter(None, [what.feedback]), aim]
    if behind:
        lines.append(f"Skipped because of it: {len(behind)} more, {counted_points(sum(behind, Decimal(0)))}.")
    place = in_repository(what.place, source_of(what.place.path), base) if what.place is not None else None
    whole = place or _whole(report, base, of_package=criterion.check.subject == "package")
    lost = sum(behind, criterion.points - result.points)
    return Finding(criterion.id, "error", _text(tuple(lines), what.place, base), lost, place, whole)


def _undecided(report: Report, base: Base) -> Iterator[Finding]:
    """What a program decides as a rule, and has to leave to a person here, with the reasons."""
    left = undecided(report)
    if left:
        points = counted_points(sum((each.criterion.points for each in left), Decimal(0)))
        reasons = dict.fromkeys(sentence(each.outcome.message) for each in left)
        text = "\n".join((*reasons, f"Not decided ({points}): {', '.join(each.criterion.id for each in left)}"))
        place = _whole(report, base, of_package=all(each.criterion.check.subject == "package" for each in left))
        yield Finding(left[0].criterion.id, "warning", text, Decimal(0), None, place)


def _text(lines: tuple[str, ...], where: Location | None, base: Base) -> str:
    """What is said; of a file that the repository does not hold as such also where that is."""
    is_there = where is None or not (base.archive or base.is_outside or archive_around(where.path))
    inside = () if is_there or where is None else (f"In {location_text(where)}.",)
    return "\n".join((*lines, *inside))


def _fingerprint(finding: Finding, seen: Counter[str]) -> str:
    place = finding.place
    told_by = (finding.rule, place.path, place.text) if place is not None else (finding.rule, "", "")
    digest = hashlib.sha256("\0".join(told_by).encode("utf-8", "surrogatepass")).hexdigest()[:16]
    seen[digest] += 1
    return f"{digest}:{seen[digest]}"
