"""Criteria in a report, alone and in groups.

Here are their status and points, and what is said about each, block by block.

A writer decides how a block looks in its medium and which roles it leaves out, but neither words
nor order.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from decimal import Decimal
from itertools import groupby
from typing import Literal, TypeVar

from grader.base.grouping import Strings
from grader.base.records import Named
from grader.base.source import Edits, Location, SourceOf
from grader.base.text import (
    by_name,
    enumerated,
    format_points,
    printable,
    sentence,
    signed_points,
)
from grader.lab.checks.manual import MANUAL_CHECKS
from grader.lab.checks.outcome import Outcome
from grader.lab.grading.report import Hint, Report, Result, sum_points
from grader.lab.rubric.criterion import Criterion, worth
from grader.report.locations import excerpt_lines, location_text

_T = TypeVar("_T")
_K = TypeVar("_K", bound=Hashable)
_MAX_FILES = 2
_MAX_CRITERIA = 3

# Of a submission, of a criterion, and of the list of evidence, problems and files.
Role = Literal[
    "graded",
    "result",
    "summary",
    "provenance",
    "finding",
    "comment",
    "hint",
    "feedback",
    "expected",
    "alike",
    "also",
    "skipped",
    "carried",
    "unbuilt",
    "there",
    "part",
    "found",
    "missing",
    "error",
    "warning",
    "note",
    "ignored",
]


def name_status(result: Result) -> str:
    """Return the status of a criterion.

    It is `adjusted` by the rubric, else that of the manual mark or the check.

    A manual mark is `passed` if it gives all points, and `partial` if it gives a part of them.
    """
    if result.is_adjusted:
        return "adjusted"
    if not result.manual_mark:
        return result.outcome.status
    if result.points >= result.criterion.points:
        return "passed"
    return "partial" if result.points else "failed"


def is_failure(result: Result) -> bool:
    """Return whether a criterion failed or lost points.

    A manual mark or an adjustment overrides the check.
    """
    return name_status(result) in ("failed", "partial", "errored")


def has_passed(result: Result) -> bool:
    """Return whether a check passed, without a mark or a comment."""
    return name_status(result) == "passed" and not result.manual_mark and not result.comment


def lost_points(results: Iterable[Result]) -> Decimal:
    """Return the points that criteria lost.

    Extra credit does not count, and nothing that needs manual grading.
    """
    decided = (result for result in results if not (result.criterion.bonus or result.is_open))
    return sum_points(result.criterion.maximum - result.points for result in decided)


def is_absent(result: Result) -> bool:
    """Return whether a criterion failed only because its subject is not built yet.

    No hint makes it pass.
    """
    is_found = result.hint is not None and bool(result.hint.gains)
    return (
        name_status(result) == "failed"
        and bool(result.outcome.absent)
        and not (result.carried or is_found)
    )


def is_not_found(result: Result) -> bool:
    """Return whether an answer or a picture was searched in vain."""
    return (
        is_manual(result)
        and result.is_open
        and result.outcome.expected is not None
        and not result.comment
    )


def is_manual(result: Result) -> bool:
    """Return whether a criterion is always graded manually: a question or a picture."""
    return result.criterion.check.function in MANUAL_CHECKS


def sum_text(results: tuple[Result, ...]) -> str:
    """Return the points of some criteria together.

    For example, this is 58.5, or a dash if all of them need manual grading.
    """
    is_open = bool(results) and all(result.is_open for result in results)
    if is_open:
        return "–"
    return format_points(sum_points(result.points for result in results))


def earned_text(*results: Result) -> str:
    """Return the points and the maximum of criteria together: 8/14, above it with extra credit.

    Other examples are –/14, and 5/5 bonus.
    """
    most = worth(result.criterion for result in results)
    maximum = format_points(most.points) if most.points or not most.bonus else most.short
    return f"{sum_text(results)}/{maximum}"


def write_points(results: Iterable[Result]) -> str:
    """Return the maximum of some criteria together.

    Examples are 14 points, 14 points and 5 bonus points, or 5 bonus points.
    """
    return worth(result.criterion for result in results).text


class Line(Named):
    """A printable sentence, and what it is."""

    role: Role
    text: str


class Answer(Named):
    """The lines of an answer, and whose it is."""

    title: Literal["Found", "Model answer"]
    lines: Strings


class Diff(Named):
    """The lines that edits change."""

    edits: Edits


Block = Line | Location | Answer | Diff  # a location is a place and its source line


class Entry(Named):
    """A criterion with what is said about it."""

    result: Result
    skipped: tuple[Result, ...] = ()  # the criteria that are skipped because it failed
    also: tuple[
        "Entry", ...
    ] = ()  # the criteria that the same edit fixes, or about which the same is said
    first: str = ""  # the criterion whose entry has this one in `also`, and shows the edit
    blocks: tuple[Block, ...] = ()  # what is said about it

    @property
    def id(self) -> str:
        """The id of the criterion."""
        return self.result.id

    @property
    def status(self) -> str:
        """The status of the criterion."""
        return name_status(self.result)

    @property
    def results(self) -> tuple[Result, ...]:
        """All criteria of the mistake.

        They are this one, those that its edit fixes, and those that are skipped because of it.
        """
        own_results = (self.result, *self.skipped)
        return (*own_results, *(result for other in self.also for result in other.results))

    @property
    def lost(self) -> Decimal:
        """The points that the mistake costs in all."""
        return lost_points(self.results)

    @property
    def cost(self) -> str:
        """The points that the mistake costs in all, as in `-8 points`.

        Of extra credit, it is what was earned.
        """
        if self.result.criterion.bonus and not self.lost:
            return f"{earned_text(self.result)} points"
        return (
            f"{signed_points(-self.lost) if self.lost else '0'} "
            f"{'point' if self.lost == 1 else 'points'}"
        )

    @property
    def names(self) -> str:
        """The criteria that lose points by the mistake.

        This is the only one, or each with its points, this one first.
        """
        costly = [result for result in self.results if lost_points((result,))]
        if [result.id for result in costly] in ([], [self.id]):
            return printable(self.id)
        named = [f"{result.id} {format_points(lost_points((result,)))}" for result in costly]
        rest = f" and {len(named) - _MAX_CRITERIA} more" if len(named) > _MAX_CRITERIA else ""
        return printable(", ".join(named[:_MAX_CRITERIA]) + rest)

    @property
    def location(self) -> Location | None:
        """Where to look, if the criterion failed."""
        return next((block for block in self.blocks if isinstance(block, Location)), None)

    def texts(self, *roles: Role) -> list[str]:
        """Return the sentences with these roles."""
        return [
            block.text for block in self.blocks if isinstance(block, Line) and block.role in roles
        ]


class Section(Named):
    """A part of a report under a title: entries, then lines."""

    title: str
    entries: tuple[Entry, ...] = ()
    lines: tuple[Line, ...] = ()


class CriteriaGroup(Named):
    """The criteria about one thing, in the rubric's order."""

    part: str
    title: str
    results: tuple[Result, ...]

    @property
    def points(self) -> str:
        """The points and the maximum of the group."""
        return earned_text(*self.results)

    @property
    def status(self) -> str:
        """The status of its worst criterion, without extra credit.

        One with all its points counts as passed.
        """
        counting = [result for result in self.results if not result.criterion.bonus] or self.results
        statuses = [
            name_status(result) for result in counting if result.points < result.criterion.points
        ]
        lost = {"failed", "partial", "errored"}.intersection(statuses)
        if lost:
            return "partial" if lost == {"partial"} else "failed"
        return next(iter(statuses), "passed")


def groups(report: Report) -> Iterator[CriteriaGroup]:
    """Yield the criteria in the rubric's order, those about one thing together.

    Others stand under the title of their part.
    """
    for (part, about), results in groupby(
        report.results, lambda one: (one.criterion.part, one.criterion.about)
    ):
        yield CriteriaGroup(part, about or report.rubric.part(part).title, tuple(results))


def alike(items: Iterable[_T], key: Callable[[_T], _K]) -> list[tuple[_K, tuple[_T, ...]]]:
    """Return each value of a key with the items that have it, in the order of the first ones."""
    items_by_key: dict[_K, list[_T]] = {}
    for item in items:
        items_by_key.setdefault(key(item), []).append(item)
    return [(value, tuple(some)) for value, some in items_by_key.items()]


def make_blocks(entry: Entry, report: Report, *, everything: bool = False) -> Iterator[Block]:
    """Yield what is said about a criterion.

    This is what is wrong and where, the answer, what to do, and what was expected.

    A hint is in place of the rubric's feedback; with `everything` there are both.
    """
    result = entry.result
    outcome = entry.result.outcome
    is_asked = outcome.status == "pending" and not result.is_adjusted
    has_failed = entry.status == "failed" and not result.manual_mark
    is_mistake = (
        has_failed and not result.carried
    )  # else the advice would be to change what is as it should be
    yield from _findings(result)
    at = _place_to_change(result) if is_mistake else outcome.location
    if at and has_failed:
        yield at
    if is_asked:
        yield from _answers(result)
    if is_mistake:
        yield from _advice(entry, report, everything=everything)
    if is_failure(result) and not is_asked:
        # The title of a criterion is never stated alone, because it would read as a fact.
        yield Line("expected", f"Passes when: {sentence(result.criterion.title)}")
    yield from _said_of_others(entry)
    if entry.skipped:
        names = enumerated([result.id for result in entry.skipped])
        yield Line("skipped", printable(f"Skipped because {entry.id} failed: {names}."))


def _advice(entry: Entry, report: Report, *, everything: bool) -> Iterator[Block]:
    """Yield the hint, or the rubric's feedback; with `everything` both."""
    result = entry.result
    criterion = entry.result.criterion
    hint = result.hint
    if hint:
        yield Line("hint", hint_text(entry, hint))
        if hint.edits and not entry.first:
            yield Diff(hint.edits)
    has_subject = report.submission.has_urdf or not criterion.check.is_of_robot
    feedback = criterion.feedback_on(result.outcome)
    if feedback and has_subject and (everything or not hint):
        yield Line("feedback", _one_line(feedback))


def _said_of_others(entry: Entry) -> Iterator[Line]:
    """Yield what is said of the criteria that are told with this one."""

    def describe_entry(other: Entry) -> str:
        return " ".join(line.text for line in _findings(other.result))

    for said, others in alike(entry.also, describe_entry):
        names = printable(enumerated([other.id for other in others]))
        is_same = said == describe_entry(entry)
        yield Line("also", f"The same holds for {names}." if is_same else f"{names}: {said}")


def _place_to_change(result: Result) -> Location | None:
    """Return the place of a failure, or of its hint where that is in another line."""
    at = result.outcome.location
    hint = result.hint
    if not hint or not hint.at.path or (at and (at.path, at.line) == (hint.at.path, hint.at.line)):
        return at
    return hint.at


def _findings(result: Result) -> Iterator[Line]:
    """Yield what the points of a criterion are due to, and the comment without points."""
    outcome = result.outcome
    mark = result.manual_mark
    comment = result.comment
    if result.is_adjusted:  # what the check found is not the student's mistake
        yield Line("finding", sentence(_one_line(result.why_given)))
    elif mark:
        words = f": {_one_line(mark.comment)}" if mark.comment else ""
        yield Line("finding", sentence(f"Marked{by_name(mark.by) or ' manually'}{words}"))
        if outcome.status != "pending":
            yield Line("finding", sentence(f"The check: {outcome.status}. {outcome.message}"))
    elif outcome.status == "skipped" and result.because:
        yield Line("finding", f"Skipped because {result.because} failed.")
    else:
        yield Line("finding", sentence(outcome.message))
        if result.why_given:
            yield Line("finding", result.why_given)
    if comment:
        yield Line("comment", sentence(f"Comment{by_name(comment.by)}: {_one_line(comment.text)}"))


def remarks_on(result: Result) -> list[str]:
    """Return why a criterion is adjusted, and a grader's comment; nothing without either."""
    return [line.text for line in _findings(result) if result.is_adjusted or line.role == "comment"]


def _answers(result: Result) -> Iterator[Answer]:
    """Yield the student's answer to a question, and the model answer.

    The latter is there if the rubric was loaded with its answers.
    """
    lines = tuple(printable(line) for line in answer_lines(result.outcome) if line.strip())
    model = tuple(printable(line) for line in model_lines(result.criterion) if line.strip())
    if lines:
        yield Answer("Found", lines)
    if model:
        yield Answer("Model answer", model)


def _one_line(text: str) -> str:
    """Return a text of a rubric or a comment in one printable line."""
    return printable(" ".join(text.split()))


def answer_lines(outcome: Outcome) -> list[str]:
    """Return the lines of the answer that a check found; none if it is not about a question."""
    if isinstance(outcome.measured, str):
        return outcome.measured.strip("\n").splitlines()
    return []


def model_lines(criterion: Criterion) -> list[str]:
    """Return the lines of the model answer.

    It is None if the criterion has no answer or is loaded without.
    """
    return criterion.answer.strip("\n").splitlines()


def counts_lines(location: Location) -> bool:
    """Return whether editors count the lines of a file.

    Of a PDF or Word file, a message names the page or heading.
    """
    return not location.path.lower().endswith((".pdf", ".docx"))


def hint_text(entry: Entry, hint: Hint) -> str:
    """Return the message of the hint of a failure.

    It also says which criteria have to be looked at after that edit.
    """
    if entry.first and not hint.fixed_with:
        return f"Fixed by the same edit as {entry.first}."
    left = list[str]()
    texts = [hint.message.removesuffix(".")]
    for result in entry.results:
        if result.id in hint.gains:
            continue
        if result.hint and result.hint.fixed_with and result is not entry.result:
            texts.append(f"{result.id}: {result.hint.message.removesuffix('.')}")
        else:
            left.append(result.id)
    if left and hint.gains:
        texts.append(f"Then check {enumerated(left, _MAX_CRITERIA)}")
    return sentence(". ".join(texts))


def plain_lines(entry: Entry, source_of: SourceOf) -> list[str]:
    """Return an entry as plain text: the finding, its place, the answer, what to do."""
    lines = []
    for block in entry.blocks:
        match block:
            case Line("finding" | "comment" | "hint" | "feedback", text):
                lines.append(text)
            case Location():
                lines += [location_text(block), *excerpt_lines(block, source_of)]
            case Answer("Found", answer_text):
                lines += ["Found:", *(f"  {line}" for line in answer_text)]
    return lines


def pending_reason(result: Result) -> str:
    """Return where the answer or the pictures are that need manual grading.

    For a check that cannot decide, return why.
    """
    outcome = result.outcome
    if not is_manual(result):
        return sentence(
            outcome.message.removesuffix("; needs manual grading")
        )  # which the heading says
    where = ""
    if isinstance(outcome.measured, tuple):
        where = enumerated(map(str, outcome.measured), _MAX_FILES)
    elif outcome.location:
        at = outcome.location
        where = f"{at.path}:{at.line}" if counts_lines(at) else at.path
    doubt = outcome.problem or ("" if where else "not found")
    return printable(f"{where} ({doubt})" if where and doubt else where or doubt)


def carried_text(cause: str, results: Sequence[Result]) -> str:
    """Return which criteria fail only because of a mistake that is counted elsewhere.

    They have their points.
    """
    names = enumerated([one.id for one in results])
    verb = "it fails" if len(results) == 1 else "they fail"
    return printable(f"No points lost for {names}: {verb} only because of {cause}.")


def looked_for(results: Iterable[Result]) -> Iterator[str]:
    """Yield what was searched in vain, of each answer and each picture."""
    return (printable(f"{result.id}: {result.outcome.expected}") for result in results)
