"""What a report says, sentence by sentence, for every format to lay out in its own way. All of it is printable text."""

from collections.abc import Iterator
from decimal import Decimal
from itertools import groupby
from typing import NamedTuple

from grader.checks.handed_in import JUDGED_BY_A_PERSON
from grader.grading.report import Exhibits, Report, Result
from grader.problems import Problem
from grader.source import Location
from grader.text import counted_points, format_points, printable

_VERDICTS = {
    "clean": "ROS 2 loads the file",
    "degraded": "ROS 2 loads the file, but drops some of it",
    "rejected": "ROS 2 rejects the file",
}
_MOST_LISTED = 12
_STATUSES = ("passed", "failed", "skipped", "pending", "errored", "marked by hand")


class Details(NamedTuple):
    """What there is to say of a criterion beside its title and points. `place` is where to look, if it failed.

    `found` is what was answered to a question, line by line. `model` is the model answer, empty unless the rubric was loaded
    with its answers.
    """

    sentences: tuple[str, ...]
    found: tuple[str, ...] = ()
    model: tuple[str, ...] = ()
    place: Location | None = None
    feedback: str = ""


def score_text(report: Report) -> str:
    """The score of all that can be earned_text: 58.5 / 70 points."""
    return f"{format_points(report.score)} / {format_points(report.max_score)} points"


def status_of(result: Result) -> str:
    """What became of a criterion: of one that a person has decided, whether it has all points."""
    if result.ruling is None:
        return result.outcome.status
    return "passed" if result.points >= result.criterion.points else "failed"


def earned_text(results: tuple[Result, ...]) -> str:
    """The points of some criteria together: 8/14."""
    got = sum((result.points for result in results), Decimal(0))
    most = sum((result.criterion.points for result in results), Decimal(0))
    return f"{format_points(got)}/{format_points(most)}"


def summary(report: Report) -> str:
    """What ROS 2 makes of the URDF, and how many criteria passed, failed, and so on."""
    submission = report.submission
    path = printable(submission.path or "")
    graded = f"{path}: not read" if submission.unread else "no URDF was submitted"
    if submission.path is not None and submission.has_urdf:
        verdict = _VERDICTS[submission.verdict] if submission.verdict else "xacro that a person has to expand"
        graded = f"{path}: {verdict}"
    decided = [each.outcome.status if each.ruling is None else "marked by hand" for each in report.results]
    return f"{graded}; {', '.join(f'{decided.count(each)} {each}' for each in _STATUSES if each in decided)}"


def package_line(report: Report) -> str:
    """The package that is graded, and where it stands; empty where none is."""
    package = report.submission.package
    if package is None or not any(report.rubric.part(part).needs == "package" for part in report.parts):
        return ""
    return printable(f"package {package.name}{f' in {package.folder}' if package.folder else ''}")


def pending_line(report: Report) -> str:
    """How many points a person still has to give or refuse, and what no program could decide; empty where none wait."""
    if not report.pending:
        return ""
    names = [printable(each.criterion.id) for each in undecided(report)]
    more = f" and {len(names) - _MOST_LISTED} more" if len(names) > _MOST_LISTED else ""
    left = f"; not decided: {', '.join(names[:_MOST_LISTED])}{more}" if names else ""
    return f"{counted_points(report.pending)} {'waits' if report.pending == 1 else 'wait'} for a person{left}"


def notes(report: Report) -> list[str]:
    """What is worth knowing of how the submission was read."""
    return [f"Note: {printable(note)}" for note in report.notes]


def ignored_lines(report: Report) -> list[str]:
    """What might have been graded and was not, and what was not read: of many the first, and how many more there are."""
    every = [f"Passed over {each.path}: {each.because}" for each in report.submission.passed_over]
    every += [f"Left out: {each}" for each in report.submission.left_out]
    more = [f"... and {len(every) - _MOST_LISTED} more"] if len(every) > _MOST_LISTED else []
    return [printable(each) for each in (*every[:_MOST_LISTED], *more)]


def undecided(report: Report) -> list[Result]:
    """Criteria that wait for a person though a program decides them as a rule: what they ask of could not be read."""
    return [each for each in report.results if each.is_open and each.criterion.check.function not in JUDGED_BY_A_PERSON]


def result_details(result: Result, report: Report) -> Details:
    """What there is to say of one criterion, whatever became of it."""
    outcome = result.outcome
    if result.ruling is not None:
        comment = f": {_line(result.ruling.comment)}" if result.ruling.comment else ""
        by_hand = sentence(f"Marked by {result.ruling.by or 'hand'}{comment}")
        if outcome.status == "pending":
            return Details((by_hand,), *_answers(result))
        return Details((by_hand, sentence(f"The check: {outcome.status}. {outcome.message}")))
    if outcome.status == "skipped":
        return Details((f"Skipped, because {result.because} failed.",))
    sentences = (sentence(outcome.message),)
    if outcome.status == "pending":
        return Details(sentences, *_answers(result))
    if outcome.status != "failed":
        return Details(sentences)
    is_there = report.submission.has_urdf or result.criterion.check.subject not in ("urdf", "robot")
    feedback = _line(result.criterion.feedback) if is_there else ""
    return Details(sentences, place=outcome.location, feedback=feedback)


def _line(text: str) -> str:
    """A text of a rubric or of a person who marks in one printable line, however they have broken it."""
    return printable(" ".join(text.split()))


def _answers(result: Result) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """What was answered, and the model answer; nothing where no question was asked."""
    return _lines(result.outcome.measured), _lines(result.criterion.answer)


def _lines(text: object) -> tuple[str, ...]:
    return tuple(printable(line) for line in text.splitlines() if line.strip()) if isinstance(text, str) else ()


def other_problems(report: Report) -> Iterator[Problem]:
    """The problems that no failed criterion has told already."""
    said = [(each.outcome.location, each.outcome.message) for each in report.results if each.outcome.status == "failed"]
    for problem in report.problems:
        if not any(where == problem.location and problem.message in message for where, message in said):
            yield problem


def evidence(report: Report) -> Iterator[tuple[str, list[tuple[str, bool]]]]:
    """Part by part each piece of evidence with the files that were found, and whether there are any; then all other files."""
    parts = {part.id: part.title for part in report.rubric.parts}
    for part, asked in groupby(report.exhibits, key=lambda each: each.evidence.part):
        yield printable(parts[part]), [(_exhibits(found), bool(found.files)) for found in asked]
    if report.others:
        yield "Other pictures and documents", [(printable(exhibit.words), True) for exhibit in report.others]


def _exhibits(found: Exhibits) -> str:
    listed = ", ".join(exhibit.words for exhibit in found.files)
    return printable(f"{found.evidence.title}: {listed or 'missing'}")


def sentence(message: str) -> str:
    """A message as a printable sentence, with a capital and a full stop."""
    text = printable(message)
    if text.split(" ")[0].isalpha():  # an attribute of the file, as in xyz="0 0", stays as it is
        text = text[:1].upper() + text[1:]
    return text if text.endswith((".", "?")) else f"{text}."


def location_text(where: Location) -> str:
    """A place as editors take it: path:line:column."""
    return f"{printable(where.path)}:{where.line}:{where.column}"


def advice(report: Report) -> str:
    """The command that says more; empty where nothing failed."""
    first = next((each.criterion.id for each in report.results if each.outcome.status == "failed"), None)
    if first is None:
        return ""
    whole = ", `grader inspect` shows the whole robot" if report.submission.has_urdf else ""
    return f"`{explain_command(first, report)}` says how it is decided{whole}."


def explain_command(name: str, report: Report) -> str:
    """The command that explains a criterion. Of a rubric's path no more is told than where it stands below the current folder."""
    path = report.rubric.path
    rubric = (
        "" if report.rubric.is_shipped else f" --rubric {printable(path.name if path.is_absolute() else str(path))}"
    )
    return f"grader explain {name}{rubric}"
