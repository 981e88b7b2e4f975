"""Opening a submission of a class: its digest and fingerprint, and what is refused."""

import io
import os
import shutil
import time
import zipfile
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.gradebook.submission_files import SubmissionFiles, SubmissionSources
from grader.classroom.intake.fingerprint import fingerprint
from grader.classroom.opening import is_zip, open_class_submission
from grader.errors import InputError
from grader.files import reading
from grader.files.folder import read_folder
from grader.files.opening import outer_tree
from grader.files.reading import URDF_LIMIT
from tests.classroom.class_runs import Item, tarred
from tests.documents.files import docx
from tests.samples import LAB6, ROOT

URDF = b"<robot name='a'><link name='b'/></robot>"


def later() -> int:
    """Return a time at which a recent change has settled."""
    return time.time_ns() + 10**9


def digest(top: Path, *paths: str, names: tuple[str, ...] = (), key: str = "ann") -> str:
    """Return the digest of a submission."""
    return open_class_submission(str(top), paths, names, key).digest


def mark(top: Path, *paths: str) -> str:
    """Return the fingerprint of a submission after it has settled."""
    return fingerprint(str(top), paths, later())


def package(top: Path) -> Path:
    """Make a submission that is a folder."""
    folder = top / "ann"
    (folder / "urdf").mkdir(parents=True)
    (folder / "urdf/my_robot.urdf").write_bytes(URDF)
    (folder / "notes.txt").write_text("notes")
    (folder / "link.txt").symlink_to("notes.txt")
    return folder


def _byte(folder: Path) -> None:
    (folder / "urdf/my_robot.urdf").write_bytes(URDF.replace(b"'b'", b"'c'"))


def _name(folder: Path) -> None:
    (folder / "notes.txt").rename(folder / "notes.md")


def _moved(folder: Path) -> None:
    (folder / "urdf/my_robot.urdf").rename(folder / "my_robot.urdf")


def _more(folder: Path) -> None:
    (folder / "more.txt").touch()


def _less(folder: Path) -> None:
    (folder / "link.txt").unlink()


def _empty_folder(folder: Path) -> None:
    (folder / "empty").mkdir()


def _other_target(folder: Path) -> None:
    (folder / "link.txt").unlink()
    (folder / "link.txt").symlink_to("urdf/my_robot.urdf")


def _link_out(folder: Path) -> None:
    (folder / "out").symlink_to("/etc")


def _link_nowhere(folder: Path) -> None:
    (folder / "out").symlink_to("nowhere")


def _built(folder: Path) -> None:
    (folder / "build").mkdir()


CHANGES = [_byte, _name, _moved, _more, _less, _empty_folder, _other_target, _link_out, _link_nowhere, _built]


@pytest.mark.parametrize("change", CHANGES)
def test_any_change_is_detected(change: Callable[[Path], None], tmp_path: Path) -> None:
    """Changes show in the digest of a folder and in its fingerprint."""
    folder = package(tmp_path)
    before = digest(tmp_path, "ann"), mark(tmp_path, "ann")
    change(folder)
    after = digest(tmp_path, "ann"), mark(tmp_path, "ann")
    assert before[0] != after[0]
    assert before[1] != after[1]


def test_a_copy_has_the_same_digest(tmp_path: Path) -> None:
    """The digest does not depend on path and age; the fingerprint does."""
    for place in ("one", "other"):
        (tmp_path / place).mkdir()
    package(tmp_path / "one")
    shutil.copytree(tmp_path / "one/ann", tmp_path / "other/ann", symlinks=True)
    for path in (tmp_path / "other").rglob("*.txt"):
        os.utime(path, (1, 1), follow_symlinks=False)
    assert digest(tmp_path / "one", "ann") == digest(tmp_path / "other", "ann")
    assert mark(tmp_path / "one", "ann") != mark(tmp_path / "other", "ann")


@pytest.mark.parametrize("name", ["ann.urdf", "ann.zip", "ann"])
def test_the_name_is_in_the_digest(name: str, tmp_path: Path) -> None:
    """The digest covers the name, because the report contains it."""
    if name.endswith(".zip"):
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            archive.writestr("a.urdf", URDF)
    elif name == "ann":
        package(tmp_path)
    else:
        (tmp_path / name).write_bytes(URDF)
    before = digest(tmp_path, name)
    renamed = name.replace("ann", "bea")
    (tmp_path / name).rename(tmp_path / renamed)
    assert digest(tmp_path, renamed) != before


@given(st.binary(max_size=200), st.binary(max_size=200))
def test_digests_are_equal_for_equal_bytes_only(one: bytes, other: bytes) -> None:
    """Different bytes give different digests."""
    import tempfile

    with tempfile.TemporaryDirectory() as place:
        digests = []
        for number, data in enumerate((one, other)):
            top = Path(place, str(number))
            top.mkdir()
            (top / "ann.urdf").write_bytes(data)
            digests.append(digest(top, "ann.urdf"))
    assert (digests[0] == digests[1]) == (one == other)


def test_a_fingerprint_depends_on_times(tmp_path: Path) -> None:
    """The same size, bytes and modification time are not enough: the inode's change time counts."""
    place = tmp_path / "ann.urdf"
    place.write_bytes(URDF)
    (tmp_path / "dan").mkdir()
    (tmp_path / "dan/a.urdf").write_bytes(URDF)
    before = [mark(tmp_path, name) for name in ("ann.urdf", "dan")]
    assert before == [mark(tmp_path, name) for name in ("ann.urdf", "dan")]
    assert all(before)
    for path in (place, tmp_path / "dan/a.urdf"):
        status = path.stat()
        path.write_bytes(URDF.replace(b"'b'", b"'c'"))
        os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
    for name, was in zip(("ann.urdf", "dan"), before, strict=True):
        assert mark(tmp_path, name) != was


@pytest.mark.parametrize("kind", ["file", "folder", "several", "zip"])
def test_no_fingerprint_just_after_a_change(kind: str, tmp_path: Path) -> None:
    """A file system may not distinguish two changes within a moment, so there is no fingerprint."""
    top = tmp_path / "class"
    paths: tuple[str, ...] = ("ann.urdf",)
    top.mkdir()
    if kind == "folder":
        package(top)
        paths = ("ann",)
    else:
        (top / "ann.urdf").write_bytes(URDF)
        (top / "bea.urdf").write_bytes(URDF)
    if kind == "several":
        paths = ("ann.urdf", "bea.urdf")
    if kind == "zip":
        top = Path(shutil.make_archive(str(tmp_path / "packed"), "zip", top))
    now = max(path.lstat().st_ctime_ns for path in (top, *top.rglob("*")))  # not the clock: this process may be held up
    assert fingerprint(str(top), paths, now) == ""
    assert fingerprint(str(top), paths, now + 10**9) != ""
    assert fingerprint(str(top), ("missing",), now + 10**9) == "" or kind == "zip"
    assert fingerprint(str(tmp_path / "missing"), paths, now + 10**9) == ""


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


def test_symlinks_among_several_files_are_refused(tmp_path: Path) -> None:
    """A symlink that leads out of the class or to another student's file is refused."""
    (tmp_path / "a.urdf").write_bytes(URDF)
    for target in ("/etc/passwd", "a.urdf"):
        (tmp_path / "b.txt").unlink(missing_ok=True)
        (tmp_path / "b.txt").symlink_to(target)
        with pytest.raises(InputError, match=r"b\.txt is a symlink, and was not followed"):
            open_class_submission(str(tmp_path), ("a.urdf", "b.txt"), (), "ann")


@pytest.mark.parametrize("opens_in_folders", [True, False])
@pytest.mark.parametrize("swapped", ["ann", "ann/urdf", "ann/urdf/my_robot.urdf"])
def test_a_symlink_that_replaces_a_file_is_not_followed(
    swapped: str, opens_in_folders: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a file is found, another student's file cannot be put in its place, with or without openat."""
    monkeypatch.setattr(reading, "_OPENS_IN_FOLDERS", opens_in_folders and reading._OPENS_IN_FOLDERS)
    for name, text in (("ann", URDF), ("bob", b"secret")):
        (tmp_path / name / "urdf").mkdir(parents=True)
        (tmp_path / name / "urdf/my_robot.urdf").write_bytes(text)
    trees = [outer_tree(tmp_path / "ann", str(tmp_path)), read_folder(tmp_path / "ann")]
    found = [tree.files["urdf/my_robot.urdf"] for tree in trees if tree is not None]
    assert [file.size for file in found] == [len(URDF), len(URDF)]
    place = tmp_path / swapped
    place.rename(tmp_path / "away")
    place.symlink_to(tmp_path / swapped.replace("ann", "bob", 1))
    for file in found[: 1 if swapped == "ann" else 2]:  # a folder that is named on the command line is trusted
        with pytest.raises(InputError, match=r"urdf/my_robot\.urdf is a symlink, and was not followed"):
            file.read(1000)
    with pytest.raises(InputError, match="is a symlink, and was not followed") if swapped == "ann" else nullcontext():
        outer_tree(tmp_path / "ann", str(tmp_path))


def test_nothing_outside_of_the_class_is_opened(tmp_path: Path) -> None:
    """A path that leads elsewhere is refused before it is opened."""
    with pytest.raises(InputError, match="it is outside of the submission"):
        reading.read_start("/etc/passwd", 10, "x", str(tmp_path))


def _fifo(top: Path) -> None:
    os.mkfifo(top / "ann.urdf")


def _missing(top: Path) -> None:
    pass


def _large(top: Path) -> None:
    (top / "ann.urdf").write_bytes(b" " * (1024 * 1024 + 1))


def _circle(top: Path) -> None:
    (top / "ann.urdf").symlink_to("ann.urdf")


@pytest.mark.parametrize("make", [_fifo, _missing, _large, _circle])
def test_unreadable_submissions_are_one_line(make: Callable[[Path], None], tmp_path: Path) -> None:
    """They raise an InputError, in a class as alone."""
    make(tmp_path)
    with pytest.raises(InputError) as caught:
        open_class_submission(str(tmp_path), ("ann.urdf",), (), "ann")
    assert "\n" not in str(caught.value)


def test_neither_a_urdf_nor_a_folder_or_archive(tmp_path: Path) -> None:
    """A file of another kind is refused."""
    (tmp_path / "ann.csv").write_text("text")
    with pytest.raises(InputError, match=r"ann\.csv is neither a URDF nor a folder, an archive or a document"):
        open_class_submission(str(tmp_path), ("ann.csv",), (), "ann")


@pytest.mark.parametrize("name", ["ann.pdf", "ann.docx", "ann.md", "ann.txt", "ann.png"])
def test_a_single_document_is_a_submission(name: str, tmp_path: Path) -> None:
    """Its file is the only one of the tree, in a folder and in a zip; a Word file is no archive."""
    data = docx("Task 1: Step 15") if name.endswith("docx") else b"text"
    opened = [open_class_submission(str(top), (name,), (), "ann") for top in _both(tmp_path, {name: data})]
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
        assert is_zip(str(place))
        seen.append(open_class_submission(str(place), ("ann.urdf",), (), "ann").data)
    assert [b"one" in seen[0], b"other" in seen[1]] == [True, True]  # type: ignore[operator]


def test_lines_are_quoted_while_a_file_is_unchanged(tmp_path: Path) -> None:
    """The text of a file is available until the file is changed, removed or was never known."""
    shutil.copytree(ROOT / "submissions/lab6/lidar-buried/my_robot/urdf", tmp_path / "ann")
    while not (now := fingerprint(str(tmp_path), ("ann",), time.time_ns())):
        pass  # until it has settled
    origin = SubmissionFiles(str(tmp_path), ("ann",), (), "ann", now)
    source = SubmissionSources(origin, LAB6).source("my_robot.urdf")
    assert source is not None
    assert SubmissionSources(origin, LAB6).source("missing.urdf") is None
    assert SubmissionSources(origin._replace(fingerprint=""), LAB6).source("my_robot.urdf") is None
    with (tmp_path / "ann/my_robot.urdf").open("a") as file:
        file.write("\n")
    assert SubmissionSources(origin, LAB6).source("my_robot.urdf") is None
    shutil.rmtree(tmp_path / "ann")
    assert SubmissionSources(origin, LAB6).source("my_robot.urdf") is None


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
BUILT = {"build/my_robot/my_robot.urdf": URDF, "log/a.txt": b"", "__pycache__/a.pyc": b"", ".git/config": b""}


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
def test_a_zip_has_the_digests_of_its_folder(files: dict[str, bytes], entries: bool, tmp_path: Path) -> None:
    """A folder and its zip have the same digests, so that nothing is graded again if one replaces the other."""
    name = next(iter(files)).partition("/")[0]
    folder, packed = _both(tmp_path, files, entries=entries)
    assert digest(folder, name) == digest(packed, name)


def test_a_repacked_archive_has_another_digest(tmp_path: Path) -> None:
    """The digest is that of the archive's bytes, in a folder and in a zip."""
    seen = set()
    for number, files in enumerate((ROBOT, dict(reversed(ROBOT.items())))):
        for top in _both(tmp_path / str(number), {"ann.zip": _zip(files)}):
            seen.add(digest(top, "ann.zip"))
    assert len(seen) == 2


def test_several_files_in_a_zip_equal_those_in_a_folder(tmp_path: Path) -> None:
    """Digests and files are the same: build folders and hidden files are ignored in both."""
    files = {"1": URDF, "2": b"notes", "3": URDF, "4": b"hidden"}
    names = ("my_robot.urdf", "onlinetext/notes.html", "build/my_robot.urdf", ".hidden")
    opened = [open_class_submission(str(top), tuple(files), names, "ann") for top in _both(tmp_path, files)]
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
    for top in _both(tmp_path, {f"lab/{name}": b"7z\xbc\xaf\x27\x1c" if name.endswith("7z") else b"text"}):
        with pytest.raises(InputError) as caught:
            open_class_submission(str(top), (f"lab/{name}",), (), "ann")
        output.add(str(caught.value).replace(f"{top}/", ""))
    assert len(output) == 1


def test_a_large_document_and_its_name(tmp_path: Path) -> None:
    """A PDF above the limit for a URDF is opened, also in a zip; its name, not the student's, is in the digest."""
    data = b"%PDF-1.4\n" + bytes(URDF_LIMIT)
    tops = _both(tmp_path, {"report.pdf": data})
    digests = {open_class_submission(str(top), ("report.pdf",), (), key).digest for top in tops for key in ("a", "b")}
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
