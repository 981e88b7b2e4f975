"""Reports with hints, and submissions with the edits of all hints."""

from collections.abc import Mapping
from contextlib import suppress
from decimal import Decimal
from typing import TYPE_CHECKING, NamedTuple

from grader.errors import InputError
from grader.grading.grade import grade
from grader.grading.levels import HintLevel
from grader.grading.report import Hint, Report, Result
from grader.grading.rubric import ReferenceSolution
from grader.hints.editing import edited_files, with_files
from grader.hints.robot.draft import Draft
from grader.hints.search import HintSearch
from grader.hints.trials import FoundHint, Trials, costs_of
from grader.hints.words import message
from grader.source import Edits, Location
from grader.submission.submission import Submission
from grader.text import enumerated

if TYPE_CHECKING:
    from grader.package.package import Package


_MAX_NAMED = 4


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


def hinted(report: Report, submission: Submission, level: HintLevel) -> HintedReport:
    """Return a report with proven hints for criteria that failed."""
    results = {result.criterion.id: result for result in report.results}
    solution = report.rubric.solution
    trials = Trials(report.rubric, submission, results)
    search = HintSearch(trials, _draft(solution), lambda: _package(solution), report.by_convention).run()
    costs = costs_of(results)
    shown = {name: found for found in reversed(search.found) for name in found.gains}
    entries = {id(found): _entry(found, shown, results, costs) for found in search.found}
    hints: dict[str, Hint] = {}
    for name, one in {**search.missing, **shown}.items():
        with trials.isolated():
            entry = entries.get(id(one), name)
            before = search.found[: search.found.index(one)] if one.is_late else []
            found = _first_at(one, results[entry].outcome.location)
            earlier = tuple(dict.fromkeys(entries[id(it)] for it in before))
            text = message(found, level, submission, earlier)
            hint = _hint(found, text, entry, results[name], keeps_edits=level == "edit")
            hints[name] = hint._replace(after=earlier)
    left = [name for name in costs if name not in hints and name in search.results and not search.results[name].is_lost]
    for name in left if level == "edit" else ():
        others = enumerated(list(dict.fromkeys(entries.values())), _MAX_NAMED)
        hints[name] = Hint(f"Make the edits for {others}.", results[name].outcome.location or Location("", 1, 1), {})
    with_hints = [result._replace(hint=hints.get(result.criterion.id)) for result in report.results]
    report = report._replace(results=tuple(with_hints), hints_complete=search.is_complete or submission.is_costly)
    return HintedReport(report, search.edits, trials.faults)


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


def _first_at(found: FoundHint, where: Location | None) -> FoundHint:
    """Return a hint with the edits in the line of the failure first."""
    place = (where.path, where.line) if where is not None else None
    edits = sorted(found.proposal.edits, key=lambda it: ((it.path, it.line) != place, it.path, it.line, it.column))
    return found._replace(proposal=found.proposal._replace(edits=tuple(edits)))


def _hint(found: FoundHint, text: str, shown_by: str, result: Result, *, keeps_edits: bool) -> Hint:
    places = [Location(edit.path, edit.line, edit.column) for edit in found.proposal.edits]
    at = next(iter(places), result.outcome.location or Location("", 1, 1))
    shown = (found.edits, found.proposal.cause) if keeps_edits else ((), "")
    return Hint(text, at, found.gains, *shown, shown_by, found.certainty)


def _draft(reference: ReferenceSolution | None) -> Draft | None:
    """Return the robot of the reference solution."""
    with suppress(InputError):
        return Draft.of(reference.reading) if reference is not None else None
    return None


def _package(reference: ReferenceSolution | None) -> "Package | None":
    """Return the package of the reference solution."""
    with suppress(InputError):
        return reference.submission.package if reference is not None else None
    return None
