"""`grader rubric sheet`: what students get; and `rubric show --format json`."""

import json
import re
from pathlib import Path

import pytest

from grader.lab.rubric.rubric import load_rubric, shipped_rubrics
from tests.command_line import run

_SHEET = ("rubric", "sheet")


@pytest.mark.parametrize("name", sorted(shipped_rubrics()))
def test_a_sheet_has_each_task_with_its_points(name: str) -> None:
    """In the order of the rubric, by parts; the points of all are those of the rubric."""
    rubric = load_rubric(name)
    text = run((*_SHEET, name)).stdout.decode()
    items = re.findall(r"^- (.*) \(([\d.]+)( extra)?(?:, manual grading)?\)$", text, re.MULTILINE)
    assert len(items) == len([criterion for criterion in rubric.criteria if criterion.points])
    assert sum(float(points) for _, points, extra in items if not extra) == float(rubric.points)
    assert text.startswith(f"# {rubric.title}\n")
    assert f"`grader grade --rubric {name}`" in text
    assert f"`{rubric.urdf}`" in text


def test_a_sheet_says_what_to_submit_and_what_needs_manual_grading() -> None:
    """Evidence with the words in the names of its files."""
    text = run((*_SHEET, "lab6")).stdout.decode()
    assert "- The package `my_robot`\n" in text
    assert "(a file with `task 1 step 8` in its name)" in text
    assert "(4, manual grading)" in text


def test_a_lab_without_a_robot_asks_for_none(tmp_path: Path) -> None:
    """Its parts need a package."""
    file = tmp_path / "lab.toml"
    file.write_text(
        'id = "x"\ntitle = "X"\npackage = "nodes"\n[[part]]\nid = "a"\ntitle = "A"\nneeds = "package"\n'
        '[[criterion]]\nid = "c"\npart = "a"\npoints = 1\ntitle = "It builds"\ncheck = "setup_imports"\n'
    )
    text = run((*_SHEET, file)).stdout.decode()
    assert "## What to submit\n\n- The package `nodes`\n\n## Before" in text


def test_a_lab_asks_for_a_robot_if_a_check_reads_one(tmp_path: Path) -> None:
    """Whatever its parts need: one without checks may need a URDF, and is of no robot."""
    file = tmp_path / "lab.toml"
    head = 'id = "x"\ntitle = "X"\nurdf = "a.urdf"\n[[part]]\nid = "a"\ntitle = "A"\n'
    row = '[[criterion]]\nid = "c"\npart = "a"\npoints = 1\ntitle = "C"\n'
    for needs, check, is_of_robot in (
        ("package", 'check = "urdf_loads"\n', True),
        ("urdf", 'check = "answered"\nwith = { question = "Why?" }\n', False),
    ):
        file.write_text(f'{head}needs = "{needs}"\n{row}{check}')
        text = run((*_SHEET, file)).stdout.decode()
        assert ("- The robot, `a.urdf`\n" in text) is is_of_robot, needs


def test_a_sheet_has_nothing_of_the_reference(tmp_path: Path) -> None:
    """Neither its text nor a picture, unless it is asked for; text of a rubric is no markup."""
    page = run((*_SHEET, "rover", "--format", "html")).stdout.decode()
    assert "<svg" not in page
    assert "<li>It stands level" in page
    drawn = run((*_SHEET, "rover", "--format", "html", "--picture")).stdout.decode()
    assert "<svg" in drawn
    file = tmp_path / "my lab.toml"
    file.write_text(
        'id = "x"\ntitle = "<b>*"\n[[part]]\nid = "a"\ntitle = "A"\n'
        '[[criterion]]\nid = "c"\npart = "a"\npoints = 1\ntitle = "<i> `x`"\ncheck = "urdf_loads"\n'
    )
    page = run((*_SHEET, file, "--format", "html")).stdout.decode()
    assert "<li>&lt;i&gt; <code>x</code> (1)</li>" in page
    assert "<b>" not in page
    text = run((*_SHEET, file)).stdout.decode()
    assert text.startswith("# &lt;b&gt;\\*\n")
    assert "--rubric 'my lab.toml'" in text
    refused = run((*_SHEET, file, "--format", "html", "--picture"))
    assert refused.returncode == 2
    assert refused.stderr.decode() == "grader: the rubric x has no reference: there is no picture\n"
    refused = run((*_SHEET, file, "--picture"))
    assert refused.stderr.decode() == "grader: --picture is for --format html\n"


def test_a_rubric_as_json() -> None:
    """It has the criteria of each part, and the points of all."""
    data = json.loads(run(("rubric", "show", "rover", "--format", "json")).stdout)
    rubric = load_rubric("rover")
    criteria = [criterion for part in data["parts"] for criterion in part["criteria"]]
    assert [each["id"] for each in criteria] == [each.id for each in rubric.criteria]
    assert sum(each["points"] for each in criteria if not each["bonus"]) == data["points"] == 50
    assert data["sha256"] == rubric.sha256


def test_another_labs_package_is_named() -> None:
    """Before its points: the package, and which one the rubric is for; a misspelt one is none."""
    text = run(
        ("grade", "rubrics/diffdrive", "--rubric", "lab6", "--hints", "none")
    ).stdout.decode()
    assert (
        "Note: this is the package 'diffdrive_robot'; the rubric lab6 is for 'my_robot'\n" in text
    )
    text = run(("grade", "rubrics/diffdrive", "--rubric", "diffdrive")).stdout.decode()
    assert "this is the package" not in text
