"""A report for a person at a terminal: what to fix first.

The score is last, where the eye is when the command ends.

It has the first mistakes in full, and a line for each further one; `--verbose` has everything. Text
of a submission is never interpreted as markup or control codes.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from textwrap import shorten
from typing import TYPE_CHECKING, get_args

from rich.console import Console
from rich.style import Style
from rich.text import Text

from grader.base.problems import Problem
from grader.base.source import Location, SourceOf
from grader.base.text import counted, enumerated, format_points, printable
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.criterion import worth
from grader.report import content
from grader.report.content import ReportSections, report_sections
from grader.report.criteria import (
    Answer,
    Block,
    CriteriaGroup,
    Diff,
    Entry,
    Line,
    Role,
    Section,
    alike,
    earned_text,
    groups,
    is_failure,
    is_manual,
    name_status,
    pending_reason,
    remarks_on,
    write_points,
)
from grader.report.locations import diff_lines, location_text
from grader.report.screen import link_to
from grader.report.statuses import STYLES
from grader.report.writers.terminal_page import (
    INDENT,
    SEVERITY_LOOKS,
    Page,
    block,
    count_rows,
    excerpt_block,
)

if TYPE_CHECKING:
    pass


_LOOKS = {
    **dict.fromkeys(get_args(Role), ""),
    **dict.fromkeys(("result", "comment", "hint"), "bold"),
    **dict.fromkeys(("graded", "provenance", "expected", "part", "ignored", "there"), "dim"),
    **dict.fromkeys(("missing", "alike", "carried"), "yellow"),
    "error": SEVERITY_LOOKS["error"],
    "warning": SEVERITY_LOOKS["warning"],
    "note": SEVERITY_LOOKS["note"],
    "feedback": "italic",
}
_DIFF_STYLES = {"-": "red", "+": "green"}
_MAX_WHOLE = 5  # mistakes in full
_MANY, _MAX_HINTS = 5, 2  # criteria; of more, so many hints in full
_MAX_ROWS, _HEIGHT_OF_END = 18, 2  # of a report of one mistake; its last lines
_MAX_NAMES = 3
_MAX_PROBLEMS = 3
_MAX_FILES = 2


def render_terminal(report: Report, console: Console, *, verbose: bool = False) -> None:
    """Print a report, with `verbose` everything in it."""
    sections = report_sections(report, everything=verbose)
    page = Page(console, [])
    if verbose:
        _show_everything(report, sections, page)
    else:
        _show_brief(report, sections, page)
    _show_end(report, sections, page)
    page.print()


def _show_brief(report: Report, sections: ReportSections, page: Page) -> None:
    """Add the short report, without its last lines.

    While a student has something to fix in the robot, what comes later is a line each, without
    empty rows.
    """
    is_unfinished = bool(sections.mistakes or sections.unbuilt) and not report.student
    is_short = is_unfinished and len(sections.mistakes) == 1
    _show_start(report, sections, page)
    _show_mistakes(sections.mistakes, report, page)
    if sections.unbuilt:
        page.title(sections.unbuilt_title)
    for line in sections.unbuilt_lines:
        page.inset(line.text)
    is_early = is_unfinished and _is_robot_wrong(sections)
    found_line = content.found_line(sections.pending) if is_early else ""
    if is_early and not found_line:
        _show_pending(report, sections.pending, page)
    _show_carried(sections.carried, page)
    if is_early:
        _show_later(report, found_line, sections.missing, page)
    else:
        _show_missing(sections.missing, page)
        _show_pending(report, sections.pending, page)
    for section in sections.remarks:
        page.leave_row()
        _show_remarks(section, page)
    _show_groups(report, page)
    _show_files(report, page, most=_MAX_ROWS if is_short else 0)
    page.leave_row()
    if is_short:
        page.close_up(_MAX_ROWS - _HEIGHT_OF_END)


def _show_carried(carried: Sequence[Line], page: Page) -> None:
    """Add what fails and costs nothing."""
    if carried:
        page.leave_row()
    for line in carried:
        page.line(line.text, _LOOKS[line.role])


def _is_robot_wrong(sections: ReportSections) -> bool:
    """Return whether a mistake is in the robot, or a part of it is missing."""
    wrong = sections.mistakes + sections.unbuilt
    return any(entry.result.criterion.check.is_of_robot for entry in wrong)


def _show_remarks(section: Section, page: Page) -> None:
    """Add why each criterion of a section has its points."""
    for entry in section.entries:
        words = " ".join(remarks_on(entry.result)) or entry.texts("finding")[0]
        name = (printable(entry.id), "bold")
        page.item(entry.status, name, f"  {earned_text(entry.result)}: {words}")


def _show_later(report: Report, missing_text: str, missing: Sequence[Line], page: Page) -> None:
    """Add how much is left to submit.

    Also add what was found for manual grading, and what matches nothing.
    """
    texts = [text for text in (content.hand_in_line(report), missing_text) if text]
    texts += [line.text for line in missing if line.role == "there"]
    if texts:
        page.leave_row()
    for text in texts:
        page.line(text, _LOOKS["missing"])


def _show_missing(missing: Sequence[Line], page: Page) -> None:
    """Add what was searched in vain."""
    if missing:
        page.title("Not found")
    for line in missing:
        page.inset(line.text, _LOOKS[line.role])


def _show_start(report: Report, sections: ReportSections, page: Page) -> None:
    """Add what was graded, the result, and notes.

    The package is among it only if the path of the URDF does not show it.
    """
    submission = report.submission
    rejected = ", which ROS 2 rejects" if submission.verdict == "rejected" else ""
    page.line(content.graded_line(report) + rejected, _LOOKS["graded"])
    page.line(content.result_line(report, sections), _LOOKS["result"])
    if submission.package and submission.package.folder:
        folder = f"{submission.package.folder}/"
    else:
        folder = ""
    package = content.package_line(report)
    if package and not (submission.path or "").startswith(folder or "urdf/"):
        page.line(package, "dim")
    for line in content.notes(report):
        page.line(line, _LOOKS["note"])


def _show_mistakes(mistakes: Sequence[Entry], report: Report, page: Page) -> None:
    """Add the first mistakes in full, and the costs and places of the rest."""
    are_many = sum(len(entry.results) for entry in mistakes) > _MANY
    for number, entry in enumerate(mistakes[:_MAX_WHOLE]):
        page.leave_row()
        blocks = _brief_blocks(entry)
        if are_many and number >= _MAX_HINTS:
            blocks = _with_cut_feedback(blocks, page.console.width - INDENT)
        _show_entry(entry, report, page, blocks)
    rest = mistakes[_MAX_WHOLE:]
    if rest:
        them = "it" if len(rest) == 1 else "them"
        page.title(f"{counted(len(rest), 'more mistake')}: --verbose shows {them} in full")
    for entry in rest:
        page.line(_mistake_head(entry, page))


def _brief_blocks(entry: Entry) -> Iterator[Block]:
    """Yield the blocks of a short report.

    What is expected is there only if needed, and nothing that head and hint say. What names that do
    not agree break stays.
    """
    has_names = any(other.result.criterion.check.name == "names_agree" for other in entry.also)
    is_clear = entry.result.outcome.expected is not None or bool(entry.texts("hint", "feedback"))
    for part in entry.blocks:
        match part:
            case Line("also") if has_names:
                yield part
            case Diff() | Line("also" | "skipped"):
                pass
            case Line("expected") if is_clear:
                pass
            case Answer() if is_failure(entry.result):
                pass
            case _:
                yield part


def _with_cut_feedback(blocks: Iterable[Block], width: int) -> Iterator[Block]:
    """Yield blocks with feedback of one line; a hint stays whole."""
    for part in blocks:
        match part:
            case Line("feedback", text):
                yield part._replace(text=shorten(text, width, placeholder=" ..."))
            case _:
                yield part


def _show_entry(entry: Entry, report: Report, page: Page, blocks: Iterable[Block]) -> None:
    """Add a criterion or a mistake with these blocks."""
    is_mistake = bool(entry.lost) or is_failure(entry.result)
    page.line(_mistake_head(entry, page) if is_mistake else _entry_head(entry, page))
    page.inset(" ".join(entry.texts("finding")))
    source_of = report.submission.source
    for part in blocks:
        match part:
            case Line(role, text) if role != "finding":
                page.inset(text, _LOOKS[role])
            case Location():
                source = source_of(part.path)
                if source and source.line(part.line).strip():
                    page.rows.append(excerpt_block(page.console, source, part, INDENT))
            case Answer() | Diff():
                _show_lines(part, source_of, page)


def _show_lines(part: Answer | Diff, source_of: SourceOf, page: Page) -> None:
    """Add the lines of an answer or of edits."""
    match part:
        case Answer(title, lines):
            page.inset(f"{title}:", "bold")
            for line in lines:
                page.inset(line, indent=2 * INDENT)
        case Diff(edits):
            for line in diff_lines(edits, source_of):
                page.inset(line, _DIFF_STYLES.get(line[0], "dim"), 2 * INDENT)


def _mistake_head(entry: Entry, page: Page) -> Text:
    """Return what a mistake costs, its criteria, and its place."""
    cost = (entry.cost, STYLES[entry.status]), ": ", (entry.names, "bold")
    text = Text.assemble(page.mark(entry.status), " ", *cost)
    if entry.location:
        text.append("  ").append(_place(entry.location, page))
    return text


def _place(where: Location, page: Page) -> Text:
    """Return a location with its whole path, which is a link where the terminal has links."""
    style = Style(dim=True, link=link_to(page.console, where.path))
    return Text(location_text(where), style)


def _entry_head(entry: Entry, page: Page) -> Text:
    """Return the title, name and points of a criterion that did not fail."""
    title = printable(entry.result.criterion.title)
    name = printable(entry.id)
    points = earned_text(entry.result)
    return Text.assemble(
        page.mark(entry.status), " ", (title, "bold"), (f"  {name}", "dim"), f"  {points}"
    )


def _show_pending(report: Report, pending: Sequence[Entry], page: Page) -> None:
    """Add what needs manual grading.

    This is where each answer and picture was found, or why a check cannot decide.
    """
    if pending:
        points = write_points(result for entry in pending for result in entry.results)
        page.title(f"Needs manual grading ({points})" if report.open_points else "Not graded")
    every = list[Entry]()
    for entry in pending:
        every += [entry, *entry.also]
    for reason, entries in alike(every, lambda entry: pending_reason(entry.result)):
        results = [entry.result for entry in entries]
        if any(map(_has_own_lines, results)):
            for entry in entries:
                _show_entry(entry, report, page, _brief_blocks(entry))
            continue
        names = enumerated([printable(entry.id) for entry in entries], _MAX_NAMES)
        points = worth(result.criterion for result in results).short
        page.item("pending", (names, "bold"), f" ({points}): {reason}")


def _has_own_lines(result: Result) -> bool:
    """Return whether there is more to say of an open criterion than why it is open."""
    return bool(result.comment or (is_manual(result) and result.criterion.answer))


def _show_groups(report: Report, page: Page) -> None:
    """Add the points of each group that lost some, or of all groups if none did.

    Groups of which nothing is known yet are listed elsewhere.
    """
    kinds = alike(filter(_is_known, groups(report)), lambda group: group.status)
    if kinds:
        page.leave_row()
    for status, members in [kind for kind in kinds if kind[0] != "passed"] or kinds:
        titles = [f"{printable(group.title)} {group.points}" for group in members]
        page.item(status, ", ".join(titles))


def _is_known(group: CriteriaGroup) -> bool:
    return not all(result.is_open for result in group.results)


def _show_files(report: Report, page: Page, most: int) -> None:
    """Add the first unreported problems, and the first files that were not graded.

    No criterion has reported these problems. Problems that make a report higher than `most` are
    only counted, if it is not 0.
    """
    problems = content.other_problems(report)
    listed = [problem for problem in problems if problem.severity != "note"]
    if listed:
        page.leave_row()
    rows = [_problem_row(problem, page) for problem in listed[:_MAX_PROBLEMS]]
    if most and page.height + sum(map(count_rows, rows)) + _HEIGHT_OF_END > most:
        rows = []
    page.rows.extend(rows)
    rest = len(problems) - len(rows)
    if rest:
        words = counted(rest, "more problem" if listed else "note")
        page.line(f"{words}: --verbose shows {'it' if rest == 1 else 'them'}", "dim")
    others = [file.path for file in report.submission.unused_candidates]
    if others:
        line = f"Not graded: {enumerated(others, _MAX_FILES)} (--verbose says why)"
        page.line(printable(line), "dim")
    ignored = report.submission.ignored
    if ignored:
        line = f"Ignored: {ignored[0]}"
        if len(ignored) > 1:
            line += f" (and {len(ignored) - 1} more: --verbose lists them)"
        page.line(printable(line), "dim")


def _problem_row(problem: Problem, page: Page) -> Text:
    """Return a problem with its code and place."""
    name = (f"{problem.label} {problem.severity} ", _LOOKS[problem.severity])
    text = Text.assemble(name, _place(problem.location, page), f": {printable(problem.message)}")
    return block(page.console, text, INDENT, Text())


def _show_end(report: Report, sections: ReportSections, page: Page) -> None:
    """Add the next command and the score."""
    command = content.next_command(report, sections)
    for line in (f"Next: {command}" if command else "", content.bonus_line(report)):
        if line:
            page.line(line)
    counting = report.counting
    is_full = counting is not None and counting + report.open_points >= report.max_score
    score = content.counting_text(report)
    if counting is not None:
        score += f"/{format_points(report.max_score)}"
    parts = (
        (score, "bold green" if is_full else "bold"),
        "  ",
        (printable(report.rubric.title), "bold"),
    )
    page.inset(Text.assemble(*parts), indent=0)


def _show_everything(report: Report, sections: ReportSections, page: Page) -> None:
    """Add a report, without its last lines."""
    for line in content.head(report, sections):
        page.line(line.text, _LOOKS[line.role])
    for section in sections.sections:
        _show_section(section, report, page)
    _show_parts(report, page)
    for section in content.closing(report):
        _show_section(section, report, page)
    page.leave_row()
    if report.submission.has_urdf:
        page.line("grader inspect shows the whole robot.", "dim")


def _show_section(section: Section, report: Report, page: Page) -> None:
    page.title(section.title)
    for number, entry in enumerate(section.entries):
        if number and is_failure(entry.result):
            page.leave_row()
        _show_entry(entry, report, page, entry.blocks)
    for line in section.lines:
        indent = 2 * INDENT if line.role in ("found", "missing") else INDENT
        page.inset(line.text, _LOOKS[line.role], indent)


def _show_parts(report: Report, page: Page) -> None:
    """Add each part with its groups and all their criteria."""
    for part, part_groups in groupby(groups(report), key=lambda group: group.part):
        members = list(part_groups)
        title = report.rubric.part(part).title
        if len(report.parts) > 1:
            points = earned_text(*(result for group in members for result in group.results))
            page.title(f"{printable(title)}  {points}", "bold underline")
        for group in members:
            if len(members) > 1 or group.title != title:
                name = (printable(group.title), "bold")
                page.title(Text.assemble(name, (f"  {group.points}", "dim")))
            for result in group.results:
                # One that fails only because of another one has its points: it is no mistake.
                mark = page.mark("skipped" if _is_carried(result) else name_status(result))
                start = Text.assemble("  ", mark, f" {earned_text(result):<5} ")
                page.inset(_criterion_row(result), indent=len(start), head=start)


def _is_carried(result: Result) -> bool:
    """Return whether a criterion fails only because of another one, and has its points."""
    is_overridden = result.manual_mark is not None or result.is_adjusted
    return bool(result.carried) and not is_overridden


def _criterion_row(result: Result) -> Text:
    """Return a criterion in a line: its title if it passed, else its name.

    A title would read as a fact.
    """
    status = name_status(result)
    if status == "passed":
        return Text(printable(result.criterion.title))
    reason = ""
    if _is_carried(result):
        reason = f"  not deducted: caused by {printable(result.carried)}"
    elif status == "skipped" and result.because is not None:
        reason = f"  skipped because {printable(result.because)} failed"
    return Text.assemble(printable(result.id), (reason, "dim"))
