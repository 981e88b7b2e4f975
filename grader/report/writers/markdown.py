"""A report as Markdown, for job summaries, comments and LMS pages.

It is CommonMark, and HTML only to fold what passed.

Text of a submission is escaped: it never becomes markup, HTML, a link or a mention.
"""

import html
from collections.abc import Iterator
from itertools import accumulate, groupby
from textwrap import indent

from grader.base.source import Location
from grader.base.text import printable
from grader.lab.grading.report import Report
from grader.report import content
from grader.report.content import ReportSections, report_sections
from grader.report.criteria import (
    Answer,
    CriteriaGroup,
    Diff,
    Entry,
    Line,
    Section,
    earned_text,
    groups,
    has_passed,
    is_failure,
)
from grader.report.locations import diff_lines, excerpt_lines, location_text
from grader.report.statuses import SYMBOLS
from grader.report.writers.escaped_markdown import MENTION, code, escape, escape_words, fence

_LOOKS = {"graded": "# {}", "result": "**{}**", "hint": "**{}**", "feedback": "*{}*", "part": "{}:"}
_CUT = (
    "**The report is cut off here, because it is too long.** A report that is saved to a file "
    "is complete.\n"
)


def render_markdown(report: Report) -> str:
    """Return the report."""
    return "\n".join(f"{block}\n" for block in _blocks(report, answers=True))


def cut_markdown(report: Report, most: int) -> str:
    """Return the first blocks of a report that fit into a number of bytes of UTF-8.

    A notice follows if some are missing.

    It is for job summaries, which students read, so it has no model answers.
    """
    blocks = [f"{block}\n" for block in _blocks(report, answers=False)]
    whole = "\n".join(blocks)
    room = most - len(_CUT.encode())
    if len(whole.encode()) <= most:
        return whole
    ends = accumulate(len(block.encode()) + 1 for block in blocks)
    kept = (block for block, end in zip(blocks, ends, strict=True) if end <= room)
    if room >= 0:
        return "\n".join((*kept, _CUT))
    return ""


def overview_markdown(report: Report) -> str:
    """Return the report without its criteria."""
    sections = (
        part
        for section in content.closing(report)
        for part in _section(section, report, answers=False)
    )
    return "\n\n".join((*_head(report, report_sections(report)), *sections))


def criterion_markdown(entry: Entry, report: Report) -> str:
    """Return the text about one criterion, besides its title and points."""
    return "\n\n".join(_details(entry, report, answers=False))


def _blocks(report: Report, *, answers: bool) -> Iterator[str]:
    """Yield the report block by block, each of which can be the last one."""
    described = report_sections(report)
    yield from _head(report, described)
    for section in described.sections:
        yield from _section(section, report, answers=answers)
    passed = [folded for group in groups(report) if (folded := _fold_passed(group))]
    if passed:
        yield from ("## Passed", *passed)
    for section in content.closing(report):
        yield from _section(section, report, answers=answers)
    command = content.next_command(report, described)
    if command:
        yield f"Next: {code(command)}"


def _head(report: Report, sections: ReportSections) -> Iterator[str]:
    for line in content.head(report, sections):
        yield _LOOKS.get(line.role, "{}").format(escape(line.text))


def _section(section: Section, report: Report, *, answers: bool) -> Iterator[str]:
    yield f"## {escape(section.title)}"
    for entry in section.entries:
        details = (indent(block, "  ") for block in _details(entry, report, answers=answers))
        yield "\n\n".join((f"- {SYMBOLS[entry.status]} {_entry_head(entry)}", *details))
    for is_item, lines in groupby(
        section.lines, lambda line: line.role not in ("part", "carried", "there")
    ):
        texts = [_LOOKS.get(line.role, "{}").format(escape_words(line.text)) for line in lines]
        if is_item:
            yield "\n".join(f"- {text}" for text in texts)
        else:
            yield from texts


def _entry_head(entry: Entry) -> str:
    """Return what a mistake costs and its criteria.

    Of another criterion, return the points, and the title where it holds.
    """
    result = entry.result
    name = code(entry.id)
    if entry.lost or is_failure(result):
        return f"**{entry.cost}**: {code(entry.names)}"
    if result.is_adjusted:
        return f"{earned_text(result)} {name}"
    return f"{earned_text(result)} {escape(printable(result.criterion.title))} ({name})"


def _details(entry: Entry, report: Report, *, answers: bool) -> Iterator[str]:
    """Yield the text about a criterion, block by block."""
    for block in entry.blocks:
        match block:
            case Line(role, text):
                yield _LOOKS.get(role, "{}").format(escape_words(text))
            case Location():
                yield code(location_text(block))
                if excerpt := list(excerpt_lines(block, report.submission.source)):
                    yield fence(excerpt)
            case Answer(title, lines) if answers or title == "Found":
                yield f"{title}:"
                yield fence(lines)
            case Diff(edits):
                yield fence(diff_lines(edits, report.submission.source), "diff")


def _fold_passed(group: CriteriaGroup) -> str:
    """Return the criteria of a group that passed, folded below its points; empty if none did."""
    lines = [
        f"- {SYMBOLS['passed']} {earned_text(result)} {escape(printable(result.criterion.title))}"
        for result in group.results
        if has_passed(result)
    ]
    if lines:
        summary = f"{printable(group.title)} {group.points}"
        shown = MENTION.sub("\\g<0>\u2060", html.escape(summary))
        # CommonMark reads Markdown in HTML only after an empty line.
        return "\n".join(("<details>", f"<summary>{shown}</summary>", "", *lines, "", "</details>"))
    return ""
