"""A report as Markdown (CommonMark, without extensions): for job summaries, comments and the pages of an LMS."""

from collections.abc import Iterator
from itertools import groupby
from textwrap import indent

from grader.grading.report import Report, Result
from grader.report.content import (
    advice,
    earned_text,
    evidence,
    ignored_lines,
    location_text,
    notes,
    other_problems,
    package_line,
    pending_line,
    result_details,
    score_text,
    status_of,
    summary,
)
from grader.report.markdown_text import code, escaped, fenced
from grader.report.plain_text import problem_line, provenance, quoted_lines
from grader.text import format_points, printable

_MARKS = {"passed": "\u2713", "failed": "\u2717", "skipped": "\u2212", "pending": "?", "errored": "!"}
_CUT = "**The report is cut off here: it is longer than can be shown.** A report that is saved to a file is whole.\n"


def render_markdown(report: Report, *, answers: bool = True) -> str:
    """Return the whole report, with the model answers that its rubric was loaded with or without."""
    return "\n".join(f"{block}\n" for block in _blocks(report, answers=answers))


def cut_markdown(report: Report, most: int) -> str:
    """The report in no more than so many bytes of UTF-8: whole blocks from its beginning, and a notice if some are missing.

    Job summaries are made of it, which students read: no model answers are in it.
    """
    text = render_markdown(report, answers=False)
    if len(text.encode()) <= most:
        return text
    kept: list[str] = []
    left = most - len(_CUT.encode())
    for block in _blocks(report, answers=False):
        left -= len(block.encode()) + 2
        if left < 0:
            break
        kept.append(f"{block}\n")
    return "\n".join((*kept, _CUT)) if len(_CUT.encode()) <= most else ""


def whole_markdown(report: Report) -> str:
    """What is said of the submission as a whole: the report without its criteria."""
    return "\n\n".join((*_head(report), *_evidence(report), *_problems(report)))


def criterion_markdown(result: Result, report: Report) -> str:
    """What is said of one criterion, beside its title and points."""
    return "\n\n".join(_details(result, report, set(), answers=False))


def _blocks(report: Report, *, answers: bool) -> Iterator[str]:
    """The report piece by piece; each stands for itself."""
    yield from _head(report)
    titles = {part.id: part.title for part in report.rubric.parts}
    shown: set[str] = set()
    for part, of_part in groupby(report.results, key=lambda each: each.criterion.part):
        results = tuple(of_part)
        yield f"## {escaped(printable(titles[part]))} ({earned_text(results)})"
        for about, some in groupby(results, key=lambda each: each.criterion.about):
            group = tuple(some)
            if about and about != titles[part]:
                yield f"### {escaped(printable(about))} ({earned_text(group)})"
            yield from (_item(each, report, shown, answers=answers) for each in group)
    yield from _evidence(report)
    yield from _problems(report)
    yield from filter(None, (advice(report),))


def _head(report: Report) -> Iterator[str]:
    yield f"# {escaped(score_text(report))}: {escaped(printable(report.rubric.title))}"
    yield from (escaped(line) for line in (summary(report), package_line(report)) if line)
    if report.pending:
        yield f"**{escaped(pending_line(report))}**"
    yield escaped(provenance(report))
    yield from map(escaped, (*notes(report), *ignored_lines(report)))


def _item(result: Result, report: Report, shown: set[str], *, answers: bool) -> str:
    criterion, status = result.criterion, status_of(result)
    points = f"{format_points(result.points)}/{format_points(criterion.points)}"
    head = f"- {_MARKS[status]} {points} {escaped(printable(criterion.title))}"
    if status == "passed" and result.ruling is None:
        return head
    details = (indent(block, "  ") for block in _details(result, report, shown, answers=answers))
    return "\n\n".join((f"{head} ({code(criterion.id)})", *details))


def _details(result: Result, report: Report, shown: set[str], *, answers: bool) -> Iterator[str]:
    """What is said of a criterion, block by block. Feedback that is shown already is not shown once more."""
    what = result_details(result, report)
    yield from map(escaped, what.sentences)
    if what.place is not None:
        yield code(location_text(what.place))
        quoted = list(quoted_lines(what.place, report))
        if quoted:
            yield fenced(quoted)
    for name, lines in (("Found", what.found), ("Model answer", what.model if answers else ())):
        if lines:
            yield f"{name}:"
            yield fenced(list(lines))
    if what.feedback and what.feedback not in shown:
        shown.add(what.feedback)
        yield f"*{escaped(what.feedback)}*"


def _evidence(report: Report) -> Iterator[str]:
    for number, (part, lines) in enumerate(evidence(report)):
        if number == 0:
            yield "## Evidence"
        yield f"{escaped(part)}:"
        yield "\n".join(f"- {escaped(words)}" for words, _ in lines)


def _problems(report: Report) -> Iterator[str]:
    problems = list(other_problems(report))
    if problems:
        yield f"## What else there is to say of the {'file' if report.submission.is_single else 'files'}"
        yield from (f"- {escaped(problem_line(each))}" for each in problems)
