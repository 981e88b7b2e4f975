"""Reading a class in any layout: refused input, ignored files, a zip, a roster, and a very large class."""

import os
import sys
import tempfile
import tracemalloc
import zipfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.layouts.layout import MAX_LINES
from grader.errors import InputError
from tests.classroom.class_folders import assigned, lay_out, pack
from tests.classroom.lab6_class import read_class
from tests.work import limited_work

LARGE = 10_000


def test_the_list_of_ignored_files_is_bounded(tmp_path: Path) -> None:
    """Of very many files that are no submissions the first are listed, the others counted."""
    lay_out(tmp_path, "ann/", *(f"note{index:05}.txt" for index in range(30 * MAX_LINES)))
    lines = read_class(tmp_path).ignored
    assert len(lines) == MAX_LINES + 1
    assert lines[0].startswith("note00000.txt ")
    assert lines[-2].startswith(f"note{MAX_LINES - 1:05}.txt ")
    assert lines[-1] == f"and {29 * MAX_LINES} more"


def test_a_zip_is_listed_in_place(tmp_path: Path) -> None:
    """A zip gives the same as its folder: names that lead out and litter are ignored."""
    names = ["ann/my_robot/urdf/my_robot.urdf", "bea.zip", "__MACOSX/bea.zip", "../cal.zip", "/dan.zip", "notes.txt"]
    intake = read_class(pack(tmp_path / "class.zip", names))
    assert assigned(intake) == {"ann": ("ann",), "bea": ("bea.zip",)}
    assert [line.split()[0] for line in intake.ignored] == ["../cal.zip", "/dan.zip", "notes.txt"]


def test_a_zip_of_too_many_members_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The number of members is bounded."""
    monkeypatch.setattr("grader.files.class_zip._MAX_MEMBERS", 3)
    assert len(read_class(pack(tmp_path / "a.zip", ["a.zip", "b.zip", "c.zip"]))) == 3
    with pytest.raises(InputError, match="contains more than 3 files"):
        read_class(pack(tmp_path / "b.zip", ["a.zip", "b.zip", "c.zip", "d.zip"]))


def test_symlinks_in_a_zip_are_not_followed(tmp_path: Path) -> None:
    """A symlink in a zip is no submission."""
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        link = zipfile.ZipInfo("ann.zip")
        link.create_system, link.external_attr = 3, 0o120777 << 16
        archive.writestr(link, "/etc/passwd")
        archive.writestr("bea.zip", b"")
    intake = read_class(tmp_path / "class.zip")
    assert assigned(intake) == {"bea": ("bea.zip",)}
    assert intake.ignored == ("ann.zip is a symlink in an archive, and was not followed",)


def test_names_that_are_not_utf_8_can_be_opened(tmp_path: Path) -> None:
    """A name of any bytes gets its own printable key, and its path leads to the file."""
    for name in (b"caf\xe9", b"caf\xe8", b"line\nbreak", b"line\\x0abreak"):
        os.mkdir(os.fsencode(tmp_path) + b"/" + name)
    found = assigned(read_class(tmp_path))
    assert len(found) == 4
    assert all(key.isprintable() for key in found)
    assert all((tmp_path / path).is_dir() for (path,) in found.values())


@given(st.lists(st.text(st.characters(codec="utf-8"), min_size=1, max_size=20), max_size=20))
def test_any_names_are_accepted(names: list[str]) -> None:
    """Whatever the members of a zip are called, keys are printable and unique, and every path is in the zip."""
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder, "class.zip")
        with zipfile.ZipFile(target, "w") as archive:
            members = {zipfile.ZipInfo(name).filename or "x" for name in ("ann.zip", "bea.zip", *names)}  # cut at a NUL
            for name in sorted(members - {"package.xml"}):
                archive.writestr(zipfile.ZipInfo(name), b"")
        submissions = list(read_class(target).submissions())
    keys = [submission.student.key for submission in submissions]
    assert keys == sorted(set(keys))
    assert all(key.isprintable() for key in keys)


def test_a_very_large_class_takes_linear_work(tmp_path: Path) -> None:
    """Each submission takes few lines of Python and little more memory than its name."""
    folder = large_class(tmp_path / "class", LARGE)
    with limited_work(500 * LARGE):
        intake = read_class(folder)
        assert sum(1 for _ in intake.submissions()) == LARGE
    folder = large_class(tmp_path / "smaller", LARGE // 10)
    tracemalloc.start()
    try:
        intake = read_class(folder)
        assert sum(1 for _ in intake.submissions()) == LARGE // 10
        assert tracemalloc.get_traced_memory()[1] < 3 * LARGE // 10 * sys.getsizeof("student000000.urdf")
    finally:
        tracemalloc.stop()


def large_class(folder: Path, count: int) -> Path:
    """Make a class of as many URDFs, which are links to a few, because files are slow to make."""
    folder.mkdir()
    for index in range(count):
        name = f"{folder}/student{index:06}.urdf"
        if index % 50_000:  # file systems limit the number of links to one file
            os.link(f"{folder}/student{index // 50_000 * 50_000:06}.urdf", name)
        else:
            Path(name).touch()
    return folder
