"""The content of a report, for every format to lay out: the order of its criteria, and what it says of the submission.

People read a report from the top: what to fix comes first, what is fine last. All of it is printable text.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal
from itertools import groupby
from typing import NamedTuple

from grader.checks.loading import urdf_loads
from grader.grading.criterion import worth
from grader.grading.report import EvidenceResult, Report, Result
from grader.problems import Problem
from grader.report.criteria import (
    Answer,
    Entry,
    Line,
    Section,
    alike,
    blocks_of,
    is_failure,
    points_of,
    skipped_text,
    status_of,
    sum_text,
)
from grader.report.locations import location_text
from grader.text import counted_points, enumerated, first_lines, format_points, printable, shell_quoted
from grader.xml.xml_problems import RECOVERED

_REMARKS = ("Marked manually", "Corrected after grading", "Comments")
UNDECIDED = "xacro that cannot be determined statically"
VERDICTS = {
    "clean": "ROS 2 loads the file",
    "degraded": "ROS 2 loads the file, but drops content of it",
    "rejected": "ROS 2 rejects the file",
}
_MAX_LISTED = 12
_STATUSES = ("passed", "failed", "skipped", "pending", "errored", "adjusted", "marked manually")


class ReportSections(NamedTuple):
    """The criteria of a report, except those that passed and have no remark."""

    failures: tuple[Entry, ...]
    skipped: tuple[Line, ...]  # although nothing failed: a mark overrides the cause, or nothing was submitted
    pending: tuple[Entry, ...]  # what needs manual grading
    remarks: tuple[Section, ...]  # what did not fail and has a mark, an adjustment or a comment; some in two of them

    @property
    def sections(self) -> Iterator[Section]:
        """What failed, what needs manual grading, and the remarks."""
        if self.failures or self.skipped:
            yield Section("Failed" if self.failures else "Not graded", self.failures, self.skipped)
        if self.pending:
            yield Section("Needs manual grading", self.pending)
        yield from self.remarks


def report_sections(report: Report, *, everything: bool = False) -> ReportSections:
    """Return the description of a report; with `everything` the rubric's feedback where there is a hint, too."""
    known = entries(report, everything=everything)
    others = [entry for entry in known.values() if not is_failure(entry.result)]
    by_status = dict(alike(others, lambda entry: entry.status))
    skipped = alike((one.result for one in by_status.get("skipped", ())), lambda one: one.because or "")
    commented = [one for one in others if one.result.comment and one.status not in ("pending", "adjusted")]
    marked = [one for one in others if one.result.manual_mark]
    remarks = zip(_REMARKS, (marked, by_status.get("adjusted", ()), commented), strict=True)
    failed = [known[failure.id] for failure in failures(report)]
    return ReportSections(
        tuple(_join_equal(_without_repeats(failed))),
        tuple(
            Line("skipped", skipped_text(cause, some))
            for cause, some in skipped
            if cause not in known or not known[cause].skipped
        ),
        tuple(_join_equal(by_status.get("pending", ()))),
        tuple(Section(title, tuple(some)) for title, some in remarks if some),
    )


def entries(report: Report, *, everything: bool = False) -> Mapping[str, Entry]:
    """Return the entry of every criterion by its id, in the rubric's order."""
    failed = {failure.id: failure for failure in failures(report)}
    found = (failed.get(result.criterion.id, Entry(result)) for result in report.results)
    return {one.id: one._replace(blocks=tuple(blocks_of(one, report, everything=everything))) for one in found}


def failures(report: Report) -> tuple[Entry, ...]:
    """Return the criteria that failed or lost points, without blocks; those that one edit fixes follow each other.

    What keeps ROS 2 from loading the file comes first, then the costliest mistake. What is about a package that was not
    submitted, and then what is carried forward, comes last. Equals are in the rubric's order.
    """
    skipped = dict(alike((one for one in report.results if status_of(one) == "skipped"), lambda one: one.because or ""))
    found = [Entry(one, skipped.get(one.criterion.id, ())) for one in report.results if is_failure(one)]
    mistakes = [_fixed_together(some) for _, some in alike(found, _shared_edit)]
    is_rejected, has_package = report.submission.verdict == "rejected", report.submission.package is not None

    def rank(mistake: tuple[Entry, ...]) -> tuple[bool, bool, bool, Decimal]:
        criteria = [failure.result.criterion for failure in mistake]
        is_last = not has_package and report.rubric.part(criteria[0].part).needs == "package"
        is_urgent = is_rejected and any(criterion.check.subject == "urdf" for criterion in criteria)
        lost = sum((failure.lost for failure in mistake), Decimal(0))
        return bool(mistake[0].result.why_given), is_last, not is_urgent, -lost

    return tuple(failure for mistake in sorted(mistakes, key=rank) for failure in mistake)


def _shared_edit(failure: Entry) -> str:
    """Return what failures have in common that one edit fixes."""
    hint = failure.result.hint
    return hint.shown_by if hint is not None and not failure.result.why_given else failure.id


def _fixed_together(some: tuple[Entry, ...]) -> tuple[Entry, ...]:
    """Return failures that one edit fixes: the one that shows the hint first, then those of the file, the costliest."""

    def rank(failure: Entry) -> tuple[bool, bool, Decimal]:
        is_shown = failure.result.hint is not None and failure.result.hint.shown_by == failure.id
        return not is_shown, failure.result.criterion.check.subject != "urdf", -failure.lost

    first, *also = sorted(some, key=rank)
    return first._replace(also=tuple(also)), *(one._replace(first=first.id) for one in also)


def _without_repeats(failed: Iterable[Entry]) -> Iterator[Entry]:
    """Yield entries without feedback that an earlier one has."""
    seen = set[Line]()
    for entry in failed:
        feedback = {one for one in entry.blocks if isinstance(one, Line) and one.role == "feedback"}
        yield entry._replace(blocks=tuple(block for block in entry.blocks if block not in feedback & seen))
        seen |= feedback


def _join_equal(entries: Iterable[Entry]) -> Iterator[Entry]:
    """Yield one entry for all that could not be graded for the same reason."""
    for _, (first, *others) in alike(entries, _reason_to_join):
        names = enumerated([entry.id for entry in others])
        line = Line("alike", f"The same holds for {names} ({points_of(one.result for one in others)}).")
        yield first._replace(also=tuple(others), blocks=(*first.blocks, line)) if others else first


def _reason_to_join(entry: Entry) -> str:
    """Return why a criterion could not be graded; of others, and of those with an answer or a comment, the id."""
    outcome, has_own = entry.result.outcome, any(isinstance(block, Answer) for block in entry.blocks)
    is_ungraded = entry.status in ("pending", "errored") and not (has_own or entry.result.comment)
    return outcome.mistake or outcome.message if is_ungraded else entry.id


def score_text(report: Report) -> str:
    """Return the points that count and the maximum, 58.5 / 70 points, or that the student is excused."""
    points = counting_text(report)
    return f"{points} / {format_points(report.max_score)} points" if report.counting is not None else points


def counting_text(report: Report) -> str:
    """Return the points that count for the student: 58.5, excused, or a dash if nothing is decided."""
    if report.grade is None:
        return sum_text(report.results)
    return format_points(report.grade.points) if report.grade.points is not None else "Excused"


def grade_line(report: Report) -> str:
    """Return how the grade of a student in a class came about; empty if it is the score of automatic criteria."""
    if report.grade is None:
        return ""
    marked = [result.points for result in report.results if result.manual_mark is not None]
    manual = sum(marked, Decimal(0))
    text = f"{format_points(report.score - manual)} automatic"
    text += f" + {format_points(manual)} manual" if marked else ""
    text += f" - {format_points(-report.grade.late)} late" if report.grade.late else ""
    if report.grade.points is None:
        return f"Excused; the criteria give {text} points."
    return f"Final mark, instead of {text} points." if report.grade.is_final else f"Points: {text}."


def summary(report: Report) -> str:
    """Return the URDF, whether ROS 2 loads it, and how many criteria passed, failed, and so on."""
    path, words = report.submission.path, verdict_and_counts(report)
    return f"{printable(path)}: {words}" if path is not None else words


def verdict_and_counts(report: Report) -> str:
    """Return whether ROS 2 loads the URDF, and how many criteria passed, failed, and so on."""
    submission = report.submission
    urdf = "the URDF could not be read" if submission.unread else "no URDF was submitted"
    if submission.path is not None and submission.has_urdf:
        urdf = VERDICTS[submission.verdict] if submission.verdict else UNDECIDED
    statuses = Counter(_counted_status(result) for result in report.results)
    counts = (f"{count} {_status_words(status, count)}" for status in _STATUSES if (count := statuses[status]))
    return f"{urdf}; {', '.join(counts)}"


def _counted_status(result: Result) -> str:
    if result.manual_mark:
        return "marked manually"
    return "adjusted" if result.is_adjusted else result.outcome.status


def _status_words(status: str, count: int) -> str:
    if status == "pending":
        return "needs manual grading" if count == 1 else "need manual grading"
    return "corrected after grading" if status == "adjusted" else status


def bonus_line(report: Report) -> str:
    """Return how much extra credit is in the score; empty if the rubric has none."""
    bonus = worth(result.criterion for result in report.results).bonus
    if not bonus:
        return ""
    return f"Extra credit: {format_points(report.bonus)} of {counted_points(bonus)}, in addition to the maximum."


def package_line(report: Report) -> str:
    """Return the package that is graded and its folder; empty if none is."""
    package = report.submission.package
    if package is None or not any(report.rubric.part(part).needs == "package" for part in report.parts):
        return ""
    text = f"package {package.name}"
    return printable(f"{text} in {package.folder}" if package.folder else text)


def head(report: Report) -> Iterator[Line]:
    """Yield what a report says first: how the grade came about, the URDF, the criteria, the package, what is open."""
    for text in (grade_line(report), summary(report), bonus_line(report), package_line(report)):
        if text:
            yield Line("summary", text)
    if report.open_points:
        names = [printable(result.criterion.id) for result in report.pending_automatic]
        rest = f"; could not be decided: {enumerated(names, _MAX_LISTED)}" if names else ""
        yield Line("pending", pending_points(report) + rest)
    sha256 = report.rubric.sha256
    yield Line("provenance", f"grader {report.version}, rubric {printable(report.rubric.id)}, sha256 {sha256}")
    yield from (Line("note", text) for text in notes(report))


def pending_points(report: Report) -> str:
    """Return how many points need manual grading."""
    return f"{counted_points(report.pending)} {'needs' if report.pending == 1 else 'need'} manual grading"


def notes(report: Report) -> list[str]:
    """Return notes on how the submission was read."""
    return [f"Note: {printable(note)}" for note in report.all_notes]


def closing(report: Report) -> Iterator[Section]:
    """Yield the evidence, the problems that no criterion has reported, and other candidates with ignored files."""
    files = [f"Other candidate {file.path}: {file.reason}" for file in report.submission.unused_candidates]
    files += [f"Ignored: {file}" for file in report.submission.ignored]
    problems = other_problems(report)
    sections = (
        Section("Evidence", lines=tuple(_evidence(report))),
        Section(
            f"Other problems in the {'file' if report.submission.is_single else 'files'}",
            lines=tuple(Line(problem.severity, problem_line(problem)) for problem in problems),
        ),
        Section("Ignored files", lines=tuple(Line("ignored", printable(it)) for it in first_lines(files, _MAX_LISTED))),
    )
    yield from (section for section in sections if section.lines)


def closing_lines(report: Report) -> list[str]:
    """Return the evidence, other problems and files as plain text."""
    return [text for part in closing(report) for text in (f"{part.title}:", *(line.text for line in part.lines))]


def _evidence(report: Report) -> Iterator[Line]:
    """Yield the title of each part, then its evidence; last the other pictures."""
    for part, of_part in groupby(report.evidence, key=lambda found: found.evidence.part):
        yield Line("part", printable(report.rubric.part(part).title))
        yield from (Line("found" if found.files else "missing", _evidence_text(found)) for found in of_part)
    if report.other_pictures:
        yield Line("part", "Other pictures and documents")
        yield from (Line("found", printable(file.words)) for file in report.other_pictures)


def _evidence_text(found: EvidenceResult) -> str:
    """Return a piece of evidence with its files, or with those that are perhaps meant."""
    files = ", ".join(file.words for file in found.files)
    perhaps = enumerated([file.words for file in found.possible], _MAX_LISTED, "or")
    return printable(f"{found.evidence.title}: {files or (f'perhaps {perhaps}' if perhaps else 'missing')}")


def problem_line(problem: Problem) -> str:
    """Return a problem with its code, severity and location."""
    return f"{problem.code} {problem.severity} {location_text(problem.location)}: {printable(problem.message)}"


def other_problems(report: Report) -> list[Problem]:
    """Return the problems that no failed criterion has reported."""
    failed = [result for result in report.results if result.outcome.status == "failed"]
    reported = {(it.outcome.location, it.outcome.problem or it.outcome.message) for it in failed}
    told = [(RECOVERED, "") for it in failed if it.criterion.check.function is urdf_loads]
    left = (problem for problem in report.problems if (problem.kind, problem.subject) not in told)
    return [problem for problem in left if (problem.location, problem.message) not in reported]


def next_command(report: Report) -> str:
    """Return the command that explains the costliest failure, or else what is undecided; empty without either."""
    failed = [failure.result for failure in failures(report) if failure.result.manual_mark is None]
    first = next(iter((*failed, *report.pending_automatic)), None)
    return _explain_command(first.criterion.id, report) if first is not None else ""


def what_is_left(report: Report) -> str:
    """Return what is left where no command follows; points may be lost by a manual mark."""
    start = "No check failed" if failures(report) else "Nothing to fix"
    return f"{start}: {pending_points(report)}." if report.open_points else f"{start}."


def _explain_command(name: str, report: Report) -> str:
    """Return the command that explains a criterion. It shows no part of the rubric's path above the current folder."""
    if report.rubric.is_copy_of_shipped:
        return f"grader explain {name}"
    path = report.rubric.path
    return f"grader explain {name} --rubric {shell_quoted(path.name if path.is_absolute() else path)}"
