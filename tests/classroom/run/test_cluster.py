"""On a Dask cluster a class gets the same marks, whatever happens to its workers; unusable clusters are one line."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.classroom.class_runs import (
    HOSTILE_RUBRIC,
    WITH_HOSTILE,
    contents,
    counted,
    duplicates,
    environment,
    eventually,
    grader,
    hostile_class,
    is_sound,
    mixed_class,
    reasons,
    rows,
    started,
    urdf_class,
    verdicts,
    without_hints,
)
from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT

pytest.importorskip("distributed")

DASK = (sys.executable, "-m", "dask")
JSON = ("--report-format", "json")


@contextmanager
def service(log: Path, *arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """Yield a running Dask program in its own session; all its processes end with it."""
    with log.open("wb") as out:
        process = subprocess.Popen(
            [*DASK, *arguments], env=environment(**WITH_HOSTILE), stdout=out, stderr=out, start_new_session=True
        )
        with process:
            try:
                yield process
            finally:
                process.terminate()
                try:
                    process.wait(10)
                except subprocess.TimeoutExpired:
                    process.kill()


class DaskCluster:
    """A scheduler and its workers."""

    def __init__(self, target: Path) -> None:
        self._folder = target
        self.process = 0

    @property
    def file(self) -> Path:
        """Return the scheduler file."""
        return self._folder / "scheduler.json"

    @property
    def address(self) -> str:
        """Return the scheduler's address."""
        return str(json.loads(self.file.read_text())["address"])

    @property
    def log(self) -> str:
        """Return the output of the workers."""
        return (self._folder / "worker.log").read_text()

    def workers(self) -> list[int]:
        """Return the process ids of the workers that run tasks."""
        from distributed import Client

        with Client(self.address, timeout=HANG_TIMEOUT, set_as_default=False) as client:  # type: ignore[no-untyped-call]
            return list(client.run(os.getpid).values())

    @contextmanager
    def with_workers(self, count: int, threads: int = 1) -> Iterator["DaskCluster"]:
        """Start workers, each with a nanny that restarts it."""
        shape = ("--nworkers", str(count), "--nthreads", str(threads), "--host", "127.0.0.1")
        target = ("--scheduler-file", str(self.file), "--local-directory", str(self._folder))
        with service(self._folder / "worker.log", "worker", *target, *shape, "--no-dashboard"):
            assert eventually(lambda: self.log.count("Registered to:") >= count), self.log
            yield self


@contextmanager
def scheduler(target: Path) -> Iterator[DaskCluster]:
    """Yield a scheduler without workers."""
    cluster = DaskCluster(target)
    arguments = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(cluster.file))
    with service(target / "scheduler.log", "scheduler", *arguments) as process:
        cluster.process = process.pid
        assert eventually(lambda: cluster.file.exists() and cluster.file.read_text().endswith("}"))
        yield cluster


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[DaskCluster]:
    """Yield a scheduler and two workers, one of them for two tasks at once."""
    with scheduler(tmp_path_factory.mktemp("cluster")) as found, found.with_workers(2, threads=2):
        yield found


def refused(*arguments: str | Path, **variables: str) -> str:
    """Return the line with which a command is refused, after the one about the class."""
    done = grader(*arguments, **variables)
    assert (done.returncode, done.stdout) == (2, "")
    lines = done.stderr.splitlines()
    assert len(lines) == 2, done.stderr
    assert lines[0].endswith("layout folders")
    return lines[1].removeprefix("grader: ")


def without_progress(text: str) -> list[str]:
    """Return lines without those that a run of more than ten seconds writes about its progress."""
    return [line for line in text.splitlines() if not re.search(r"\d of \d+, \d+/s, ", line)]


@pytest.mark.parametrize("kind", ["mixed", "samples", "zip"])
def test_a_cluster_gives_the_same_marks(kind: str, cluster: DaskCluster, tmp_path: Path) -> None:
    """The reports equal those of local processes, byte for byte; a second run grades nothing; stderr is the same."""
    if kind == "samples":
        folder = tmp_path / "class"
        for name in sorted(path.name for path in (ROOT / "submissions").iterdir())[::4]:
            shutil.copytree(ROOT / "submissions" / name, folder / name)
    else:
        folder = mixed_class(tmp_path / "class", 100, for_zip=kind == "zip")
    if kind == "zip":
        folder = Path(shutil.make_archive(str(tmp_path / "packed"), "zip", folder))
    local, remote = tmp_path / "here", tmp_path / "there"
    rubric = ("--rubric", without_hints(tmp_path))  # hints are searched by local processes in both runs
    one = grader("batch", folder, "--gradebook", tmp_path / "here.db", "--reports", local, *JSON, *rubric)
    command = ("batch", folder, "--gradebook", tmp_path / "there.db", "--cluster", cluster.address, *rubric)
    other = grader(*command, "--reports", remote, *JSON)
    assert (other.returncode, other.stdout) == (0, one.stdout)
    assert without_progress(other.stderr) == without_progress(one.stderr.replace(str(local), str(remote)))
    assert contents(local) == contents(remote)
    assert counted(grader(*command)).startswith("0 graded, ")


@pytest.mark.slow
def test_misbehaviour_ends_no_worker(cluster: DaskCluster, tmp_path: Path) -> None:
    """Each affects one submission, for the same reason as locally; the cluster's workers live on and log nothing."""
    names = ("hangs", "hangs_in_c", "dies", "crashes", "leaves", "leaves_loudly", "exits", "raises", "fine", "fine-2")
    folder = hostile_class(tmp_path / "class", *names)
    before = sorted(cluster.workers())
    logged = len(cluster.log)
    command = ("batch", folder, "--rubric", HOSTILE_RUBRIC, "--timeout", "4")
    for book in ("here.db", "there.db"):
        where = ("--cluster", cluster.address) if book == "there.db" else ()
        done = grader(*command, "--gradebook", tmp_path / book, *where, **WITH_HOSTILE)
        assert (done.returncode, counted(done)) == (0, "10 graded (8 errored), 0 unchanged")
    local, remote = (reasons(tmp_path / book) for book in ("here.db", "there.db"))
    slow = "grading it took longer than 4 s (--timeout raises the limit)"
    assert set(local) == set(remote) == set(names[:8])
    assert all(local[key] == remote[key] or slow in (local[key], remote[key]) for key in local)
    assert local["hangs"] == remote["hangs"] == slow
    assert sorted(cluster.workers()) == before
    assert "ERROR" not in cluster.log[logged:]


def test_two_batches_at_once(cluster: DaskCluster, tmp_path: Path) -> None:
    """Two users may use a cluster at the same time, each with their own timeout."""
    folders = [urdf_class(tmp_path / f"class{seed}", 150, seed) for seed in (1, 2)]

    def run(number: int) -> int:
        where = ("--gradebook", tmp_path / f"{number}.db", "--cluster", cluster.address, "--timeout", str(20 + number))
        return grader("batch", folders[number], *where).returncode

    with ThreadPoolExecutor(2) as threads:
        assert list(threads.map(run, range(2))) == [0, 0]
    for number in range(2):
        assert list(verdicts(tmp_path / f"{number}.db").values()) == ["graded"] * 150


def test_a_killed_worker(cluster: DaskCluster, tmp_path: Path) -> None:
    """Its tasks move to the others, and it is restarted: no result is lost or duplicated."""
    folder, book = urdf_class(tmp_path / "class", 400), tmp_path / "lab6.db"
    victims = cluster.workers()
    with started("batch", folder, "--gradebook", book, "--cluster", cluster.address) as process:
        for count, victim in zip((40, 160), victims, strict=True):
            assert eventually(lambda at=count: len(verdicts(book)) > at)  # type: ignore[misc]
            os.kill(victim, signal.SIGKILL)
        _, output = process.communicate(timeout=HANG_TIMEOUT)
        assert process.returncode == 0, output
    assert verdicts(book) == dict.fromkeys((path.stem for path in folder.iterdir()), "graded")
    assert (duplicates(book), is_sound(book)) == ([], True)
    assert eventually(lambda: len(cluster.workers()) == 2)


def test_ctrl_c_leaves_the_cluster_alone(cluster: DaskCluster, tmp_path: Path) -> None:
    """The run ends at once and reports what is kept; the workers are ready for the next run."""
    folder, book = urdf_class(tmp_path / "class", 400), tmp_path / "lab6.db"
    command = ("batch", folder, "--gradebook", book, "--cluster", cluster.address)
    with started(*command) as process:
        assert eventually(lambda: len(verdicts(book)) > 20)
        os.killpg(process.pid, signal.SIGINT)
        _, output = process.communicate(timeout=HANG_TIMEOUT)
        assert process.returncode == 130
    first, stopped, last = output.splitlines()
    assert (first, last) == ("grader: 400 submissions, layout folders", "grader: interrupted")
    assert stopped.startswith("grader: stopped: ")
    kept = len(verdicts(book))
    assert counted(grader(*command)) == f"{400 - kept} graded, {kept} unchanged"


@pytest.mark.slow
def test_a_lost_scheduler(tmp_path: Path) -> None:
    """The run ends with a line, no submission is errored, and the run continues elsewhere."""
    folder, book = urdf_class(tmp_path / "class", 500), tmp_path / "lab6.db"
    with scheduler(tmp_path) as found, found.with_workers(1):
        address = found.address
        with started("batch", folder, "--gradebook", book, "--cluster", address) as process:
            assert eventually(lambda: len(verdicts(book)) > 20)
            os.kill(found.process, signal.SIGKILL)
            _, output = process.communicate(timeout=HANG_TIMEOUT)
            assert process.returncode == 2, output
    *_, stopped, last = output.splitlines()
    assert stopped.startswith("grader: stopped: ")
    assert last == f"grader: lost the connection to the Dask scheduler at {address}"
    assert set(verdicts(book).values()) == {"graded"}
    assert grader("batch", folder, "--gradebook", book).returncode == 0
    assert (len(verdicts(book)), duplicates(book)) == (500, [])


@pytest.mark.slow
@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "foo", "", "http://127.0.0.1:1", "tls://127.0.0.1:1"])
def test_no_scheduler(address: str, tmp_path: Path) -> None:
    """An address without a scheduler is refused in one line."""
    folder = urdf_class(tmp_path / "class", 2)
    line = refused("batch", folder, "--gradebook", tmp_path / "lab6.db", "--cluster", address)
    assert line.startswith(f"there is no Dask scheduler at {address or repr('')}: ")


@pytest.fixture(scope="module")
def idle_scheduler(tmp_path_factory: pytest.TempPathFactory) -> Iterator[DaskCluster]:
    """Yield a scheduler without workers, shared by tests."""
    with scheduler(tmp_path_factory.mktemp("idle_scheduler")) as found:
        yield found


def test_no_workers(idle_scheduler: DaskCluster, tmp_path: Path) -> None:
    """A scheduler alone grades nothing; the line says how to start a worker."""
    folder = urdf_class(tmp_path / "class", 2)
    line = refused("batch", folder, "--gradebook", tmp_path / "lab6.db", "--cluster", idle_scheduler.address)
    start = f"`dask worker {idle_scheduler.address}`"
    assert line == f"the Dask cluster at {idle_scheduler.address} has no workers yet: start one with {start}"


_BLIND = """
import pathlib
exists = pathlib.Path.exists
pathlib.Path.exists = lambda self, **named: self.name != "class" and exists(self, **named)
"""
_OTHER = "import grader\ngrader.__version__ = '0.0.1'\n"
_WITHOUT = "import sys\nsys.modules['grader'] = None\n"


@pytest.mark.parametrize(
    ("start", "output"),
    [
        (_BLIND, r"does not see {folder}: share that folder with it"),
        (_OTHER, "has grader 0.0.1, and this is "),
        (_WITHOUT, "cannot grade: "),
    ],
)
def test_a_worker_that_cannot_grade_this_class(
    start: str, output: str, idle_scheduler: DaskCluster, tmp_path: Path
) -> None:
    """A worker that does not see the folder, or has another grader or none, is detected before anything is graded."""
    folder = urdf_class(tmp_path / "class", 2)
    (tmp_path / "start.py").write_text(start)
    arguments = ("--scheduler-file", str(idle_scheduler.file), "--host", "127.0.0.1", "--no-dashboard", "--no-nanny")
    log = tmp_path / "worker.log"
    with service(log, "worker", *arguments, "--preload", str(tmp_path / "start.py")):
        assert eventually(lambda: "Registered to:" in log.read_text())
        line = refused("batch", folder, "--gradebook", tmp_path / "lab6.db", "--cluster", idle_scheduler.address)
    assert eventually(lambda: not idle_scheduler.workers())
    assert output.format(folder=folder) in line
    assert rows(tmp_path / "lab6.db", "SELECT * FROM run") == []


def test_the_extra_is_not_installed(tmp_path: Path) -> None:
    """The line says what to install."""
    folder = urdf_class(tmp_path / "class", 2)
    (tmp_path / "distributed.py").write_text("raise ImportError('no such module')\n")
    line = refused(
        "batch", folder, "--gradebook", tmp_path / "lab6.db", "--cluster", "tcp://127.0.0.1:1", PYTHONPATH=str(tmp_path)
    )
    assert line == "--cluster needs Dask: pip install 'urdf-grader[cluster]'"
