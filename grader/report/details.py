"""The content of a report on one criterion, sentence by sentence, or on several, for every format to lay out."""

from collections.abc import Iterable
from typing import NamedTuple

from grader.checks.outcome import Outcome
from grader.grading.criterion import Criterion
from grader.grading.report import Hint, Report, Result
from grader.report.locations import excerpt_lines, location_text
from grader.report.order import FailedCriterion, alike, failures, is_failure, is_manual, points_of, status_of
from grader.source import Location
from grader.text import by_name, enumerated, printable, signed_points

# The symbol of each status, that for a terminal in another encoding, the style on a terminal, and the word.
_STATUSES = (
    ("passed", "\u2713", "+", "green", "Passed"),
    ("failed", "\u2717", "X", "bold red", "Failed"),
    ("skipped", "\u2212", "-", "yellow", "Skipped"),
    ("pending", "?", "?", "cyan", "Needs manual grading"),
    ("errored", "!", "!", "bold magenta", "Could not be graded"),
    ("adjusted", "=", "=", "blue", "Corrected after grading"),
    ("partial", "~", "~", "bold yellow", "Some points"),
)
SYMBOLS, ASCII_SYMBOLS, STYLES, STATUS_WORDS = ({row[0]: row[column] for row in _STATUSES} for column in range(1, 5))
_MAX_FILES, _MAX_CRITERIA = 2, 3


class Details(NamedTuple):
    """The sentences of a report on a criterion, besides its id and points.

    `comment` is a grader's comment without points. `answer` is the student's answer to a question, line by line, and
    `model_answer` the instructor's, if the rubric was loaded with its answers. `location` is where to look and
    `expected` what should be, if the criterion failed; `hint` is a change that makes it pass, in printable sentences.
    """

    sentences: tuple[str, ...]
    answer: tuple[str, ...]
    model_answer: tuple[str, ...]
    location: Location | None
    feedback: str
    expected: str
    hint: Hint | None
    comment: str

    @property
    def words(self) -> tuple[str, ...]:
        """The sentences, and the comment."""
        return (*self.sentences, *filter(None, [self.comment]))

    @property
    def advice(self) -> tuple[str, ...]:
        """What to do: the hint, or the rubric's feedback where there is none."""
        return tuple(filter(None, [self.hint.message if self.hint is not None else self.feedback]))


def result_details(result: Result, report: Report) -> Details:
    """Return the details of one criterion, whatever its status."""
    criterion, outcome, comment = result.criterion, result.outcome, result.comment
    is_asked = outcome.status == "pending" and not result.is_adjusted
    has_failed = status_of(result) == "failed" and result.manual_mark is None
    is_mistake = has_failed and not result.carried  # else the advice would be to change what is as it should be
    has_subject = report.submission.has_urdf or criterion.check.subject not in ("urdf", "robot")
    return Details(
        _sentences(result),
        _printable(answer_lines(outcome)) if is_asked else (),
        _printable(model_lines(criterion)) if is_asked else (),
        outcome.location if has_failed else None,
        _one_line(criterion.feedback) if is_mistake and has_subject else "",
        # The title of a criterion is never stated alone, because it would read as a fact.
        f"Passes when: {sentence(criterion.title)}" if is_failure(result) and not is_asked else "",
        _hint(result, report) if is_mistake else None,
        sentence(f"Comment{by_name(comment.by)}: {_one_line(comment.text)}") if comment is not None else "",
    )


def remarks_on(result: Result, report: Report) -> tuple[str, ...]:
    """Return why a criterion is adjusted, and a grader's comment; nothing without either."""
    if not (result.is_adjusted or result.comment):
        return ()
    details = result_details(result, report)
    return details.words if result.is_adjusted else (details.comment,)


def _sentences(result: Result) -> tuple[str, ...]:
    """Return what a criterion's points are due to: an adjustment, a manual mark, or what the check found."""
    outcome, given = result.outcome, result.manual_mark
    if result.is_adjusted:  # what the check found is not the student's mistake
        return (sentence(_one_line(result.why_given)),)
    if given is not None:
        comment = f": {_one_line(given.comment)}" if given.comment else ""
        check = () if outcome.status == "pending" else (sentence(f"The check: {outcome.status}. {outcome.message}"),)
        return (sentence(f"Marked{by_name(given.by) or ' manually'}{comment}"), *check)
    if outcome.status == "skipped" and result.because:
        return (f"Skipped because {result.because} failed.",)
    return (sentence(outcome.message), *filter(None, [result.why_given]))


def _one_line(text: str) -> str:
    """Return a text of a rubric or a comment in one printable line."""
    return printable(" ".join(text.split()))


def answer_lines(outcome: Outcome) -> list[str]:
    """Return the lines of the answer that a check found, as plain text; none if it is not about a question."""
    text = outcome.measured
    if not isinstance(text, str):
        return []
    is_markup = outcome.location is None or counts_lines(outcome.location)
    return _plain_lines(text) if is_markup else text.strip("\n").splitlines()


def model_lines(criterion: Criterion) -> list[str]:
    """Return the lines of the model answer, as plain text; none if the criterion has no answer or is loaded without."""
    return _plain_lines(criterion.answer) if criterion.answer else []


def _plain_lines(markdown: str) -> list[str]:
    from grader.report.answers import plain_lines  # late: few reports have answers

    return plain_lines(markdown)


def counts_lines(location: Location) -> bool:
    """Return whether editors count the lines of a file; of a PDF or Word file, a message names the page or heading."""
    return not location.path.lower().endswith((".pdf", ".docx"))


def _printable(lines: Iterable[str]) -> tuple[str, ...]:
    """Return the lines that are not blank."""
    return tuple(printable(line) for line in lines if line.strip())


def sentence(message: str) -> str:
    """Return a message as a printable sentence, with a capital and a full stop."""
    text = printable(message)
    if text.split(" ")[0].isalpha():  # not an attribute, such as xyz="0 0"
        text = text[:1].upper() + text[1:]
    return text if text.endswith((".", "?")) else f"{text}."


def _hint(result: Result, report: Report) -> Hint | None:
    """Return the hint of a criterion, which says what it fixes besides; one that another failure shows names that."""
    if result.hint is None:
        return None
    failure = next(failure for failure in failures(report) if failure.id == result.criterion.id)
    hint = hint_of(failure, result.hint)
    return hint._replace(message=sentence(hint.message))


def hint_of(failure: FailedCriterion, hint: Hint) -> Hint:
    """Return a hint of a failure, which says what it fixes besides."""
    if failure.first:
        return hint._replace(message=f"Fixed by the same edit as {failure.first}.", edits=())
    also = [f"{other.id}, {signed_points(-other.lost)}" for other in failure.also]
    skipped = (result.criterion.id for one in (failure, *failure.also) for result in one.skipped)
    left = [name for name in skipped if name not in hint.gains]
    texts = [hint.message.removesuffix(".")]
    texts += ["Other edits are as good"] if hint.certainty == "one of several" and hint.gains else []
    texts += [f"Also fixes {enumerated(also, _MAX_CRITERIA)}"] if also else []
    texts += [f"Then look at {enumerated(left, _MAX_CRITERIA)}"] if left else []
    return hint._replace(message=f"{'. '.join(texts)}.")


def criterion_lines(result: Result, report: Report) -> list[str]:
    """Return the lines about one criterion: the finding, its place, the answer, what to do."""
    details = result_details(result, report)
    lines = list(details.words)
    if details.location is not None:
        lines += [location_text(details.location), *excerpt_lines(details.location, report.submission.source)]
    if details.answer:
        lines += ["Found:", *(f"  {line}" for line in details.answer)]
    return [*lines, *details.advice]


def pending_reason(result: Result) -> str:
    """Return where the answer or the pictures are that need manual grading, or why a check cannot decide."""
    outcome = result.outcome
    if not is_manual(result):
        return sentence(outcome.message)
    where = ""
    if isinstance(outcome.measured, tuple):
        where = enumerated(list(map(str, outcome.measured)), _MAX_FILES)
    elif outcome.location is not None:
        at = outcome.location
        where = f"{at.path}:{at.line}" if counts_lines(at) else at.path
    doubt = outcome.problem or ("" if where else "not found")
    return printable(f"{where} ({doubt})" if where and doubt else where or doubt)


def carried_text(results: Iterable[Result]) -> str:
    """Return which criteria fail only because of a mistake that is counted elsewhere, and have their points."""
    causes = alike(results, lambda result: result.carried)
    texts = (f"{enumerated([one.criterion.id for one in some])} (caused by {cause})" for cause, some in causes)
    return printable(f"Not deducted: {', '.join(texts)}.")


def skipped_text(cause: str, results: tuple[Result, ...]) -> str:
    """Return which criteria are skipped because of another one, or because nothing was submitted, and their points."""
    names = enumerated([result.criterion.id for result in results])
    why = f"Skipped because {cause} failed" if cause else "Not graded, because nothing was submitted"
    return printable(f"{why}: {names} ({points_of(results)}).")
