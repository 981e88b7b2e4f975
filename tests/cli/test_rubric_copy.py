"""grader rubric copy: a shipped rubric with its files, to be changed."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from grader.app.commands import rubrics
from grader.lab.rubric.rubric import shipped_rubrics
from tests.classroom.gradebooks import grader
from tests.samples import ROOT, SAMPLES


@pytest.mark.slow
@pytest.mark.parametrize("name", shipped_rubrics())
def test_a_copy_works_as_it_is(name: str, tmp_path: Path) -> None:
    """Its reference gets full marks, its model answers are there, and it gives the same points and hints."""
    assert grader("rubric", "copy", name, tmp_path).returncode == 0
    copy = tmp_path / name / "rubric.toml"
    assert grader("rubric", "check", copy).stdout.endswith("its reference gets full marks\n")
    answers = sorted(file.name for file in tmp_path.glob("*.answers.toml"))
    assert answers == sorted(file.name for file in (ROOT / "rubrics").glob(f"{name}.answers.toml"))
    sample = next(
        sample
        for sample in SAMPLES.values()
        if sample.expected.rubric == name and sample.expected.lost
    )
    for words in (
        ("rubric", "show"),
        ("grade", ROOT / sample.path, "--format", "json", "--rubric"),
    ):
        one, other = (
            grader(*words, rubric).stdout.splitlines()[words[0] == "rubric" :]
            for rubric in (name, copy)
        )
        assert one == other != []


@pytest.fixture
def without_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Install lab6 as students have it: without its model answers."""
    shutil.copytree(ROOT / "rubrics/lab6", tmp_path / "installed/lab6")
    (tmp_path / "installed/lab6/answers.toml").unlink()
    monkeypatch.setattr("grader.lab.rubric.rubric.shipped_folder", lambda _: tmp_path / "installed")
    shipped_rubrics.cache_clear()
    yield
    shipped_rubrics.cache_clear()


@pytest.mark.usefixtures("without_answers")
def test_without_the_answers_no_line_names_them(tmp_path: Path) -> None:
    """A copy of a rubric without its model answers is checked without a warning."""
    assert "answers.toml" not in rubrics.copy("lab6", tmp_path / "copy")
    checked = grader("rubric", "check", tmp_path / "copy/lab6/rubric.toml")
    assert (checked.returncode, checked.stderr) == (0, "")
