"""The content of a report on one criterion, sentence by sentence, or on several, for every format to lay out."""

from collections.abc import Iterable, Iterator

from grader.checks.outcome import Outcome
from grader.grading.criterion import Criterion
from grader.grading.report import Report, Result
from grader.report.criteria import Answer, Block, Diff, Entry, Line, alike, is_failure, is_manual, points_of
from grader.report.locations import SourceOf, excerpt_lines, location_text
from grader.source import Location
from grader.text import by_name, capitalised, enumerated, printable, signed_points

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


def blocks_of(entry: Entry, report: Report, *, everything: bool = False) -> Iterator[Block]:
    """Yield what is said about a criterion: what is wrong and where, the answer, what to do, what was expected.

    A hint is in place of the rubric's feedback; with `everything` there are both.
    """
    result, criterion, outcome = entry.result, entry.result.criterion, entry.result.outcome
    is_asked = outcome.status == "pending" and not result.is_adjusted
    has_failed = entry.status == "failed" and result.manual_mark is None
    is_mistake = has_failed and not result.carried  # else the advice would be to change what is as it should be
    has_subject = report.submission.has_urdf or criterion.check.subject not in ("urdf", "robot")
    yield from _findings(result)
    if outcome.location is not None and has_failed:
        yield outcome.location
    if is_asked:
        yield from _answers(result)
    if result.hint is not None and is_mistake:
        yield Line("hint", sentence(hint_text(entry, result.hint.message)))
        yield from [Diff(result.hint.edits)] if result.hint.edits and not entry.first else []
    if criterion.feedback and is_mistake and has_subject and (everything or result.hint is None):
        yield Line("feedback", _one_line(criterion.feedback))
    if is_failure(result) and not is_asked:
        # The title of a criterion is never stated alone, because it would read as a fact.
        yield Line("expected", f"Passes when: {sentence(criterion.title)}")
    if entry.skipped:
        yield Line("skipped", skipped_text(entry.id, entry.skipped))


def _findings(result: Result) -> Iterator[Line]:
    """Yield what the points of a criterion are due to, and the comment without points."""
    outcome, mark, comment = result.outcome, result.manual_mark, result.comment
    if result.is_adjusted:  # what the check found is not the student's mistake
        yield Line("finding", sentence(_one_line(result.why_given)))
    elif mark is not None:
        words = f": {_one_line(mark.comment)}" if mark.comment else ""
        yield Line("finding", sentence(f"Marked{by_name(mark.by) or ' manually'}{words}"))
        if outcome.status != "pending":
            yield Line("finding", sentence(f"The check: {outcome.status}. {outcome.message}"))
    elif outcome.status == "skipped" and result.because:
        yield Line("finding", f"Skipped because {result.because} failed.")
    else:
        yield Line("finding", sentence(outcome.message))
        yield from [Line("finding", result.why_given)] if result.why_given else []
    if comment is not None:
        yield Line("comment", sentence(f"Comment{by_name(comment.by)}: {_one_line(comment.text)}"))


def remarks_on(result: Result) -> list[str]:
    """Return why a criterion is adjusted, and a grader's comment; nothing without either."""
    return [line.text for line in _findings(result) if result.is_adjusted or line.role == "comment"]


def _answers(result: Result) -> Iterator[Answer]:
    """Yield the student's answer to a question, and the model answer if the rubric was loaded with its answers."""
    found = tuple(printable(line) for line in answer_lines(result.outcome) if line.strip())
    model = tuple(printable(line) for line in model_lines(result.criterion) if line.strip())
    yield from [Answer("Found", found)] if found else []
    yield from [Answer("Model answer", model)] if model else []


def _one_line(text: str) -> str:
    """Return a text of a rubric or a comment in one printable line."""
    return printable(" ".join(text.split()))


def answer_lines(outcome: Outcome) -> list[str]:
    """Return the lines of the answer that a check found; none if it is not about a question."""
    return outcome.measured.strip("\n").splitlines() if isinstance(outcome.measured, str) else []


def model_lines(criterion: Criterion) -> list[str]:
    """Return the lines of the model answer; none if the criterion has no answer or is loaded without."""
    return criterion.answer.strip("\n").splitlines()


def counts_lines(location: Location) -> bool:
    """Return whether editors count the lines of a file; of a PDF or Word file, a message names the page or heading."""
    return not location.path.lower().endswith((".pdf", ".docx"))


def sentence(message: str) -> str:
    """Return a message as a printable sentence, with a capital and a full stop."""
    text = capitalised(printable(message))
    return text if text.endswith((".", "?")) else f"{text}."


def hint_text(entry: Entry, message: str) -> str:
    """Return the message of the hint of a failure, with what the same edit fixes besides."""
    hint = entry.result.hint
    if entry.first or hint is None:
        return f"Fixed by the same edit as {entry.first}."
    also = [f"{other.id}, {signed_points(-other.lost)}" for other in entry.also]
    skipped = (result.criterion.id for one in (entry, *entry.also) for result in one.skipped)
    left = [name for name in skipped if name not in hint.gains]
    texts = [message.removesuffix(".")]
    texts += ["Other edits are as good"] if hint.certainty == "one of several" and hint.gains else []
    texts += [f"Also fixes {enumerated(also, _MAX_CRITERIA)}"] if also else []
    texts += [f"Then look at {enumerated(left, _MAX_CRITERIA)}"] if left else []
    return f"{'. '.join(texts)}."


def plain_lines(entry: Entry, source_of: SourceOf) -> list[str]:
    """Return an entry as plain text: the finding, its place, the answer, what to do."""
    lines: list[str] = []
    for block in entry.blocks:
        match block:
            case Line("finding" | "comment" | "hint" | "feedback", text):
                lines.append(text)
            case Location():
                lines += [location_text(block), *excerpt_lines(block, source_of)]
            case Answer("Found", found):
                lines += ["Found:", *(f"  {line}" for line in found)]
    return lines


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
