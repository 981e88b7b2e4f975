"""Measure the grading of whole classes: `python benchmarks/batch.py`.

Quote the ratios; absolute figures depend on the machine. Classes are generated
(class_generator.py), and all their files differ. Alternatives are timed alternately, A B A B. Name figures to run
only these: `python benchmarks/batch.py speed memory`.
"""

import argparse
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from class_generator import make_class
from run import check_urdf, in_turn, once

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.intake.reading import read_class
from grader.classroom.run.batch import Batch, RunSettings
from grader.classroom.run.pool import Processes, processors
from grader.classroom.run.progress import Progress
from grader.classroom.run.worker import ClassContext, Task, grade_all
from grader.grading.rubric import load_rubric

_TIMEOUT = 60.0  # seconds for one submission
_WARMING = 50  # submissions that each worker grades before the clock starts
_REPEATED = 10_000  # submissions of the largest class that is graded more than once
_SAMPLED = 0.05  # seconds between two measurements of the memory
_MAX_START = 60.0  # seconds in which all workers must start


class Bench(NamedTuple):
    """The folder of the classes, their sizes, and the number of repetitions."""

    top: Path
    sizes: Sequence[int]
    jobs: int
    runs: int

    @property
    def usual(self) -> int:
        """Return the size of the class for figures that need one: about a thousand."""
        return max(size for size in self.sizes if size <= 1_000 or size == min(self.sizes))

    def folder(self, count: int) -> Path:
        """Return a class of this many URDFs, generated on first use."""
        folder = self.top / f"class-{count}"
        if not folder.exists():
            for _ in make_class(folder, count, seed=count):
                pass
        return folder


def main() -> None:
    """Print the requested figures, or all."""
    parser = argparse.ArgumentParser(description="Measure how whole classes are graded.")
    parser.add_argument("figures", nargs="*", metavar="figure", help=f"any of: {', '.join(FIGURES)}; default: all")
    parser.add_argument(
        "--sizes", type=int, nargs="+", default=[100, 1_000, 10_000], help="numbers of submissions in a class"
    )
    parser.add_argument("--all", action="store_true", help="also measure a class of 100,000")
    parser.add_argument("--jobs", type=int, default=processors())
    parser.add_argument("--runs", type=int, default=5)
    given = parser.parse_args()
    unknown = sorted(set(given.figures) - set(FIGURES))
    if unknown:
        parser.error(f"there is no figure {', '.join(unknown)}")
    sizes = sorted({*given.sizes, 100_000} if given.all else set(given.sizes))
    with tempfile.TemporaryDirectory() as top:
        bench = Bench(Path(top), sizes, given.jobs, given.runs)
        for name in given.figures or FIGURES:
            FIGURES[name](bench)


# --- The figures ------------------------------------------------------------------------------------------------------


def speed(bench: Bench) -> None:
    """Measure submissions per second with warm workers, including the gradebook, for every size of a class."""
    with workers(bench, bench.jobs) as executor:
        runs = {size: _fresh(bench, size, bench.jobs, executor) for size in bench.sizes}
        times = in_turn({str(size): run for size, run in runs.items() if size <= _REPEATED}, bench.runs)
        times |= {str(size): [run()] for size, run in runs.items() if size > _REPEATED}
    print(f"\nSubmissions a second, {bench.jobs} warm workers, gradebook included (1 = the smallest class)")
    base = bench.sizes[0] / statistics.median(times[str(bench.sizes[0])])
    for size in bench.sizes:
        rate, best = size / statistics.median(times[str(size)]), size / min(times[str(size)])
        print(f"  {size:>7} submissions  median {rate:9.0f} /s  {rate / base:6.2f} x   best {best:9.0f} /s")


def parallel(bench: Bench) -> None:
    """Measure how much a second worker gains."""
    size = bench.usual
    with workers(bench, 1) as one, workers(bench, 2) as two:
        pools = {1: one, 2: two}
        times = in_turn({str(jobs): _fresh(bench, size, jobs, pool) for jobs, pool in pools.items()}, bench.runs)
    rates = {name: size / statistics.median(values) for name, values in times.items()}
    print(f"\nTwo workers against one, {size} submissions, warm, {processors()} processors")
    for name, rate in rates.items():
        print(f"  {name} worker{'s' if name == '2' else ' '}   median {rate:9.0f} /s")
    print(f"  parallel efficiency, rate(2) / (2 rate(1)): {rates['2'] / (2 * rates['1']):.2f}")


def against_check_urdf(bench: Bench) -> None:
    """Compare grading a class with a shell loop over urdfdom's own check_urdf, which only parses."""
    program = check_urdf()
    if program is None or shutil.which("sh") is None:
        print("\ncheck_urdf is not installed: pip install --editable '.[test]'")
        return
    size, few = bench.usual, min(200, bench.usual)
    folder, environment = bench.folder(few), {**os.environ, "LD_LIBRARY_PATH": str(program.parent.parent / "lib")}
    script = 'for f in "$1"/*.urdf; do "$0" "$f" >/dev/null 2>&1; done'

    def loop(over: Path) -> Callable[[], float]:
        command = ["sh", "-c", script, str(over), str(folder)]
        return lambda: once(lambda: subprocess.run(command, env=environment, check=False)) / few

    installed = Path(sys.executable).with_name("check_urdf")
    with workers(bench, bench.jobs) as executor:
        runs = {"bare program": loop(program)}
        if installed.exists():  # the console script that pip installs
            runs["pip's command"] = loop(installed)
        runs["grader"] = lambda: fresh_run(bench, size, bench.jobs, executor) / size
        times = in_turn(runs, bench.runs)
    print(f"\nA class against `for f in *.urdf; do check_urdf $f; done` ({size} submissions, {few} in the loop)")
    _ratios(times, "bare program")


def again(bench: Bench) -> None:
    """Compare the first run over a class with the second one, when nothing has changed."""
    size = bench.usual
    with workers(bench, bench.jobs) as executor:
        _compare_runs(
            f"First run against second, warm workers, {size} unchanged submissions",
            lambda book: once(lambda: grade_class(bench.folder(size), size, bench.jobs, executor, book)),
            bench,
        )
    if _has_command():
        _compare_runs(
            f"First run against second, whole processes, {size} unchanged submissions",
            lambda book: once(lambda: subprocess.run(_command(bench, size, book), capture_output=True, check=True)),
            bench,
        )


def memory(bench: Bench) -> None:
    """Measure the peak memory of the whole process tree, for the smallest class of a thousand or so and for the largest."""
    if not Path("/proc/self/smaps_rollup").exists() or not _has_command():
        print("\nThe memory of a batch is measured where there is /proc/PID/smaps_rollup, and a command `grader batch`")
        return
    print(f"\nPeak memory of `grader batch`, all its {bench.jobs} workers included (1 = the smaller class)")
    base = 0.0
    for size in dict.fromkeys((bench.usual, bench.sizes[-1])):
        peak = peak_memory(_command(bench, size, bench.top / f"memory-{size}.db"))
        base = base or peak
        print(f"  {size:>7} submissions  {peak / 2**20:8.1f} MiB  {peak / base:6.2f} x")


def pages(bench: Bench) -> None:
    """Compare the pages of a class with its first run, as whole processes, and measure the sizes of the pages.

    Hints are searched before, because `stats` and other reports search the same ones.
    """
    size = bench.usual
    book, folder = bench.top / "pages.db", bench.top / "pages"
    export = [sys.executable, "-m", "grader", "export", "html", "--gradebook", str(book), "--output", str(folder)]
    for command in (_command(bench, size, book), export):
        subprocess.run(command, capture_output=True, check=True)

    def batch() -> float:
        with tempfile.TemporaryDirectory(dir=bench.top) as top:
            return once(
                lambda: subprocess.run(_command(bench, size, Path(top, "g.db")), capture_output=True, check=True)
            )

    def pages() -> float:
        return once(lambda: subprocess.run(export, capture_output=True, check=True))

    times = in_turn({"batch": batch, "export html": pages}, bench.runs)
    print(f"\n`grader export html` against `grader batch`, {size} submissions, {processors()} processors")
    _ratios({name: [value / size for value in values] for name, values in times.items()}, "batch")
    index = (folder / "index.html").stat().st_size
    others = [path.stat().st_size for path in folder.glob("*.html") if path.name != "index.html"]
    print(f"  the class's page {index / 1000:.0f} kB, a student's page {statistics.median(others) / 1000:.0f} kB")


FIGURES: dict[str, Callable[[Bench], None]] = {
    "speed": speed,
    "parallel": parallel,
    "check_urdf": against_check_urdf,
    "again": again,
    "memory": memory,
    "pages": pages,
}


# --- Runs -------------------------------------------------------------------------------------------------------------


@contextmanager
def workers(bench: Bench, jobs: int) -> Iterator[Executor]:
    """Yield workers, each of which has graded a few dozen submissions that are in no class."""
    executor = Processes(jobs, _TIMEOUT)
    folder, rubric = bench.folder(_WARMING), load_rubric("lab6")
    common = ClassContext(str(folder), rubric.data, str(rubric.path))
    tasks = [Task(name, (name,)) for name in names_in(folder)]
    warm: set[int] = set()
    end = time.monotonic() + _MAX_START
    try:
        while len(warm) < jobs and time.monotonic() < end:
            warm |= {future.result() for future in [executor.submit(warmed, common, tasks) for _ in range(2 * jobs)]}
        yield executor
    finally:
        executor.shutdown()


def warmed(common: ClassContext, tasks: Sequence[Task]) -> int:
    """Grade submissions in a worker and return its process id."""
    grade_all(common, tasks)
    return os.getpid()


def fresh_run(bench: Bench, count: int, jobs: int, executor: Executor) -> float:
    """Return the seconds that a class takes into a new gradebook."""
    folder = bench.folder(count)
    with tempfile.TemporaryDirectory(dir=bench.top) as top:
        return once(lambda: grade_class(folder, count, jobs, executor, Path(top, "gradebook.db")))


def _fresh(bench: Bench, count: int, jobs: int, executor: Executor) -> Callable[[], float]:
    return lambda: fresh_run(bench, count, jobs, executor)


def grade_class(folder: Path, count: int, jobs: int, executor: Executor, book: Path) -> Progress:
    """Grade a class into a gradebook; every submission gets a mark or was graded before."""
    root, rubric = str(folder), load_rubric("lab6")
    with Gradebook(book, create=True) as opened:
        progress = Batch(opened, rubric, RunSettings(root, "folders"), executor, jobs).grade(read_class(folder))
    assert (progress.done, progress.errored, progress.unreadable) == (count, 0, 0), progress
    return progress


def names_in(folder: Path) -> list[str]:
    """Return the names in a folder, sorted."""
    with os.scandir(folder) as entries:
        return sorted(entry.name for entry in entries)


def _command(bench: Bench, count: int, book: Path) -> list[str]:
    folder = str(bench.folder(count))
    return [sys.executable, "-m", "grader", "batch", folder, "--gradebook", str(book), "--jobs", str(bench.jobs)]


def _has_command() -> bool:
    return not subprocess.run(
        [sys.executable, "-m", "grader", "batch", "--help"], capture_output=True, check=False
    ).returncode


def _compare_runs(title: str, run: Callable[[Path], float], bench: Bench) -> None:
    """Time pairs of runs into one gradebook each, after a pair that is not measured."""
    times: dict[str, list[float]] = {"first": [], "second": []}
    for number in range(bench.runs + 1):
        with tempfile.TemporaryDirectory(dir=bench.top) as top:
            for values in times.values():
                values.append(run(Path(top, "gradebook.db")))
        if not number:
            times = {name: [] for name in times}
    print(f"\n{title}")
    _ratios(times, "first", "a run")


def _ratios(times: dict[str, list[float]], base: str, what: str = "a submission") -> None:
    """Print medians, and the speed of each relative to the base."""
    middle = statistics.median(times[base])
    for name, values in times.items():
        median = statistics.median(values)
        print(f"  {name:<12} median {median * 1e3:10.3f} ms {what}   {middle / median:6.2f} x as fast as the {base}")


# --- Memory -----------------------------------------------------------------------------------------------------------


def peak_memory(command: list[str]) -> int:
    """Return the peak memory of a process and all below it; a shared page is counted once."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    peak = 0
    while process.poll() is None:
        peak = max(peak, sum(map(_share, _tree(process.pid))))
        time.sleep(_SAMPLED)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return peak


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


if __name__ == "__main__":
    main()
