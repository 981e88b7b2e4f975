"""However a run ends, results are kept, and rerunning the command gives the same as an undisturbed run."""

import os
import resource
import signal
import subprocess
import time
from contextlib import suppress
from pathlib import Path
from random import Random

import pytest

from grader.app.cli.app import run
from grader.classroom.results.results import ResultsWriter
from tests.classroom.class_runs import (
    HOSTILE_RUBRIC,
    WITH_HOSTILE,
    Done,
    contents,
    counted,
    environment,
    eventually,
    grader,
    hostile_class,
    lines_of,
    repeated,
    session_of,
    shell_code,
    started,
    urdf_class,
    verdicts,
)
from tests.command_line import GRADER, HANG_TIMEOUT, ROOT

KILLS, SIZE = 6, 400
JSON = ("--report-format", "json")
REFERENCE = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_text()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a class that takes some seconds with its reports: one robot in eight has mistakes, whose hints are searched."""
    made = urdf_class(tmp_path_factory.mktemp("large") / "class", SIZE)
    for number, path in enumerate(sorted(made.iterdir())):
        if number % 8:
            path.write_text(f"{REFERENCE}<!-- {number} -->\n")
    return made


@pytest.fixture(scope="module")
def undisturbed(folder: Path) -> tuple[dict[str, bytes], float]:
    """Return the reports of an undisturbed run, and how long it takes."""
    began = time.monotonic()
    done = grader(*_command(folder, folder.parent / "undisturbed"))
    seconds = time.monotonic() - began
    assert done.returncode == 0
    return contents(folder.parent / "undisturbed"), seconds


def _command(folder: Path, out: Path) -> tuple[str | Path, ...]:
    return (
        "batch",
        folder,
        "--gradebook",
        out.with_suffix(".book"),
        "--reports",
        out,
        *JSON,
        "--jobs",
        "2",
    )


def _visible(folder: Path) -> dict[str, bytes]:
    """Return the files of a folder, without those that were being written."""
    return {name: data for name, data in contents(folder).items() if not name.startswith(".")}


@pytest.mark.exhaustive
def test_killed_six_times(
    folder: Path, undisturbed: tuple[dict[str, bytes], float], tmp_path: Path
) -> None:
    """After kill -9 during start, grading and writing every result is there once, and the reports equal those of one run."""
    reports, seconds = undisturbed
    out, dice = tmp_path / "out", Random(7)
    book = out.with_suffix(".book")
    kept = [0]
    for number in range(KILLS):
        with started(*_command(folder, out)) as process:
            if number % 2:
                _wait(process, dice.uniform(0, seconds / 3 if number < KILLS / 2 else seconds))
            else:
                assert eventually(
                    lambda: len(verdicts(book)) > kept[-1] or process.poll() is not None
                )
            process.kill()
            process.wait()
            assert eventually(lambda: not session_of(process))
        kept.append(len(verdicts(book)))
    assert kept == sorted(kept)
    assert any(0 < count < SIZE for count in kept)
    assert grader(*_command(folder, out)).returncode == 0
    assert _visible(out) == reports
    assert len({line["digest"] for line in lines_of(book)}) == len(lines_of(book)) == SIZE
    assert set(verdicts(book).values()) == {"graded"}


def _wait(process: "subprocess.Popen[str]", seconds: float) -> None:
    with suppress(subprocess.TimeoutExpired):
        process.wait(seconds)


@pytest.mark.slow
@pytest.mark.parametrize("is_written", [False, True])
def test_only_what_is_written_is_called_kept(
    is_written: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Where Ctrl-C arrives just before or after the write."""
    append = ResultsWriter.append

    def interrupted(writer: ResultsWriter, *lines: bytes) -> None:
        if is_written:
            append(writer, *lines)
        raise KeyboardInterrupt

    monkeypatch.setattr(ResultsWriter, "append", interrupted)
    folder, book = urdf_class(tmp_path / "class", 2), tmp_path / "book"
    assert run(["batch", str(folder), "--gradebook", str(book), "--jobs", "1"]) == 130
    kept = len(verdicts(book))
    assert bool(kept) == is_written
    assert f"stopped: {kept} of 2 have a result, which is kept" in capsys.readouterr().err


@pytest.mark.slow
def test_interrupted(tmp_path: Path) -> None:
    """Ctrl-C reports in a line how many results are kept, which they are; then the run continues."""
    names = [f"fine-{number}" for number in range(20)]
    folder, book = hostile_class(tmp_path / "class", "hangs", *names), tmp_path / "lab"
    command = (
        "batch",
        folder,
        "--gradebook",
        book,
        "--rubric",
        HOSTILE_RUBRIC,
        "--timeout",
        "3600",
        "--jobs",
        "2",
    )
    with started(*command, **WITH_HOSTILE) as process:
        assert eventually(
            lambda: len(verdicts(book)) > 0
        )  # others may wait in a group with the one that hangs
        os.killpg(process.pid, signal.SIGINT)
        _, output = process.communicate(timeout=HANG_TIMEOUT)
        assert process.returncode == 130
    kept = len(verdicts(book))
    assert output.splitlines() == [
        "grader: 21 submissions, layout folders",
        f"grader: stopped: {kept} of 21 have a result, which is kept; rerun the same command to resume",
        "grader: interrupted",
    ]
    (folder / "hangs.urdf").write_text('<robot name="fine"><link name="a"/></robot>')
    assert counted(grader(*command, **WITH_HOSTILE)) == f"{21 - kept} graded, {kept} unchanged"


@pytest.mark.exhaustive
@pytest.mark.parametrize("moment", [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
def test_interrupted_at_the_start(folder: Path, moment: float, tmp_path: Path) -> None:
    """Whenever Ctrl-C arrives after the command has begun, no process prints a traceback."""
    out = tmp_path / "out"
    with started(*_command(folder, out)) as process:
        assert process.stderr is not None
        process.stderr.readline()  # the class has been read
        time.sleep(moment)
        os.killpg(process.pid, signal.SIGINT)
        _, output = process.communicate(timeout=HANG_TIMEOUT)
        assert (shell_code(process.returncode), output.splitlines()[-1]) == (
            130,
            "grader: interrupted",
        )
        assert all(line.startswith("grader: ") for line in output.splitlines())
        assert eventually(lambda: not session_of(process))


def _with_small_files(limit: int) -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))


def _limited(limit: int, *arguments: str | Path) -> Done:
    """Run the command line with a limit on the size of files."""
    return subprocess.run(
        [*GRADER, *map(str, arguments)],
        env=environment(),
        capture_output=True,
        text=True,
        check=False,
        timeout=HANG_TIMEOUT,
        preexec_fn=lambda: _with_small_files(limit),
    )


def _is_one_complaint(done: Done) -> bool:
    """Return whether standard error has only plain lines, the last of them the reason."""
    return all(
        line.startswith("grader: ") and "Traceback" not in line for line in done.stderr.splitlines()
    )


@pytest.mark.exhaustive
@pytest.mark.parametrize("limit", [0, 50_000, 400_000])
def test_no_space_left(limit: int, folder: Path, tmp_path: Path) -> None:
    """Committed results are kept, the reason is one line, and the run continues when there is space again."""
    book = tmp_path / "lab6"
    command = ("batch", folder, "--gradebook", book, "--jobs", "2")
    done = _limited(limit, *command)
    assert done.returncode == 2
    assert _is_one_complaint(done)
    assert done.stderr.splitlines()[-1].startswith(f"grader: cannot write {book}")
    kept = len(verdicts(book))
    assert kept < SIZE
    assert (kept > 0) == (limit > 0)
    again = grader(*command)
    assert counted(again) == f"{SIZE - kept} graded, {kept} unchanged"
    assert (len(verdicts(book)), repeated(book)) == (SIZE, [])


@pytest.mark.exhaustive
def test_reports_that_cannot_be_written(
    folder: Path, undisturbed: tuple[dict[str, bytes], float], tmp_path: Path
) -> None:
    """No space for reports is one line; the grades are kept, and the reports follow with the next run."""
    out = tmp_path / "out"
    command = _command(folder, out)
    assert grader(*command[:4]).returncode == 0
    done = _limited(100, *command)
    assert (done.returncode, _is_one_complaint(done)) == (2, True)
    assert "cannot write" in done.stderr.splitlines()[-1]
    done = grader(*command)
    assert (done.returncode, counted(done)) == (0, f"0 graded, {SIZE} unchanged")
    assert _visible(out) == undisturbed[0]


@pytest.mark.exhaustive
def test_one_run_at_a_time(folder: Path, tmp_path: Path) -> None:
    """A second run into the gradebook is refused in one line, and one that is marked meanwhile keeps the mark."""
    book = tmp_path / "lab6"
    command = ("batch", folder, "--gradebook", book, "--jobs", "1")
    with started(*command) as process:
        assert eventually(lambda: verdicts(book))
        done = grader(*command)
        assert done.returncode == 2
        assert (
            done.stderr.splitlines()[-1]
            == f"grader: another `grader batch` writes to {book}: wait until it has ended"
        )
        (book / "marks/kim.csv").write_text(
            f"time,by,student,criterion,points\n,kim,{min(verdicts(book))},total,7\n"
        )
        assert process.wait(HANG_TIMEOUT) == 0
    assert (len(lines_of(book)), len(verdicts(book)), len(lines_of(book, "run"))) == (SIZE, SIZE, 1)
    assert ",7," in (book / "grades.csv").read_text().splitlines()[1]
    assert counted(grader(*command)) == f"0 graded, {SIZE} unchanged"
