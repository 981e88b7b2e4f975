"""A report for a person at a terminal: what to fix first; the score last, where the eye is when the command ends.

In 24 rows it has of each failure what it costs, what is wrong and what to do, and of the rest what is open. What has no
room is joined, cut or left out; where even that does not make 24 rows, messages are whole. Text of a submission is
never interpreted as markup or control codes.
"""

from collections.abc import Sequence
from itertools import groupby

from rich.console import Console
from rich.text import Text

from grader.grading.criterion import worth
from grader.grading.report import Report, Result
from grader.report import content
from grader.report.console import INDENT, LOOKS, Page, show_entry
from grader.report.criteria import Entry, Section, alike, earned_text, groups, is_manual, status_of
from grader.report.details import carried_text, pending_reason, remarks_on
from grader.report.document import Document, document
from grader.text import counted, enumerated, printable

_ROWS = 24  # of a common terminal
_TRIED = (False, False), (True, False), (True, True), (True, False)  # without blank rows? with shortened sentences?
_MAX_NAMES, _MAX_PROBLEMS, _MAX_FILES = 3, 3, 2


def render_terminal(report: Report, console: Console, *, verbose: bool = False) -> None:
    """Print a report, with `verbose` everything in it, else in 24 rows as far as possible."""
    found = document(report, everything=verbose)
    for is_tight, is_cut in [(False, False)] if verbose else _TRIED:
        page = Page(console, [], verbose, is_tight, is_cut)
        (_show_everything if verbose else _show_brief)(report, found, page)
        _show_end(report, page)
        if sum(row.plain.count("\n") + 1 for row in page.rows) <= _ROWS:
            break
    page.print()


def _show_brief(report: Report, found: Document, page: Page) -> None:
    """Add the short report, without its last lines."""
    _show_start(report, page)
    listed = (entry for entry in found.failures if not (entry.result.why_given or entry.first))
    for number, entry in enumerate(listed):
        page.leave_row()
        show_entry(entry, report, page, number)
    carried = [entry.result for entry in found.failures if entry.result.why_given]
    lines = [*([carried_text(carried)] if carried else []), *(line.text for line in found.skipped)]
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
    if submission.another_robot:
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
                show_entry(entry, report, page)
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
    for line in content.notes(report)[bool(submission.another_robot) :]:
        page.line(line, "cyan")
    others, ignored = [file.path for file in submission.other_candidates], submission.ignored
    lines = [f"Not graded: {enumerated(others, _MAX_FILES)} (--verbose says why)"] if others else []
    more = f" (and {len(ignored) - 1} more: --verbose lists them)" if len(ignored) > 1 else ""
    for line in (*lines, *(f"Ignored: {file}{more}" for file in ignored[:1])):
        page.line(printable(line), "dim")


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
    lines = [f"{verdict}. {following}"] if page.is_tight else [verdict, following]
    lines += [content.bonus_line(report), content.grade_line(report)]
    for line in [following] if page.is_whole else filter(None, lines):
        page.line(line)
    counting = report.counting
    is_full = counting is not None and counting + report.open_points >= report.max_score
    score = content.score_text(report).replace(" / ", "/").removesuffix(" points")
    parts = (score, "bold green" if is_full else "bold"), "  ", (printable(report.rubric.title), "bold")
    page.inset(Text.assemble(*parts), indent=0)


def _show_everything(report: Report, found: Document, page: Page) -> None:
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
        show_entry(entry, report, page)
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
                page.inset(_row(result), indent=len(start), head=start)


def _row(result: Result) -> Text:
    """Return a criterion in a line: its title if it passed, else its name, because a title would read as a fact."""
    status = status_of(result)
    if status == "passed":
        return Text(printable(result.criterion.title))
    is_consequence = status == "skipped" and result.because is not None
    reason = f"  skipped because {printable(result.because or '')} failed" if is_consequence else ""
    return Text.assemble(printable(result.criterion.id), (reason, "dim"))
