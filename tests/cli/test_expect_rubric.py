"""grader grade --expect-rubric: a student's file is never used as the rubric."""

from pathlib import Path

import pytest

from tests.cli.jobs import ELSEWHERE, GithubJob
from tests.samples import LAB6


@pytest.fixture
def job(tmp_path: Path) -> GithubJob:
    """Return a job of its own."""
    return GithubJob(tmp_path)


def test_an_id_is_the_shipped_rubric(job: GithubJob) -> None:
    """Whatever files a repository contains, an id means the shipped rubric and a path means the file."""
    own = LAB6.data.replace(b"IRP Lab 6", b"My own")
    for name in ("lab6", "lab6.toml", "rubrics/lab6/rubric.toml", "grader/rubrics/lab6/rubric.toml", ".toml/lab6"):
        file = job.checkout / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(own)
    for arguments in ((), ("--rubric", "lab6")):
        done = job.run("grade", "my_robot.urdf", *arguments, "--expect-rubric", LAB6.sha256)
        assert done.returncode == 1, done.stderr
        assert b"My own" not in done.stdout
    for name in ("lab6.toml", "./lab6", "rubrics/lab6/rubric.toml"):
        assert b"My own" in job.run("grade", "my_robot.urdf", "--rubric", name).stdout
        done = job.run("grade", "my_robot.urdf", "--rubric", name, "--expect-rubric", LAB6.sha256)
        assert (done.returncode, done.stdout) == (2, b"")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (LAB6.sha256, ""),
        (LAB6.sha256.upper(), ""),
        (LAB6.sha256[:-1] + ("0" if LAB6.sha256[-1] != "0" else "1"), f"its sha256 is {LAB6.sha256}, not "),
        (LAB6.sha256[:-1], "--expect-rubric takes the 64 digits"),
        (LAB6.sha256 + "\n", "--expect-rubric takes the 64 digits"),
        ("\uff10" * 64, "--expect-rubric takes the 64 digits"),
        ("", "--expect-rubric takes the 64 digits"),
    ],
)
def test_expected_rubric(job: GithubJob, given: str, words: str) -> None:
    """Only a rubric with the expected hash is used, in upper or lower case; anything that is no hash is refused."""
    done = job.run("grade", "my_robot.urdf", "--expect-rubric", given, around=ELSEWHERE)
    assert done.returncode == (2 if words else 1)
    assert words in done.stderr.decode()
    assert done.stderr.count(b"\n") == bool(words)
    assert (done.stdout == b"") == bool(words)
