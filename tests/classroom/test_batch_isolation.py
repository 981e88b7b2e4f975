"""A submission that hangs, crashes or breaks the grader affects only itself, and no process outlives the command."""

import os
import re
import signal
from pathlib import Path

import pytest

from tests.classroom.class_runs import (
    HOSTILE_RUBRIC,
    WITH_HOSTILE,
    counted,
    eventually,
    grader,
    hostile_class,
    newest,
    reasons,
    session_of,
    started,
    urdf_class,
    verdicts,
)
from tests.command_line import HANG_TIMEOUT

GOOD = tuple(f"fine-{number}" for number in range(20))
SLOW = r"grading it took longer than 3 s of processor time \(--timeout raises the limit\)"
WAITED = "grading it did not end within 30 s"
REASONS = {
    # An endless loop is ended by whichever limit it reaches first: the wall clock's where others have the processor.
    "loops": f"{SLOW}|{WAITED}",
    "loops_in_c": f"{SLOW}|{WAITED}",
    "hangs": WAITED,
    "hangs_in_c": WAITED,
    "stops": WAITED,
    "dies": "the process that graded it was ended by signal 9",
    "crashes": "the process that graded it was ended by signal 11",
    "leaves": "the process that graded it exited unexpectedly",
    "leaves_loudly": "the process that graded it ended with exit code 7",
    "exits": "the check behaves of the package hostile-checks is faulty: SystemExit: out",
    "eats": r".*(MemoryError|more memory than a worker has|took longer than 3 s of processor time).*",
    "raises": "the check behaves of the package hostile-checks is faulty: RuntimeError: as asked",
}
# Where a process ends before anybody has heard that it had begun, its task is missed only when its time is over; and memory is
# not eaten up at once everywhere.
ENDED = ("dies", "crashes", "leaves", "leaves_loudly", "eats")
RUBRIC = ("--rubric", HOSTILE_RUBRIC)


@pytest.mark.exhaustive
def test_each_misbehaviour_affects_one_submission(tmp_path: Path) -> None:
    """All of them at once among many others: each is errored with its reason, and only these are tried again."""
    folder = hostile_class(tmp_path / "class", *REASONS, *GOOD)
    book = tmp_path / "lab"
    command = ("batch", folder, "--gradebook", book, *RUBRIC, "--timeout", "3", "--jobs", "4")
    done = grader(*command, **WITH_HOSTILE)
    assert done.returncode == 0, done.stderr
    assert (
        counted(done) == f"{len(REASONS) + len(GOOD)} graded ({len(REASONS)} errored), 0 unchanged"
    )
    assert "Traceback" not in done.stderr
    assert verdicts(book) == {**dict.fromkeys(REASONS, "errored"), **dict.fromkeys(GOOD, "graded")}
    found = reasons(book)
    for key, reason in REASONS.items():
        allowed = f"{reason}|{WAITED}" if key in ENDED else reason
        assert re.fullmatch(allowed, found[key]), (key, found[key])
    assert {sum(entry[0] for entry in newest(book)[key]["results"].values()) for key in GOOD} == {3}

    for name in REASONS:  # as their students submit something else
        (folder / f"{name}.urdf").write_text('<robot name="fine"><link name="a"/></robot>')
    (folder / "dies.urdf").write_text('<robot name="dies"><link name="a"/></robot>')
    assert counted(grader(*command, **WITH_HOSTILE)) == (
        f"{len(REASONS)} graded (1 errored), {len(GOOD)} unchanged"
    )
    assert counted(grader(*command, **WITH_HOSTILE)) == (
        f"1 graded (1 errored), {len(GOOD) + len(REASONS) - 1} unchanged"
    )


@pytest.mark.slow
def test_what_takes_too_long_is_kept(tmp_path: Path) -> None:
    """It is named in each run with the command that tries it again, and tried only if it is asked for or has changed."""
    folder, book = hostile_class(tmp_path / "class", "loops", "fine"), tmp_path / "lab"
    command = ("batch", folder, "--gradebook", book, *RUBRIC, "--jobs", "1", "--timeout")
    slow = "not graded again, because it takes too long: loops"

    def run(*options: str) -> tuple[str, bool]:
        done = grader(*command, *options, **WITH_HOSTILE)
        assert (done.returncode, verdicts(book)["loops"]) == (0, "errored")
        return counted(done), slow in done.stderr

    assert run("1") == ("2 graded (1 errored), 0 unchanged", True)
    kept = newest(book)["loops"]
    assert (kept["timeout"], kept["reason"]) == (1, SLOW.replace("\\", "").replace("3 s", "1 s"))
    assert run("1") == run("0.5") == ("0 graded, 2 unchanged", True)
    assert newest(book)["loops"] == kept
    assert run("2") == ("1 graded (1 errored), 1 unchanged", True)
    assert run("1") == ("0 graded, 2 unchanged", True)
    assert run("1", "--force") == ("2 graded (1 errored), 0 unchanged", True)
    done = grader(*command, "1", **WITH_HOSTILE)
    assert f"`grader batch --gradebook {book} --timeout 2` tries it" in done.stderr
    (folder / "loops.urdf").write_text('<robot name="fine"><link name="a"/></robot>')
    done = grader(*command, "1", **WITH_HOSTILE)
    assert (counted(done), slow in done.stderr) == ("1 graded, 1 unchanged", False)
    assert set(verdicts(book).values()) == {"graded"}


@pytest.mark.exhaustive
def test_a_class_of_misbehaving_submissions_finishes(tmp_path: Path) -> None:
    """Even if every worker is killed again and again, each submission has its reason."""
    names = [f"{name}-{number}" for name in ("dies", "leaves", "crashes") for number in range(8)]
    folder, book = hostile_class(tmp_path / "class", *names), tmp_path / "lab"
    done = grader(
        "batch",
        folder,
        "--gradebook",
        book,
        *RUBRIC,
        "--timeout",
        "6",
        "--jobs",
        "2",
        **WITH_HOSTILE,
    )
    assert (done.returncode, counted(done)) == (0, "24 graded (24 errored), 0 unchanged")
    assert set(verdicts(book)) == set(names)


@pytest.mark.exhaustive
def test_no_process_remains(tmp_path: Path) -> None:
    """When the command has finished, all its processes have ended or are ending."""
    folder = urdf_class(tmp_path / "class", 20)
    with started("batch", folder, "--gradebook", tmp_path / "lab", "--jobs", "3") as process:
        assert process.wait(HANG_TIMEOUT) == 0
        assert eventually(lambda: not session_of(process))


HANGING = ("hangs", "hangs-2", "hangs_in_c", "fine")


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGKILL, -9), (signal.SIGTERM, -15)]
)
def test_no_process_outlives_a_killed_command(
    number: signal.Signals, code: int, tmp_path: Path
) -> None:
    """Not even workers that hang within a submission and never return to the interpreter."""
    folder, book = hostile_class(tmp_path / "class", *HANGING), tmp_path / "lab"
    command = ("batch", folder, "--gradebook", book, *RUBRIC, "--timeout", "3600", "--jobs", "4")
    with started(*command, **WITH_HOSTILE) as process:
        assert eventually(lambda: "fine" in verdicts(book))
        assert eventually(
            lambda: len(session_of(process)) >= 1 + 2 + 4
        )  # two service processes in addition to the workers
        if number is signal.SIGINT:
            os.killpg(process.pid, number)  # as a terminal does
        else:
            process.send_signal(number)
        assert process.wait(HANG_TIMEOUT) == code
        assert eventually(lambda: not session_of(process))
    assert verdicts(book) == {"fine": "graded"}


@pytest.mark.exhaustive
def test_killed_workers_are_replaced(tmp_path: Path) -> None:
    """As when the kernel is short of memory: every submission has a result, and most are graded at once."""
    folder, book = urdf_class(tmp_path / "class", 600), tmp_path / "lab"
    with started("batch", folder, "--gradebook", book, "--jobs", "3") as process:
        for count in (30, 120, 210, 300, 420):
            assert eventually(lambda at=count: len(verdicts(book)) > at)  # type: ignore[misc]
            workers = [pid for pid in session_of(process) if pid > process.pid][2:]
            if workers:
                os.kill(workers[-1], signal.SIGKILL)
        assert process.wait(HANG_TIMEOUT) == 0
    found = list(verdicts(book).values())
    assert len(found) == 600
    assert found.count("errored") <= 5
    done = grader("batch", folder, "--gradebook", book)
    assert done.returncode == 0
    assert set(verdicts(book).values()) == {"graded"}
