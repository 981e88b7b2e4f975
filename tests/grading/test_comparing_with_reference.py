"""Rubrics whose checks compare with the reference solution: graded alone, in a class and in a bundle for Gradescope."""

import re
import zipfile
from collections.abc import Callable
from csv import DictReader
from pathlib import Path

import pytest

from tests.checks.robots import ARM, arm
from tests.command_line import ROOT, Done, run

RUBRIC = """\
id = "arm"
title = "Arm"
reference = "arm"
hints = "none"
[[part]]
id = "a"
title = "A"
[[criterion]]
id = "moves"
part = "a"
title = "It moves"
points = 4
check = "kinematics_match_reference"
with = { links = ["@tip"] }
"""

HEAD = RUBRIC.partition("check =")[0]
EXAMPLES = re.findall(r"```toml\n(.*?)```", (ROOT / "docs/checks.md").read_text(encoding="utf-8"), re.DOTALL)


# What is wrong with the reference, by what is done to the folder of the rubric, and a part of the message.
BROKEN: dict[str, tuple[Callable[[Path], object], str]] = {
    "missing": (lambda folder: (folder / "arm/robot.urdf").unlink(), "arm"),
    "another file": (
        lambda folder: (folder / "arm/robot.urdf").rename(folder / "arm/notes.txt").write_text("nothing"),
        "cannot be compared with: no URDF",
    ),
    "not a URDF": (lambda folder: (folder / "arm/robot.urdf").write_text("nothing"), "cannot be compared with"),
    "xacro without a robot": (
        lambda folder: (folder / "arm/robot.urdf").write_text("<robot>${x}<robot"),
        "cannot be compared with",
    ),
    "no such link": (
        lambda folder: (folder / "arm.toml").write_text(RUBRIC.replace("@tip", "hand")),
        "the criterion moves: the reference solution cannot be compared with: there is no link 'hand'",
    ),
    "not named": (
        lambda folder: (folder / "arm.toml").write_text(RUBRIC.replace('reference = "arm"\n', "")),
        "the rubric needs the key reference",
    ),
}


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """Return a folder with a rubric, its reference, and a class with one correct and one wrong robot."""
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm.toml").write_text(RUBRIC)
    (tmp_path / "arm/robot.urdf").write_text(ARM.text)
    wrong = arm(axis="0 -1 0").text
    for name, text in (("ash", ARM.text.replace("0.2", ".2")), ("birch", wrong)):
        folder = tmp_path / "class" / name
        folder.mkdir(parents=True)
        (folder / "robot.urdf").write_text(text)
    return tmp_path


def graded(lab: Path, name: str) -> Done:
    """Return the run of `grader grade` on a submission of the class."""
    return run(("grade", lab / "class" / name, "--rubric", lab / "arm.toml"))


def test_a_submission(lab: Path) -> None:
    """The correct robot passes, the wrong one fails with its joint and its line."""
    assert graded(lab, "ash").returncode == 0
    done = graded(lab, "birch")
    assert done.returncode == 1
    words = b" ".join(done.stdout.split())
    assert b"it differs as soon as 'shoulder' moves: its axis is reversed" in words
    assert b"robot.urdf:" in words


def test_a_class(lab: Path) -> None:
    """Workers compare with the reference, too."""
    book = lab / "book.db"
    done = run(
        (
            "batch",
            lab / "class",
            "--rubric",
            lab / "arm.toml",
            "--gradebook",
            book,
            "--jobs",
            "2",
            "--csv",
            lab / "grades.csv",
        )
    )
    assert done.returncode == 0, done
    with (lab / "grades.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["id"]: (row["status"], row["score"], row["moves"]) for row in DictReader(file)}
    assert rows == {"ash": ("graded", "4", "4"), "birch": ("graded", "0", "0")}


def test_the_reference_gets_full_marks(lab: Path) -> None:
    """`rubric check` compares the reference with itself."""
    done = run(("rubric", "check", lab / "arm.toml"))
    assert done.returncode == 0, done
    assert b"its reference gets full marks" in done.stdout


@pytest.mark.parametrize("fault", BROKEN)
def test_a_reference_that_cannot_be_read_stops_every_command(lab: Path, fault: str) -> None:
    """Nothing is graded: one line, exit code 2, no report, no bundle."""
    change, message = BROKEN[fault]
    change(lab)
    rubric = ("--rubric", lab / "arm.toml")
    for words in (
        ("grade", lab / "class/ash", *rubric),
        ("batch", lab / "class", *rubric, "--gradebook", lab / "book.db", "--jobs", "2"),
        ("bundle", "gradescope", lab / "out.zip", *rubric),
    ):
        done = run(words)
        assert done.returncode == 2, (words, done)
        assert message in " ".join(done.stderr.decode().split()), done
        assert not done.stdout, done
    assert not (lab / "out.zip").exists()


def test_the_bundle_contains_the_reference(lab: Path) -> None:
    """Also where hints, for which it is needed otherwise, are off; without such a check they decide."""
    command = ("bundle", "gradescope", lab / "out.zip", "--rubric", lab / "arm.toml")
    assert run(command).returncode == 0
    with zipfile.ZipFile(lab / "out.zip") as archive:
        assert archive.read("arm/robot.urdf").decode() == ARM.text
    (lab / "arm.toml").write_text(RUBRIC.replace("kinematics_match_reference", "urdf_loads").replace("with =", "# "))
    assert run(command).returncode == 0
    with zipfile.ZipFile(lab / "out.zip") as archive:
        assert "arm/robot.urdf" not in archive.namelist()


@pytest.mark.parametrize("example", EXAMPLES)
def test_the_examples_of_the_documentation(lab: Path, example: str) -> None:
    """Each example is a valid criterion."""
    (lab / "arm.toml").write_text(HEAD + example[example.index("check =") :])
    done = run(("rubric", "show", lab / "arm.toml"))
    assert done.returncode == 0, done


def test_a_reference_outside_of_the_bundle_is_refused(lab: Path) -> None:
    """A bundle without it could grade nothing."""
    (lab / "rubrics").mkdir()
    (lab / "rubrics/arm.toml").write_text(RUBRIC.replace('"arm"\nhints', '"../arm"\nhints'))
    done = run(("bundle", "gradescope", lab / "out.zip", "--rubric", lab / "rubrics/arm.toml"))
    assert done.returncode == 2
    assert b"must be below the rubric's folder" in done.stderr
