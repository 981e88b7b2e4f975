"""Harnesses of whole submissions: grading, hints, the files that `--fix` writes, and every format of the report."""

import os
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

from grader.app.hints_and_fix import add_hints, files_to_fix, write_fix
from grader.base.source import Base, Edit
from grader.base.text import printable
from grader.files.tree import make_tree
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Hint, Report, Result
from grader.lab.hints.search import list_gains
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.opening import make_submission, read_submission
from grader.lab.submission.submission import Submission
from grader.report.formats import Format, render
from tests.checks.submissions import file_of
from tests.fuzz.harness import GUARD, check_location, check_message, decoded, files_of, user_errors
from tests.hints.trials import with_edits
from tests.report.harmless import is_harmless
from tests.report.reports import CLASSROOM50
from tests.samples import RUBRICS


def urdf(data: bytes, rubric: str) -> None:
    """A URDF is graded; its hints gain what they promise and lose nothing, and `--fix` writes what they make of it."""
    check_graded(
        RUBRICS[rubric],
        read_submission(data, identity="student", path="my_robot.urdf"),
        "my_robot.urdf",
    )


def package(data: bytes, rubric: str) -> None:
    """A folder of files is graded, its hints hold, and `--fix` writes what they make of it."""
    files = files_of(data)
    tree = make_tree(
        "student", [file_of(printable(path), content) for path, content in files.items()], ()
    )
    with user_errors():
        check_graded(
            RUBRICS[rubric], make_submission(tree, "student", RUBRICS[rubric].lab), "student"
        )


def check_graded(rubric: Rubric, submission: Submission, path: str) -> None:
    """Assert what holds of every submission that is graded."""
    rubric = replace(rubric, hints="edit")
    report = grade(rubric, submission)
    _check_report(report, submission)
    warnings: list[str] = []
    hinted, fix = add_hints(report, submission, None, warnings.append, is_fixed=True)
    assert not warnings, warnings
    assert [(it.criterion, it.outcome.status, it.points) for it in hinted.results] == [
        (it.criterion, it.outcome.status, it.points) for it in report.results
    ]
    by_criterion = {
        result.criterion.id: result.hint for result in hinted.results if result.hint is not None
    }
    promised = {name for hint in by_criterion.values() for name in hint.gains}
    for hint in {hint.edits: hint for hint in by_criterion.values()}.values():
        check_message(hint.message)
        _check_hint(report, submission, [by_criterion[name] for name in hint.after], hint, promised)
    assert fix.report.score >= report.score
    with GUARD.watching(is_active=False), TemporaryDirectory() as folder, GUARD.watching():
        target = Path(folder, "fix.urdf" if submission.is_single else "fix")
        written = files_to_fix(target, path, hinted, fix, (), ())
        check_message(write_fix(target, path, hinted, fix, written))
        assert {it: it.read_bytes() for it in Path(folder).rglob("*") if it.is_file()} == written
    with patch.dict(os.environ, CLASSROOM50):
        for kind in Format:
            is_harmless(render(hinted, kind, Base()), kind)


def _check_report(report: Report, submission: Submission) -> None:
    assert not report.fault, [result.traceback for result in report.results if result.traceback]
    assert 0 <= report.score <= report.max_score + report.bonus
    assert report.score + report.pending <= report.max_score + report.bonus
    texts = {
        path: decoded(file.read(1 << 20)) for path, file in submission.whole_tree.files.items()
    }
    if submission.path is not None:
        source = submission.source(submission.path)
        others = {} if submission.is_single else texts
        texts = {**others, submission.path: source.text} if source is not None else others
    for result in report.results:
        check_message(result.outcome.message)
        location = result.outcome.location
        check_location(location, texts)
    for problem in report.problems:
        check_location(problem.location, texts)


def _check_hint(
    report: Report, submission: Submission, earlier: list[Hint], hint: Hint, promised: set[str]
) -> None:
    """Assert that edits, applied by other code, make the promised criteria pass, and cost none its points.

    A hint that names `earlier` ones promises what it gains after their edits; what needs both is promised by neither.
    Any other hint gains no more than the hints promise together.
    """
    edits = [edit for it in earlier for edit in it.edits]
    results = _graded(report, submission, [*edits, *hint.edits])
    assert all(results[before.criterion.id].points >= before.points for before in report.results)
    gains = list_gains(_graded(report, submission, edits), results)
    assert hint.gains.items() <= gains.items()
    assert earlier or not hint.edits or gains.keys() <= promised


def _graded(report: Report, submission: Submission, edits: list[Edit]) -> dict[str, Result]:
    return {
        it.criterion.id: it for it in grade(report.rubric, with_edits(submission, edits)).results
    }
