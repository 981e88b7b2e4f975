"""What has to be mended, one finding each: what costs points, the most first, then problems that no criterion has told."""

import hashlib
from collections import Counter
from collections.abc import Callable
from decimal import Decimal
from functools import cache
from typing import Literal, NamedTuple

from grader.grading.report import Report, Result
from grader.report.places import Base, Place, placed
from grader.report.text import printable
from grader.report.words import Told, place_words, sentence, told, untold
from grader.robot.source import Location, Source

Level = Literal["error", "warning", "note"]
_ORDER: tuple[Level, ...] = ("error", "warning", "note")


class Finding(NamedTuple):
    """One thing to mend. `rule` is the criterion's id or the problem's code, `text` printable, line by line.

    `place` is None where the submission as a whole is meant. `fingerprint` stays the same while the line stays the same,
    wherever in its file it moves.
    """

    rule: str
    level: Level
    text: str
    lost: Decimal
    place: Place | None
    fingerprint: str


def findings(report: Report, base: Base) -> list[Finding]:
    """All there is to mend in a submission; `base` is where that stands in its repository."""
    lost = [each for each in report.results if is_lost(each)]
    lost.sort(key=lambda each: each.points - each.criterion.points)
    source_of = cache(report.submission.source)  # a file is read once, however much there is to say of it
    found = [_of_criterion(each, told(each, report), source_of, base) for each in lost]
    problems = sorted(untold(report), key=lambda each: _ORDER.index(each.severity))
    for each in problems:
        text = _text((printable(each.message),), each.location, base)
        place = placed(each.location, source_of(each.location.path), base)
        found.append(Finding(each.code, each.severity, text, Decimal(0), place, ""))
    seen: Counter[str] = Counter()
    return [each._replace(fingerprint=_fingerprint(each, seen)) for each in found]


def is_lost(result: Result) -> bool:
    """Whether a criterion has cost points, or has failed: what a person has decided counts, whatever the check has found."""
    if result.ruling is not None:
        return result.points < result.criterion.points
    return result.outcome.status in ("failed", "errored")


def whole(report: Report, base: Base) -> Place:
    """The place of a finding that has none of its own: the URDF, the package, or the folder that was handed in."""
    submission = report.submission
    path = submission.path
    if path is None and submission.package is not None:
        path = f"{submission.package.folder}/package.xml".lstrip("/")
    return Place(base.archive or (base.folder + path if path is not None else base.folder.rstrip("/")) or ".")


def _of_criterion(result: Result, what: Told, source_of: Callable[[str], Source | None], base: Base) -> Finding:
    criterion = result.criterion
    aim = f"Passes when: {sentence(criterion.title)}"
    text = _text((*what.sentences, *filter(None, [what.feedback]), aim), what.place, base)
    place = placed(what.place, source_of(what.place.path), base) if what.place is not None else None
    return Finding(criterion.id, "error", text, criterion.points - result.points, place, "")


def _text(lines: tuple[str, ...], where: Location | None, base: Base) -> str:
    """What is said; of a file that the repository does not hold as such also where that is."""
    inside = (f"In {place_words(where)}.",) if where is not None and (base.archive or base.is_outside) else ()
    return "\n".join((*lines, *inside))


def _fingerprint(finding: Finding, seen: Counter[str]) -> str:
    place = finding.place
    told_by = (finding.rule, place.path, place.text) if place is not None else (finding.rule, "", "")
    digest = hashlib.sha256("\0".join(told_by).encode("utf-8", "surrogatepass")).hexdigest()[:16]
    seen[digest] += 1
    return f"{digest}:{seen[digest]}"
