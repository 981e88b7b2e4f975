"""A report as annotations of GitHub Actions: workflow commands, a line each, that put each finding on the line that it is about.

GitHub shows ten of each type in a step and drops the rest in silence, so the last one that is shown counts the others.
https://docs.github.com/actions/reference/workflow-commands-for-github-actions
"""

from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal

from grader.grading.report import Report
from grader.report.content import score_text
from grader.report.findings import Finding, Level, findings
from grader.report.locations import Base, RepositoryLocation
from grader.report.plain_text import beside, core, provenance
from grader.text import counted_points, printable

_MOST = 10  # of a type
_LONGEST = 4000  # characters of a message
_COMMANDS: dict[Level, str] = {"error": "error", "warning": "warning", "note": "notice"}


def render_github(report: Report, base: Base) -> str:
    """The annotations of a report: the score as a notice, then what costs most points first."""
    every = findings(report, base)
    if base.is_outside:  # a file of the repository may be called the same
        every = [each._replace(place=None) for each in every]
    lines = [command("notice", None, f"{score_text(report)}: {printable(report.rubric.title)}", _whole(report))]
    for level in _COMMANDS:
        some = [each for each in every if each.level == level]
        lines += _annotations(level, some, room=_MOST - (level == "note"))
    return "".join(lines)


def _annotations(level: Level, found: Sequence[Finding], room: int) -> Iterator[str]:
    shown = found if len(found) <= room else found[: room - 1]
    for each in shown:
        yield command(_COMMANDS[level], each.place, f"{each.rule}{_cost(each.lost)}", each.text)
    rest = found[len(shown) :]
    if rest:
        names = ", ".join(dict.fromkeys(each.rule for each in rest))
        cost = _cost(sum((each.lost for each in rest), Decimal(0)))
        yield command(_COMMANDS[level], None, f"{len(rest)} more{cost}", f"The report tells of these, too: {names}")


def _cost(lost: Decimal) -> str:
    return f" ({counted_points(lost)} lost)" if lost else ""


def _whole(report: Report) -> str:
    """What there is to say of the submission as a whole, and what nobody has decided yet."""
    waiting = [each.criterion.id for each in report.results if each.is_open]
    lines = [*core(report), provenance(report)]  # first, because the rest may be cut off
    if waiting:
        lines.append(f"A person decides: {', '.join(waiting)}")
    skipped: dict[str, list[str]] = {}
    for each in report.results:
        if each.because is not None and each.ruling is None:
            skipped.setdefault(each.because, []).append(each.criterion.id)
    lines += [f"Skipped, because {because} failed: {', '.join(names)}" for because, names in skipped.items()]
    return "\n".join((*lines, *beside(report)))


def command(name: str, place: RepositoryLocation | None, title: str, text: str) -> str:
    """One annotation: `error`, `warning` or `notice` of printable text, with a line break at its end."""
    properties = [*_position(place), ("title", title)] if place is not None else [("title", title)]
    listed = ",".join(f"{key}={_property(value)}" for key, value in properties)
    message = text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."
    return f"::{name} {listed}::{_data(message)}\n"


def _position(place: RepositoryLocation) -> Iterable[tuple[str, str]]:
    yield "file", printable(place.path)
    if place.line is not None:
        yield from (("line", str(place.line)), ("endLine", str(place.line)))
        yield from (("col", str(place.column)), ("endColumn", str(max(place.column, place.end - 1))))


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
