"""Reports that were saved beside the lab are no part of it."""

import shutil
from pathlib import Path

import pytest

from grader.cli.formats import Format, render
from grader.grading.grade import grade
from tests.samples import LAB6, ROOT, opened


@pytest.mark.parametrize("kind", [kind for kind in Format if kind is not Format.CLASSROOM50])
def test_a_report_is_no_answer(tmp_path: Path, kind: Format) -> None:
    """A report repeats questions and model answers, and yet what is graded is the same with it and without it."""
    work = tmp_path / "lab"
    shutil.copytree(ROOT / "submissions" / "equivalent-answers-in-text-file", work)
    (work / "my answers.txt").unlink()
    before = grade(LAB6, opened(work))
    (work / f"a_report.{kind.ending}").write_text(render(before, kind), encoding="utf-8")
    after = grade(LAB6, opened(work))
    assert [each.outcome for each in after.results] == [each.outcome for each in before.results]
    assert after.problems == before.problems
