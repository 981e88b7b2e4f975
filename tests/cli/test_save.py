"""grader grade --save: as many reports as are wanted from one run, each whole or not there at all."""

import os
import subprocess
from pathlib import Path

import pytest

from grader.cli.formats import Format
from tests.golden.cases import CLASSROOM50, run

MISTAKEN = "submissions/several-mistakes/my_robot.urdf"


def saved(*texts: str) -> subprocess.CompletedProcess[bytes]:
    """Grade the sample and save it so."""
    return run(("grade", MISTAKEN, *(part for text in texts for part in ("--save", text))), **CLASSROOM50)


def test_every_format_can_be_saved_at_once(tmp_path: Path) -> None:
    """Each file is what that format prints, under an ending of its own; nothing else is left in the folder."""
    names = {kind: f"report.{kind.ending}" for kind in Format}
    assert len(set(names.values())) == len(Format)
    done = saved(*(f"{kind}={tmp_path / name}" for kind, name in names.items()))
    assert (done.returncode, done.stderr) == (1, b"")
    assert sorted(each.name for each in tmp_path.iterdir()) == sorted(names.values())
    for kind, name in names.items():
        assert (tmp_path / name).read_bytes() == run(("grade", MISTAKEN, "--format", kind), **CLASSROOM50).stdout


@pytest.mark.parametrize("other", ["{0}/a", "{0}/./a", "{0}/b/../a", "{0}/link"])
@pytest.mark.parametrize("kind", ["json", "junit"])
def test_one_file_holds_one_report(tmp_path: Path, kind: str, other: str) -> None:
    """Two for the same file are refused, however it is called, and nothing is written."""
    (tmp_path / "b").mkdir()
    (tmp_path / "link").symlink_to("a")
    done = saved(f"json={tmp_path}/a", f"{kind}={other.format(tmp_path)}")
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"one file cannot hold two reports" in done.stderr
    assert not (tmp_path / "a").exists()


@pytest.mark.parametrize("text", ["html=a", "json", "json=", "json=-", "=a", "JSON=a", " json=a", "json:a", ""])
def test_what_is_no_format_and_file_is_refused(text: str) -> None:
    """One line names the formats."""
    done = saved(text)
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"--save takes FORMAT=FILE with one of the formats terminal, markdown, json, junit" in done.stderr
    assert done.stderr.count(b"\n") == 1


@pytest.mark.parametrize("place", ["nowhere/a", "folder", "file/a"])
def test_a_place_that_cannot_be_written(tmp_path: Path, place: str) -> None:
    """Nothing is printed, the line says where and why, and no temporary file is left."""
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    before = sorted(tmp_path.rglob("*"))
    done = saved(f"json={tmp_path / place}")
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.startswith(f"grader: cannot write {tmp_path / place}: ".encode())
    assert done.stderr.count(b"\n") == 1
    assert sorted(tmp_path.rglob("*")) == before


def test_a_file_is_replaced_as_a_whole(tmp_path: Path) -> None:
    """Who has it open still reads the old one; its permissions stay, and a link to it leads to the new one."""
    file, link = tmp_path / "a.json", tmp_path / "link.json"
    file.write_text("old")
    file.chmod(0o640)
    link.symlink_to("a.json")
    with file.open() as old:
        assert saved(f"json={link}").returncode == 1
        assert old.read() == "old"
    assert link.is_symlink()
    assert file.read_bytes() == run(("grade", MISTAKEN, "--format", "json")).stdout
    assert file.stat().st_mode & 0o777 == 0o640


def test_a_device_is_written_to(tmp_path: Path) -> None:
    """What is no regular file is not replaced, and what cannot take the report is told."""
    assert saved("json=/dev/null").returncode == 1
    assert not os.path.isfile("/dev/null")
    done = saved("json=/dev/full")
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"cannot write /dev/full: No space left on device" in done.stderr
