"""The parts of a report as lines of printable plain text, for text formats, and the files that were found as evidence."""

from collections.abc import Iterator
from itertools import groupby

from grader.grading.report import Exhibits, Report, Result
from grader.problems import Problem
from grader.report import content
from grader.report.details import location_text, result_details
from grader.report.locations import excerpt
from grader.source import Location
from grader.text import enumerated, printable

_MAX_LISTED, _MAX_MISSING = 12, 2


def evidence(report: Report) -> Iterator[tuple[str, list[tuple[str, bool]]]]:
    """Yield the title of each part with its pieces of evidence, and whether files were found; then the other pictures."""
    parts = {part.id: part.title for part in report.rubric.parts}
    for part, exhibits in groupby(report.exhibits, key=lambda exhibits: exhibits.evidence.part):
        yield printable(parts[part]), [(_exhibits_text(found), bool(found.files)) for found in exhibits]
    if report.others:
        yield "Other pictures and documents", [(printable(exhibit.words), True) for exhibit in report.others]


def evidence_line(report: Report) -> str:
    """Return how many pieces of evidence were found, and which were not; empty if the lab asks for none."""
    found = sum(bool(exhibits.files) for exhibits in report.exhibits)
    uncertain = [_exhibits_text(exhibits) for exhibits in report.exhibits if exhibits.possible and not exhibits.files]
    missing = [exhibits.evidence.title for exhibits in report.exhibits if not (exhibits.files or exhibits.possible)]
    texts = [f"Evidence: {found or 'none'} of {len(report.exhibits)} found", *uncertain]
    texts += (
        [f"missing: {enumerated(missing, _MAX_MISSING)}"] if missing and len(missing) < len(report.exhibits) else []
    )
    return printable("; ".join(texts)) if report.exhibits else ""


def _exhibits_text(found: Exhibits) -> str:
    """Return a piece of evidence with its files, or with those that are perhaps meant."""
    files = ", ".join(exhibit.words for exhibit in found.files)
    perhaps = enumerated([exhibit.words for exhibit in found.possible], _MAX_LISTED, "or")
    return printable(f"{found.evidence.title}: {files or (f'perhaps {perhaps}' if perhaps else 'missing')}")


_EXCERPT_WIDTH = 120


def summary_lines(report: Report) -> list[str]:
    """Return whether ROS 2 loads the URDF, the extra credit, the package, and what needs manual grading."""
    return [*content.summaries(report), *filter(None, [content.pending_line(report)])]


def note_lines(report: Report) -> list[str]:
    """Return notes on the whole submission: how it was read, other candidates, ignored files, evidence."""
    shown = [f"Evidence, {part}: {text}" for part, lines in evidence(report) for text, _ in lines]
    return [*content.notes(report), *content.ignored_lines(report), *shown]


def submission_lines(report: Report) -> list[str]:
    """Return all lines about the whole submission, besides its score."""
    return summary_lines(report) + note_lines(report)


def criterion_lines(result: Result, report: Report) -> list[str]:
    """Return the lines about one criterion: the finding, its place, the answer, what to do."""
    details = result_details(result, report)
    lines = list(details.words)
    if details.location is not None:
        lines += [location_text(details.location), *excerpt_lines(details.location, report)]
    if details.answer:
        lines += ["Found:", *(f"  {line}" for line in details.answer)]
    return [*lines, *details.advice]


def excerpt_lines(where: Location, report: Report) -> Iterator[str]:
    """Yield the source line of a location, and a line that underlines the marked part; nothing without the file."""
    source = report.submission.source(where.path)
    if source is not None:
        line = excerpt(source, where, _EXCERPT_WIDTH)
        number = str(where.line)
        yield f"{number} | {line.text}"
        yield f"{' ' * len(number)} | {' ' * line.start}{'-' * line.width}"


def problem_line(problem: Problem) -> str:
    """Return a problem with its code, severity and location."""
    return f"{problem.code} {problem.severity} {location_text(problem.location)}: {printable(problem.message)}"


def provenance(report: Report) -> str:
    """Return the version of the grader, and the rubric with its hash."""
    return f"grader {report.version}, rubric {printable(report.rubric.id)}, sha256 {report.rubric.sha256}"
