"""`grade` and `inspect` end by themselves, whatever a file makes them do: limits of processor time and of memory."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest

import grader.app.commands.inspect_urdf
import grader.app.hints_and_fix
import grader.lab.grading.subjects
import grader.lab.hints.hinting
import grader.workspace.opening.opening
from grader.app.cli import app, ending
from grader.base import processor_time
from grader.base.errors import OutOfTime
from tests.command_line import ROOT, run

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX limits")
URDF = ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf"


def hang(*_: object, **__: object) -> None:
    """Use processor time without end, and take every error for one of the file."""
    while True:
        with suppress(Exception):
            sum(range(1000))


def hang_where_nothing_is_raised(*_: object, **__: object) -> None:
    """Use processor time without end, first in a finalizer, which loses every exception."""

    class _Slow:
        def __del__(self) -> None:
            hang()

    _Slow()
    hang()


def fill_memory(*_: object, **__: object) -> bytes:
    """Ask for more memory than the limit allows."""
    return bytes(2 * ending._MEMORY)


@pytest.mark.parametrize(
    ("what", "said"),
    [
        pytest.param(
            hang, b"this takes more than 1 s of processor time", marks=pytest.mark.exhaustive
        ),
        pytest.param(
            hang_where_nothing_is_raised,
            b"this takes more than 1 s of processor time",
            marks=pytest.mark.exhaustive,
        ),
        (fill_memory, b"this needs more than 512 MiB of memory"),
    ],
)
@pytest.mark.parametrize("command", ["grade", "inspect"])
def test_reading_ends(
    command: str, what: Callable[..., object], said: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One line says which limit it was, and nothing was graded: exit code 2."""
    monkeypatch.setitem(app._LIMITED, command, 60 if what is fill_memory else 1)
    monkeypatch.setattr(ending, "_MEMORY", 512 * 1024**2)
    monkeypatch.setattr(grader.workspace.opening.opening, "read_as_ros", what)
    done = run((command, URDF))
    assert (done.returncode, done.stdout, done.stderr) == (2, b"", b"grader: " + said + b"\n")


@pytest.mark.slow
def test_a_check_that_hangs_is_no_faulty_check(monkeypatch: pytest.MonkeyPatch) -> None:
    """The limit of time ends the command, not only the check."""
    monkeypatch.setitem(app._LIMITED, "grade", 1)
    monkeypatch.setattr(grader.lab.grading.subjects.Subjects, "of", hang)
    done = run(("grade", URDF))
    assert (done.returncode, done.stderr) == (
        2,
        b"grader: this takes more than 1 s of processor time\n",
    )


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        (OutOfTime("of a limit"), "the search for them ran out of time: of a limit"),
        (ZeroDivisionError(), "the grader itself failed (ZeroDivisionError); please report it"),
    ],
)
def test_a_search_for_hints_costs_no_report(
    fault: BaseException, reason: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """If the limit is reached there, or the search fails, the report is printed without hints."""

    def stop(*_: object, **__: object) -> None:
        raise fault

    monkeypatch.setattr(grader.app.hints_and_fix, "hinted", stop)
    wrong = tmp_path / "my_robot.urdf"
    wrong.write_bytes(URDF.read_bytes().replace(b"0.15 0 0.225", b"0.15 0 0.3"))
    done = run(("grade", wrong))
    assert done.returncode == 1
    assert b"lidar" in done.stdout
    assert done.stderr.decode() == f"grader: no hints: {reason}\n"


def test_limits_end_with_the_command() -> None:
    """The process has its own limits again."""
    import resource

    def all_limits() -> list[tuple[int, int]]:
        return [resource.getrlimit(limit) for limit in (resource.RLIMIT_CPU, resource.RLIMIT_AS)]

    before = all_limits()
    assert run(("inspect", URDF)).returncode == 0
    assert all_limits() == before


def test_a_process_that_has_worked_long_is_not_ended_early(monkeypatch: pytest.MonkeyPatch) -> None:
    """The system counts its own ticks for the end, which may be some per cent more than what the process has used."""
    import resource

    ends = []
    monkeypatch.setattr("time.process_time", lambda: 10_000.0)
    monkeypatch.setattr(resource, "setrlimit", lambda _kind, limits: ends.append(limits[0]))
    processor_time.limit_processor_time(1)
    processor_time.lift_processor_time()
    assert ends[0] > 11_000


@pytest.mark.exhaustive
def test_what_ignores_the_limit_is_ended(tmp_path: Path) -> None:
    """Work inside of one call into C, which no exception can interrupt, ends with the process."""
    program = tmp_path / "stuck.py"
    program.write_text(
        "from grader.app.cli import ending\n"
        "from grader.base import processor_time\n"
        "processor_time._GRACE = 1\n"
        "with ending.outer_limits(1):\n"
        "    sum(range(10**12))\n"
    )
    done = subprocess.run(
        [sys.executable, program],
        check=False,
        capture_output=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert done.returncode == -signal.SIGXCPU


@pytest.mark.exhaustive
@pytest.mark.parametrize("limit", ["-St 2", "-t 2"])
def test_a_lower_limit_of_the_shell_is_named(limit: str, tmp_path: Path) -> None:
    """The process says which limit it was, before the system ends it."""
    program = tmp_path / "hang.py"
    program.write_text(
        "import sys\n"
        "import grader.workspace.opening.opening as opening\n"
        "from grader.app.cli.app import run\n"
        "from tests.cli.test_outer_limits import hang\n"
        "opening.read_as_ros = hang\n"
        "sys.exit(run(sys.argv[1:]))\n"
    )
    done = subprocess.run(
        ["sh", "-c", f'ulimit {limit}; exec "$@"', "sh", sys.executable, program, "grade", URDF],
        check=False,
        capture_output=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    said = b"this takes more than the 2 s of processor time that `ulimit -t` allows"
    assert (done.returncode, done.stdout, done.stderr) == (2, b"", b"grader: " + said + b"\n")
