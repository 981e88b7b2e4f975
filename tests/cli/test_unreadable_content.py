"""Content that cannot be read is not a green check, and is reported with the findings."""

import json
import shutil
import zipfile
from pathlib import Path

import pytest

from tests.command_line import ROOT, run

REFERENCE = ROOT / "submissions/lab6/reference"
URDF = ROOT / "rubrics" / "lab6" / "my_robot" / "urdf" / "my_robot.urdf"


def graded(path: Path, *options: str) -> tuple[int, str]:
    """Return the exit code for a path, and its annotations."""
    done = run(("grade", str(path), "--format", "github", *options))
    return done.returncode, done.stdout.decode()


@pytest.mark.parametrize("name", ["lab6.zip", "notes.tar.gz"])
def test_an_unreadable_archive(tmp_path: Path, name: str) -> None:
    """Alone or beside a URDF: its content is undecided, and the check is red."""
    (tmp_path / name).write_bytes(b"no archive")
    code, reported = graded(tmp_path)
    assert code == 1
    assert f"::warning title=urdf-loads::No URDF was found, but {name} could not be opened" in reported
    shutil.copy(URDF, tmp_path)
    code, reported = graded(tmp_path)
    assert code == 1
    assert f"::warning title=package-found::No package was found, but {name} could not be opened" in reported
    assert "Could not be decided (20 points): package-found, " in reported


def test_a_urdf_that_is_too_large(tmp_path: Path) -> None:
    """The rest is graded, Task 1 needs manual grading, and the check is red."""
    shutil.copytree(REFERENCE, tmp_path / "work")
    [urdf] = (tmp_path / "work").rglob("*.urdf")
    urdf.write_bytes(urdf.read_bytes() + b"<!-- " + b"x" * 1_100_000 + b" -->")
    code, reported = graded(tmp_path / "work")
    assert code == 1
    assert "::warning title=urdf-loads::" in reported or "::warning file=" in reported
    assert "Could not be decided (70 points)" in reported


def test_regular_manual_grading_is_green() -> None:
    """Pictures and written answers need manual grading in every submission."""
    assert graded(REFERENCE) == (0, graded(REFERENCE)[1])
    assert "::warning" not in graded(REFERENCE)[1]


def test_with_a_threshold_only_the_score_counts(tmp_path: Path) -> None:
    """Green if and only if the score reaches it: neither other passes nor undecided criteria change that."""
    assert graded(REFERENCE, "--fail-under", "90")[0] == 0
    assert graded(REFERENCE, "--fail-under", "90.5")[0] == 1
    assert graded(REFERENCE, "--fail-under", "95%")[0] == 1
    (tmp_path / "lab6.zip").write_bytes(b"no archive")
    shutil.copy(URDF, tmp_path)
    assert graded(tmp_path, "--fail-under", "70")[0] == 0
    assert graded(tmp_path, "--fail-under", "70.5")[0] == 1
    for odd in ("1_0", "\uff14\uff12", "101%", "60 %", "-1", "nan", "%"):
        assert run(("grade", str(REFERENCE), "--fail-under", odd)).returncode == 2, odd


def test_xacro_that_cannot_be_determined_is_not_green(tmp_path: Path) -> None:
    """Nothing of it is decided: exit code 1, and standard error and the annotation name the undecided criteria."""
    include = '<xacro:include filename="$(find course_parts)/urdf/robot.xacro"/>'
    text = f'<robot name="my_robot" xmlns:xacro="http://www.ros.org/wiki/xacro">{include}</robot>'
    (tmp_path / "my_robot.urdf.xacro").write_text(text)
    done = run(("grade", str(tmp_path / "my_robot.urdf.xacro")))
    assert done.returncode == 1
    assert b"grader: exit code 1: could not be decided, and needs manual grading: urdf-loads, base-box, " in done.stderr
    code, reported = graded(tmp_path / "my_robot.urdf.xacro")
    assert code == 1
    assert "Could not be decided (70 points): urdf-loads, base-box, " in reported
    assert graded(tmp_path / "my_robot.urdf.xacro", "--fail-under", "0")[0] == 0


def test_findings_in_an_archive_are_on_the_archive(tmp_path: Path) -> None:
    """The repository has no file inside it; the text has the location."""
    with zipfile.ZipFile(tmp_path / "lab6.zip", "w") as archive:
        archive.write(ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf", "my_robot.urdf")
    (tmp_path / ".git").mkdir()
    _, reported = graded(tmp_path)
    assert "::error file=lab6.zip,title=base-green (6 points lost)::" in reported
    assert "In lab6.zip/my_robot.urdf:6:14." in reported
    done = run(("grade", str(tmp_path), "--format", "codeclimate"))
    assert {issue["location"]["path"] for issue in json.loads(done.stdout)} <= {"lab6.zip", "lab6.zip/my_robot.urdf"}


def test_the_most_consequential_failure_comes_first() -> None:
    """A criterion counts for those that are skipped because of it; what is about a missing package comes last."""
    _, reported = graded(ROOT / "submissions/lab6/several-mistakes/my_robot/urdf")
    first, *_, last = [line for line in reported.splitlines() if line.startswith("::error ")]
    assert "title=lidar-frame (6 points lost)::" in first
    assert "title=package-found (20 points lost)::" in last
    assert "Skipped because of it: 11 more, 19 points." in last


def test_many_files_hide_nothing(tmp_path: Path) -> None:
    """Of the ignored files the first dozen are listed in text reports, and all of them in JSON."""
    shutil.copytree(REFERENCE, tmp_path / "work")
    for number in range(40):
        (tmp_path / "work" / f"robot_{number}.urdf").write_text("<robot name='r'/>", encoding="utf-8")
    done = run(("grade", str(tmp_path / "work"), "--format", "markdown"))
    assert done.stdout.decode().count("Other candidate") == 12
    assert "... and 28 more" in done.stdout.decode()
    assert "sha256" in done.stdout.decode().partition("Other candidate")[0]
    done = run(("grade", str(tmp_path / "work"), "--format", "json"))
    assert len(json.loads(done.stdout)["submission"]["other_candidates"]) == 40


def test_inputs_are_not_overwritten(tmp_path: Path) -> None:
    """Neither the URDF, alone or in its folder, nor the rubric; and nothing else is written then."""
    shutil.copy(URDF, tmp_path / "my_robot.urdf")
    shutil.copy(ROOT / "rubrics/lab6/rubric.toml", tmp_path / "lab.toml")
    for folder, over in (
        (tmp_path / "my_robot.urdf", "my_robot.urdf"),
        (tmp_path, "my_robot.urdf"),
        (tmp_path, "lab.toml"),
    ):
        before = (tmp_path / over).read_bytes()
        options = ("--rubric", str(tmp_path / "lab.toml"), "--save", f"json={tmp_path / 'a.json'}")
        done = run(("grade", str(folder), *options, "--save", f"markdown={tmp_path / over}"))
        assert done.returncode == 2
        assert b"also reads or writes it; name another file for --save" in done.stderr
        assert (tmp_path / over).read_bytes() == before
        assert not (tmp_path / "a.json").exists()


def test_a_report_may_be_saved_to_standard_output(tmp_path: Path) -> None:
    """It follows the printed one, in a pipe and in a file."""
    arguments = (
        "grade",
        str(URDF),
        "--format",
        "codeclimate",
        "--save",
        "json=/dev/stdout",
        "--save",
        "junit=/dev/null",
    )
    text = run(arguments).stdout.decode()
    assert text.startswith('{\n "schema": "grader/report/v1"')
    assert text.endswith("}\n[]\n")
