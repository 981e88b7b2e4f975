"""A report's pieces as lines of plain text, for formats that hold text as it is. All of it is printable."""

from collections.abc import Iterator

from grader.grading.report import Report, Result
from grader.problems import Problem
from grader.report.content import (
    evidence,
    ignored_lines,
    location_text,
    notes,
    package_line,
    pending_line,
    result_details,
    summary,
)
from grader.report.locations import excerpt
from grader.source import Location
from grader.text import printable

_ROOM = 120  # characters of a quoted line


def core(report: Report) -> list[str]:
    """What is said first: what ROS 2 makes of the URDF, the package, and what waits for a person."""
    return [*filter(None, (summary(report), package_line(report), pending_line(report)))]


def beside(report: Report) -> list[str]:
    """What else there is to say of the submission as a whole: how it was read, what was passed over, and its evidence."""
    shown = [f"Evidence, {part}: {words}" for part, lines in evidence(report) for words, _ in lines]
    return [*notes(report), *ignored_lines(report), *shown]


def headline(report: Report) -> list[str]:
    """All that is said of the submission as a whole, beside its score."""
    return core(report) + beside(report)


def criterion_lines(result: Result, report: Report) -> list[str]:
    """What is said of one criterion: what was found, where it stands, what was answered, how to mend it."""
    what = result_details(result, report)
    lines = list(what.sentences)
    if what.place is not None:
        lines += [location_text(what.place), *quoted_lines(what.place, report)]
    if what.found:
        lines += ["Found:", *(f"  {line}" for line in what.found)]
    return [*lines, what.feedback] if what.feedback else lines


def quoted_lines(where: Location, report: Report) -> Iterator[str]:
    """The line of a place with what is meant underlined, as far as the file is at hand."""
    source = report.submission.source(where.path)
    if source is not None:
        quoted = excerpt(source, where, _ROOM)
        number = str(where.line)
        yield f"{number} | {quoted.text}"
        yield f"{' ' * len(number)} | {' ' * quoted.start}{'-' * quoted.width}"


def problem_line(problem: Problem) -> str:
    """A problem with its code, its severity and its place."""
    return f"{problem.code} {problem.severity} {location_text(problem.location)}: {printable(problem.message)}"


def provenance(report: Report) -> str:
    """Which grader has decided, and by which rubric: its hash shows whether it is the one that was meant."""
    return f"grader {report.version}, rubric {printable(report.rubric.id)}, sha256 {report.rubric.sha256}"
