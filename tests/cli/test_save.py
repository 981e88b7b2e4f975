"""grader grade --save: any number of reports from one run, each written completely or not at all."""

import errno
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from grader.report.formats import Format
from grader.report.writing import save
from tests.command_line import HANG_TIMEOUT, run
from tests.report.reports import CLASSROOM50

MISTAKEN = "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"


def test_every_format_can_be_saved_at_once(tmp_path: Path) -> None:
    """Each file equals the output of that format and has its own ending; nothing else is in the folder."""
    names = {kind: f"report.{kind.ending}" for kind in Format}
    assert len(set(names.values())) == len(Format)
    saves = [
        word for kind, name in names.items() for word in ("--save", f"{kind}={tmp_path / name}")
    ]
    done = run(("grade", MISTAKEN, *saves), **CLASSROOM50)
    assert (done.returncode, done.stderr) == (1, b"")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names.values())
    for kind, name in names.items():
        text = re.sub(
            rb"!\[.*\n\n", b"", (tmp_path / name).read_bytes()
        )  # Markdown shows the SVG beside it
        assert text == run(("grade", MISTAKEN, "--format", kind), **CLASSROOM50).stdout


def test_a_file_is_replaced_atomically(tmp_path: Path) -> None:
    """Open handles still read the old file; permissions stay, and a symlink leads to the new one."""
    file, link = tmp_path / "a.txt", tmp_path / "link.txt"
    file.write_text("old")
    file.chmod(0o640)
    link.symlink_to("a.txt")
    with file.open() as old:
        save(link, "new")
        assert old.read() == "old"
    assert link.is_symlink()
    assert (file.read_text(), file.stat().st_mode & 0o777) == ("new", 0o640)


def test_what_a_killed_writer_left_is_removed(tmp_path: Path) -> None:
    """The next writer removes the temporary files of processes that have ended, and no other file."""
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait(HANG_TIMEOUT)
    stray = [f".{'0f' * 8}.tmp", f".{'1f' * 8}-{ended.pid}.tmp", f".{'2f' * 8}-{10**30}.tmp"]
    others = [
        f".{'3f' * 8}-{os.getpid()}.tmp",
        f".{'4f' * 8}-1.tmp",
        ".notes.tmp",
        f"{'5f' * 8}.tmp",
    ]
    for name in (*stray, *others):
        (tmp_path / name).touch()
    save(tmp_path / "plain.md", "text")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(("plain.md", *others))


def test_temporary_names_are_unpredictable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The temporary file has a new random name every time, is never one that is there, and does not stay."""
    names, opened = [], os.open

    def watched(path: Path, flags: int, mode: int) -> int:
        names.append(path.name)
        assert flags & os.O_EXCL
        assert flags & os.O_NOFOLLOW
        return opened(path, flags, mode)

    monkeypatch.setattr(os, "open", watched)
    for _ in range(3):
        save(tmp_path / "plain.md", "text")
    assert len(set(names)) == 3
    assert [path.name for path in tmp_path.iterdir()] == ["plain.md"]


def test_a_file_system_that_cannot_sync(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file is written all the same."""

    def refused(_: int) -> None:
        raise OSError(errno.EINVAL, "Invalid argument")

    monkeypatch.setattr(os, "fsync", refused)
    save(tmp_path / "report", "text")
    assert (tmp_path / "report").read_text() == "text"
