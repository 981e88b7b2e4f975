"""grader rubric copy: a shipped rubric with its files, to be changed."""

from pathlib import Path

import pytest

from grader.grading.rubric import shipped_rubrics
from tests.classroom.gradebooks import grader
from tests.samples import ROOT, SAMPLES


@pytest.mark.parametrize("name", shipped_rubrics())
def test_a_copy_works_as_it_is(name: str, tmp_path: Path) -> None:
    """Its reference gets full marks, its model answers are there, and it gives the same points and hints."""
    assert grader("rubric", "copy", name, tmp_path).returncode == 0
    copy = tmp_path / name / "rubric.toml"
    assert grader("rubric", "check", copy).stdout.endswith("its reference gets full marks\n")
    answers = sorted(file.name for file in tmp_path.glob("*.answers.toml"))
    assert answers == sorted(file.name for file in (ROOT / "rubrics").glob(f"{name}.answers.toml"))
    sample = next(sample for sample in SAMPLES.values() if sample.expected.rubric == name and sample.expected.lost)
    for words in (("rubric", "show"), ("grade", ROOT / sample.path, "--format", "json", "--rubric")):
        one, other = (grader(*words, rubric).stdout.splitlines()[words[0] == "rubric" :] for rubric in (name, copy))
        assert one == other != []
