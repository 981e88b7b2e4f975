"""The content of a report on one criterion, sentence by sentence, for every format to lay out, and the edits of its hint as a diff."""

from collections.abc import Callable, Iterator, Sequence
from difflib import SequenceMatcher
from itertools import groupby
from typing import NamedTuple

from grader.grading.report import Hint, Report, Result
from grader.report.locations import calls_text
from grader.report.order import Group, hints_of, is_failure
from grader.source import Edit, Location, Source
from grader.text import by_name, first_lines, printable

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


_MAX_LENGTH = 200  # characters of a line: where it is longer, only the old and the new text are shown
_MAX_LINES = 40


def diff_lines(edits: Sequence[Edit], source_of: Callable[[str], Source | None]) -> list[str]:
    """Return the printable lines of a diff: the name of each file, and each changed line before and after; of many the first."""
    lines: list[str] = []
    for path, of_file in groupby(sorted(edits), key=lambda edit: edit.path):
        changes, source = list(of_file), source_of(path)
        new_path = next((edit.renamed for edit in changes if edit.renamed), path)
        lines += [f"--- {path if source is not None else '/dev/null'}", f"+++ {new_path}"]
        for line, of_line in groupby(changes, key=lambda edit: edit.line):
            some = [edit for edit in of_line if edit.old or edit.new]
            if some:
                lines += [f"@@ line {line} @@", *_changed(*_texts(some, source))]
    return [printable(line) for line in first_lines(lines, _MAX_LINES)]


def _texts(edits: list[Edit], source: Source | None) -> tuple[str, str]:
    """Return the whole lines of some edits that begin in one line, before and after; only what changes where a line is long."""
    height = 1 + max(edit.old.count("\n") for edit in edits)
    start = edits[0].line
    before = "\n".join(source.line(start + number) for number in range(height)) if source is not None else ""
    after = before
    for edit in reversed(edits):
        column, old = edit.column - 1, edit.old.replace("\r\n", "\n")
        is_there = after.startswith(old, column) and len(after) <= _MAX_LENGTH * height
        if not is_there:
            return "\n".join(edit.old for edit in edits), "\n".join(edit.new for edit in edits)
        after = after[:column] + edit.new + after[column + len(old) :]
    return before, after


def _changed(before: str, after: str) -> Iterator[str]:
    old, new = ([line.removesuffix("\r") for line in text.split("\n")] for text in (before, after))
    for kind, old_start, old_end, new_start, new_end in SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        if kind != "equal":
            yield from (f"-{line}" for line in old[old_start:old_end])
            yield from (f"+{line}" for line in new[new_start:new_end])
