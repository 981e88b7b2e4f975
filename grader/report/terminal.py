"""A report for a person at a terminal: what to fix first; the score last, where the eye is when the command ends."""

from io import StringIO

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report
from grader.grading.worth import worth
from grader.report import content
from grader.report.console import wrapped
from grader.report.details import result_details, status_of
from grader.report.entries import INDENT, Page, mark, show_answer, show_failure
from grader.report.order import Order, alike, in_order
from grader.report.overview import show_evidence, show_groups, show_notes, show_other_problems
from grader.text import enumerated, printable

_MAX_NAMED = 3
_ROWS = 24  # of a common terminal


def render_terminal(report: Report, console: Console, *, verbose: bool = False) -> None:
    """Print a report, with `verbose` everything in it, else in 24 rows as far as possible.

    Text of the submission is never interpreted as markup or control codes.
    """
    order = in_order(report)
    pages = [Page(report, console, verbose, set(), room) for room in (2, 1, 0)]
    _show(pages[0] if verbose else next((page for page in pages[:-1] if _fits(page, order)), pages[-1]), order)


def _fits(page: Page, order: Order) -> bool:
    out = StringIO()
    _show(page._replace(console=Console(file=out, width=page.console.width), shown=set()), order)
    return out.getvalue().count("\n") <= _ROWS


def _show(page: Page, order: Order) -> None:
    for line in filter(None, (content.graded_line(page.report), _package_line(page))):
        wrapped(page.console, Text(line, "dim"), INDENT, Text())
    shown = (one for one in order.failures if page.is_verbose or not (one.result.why_given or one.first))
    for number, failure in enumerate(shown):
        show_failure(failure, page, number)
    _show_consequences(order, page)
    _show_pending(order, page)
    _show_remarks(order, page)
    show_groups(page)
    show_evidence(page)
    show_other_problems(page)
    show_notes(page)
    _show_end(page)


def _package_line(page: Page) -> str:
    """Return the package that is graded, unless the path of the URDF shows it."""
    submission = page.report.submission
    folder = f"{submission.package.folder}/" if submission.package is not None and submission.package.folder else ""
    is_seen = not page.is_verbose and (submission.path or "").startswith(folder or "urdf/")
    return "" if is_seen else content.package_line(page.report)


def _show_consequences(order: Order, page: Page) -> None:
    """Print the failures whose error is carried forward, unless they are shown, and what is skipped although nothing failed."""
    carried = [failure.result for failure in order.failures if failure.result.why_given and not page.is_verbose]
    lines = [content.carried_text(carried)] if carried else []
    skipped = alike(order.skipped, lambda result: result.because or "")
    lines += [content.skipped_text(cause, some) for cause, some in skipped]
    if lines:
        page.leave_row()
    for line in lines:
        wrapped(page.console, Text(line, "yellow"), INDENT, Text())


def _show_pending(order: Order, page: Page) -> None:
    """Print what needs manual grading: where each answer and picture was found, and why a check cannot decide."""
    if not order.pending:
        return
    page.leave_row()
    wrapped(
        page.console, Text(content.pending_points(page.report) if page.report.open_points else "Not graded", "bold"), 0
    )
    for reason, results in alike(order.pending, content.pending_reason):
        has_answers = page.is_verbose or any(result.criterion.answer for result in results)
        if (content.is_manual(results[0]) and has_answers) or any(result.comment for result in results):
            for result in results:
                show_answer(result, page)
            continue
        names = enumerated(
            [printable(result.criterion.id) for result in results], None if page.is_verbose else _MAX_NAMED
        )
        points = worth(result.criterion for result in results).short
        text = Text.assemble((names, "bold"), f" ({points}): {reason}")
        wrapped(page.console, text, INDENT, mark("pending", page.console) + Text(" "))


def _show_remarks(order: Order, page: Page) -> None:
    """Print what has all points by a manual mark, what is adjusted, and comments without points."""
    for _, results in order.remarks:
        page.leave_row()
        for result in results:
            details, start = result_details(result, page.report), mark(status_of(result), page.console) + Text(" ")
            if page.is_verbose and not result.is_adjusted:
                show_answer(result, page)
                continue
            said = f"{details.sentences[0]} {details.comment}".strip() if result.is_adjusted else ""
            said = said or details.comment or details.sentences[0]
            name = (printable(result.criterion.id), "bold")
            text = Text.assemble(name, f"  {content.earned_text((result,))}: {said}")
            wrapped(page.console, text, INDENT, start)


def _show_end(page: Page) -> None:
    """Print the next command, whether ROS 2 loads the URDF, and the score: the last lines of a report."""
    report, console = page.report, page.console
    page.leave_row()
    if page.is_verbose and report.submission.has_urdf:
        wrapped(console, Text("grader inspect shows the whole robot.", "dim"), 0)
    counting = report.counting
    is_full = counting is not None and counting + report.open_points >= report.max_score
    score = Text(content.headline(report), "bold green" if is_full else "bold")
    command = content.next_command(report)
    next_step = f"Next: {command}" if command else content.what_is_left(report)
    verdict = content.verdict_and_counts(report)
    lines = (verdict, next_step) if page.room else (f"{verdict}. {next_step}",)
    for line in filter(None, (*lines, content.bonus_line(report), content.grade_line(report))):
        wrapped(console, Text(line), INDENT, Text())
    wrapped(console, Text.assemble(score, "  ", (printable(report.rubric.title), "bold")), 0)
