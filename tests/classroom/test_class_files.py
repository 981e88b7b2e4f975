"""Opening a submission of a class: its digest, and what is refused."""

import errno
import io
import os
import shutil
import zipfile
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from unittest.mock import patch

import pytest

from grader.base.errors import InputError, MachineError
from grader.classroom.intake.class_files import open_class_submission
from grader.files import reading
from grader.files.folder import read_folder
from grader.files.opening import outer_tree
from grader.files.reading import URDF_LIMIT
from tests.classroom.class_runs import Item, tarred
from tests.documents.files import docx
from tests.samples import LAB6

URDF = b"<robot name='a'><link name='b'/></robot>"


def digest(top: Path, *paths: str, names: tuple[str, ...] = (), key: str = "ann") -> str:
    """Return the digest of a submission."""
    return open_class_submission(str(top), paths, names, key).digest


def package(top: Path) -> Path:
    """Make a submission that is a folder."""
    folder = top / "ann"
    (folder / "urdf").mkdir(parents=True)
    (folder / "urdf/my_robot.urdf").write_bytes(URDF)
    (folder / "notes.txt").write_text("notes")
    (folder / "link.txt").symlink_to("notes.txt")
    return folder


CHANGES: dict[str, Callable[[Path], object]] = {
    "byte": lambda folder: (folder / "urdf/my_robot.urdf").write_bytes(
        URDF.replace(b"'b'", b"'c'")
    ),
    "name": lambda folder: (folder / "notes.txt").rename(folder / "notes.md"),
    "moved": lambda folder: (folder / "urdf/my_robot.urdf").rename(folder / "my_robot.urdf"),
    "more": lambda folder: (folder / "more.txt").touch(),
    "less": lambda folder: (folder / "link.txt").unlink(),
    "empty folder": lambda folder: (folder / "empty").mkdir(),
    "link out": lambda folder: (folder / "out").symlink_to("/etc"),
    "link to nowhere": lambda folder: (folder / "out").symlink_to("nowhere"),
    "build": lambda folder: (folder / "build").mkdir(),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_any_change_is_detected(change: Callable[[Path], object], tmp_path: Path) -> None:
    """A change shows in the digest of a folder; place and age do not."""
    folder = package(tmp_path)
    before = digest(tmp_path, "ann")
    shutil.copytree(folder, tmp_path / "other/ann", symlinks=True)
    os.utime(tmp_path / "other/ann/notes.txt", (1, 1))
    assert digest(tmp_path / "other", "ann") == before
    change(folder)
    assert digest(tmp_path, "ann") != before


@pytest.mark.parametrize("name", ["ann.urdf", "ann.zip", "ann"])
def test_the_name_is_in_the_digest(name: str, tmp_path: Path) -> None:
    """The digest covers the name, because the report contains it."""
    if name == "ann":
        package(tmp_path)
    else:
        (tmp_path / name).write_bytes(_zip({"a.urdf": URDF}) if name.endswith(".zip") else URDF)
    before, renamed = digest(tmp_path, name), name.replace("ann", "bea")
    (tmp_path / name).rename(tmp_path / renamed)
    assert digest(tmp_path, renamed) != before


def test_several_files_are_one_submission(tmp_path: Path) -> None:
    """They are read as one folder under the student's names for them; names and student are in the digest."""
    for name in ("ann_1_my_robot.urdf", "ann_2_notes.txt"):
        (tmp_path / name).write_bytes(URDF)
    paths = ("ann_1_my_robot.urdf", "ann_2_notes.txt")
    opened = open_class_submission(str(tmp_path), paths, ("my_robot.urdf", "notes.txt"), "ann")
    assert opened.tree is not None
    assert set(opened.tree.files) == {"my_robot.urdf", "notes.txt"}
    submission = opened.submission(LAB6)
    assert (submission.id, submission.path) == ("ann", "my_robot.urdf")
    unnamed = open_class_submission(str(tmp_path), paths, (), "ann")
    assert unnamed.tree is not None
    assert set(unnamed.tree.files) == set(paths)
    digests = {
        opened.digest,
        unnamed.digest,
        digest(tmp_path, *paths, names=("my_robot.urdf", "other.txt")),
        digest(tmp_path, *paths, names=("my_robot.urdf", "notes.txt"), key="bea"),
    }
    assert len(digests) == 4


@pytest.mark.parametrize("opens_in_folders", [True, False])
@pytest.mark.parametrize("swapped", ["ann", "ann/urdf", "ann/urdf/my_robot.urdf"])
def test_a_symlink_that_replaces_a_file_is_not_followed(
    swapped: str, opens_in_folders: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a file is found, another student's file cannot be put in its place, with or without openat."""
    monkeypatch.setattr(
        reading, "_OPENS_IN_FOLDERS", opens_in_folders and reading._OPENS_IN_FOLDERS
    )
    for name, text in (("ann", URDF), ("bob", b"secret")):
        (tmp_path / name / "urdf").mkdir(parents=True)
        (tmp_path / name / "urdf/my_robot.urdf").write_bytes(text)
    trees = [outer_tree(tmp_path / "ann", str(tmp_path)), read_folder(tmp_path / "ann")]
    found = [tree.files["urdf/my_robot.urdf"] for tree in trees if tree is not None]
    assert [file.size for file in found] == [len(URDF), len(URDF)]
    place = tmp_path / swapped
    place.rename(tmp_path / "away")
    place.symlink_to(tmp_path / swapped.replace("ann", "bob", 1))
    for file in found[
        : 1 if swapped == "ann" else 2
    ]:  # a folder that is named on the command line is trusted
        with pytest.raises(
            InputError, match=r"urdf/my_robot\.urdf is a symlink, and was not followed"
        ):
            file.read(1000)
    with (
        pytest.raises(InputError, match="is a symlink, and was not followed")
        if swapped == "ann"
        else nullcontext()
    ):
        outer_tree(tmp_path / "ann", str(tmp_path))


def test_nothing_outside_of_the_class_is_opened(tmp_path: Path) -> None:
    """A path that leads elsewhere is refused before it is opened."""
    with pytest.raises(InputError, match="it is outside of the submission"):
        reading.read_start("/etc/passwd", 10, "x", str(tmp_path))


def test_a_fault_of_the_machine_is_none_of_the_submission(tmp_path: Path) -> None:
    """A folder that cannot be looked at says so, and has not changed."""
    package(tmp_path)
    with (
        patch.object(Path, "is_dir", side_effect=OSError(errno.EIO, "why")),
        pytest.raises(MachineError, match="why"),
    ):
        digest(tmp_path, "ann")
    with (
        patch.object(Path, "is_dir", side_effect=[True, OSError(errno.EIO, "why")]),
        pytest.raises(MachineError),
    ):
        digest(tmp_path, "ann")


@pytest.mark.parametrize("name", ["ann.pdf", "ann.docx", "ann.md", "ann.txt", "ann.png"])
def test_a_single_document_is_a_submission(name: str, tmp_path: Path) -> None:
    """Its file is the only one of the tree, in a folder and in a zip; a Word file is no archive."""
    data = docx("Task 1: Step 15") if name.endswith("docx") else b"text"
    opened = [
        open_class_submission(str(top), (name,), (), "ann") for top in _both(tmp_path, {name: data})
    ]
    assert opened[0].digest == opened[1].digest
    for submission in opened:
        assert submission.tree is not None
        assert [*submission.tree.files] == [name]


def test_a_replaced_zip_is_read_again(tmp_path: Path) -> None:
    """A zip stays open between submissions but is reopened when it was replaced."""
    place = tmp_path / "class.zip"
    seen = []
    for name in ("one", "other"):
        place.unlink(missing_ok=True)
        with zipfile.ZipFile(place, "w") as archive:
            archive.writestr("ann.urdf", URDF.replace(b"'a'", f"'{name}'".encode()))
        seen.append(open_class_submission(str(place), ("ann.urdf",), (), "ann").data)
    assert [b"one" in seen[0], b"other" in seen[1]] == [True, True]  # type: ignore[operator]


# --- A class as a folder and as one zip -------------------------------------------------------------------------------


def _zip(files: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return buffer.getvalue()


def _both(top: Path, files: dict[str, bytes], *, entries: bool = False) -> tuple[Path, Path]:
    """Return a class as a folder and as a zip, with or without `entries` for its folders."""
    folder, packed = top / "class", top / "class.zip"
    for name, data in files.items():
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(data)
    with zipfile.ZipFile(packed, "w") as archive:
        for path in sorted(folder.rglob("*")):
            if entries or path.is_file():
                archive.write(path, path.relative_to(folder))
    return folder, packed


ROBOT = {"my_robot/urdf/my_robot.urdf": URDF, "my_robot/notes.txt": b"notes"}
BUILT = {
    "build/my_robot/my_robot.urdf": URDF,
    "log/a.txt": b"",
    "__pycache__/a.pyc": b"",
    ".git/config": b"",
}


@pytest.mark.parametrize("entries", [False, True])
@pytest.mark.parametrize(
    "files",
    [
        {"ann.urdf": URDF},
        {"ann.URDF.xacro": URDF},
        {"ann b.é.zip": _zip(ROBOT)},
        {"ann.tar.gz": tarred([Item("my_robot/a.urdf", URDF)])},
        {"ann.dat": _zip(ROBOT)},
        {f"ann/{name}": data for name, data in {**ROBOT, **BUILT, "lab6.zip": _zip(ROBOT)}.items()},
    ],
    ids=["urdf", "xacro", "zip", "tar", "unnamed-zip", "folder"],
)
def test_a_zip_has_the_digests_of_its_folder(
    files: dict[str, bytes], entries: bool, tmp_path: Path
) -> None:
    """A folder and its zip have the same digests, so that nothing is graded again if one replaces the other."""
    name = next(iter(files)).partition("/")[0]
    folder, packed = _both(tmp_path, files, entries=entries)
    assert digest(folder, name) == digest(packed, name)


def test_several_files_in_a_zip_equal_those_in_a_folder(tmp_path: Path) -> None:
    """Digests and files are the same: build folders and hidden files are ignored in both."""
    files = {"1": URDF, "2": b"notes", "3": URDF, "4": b"hidden"}
    names = ("my_robot.urdf", "onlinetext/notes.html", "build/my_robot.urdf", ".hidden")
    opened = [
        open_class_submission(str(top), tuple(files), names, "ann")
        for top in _both(tmp_path, files)
    ]
    assert opened[0].digest == opened[1].digest
    for submission in opened:
        assert submission.tree is not None
        assert set(submission.tree.files) == {"my_robot.urdf", "onlinetext/notes.html"}
        assert submission.tree.generated == ("build/my_robot.urdf",)
        assert submission.tree.unseen == {"build"}


@pytest.mark.parametrize("name", ["ann.csv", "ann.xml", "ann.zip", "ann.7z"])
def test_what_is_refused_in_a_folder_is_refused_in_a_zip(name: str, tmp_path: Path) -> None:
    """The message is the same, with paths relative to the class."""
    output = set()
    for top in _both(
        tmp_path, {f"lab/{name}": b"7z\xbc\xaf\x27\x1c" if name.endswith("7z") else b"text"}
    ):
        with pytest.raises(InputError) as caught:
            open_class_submission(str(top), (f"lab/{name}",), (), "ann")
        output.add(str(caught.value).replace(f"{top}/", ""))
    assert len(output) == 1
    assert name != "ann.csv" or output == {
        "ann.csv is neither a URDF nor a folder, an archive or a document"
    }


def test_a_large_document_and_its_name(tmp_path: Path) -> None:
    """A PDF above the limit for a URDF is opened, also in a zip; its name, not the student's, is in the digest."""
    data = b"%PDF-1.4\n" + bytes(URDF_LIMIT)
    tops = _both(tmp_path, {"report.pdf": data})
    digests = {
        open_class_submission(str(top), ("report.pdf",), (), key).digest
        for top in tops
        for key in ("a", "b")
    }
    assert len(digests) == 1


def test_what_is_no_document(tmp_path: Path) -> None:
    """A URDF with the ending .txt, a folder with that of a document; a symlink is refused."""
    (tmp_path / "ann.txt").write_bytes(URDF)
    (tmp_path / "ben.pdf").mkdir()
    (tmp_path / "ben.pdf" / "robot.urdf").write_bytes(URDF)
    (tmp_path / "cleo.pdf").symlink_to(tmp_path / "ann.txt")
    assert open_class_submission(str(tmp_path), ("ann.txt",), (), "ann").data == URDF
    opened = open_class_submission(str(tmp_path), ("ben.pdf",), (), "ben")
    assert opened.tree is not None and [*opened.tree.files] == ["robot.urdf"]
    with pytest.raises(InputError, match="symlink"):
        open_class_submission(str(tmp_path), ("cleo.pdf",), (), "cleo")
