"""A report for a person at a terminal: what to fix first; the score last, where the eye is when the command ends."""

from collections.abc import Sequence
from itertools import groupby

from rich.console import Console
from rich.text import Text

from grader.grading.criterion import worth
from grader.grading.report import Report
from grader.problems import Problem
from grader.report import content
from grader.report.console import SEVERITY_STYLES, block, put, show_problems, wrapped
from grader.report.details import carried_text, pending_reason, remarks_on, result_details, skipped_text
from grader.report.entries import INDENT, Page, Room, show_answer, show_criteria, show_failure
from grader.report.order import Order, alike, earned_text, groups, in_order, is_manual, status_of
from grader.text import counted, enumerated, first_lines, printable

_MAX_NAMES, _MAX_LISTED, _MAX_KINDS = 3, 12, 3
_ROWS = 24  # of a common terminal


def render_terminal(report: Report, console: Console, *, verbose: bool = False) -> None:
    """Print a report, with `verbose` everything in it, else in 24 rows as far as possible.

    Text of the submission is never interpreted as markup or control codes.
    """
    order = in_order(report)
    for room in Room:
        with console.capture() as capture:
            _show(Page(report, console, verbose, set(), room), order)
        if verbose or capture.get().count("\n") <= _ROWS:
            break
    console.file.write(capture.get())


def _show(page: Page, order: Order) -> None:
    for line in filter(None, (content.graded_line(page.report), _package_line(page))):
        page.line(line, "dim")
    for line in content.notes(page.report)[: bool(page.report.submission.another_robot)]:
        page.line(line, "yellow")
    listed = (one for one in order.failures if page.is_verbose or not (one.result.why_given or one.first))
    for number, failure in enumerate(listed):
        show_failure(failure, page, number)
    _show_consequences(order, page)
    _show_pending(order, page)
    _show_remarks(order, page)
    if page.is_verbose:
        _show_parts(page)
        _show_evidence(page)
    else:
        _show_groups(page)
        if not page.is_tight and (line := content.evidence_line(page.report)):
            page.line(line, "dim")
    _show_other_problems(page)
    _show_notes(page)
    _show_end(page)


def _package_line(page: Page) -> str:
    """Return the package that is graded, unless the path of the URDF shows it."""
    submission = page.report.submission
    folder = f"{submission.package.folder}/" if submission.package is not None and submission.package.folder else ""
    is_seen = not page.is_verbose and (submission.path or "").startswith(folder or "urdf/")
    return "" if is_seen else content.package_line(page.report)


def _show_consequences(order: Order, page: Page) -> None:
    """Print failures with an error that is carried forward, and what is skipped although nothing failed."""
    carried = [failure.result for failure in order.failures if failure.result.why_given and not page.is_verbose]
    lines = [carried_text(carried)] if carried else []
    lines += [skipped_text(cause, some) for cause, some in alike(order.skipped, lambda one: one.because or "")]
    if lines:
        page.leave_row()
    for line in lines:
        page.line(line, "yellow")


def _show_pending(order: Order, page: Page) -> None:
    """Print what needs manual grading: where each answer and picture was found, and why a check cannot decide."""
    if not order.pending:
        return
    page.leave_row()
    page.title(content.pending_points(page.report) if page.report.open_points else "Not graded")
    for reason, results in alike(order.pending, pending_reason):
        has_answers = page.is_verbose or any(result.criterion.answer for result in results)
        if (is_manual(results[0]) and has_answers) or any(result.comment for result in results):
            for result in results:
                show_answer(result, page)
            continue
        ids = [printable(result.criterion.id) for result in results]
        names = enumerated(ids, None if page.is_verbose else _MAX_NAMES)
        points = worth(result.criterion for result in results).short
        page.item("pending", (names, "bold"), f" ({points}): {reason}")


def _show_remarks(order: Order, page: Page) -> None:
    """Print what has all points by a manual mark, what is adjusted, and comments without points."""
    for _, results in order.remarks:
        page.leave_row()
        for result in results:
            details = result_details(result, page.report)
            if page.is_verbose and not result.is_adjusted:
                show_answer(result, page)
                continue
            words = " ".join(remarks_on(result, page.report)) or details.sentences[0]
            page.item(status_of(result), (printable(result.criterion.id), "bold"), f"  {earned_text(result)}: {words}")


def _show_groups(page: Page) -> None:
    """Print the points of each group, except those of which nothing is known yet: they are listed elsewhere."""
    known = [group for group in groups(page.report) if not all(result.is_open for result in group.results)]
    kinds = [
        kind for kind in alike(known, lambda group: group.status) if page.room is Room.EVERYTHING or kind[0] != "passed"
    ]
    if kinds:
        page.leave_row()
    for status, some in sorted(kinds, key=lambda kind: kind[0] == "passed"):
        page.item(status, ", ".join(f"{printable(group.title)} {group.points}" for group in some))


def _show_parts(page: Page) -> None:
    """Print each part with its groups and all their criteria."""
    for part, of_part in groupby(groups(page.report), key=lambda group: group.part):
        found, title = list(of_part), page.report.rubric.part(part).title
        if len(page.report.parts) > 1:
            page.console.print()
            points = earned_text(*(result for group in found for result in group.results))
            page.title(f"{printable(title)}  {points}", "bold underline")
        for group in found:
            show_criteria(group, page, has_title=len(found) > 1 or group.title != title)


def _show_evidence(page: Page) -> None:
    """Print the evidence that was found, and what is missing."""
    for number, (title, lines) in enumerate(content.evidence(page.report)):
        if number == 0:
            page.console.print()
            page.title("Evidence")
        page.inset(title, "dim")
        for text, is_found in lines[:_MAX_LISTED]:
            page.inset(text, "" if is_found else "yellow", levels=2)
        for text in first_lines([text for text, _ in lines], _MAX_LISTED)[_MAX_LISTED:]:
            page.inset(text, levels=2)


def _show_other_problems(page: Page) -> None:
    """Print the problems that no failed criterion has reported: all, or one of each kind of error and warning."""
    problems = content.other_problems(page.report)
    if page.is_verbose:
        if problems:
            submission = page.report.submission
            page.leave_row()
            page.title(content.other_problems_title(page.report))
            show_problems(page.console, tuple(problems), submission.source, submission.path)
        return
    listed = [found for found in problems if found.severity != "note"]
    if page.is_tight:
        problems = listed = [found for found in listed if not found.kind.is_consequence]
    if listed:
        page.leave_row()
    kinds = alike(listed, lambda problem: f"{problem.code} {problem.location.path}")
    # No criterion is about the entry for package.xml (PKG015), so this is the only place that reports it.
    shown = [some for index, (_, some) in enumerate(kinds) if index < _MAX_KINDS or some[0].code == "PKG015"]
    for some in shown:
        put(page.console, _kind_block(some, page))
    rest = len(problems) - sum(map(len, shown))
    if rest:
        noun = "problem" if len(kinds) > len(shown) else "note"
        words = counted(rest, f"more {noun}" if listed else noun)
        page.title(f"{words}: --verbose shows {'it' if rest == 1 else 'them'}", "dim")


def _kind_block(problems: Sequence[Problem], page: Page) -> Text:
    """Return problems of one kind in one file in few lines: code, place and message of the first, and how many more."""
    first, more = problems[0], len(problems) - 1
    where = f"{printable(first.location.path.rpartition('/')[2])}:{first.location.line}"
    text = Text.assemble((f"{first.code} {first.severity} ", SEVERITY_STYLES[first.severity]), (where, "dim"))
    text.append(f"{f' and {more} more' if more else ''}: {printable(first.message)}")
    return block(page.console, text, INDENT, Text(), most=1 if page.is_tight else 2)


def _show_notes(page: Page) -> None:
    """Print how the submission was read: what it was not graded on, other candidates, ignored files."""
    notes = content.notes(page.report)[bool(page.report.submission.another_robot) :]
    ignored = content.ignored_lines(page.report) if page.is_verbose else content.first_ignored(page.report)
    if page.is_verbose and (notes or ignored):
        page.console.print()
    for line in notes:
        page.line(line, "cyan")
    for line in ignored:
        page.line(line, "dim")


def _show_end(page: Page) -> None:
    """Print the next command, whether ROS 2 loads the URDF, and the score: the last lines of a report."""
    report = page.report
    page.leave_row()
    if page.is_verbose and report.submission.has_urdf:
        page.title("grader inspect shows the whole robot.", "dim")
    counting, verdict = report.counting, content.verdict_and_counts(report)
    is_full = counting is not None and counting + report.open_points >= report.max_score
    score = (content.headline(report), "bold green" if is_full else "bold")
    command = content.next_command(report)
    following = f"Next: {command}" if command else content.what_is_left(report)
    lines = (f"{verdict}. {following}",) if page.is_tight else (verdict, following)
    for line in filter(None, (*lines, content.bonus_line(report), content.grade_line(report))):
        page.line(line)
    wrapped(page.console, Text.assemble(score, "  ", (printable(report.rubric.title), "bold")), 0)
