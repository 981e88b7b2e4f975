"""A report as Markdown (CommonMark without extensions): for job summaries, comments and pages of an LMS.

Text of a submission is escaped: it never becomes markup, HTML, a link or a mention.
"""

import re
from collections.abc import Iterator
from itertools import groupby
from textwrap import indent

from grader.grading.report import Report, Result
from grader.report import content
from grader.report.plain_text import excerpt_lines, problem_line, provenance
from grader.text import format_points, printable

_MARKS = {"passed": "\u2713", "failed": "\u2717", "skipped": "\u2212", "pending": "?", "errored": "!"}
_CUT = "**The report is cut off here, because it is too long.** A report that is saved to a file is complete.\n"
_HTML = {"<": "&lt;", ">": "&gt;", "&": "&amp;"}
_ACTIVE = re.compile(
    r"[\\`*\[\]<>&|~$#]|(?<![^\W_])_|_(?![^\W_])"  # an underscore inside a word is plain text
    r"|(?<=http):(?=//)|(?<=https):(?=//)|(?<=ftp):(?=//)|(?<=www)\.",  # GitHub makes links of bare addresses
    re.IGNORECASE,
)
_OPENING = re.compile(r"^([-+=]|\d+[.)](?= |$))")  # a list, rule or heading at the start of a line
# GitHub looks for mentions and issue numbers after it has rendered Markdown, so escapes do not prevent them.
_MENTION = re.compile(r"@|#(?=\d)")
_FENCE = re.compile(r"`{3,}")
_MAX_FENCE = 80  # backticks: GitHub's parser takes no more to start code, and counts those of a block to 255


def render_markdown(report: Report, *, answers: bool = True) -> str:
    """Return the report, with or without the model answers that its rubric was loaded with."""
    return "\n".join(f"{block}\n" for block in _blocks(report, answers=answers))


def cut_markdown(report: Report, most: int) -> str:
    """Return the first blocks of a report that fit into a number of bytes of UTF-8, and a notice if some are missing.

    It is for job summaries, which students read, so it has no model answers.
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


def overview_markdown(report: Report) -> str:
    """Return the report without its criteria."""
    return "\n\n".join((*_head(report), *_evidence(report), *_problems(report)))


def criterion_markdown(result: Result, report: Report) -> str:
    """Return the text about one criterion, besides its title and points."""
    return "\n\n".join(_details(content.result_details(result, report), report, set(), answers=False))


def _blocks(report: Report, *, answers: bool) -> Iterator[str]:
    """Yield the report block by block."""
    yield from _head(report)
    titles = {part.id: part.title for part in report.rubric.parts}
    shown: set[str] = set()
    for part, of_part in groupby(report.results, key=lambda result: result.criterion.part):
        results = tuple(of_part)
        yield f"## {escaped(printable(titles[part]))} ({content.earned_text(results)})"
        for about, of_group in groupby(results, key=lambda result: result.criterion.about):
            group = tuple(of_group)
            if about and about != titles[part]:
                yield f"### {escaped(printable(about))} ({content.earned_text(group)})"
            yield from (_item(result, report, shown, answers=answers) for result in group)
    yield from _evidence(report)
    yield from _problems(report)
    yield from filter(None, (content.advice(report),))


def _head(report: Report) -> Iterator[str]:
    yield f"# {escaped(content.score_text(report))}: {escaped(printable(report.rubric.title))}"
    yield from (escaped(line) for line in (content.summary(report), content.package_line(report)) if line)
    if report.pending:
        yield f"**{escaped(content.pending_line(report))}**"
    yield escaped(provenance(report))
    yield from map(escaped, (*content.notes(report), *content.ignored_lines(report)))


def _item(result: Result, report: Report, shown: set[str], *, answers: bool) -> str:
    criterion, status = result.criterion, content.status_of(result)
    start = f"- {_MARKS[status]} {format_points(result.points)}/{format_points(criterion.points)}"
    title, name = escaped(printable(criterion.title)), code(criterion.id)
    if status == "passed" and result.manual_mark is None:
        return f"{start} {title}"
    details = content.result_details(result, report)
    is_title = not details.expected and status != "skipped"
    blocks = (indent(block, "  ") for block in _details(details, report, shown, answers=answers))
    return "\n\n".join((f"{start} {title} ({name})" if is_title else f"{start} {name}", *blocks))


def _details(details: content.Details, report: Report, shown: set[str], *, answers: bool) -> Iterator[str]:
    """Yield the text about a criterion, block by block, without feedback that is shown already."""
    yield from map(escaped, details.sentences)
    if details.expected:
        yield escaped(details.expected)
    if details.location is not None:
        yield code(content.location_text(details.location))
        lines = list(excerpt_lines(details.location, report))
        if lines:
            yield fenced(lines)
    for title, lines in (("Found", list(details.answer)), ("Model answer", list(details.model_answer) * answers)):
        if lines:
            yield f"{title}:"
            yield fenced(lines)
    if details.feedback and details.feedback not in shown:
        shown.add(details.feedback)
        yield f"*{escaped(details.feedback)}*"


def _evidence(report: Report) -> Iterator[str]:
    for number, (part, lines) in enumerate(content.evidence(report)):
        if number == 0:
            yield "## Evidence"
        yield f"{escaped(part)}:"
        yield "\n".join(f"- {escaped(text)}" for text, _ in lines)


def _problems(report: Report) -> Iterator[str]:
    problems = list(content.other_problems(report))
    if problems:
        yield f"## {content.other_problems_title(report)}"
        yield from (f"- {escaped(problem_line(problem))}" for problem in problems)


def escaped(text: str) -> str:
    """Return one line of printable text that Markdown shows as it is."""
    plain = _ACTIVE.sub(lambda found: _HTML.get(found[0]) or f"\\{found[0]}", text.strip())
    plain = _OPENING.sub(lambda found: f"{found[0][:-1]}\\{found[0][-1]}", plain)
    return _MENTION.sub("\\g<0>\u2060", plain)


def code(text: str) -> str:
    """Return printable text as inline code; as plain text if it has too many backticks."""
    longest = max((len(found[0]) for found in re.finditer(r"`+", text)), default=0)
    if longest >= _MAX_FENCE:
        return escaped(text)
    fence = "`" * (longest + 1)
    space = " " if not text or text[0] in "` " or text[-1] in "` " else ""
    return f"{fence}{space}{text}{space}{fence}"


def fenced(lines: list[str]) -> str:
    """Return printable lines, none of them blank, as a code block that nothing in them can end."""
    fence = "`" * max((len(found[0]) + 1 for line in lines for found in _FENCE.finditer(line)), default=3)
    if len(fence) > _MAX_FENCE:
        return "\n".join(f"    {line}" for line in lines)
    return "\n".join((f"{fence}text", *lines, fence))
