"""The work of a worker process: grade submissions one by one.

All data is plain and can be sent to any process.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from math import inf, isfinite
from pathlib import Path
from typing import NamedTuple

from grader.base.errors import InputError, MachineError, OutOfTime
from grader.base.grouping import Strings
from grader.base.processor_time import limit_processor_time
from grader.base.text import MAX_NAMED, cut, enumerated
from grader.classroom.intake.class_files import digest_of_unread, open_class_submission
from grader.classroom.results.equal_work import hash_forms, hash_handed_out
from grader.classroom.results.results import StoredCriterion, StoredResult, Verdict, hash_values
from grader.files.limits import ARCHIVES
from grader.files.reading import URDF_LIMIT
from grader.lab.checks.outcome import Status, how_far_off
from grader.lab.grading.criterion_pictures import find_content, is_empty
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.rubric import Rubric, read_rubric
from grader.lab.submission.submission import Opening, Submission
from grader.ros.api import Absent, Unreadable
from grader.workers.pool import NO_MEMORY, WorkerError, out_of_time

_MAX_ANSWER = 4000  # characters of an answer that are kept to compare it
_MAX_CAUSE = 200  # characters


class ClassContext(NamedTuple):
    """What all tasks of a run share."""

    roots: Strings  # the class folders or zips
    rubric: bytes  # the content of its file
    rubric_path: str
    max_size: int = URDF_LIMIT  # of a URDF, in bytes
    parts: Strings = ()  # the ids of those to grade; without any all
    arguments: Mapping[str, str] = {}  # of xacro
    timeout: float = inf  # for a submission, in seconds of processor time


class Task(NamedTuple):
    """One submission to grade."""

    key: str  # of the student
    root: int  # the index of the class folder
    paths: Strings  # below it
    names: Strings = ()  # the student's own of several files
    graded: str = ""  # the digest, if it has a result that is current
    has_timed_out: bool = False  # whether that result is that it took too long
    no_documents: str = ""  # why its documents are not read: its grading was lost with them
    reached: float = 0  # the limit of processor time that it reached with them, in seconds


def grade_all(context: ClassContext, tasks: Sequence[Task]) -> list[StoredResult]:
    """Grade submissions one after the other, in isolation.

    An error affects only its own submission.
    """
    return [_grade_within_limits(context, task) for task in tasks]


def _grade_within_limits(context: ClassContext, task: Task) -> StoredResult:
    """Grade a submission, and again without its documents if it exceeds a limit with them."""
    if task.has_timed_out:
        unopened = unopened_digest(context.roots[task.root], task.paths)
        if unopened == task.graded:
            return StoredResult(task.key, 0, "unchanged")
    lost = WorkerError(NO_MEMORY)
    try:
        if isfinite(context.timeout):
            limit_processor_time(context.timeout)  # in place of that of all tasks together
        return _grade_one(context, task)
    except MemoryError:
        pass
    except OutOfTime:
        lost = out_of_time(context.timeout)
    if not task.no_documents:
        without = task._replace(no_documents=str(lost), reached=lost.timeout)
        return _grade_within_limits(context, without)
    digest = ""
    with suppress(InputError, MemoryError):
        opened = open_class_submission(
            context.roots[task.root], task.paths, task.names, task.key, context.max_size
        )
        digest = hash_values(opened.digest)
    return given_up(context, task, lost, digest)


def _grade_one(context: ClassContext, task: Task) -> StoredResult:
    rubric = _rubric_from(context.rubric, context.rubric_path)
    root = context.roots[task.root]
    result = StoredResult(task.key, 0, "unchanged", no_documents=task.no_documents)
    try:
        opened = open_class_submission(root, task.paths, task.names, task.key, context.max_size)
        result = result._replace(digest=hash_values(opened.digest))
        if result.digest == task.graded:
            return result
        if task.no_documents and not opened.has_documents:  # nothing would be different this time
            lost = WorkerError(task.no_documents, timeout=task.reached)
            return given_up(context, task, lost, result.digest)
        submission = opened.submission(
            rubric, Opening(arguments=context.arguments, no_documents=task.no_documents)
        )
        report = grade(rubric, submission, context.parts, is_one_of_class=True, is_explained=False)
    except InputError as error:
        result = result._replace(
            digest=result.digest or hash_values(str(error), digest_of_unread(root, task.paths))
        )
        if result.digest != task.graded:
            result = _undecided(context, result._replace(verdict="unreadable", reason=str(error)))
        return result
    except MemoryError:
        raise
    except (Exception, SystemExit) as error:  # noqa: BLE001  a fault of the grader affects only this submission
        is_known = isinstance(error, MachineError)  # in the next run it may be over
        if is_known:
            reason = str(error)
        else:
            reason = f"the grader itself failed: {type(error).__name__}: {error}"
        return _undecided(context, result._replace(verdict="errored", reason=reason))
    entries = {one.criterion.id: _stored_criterion(one) for one in report.results}
    answers, written = _key_answers(report, result.digest)
    result = result._replace(parts=report.parts, results=entries, answers=answers, written=written)
    if fault := report.fault:
        return result._replace(verdict="errored", reason=fault)
    is_handed_out = bool(report.another_robot)  # by the course, so that it is no equal work
    unread = _why_unreadable(submission)
    if not unread:
        result = result._replace(no_robot=_in_place_of_robot(report))
    verdict: Verdict = "unreadable" if unread else "graded"
    texts = submission.documents.converted
    result = result._replace(verdict=verdict, reason=unread or submission.several, texts=texts)
    return result if is_handed_out else result._replace(work=hash_forms(submission, rubric))


def _stored_criterion(result: Result) -> StoredCriterion:
    """Return what a line keeps of a criterion."""
    outcome = result.outcome
    is_open = outcome.status in ("pending", "errored") and not result.is_adjusted
    words = outcome.mistake or (outcome.message if outcome.status in ("failed", "errored") else "")
    points = result.points
    number = int(points) if points == int(points) else float(points)
    stored = None if is_open else number, outcome.status, cut(words, _MAX_CAUSE), result.carried
    off = how_far_off(outcome)
    if off is None:
        return stored
    return (*stored, off)


def _key_answers(report: Report, digest: str) -> tuple[dict[str, str], dict[str, str]]:
    """Return the key of the answer for each criterion that needs manual grading.

    It is empty if there is nothing to read. The answers that are words come with the keys.

    It is that of the words, or of the whole submission where more than words is to be looked at.
    """
    automatic = {}
    written = {}
    for one in report.results:
        if one.outcome.status != "pending":
            continue
        content = find_content(one, report)
        if content:
            written[one.criterion.id] = content[:_MAX_ANSWER]
        if not content and not is_empty(one, report):
            content = digest
        automatic[one.criterion.id] = hash_values(content) if content else ""
    return automatic, written


def given_up(context: ClassContext, task: Task, error: WorkerError, digest: str) -> StoredResult:
    """Return the result of a submission that cannot be graded.

    Where it reached the limit of processor time it is kept as long as its digest is the same and
    the limit is not larger; without a digest it cannot be compared, and is graded in every run.
    """
    timeout = error.timeout if digest else 0
    result = StoredResult(task.key, 0, "errored", digest, reason=str(error), timeout=timeout)
    return _undecided(context, result)


def unopened_digest(root: str, paths: Strings) -> str:
    """Return the digest of files that are too slow to open; empty for folders."""
    unread = digest_of_unread(root, paths)
    return hash_values(unread) if unread else ""


def _undecided(context: ClassContext, result: StoredResult) -> StoredResult:
    """Return the result of a submission that could not be graded: every criterion is undecided."""
    rubric = _rubric_from(context.rubric, context.rubric_path)
    status: Status = "errored" if result.verdict == "errored" else "pending"
    parts = tuple(part.id for part in rubric.parts if not context.parts or part.id in context.parts)
    results = {row.id: (None, status, "", "") for row in rubric.criteria if row.part in parts}
    return result._replace(parts=parts, results=results)


def reference_hashes(data: bytes, path: str) -> Strings:
    """Return the hashes of the work in a rubric's reference.

    Raises InputError if nothing can be graded without it.
    """
    rubric = _rubric_from(data, path)
    if rubric.solution and rubric.compares_with_reference:
        _ = rubric.solution.robot  # raises InputError
    with suppress(InputError):
        if rubric.solution:
            return hash_handed_out(rubric.solution.submission, rubric)
    return ()


def _why_unreadable(submission: Submission) -> str:
    """Return why nothing in a submission could be read, although its folder could.

    It is empty if something was read.

    A damaged or empty archive makes a submission unreadable if there is nothing else to grade.
    """
    if isinstance(submission.urdf, Unreadable):
        return submission.urdf.reason
    if not _has_nothing_to_grade(submission):
        return ""
    tree = submission.tree
    closed = submission.tree.unopened
    if closed:
        because = str(closed[0])
        more = f" (and {len(closed) - 1} more cannot be opened)" if len(closed) > 1 else ""
        return f"nothing to grade was found: {because}{more}"
    if not tree.generated and all(file.suffix in ARCHIVES for file in tree.files.values()):
        because = str(tree.ignored[0]) if tree.ignored else f"{next(iter(tree.files))} is empty"
        return f"nothing to grade was found: {because}"
    return ""


def _has_nothing_to_grade(submission: Submission) -> bool:
    is_absent = isinstance(submission.urdf, Absent) and not submission.urdf.blank
    return is_absent and not submission.packages


def _in_place_of_robot(report: Report) -> str:
    """Return the files of a submission without the robot and the package that are graded.

    It is empty for another submission.
    """
    has_robot = any(one.criterion.check.is_of_robot for one in report.results)
    if not has_robot or not _has_nothing_to_grade(report.submission):
        return ""
    return enumerated(report.submission.tree.files, MAX_NAMED) or "no file"


@lru_cache(maxsize=4)
def _rubric_from(data: bytes, path: str) -> Rubric:
    """Return the rubric in the content of a file, which need not exist; tasks of a run share it."""
    return read_rubric(data, Path(path))
