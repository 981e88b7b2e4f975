"""In a job of GitHub Actions: annotations on standard error and the report in the job's summary; nothing else differs."""

import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.command_line import Done, run_with_input
from tests.report.readers import read_as_github
from tests.report.workflow_commands import commands
from tests.samples import ROOT

MAX_SUMMARY = 1024 * 1024  # bytes that GitHub accepts for a summary
MISTAKEN = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"
ELSEWHERE: Mapping[str, str] = {"GITHUB_ACTIONS": ""}


class GithubJob:
    """A checkout with a submission in it, and the file that becomes the job's summary."""

    def __init__(self, folder: Path) -> None:
        self.checkout, self.summary = folder / "checkout", folder / "summary.md"
        (self.checkout / ".git").mkdir(parents=True)
        shutil.copy(MISTAKEN, self.checkout)

    def run(self, *arguments: str, around: Mapping[str, str] = {}) -> Done:
        """Run the command line in the checkout, as a step does; `around` overrides variables of the runner."""
        job = {
            "GITHUB_ACTIONS": "true",
            "GITHUB_WORKSPACE": str(self.checkout),
            "GITHUB_STEP_SUMMARY": str(self.summary),
        }
        return run_with_input(
            (*arguments, "--hints", "none"), b"", {**job, **around}, self.checkout
        )


@pytest.fixture
def job(tmp_path: Path) -> GithubJob:
    """Return a job of its own."""
    return GithubJob(tmp_path)


@pytest.mark.parametrize("form", ["terminal", "json", "markdown", "junit"])
def test_a_job_gets_annotations_and_a_summary(job: GithubJob, form: str) -> None:
    """Standard output is the same as elsewhere, byte for byte; the annotations equal the format github."""
    done = job.run("grade", "my_robot.urdf", "--format", form)
    elsewhere = job.run("grade", "my_robot.urdf", "--format", form, around=ELSEWHERE)
    assert (done.stdout, done.returncode) == (elsewhere.stdout, elsewhere.returncode)
    assert elsewhere.stderr == b""
    assert (
        done.stderr
        == job.run("grade", "my_robot.urdf", "--format", "github", around=ELSEWHERE).stdout
    )
    assert (
        job.summary.read_bytes()
        == job.run("grade", "my_robot.urdf", "--format", "markdown", around=ELSEWHERE).stdout
    )
    assert commands(done.stdout.decode()) == []


def test_a_summary_is_appended(job: GithubJob) -> None:
    """Text of another command of the step is kept, and two reports follow each other."""
    job.summary.write_text("# Built\n")
    for _ in range(2):
        job.run("grade", "my_robot.urdf")
    root = read_as_github(job.summary.read_text(encoding="utf-8"))
    assert [heading.text_content() for heading in root.iter("h1")] == [
        "Built",
        *["lab6: my_robot.urdf"] * 2,
    ]


@pytest.mark.parametrize("room", [0, 1, 50, 200, 3000, 5806, 5807, 20_000])
def test_the_summary_respects_githubs_limit(job: GithubJob, room: int) -> None:
    """The existing text counts; without space for it, nothing is appended."""
    whole = job.run("grade", "my_robot.urdf", "--format", "markdown", around=ELSEWHERE).stdout
    before = b"x" * (MAX_SUMMARY - room - 1) + b"\n"
    job.summary.write_bytes(before)
    assert job.run("grade", "my_robot.urdf").returncode == 1
    text = job.summary.read_bytes()
    assert len(text) <= MAX_SUMMARY
    assert text.startswith(before)
    added = text.removeprefix(before)
    if room > len(whole):
        assert added == b"\n" + whole
    elif added:
        assert b"The report is cut off here" in added
        assert whole.startswith(added[1:].partition(b"**The report is cut")[0])
    else:
        assert room < 200
