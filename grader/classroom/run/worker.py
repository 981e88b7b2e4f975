"""The work of a worker process: grade submissions one by one. Everything here is plain data that can be sent to any process."""

import json
import time
import zlib
from collections import Counter
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from grader.checks.manual import MANUAL_CHECKS
from grader.checks.outcome import Outcome, Status
from grader.classroom.gradebook.failures import Failure, failure_of
from grader.classroom.gradebook.result import (
    NOT_GRADED,
    SETTLED,
    STATUS_LETTERS,
    UNITS_PER_POINT,
    GradingResult,
    Verdict,
)
from grader.classroom.intake.fingerprint import fingerprint
from grader.classroom.intake.opening import open_submission, unreadable_digest
from grader.classroom.run.pool import NO_MEMORY
from grader.errors import InputError
from grader.files.opening import ARCHIVES
from grader.files.reading import URDF_LIMIT, sha256_of
from grader.grading.grade import grade
from grader.grading.graded_submission import GradedSubmission
from grader.grading.missing_work import is_another_robot, robot_of
from grader.grading.record import Template, to_record
from grader.grading.report import Report, Result
from grader.grading.rubric import Rubric, read_rubric
from grader.robot.normal_form import robot_hash
from grader.submission.submission import Submission
from grader.submission.urdf import Absent, Read, Unreadable
from grader.text import enumerated

_MAX_NAMED = 10  # students in a message


class ClassContext(NamedTuple):
    """The data that all tasks of a run share: the path of the class folder or zip, and the rubric's file."""

    root: str
    rubric: bytes
    rubric_path: str
    template: str = ""  # records are stored as differences from this one
    max_size: int = URDF_LIMIT  # bytes of a URDF
    parts: tuple[str, ...] = ()  # ids; default: all


class Task(NamedTuple):
    """One submission: where it is, and its digest if it has been graded by the same rubric and grader before.

    `no_documents` says why its documents are not read: its grading was lost with them.
    """

    key: str
    paths: tuple[str, ...]
    names: tuple[str, ...] = ()
    graded: str = ""
    no_documents: str = ""


def grade_all(context: ClassContext, tasks: Sequence[Task]) -> list[GradingResult]:
    """Grade submissions one after the other, in isolation: an error affects only its own submission."""
    return [_grade_one(context, task) for task in tasks]


def _grade_one(context: ClassContext, task: Task) -> GradingResult:
    rubric, template = _rubric(context.rubric, context.rubric_path, context.template)
    seen = fingerprint(context.root, task.paths, time.time_ns(), context.max_size)
    digest = ""
    try:
        opened = open_submission(context.root, task.paths, task.names, task.key, context.max_size)
        digest = opened.digest
        if digest == task.graded:
            return GradingResult(task.key, "unchanged", digest, seen)
        submission = opened.submission(rubric, task.no_documents)
        if submission.students:
            return failed(rubric, context.parts, task, "unreadable", several_students(submission), digest, seen)
        report = grade(rubric, submission, context.parts, is_one_of_class=True)
    except InputError as error:
        digest = digest or unreadable_digest(context.root, task.paths)
        if digest and digest == task.graded:
            return GradingResult(task.key, "unchanged", digest, seen)
        return failed(rubric, context.parts, task, "unreadable", str(error), digest, seen)
    except MemoryError:
        if not task.no_documents:
            return _grade_one(context, task._replace(no_documents=NO_MEMORY))
        return failed(rubric, context.parts, task, "errored", NO_MEMORY, digest, seen)
    except (Exception, SystemExit) as error:  # noqa: BLE001  a fault of the grader affects only this submission
        reason = f"the grader itself failed: {type(error).__name__}: {error}"
        return failed(rubric, context.parts, task, "errored", reason, digest, seen)
    fault, reason = report.fault, _why_unreadable(submission)
    verdict: Verdict = "errored" if fault else "unreadable" if reason else "graded"
    graded = result_of(report, task, verdict, fault or reason, digest, seen, template)
    if is_another_robot(
        rubric, robot_of(submission.urdf)
    ):  # what the course handed out for the lab before is no identical work
        return graded
    urdf, robot = robot_hashes(submission)
    return graded._replace(urdf=urdf, robot=robot)


def robot_hashes(submission: Submission) -> tuple[str, str]:
    """Return the hashes of the graded URDF and of its robot's normal form; empty where there is none."""
    urdf = submission.urdf
    if not isinstance(urdf, Read) or not urdf.data.strip():
        return "", ""
    return sha256_of(urdf.data), robot_hash(urdf.reading)


def _why_unreadable(submission: Submission) -> str:
    """Return why nothing in a submission could be read, although its folder could; empty if something was read.

    A damaged or empty archive makes a submission unreadable if there is nothing else to grade.
    """
    if isinstance(submission.urdf, Unreadable):
        return submission.urdf.reason
    if not isinstance(submission.urdf, Absent) or submission.packages:
        return ""
    tree, closed = submission.tree, submission.tree.unopened
    if closed:
        because = str(closed[0])
        more = f" (and {len(closed) - 1} more cannot be opened)" if len(closed) > 1 else ""
        return f"nothing to grade was found: {because}{more}"
    if not tree.generated and all(file.suffix in ARCHIVES for file in tree.files.values()):
        because = str(tree.ignored[0]) if tree.ignored else f"{next(iter(tree.files))} is empty"
        return f"nothing to grade was found: {because}"
    return ""


def several_students(submission: Submission) -> str:
    """Return why a submission is left unassigned that contains those of several students."""
    named = enumerated(submission.students, _MAX_NAMED)
    count = len(submission.students)
    return f"it contains the submissions of {count} students, {named}: left unassigned (--layout teams grades each)"


def failed(
    rubric: Rubric, parts: tuple[str, ...], task: Task, verdict: Verdict, reason: str, digest: str = "", seen: str = ""
) -> GradingResult:
    """Return the result of a submission that could not be graded: every criterion is undecided, and says why."""
    status: Status = "errored" if verdict == "errored" else "pending"
    message = reason if status == "errored" else f"{reason}; needs manual grading"
    chosen = tuple(part.id for part in rubric.parts if not parts or part.id in parts)
    criteria = [criterion for criterion in rubric.criteria if criterion.part in chosen]
    results = tuple(Result(criterion, Outcome(status, message)) for criterion in criteria)
    name = Path(task.paths[0]).name if len(task.paths) == 1 else task.key
    report = Report(GradedSubmission(name, unread=reason if verdict == "unreadable" else ""), rubric, chosen, results)
    return result_of(report, task, verdict, reason, digest, seen)


def result_of(
    report: Report,
    task: Task,
    verdict: Verdict,
    reason: str,
    digest: str,
    seen: str,
    template: Template | None = None,
) -> GradingResult:
    """Return a report as plain data; `seen` is the fingerprint of the files."""
    statuses = [NOT_GRADED] * len(report.rubric.criteria)
    failures: list[Failure] = []
    causes: Counter[str] = Counter()
    for result in report.results:
        criterion, outcome = result.criterion, result.outcome
        is_settled = outcome.status != "passed" and result.why_given
        statuses[criterion.position] = SETTLED if is_settled else STATUS_LETTERS[outcome.status]
        if outcome.status == "failed" and not is_settled:
            failures.append(failure_of(criterion, outcome))
        elif result.is_open and criterion.check.function not in MANUAL_CHECKS:
            causes[outcome.mistake or f"{criterion.check.name} could not be decided"] += int(
                criterion.points * UNITS_PER_POINT
            )
    undecided = max(causes, key=lambda cause: (causes[cause], cause), default="")
    score, out_of, pending = (
        int(points * UNITS_PER_POINT) for points in (report.score, report.max_score, report.pending)
    )
    record = zlib.compress(to_record(report, template).encode(), 1)
    told = "".join(statuses), json.dumps(failures), record, reason, undecided
    return GradingResult(task.key, verdict, digest, seen, score, out_of, pending, *told)


@lru_cache(maxsize=4)
def _rubric(data: bytes, path: str, template: str) -> tuple[Rubric, Template]:
    rubric = read_rubric(data, Path(path))
    return rubric, Template(template, rubric)
