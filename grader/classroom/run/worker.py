"""The work of a worker process: grade submissions one by one. All data is plain and can be sent to any process."""

import json
import re
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from grader.checks.outcome import Outcome, Status
from grader.classroom.gradebook.result import GradingResult, GradingVerdict
from grader.classroom.intake.fingerprint import fingerprint
from grader.classroom.opening import open_class_submission, unreadable_digest
from grader.classroom.run.pool import NO_MEMORY
from grader.errors import InputError, MachineError
from grader.files.names import ARCHIVES
from grader.files.reading import URDF_LIMIT, sha256_of
from grader.grading.grade import grade
from grader.grading.graded_submission import GradedSubmission
from grader.grading.record import to_record
from grader.grading.report import Report, Result, without_gifts
from grader.grading.rubric import Rubric, read_rubric
from grader.package.package import PYTHON_LIMIT, SETUP, Package
from grader.robot.normal_form import robot_hash, written_form
from grader.submission.submission import Submission
from grader.submission.urdf import Absent, Read, Unreadable
from grader.text import enumerated

_MAX_NAMED = 10  # students in a message
_IGNORED = re.compile(rb"^(?:[ \t]*+#.*|(?:Panels|Window Geometry):.*\n(?:[ \t-].*(?:\n|\Z))*)", re.MULTILINE)


class ClassContext(NamedTuple):
    """The data that all tasks of a run share: the path of the class folder or zip, and the rubric's file."""

    root: str
    rubric: bytes
    rubric_path: str
    dictionary: bytes = b""  # with which records are compressed
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
    rubric = rubric_from(context.rubric, context.rubric_path)
    result = GradingResult(task.key, "unchanged", "", fingerprint(context.root, task.paths, time.time_ns()))
    try:
        opened = open_class_submission(context.root, task.paths, task.names, task.key, context.max_size)
        result = result._replace(digest=opened.digest)
        if opened.digest == task.graded:
            return result
        submission = opened.submission(rubric, task.no_documents)
        if submission.students:
            raise InputError(students_refusal(submission))  # noqa: TRY301  it is handled like files that cannot be read
        report = grade(rubric, submission, context.parts, is_one_of_class=True)
    except InputError as error:
        result = result._replace(digest=result.digest or unreadable_digest(context.root, task.paths))
        if result.digest and result.digest == task.graded:
            return result
        return undecided_result(context, task, result._replace(verdict="unreadable", reason=str(error)))
    except (Exception, SystemExit) as error:  # noqa: BLE001  a fault of the grader affects only this submission
        is_memory = isinstance(error, MemoryError)
        if is_memory and not task.no_documents:
            return _grade_one(context, task._replace(no_documents=NO_MEMORY))
        is_known = isinstance(error, MachineError)  # in the next run it may be over
        reason = str(error) if is_known else f"the grader itself failed: {type(error).__name__}: {error}"
        reason = NO_MEMORY if is_memory else reason
        return undecided_result(context, task, result._replace(verdict="errored", reason=reason))
    fault, reason = report.fault, _why_unreadable(submission)
    verdict: GradingVerdict = "errored" if fault else "unreadable" if reason else "graded"
    graded = result._replace(verdict=verdict, reason=fault or reason).with_report(report, context.dictionary)
    if not report.submission.another_robot:  # else the course handed it out
        urdf, robot = robot_hashes(submission)
        graded = graded._replace(urdf=urdf, robot=robot, forms=json.dumps(_forms(submission)))
    return graded


def reference_record(data: bytes, path: str) -> tuple[bytes, tuple[str, ...]]:
    """Return the record of a rubric's reference solution, which most records resemble, and the hashes of its work.

    Both are empty if it cannot be graded. Raises InputError if nothing can be graded without it.
    """
    rubric = rubric_from(data, path)
    if rubric.solution is not None and rubric.compares_with_reference:
        _ = rubric.solution.robot  # raises InputError
    with suppress(InputError):
        if rubric.solution is not None:
            reference = rubric.solution.submission
            return to_record(grade(rubric, reference)).encode(), work_hashes(reference)
    return b"", ()


def robot_hashes(submission: Submission) -> tuple[str, str]:
    """Return the hashes of the graded URDF and of its robot's normal form; empty where there is none."""
    urdf = submission.urdf
    if not isinstance(urdf, Read) or not urdf.data.strip():
        return "", ""
    return sha256_of(urdf.data), robot_hash(urdf.reading)


def _forms(submission: Submission, *, is_handed_out: bool = False) -> dict[str, Any]:
    """Return what two students may have in common besides the robot: see gradebook/identical.py."""
    root = submission.urdf.reading.elements if isinstance(submission.urdf, Read) else None
    written, others = written_form(root, is_handed_out=is_handed_out)
    package = dict(_package_forms(submission.package)) if submission.package is not None else {}
    return {"written": written, "others": others, "package": package} if written or package else {}


def _package_forms(package: Package) -> Iterator[tuple[str, str]]:
    """Yield kinds of files, each with the hash of what they are apart from comments, white space, quotes, windows."""
    kinds = {"setup.py": (SETUP,), "launch files": package.launch_files, "RViz files": package.rviz_files}
    for kind, paths in kinds.items():
        with suppress(InputError):
            files = [package.tree.files[path].read(PYTHON_LIMIT) for path in paths if path in package.tree.files]
            forms = sorted(_IGNORED.sub(b"", data).replace(b"'", b'"').split() for data in files)
            if any(forms):
                yield kind, sha256_of(repr((kind, forms)).encode())


def work_hashes(submission: Submission) -> tuple[str, ...]:
    """Return the hashes of the robot and the package, which are no identical work if the course handed them out."""
    forms = _forms(submission, is_handed_out=True)
    return tuple(filter(None, (*robot_hashes(submission), forms.get("written"), *forms.get("package", {}).values())))


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


def students_refusal(submission: Submission) -> str:
    """Return why a submission is left unassigned that contains those of several students."""
    named = enumerated(submission.students, _MAX_NAMED)
    count = len(submission.students)
    return f"it contains the submissions of {count} students, {named}: left unassigned (--layout teams grades each)"


def undecided_result(context: ClassContext, task: Task, result: GradingResult) -> GradingResult:
    """Return the result of a submission that could not be graded: every criterion is undecided, and says why."""
    rubric, reason = rubric_from(context.rubric, context.rubric_path), result.reason
    status: Status = "errored" if result.verdict == "errored" else "pending"
    message = reason if status == "errored" else f"{reason}; needs manual grading"
    chosen = tuple(part.id for part in rubric.parts if not context.parts or part.id in context.parts)
    criteria = [criterion for criterion in rubric.criteria if criterion.part in chosen]
    name = Path(task.paths[0]).name if len(task.paths) == 1 else task.key
    unread = reason if result.verdict == "unreadable" else ""
    submission = GradedSubmission(name, unread=unread)
    results = without_gifts((Result(criterion, Outcome(status, message)) for criterion in criteria), submission)
    report = Report(submission, rubric, chosen, results)
    return result.with_report(report, context.dictionary)


@lru_cache(maxsize=4)
def rubric_from(data: bytes, path: str) -> Rubric:
    """Return the rubric in the content of a file, which need not exist; tasks of a run share it."""
    return read_rubric(data, Path(path))
