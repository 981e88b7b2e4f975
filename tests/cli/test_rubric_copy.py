"""grader rubric copy: a shipped rubric with its files, to be changed."""

import json
from pathlib import Path

import pytest

from grader.grading.rubric import shipped_rubrics
from tests.classroom.gradebooks import grader, refusal
from tests.samples import ROOT

SAMPLE = ROOT / "submissions/lab6/lidar-in-the-middle/my_robot/urdf"


@pytest.mark.parametrize("name", shipped_rubrics())
def test_a_copy_works_as_it_is(name: str, tmp_path: Path) -> None:
    """Its reference gets full marks, and its model answers are there."""
    done = grader("rubric", "copy", name, tmp_path / "mine")
    assert (done.returncode, done.stderr) == (0, "")
    copy = tmp_path / "mine" / name / "rubric.toml"
    assert done.stdout.splitlines()[0] == str(copy)
    assert done.stdout.endswith(f"next: change it, then `grader rubric check {copy}`\n")
    checked = grader("rubric", "check", copy)
    assert (checked.returncode, checked.stderr) == (0, "")
    assert checked.stdout.endswith("its reference gets full marks\n")
    shown = [grader("rubric", "show", which).stdout.splitlines()[1:] for which in (name, copy)]
    assert shown[0] == shown[1]
    assert (copy.parent / "answers.toml").exists() == (ROOT / "rubrics" / name / "answers.toml").exists()


def test_a_copy_grades_like_the_rubric(tmp_path: Path) -> None:
    """The same points and hints."""
    grader("rubric", "copy", "lab6", tmp_path)
    reports = [
        json.loads(grader("grade", SAMPLE, "--rubric", rubric, "--format", "json").stdout)
        for rubric in ("lab6", tmp_path / "lab6/rubric.toml")
    ]
    assert reports[0] == reports[1]
    assert any(result["hints"] for result in reports[0]["results"])


@pytest.mark.parametrize("there", ["rubric.toml", "my_robot", "answers.toml"])
def test_nothing_is_overwritten(there: str, tmp_path: Path) -> None:
    """If one of the files is there, none is written."""
    mine = tmp_path / "lab6" / there
    mine.parent.mkdir()
    mine.write_text("mine")
    done = grader("rubric", "copy", "lab6", tmp_path)
    assert refusal(done) == f"{mine} exists already: nothing was copied"
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == [mine]


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("lab7", "lab7 is not a rubric of the grader: arm, lab6, sensors"),
        (str(ROOT / "rubrics/lab6/rubric.toml"), "is not a rubric of the grader: arm, lab6, sensors"),
    ],
)
def test_what_is_refused(name: str, why: str, tmp_path: Path) -> None:
    """Only the rubrics that come with the grader are copied."""
    assert why in refusal(grader("rubric", "copy", name, tmp_path))


def test_a_rubric_without_its_reference(tmp_path: Path) -> None:
    """The error names the file, the line, and the command that copies both."""
    (tmp_path / "arm.toml").write_bytes((ROOT / "rubrics/arm/rubric.toml").read_bytes())
    expected = (
        f"{tmp_path / 'arm.toml'}:3: the reference {tmp_path / 'arm.urdf'} does not exist"
        " (`grader rubric copy arm FOLDER` copies a rubric with its reference)"
    )
    assert refusal(grader("rubric", "check", tmp_path / "arm.toml")) == expected
    assert refusal(grader("grade", ROOT / "rubrics/arm", "--rubric", tmp_path / "arm.toml")) == expected
