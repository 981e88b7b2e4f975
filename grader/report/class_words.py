"""The sentences about a class in every format for people: counts, grades, criteria, edits, identical work."""

from collections.abc import Iterator, Mapping, Sequence
from decimal import ROUND_FLOOR, Decimal
from textwrap import dedent

from grader.classroom.gradebook.hints import CommonFix
from grader.classroom.gradebook.identical import IdenticalWork
from grader.classroom.gradebook.statistics import ClassStatistics
from grader.classroom.gradebook.summary import ClassSummary
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric
from grader.report.details import sentence
from grader.source import Edit
from grader.text import counted, counted_points, cut, enumerated, format_points, people_text, printable

VERDICTS = {
    "graded": "graded",
    "unreadable": "could not be graded",
    "errored": "errored",
    "missing": "without a submission",
}
CRITERIA_NOTE = (
    "Share: the mean share of the points that students earned. Discrimination: whether students who earned the rest of"
    " the grade earned these points, too (a correlation from -1 to 1). Below 0.2 a criterion hardly separates strong"
    " from weak submissions; below 0 it may be wrong."
)
NOT_DEDUCTED_NOTE = "Not deducted: failed because of an earlier mistake alone, or corrected after grading."
FIXES_NOTE = "Each edit was tested: the listed criteria pass, and no other criterion fails."
IDENTICAL_NOTE = (
    "The same robot may differ in names, order, comments and the spelling of numbers. This is no verdict: students who"
    " follow the handout and make the same mistake have the same robot or files."
)
DECIDED = " (scaled up from the points that need no manual grading)"
ATTENTION_NOTE = "--verbose lists all students."
MAX_DETAILS = 5  # students with details who need attention for one reason
MAX_LISTED = 10  # mistakes, and edits
MAX_GROUPS = 20  # of identical work
_LOW_DISCRIMINATION = 0.2
MAX_NAMED = 12
_TOTALS = ("earned", "lost", "need manual grading")
_FINAL = "which a person gave instead of the sum of the criteria"
_MAX_EDITS, _MAX_LINES, _MAX_CRITERIA = 4, 6, 4
_MAX_WIDTH = 200  # characters of a line of a student's file


def counts_line(statistics: ClassStatistics) -> str:
    """Return how many students were graded, and how many were not."""
    counts = [(statistics.verdicts.get(verdict, 0), words) for verdict, words in VERDICTS.items()]
    return ", ".join(f"{count} {words}" for count, words in counts if count) or "no students"


def earlier_line(statistics: ClassStatistics) -> str:
    """Return how many students were graded by an earlier rubric only; empty if there are none."""
    earlier = statistics.verdicts.get("graded", 0) - statistics.graded
    return f"{earlier} graded by an earlier rubric only: not in these statistics" if earlier else ""


def final_line(statistics: ClassStatistics) -> str:
    """Return how many students have a final mark or are excused; empty if there are none."""
    final, excused = statistics.final, statistics.excused
    others = final - statistics.final_graded
    parts = (
        (final, f"{counted(final, 'student')} {'has' if final == 1 else 'have'} a final mark, {_FINAL}"),
        (others, f"{others} of them without a graded submission: not in these statistics"),
        (excused, f"{counted(excused, 'student')} {'is' if excused == 1 else 'are'} excused: not in these statistics"),
    )
    return "; ".join(words for count, words in parts if count)


def criterion_name(criterion: Criterion) -> str:
    """Return the id of a criterion, and whether it is extra credit."""
    return printable(f"{criterion.id} (bonus)" if criterion.bonus else criterion.id)


def adjusted_lines(rubric: Rubric) -> list[str]:
    """Return the criteria that the rubric adjusts, each with what it changes and the reason."""
    adjusted = ((row.id, row.adjustment) for row in rubric.criteria if row.adjustment is not None)
    return [f"{printable(name)}: {sentence(adjustment.message)}" for name, adjustment in adjusted]


def mark_lines(statistics: ClassStatistics) -> Iterator[str]:
    """Yield the grades in one line, then what needs manual grading, and why."""
    maximum, earned = format_points(statistics.out_of), statistics.points
    if statistics.graded > statistics.undecided:
        yield (
            f"Grades out of {maximum}{DECIDED if earned.pending else ''}: mean {_mean(statistics)}, "
            f"standard deviation {statistics.deviation:.1f}, lowest {_grade(statistics.lowest, statistics)}, "
            f"median {_grade(statistics.median, statistics)}, highest {_grade(statistics.highest, statistics)}"
        )
    if statistics.undecided:
        most = "because most of the automatic points need manual grading"
        yield f"Not in these grades: {counted(statistics.undecided, 'submission')}, {most}"
    if not earned.pending:
        return
    shares = [f"{points / statistics.graded:.1f} {what}" for points, what in zip(earned, _TOTALS, strict=True)]
    verb = "needs" if statistics.pending == 1 else "need"
    yield f"Points on average: {', '.join(shares)}; {counted(statistics.pending, 'submission')} {verb} manual grading"
    if statistics.reasons:
        (reason, count), *others = statistics.reasons
        more = f"; {sum(number for _, number in others)} for other reasons" if others else ""
        yield printable(f"Checks without a result: {counted(count, 'submission')}: {reason}{more}")


def span(statistics: ClassStatistics, tenth: int) -> str:
    """Return the grades of a tenth of the maximum: "10 to 20"."""
    step = statistics.out_of / len(statistics.bins)
    return f"{format_points(step * tenth)} to {format_points(step * (tenth + 1))}"


def percent(share: float) -> str:
    """Return a share in percent, not rounded up to 100 % or down to 0 %."""
    return f"{share:.0%}" if share in (0, 1) else f"{min(99, max(1, round(100 * share)))}%"


def is_low(discrimination: float | None) -> bool:
    """Return whether a criterion says little about a student."""
    return discrimination is not None and discrimination < _LOW_DISCRIMINATION


def gain(fix: CommonFix) -> str:
    """Return which criteria pass with an edit, and the points that it gains."""
    points = f", +{counted_points(fix.points)}" if fix.points else ""
    verb = "passes" if len(fix.criteria) == 1 else "pass"
    return printable(f"{enumerated(fix.criteria, _MAX_CRITERIA)} {verb}{points}")


def edit_lines(edits: Sequence[Edit]) -> Iterator[tuple[str, str]]:
    """Yield the lines of edits, each with its sign: removed (-), added (+), or a remark."""
    for edit in edits[:_MAX_EDITS]:
        if edit.renamed:
            yield " ", f"rename {edit.path} to {edit.renamed}"
        for sign, text in (("-", edit.old), ("+", edit.new)):
            lines = _lines(text)
            for line in lines[:_MAX_LINES]:
                yield sign, cut(line, _MAX_WIDTH)
            if len(lines) > _MAX_LINES:
                yield " ", f"... {len(lines) - _MAX_LINES} more lines"
    if len(edits) > _MAX_EDITS:
        yield " ", f"... {counted(len(edits) - _MAX_EDITS, 'more edit')}"


def what_is_same(work: IdenticalWork, names: Mapping[str, str]) -> str:
    """Return what is the same for all of the students, and who of them has the same file."""
    if work.students in work.same_file:
        return "the same file"
    files = (people_text([names[key] for key in keys], MAX_NAMED) for keys in work.same_file)
    return "; ".join([work.equal, *(f"the same file: {who}" for who in files)])


def identical_line(work: IdenticalWork, names: Mapping[str, str]) -> str:
    """Return the students of one group of identical work, by `names`."""
    return f"{people_text([names[key] for key in work.students], MAX_NAMED)}: {what_is_same(work, names)}"


def evidence_lines(summary: ClassSummary) -> list[str]:
    """Return how many submissions have evidence, but no URDF or package, unless the rubric says what to do then."""
    keys = {"URDF": summary.rubric.without_urdf, "package": summary.rubric.without_package}
    return [
        f"{counted(count, 'submission')} {'has' if count == 1 else 'have'} pictures or documents, "
        f"but no {kind} of this lab: the criteria of the {kind} fail. "
        f'Set `without_{kind.lower()} = "manual"` in the rubric to grade them manually, or "failed" to keep this'
        for kind, key in keys.items()
        if (count := summary.evidence_only[kind]) and not key
    ]


def late_line(summary: ClassSummary) -> str:
    """Return how many submissions are late and what they lost, or that this is unknown; empty if none is late."""
    late = summary.late
    if late.unknown:
        known = f"no submission time is known for {counted(late.unknown, 'submission')}"
        return f"{known}: add a column `submitted` to the roster"
    if not late.students:
        return ""
    if summary.rubric.late is None and not late.lost:
        return f"{counted(late.students, 'submission')} late: no points lost, because the rubric has no [late]"
    least, most = format_points(late.least), format_points(late.most)
    each = "" if late.students == 1 else f", {most} each" if least == most else f", {least} to {most} each"
    return f"{counted(late.students, 'submission')} late: {counted_points(late.lost)} lost{each}"


def _grade(points: Decimal, statistics: ClassStatistics) -> str:
    """Return a grade exactly, or to two decimals if some points need manual grading."""
    is_share = statistics.points.pending > 0
    return format_points(points.quantize(Decimal("0.01"), ROUND_FLOOR) if is_share else points)


def _mean(statistics: ClassStatistics) -> str:
    """Return the mean to one decimal, not rounded up to the maximum."""
    words = f"{statistics.mean:.1f}"
    is_full = Decimal(words) >= statistics.out_of > statistics.mean
    return format(Decimal(statistics.mean).quantize(Decimal("0.1"), ROUND_FLOOR), "f") if is_full else words


def _lines(text: str) -> list[str]:
    """Return the lines of an edit, which begins within a line, without the indent that the others have in common."""
    first, _, others = text.partition("\n")
    return [line for line in (first.strip(), *dedent(others).splitlines()) if line.strip()]
