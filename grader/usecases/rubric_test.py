"""Test a rubric: its reference, equivalents, samples and mutants."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from grader.classroom.run.batch import Progress
from grader.errors import GraderError
from grader.mutation.samples import read_samples
from grader.mutation.testing import tested
from grader.report.formats import OutputFormat
from grader.report.rubric_test import render_rubric_test, render_rubric_test_json
from grader.report.screen import Screen
from grader.usecases import Warn
from grader.usecases.exit_codes import ExitCode, read_threshold
from grader.usecases.rubrics import load

_MAX_PERCENT = 100
ShowProgress = Callable[[str], AbstractContextManager[Callable[[Progress], None]]]


class TestRequest(NamedTuple):
    """What is tested, and how."""

    rubric: str
    folder: Path | None
    fail_under: str | None
    seed: int
    mutants: int
    format: OutputFormat


def test(request: TestRequest, screen: Screen, warn: Warn, show_progress: ShowProgress) -> tuple[str, ExitCode]:
    """Return the result as text, and the exit code. Raises GraderError for a broken rubric or one without a reference."""
    least = _least(request.fail_under)
    rubric = load(request.rubric, warn, answers=False)
    samples = read_samples(request.folder) if request.folder is not None else None
    with show_progress(f"Testing {rubric.id}") as show:
        result = tested(
            rubric,
            samples,
            seed=request.seed,
            most=request.mutants,
            progress=lambda done, total: show(Progress(total, done)),
        )
    is_passed = result.is_sound and (least is None or result.mutants.score >= least)
    is_json = request.format is OutputFormat.JSON
    text = render_rubric_test_json(result) if is_json else render_rubric_test(result, screen.width)
    if result.is_faulty:
        return text, ExitCode.FAULT
    return text, ExitCode.PASSED if is_passed else ExitCode.FAILED


def _least(text: str | None) -> Decimal | None:
    """Return the least mutation score in percent, with or without its sign. Raises GraderError."""
    if text is None:
        return None
    least, _ = read_threshold(text)
    if least > _MAX_PERCENT:
        raise GraderError(f"--fail-under takes a mutation score from 0% to 100%, not {text!r}")
    return least
