"""Reports with hints, and submissions with the edits of all hints."""

from collections.abc import Mapping
from dataclasses import replace
from decimal import Decimal
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from grader.errors import InputError
from grader.files.reading import read_capped
from grader.grading.grade import grade, open_reference
from grader.grading.hints.search import Found, Search
from grader.grading.hints.trials import Edits, Trials, costs_of
from grader.grading.hints.words import message
from grader.grading.levels import Level
from grader.grading.report import Fix, Hint, Report
from grader.grading.rubric import Rubric
from grader.robot.edits.draft import Draft
from grader.robot.reader import read_urdf
from grader.source import Location
from grader.submission.editing import edited_files, with_files
from grader.submission.submission import Submission
from grader.submission.urdf import Read

if TYPE_CHECKING:
    from grader.package.package import Package


class Hinted(NamedTuple):
    """A report with hints, and the edits of all hints that fit together."""

    report: Report
    edits: Edits


def hinted(report: Report, submission: Submission, level: Level, *, keep_edits: bool = False) -> Hinted:
    """Return a report with proven hints for the criteria that failed; `keep_edits` keeps edits that the level does not show."""
    results = {result.criterion.id: result for result in report.results}
    reference = _Reference(report.rubric)
    search = Search(Trials(report.rubric, submission, results), reference.draft, reference.package).run()
    costs = costs_of(results)
    hints = {
        name: hint
        for found in reversed(search.found)
        for hint in [_hint(found, level, submission, costs, keep_edits=keep_edits)]
        for name in found.gains
    }
    with_hints = [
        result._replace(hints=(hints[result.criterion.id],)) if result.criterion.id in hints else result
        for result in report.results
    ]
    return Hinted(replace(report, results=tuple(with_hints)), search.final.edits)


def fixed(found: Hinted, submission: Submission) -> Fix:
    """Return the files with the edits of all hints that fit together, graded again."""
    files = edited_files(submission, found.edits) or {}
    report = found.report
    return Fix(
        files,
        grade(report.rubric, with_files(submission, files), report.parts, is_one_of_class=not submission.is_single),
    )


def _hint(
    found: Found, level: Level, submission: Submission, costs: Mapping[str, Decimal], *, keep_edits: bool
) -> Hint:
    first = found.edits[0]
    at = Location(first.path, first.line, first.column)
    edits = found.edits if keep_edits or level == "edit" else ()
    return Hint(message(found, level, submission, costs), at, found.gains, edits, found.proposal.said)


class _Reference:
    """The reference solution of a rubric, of which no more is read than is needed."""

    def __init__(self, rubric: Rubric) -> None:
        self._rubric = rubric

    @cached_property
    def _submission(self) -> Submission | None:
        try:
            return open_reference(self._rubric) if self._rubric.reference else None
        except InputError:
            return None

    @property
    def draft(self) -> Draft | None:
        """The robot."""
        file = self._rubric.path.parent / self._rubric.reference / self._rubric.urdf
        if self._rubric.reference and file.is_file():
            return Draft.of(read_urdf(read_capped(file), self._rubric.urdf))
        urdf = self._submission.urdf if self._submission is not None else None
        return Draft.of(urdf.reading) if isinstance(urdf, Read) else None

    def package(self) -> "Package | None":
        """Return the package."""
        return self._submission.package if self._submission is not None else None
