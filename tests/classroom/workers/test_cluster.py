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
    environment,
    eventually,
    grader,
    hostile_class,
    lines_of,
    mixed_class,
    reasons,
    repeated,
    started,
    urdf_class,
    verdicts,
    without_hints,
)
from tests.command_line import HANG_TIMEOUT

pytest.importorskip("distributed")

DASK = (sys.executable, "-m", "dask")
JSON = ("--report-format", "json")


@contextmanager
def service(log: Path, *arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """Yield a running Dask program in its own session; all its processes end with it."""
    with log.open("wb") as out:
        process = subprocess.Popen(
            [*DASK, *arguments],
            env=environment(**WITH_HOSTILE),
            stdout=out,
            stderr=out,
            start_new_session=True,
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

    def has_workers(self, count: int) -> bool:
        """Return whether the scheduler has so many workers, without asking them: one that is killed never answers."""
        from distributed import Client

        with Client(self.address, timeout=HANG_TIMEOUT, set_as_default=False) as client:  # type: ignore[no-untyped-call]
            return len(client.scheduler_info()["workers"]) == count

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
    arguments = (
        "--host",
        "127.0.0.1",
        "--port",
        "0",
        "--no-dashboard",
        "--scheduler-file",
        str(cluster.file),
    )
    with service(target / "scheduler.log", "scheduler", *arguments) as process:
        cluster.process = process.pid
        assert eventually(lambda: cluster.file.exists() and cluster.file.read_text().endswith("}"))
        yield cluster


def refused(*arguments: str | Path, **variables: str) -> str:
    """Return the line with which a command is refused, after the one about the class."""
    done = grader(*arguments, **variables)
    assert (done.returncode, done.stdout) == (2, "")
    lines = [line for line in done.stderr.splitlines() if not line.startswith("grader: ignored: ")]
    assert len(lines) == 2, done.stderr
    assert lines[0].endswith("layout folders")
    return lines[1].removeprefix("grader: ")


def without_progress(text: str) -> list[str]:
    """Return lines without those that a run of more than ten seconds writes about its progress."""
    return [line for line in text.splitlines() if not re.search(r"\d of \d+, \d+/s, ", line)]


@pytest.mark.exhaustive
def test_a_cluster_gives_the_same_marks(tmp_path: Path) -> None:
    """Without workers it is refused; with some, reports and stderr equal those of local processes; then nothing is new."""
    folder = mixed_class(tmp_path / "class", 30, for_zip=True)
    folder = Path(shutil.make_archive(str(tmp_path / "packed"), "zip", folder))
    local, remote = tmp_path / "here", tmp_path / "there"
    rubric = ("--rubric", without_hints())  # hints are searched by local processes in both runs
    one = grader(
        "batch", folder, "--gradebook", tmp_path / "local-book", "--reports", local, *JSON, *rubric
    )
    with scheduler(tmp_path) as found:
        command = (
            "batch",
            folder,
            "--gradebook",
            tmp_path / "other-book",
            "--cluster",
            found.address,
            *rubric,
        )
        start = f"`dask worker {found.address}`"
        line = f"the Dask cluster at {found.address} has no workers yet: start one with {start}"
        assert refused(*command) == line
        with found.with_workers(2):
            other = grader(*command, "--reports", remote, *JSON)
            assert (other.returncode, other.stdout.replace("other-book", "local-book")) == (
                0,
                one.stdout,
            )
            assert without_progress(other.stderr) == without_progress(
                one.stderr.replace(str(local), str(remote))
            )
            assert contents(local) == contents(remote)
            assert counted(grader(*command)).startswith("0 graded, ")


@pytest.mark.exhaustive
def test_whatever_happens_to_a_cluster(tmp_path: Path) -> None:
    """Misbehaviour ends no worker, a worker that is killed loses nothing, and neither does Ctrl-C or a lost scheduler."""
    with scheduler(tmp_path) as found, found.with_workers(2, threads=2):
        _misbehaves(found, tmp_path / "misbehaving")
        _loses_workers(found, tmp_path / "killed")
        _is_interrupted(found, tmp_path / "interrupted")
        _is_used_twice(found, tmp_path / "twice")
        _loses_its_scheduler(found, tmp_path / "lost")


def _misbehaves(cluster: DaskCluster, top: Path) -> None:
    """Each affects one submission, for the same reason as locally; the cluster's workers live on and log nothing."""
    names = (
        "hangs",
        "hangs_in_c",
        "dies",
        "crashes",
        "leaves",
        "leaves_loudly",
        "exits",
        "raises",
        "fine",
        "fine-2",
    )
    top.mkdir()
    folder = hostile_class(top / "class", *names)
    before = sorted(cluster.workers())
    logged = len(cluster.log)
    command = ("batch", folder, "--rubric", HOSTILE_RUBRIC, "--timeout", "3")
    for book in ("here", "there"):
        where = ("--cluster", cluster.address) if book == "there" else ()
        done = grader(*command, "--gradebook", top / book, *where, **WITH_HOSTILE)
        assert (done.returncode, counted(done)) == (0, "10 graded (8 errored), 0 unchanged")
    local, remote = (reasons(top / book) for book in ("here", "there"))
    slow = "grading it did not end within 30 s"
    assert set(local) == set(remote) == set(names[:8])
    assert all(local[key] == remote[key] or slow in (local[key], remote[key]) for key in local)
    assert local["hangs"] == remote["hangs"] == slow
    assert sorted(cluster.workers()) == before
    assert "ERROR" not in cluster.log[logged:]


def _loses_workers(cluster: DaskCluster, top: Path) -> None:
    """Its tasks move to the others, and it is restarted: no result is lost or duplicated."""
    folder, book = urdf_class(top / "class", 400), top / "lab6"
    victims, registered = cluster.workers(), cluster.log.count("Registered to:")
    with started("batch", folder, "--gradebook", book, "--cluster", cluster.address) as process:
        for count, victim in zip((40, 160), victims, strict=True):
            assert eventually(lambda at=count: len(verdicts(book)) > at)  # type: ignore[misc]
            os.kill(victim, signal.SIGKILL)
        _, output = process.communicate(timeout=HANG_TIMEOUT)
        assert process.returncode == 0, output
    assert verdicts(book) == dict.fromkeys((path.stem for path in folder.iterdir()), "graded")
    assert repeated(book) == []
    assert eventually(lambda: cluster.log.count("Registered to:") >= registered + len(victims))
    assert eventually(lambda: cluster.has_workers(2))


def _is_interrupted(cluster: DaskCluster, top: Path) -> None:
    """The run ends at once and reports what is kept; the workers are ready for the next run."""
    folder, book = urdf_class(top / "class", 400), top / "lab6"
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


def _is_used_twice(cluster: DaskCluster, top: Path) -> None:
    """Two users may use a cluster at the same time, each with their own timeout."""
    folders = [urdf_class(top / f"class{seed}", 150, seed) for seed in (1, 2)]

    def run(number: int) -> int:
        where = (
            "--gradebook",
            top / f"{number}",
            "--cluster",
            cluster.address,
            "--timeout",
            str(20 + number),
        )
        return grader("batch", folders[number], *where).returncode

    with ThreadPoolExecutor(2) as threads:
        assert list(threads.map(run, range(2))) == [0, 0]
    for number in range(2):
        assert list(verdicts(top / f"{number}").values()) == ["graded"] * 150


def _loses_its_scheduler(cluster: DaskCluster, top: Path) -> None:
    """The run ends with a line, no submission is errored, and the run continues elsewhere."""
    folder, book = urdf_class(top / "class", 500), top / "lab6"
    address = cluster.address
    with started("batch", folder, "--gradebook", book, "--cluster", address) as process:
        assert eventually(lambda: len(verdicts(book)) > 20)
        os.kill(cluster.process, signal.SIGKILL)
        _, output = process.communicate(timeout=HANG_TIMEOUT)
        assert process.returncode == 2, output
    *_, stopped, last = output.splitlines()
    assert stopped.startswith("grader: stopped: ")
    assert last == f"grader: lost the connection to the Dask scheduler at {address}"
    assert set(verdicts(book).values()) == {"graded"}
    assert grader("batch", folder, "--gradebook", book).returncode == 0
    assert (len(verdicts(book)), repeated(book)) == (500, [])


_BLIND = """
import pathlib
exists = pathlib.Path.exists
pathlib.Path.exists = lambda self, **named: self.name != "class" and exists(self, **named)
"""
_UNUSABLE = {
    r"does not see {folder}: share that folder": _BLIND,
    "has grader 0.0.1, and this is ": "import grader\ngrader.__version__ = '0.0.1'\n",
    "cannot grade: ": "import sys\nsys.modules['grader'] = None\n",
}


@pytest.mark.exhaustive
def test_an_unusable_cluster_is_refused(tmp_path: Path) -> None:
    """An address without a scheduler, no Dask here, and a worker without the folder, this grader or any: one line each."""
    folder, book = urdf_class(tmp_path / "class", 2), tmp_path / "lab6"
    command = ("batch", folder, "--gradebook", book, "--cluster")
    for address in ("tcp://127.0.0.1:1", "foo", "", "http://127.0.0.1:1", "tls://127.0.0.1:1"):
        assert refused(*command, address).startswith(
            f"there is no Dask scheduler at {address or repr('')}: "
        )
    (tmp_path / "distributed.py").write_text("raise ImportError('no such module')\n")
    line = refused(*command, "tcp://127.0.0.1:1", PYTHONPATH=str(tmp_path))
    assert line == "--cluster needs Dask: pip install 'urdf-grader[cluster]'"
    (tmp_path / "scheduler").mkdir()
    with scheduler(tmp_path / "scheduler") as idle:
        arguments = (
            "--scheduler-file",
            str(idle.file),
            "--host",
            "127.0.0.1",
            "--no-dashboard",
            "--no-nanny",
        )
        for number, (words, start) in enumerate(_UNUSABLE.items()):
            (tmp_path / "start.py").write_text(start)
            log = tmp_path / f"worker{number}.log"
            with service(log, "worker", *arguments, "--preload", str(tmp_path / "start.py")):
                assert eventually(lambda log=log: "Registered to:" in log.read_text())  # type: ignore[misc]
                assert words.format(folder=folder) in refused(*command, idle.address)
            assert eventually(lambda: idle.has_workers(0))
    assert lines_of(book, "run") == []
