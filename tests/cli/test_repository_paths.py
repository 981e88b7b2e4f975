"""Paths in a report for a repository are relative to its root, wherever the grader starts and whatever it grades."""

import json
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.cli.jobs import MISTAKEN, GithubJob
from tests.command_line import HANG_TIMEOUT, run_with_input
from tests.samples import ROOT

REFERENCE = ROOT / "submissions/lab6/reference"
URDF = "roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"


@pytest.fixture
def job(tmp_path: Path) -> GithubJob:
    """Return a checkout with a submission in its root, which has one mistake, and a URDF in a folder."""
    made = GithubJob(tmp_path)
    (made.checkout / "my_robot.urdf").unlink()
    shutil.copytree(REFERENCE, made.checkout, dirs_exist_ok=True)
    _mistake(made.checkout / URDF)
    (made.checkout / "my lab").mkdir()
    shutil.copy(MISTAKEN, made.checkout / "my lab")
    return made


def _mistake(file: Path) -> None:
    file.write_text(file.read_text(encoding="utf-8").replace('"0 0.6 0 1"', '"0 1 0 1"'), encoding="utf-8")


def test_the_root_of_the_repository(job: GithubJob) -> None:
    """The checkout itself, under any of its names."""
    for path in (".", "./", str(job.checkout), "../checkout", "my lab/.."):
        assert job.files(path) == {URDF}


def test_a_folder_in_it(job: GithubJob) -> None:
    """A package or workspace below the root, from the root or from beside it."""
    assert job.files("roscourse_sim_ws") == {URDF}
    assert job.files("src/my_robot", start=job.checkout / "roscourse_sim_ws") == {URDF}
    assert job.files(".", start=job.checkout / "roscourse_sim_ws/src/my_robot") == {URDF}


def test_a_urdf_in_it(job: GithubJob) -> None:
    """A single file is in its folder; a symlink keeps its own name."""
    (job.checkout / "linked.urdf").symlink_to("my lab/my_robot.urdf")
    assert job.files("my lab/my_robot.urdf") == {"my lab/my_robot.urdf"}
    assert job.files("my_robot.urdf", start=job.checkout / "my lab") == {"my lab/my_robot.urdf"}
    assert job.files("linked.urdf") == {"linked.urdf"}


def test_an_archive_in_it(job: GithubJob) -> None:
    """The location of a file in an archive is the archive."""
    with zipfile.ZipFile(job.checkout / "my lab" / "lab6.zip", "w") as archive:
        archive.write(MISTAKEN, "my_robot.urdf")
    assert job.files("my lab/lab6.zip") == {"my lab/lab6.zip"}


def test_a_symlinked_workspace(job: GithubJob, tmp_path: Path) -> None:
    """Named by the symlink or by its target."""
    link = tmp_path / "link"
    link.symlink_to(job.checkout)
    for path in (str(link), str(job.checkout), str(link / "roscourse_sim_ws")):
        assert job.files(path, around={"GITHUB_WORKSPACE": str(link)}) == {URDF}


def test_outside_the_workspace(job: GithubJob, tmp_path: Path) -> None:
    """No annotation has a file, because the repository may contain one of the same name; the text has the location."""
    (tmp_path / "other").mkdir()
    shutil.copy(MISTAKEN, tmp_path / "other")
    for path in ("../other/my_robot.urdf", str(tmp_path / "other")):
        assert job.files(path) == set()
        assert "In my_robot.urdf:39:15." in str(job.run("grade", path).stderr)


def test_without_a_ci_system(job: GithubJob) -> None:
    """The nearest repository counts, including submodules and worktrees; without one, the current folder."""
    alone = {"GITHUB_WORKSPACE": ""}
    assert job.files("my_robot.urdf", start=job.checkout / "my lab", around=alone) == {"my lab/my_robot.urdf"}
    (job.checkout / "my lab/.git").write_text("gitdir: ../.git/worktrees/lab\n")
    assert job.files("my lab/my_robot.urdf", around=alone) == {"my_robot.urdf"}
    for location in ("my lab/.git", ".git"):
        git = job.checkout / location
        git.unlink() if git.is_file() else git.rmdir()
    assert job.files("my lab/my_robot.urdf", around=alone) == {"my lab/my_robot.urdf"}
    assert job.files("my_robot.urdf", start=job.checkout / "my lab", around=alone) == {"my_robot.urdf"}


def test_on_gitlab(job: GithubJob) -> None:
    """GitLab's checkout is the root, even if a repository is nearer."""
    (job.checkout / "my lab/.git").mkdir()
    done = job.run(
        *("grade", "my lab/my_robot.urdf", "--format", "codeclimate"),
        around={"GITHUB_ACTIONS": "", "GITHUB_WORKSPACE": "", "CI_PROJECT_DIR": str(job.checkout)},
    )
    assert {issue["location"]["path"] for issue in json.loads(done.stdout)} == {"my lab/my_robot.urdf"}
    assert done.stderr == b""


def test_standard_input(job: GithubJob) -> None:
    """Annotations have only the conventional name of standard input as file."""
    done = run_with_input(("grade", "-", "--format", "sarif"), MISTAKEN.read_bytes(), folder=job.checkout)
    locations = [result["locations"][0]["physicalLocation"] for result in json.loads(done.stdout)["runs"][0]["results"]]
    assert {location["artifactLocation"]["uri"] for location in locations} == {"-"}


@pytest.mark.exhaustive
def test_a_deleted_current_folder(tmp_path: Path) -> None:
    """A report needs no current folder."""
    gone = tmp_path / "gone"
    gone.mkdir()
    done = subprocess.run(
        ["bash", "-c", f"rmdir ../gone; '{sys.executable}' -m grader grade {MISTAKEN} --format github"],
        cwd=gone,
        capture_output=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )
    assert (done.returncode, done.stderr) == (1, b"")
