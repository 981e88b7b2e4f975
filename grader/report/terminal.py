"""A report for a person at a terminal: what to fix first; the score last, where the eye is when the command ends.

In 24 rows it has of each failure what it costs, what is wrong and what to do, and of the rest what is open. What has no
room is joined, cut or left out; where even that does not make 24 rows, messages are whole. Text of a submission is
never interpreted as markup or control codes.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple, get_args

from rich.console import Console
from rich.text import Text

from grader.grading.criterion import worth
from grader.grading.report import Report, Result
from grader.report import content
from grader.report.content import ReportSections, report_sections
from grader.report.criteria import (
    ASCII_SYMBOLS,
    STYLES,
    SYMBOLS,
    Answer,
    Block,
    Diff,
    Entry,
    Line,
    Role,
    Section,
    alike,
    carried_text,
    earned_text,
    groups,
    hint_text,
    is_failure,
    is_manual,
    pending_reason,
    points_of,
    remarks_on,
    status_of,
)
from grader.report.locations import diff_lines, excerpt, location_text
from grader.source import Location, Source
from grader.text import counted, enumerated, printable

if TYPE_CHECKING:
    from rich.table import Table


INDENT = 2
LOOKS: Mapping[Role, str] = {
    **dict.fromkeys(get_args(Role), ""),
    **dict.fromkeys(("pending", "comment", "hint"), "bold"),
    **dict.fromkeys(("provenance", "expected", "part", "ignored"), "dim"),
    **dict.fromkeys(("missing", "skipped", "alike", "warning"), "yellow"),
    "feedback": "italic",
    "error": "bold red",
    "note": "cyan",
}
_DIFF_STYLES = {"-": "red", "+": "green"}
_MAX_FIRST = 3  # failures with their source line
_MAX_ROWS, _MAX_REASON = 4, 2  # rows of a message, and of a reason; a hint has fewer than a message
_MOST_ROWS = 10  # of a message in a report of more than 24 rows
_LAST_WORD, _LAST_NUMBER = re.compile(r"\s+\S*$"), re.compile(r"\s+[-+.\d]+$")  # a number keeps its unit
_ROWS = 24  # of a common terminal
_MAX_NAMES, _MAX_PROBLEMS, _MAX_FILES = 3, 3, 2


class Page(NamedTuple):
    """The rows of a report for a console. All texts are printable."""

    console: Console
    rows: list[Text]
    is_whole: bool = True  # else it is a short report
    is_tight: bool = False  # without empty rows
    is_cut: bool = False  # with short texts

    @property
    def height(self) -> int:
        """The number of rows that a terminal shows."""
        return sum(row.plain.count("\n") + 1 for row in self.rows)

    def leave_row(self) -> None:
        """Add an empty row if there is room for it."""
        if not self.is_tight:
            self.rows.append(Text())

    def title(self, text: str | Text, style: str = "bold") -> None:
        """Add a title below an empty row."""
        self.leave_row()
        self.line(text, style)

    def line(self, text: str | Text, style: str = "") -> None:
        """Add a line, with an indent where it wraps."""
        self.inset(text, style, head=Text())

    def inset(
        self, text: str | Text, style: str = "", indent: int = INDENT, head: Text | None = None, most: int | None = None
    ) -> None:
        """Add a text below a title or an item, of more than `most` rows the first ones."""
        self.rows.append(block(self.console, Text(text, style) if isinstance(text, str) else text, indent, head, most))

    def item(self, status: str, *parts: str | tuple[str, str]) -> None:
        """Add texts, with their styles, behind the symbol of a status."""
        self.inset(Text.assemble(*parts), head=self.mark(status) + Text(" "))

    def mark(self, status: str) -> Text:
        """Return the symbol of a status in its colour."""
        return Text(_symbol(self.console, SYMBOLS[status], ASCII_SYMBOLS[status]), STYLES[status])

    def table(self, table: "Table") -> None:
        """Add a table, which a terminal may be too narrow for."""
        self.print()
        self.console.print(table)

    def print(self) -> None:
        """Print the rows so far, all at once: a print costs more than a row."""
        self.console.print(Text("\n").join(self.rows), overflow="ignore", no_wrap=True, crop=False)
        self.rows.clear()


def _show_entry(entry: Entry, report: Report, page: Page, number: int = 0) -> None:
    """Add a criterion; `number` counts failures, of which a short report has only the first with all blocks."""
    head, message = _entry_head(entry, page), Text(" ".join(entry.texts("finding")))
    source_of = report.submission.source
    if page.is_tight:
        page.inset(Text(": ").join((head, message)), head=Text(), most=_most_rows(page, number))
    else:
        page.line(head)
        page.inset(message)
    for part in entry.blocks if page.is_whole else _shortened(entry, page, is_first=number < _MAX_FIRST):
        match part:
            case Line(role, text) if role != "finding":
                is_cut = page.is_cut and role in ("feedback", "expected")
                page.inset(text, LOOKS[role], most=_MAX_REASON - (number > 0) if is_cut else None)
            case Location():
                source = source_of(part.path)
                if source is not None and source.line(part.line).strip():
                    page.rows.append(excerpt_block(page.console, source, part, INDENT, is_underlined=not page.is_tight))
            case Answer(title, lines):
                page.inset(f"{title}:", "bold")
                for line in lines:
                    page.inset(line, indent=2 * INDENT)
            case Diff(edits):
                for line in diff_lines(edits, source_of):
                    page.inset(line, _DIFF_STYLES.get(line[0], "dim"), 2 * INDENT)


def _most_rows(page: Page, number: int) -> int:
    """Return how many rows the message of a failure may have on a page without empty rows."""
    if not page.is_cut:
        return _MOST_ROWS
    return _MAX_ROWS if number < _MAX_FIRST else _MAX_REASON


def _entry_head(entry: Entry, page: Page) -> Text:
    """Return the name of a failure, its cost and place, or the title, name and points of another criterion."""
    name, mark = printable(entry.id), page.mark(entry.status)
    if not is_failure(entry.result):
        title = printable(entry.result.criterion.title)
        return Text.assemble(mark, " ", (title, "bold"), (f"  {name}", "dim"), f"  {entry.points}")
    text = Text.assemble(mark, " ", (name, "bold"), (f"  {entry.points}", STYLES[entry.status]))
    if entry.location is not None:
        where = entry.location._replace(calls=()) if page.is_tight else entry.location
        text.append(f"  {location_text(where)}", "dim")
    return text


def _shortened(entry: Entry, page: Page, *, is_first: bool) -> Iterator[Block]:
    """Yield the blocks for which a short report has room."""
    is_failed, is_loose = is_failure(entry.result), not page.is_tight
    is_clear = entry.result.outcome.expected is not None or bool(entry.texts("hint", "feedback"))
    for part in entry.blocks:
        match part:
            case Line("hint", text):
                yield Line("hint", _short_hint(entry, text, page))
            case Line("skipped") if is_loose:
                words = f"{counted(len(entry.skipped), 'criterion is', 'criteria are')} skipped because of it"
                yield Line("skipped", f"{words} ({points_of(entry.skipped)}).")
            case Line("comment" | "alike"):
                yield part
            case Location() if is_first:
                yield part
            case Answer() if not is_failed:
                yield part
            case Line("feedback") if is_first or is_loose:
                yield part
            case Line("expected") if not is_clear and (is_first or is_loose):
                yield part


def _short_hint(entry: Entry, text: str, page: Page) -> str:
    """Return the hint, or what is wrong if its edits are too long."""
    rows, hint = block(page.console, Text(text), INDENT).plain.count("\n") + 1, entry.result.hint
    if hint is None or not hint.cause or rows < _MAX_ROWS:
        return text
    return hint_text(entry, f"Wrong: {hint.cause}. --verbose shows the edits.")


def block(console: Console, text: Text, indent: int, head: Text | None = None, most: int | None = None) -> Text:
    """Return text that keeps its indent when it wraps; `head` is in place of the indent of the first line.

    Of more than `most` lines it is the first ones, with an ellipsis.
    """
    lines = text.wrap(console, max(8, console.width - indent))
    for line in lines:
        line.rstrip()
    kept = lines[:most]
    if len(kept) < len(lines):
        ellipsis = _symbol(console, "\u2026", "...")
        room = max(8, console.width - indent) - len(ellipsis)
        words = kept[-1].plain if kept[-1].cell_len <= room else _LAST_WORD.sub("", kept[-1].plain)
        kept[-1].truncate(min(room, len(_LAST_NUMBER.sub("", words))))
        kept[-1].append(ellipsis)
    return (Text(" " * indent) if head is None else head) + Text("\n" + " " * indent).join(kept)


def excerpt_block(
    console: Console, source: Source, where: Location, indent: int, style: str = "red", *, is_underlined: bool = True
) -> Text:
    """Return the source line of a location, and if wanted a line that underlines the marked part."""
    number = str(where.line)
    before, meant, after = excerpt(source, where, max(8, console.width - indent - len(number) - 3))
    mark, bar = _symbol(console, "\u2500", "-"), _symbol(console, "\u2502", "|")
    text = Text.assemble((f"{' ' * indent}{number} {bar} ", "dim"), (before + meant + after).rstrip())
    if is_underlined:
        under = " " * len(before) + mark * max(1, len(meant))
        text.append(f"\n{' ' * (indent + len(number))} {bar} ", "dim").append(under, style)
    return text


def _symbol(console: Console, fancy: str, plain: str) -> str:
    """Return a symbol, or its ASCII form if the terminal cannot show it."""
    return fancy if console.encoding.lower().startswith("utf") else plain


def render_terminal(report: Report, console: Console, *, verbose: bool = False) -> None:
    """Print a report, with `verbose` everything in it, else in 24 rows as far as possible."""
    found = report_sections(report, everything=verbose)
    if verbose:
        page = Page(console, [], is_whole=True)
        _show_everything(report, found, page)
        _show_end(report, page)
        page.print()
        return
    page = _brief_page(report, found, Page(console, [], is_whole=False))
    if page.height > _ROWS:
        page = _brief_page(report, found, Page(console, [], is_whole=False, is_tight=True))
    if page.height > _ROWS:
        cut = _brief_page(report, found, Page(console, [], is_whole=False, is_tight=True, is_cut=True))
        page = cut if cut.height <= _ROWS else page  # if nothing makes it fit, sentences stay whole
    page.print()


def _brief_page(report: Report, found: ReportSections, page: Page) -> Page:
    """Return a page with the short report."""
    _show_brief(report, found, page)
    _show_end(report, page)
    return page


def _show_brief(report: Report, found: ReportSections, page: Page) -> None:
    """Add the short report, without its last lines."""
    _show_start(report, page)
    listed = (entry for entry in found.failures if not (entry.result.why_given or entry.first))
    for number, entry in enumerate(listed):
        page.leave_row()
        _show_entry(entry, report, page, number)
    carried = [entry.result for entry in found.failures if entry.result.why_given]
    lines = [line.text for line in found.skipped]
    if carried:
        lines.insert(0, carried_text(carried))
    if lines:
        page.leave_row()
    for line in lines:
        page.line(line, "yellow")
    _show_pending(report, found.pending, page)
    for section in found.remarks:
        page.leave_row()
        for entry in section.entries:
            words = " ".join(remarks_on(entry.result)) or entry.texts("finding")[0]
            page.item(entry.status, (printable(entry.id), "bold"), f"  {entry.points}: {words}")
    _show_groups(report, page)
    _show_submission(report, page)
    page.leave_row()


def _show_start(report: Report, page: Page) -> None:
    """Add what was graded; the package only if the path of the URDF does not show it."""
    submission = report.submission
    graded = printable(submission.path or submission.id)
    graded += ", which ROS 2 rejects" if submission.verdict == "rejected" else ""
    page.line(f"grader {report.version}, {printable(report.rubric.id)}: {graded}", "dim")
    folder = f"{submission.package.folder}/" if submission.package is not None and submission.package.folder else ""
    package = content.package_line(report)
    if package and not (submission.path or "").startswith(folder or "urdf/"):
        page.line(package, "dim")
    if report.another_robot:
        page.line(content.notes(report)[0], "yellow")


def _show_pending(report: Report, pending: Sequence[Entry], page: Page) -> None:
    """Add what needs manual grading: where each answer and picture was found, or why a check cannot decide."""
    if pending:
        page.title(content.pending_points(report) if report.open_points else "Not graded")
    every = [one for entry in pending for one in (entry, *entry.also)]
    for reason, some in alike(every, lambda entry: pending_reason(entry.result)):
        results = [entry.result for entry in some]
        if any(one.comment or (is_manual(one) and one.criterion.answer) for one in results):
            for entry in some:
                _show_entry(entry, report, page)
            continue
        names = enumerated([printable(entry.id) for entry in some], _MAX_NAMES)
        points = worth(result.criterion for result in results).short
        page.item("pending", (names, "bold"), f" ({points}): {reason}")


def _show_groups(report: Report, page: Page) -> None:
    """Add the points of each group that lost some, or of all groups if none did.

    Groups of which nothing is known yet are listed elsewhere.
    """
    known = [group for group in groups(report) if not all(result.is_open for result in group.results)]
    kinds = alike(known, lambda group: group.status)
    if kinds:
        page.leave_row()
    for status, some in [kind for kind in kinds if kind[0] != "passed"] or kinds:
        page.item(status, ", ".join(f"{printable(group.title)} {group.points}" for group in some))


def _show_submission(report: Report, page: Page) -> None:
    """Add the evidence in a line, problems, notes, and the first of the files that were not graded."""
    submission, found = report.submission, sum(bool(one.files) for one in report.evidence)
    if report.evidence and not page.is_tight:
        missing = [printable(one.evidence.title) for one in report.evidence if not (one.files or one.possible)]
        named = f"; missing: {enumerated(missing, _MAX_FILES)}" if missing and found else ""
        page.line(f"Evidence: {found or 'none'} of {len(report.evidence)} found{named}", "dim")
    _show_problems(report, page)
    notes = content.notes(report)
    for line in notes[1:] if report.another_robot else notes:  # the first one is shown above
        page.line(line, "cyan")
    others, ignored = [file.path for file in submission.unused_candidates], submission.ignored
    if others:
        page.line(printable(f"Not graded: {enumerated(others, _MAX_FILES)} (--verbose says why)"), "dim")
    if ignored:
        more = f" (and {len(ignored) - 1} more: --verbose lists them)" if len(ignored) > 1 else ""
        page.line(printable(f"Ignored: {ignored[0]}{more}"), "dim")


def _show_problems(report: Report, page: Page) -> None:
    """Add the first problems that no failed criterion has reported, and how many more there are."""
    problems = content.other_problems(report)
    listed = [found for found in problems if found.severity != "note"]
    if page.is_tight:
        problems = listed = [found for found in listed if not found.kind.is_consequence]
    if listed:
        page.leave_row()
    for found in listed[:_MAX_PROBLEMS]:
        where = f"{printable(found.location.path.rpartition('/')[2])}:{found.location.line}"
        text = Text.assemble((f"{found.code} {found.severity} ", LOOKS[found.severity]), (where, "dim"))
        page.inset(text.append(f": {printable(found.message)}"), head=Text(), most=1 if page.is_cut else 2)
    rest = len(problems) - len(listed[:_MAX_PROBLEMS])
    if rest:
        words = counted(rest, "more problem" if listed else "note")
        page.line(f"{words}: --verbose shows {'it' if rest == 1 else 'them'}", "dim")


def _show_end(report: Report, page: Page) -> None:
    """Add whether ROS 2 loads the URDF, the next command, and the score."""
    command, verdict = content.next_command(report), content.verdict_and_counts(report)
    following = f"Next: {command}" if command else content.what_is_left(report)
    lines = [following]
    if not page.is_whole:
        lines = [f"{verdict}. {following}"] if page.is_tight else [verdict, following]
        lines += [content.bonus_line(report), content.grade_line(report)]
    for line in lines:
        if line:
            page.line(line)
    counting = report.counting
    is_full = counting is not None and counting + report.open_points >= report.max_score
    score = content.score_text(report).replace(" / ", "/").removesuffix(" points")
    parts = (score, "bold green" if is_full else "bold"), "  ", (printable(report.rubric.title), "bold")
    page.inset(Text.assemble(*parts), indent=0)


def _show_everything(report: Report, found: ReportSections, page: Page) -> None:
    """Add a report, without its last lines."""
    for line in content.head(report):
        page.line(line.text, LOOKS[line.role])
    for section in found.sections:
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
        if number and section.title == "Failed":
            page.leave_row()
        _show_entry(entry, report, page)
    for line in section.lines:
        page.inset(line.text, LOOKS[line.role], 2 * INDENT if line.role in ("found", "missing") else INDENT)


def _show_parts(report: Report, page: Page) -> None:
    """Add each part with its groups and all their criteria."""
    for part, of_part in groupby(groups(report), key=lambda group: group.part):
        found, title = list(of_part), report.rubric.part(part).title
        if len(report.parts) > 1:
            points = earned_text(*(result for group in found for result in group.results))
            page.title(f"{printable(title)}  {points}", "bold underline")
        for group in found:
            if len(found) > 1 or group.title != title:
                page.title(Text.assemble((printable(group.title), "bold"), (f"  {group.points}", "dim")))
            for result in group.results:
                start = Text.assemble("  ", page.mark(status_of(result)), f" {earned_text(result):<5} ")
                page.inset(_criterion_row(result), indent=len(start), head=start)


def _criterion_row(result: Result) -> Text:
    """Return a criterion in a line: its title if it passed, else its name, because a title would read as a fact."""
    status = status_of(result)
    if status == "passed":
        return Text(printable(result.criterion.title))
    is_consequence = status == "skipped" and result.because is not None
    reason = f"  skipped because {printable(result.because or '')} failed" if is_consequence else ""
    return Text.assemble(printable(result.criterion.id), (reason, "dim"))
