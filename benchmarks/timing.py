"""Time alternatives in turn, A B A B, and check what each of them did."""

import ctypes
import os
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "submissions/lab6/reference" / "roscourse_sim_ws" / "src" / "my_robot"
URDF = PACKAGE / "urdf" / "my_robot.urdf"
_SET_CHILD_SUBREAPER = 36  # of Linux's prctl
_SAMPLED = 0.05  # seconds between two measurements of the memory


class WrongOutputError(Exception):
    """What is timed did not do what it is timed for."""


class Command(NamedTuple):
    """A process to time: it must end with the exit code, and print the word.

    `prepare` is called before each run, and not timed.
    """

    words: Sequence[str | Path]
    code: int = 0
    word: str = ""
    environment: dict[str, str] = {}  # noqa: RUF012  it is never changed
    prepare: Callable[[], object] = bool

    def seconds(self) -> float:
        """Run it, and return its time."""
        self.prepare()
        start = time.perf_counter()
        self.output()
        return time.perf_counter() - start

    def processor_seconds(self) -> float:
        """Run it, and return the processor time of it and of all processes below it."""
        self.prepare()
        _wait_for_orphans()
        start = getrusage(RUSAGE_CHILDREN)
        self.output()
        _wait_for_orphans()
        end = getrusage(RUSAGE_CHILDREN)
        return end.ru_utime + end.ru_stime - start.ru_utime - start.ru_stime

    def output(self) -> str:
        """Run it, and return what it prints."""
        variables = process_environment() | self.environment
        done = subprocess.run(self.words, capture_output=True, env=variables, check=False)
        output = (done.stdout + done.stderr).decode(errors="replace")
        self.check(done.returncode, output)
        return output

    def check(self, code: int, output: str) -> None:
        """Refuse another exit code, and output without the word."""
        if code != self.code or self.word not in output:
            raise WrongOutputError(
                f"{self.words} ended with {code}, expected {self.code} and {self.word!r}:\n{output}"
            )

    def peak_memory(self) -> int:
        """Run it, and return the most bytes that it and all processes below it use; a shared page counts once."""
        with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
            process = subprocess.Popen(
                self.words,
                stdout=output,
                stderr=output,
                env=process_environment() | self.environment,
            )
            peak = 0
            while process.poll() is None:
                peak = max(peak, sum(map(_share, _tree(process.pid))))
                time.sleep(_SAMPLED)
            output.seek(0)
            self.check(process.returncode, output.read())
        return peak


def _wait_for_orphans() -> None:
    """Wait for processes that outlive their parents, as worker processes do, so that their time counts, too."""
    ctypes.CDLL(None).prctl(
        _SET_CHILD_SUBREAPER, 1, 0, 0, 0
    )  # from now on they are children of this process
    with suppress(ChildProcessError):
        while True:
            os.waitpid(-1, 0)


def process_environment() -> dict[str, str]:
    """Return the environment of a process that finds its bytecode ready, as an installed package does."""
    environment = {
        **os.environ,
        "PYTHONPYCACHEPREFIX": str(Path(tempfile.gettempdir()) / "grader-benchmark"),
    }
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    return environment


def in_turn(runs: Mapping[str, Callable[[], float]], rounds: int) -> dict[str, list[float]]:
    """Run all measurements in turn, this many times after a round that is not measured."""
    times: dict[str, list[float]] = {name: [] for name in runs}
    for number in range(rounds + 1):
        for name, run in runs.items():
            seconds = run()
            if number:
                times[name].append(seconds)
    return times


def ratio(above: Sequence[float], below: Sequence[float]) -> float:
    """Return the median of the ratios of each round: a machine whose speed drifts favours neither."""
    return statistics.median(a / b for a, b in zip(above, below, strict=True))


def repeated(run: Callable[[], object], count: int) -> Callable[[], float]:
    """Return a function that runs several times and returns the seconds for each."""

    def batch() -> float:
        start = time.perf_counter()
        for _ in range(count):
            run()
        return (time.perf_counter() - start) / count

    return batch


def _tree(top: int) -> list[int]:
    """Return a process and all below it."""
    below: dict[int, list[int]] = {}
    for target in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = target.read_text(errors="replace").rpartition(")")[2].split()
        except OSError:  # it has ended meanwhile
            continue
        below.setdefault(int(fields[1]), []).append(int(target.parent.name))
    found = [top]
    for process in found:
        found += below.get(process, [])
    return found


def _share(process: int) -> int:
    """Return the memory of a process in bytes: its own, and its part of shared memory (PSS)."""
    try:
        lines = Path(f"/proc/{process}/smaps_rollup").read_text(encoding="ascii").splitlines()
    except OSError:
        return 0
    return next((int(line.split()[1]) * 1024 for line in lines if line.startswith("Pss:")), 0)
