"""Reports with hints, and submissions with the edits of all hints."""

from collections.abc import Mapping
from decimal import Decimal
from typing import TYPE_CHECKING, NamedTuple

from grader.errors import InputError
from grader.grading.grade import grade
from grader.grading.hints.search import FoundHint, HintSearch
from grader.grading.hints.trials import Trials, costs_of
from grader.grading.hints.words import message
from grader.grading.levels import HintLevel
from grader.grading.reference import ReferenceSolution
from grader.grading.report import Hint, Report, Result
from grader.robot.edits.draft import Draft
from grader.source import Edits, Location
from grader.submission.editing import edited_files, with_files
from grader.submission.submission import Submission
from grader.text import enumerated

if TYPE_CHECKING:
    from grader.package.package import Package


class HintedReport(NamedTuple):
    """A report with hints, the edits of all that fit together, and the types of exceptions that cost other hints."""

    report: Report
    edits: Edits
    faults: list[str]


class Fix(NamedTuple):
    """The files of a submission that all proven edits change, None for one that is gone, and the report on the result.

    `why_nothing` says why there are none.
    """

    files: Mapping[str, bytes | None]
    report: Report
    why_nothing: str = ""


def hinted(report: Report, submission: Submission, level: HintLevel, *, keep_edits: bool = False) -> HintedReport:
    """Return a report with proven hints for criteria that failed; `keep_edits` keeps edits that the level hides."""
    results = {result.criterion.id: result for result in report.results}
    solution = report.rubric.solution
    trials = Trials(report.rubric, submission, results)
    search = HintSearch(trials, _draft(solution), lambda: _package(solution)).run()
    costs = costs_of(results)
    shown = {name: found for found in reversed(search.found) for name in found.gains}

    def shown_by(found: FoundHint) -> str:
        return _entry(found, shown, results, costs)

    certainties = search.certainties(found.proposal for found in shown.values())
    hints: dict[str, Hint] = {}
    for name, found in shown.items():
        with trials.isolated():
            text = message(found, level, submission, shown_by)
            hint = _hint(found, text, shown_by(found), keeps_edits=keep_edits or level == "edit")
            hints[name] = hint._replace(certainty=certainties[found.proposal])
    causes = search.causes if level in ("cause", "edit") else {}
    with_hints = [_explain(result, hints.get(result.criterion.id), causes) for result in report.results]
    is_complete = search.is_complete or submission.is_costly
    report = report._replace(results=tuple(with_hints), hints_complete=is_complete)
    return HintedReport(report, search.final.edits, trials.faults)


def fixed(found: HintedReport, submission: Submission) -> Fix:
    """Return the files with all proven edits that fit together, graded again."""
    report, why_nothing = found.report, "no edit that was tried gains points"
    if not report.hints_complete:
        why_nothing = "the search for edits ended at its limit before it found one"
    if found.faults:
        why_nothing = "the search for edits failed"
    if submission.is_costly:
        why_nothing = "the submission is too large to search for edits"
    files = edited_files(submission, found.edits) or {}
    after = with_files(submission, files)
    return Fix(files, grade(report.rubric, after, report.parts, is_one_of_class=not submission.is_single), why_nothing)


def _explain(result: Result, hint: Hint | None, causes: Mapping[str, list[str]]) -> Result:
    """Return a result with its hint; without one, its message says what is wrong at several places."""
    if hint is not None:
        return result._replace(hint=hint)
    wrong = causes.get(result.criterion.id)
    if not wrong or not result.is_lost:
        return result
    outcome = result.outcome
    message = f"{outcome.message}. Several places differ from the reference solution: {enumerated(wrong)}"
    return result._replace(outcome=outcome._replace(message=message, mistake=outcome.mistake or outcome.message))


def _entry(
    found: FoundHint, shown: Mapping[str, FoundHint], results: Mapping[str, Result], costs: Mapping[str, Decimal]
) -> str:
    """Return the criterion that shows a hint in a report: the one at the line that is edited, else the costliest."""

    def rank(name: str) -> tuple[bool, bool, bool, Decimal]:
        where, at = results[name].outcome.location, found.edits[0]
        is_there = where is not None and (where.path, where.line) == (at.path, at.line)
        cost = costs.get(name, found.gains[name])
        return name not in costs, not is_there, results[name].criterion.check.subject != "urdf", -cost

    return min([name for name in found.gains if shown.get(name) is found] or found.gains, key=rank)


def _hint(found: FoundHint, text: str, shown_by: str, *, keeps_edits: bool) -> Hint:
    first = found.edits[0]
    at = Location(first.path, first.line, first.column)
    shown = (found.edits, found.proposal.action) if keeps_edits else ((), "")
    return Hint(text, at, found.gains, *shown, shown_by)


def _draft(reference: ReferenceSolution | None) -> Draft | None:
    """Return the robot of the reference solution."""
    try:
        return Draft.of(reference.reading) if reference is not None else None
    except InputError:
        return None


def _package(reference: ReferenceSolution | None) -> "Package | None":
    """Return the package of the reference solution."""
    try:
        return reference.submission.package if reference is not None else None
    except InputError:
        return None
