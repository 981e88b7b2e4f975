"""The content of a report on one criterion, sentence by sentence, for every format to lay out. All of it is printable text."""

from typing import NamedTuple

from grader.grading.report import Hint, Report, Result
from grader.report.locations import calls_text
from grader.report.order import Group, hints_of, is_failure
from grader.source import Location
from grader.text import by_name, printable

SYMBOLS = {
    "passed": "\u2713",
    "failed": "\u2717",
    "skipped": "\u2212",
    "pending": "?",
    "errored": "!",
    "adjusted": "=",
    "partial": "~",
}  # of each status


class Details(NamedTuple):
    """The sentences of a report on a criterion, besides its id and points.

    `comment` is a grader's comment without points. `answer` is the student's answer to a question, line by line, and
    `model_answer` the instructor's, if the rubric was loaded with its answers. `location` is where to look and `expected` what
    should be, if the criterion failed; `hints` are changes that make it pass, in printable sentences.
    """

    sentences: tuple[str, ...]
    answer: tuple[str, ...] = ()
    model_answer: tuple[str, ...] = ()
    location: Location | None = None
    feedback: str = ""
    expected: str = ""
    hints: tuple[Hint, ...] = ()
    comment: str = ""

    @property
    def words(self) -> tuple[str, ...]:
        """The sentences, and the comment."""
        return (*self.sentences, *filter(None, [self.comment]))

    @property
    def advice(self) -> tuple[str, ...]:
        """What to do: the hints, or the rubric's feedback where there is none."""
        return tuple(hint.message for hint in self.hints) or tuple(filter(None, [self.feedback]))


def result_details(result: Result, report: Report) -> Details:
    """Return the details of one criterion, whatever its status."""
    comment = (
        f"Comment{by_name(result.comment.by)}: {_one_line(result.comment.text)}" if result.comment is not None else ""
    )
    return _details(result, report)._replace(comment=sentence(comment) if comment else "")


def _details(result: Result, report: Report) -> Details:
    outcome = result.outcome
    if result.is_adjusted:  # what the check found is not the student's mistake
        return Details((sentence(_one_line(result.why_given)),))
    answers = (_lines(outcome.measured), _lines(result.criterion.answer)) if outcome.status == "pending" else ()
    if result.manual_mark is not None:
        comment = f": {_one_line(result.manual_mark.comment)}" if result.manual_mark.comment else ""
        mark = sentence(f"Marked{by_name(result.manual_mark.by) or ' manually'}{comment}")
        if outcome.status == "pending":
            return Details((mark,), *answers)
        expected = _expected(result) if status_of(result) in ("failed", "partial") else ""
        return Details((mark, sentence(f"The check: {outcome.status}. {outcome.message}")), expected=expected)
    if result.carried:  # the feedback would ask for a change of what is as it should be
        return Details(
            (sentence(outcome.message), result.why_given), location=outcome.location, expected=_expected(result)
        )
    if outcome.status == "skipped":
        return Details((f"Skipped because {result.because} failed." if result.because else sentence(outcome.message),))
    sentences = (sentence(outcome.message),)
    if outcome.status == "pending":
        return Details(sentences, *answers)
    if outcome.status != "failed":
        return Details(sentences, expected=_expected(result) if outcome.status == "errored" else "")
    has_subject = report.submission.has_urdf or result.criterion.check.subject not in ("urdf", "robot")
    feedback = _one_line(result.criterion.feedback) if has_subject else ""
    hints = tuple(hint._replace(message=sentence(hint.message)) for hint in hints_of(result, report))
    return Details(sentences, location=outcome.location, feedback=feedback, expected=_expected(result), hints=hints)


def _expected(result: Result) -> str:
    """Return what should be: the title of a criterion is never stated alone, because it would read as a fact."""
    return f"Passes when: {sentence(result.criterion.title)}"


def _one_line(text: str) -> str:
    """Return a text of a rubric or a comment in one printable line."""
    return printable(" ".join(text.split()))


def _lines(text: object) -> tuple[str, ...]:
    """Return the lines of an answer; none of the value of a criterion that is not a question."""
    return tuple(printable(line) for line in text.splitlines() if line.strip()) if isinstance(text, str) else ()


def status_of(result: Result) -> str:
    """Return the status of a criterion: `adjusted` if the rubric adjusts it, else that of the manual mark or of the check.

    A manual mark is `passed` if it gives all points, and `partial` if it gives a part of them.
    """
    if result.is_adjusted:
        return "adjusted"
    if result.manual_mark is None:
        return result.outcome.status
    if result.points >= result.criterion.points:
        return "passed"
    return "partial" if result.points else "failed"


def group_status(group: Group) -> str:
    """Return the status of a group: that of its worst criterion, without extra credit.

    Criteria with all points by a mark or carried forward count as passed.
    """
    counting = [result for result in group.results if not result.criterion.bonus] or group.results
    open_or_lost = [result for result in counting if result.points < result.criterion.points]
    lost = {status_of(result) for result in open_or_lost if is_failure(result)}
    if lost:
        return "partial" if lost == {"partial"} else "failed"
    return next((status_of(result) for result in open_or_lost), "passed")


def sentence(message: str) -> str:
    """Return a message as a printable sentence, with a capital and a full stop."""
    text = printable(message)
    if text.split(" ")[0].isalpha():  # not an attribute, such as xyz="0 0"
        text = text[:1].upper() + text[1:]
    return text if text.endswith((".", "?")) else f"{text}."


def location_text(where: Location) -> str:
    """Return a location as editors take it, path:line:column, and the macro calls that led to it."""
    return f"{printable(where.path)}:{where.line}:{where.column}{calls_text(where)}"
