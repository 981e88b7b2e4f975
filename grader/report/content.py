"""The content of a report on the whole submission, for every format to lay out. All of it is printable text."""

from collections.abc import Iterable, Iterator
from decimal import Decimal

from grader.checks.manual import MANUAL_CHECKS
from grader.grading.report import Report, Result
from grader.grading.worth import worth
from grader.problems import Problem
from grader.report.details import sentence
from grader.report.order import Failure, alike, failures
from grader.submission.urdf import Absent
from grader.text import counted_points, enumerated, first_lines, format_points, printable, shell_quoted, signed_points

_VERDICTS = {
    "clean": "ROS 2 loads the file",
    "degraded": "ROS 2 loads the file, but drops content of it",
    "rejected": "ROS 2 rejects the file",
}
_MAX_LISTED, _MAX_FILES = 12, 2
_WITHOUT_LINES = (".pdf", ".docx")  # the message names the page or the heading
_STATUSES = ("passed", "failed", "skipped", "pending", "errored", "adjusted", "marked manually")


def score_text(report: Report) -> str:
    """Return the points that count and the maximum, 58.5 / 70 points, or that the student is excused."""
    points = counting_text(report)
    return f"{points} / {format_points(report.max_score)} points" if report.counting is not None else points


def counting_text(report: Report) -> str:
    """Return the points that count for the student: 58.5, excused, or a dash if nothing is decided."""
    if report.grade is None:
        return _earned(report.results)
    return format_points(report.grade.points) if report.grade.points is not None else "Excused"


def headline(report: Report) -> str:
    """Return the points that count and the maximum in short: 58.5/70."""
    most = earned_text(report.results).partition("/")[2]
    return f"{counting_text(report)}/{most}" if report.counting is not None else counting_text(report)


def grade_line(report: Report) -> str:
    """Return how the grade of a student in a class came about; empty if it is the score of automatic criteria."""
    if report.grade is None:
        return ""
    manual = sum((result.points for result in report.results if result.manual_mark is not None), Decimal(0))
    has_marks = any(result.manual_mark is not None for result in report.results)
    text = (
        f"{format_points(report.score - manual)} automatic{f' + {format_points(manual)} manual' if has_marks else ''}"
    )
    text += f" - {format_points(-report.grade.late)} late" if report.grade.late else ""
    if report.grade.points is None:
        return f"Excused; the criteria give {text} points."
    return f"Final mark, instead of {text} points." if report.grade.is_final else f"Points: {text}."


def earned_text(results: tuple[Result, ...]) -> str:
    """Return the points of some criteria together: 8/14, above the maximum with extra credit; extra credit alone: 5/5 bonus.

    If all of them need manual grading: –/14.
    """
    most = worth(result.criterion for result in results)
    return f"{_earned(results)}/{format_points(most.points) if most.points or not most.bonus else most.short}"


def _earned(results: tuple[Result, ...]) -> str:
    is_open = bool(results) and all(result.is_open for result in results)
    return "–" if is_open else format_points(sum((result.points for result in results), Decimal(0)))


def points_of(results: Iterable[Result]) -> str:
    """Return the maximum of some criteria together: 14 points, 14 points and 5 bonus points, 5 bonus points."""
    return worth(result.criterion for result in results).text


def cost_text(failure: Failure) -> str:
    """Return the points that a failure costs: -6 points; of extra credit what was earned: 0/5 bonus."""
    lost = f"{signed_points(-failure.lost) if failure.lost else '0'} point{'' if failure.lost == 1 else 's'}"
    if not failure.result.criterion.bonus:
        return lost
    return earned_text((failure.result,)) + (f", {lost}" if failure.lost else "")


def graded_line(report: Report) -> str:
    """Return the version of the grader, the rubric, and the URDF, or the submission without one."""
    graded = printable(report.submission.path or report.submission.id)
    return f"grader {report.version}, {printable(report.rubric.id)}: {graded}"


def summary(report: Report) -> str:
    """Return the URDF, whether ROS 2 loads it, and how many criteria passed, failed, and so on."""
    path = report.submission.path
    return f"{f'{printable(path)}: ' if path is not None else ''}{verdict_and_counts(report)}"


def verdict_and_counts(report: Report) -> str:
    """Return whether ROS 2 loads the URDF, and how many criteria passed, failed, and so on."""
    submission = report.submission
    urdf = "the URDF could not be read" if submission.unread else "no URDF was submitted"
    if submission.path is not None and submission.has_urdf:
        urdf = _VERDICTS[submission.verdict] if submission.verdict else "xacro that cannot be determined statically"
    statuses = ["marked manually" if result.manual_mark else _status(result) for result in report.results]
    counts = (f"{statuses.count(status)} {status}" for status in _STATUSES if status in statuses)
    return f"{urdf}; {', '.join(counts)}"


def _status(result: Result) -> str:
    return "adjusted" if result.is_adjusted else result.outcome.status


def bonus_line(report: Report) -> str:
    """Return how much extra credit is in the score; empty if the rubric has none."""
    bonus = worth(result.criterion for result in report.results).bonus
    if not bonus:
        return ""
    return f"Extra credit: {format_points(report.bonus)} of {counted_points(bonus)}, in addition to the maximum."


def summaries(report: Report) -> list[str]:
    """Return what a report says first: how the grade came about, the URDF, how many criteria passed, the extra credit, the package."""
    return [*filter(None, (grade_line(report), summary(report), bonus_line(report), package_line(report)))]


def package_line(report: Report) -> str:
    """Return the package that is graded and its folder; empty if none is."""
    package = report.submission.package
    if package is None or not any(report.rubric.part(part).needs == "package" for part in report.parts):
        return ""
    return printable(f"package {package.name}{f' in {package.folder}' if package.folder else ''}")


def pending_line(report: Report) -> str:
    """Return how many points need manual grading, and which automatic criteria are among them; empty if none do."""
    names = [printable(result.criterion.id) for result in undecided(report)]
    rest = f"; could not be decided: {enumerated(names, _MAX_LISTED)}" if names else ""
    return f"{pending_points(report)}{rest}" if report.open_points else ""


def pending_points(report: Report) -> str:
    """Return how many points need manual grading."""
    return f"{counted_points(report.pending)} {'needs' if report.pending == 1 else 'need'} manual grading"


def notes(report: Report) -> list[str]:
    """Return notes on how the submission was read."""
    return [f"Note: {printable(note)}" for note in report.notes]


def why_no_picture(report: Report) -> str:
    """Return why a report has no picture of the robot."""
    submission = report.submission
    urdf = submission.originals.urdf if submission.originals is not None else Absent()
    if submission.has_urdf and isinstance(urdf, Absent):
        return "No picture: the submission has changed or moved since it was graded."
    if submission.robot is None or not submission.robot.links:
        return "No picture: no robot could be read from the submission."
    return "No picture: no link of the robot has a pose."


def first_ignored(report: Report) -> list[str]:
    """Return the other candidates for grading in a line, and the first ignored file; of many how many more there are."""
    others, ignored = report.submission.other_candidates, report.submission.ignored
    lines = (
        [f"Not graded: {enumerated([file.path for file in others], _MAX_FILES)} (--verbose says why)"] if others else []
    )
    more = f" (and {len(ignored) - 1} more: --verbose lists them)" if len(ignored) > 1 else ""
    lines += [f"Ignored: {file}{more}" for file in ignored[:1]]
    return list(map(printable, lines))


def ignored_lines(report: Report) -> list[str]:
    """Return the other candidates for grading and the ignored files; of many the first, and how many more there are."""
    lines = [f"Other candidate {file.path}: {file.reason}" for file in report.submission.other_candidates]
    lines += [f"Ignored: {file}" for file in report.submission.ignored]
    return [printable(line) for line in first_lines(lines, _MAX_LISTED)]


def undecided(report: Report) -> list[Result]:
    """Return the automatic criteria that need manual grading here, because their subject could not be read."""
    return [result for result in report.results if result.is_open and not is_manual(result)]


def is_manual(result: Result) -> bool:
    """Return whether a criterion is always graded manually: a question or a picture."""
    return result.criterion.check.function in MANUAL_CHECKS


def pending_reason(result: Result) -> str:
    """Return where the answer or the pictures are that need manual grading, or why a check cannot decide."""
    outcome = result.outcome
    if not is_manual(result):
        return sentence(outcome.message)
    where = ""
    if isinstance(outcome.measured, tuple):
        where = enumerated(list(map(str, outcome.measured)), _MAX_FILES)
    elif outcome.location is not None:
        path = outcome.location.path
        where = path if path.lower().endswith(_WITHOUT_LINES) else f"{path}:{outcome.location.line}"
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
    if not cause:
        return printable(f"Not graded, because nothing was submitted: {names} ({points_of(results)}).")
    return printable(f"Skipped because {cause} failed: {names} ({points_of(results)}).")


def other_problems(report: Report) -> Iterator[Problem]:
    """Return the problems that no failed criterion has reported."""
    failed = (result.outcome for result in report.results if result.outcome.status == "failed")
    reported = {(outcome.location, outcome.problem or outcome.message) for outcome in failed}
    return (problem for problem in report.problems if (problem.location, problem.message) not in reported)


def other_problems_title(report: Report) -> str:
    """Return the title of the problems that no failed criterion has reported."""
    return f"Other problems in the {'file' if report.submission.is_single else 'files'}"


def next_command(report: Report) -> str:
    """Return the command that explains the costliest failure, or else what is undecided; empty without either."""
    failed = [failure.result for failure in failures(report) if failure.result.manual_mark is None]
    first = next(iter((*failed, *undecided(report))), None)
    return explain_command(first.criterion.id, report) if first is not None else ""


def what_is_left(report: Report) -> str:
    """Return what is left where no command follows; points may be lost by a manual mark."""
    start = "No check failed" if failures(report) else "Nothing to fix"
    return f"{start}: {pending_points(report)}." if report.open_points else f"{start}."


def explain_command(name: str, report: Report) -> str:
    """Return the command that explains a criterion. It shows no part of the rubric's path above the current folder."""
    if report.rubric.is_shipped:
        return f"grader explain {name}"
    path = report.rubric.path
    return f"grader explain {name} --rubric {shell_quoted(path.name if path.is_absolute() else path)}"
