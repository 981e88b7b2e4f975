"""What a worker does: grade some hand-ins, each on its own. Everything here is plain data, fit to be sent anywhere."""

import gc
import json
import os
import time
import zlib
from collections.abc import Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from grader.checks.outcome import Outcome, Status
from grader.classroom.gradebook.result import NOT_GRADED, SIGNS, UNITS, Graded, Verdict
from grader.classroom.intake.opening import fingerprint, open_hand_in
from grader.classroom.run.pool import NO_MEMORY
from grader.errors import InputError
from grader.files.opening import ARCHIVES
from grader.files.reading import URDF_LIMIT
from grader.grading.grade import grade
from grader.grading.record import Template, to_record
from grader.grading.report import GradedSubmission, Report, Result
from grader.grading.rubric import Rubric, read_rubric
from grader.submission.submission import Submission

# What a process is to have loaded before it forks, late imports included.
PRELOAD = (
    "grader.classroom.run.worker",
    "grader.robot.edge_overlap",
    "grader.submission.find",
    "grader.package.linting",
)

MAX_MISTAKE = 200  # characters of a mistake that statistics count


class Class(NamedTuple):
    """What all tasks of a run share: the top of the class folder or archive, and the rubric's file."""

    root: str
    rubric: bytes
    rubric_path: str
    template: str = ""  # the record that those of the class are kept beside
    max_size: int = URDF_LIMIT  # bytes of a URDF


class Task(NamedTuple):
    """One hand-in: where it is, and its digest if it has been graded by the same rubric and grader before.

    `no_documents` says why its documents are not read: grading it was lost with them.
    """

    key: str
    paths: tuple[str, ...]
    names: tuple[str, ...] = ()
    graded: str = ""
    no_documents: str = ""


def grade_all(common: Class, tasks: Sequence[Task]) -> list[Graded]:
    """Grade hand-ins one after the other; what is wrong with one of them costs the others nothing."""
    return [_grade_one(common, task) for task in tasks]


def prepare(memory: int) -> None:
    """Make a process fit for grading: bounded in memory (bytes), deaf to Ctrl-C, which is for the one that hands out the work."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    gc.collect()
    gc.freeze()  # what is loaded now stays: it need not be looked through again
    gc.set_threshold(10_000, 10, 20)


def _grade_one(common: Class, task: Task) -> Graded:
    rubric, template = _rules(common.rubric, common.rubric_path, common.template)
    mark = fingerprint(common.root, task.paths, time.time_ns(), common.max_size)
    digest = ""
    try:
        opened = open_hand_in(common.root, task.paths, task.names, task.key, common.max_size)
        digest = opened.digest
        if digest == task.graded:
            return Graded(task.key, "unchanged", digest, mark)
        submission = opened.submission(rubric, task.no_documents)
        report = grade(rubric, submission)
    except InputError as error:
        return failed(rubric, task, "unreadable", _of_class(str(error), common), digest, mark)
    except MemoryError:
        if not task.no_documents:
            return _grade_one(common, task._replace(no_documents=NO_MEMORY))
        return failed(rubric, task, "errored", NO_MEMORY, digest, mark)
    except (Exception, SystemExit) as error:  # noqa: BLE001  a fault of ours must cost nobody else anything
        return failed(
            rubric, task, "errored", f"the grader itself failed: {type(error).__name__}: {error}", digest, mark
        )
    faulty = next((each.outcome.message for each in report.results if each.outcome.status == "errored"), "")
    if faulty:
        return _of(report, task, "errored", faulty, digest, mark, template)
    reason = _of_class(_nothing_readable(submission), common)
    return _of(report, task, "unreadable" if reason else "graded", reason, digest, mark, template)


def _nothing_readable(submission: Submission) -> str:
    """Why what is to be graded of a hand-in could not be read, although its folder could; empty where it was read.

    As on its own, an archive that is damaged or empty is unreadable where nothing else that could be graded lies beside it.
    """
    if submission.unread:
        return submission.unread
    if submission.path is not None or submission.packages:
        return ""
    tree, closed = submission.tree, submission.unopened
    if closed:
        because = next((line for line in tree.left_out if line.startswith(closed[0])), f"{closed[0]} cannot be opened")
        more = f" (nor could {len(closed) - 1} more be opened)" if len(closed) > 1 else ""
        return f"nothing to grade was found: {because}{more}"
    if not tree.generated and all(file.suffix in ARCHIVES for file in tree.files.values()):
        because = tree.left_out[0] if tree.left_out else f"{next(iter(tree.files))} is empty"
        return f"nothing to grade was found: {because}"
    return ""


def _of_class(reason: str, common: Class) -> str:
    """A reason as a class is told it: with paths in the class."""
    return reason.replace(f"{common.root}{os.sep}", "")


def failed(rubric: Rubric, task: Task, verdict: Verdict, reason: str, digest: str = "", mark: str = "") -> Graded:
    """The result of a hand-in that could not be graded: no criterion is decided, and each says why."""
    status: Status = "errored" if verdict == "errored" else "pending"
    message = reason if status == "errored" else f"{reason}; a person has to look"
    results = tuple(Result(criterion, Outcome(status, message)) for criterion in rubric.criteria)
    name = Path(task.paths[0]).name if len(task.paths) == 1 else task.key
    report = Report(GradedSubmission(name), rubric, tuple(part.id for part in rubric.parts), results)
    return _of(report, task, verdict, reason, digest, mark)


def _of(
    report: Report,
    task: Task,
    verdict: Verdict,
    reason: str,
    digest: str,
    mark: str,
    template: Template | None = None,
) -> Graded:
    signs = [NOT_GRADED] * len(report.rubric.criteria)
    misses = []
    for criterion, outcome, *_ in report.results:
        signs[criterion.position] = SIGNS[outcome.status]
        if outcome.status == "failed":
            misses.append((criterion.position, (outcome.mistake or outcome.message)[:MAX_MISTAKE]))
    score, out_of, pending = (int(each * UNITS) for each in (report.score, report.max_score, report.pending))
    record = zlib.compress(to_record(report, template).encode(), 1)
    return Graded(
        task.key, verdict, digest, mark, score, out_of, pending, "".join(signs), json.dumps(misses), record, reason
    )


@lru_cache(maxsize=4)
def _rules(data: bytes, path: str, template: str) -> tuple[Rubric, Template]:
    rubric = read_rubric(data, Path(path))
    return rubric, Template(template, rubric)
