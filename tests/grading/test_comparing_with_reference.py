"""Rubrics whose checks compare with the reference solution: in a class, in a bundle, and in the documentation."""

import re
import zipfile
from csv import DictReader
from pathlib import Path

import pytest

from tests.command_line import ROOT, run

pytestmark = pytest.mark.slow

REFERENCE = ROOT / "tests/corpus/grading/arm.urdf"
HEAD = """\
id = "arm"
title = "Arm"
reference = "arm.urdf"
hints = "none"
[[part]]
id = "a"
title = "A"
[[criterion]]
id = "moves"
part = "a"
title = "It moves"
points = 4
"""
EXAMPLES = re.findall(
    r"```toml\n(.*?)```", (ROOT / "docs/checks.md").read_text(encoding="utf-8"), re.DOTALL
)
CHECK = 'check = "kinematics_match_reference"\nwith = { links = ["@tip"] }\n'


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """Return a folder with a rubric, its reference, and a class with one correct and one wrong robot."""
    text = REFERENCE.read_text()
    (tmp_path / "arm.toml").write_text(HEAD + CHECK)
    (tmp_path / "arm.urdf").write_text(text)
    for name, robot in (
        ("ash", text.replace("0.2", ".2")),
        ("birch", re.sub('axis xyz="0 1', 'axis xyz="0 -1', text)),
    ):
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "robot.urdf").write_text(robot)
    return tmp_path


def test_a_class(lab: Path) -> None:
    """Workers compare with the reference, too."""
    rubric, book = ("--rubric", lab / "arm.toml"), ("--gradebook", lab / "book")
    done = run(("batch", lab / "class", *rubric, *book, "--jobs", "2"))
    assert done.returncode == 0, done
    with (lab / "book/grades.csv").open(encoding="utf-8", newline="") as file:
        assert {row["id"]: row["moves"] for row in DictReader(file)} == {"ash": "4", "birch": "0"}


@pytest.mark.parametrize(("check", "is_needed"), [(CHECK, True), ('check = "urdf_loads"\n', False)])
def test_the_bundle_contains_the_reference(lab: Path, check: str, is_needed: bool) -> None:
    """Also where hints, for which it is needed otherwise, are off; without such a check they decide."""
    (lab / "arm.toml").write_text(HEAD + check)
    assert (
        run(("bundle", "gradescope", lab / "out.zip", "--rubric", lab / "arm.toml")).returncode == 0
    )
    with zipfile.ZipFile(lab / "out.zip") as archive:
        assert ("arm.urdf" in archive.namelist()) == is_needed


@pytest.mark.parametrize("example", EXAMPLES)
def test_the_examples_of_the_documentation(lab: Path, example: str) -> None:
    """Each example is a valid criterion."""
    (lab / "arm.toml").write_text(HEAD + example[example.index("check =") :])
    done = run(("rubric", "show", lab / "arm.toml"))
    assert done.returncode == 0, done
