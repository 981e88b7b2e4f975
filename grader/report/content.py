"""The content of a report, for every format to lay out.

It has the order of its criteria, and what it says of the submission.

People read a report from the top: what to fix comes first, what is fine last. All of it is
printable text.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import groupby

from grader.base.problems import Problem
from grader.base.records import Named
from grader.base.text import (
    counted,
    counted_points,
    enumerated,
    first_lines,
    format_points,
    printable,
    sentence,
    shell_quoted,
)
from grader.lab.checks.loading import urdf_loads
from grader.lab.checks.manual import answered, picture_name, picture_named
from grader.lab.grading.report import EvidenceResult, Report, Result, sum_points
from grader.lab.rubric.criterion import worth
from grader.lab.rubric.rubric_files import DEFAULT_RUBRIC
from grader.report.criteria import (
    Answer,
    Entry,
    Line,
    Section,
    alike,
    carried_text,
    hint_text,
    is_absent,
    is_failure,
    is_manual,
    is_not_found,
    looked_for,
    lost_points,
    make_blocks,
    name_status,
    sum_text,
    write_points,
)
from grader.report.readings import UNDECIDED, VERDICTS, problem_line
from grader.ros.api import RECOVERED, Absent

_REMARKS = ("Marked manually", "Corrected after grading", "Comments")
_MAX_LISTED = 12


class ReportSections(Named):
    """A report in the order in which a student needs it.

    Criteria that passed and have no remark are not among them.
    """

    mistakes: tuple[
        Entry, ...
    ]  # in what exists: first what keeps ROS 2 from loading the file, then the costliest
    unbuilt: tuple[Entry, ...]  # what is not there at all
    carried: tuple[Line, ...]  # failures that cost nothing
    missing: tuple[Line, ...]  # what was searched in vain: answers and pictures
    pending: tuple[Entry, ...]  # what needs manual grading
    remarks: tuple[
        Section, ...
    ]  # what did not fail and has a mark, an adjustment or a comment; some in two of them

    @property
    def sections(self) -> Iterator[Section]:
        """The parts under their titles."""
        if self.mistakes or self.carried:
            yield Section("Mistakes", self.mistakes, self.carried)
        if self.unbuilt:
            yield Section(self.unbuilt_title, lines=tuple(self.unbuilt_lines))
        if self.missing:
            yield Section("Not found", lines=self.missing)
        if self.pending:
            yield Section("Needs manual grading", self.pending)
        yield from self.remarks

    @property
    def unbuilt_title(self) -> str:
        """The title of what is not built yet, with the points that it costs."""
        points = lost_points(result for entry in self.unbuilt for result in entry.results)
        names = dict.fromkeys(
            name for entry in self.unbuilt for name in entry.result.outcome.absent
        )
        return printable(f"Not built yet: {', '.join(names)} ({counted_points(points)})")

    @property
    def unbuilt_lines(self) -> Iterator[Line]:
        """What to add, a line for each thing that is not there."""
        listed = set[str]()
        for entry in self.unbuilt:
            outcome = entry.result.outcome
            hint = entry.result.hint
            if not listed.issuperset(outcome.absent):
                if hint:
                    what = hint_text(entry, hint)
                else:
                    what = sentence(outcome.mistake or outcome.message)
                yield Line("unbuilt", f"{printable(', '.join(outcome.absent))}: {what}")
            listed.update(outcome.absent)


def report_sections(report: Report, *, everything: bool = False) -> ReportSections:
    """Return the description of a report.

    With `everything` it has the rubric's feedback where there is a hint, too.
    """
    if report.is_bare:
        return ReportSections((), (), (), (), (), ())
    known = entries(report, everything=everything)
    others = [entry for entry in known.values() if not is_failure(entry.result)]
    by_status = dict(alike(others, lambda entry: entry.status))
    failed = [known[failure.id] for failure in failures(report)]
    costing = [entry for entry in failed if not (entry.first or entry.result.why_given)]
    present, absent = _split(costing, is_absent)
    pending, not_found = _split(by_status.get("pending", ()), is_not_found)
    alone = _skipped_without_cause(by_status.get("skipped", ()), known)
    return ReportSections(
        mistakes=(*_join_equal(present), *alone),
        unbuilt=tuple(sorted(absent, key=_building_order)),
        carried=tuple(_carried_lines(failed)),
        missing=tuple(_missing_lines(report, [entry.result for entry in not_found])),
        pending=tuple(_join_equal(pending)),
        remarks=tuple(_remarks(others, by_status.get("adjusted", ()))),
    )


def _split(
    some: Iterable[Entry], belongs: Callable[[Result], bool]
) -> tuple[list[Entry], list[Entry]]:
    """Return the entries whose results do not have a property, and those whose do."""
    without = list[Entry]()
    having = list[Entry]()
    for entry in some:
        (having if belongs(entry.result) else without).append(entry)
    return without, having


def _skipped_without_cause(skipped: Iterable[Entry], known: Mapping[str, Entry]) -> Iterator[Entry]:
    """Yield what was skipped for a criterion under which it is not listed."""
    for cause, some in alike(skipped, lambda entry: entry.result.because or ""):
        if cause not in known or not known[cause].skipped:
            yield _skipped_alone(cause, some)


def _carried_lines(failed: Iterable[Entry]) -> Iterator[Line]:
    """Yield the failures that cost nothing, a line for each cause."""
    results = [entry.result for entry in failed if entry.result.carried]
    for cause, some in alike(results, lambda result: result.carried):
        yield Line("carried", carried_text(cause, some))


def _remarks(others: Sequence[Entry], adjusted: Sequence[Entry]) -> Iterator[Section]:
    """Yield what did not fail and has a mark, an adjustment or a comment."""
    marked = [entry for entry in others if entry.result.manual_mark]
    commented = []
    for entry in others:
        if entry.result.comment and entry.status not in ("pending", "adjusted"):
            commented.append(entry)
    for title, some in zip(_REMARKS, (marked, adjusted, commented), strict=True):
        if some:
            yield Section(title, tuple(some))


def _skipped_alone(cause: str, some: Sequence[Entry]) -> Entry:
    """Return the entry of criteria that are skipped although no mistake says so.

    A mark may override their cause.
    """
    if cause:
        why = f"Skipped because {cause} failed."
    else:
        why = "Not graded, because nothing was submitted."
    first, *others = some
    return first._replace(also=tuple(others), blocks=(Line("finding", printable(why)),))


def _building_order(entry: Entry) -> tuple[int, bool, int]:
    """Return the rank of what is not built yet.

    Criteria about one thing come first, those with a hint, as in the rubric.
    """
    return (
        len(entry.result.outcome.absent),
        not entry.result.hint,
        entry.result.criterion.position,
    )


def _missing_lines(report: Report, results: Sequence[Result]) -> Iterator[Line]:
    """Yield what was searched in vain for criteria and as evidence, and what is there instead."""
    yield from (Line("missing", text) for text in looked_for(results))
    others = [f"`{name}`" for name in _pictures_to_add(report, results)]
    if others:
        pictures = "a picture" if len(others) == 1 else "pictures"
        yield Line(
            "missing", printable(f"evidence: {pictures} named {enumerated(others, _MAX_LISTED)}")
        )
    unmatched = _unmatched(report) if results else []
    if unmatched:
        yield Line("there", printable(f"Matches nothing: {enumerated(unmatched, _MAX_LISTED)}"))


def _pictures_to_add(report: Report, results: Sequence[Result]) -> list[str]:
    """Return names for the pictures that are missing as evidence.

    Criteria with these results do not want them.
    """
    wanted = {result.outcome.expected for result in results}
    evidence = [
        result.evidence.names for result in report.evidence if not (result.files or result.possible)
    ]
    return [picture_name(names) for names in evidence if picture_named(names) not in wanted]


def hand_in_line(report: Report) -> str:
    """Return how many answers and pictures were searched in vain; empty if there are all."""
    missing = [result for result in report.results if is_not_found(result)]
    answers = sum(result.criterion.check.function is answered for result in missing)
    pictures = len(missing) - answers
    without = len(_pictures_to_add(report, missing))
    counts = [counted(answers, "answer")] if answers else []
    counts += [f"{counted(pictures, 'picture')} with points"] if pictures else []
    if without and pictures:
        counts.append(f"{without} without")
    elif without:
        counts.append(f"{counted(without, 'picture')} without points")
    return f"Not found yet: {', '.join(counts)} (--verbose)" if counts else ""


def found_line(pending: Sequence[Entry]) -> str:
    """Return what was found for a person to grade; empty if there is more to say of any of it."""
    results = [result for entry in pending for result in entry.results]
    if not results or not all(is_manual(one) and one.outcome.problem == "" for one in results):
        return ""
    names = enumerated([printable(result.id) for result in results])
    return f"Needs manual grading ({write_points(results)}): {names}"


def _unmatched(report: Report) -> list[str]:
    """Return the documents that were read and the pictures in which nothing was found."""
    used = {
        result.outcome.location.path
        for result in report.results
        if result.is_open and result.outcome.location
    }
    documents = report.submission.readable_documents
    read = documents.read if documents else ()
    return [
        path
        for path in dict.fromkeys((*read, *(file.path for file in report.other_pictures)))
        if path not in used
    ]


def entries(report: Report, *, everything: bool = False) -> Mapping[str, Entry]:
    """Return the entry of every criterion by its id, in the rubric's order."""
    failed = {failure.id: failure for failure in failures(report)}
    entries_in_order = (failed.get(result.id, Entry(result)) for result in report.results)
    filled = {
        one.id: one._replace(blocks=tuple(make_blocks(one, report, everything=everything)))
        for one in entries_in_order
    }
    return {
        name: one._replace(also=tuple(filled[other.id] for other in one.also))
        for name, one in filled.items()
    }


def failures(report: Report) -> tuple[Entry, ...]:
    """Return the criteria that failed or lost points, without blocks.

    Those that one edit fixes follow each other.

    What keeps ROS 2 from loading the file comes first, then the costliest mistake; what is carried
    forward comes last. Equals are in the rubric's order.
    """
    skipped = dict(
        alike(
            (one for one in report.results if name_status(one) == "skipped"),
            lambda one: one.because or "",
        )
    )
    mistakes_found = [
        Entry(one, skipped.get(one.id, ())) for one in report.results if is_failure(one)
    ]
    mistakes = [_fixed_together(some) for _, some in alike(mistakes_found, _shared_edit)]
    is_rejected = report.submission.verdict == "rejected"

    def rank(mistake: tuple[Entry, ...]) -> tuple[bool, bool, Decimal]:
        first = mistake[0].result
        is_urgent = is_rejected and any(
            entry.result.criterion.check.subject == "urdf" for entry in mistake
        )
        return bool(first.why_given), not is_urgent, -mistake[0].lost

    return tuple(failure for mistake in sorted(mistakes, key=rank) for failure in mistake)


def _shared_edit(failure: Entry) -> str:
    """Return what failures have in common that one edit fixes.

    Without a hint, it is what is said of them. A mark stands alone.
    """
    result = failure.result
    outcome = failure.result.outcome
    if result.why_given or result.manual_mark:
        return f"only {failure.id}"
    if result.hint:
        return result.hint.shown_by
    return f"{outcome.mistake or outcome.message} {outcome.location}"


def _fixed_together(some: tuple[Entry, ...]) -> tuple[Entry, ...]:
    """Return failures that one edit fixes.

    The one that shows the hint comes first, then those of the file, the costliest.
    """

    def rank(failure: Entry) -> tuple[bool, bool, Decimal]:
        is_shown = failure.result.hint is not None and failure.result.hint.shown_by == failure.id
        return not is_shown, failure.result.criterion.check.subject != "urdf", -failure.lost

    first, *also = sorted(some, key=rank)
    return first._replace(also=tuple(also)), *(one._replace(first=first.id) for one in also)


def _join_equal(entries: Iterable[Entry]) -> Iterator[Entry]:
    """Yield one entry for all that could not be graded for the same reason."""
    for _, (first, *others) in alike(entries, _reason_to_join):
        names = enumerated([entry.id for entry in others])
        line = Line(
            "alike",
            f"The same holds for {names} ({write_points(entry.result for entry in others)}).",
        )
        yield first._replace(also=tuple(others), blocks=(*first.blocks, line)) if others else first


def _reason_to_join(entry: Entry) -> str:
    """Return why a criterion could not be graded.

    Of others, and of those with an answer or a comment, return the id.
    """
    outcome = entry.result.outcome
    has_own = any(isinstance(block, Answer) for block in entry.blocks)
    is_ungraded = entry.status in ("pending", "errored") and not (has_own or entry.result.comment)
    if is_ungraded:
        return outcome.mistake or outcome.message
    return entry.id


def result_line(report: Report, sections: ReportSections) -> str:
    """Return the result in a line.

    It has the points of what is decided, what they were lost by, and what is open.

    Of a student in a class it is the grade, and how it came about.
    """
    if report.grade:
        return _result_with_grade(report)
    open_maximum = sum_points(
        result.criterion.maximum for result in report.results if result.is_open
    )
    decided = report.max_score - open_maximum
    if decided == 0 and not sections.mistakes:
        return sentence(_pending_points(report)) if report.pending else "Nothing to grade."
    points = f"{format_points(report.score)} of {counted_points(decided)}"
    reasons = _reasons_of_loss(sections)
    if reasons:
        text = f"{points}: {', '.join(reasons)}"
    elif report.pending_automatic:
        text = f"No mistakes found: {points}"
    else:
        text = f"All automatic checks passed: {points}"
    if report.pending:
        verb = "needs" if report.pending == 1 else "need"
        text += f"; {format_points(report.pending)} more {verb} manual grading"
    return f"{text}."


def _result_with_grade(report: Report) -> str:
    """Return the result of a student in a class in a line: the grade, and how it came about."""
    texts = [grade_line(report)]
    if report.counting is not None:
        texts.insert(0, f"{score_text(report)}.")
    if report.open_points:
        texts.append(f"{_pending_points(report)}.")
    return " ".join(texts)


def _reasons_of_loss(sections: ReportSections) -> list[str]:
    """Return what the points were lost by, each with the points."""
    faulty = [entry for entry in sections.mistakes if entry.status == "errored"]
    mistakes = [entry for entry in sections.mistakes if entry.status != "errored"]
    reasons = []
    if mistakes and all(entry.result.criterion.bonus and not entry.lost for entry in mistakes):
        reasons.append(f"{counted(len(mistakes), 'mistake')} in extra credit")
    elif mistakes:
        reasons.append(
            f"{counted(len(mistakes), 'mistake costs', 'mistakes cost')} {_lost_by(mistakes)}"
        )
    if sections.unbuilt:
        reasons.append(
            f"what is not built yet{'' if reasons else ' costs'} {_lost_by(sections.unbuilt)}"
        )
    if faulty:  # no mistake of the student
        reasons.append(
            f"{counted(len(faulty), 'faulty check costs', 'faulty checks cost')} {_lost_by(faulty)}"
        )
    return reasons


def _lost_by(entries: Iterable[Entry]) -> str:
    return format_points(sum_points(entry.lost for entry in entries))


def score_text(report: Report) -> str:
    """Return the points that count and the maximum: 58.5 / 70 points.

    Of an excused student, return that.
    """
    points = counting_text(report)
    if report.counting is not None:
        return f"{points} / {format_points(report.max_score)} points"
    return points


def counting_text(report: Report) -> str:
    """Return the points that count for the student.

    For example, this is 58.5, excused, or a dash if nothing is decided.
    """
    if not report.grade:
        return sum_text(report.results)
    if report.grade.points is not None:
        return format_points(report.grade.points)
    return "Excused"


def grade_line(report: Report) -> str:
    """Return how the grade of a student in a class came about.

    It is empty if it is the score of automatic criteria.
    """
    if not report.grade:
        return ""
    marked = [result.points for result in report.results if result.manual_mark]
    manual = sum_points(marked)
    text = f"{format_points(report.score - manual)} automatic"
    text += f" + {format_points(manual)} manual" if marked else ""
    text += f" - {format_points(-report.grade.late)} late" if report.grade.late else ""
    if report.grade.points is None:
        return f"Excused; the criteria give {text} points."
    if report.grade.is_final:
        return f"Final mark, instead of {text} points."
    return f"Points: {text}."


def graded_line(report: Report) -> str:
    """Return the rubric and what is graded with it.

    This is the URDF, else the submission; in a class whose it is.
    """
    graded = f"{report.rubric.id}: {report.submission.path or report.submission.id}"
    return printable(f"{graded} ({report.student})" if report.student else graded)


def verdict_line(report: Report) -> str:
    """Return whether ROS 2 loads the URDF."""
    submission = report.submission
    text = "the URDF could not be read"
    if isinstance(submission.urdf, Absent):
        text = submission.urdf.reason
    elif submission.has_urdf:
        text = VERDICTS[submission.verdict] if submission.verdict else UNDECIDED
    return sentence(text)


def bonus_line(report: Report) -> str:
    """Return how much extra credit is in the score; empty if the rubric has none."""
    bonus = worth(result.criterion for result in report.results).bonus
    if not bonus:
        return ""
    return (
        f"Extra credit: {format_points(report.bonus)} of {counted_points(bonus)}, in addition "
        "to the maximum."
    )


def package_line(report: Report) -> str:
    """Return the packages that are graded and their folders; empty if none is."""
    packages = report.submission.lab_packages.values()
    if not packages or not any(
        report.rubric.part(part).needs == "package" for part in report.parts
    ):
        return ""
    named = [
        f"{package.name} in {package.folder}" if package.folder else package.name
        for package in packages
    ]
    return printable(f"package{'s' * (len(named) > 1)} {', '.join(named)}")


def head(report: Report, sections: ReportSections) -> Iterator[Line]:
    """Yield what a report says first.

    This is what is graded, the result, whether ROS 2 loads the URDF, the package, and notes.
    """
    yield Line("graded", graded_line(report))
    yield Line("result", result_line(report, sections))
    for text in (verdict_line(report), bonus_line(report), package_line(report)):
        if text:
            yield Line("summary", text)
    sha256 = report.rubric.sha256
    yield Line(
        "provenance",
        f"grader {report.version}, rubric {printable(report.rubric.id)}, sha256 {sha256}",
    )
    yield from (Line("note", text) for text in notes(report))


def _pending_points(report: Report) -> str:
    """Return how many points need manual grading."""
    return (
        f"{counted_points(report.pending)} {'needs' if report.pending == 1 else 'need'} manual "
        "grading"
    )


def notes(report: Report) -> list[str]:
    """Return notes on how the submission was read."""
    return [f"Note: {printable(note)}" for note in report.all_notes]


def closing(report: Report) -> Iterator[Section]:
    """Yield what a report says last.

    This is the evidence, the problems that no criterion has reported, and other candidates with
    ignored files.
    """
    files = [
        f"Other candidate {file.path}: {file.reason}"
        for file in report.submission.unused_candidates
    ]
    files += [f"Ignored: {file}" for file in report.submission.ignored]
    problems = other_problems(report)
    sections = (
        Section("Evidence", lines=tuple(_evidence(report))),
        Section(
            f"Other problems in the {'file' if report.submission.is_single else 'files'}",
            lines=tuple(Line(problem.severity, problem_line(problem)) for problem in problems),
        ),
        Section(
            "Ignored files",
            lines=tuple(
                Line("ignored", printable(first_line))
                for first_line in first_lines(files, _MAX_LISTED)
            ),
        ),
    )
    yield from (section for section in sections if section.lines)


def closing_lines(report: Report) -> list[str]:
    """Return the evidence, other problems and files as plain text."""
    return [
        text
        for part in closing(report)
        for text in (f"{part.title}:", *(line.text for line in part.lines))
    ]


def _evidence(report: Report) -> Iterator[Line]:
    """Yield the title of each part, then its evidence; last the other pictures."""
    for part, of_part in groupby(report.evidence, key=lambda result: result.evidence.part):
        yield Line("part", printable(report.rubric.part(part).title))
        yield from (
            Line("found" if result.files else "missing", _evidence_text(result))
            for result in of_part
        )
    if report.other_pictures:
        yield Line("part", "Other pictures and documents")
        yield from (Line("found", printable(file.words)) for file in report.other_pictures)


def _evidence_text(result: EvidenceResult) -> str:
    """Return a piece of evidence with its files, or with those that are perhaps meant."""
    files = ", ".join(file.words for file in result.files)
    perhaps = enumerated([file.words for file in result.possible], _MAX_LISTED, "or")
    return printable(
        f"{result.evidence.title}: {files or (f'perhaps {perhaps}' if perhaps else 'missing')}"
    )


def other_problems(report: Report) -> list[Problem]:
    """Return the problems that no failed criterion has reported."""
    failed = [result for result in report.results if result.outcome.status == "failed"]
    reported = {
        (result.outcome.location, result.outcome.problem or result.outcome.message)
        for result in failed
    }
    payers = {result.id for result in failed}
    for paid in report.meant.paid if report.meant else ():
        if paid.payer in payers:
            reported.add((paid.slip.location, paid.slip.assumption))
    told = [(RECOVERED, "") for result in failed if result.criterion.check.function is urdf_loads]
    left = (problem for problem in report.problems if (problem.kind, problem.subject) not in told)
    return [problem for problem in left if (problem.location, problem.message) not in reported]


def next_command(report: Report, sections: ReportSections) -> str:
    """Return the command that explains the costliest failure, or else what is undecided.

    It is empty without either.
    """
    if report.student and not report.rubric.is_copy_of_shipped:  # which the student does not have
        return ""
    failed = [
        entry.result
        for entry in sections.mistakes + sections.unbuilt
        if not entry.result.manual_mark
    ]
    first = next(iter(failed + report.pending_automatic), None)
    if not first:
        return ""
    named = report.rubric.id if report.rubric.is_copy_of_shipped else report.rubric.path
    option = "" if named == DEFAULT_RUBRIC else f" --rubric {shell_quoted(named)}"
    return f"grader explain {first.id}{option}"
