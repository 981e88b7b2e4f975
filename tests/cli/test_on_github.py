"""In a job of GitHub Actions: annotations on standard error and the report in the job's summary; nothing else differs."""

from pathlib import Path

import pytest

from tests.cli.jobs import ELSEWHERE, GithubJob
from tests.report.readers import read_as_github
from tests.report.workflow_commands import commands

MAX_SUMMARY = 1024 * 1024  # bytes that GitHub accepts for a summary


@pytest.fixture
def job(tmp_path: Path) -> GithubJob:
    """Return a job of its own."""
    return GithubJob(tmp_path)


@pytest.mark.parametrize("form", ["terminal", "json", "markdown", "sarif"])
def test_a_job_gets_annotations_and_a_summary(job: GithubJob, form: str) -> None:
    """Standard output is the same as elsewhere, byte for byte; the annotations equal the format github."""
    done = job.run("grade", "my_robot.urdf", "--format", form)
    elsewhere = job.run("grade", "my_robot.urdf", "--format", form, around=ELSEWHERE)
    assert (done.stdout, done.returncode) == (elsewhere.stdout, elsewhere.returncode)
    assert elsewhere.stderr == b""
    assert done.stderr == job.run("grade", "my_robot.urdf", "--format", "github", around=ELSEWHERE).stdout
    assert (
        job.summary.read_bytes() == job.run("grade", "my_robot.urdf", "--format", "markdown", around=ELSEWHERE).stdout
    )
    assert commands(done.stdout.decode()) == []


def test_requested_annotations_are_printed_once(job: GithubJob) -> None:
    """With the format github standard error stays empty, and the summary is written all the same."""
    done = job.run("grade", "my_robot.urdf", "--format", "github")
    assert len(commands(done.stdout.decode())) == 8
    assert done.stderr == b""
    assert job.summary.read_text(encoding="utf-8").startswith("# 43 / 70 points")


@pytest.mark.parametrize("variable", ["GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY"])
def test_no_annotations_elsewhere(job: GithubJob, variable: str) -> None:
    """Another system that sets some of the variables, and a runner without summaries."""
    done = job.run("grade", "my_robot.urdf", around={variable: ""})
    assert (done.stderr == b"") == (variable == "GITHUB_ACTIONS")
    assert not job.summary.exists()


def test_a_summary_is_appended(job: GithubJob) -> None:
    """Text of another command of the step is kept, and two reports follow each other."""
    job.summary.write_text("# Built\n")
    for _ in range(2):
        job.run("grade", "my_robot.urdf")
    root = read_as_github(job.summary.read_text(encoding="utf-8"))
    assert [heading.text_content() for heading in root.iter("h1")] == [
        "Built",
        *["43 / 70 points: IRP Lab 6: a wheeled base"] * 2,
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


@pytest.mark.parametrize("path", ["folder", "/dev/full", "nowhere/at/all.md"])
def test_a_summary_that_cannot_be_written_changes_nothing_else(job: GithubJob, path: str) -> None:
    """One line says so; report, annotations and exit code are as always."""
    (job.checkout / "folder").mkdir()
    usual = job.run("grade", "my_robot.urdf")
    done = job.run("grade", "my_robot.urdf", around={"GITHUB_STEP_SUMMARY": path})
    assert (done.stdout, done.returncode) == (usual.stdout, usual.returncode)
    added = done.stderr.removeprefix(usual.stderr)
    assert added.startswith(b"grader: cannot write the job summary: ")
    assert added.count(b"\n") == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("nowhere.urdf",), "nowhere.urdf does not exist"),
        (("my_robot.urdf", "--rubric", "nowhere.toml"), "cannot read nowhere.toml"),
        (("my_robot.urdf", "--rubric", "lab7"), "there is no rubric 'lab7'"),
        (("my_robot.urdf", "--part", "task2"), "give the folder or archive"),
        (("my_robot.urdf", "--expect-rubric", "0" * 64), "is not the expected one"),
        (("my_robot.urdf", "--save", "json=nowhere/a.json"), "cannot write nowhere/a.json"),
        (("my_robot.urdf", "--save", "pdf=a.pdf"), "--save takes FORMAT=FILE"),
        (("my_robot.urdf", "--fail-under", "many"), "--fail-under takes points"),
    ],
)
def test_a_job_without_a_report_says_why(job: GithubJob, arguments: tuple[str, ...], words: str) -> None:
    """As an annotation and in the summary, besides the line on standard error; exit code 2."""
    done = job.run("grade", *arguments)
    assert (done.returncode, done.stdout) == (2, b"")
    (reported,) = commands(done.stderr.decode())
    assert (reported.name, reported.get("title"), reported.get("file")) == ("error", "Nothing was graded", None)
    assert words in reported.data
    assert done.stderr.decode().splitlines()[1] == f"grader: {reported.data}"
    root = read_as_github(job.summary.read_text(encoding="utf-8"))
    assert [root.findtext("h1"), root.findtext("p")] == ["Nothing was graded", reported.data]


def test_every_mistake_of_a_rubric_is_in_the_annotation(job: GithubJob) -> None:
    """Line by line, as on standard error."""
    (job.checkout / "bad.toml").write_text('id = "x"\ntitel = "y"\n')
    done = job.run("grade", "my_robot.urdf", "--rubric", "bad.toml")
    (reported,) = commands(done.stderr.decode())
    lines = reported.data.splitlines()
    assert len(lines) == 4
    assert done.stderr.decode().splitlines()[1:] == [f"grader: {line}" for line in lines]


@pytest.mark.parametrize(("threshold", "code"), [("43", 0), ("60%", 0), ("43.5", 1), ("100%", 1)])
def test_the_threshold_decides_whether_the_step_fails(job: GithubJob, threshold: str, code: int) -> None:
    """Error annotations alone fail no step."""
    done = job.run("grade", "my_robot.urdf", "--fail-under", threshold)
    assert done.returncode == code
    assert {command.name for command in commands(done.stderr.decode())} == {"notice", "error"}


def test_help_is_plain_text_in_a_job(job: GithubJob) -> None:
    """Some libraries colour their help there."""
    for arguments in (("--help",), ("grade", "--help"), ("inspect",), ("grad",)):
        done = job.run(*arguments)
        assert b"\x1b" not in done.stdout + done.stderr
