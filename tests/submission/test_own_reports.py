"""Saved reports beside the lab are ignored, and lines of answers are counted as editors do."""

import shutil
from pathlib import Path

import pytest

from grader.lab.grading.grade import grade
from grader.report.formats import Format, render
from tests.samples import LAB6, ROOT, opened

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("kind", [kind for kind in Format if kind.needs != "identity"])
def test_a_report_is_no_answer(tmp_path: Path, kind: Format) -> None:
    """A report repeats questions and model answers, but grading gives the same with and without it."""
    work = tmp_path / "lab"
    shutil.copytree(ROOT / "submissions/lab6/equivalent-answers-in-text-file", work)
    (work / "my answers.txt").unlink()
    before = grade(LAB6, opened(work))
    (work / f"a_report.{kind.ending}").write_text(render(before, kind), encoding="utf-8")
    after = grade(LAB6, opened(work))
    assert [result.outcome for result in after.results] == [
        result.outcome for result in before.results
    ]
    assert after.problems == before.problems


@pytest.mark.parametrize("odd", ["\f", "\x85", "\u2028", "\v", "\x1c"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_an_answer_has_the_line_of_an_editor(tmp_path: Path, odd: str, end: str) -> None:
    """Only line endings start a line, whatever other breaks Unicode has."""
    text = end.join(
        ["# Lab 6", f"some{odd}thing", "", "## Task 1 step 15", "The tree has two roots.", ""]
    )
    (tmp_path / "answers.md").write_bytes(text.encode())
    found = [
        result.outcome
        for result in grade(LAB6, opened(tmp_path)).results
        if result.criterion.id == "answer-floating-link"
    ]
    assert found[0].location is not None
    assert (found[0].location.line, "two roots" in str(found[0].measured)) == (4, True)
