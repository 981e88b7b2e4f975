"""Model answers are shown to those who grade, and to nobody else."""

import shutil
from pathlib import Path

import pytest

from grader.report.formats import Format
from tests.classroom.gradebooks import batch, grader, lab_text
from tests.report.reports import CLASSROOM50

SECRET = "Because of the roots."
INLINE = f', answer = "{SECRET}"'


def with_separate_answers(top: Path, answers: str = f'essay = "{SECRET}"') -> Path:
    """Write the small lab with its model answers in a separate file."""
    rubric = top / "small.toml"
    text = (
        lab_text()
        .replace(INLINE, "")
        .replace('id = "small"', 'id = "small"\nanswers = "small.answers.toml"', 1)
    )
    rubric.write_text(text, encoding="utf-8")
    (top / "small.answers.toml").write_text(answers, encoding="utf-8")
    return rubric


@pytest.mark.parametrize("is_apart", [True, False])
def test_no_report_of_grade_or_batch_contains_one(
    graded_class: Path, tmp_path: Path, is_apart: bool
) -> None:
    """In any format, saved or printed, in a job's summary or log, with the answer in the rubric or in a separate file."""
    top = tmp_path / "small"
    shutil.copytree(graded_class / "class", top / "class")
    shutil.copy(graded_class / "roster.csv", top)
    rubric = with_separate_answers(top) if is_apart else top / "small.toml"
    if not is_apart:
        rubric.write_text(lab_text(), encoding="utf-8")
        assert SECRET in rubric.read_text(encoding="utf-8")
    out = tmp_path / "out"
    out.mkdir()
    saves = [part for kind in Format for part in ("--save", f"{kind}={out / kind.ending}")]
    summary = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(out / "summary")}
    done = grader(
        "grade", top / "class" / "anna", "--rubric", rubric, *saves, **CLASSROOM50, **summary
    )
    assert done.returncode == 0, done.stderr
    formats = [file_format for file_format in Format if file_format.needs != "identity"]
    expected = [part for kind in formats for part in ("--report-format", kind)]
    graded = batch(top, "--reports", out / "reports", *expected)
    assert graded.returncode == 0, graded.stderr
    output = [done.stdout, done.stderr, graded.stdout, graded.stderr]
    for arguments in (
        ("explain", "essay", "--rubric", rubric),
        ("rubric", "show", rubric),
        ("stats", "--gradebook", top / "book"),
        ("export", "csv", "--gradebook", top / "book"),
        ("stats", "--gradebook", top / "book", "--format", "json"),
    ):
        shown = grader(*arguments)
        assert shown.returncode == 0, shown.stderr
        output.append(shown.stdout + shown.stderr)
    files = [
        path.read_text(encoding="utf-8")
        for path in (*out.rglob("*"), *(top / "book").glob("*.*"))
        if path.is_file()
    ]
    assert len(files) > 2 * len(Format)
    assert any("The roots of " in text for text in files)  # what the student has answered
    assert all("of the roots" not in text for text in (*files, *output))
