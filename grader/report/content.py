"""The content of a report, sentence by sentence, for every format to lay out. All of it is printable text."""

from collections.abc import Iterator
from decimal import Decimal
from itertools import groupby
from typing import NamedTuple

from grader.checks.manual import MANUAL_CHECKS
from grader.grading.report import Exhibits, Report, Result
from grader.problems import Problem
from grader.report.locations import calls_text
from grader.source import Location
from grader.text import counted_points, enumerated, first_lines, format_points, printable, shell_quoted

_VERDICTS = {
    "clean": "ROS 2 loads the file",
    "degraded": "ROS 2 loads the file, but drops content of it",
    "rejected": "ROS 2 rejects the file",
}
_MAX_LISTED = 12
_STATUSES = ("passed", "failed", "skipped", "pending", "errored", "marked manually")


class Details(NamedTuple):
    """The sentences of a report on a criterion, besides its id and points.

    `answer` is the student's answer to a question, line by line, and `model_answer` the instructor's, if the rubric was loaded
    with its answers. `location` is where to look and `expected` what should be, if the criterion failed.
    """

    sentences: tuple[str, ...]
    answer: tuple[str, ...] = ()
    model_answer: tuple[str, ...] = ()
    location: Location | None = None
    feedback: str = ""
    expected: str = ""


def score_text(report: Report) -> str:
    """Return the score and the maximum: 58.5 / 70 points."""
    return f"{format_points(report.score)} / {format_points(report.max_score)} points"


def status_of(result: Result) -> str:
    """Return the status of a criterion; a manual mark passes if it gives all points."""
    if result.manual_mark is None:
        return result.outcome.status
    return "passed" if result.points >= result.criterion.points else "failed"


def earned_text(results: tuple[Result, ...]) -> str:
    """Return the points of some criteria together: 8/14."""
    earned = sum((result.points for result in results), Decimal(0))
    maximum = sum((result.criterion.points for result in results), Decimal(0))
    return f"{format_points(earned)}/{format_points(maximum)}"


def summary(report: Report) -> str:
    """Return whether ROS 2 loads the URDF, and how many criteria passed, failed, and so on."""
    submission = report.submission
    path = printable(submission.path or "")
    urdf = f"{path}: not read" if submission.unread else "no URDF was submitted"
    if submission.path is not None and submission.has_urdf:
        verdict = _VERDICTS[submission.verdict] if submission.verdict else "xacro that cannot be determined statically"
        urdf = f"{path}: {verdict}"
    statuses = ["marked manually" if result.manual_mark else result.outcome.status for result in report.results]
    counts = (f"{statuses.count(status)} {status}" for status in _STATUSES if status in statuses)
    return f"{urdf}; {', '.join(counts)}"


def package_line(report: Report) -> str:
    """Return the package that is graded and its folder; empty if none is."""
    package = report.submission.package
    if package is None or not any(report.rubric.part(part).needs == "package" for part in report.parts):
        return ""
    return printable(f"package {package.name}{f' in {package.folder}' if package.folder else ''}")


def pending_line(report: Report) -> str:
    """Return how many points need manual grading, and which automatic criteria are among them; empty if none do."""
    if not report.pending:
        return ""
    names = [printable(result.criterion.id) for result in undecided(report)]
    rest = f"; could not be decided: {enumerated(names, _MAX_LISTED)}" if names else ""
    return f"{counted_points(report.pending)} {'needs' if report.pending == 1 else 'need'} manual grading{rest}"


def notes(report: Report) -> list[str]:
    """Return notes on how the submission was read."""
    return [f"Note: {printable(note)}" for note in report.notes]


def ignored_lines(report: Report) -> list[str]:
    """Return the other candidates for grading and the ignored files; of many the first, and how many more there are."""
    lines = [f"Other candidate {file.path}: {file.reason}" for file in report.submission.other_candidates]
    lines += [f"Ignored: {file}" for file in report.submission.ignored]
    return [printable(line) for line in first_lines(lines, _MAX_LISTED)]


def undecided(report: Report) -> list[Result]:
    """Return the automatic criteria that need manual grading here, because their subject could not be read."""
    return [
        result for result in report.results if result.is_open and result.criterion.check.function not in MANUAL_CHECKS
    ]


def result_details(result: Result, report: Report) -> Details:
    """Return the details of one criterion, whatever its status."""
    outcome = result.outcome
    answers = (_lines(outcome.measured), _lines(result.criterion.answer)) if outcome.status == "pending" else ()
    if result.manual_mark is not None:
        comment = f": {_one_line(result.manual_mark.comment)}" if result.manual_mark.comment else ""
        mark = sentence(f"Marked {f'by {result.manual_mark.by}' if result.manual_mark.by else 'manually'}{comment}")
        if outcome.status == "pending":
            return Details((mark,), *answers)
        expected = _expected(result) if status_of(result) == "failed" else ""
        return Details((mark, sentence(f"The check: {outcome.status}. {outcome.message}")), expected=expected)
    if result.carried:  # the feedback would ask for a change of what is as it should be
        return Details(
            (sentence(outcome.message), result.why_given), location=outcome.location, expected=_expected(result)
        )
    if outcome.status == "skipped":
        return Details((f"Skipped because {result.because} failed.",))
    sentences = (sentence(outcome.message),)
    if outcome.status == "pending":
        return Details(sentences, *answers)
    if outcome.status != "failed":
        return Details(sentences, expected=_expected(result) if outcome.status == "errored" else "")
    has_subject = report.submission.has_urdf or result.criterion.check.subject not in ("urdf", "robot")
    feedback = _one_line(result.criterion.feedback) if has_subject else ""
    return Details(sentences, location=outcome.location, feedback=feedback, expected=_expected(result))


def _expected(result: Result) -> str:
    """Return what should be: the title of a criterion is never stated alone, because it would read as a fact."""
    return f"Passes when: {sentence(result.criterion.title)}"


def _one_line(text: str) -> str:
    """Return a text of a rubric or a comment in one printable line."""
    return printable(" ".join(text.split()))


def _lines(text: object) -> tuple[str, ...]:
    """Return the lines of an answer; none of the value of a criterion that is not a question."""
    return tuple(printable(line) for line in text.splitlines() if line.strip()) if isinstance(text, str) else ()


def other_problems(report: Report) -> Iterator[Problem]:
    """Return the problems that no failed criterion has reported."""
    failed = (result.outcome for result in report.results if result.outcome.status == "failed")
    reported = {(outcome.location, outcome.problem or outcome.message) for outcome in failed}
    return (problem for problem in report.problems if (problem.location, problem.message) not in reported)


def other_problems_title(report: Report) -> str:
    """Return the title of the problems that no failed criterion has reported."""
    return f"Other problems in the {'file' if report.submission.is_single else 'files'}"


def evidence(report: Report) -> Iterator[tuple[str, list[tuple[str, bool]]]]:
    """Yield the title of each part with its pieces of evidence, and whether files were found; then the other pictures."""
    parts = {part.id: part.title for part in report.rubric.parts}
    for part, exhibits in groupby(report.exhibits, key=lambda exhibits: exhibits.evidence.part):
        yield printable(parts[part]), [(_exhibits_text(found), bool(found.files)) for found in exhibits]
    if report.others:
        yield "Other pictures and documents", [(printable(exhibit.words), True) for exhibit in report.others]


def _exhibits_text(found: Exhibits) -> str:
    """Return a piece of evidence with its files, or with those that are perhaps meant."""
    files = ", ".join(exhibit.words for exhibit in found.files)
    perhaps = enumerated([exhibit.words for exhibit in found.perhaps], _MAX_LISTED, "or")
    return printable(f"{found.evidence.title}: {files or (f'perhaps {perhaps}' if perhaps else 'missing')}")


def sentence(message: str) -> str:
    """Return a message as a printable sentence, with a capital and a full stop."""
    text = printable(message)
    if text.split(" ")[0].isalpha():  # not an attribute, such as xyz="0 0"
        text = text[:1].upper() + text[1:]
    return text if text.endswith((".", "?")) else f"{text}."


def location_text(where: Location) -> str:
    """Return a location as editors take it, path:line:column, and the macro calls that led to it."""
    return f"{printable(where.path)}:{where.line}:{where.column}{calls_text(where)}"


def advice(report: Report) -> str:
    """Return the command that explains the first failed criterion; empty if none failed."""
    first = next((result.criterion.id for result in report.results if result.outcome.status == "failed"), None)
    if first is None:
        return ""
    robot = "; `grader inspect` shows the whole robot" if report.submission.has_urdf else ""
    return f"`{explain_command(first, report)}` explains the first failed criterion{robot}."


def explain_command(name: str, report: Report) -> str:
    """Return the command that explains a criterion. It shows no part of the rubric's path above the current folder."""
    if report.rubric.is_shipped:
        return f"grader explain {name}"
    path = report.rubric.path
    return f"grader explain {name} --rubric {shell_quoted(path.name if path.is_absolute() else path)}"
