"""A gradebook without write permission can be read, and every message names the permission."""

import ctypes
import os
import shutil
import sqlite3
import sys
import tempfile
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import pytest

from tests.command_line import ROOT, Done, run

pytestmark = pytest.mark.skipif(
    not hasattr(os, "geteuid") or (os.geteuid() == 0 and sys.platform != "linux"), reason="needs POSIX permissions"
)
_CAPABILITY_VERSION = 0x20080522
_IGNORES_PERMISSIONS = 0b111110  # the capabilities of root that concern files: CAP_DAC_OVERRIDE and its neighbours


@pytest.fixture(scope="module")
def graded() -> Iterator[Path]:
    """Return a gradebook in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        top = Path(folder)
        (top / "class/ann").mkdir(parents=True)
        shutil.copy(ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf", top / "class/ann")
        (top / "book").mkdir()
        assert run(("batch", top / "class", "--gradebook", top / "book/lab.db")).returncode == 0
        yield top / "book/lab.db"


@contextmanager
def obeying_permissions() -> Iterator[None]:
    """Let root be bound by permissions like every owner of files."""
    if os.geteuid() != 0:
        yield
        return
    libc, header, sets = ctypes.CDLL(None), (ctypes.c_uint32 * 2)(_CAPABILITY_VERSION, 0), (ctypes.c_uint32 * 6)()
    assert libc.capget(header, sets) == 0
    effective = sets[0]
    sets[0] = effective & ~_IGNORES_PERMISSIONS
    assert libc.capset(header, sets) == 0
    try:
        yield
    finally:
        sets[0] = effective
        assert libc.capset(header, sets) == 0


@contextmanager
def permissions(book: Path, *, folder: int, file: int) -> Iterator[None]:
    """Set the permissions of a gradebook and its folder."""
    book.chmod(file)
    book.parent.chmod(folder)
    try:
        yield
    finally:
        book.parent.chmod(0o755)
        book.chmod(0o644)


def as_reader(book: Path, *arguments: object, folder: int = 0o555, file: int = 0o444) -> Done:
    """Run a command as a user who cannot write the gradebook."""
    with permissions(book, folder=folder, file=file), obeying_permissions():
        return run((*arguments, "--gradebook", book))


@pytest.mark.parametrize(("folder", "file"), [(0o555, 0o444), (0o777, 0o444), (0o555, 0o666)])
@pytest.mark.parametrize("command", [("stats",), ("export", "csv"), ("export", "json")])
def test_it_can_be_read(graded: Path, command: tuple[str, ...], folder: int, file: int) -> None:
    """The output is that of a gradebook with write permission, and no file is left beside it."""
    done = as_reader(graded, *command, folder=folder, file=file)
    assert (done.returncode, done.stdout) == (0, run((*command, "--gradebook", graded)).stdout), done.stderr
    assert [path.name for path in graded.parent.iterdir()] == ["lab.db"]


@pytest.mark.parametrize("command", [("review",), ("review", "--html"), ("mark", "ann", "answer-floating-link", "3")])
def test_nothing_is_saved(graded: Path, command: tuple[str, ...]) -> None:
    """`review` says so at its start, and the message names what to permit."""
    done = as_reader(graded, *command)
    said = " ".join(done.stderr.decode().split())
    assert done.returncode == 2
    assert f"there is no write permission for {graded} and {graded.parent} (`chmod u+w` gives it to the owner)" in said
    assert ("marks cannot be saved" in said) == (command[0] == "review")


def test_batch_names_the_permission(graded: Path) -> None:
    """A file that cannot be written is no other class and no damaged file."""
    done = as_reader(graded, "batch", graded.parent.parent / "class", "--jobs", "1")
    assert done.returncode == 2
    assert b"there is no write permission for" in done.stderr


def test_a_journal_that_cannot_be_read(graded: Path, tmp_path: Path) -> None:
    """Results that are still in the write-ahead log are never ignored: they are read, or the permission is named."""
    with closing(sqlite3.connect(graded)) as writer:
        writer.execute("PRAGMA journal_mode = WAL")
        writer.execute("UPDATE student SET name = 'In the log'")
        writer.commit()
        assert Path(f"{graded}-wal").stat().st_size
        done = as_reader(graded, "export", "csv")
    if done.returncode:
        assert b"there is no write permission for" in done.stderr
    else:
        assert b"In the log" in done.stdout
