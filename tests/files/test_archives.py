"""Archives and folders give the same file tree; anything hostile in them is refused, or ignored and named."""

import bz2
import errno
import gc
import gzip
import io
import lzma
import os
import socket
import struct
import tarfile
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random

import pytest

from grader.base.errors import InputError
from grader.files import limits
from grader.files.archive import read_archive
from grader.files.folder import read_folder
from grader.files.opening import archive_kind, open_tree, tree_name
from grader.files.tree import File, Tree
from tests.files.archives import (
    FILES,
    MAKERS,
    ROBOT,
    LinkMember,
    make_named_zip,
    make_tar,
    make_zip,
    set_flags,
    twice,
)
from tests.work import limited_work

URDF = "my_robot/urdf/my_robot.urdf"
NOISE = Random(1)
EVERY = list(MAKERS)


@pytest.fixture(autouse=True)
def temporary(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Path]:
    """Yield a folder for temporary files, which must be empty at the end."""
    place = tmp_path_factory.mktemp("temporary")
    monkeypatch.setattr(tempfile, "tempdir", str(place))
    gc.freeze()  # objects of earlier tests need not be scanned for each of these
    yield place
    gc.collect()
    assert list(place.iterdir()) == []


def tree_of(data: bytes, name: str = "lab6.zip") -> Tree:
    """Return the file tree of an archive, without the contents of nested archives."""
    kind = archive_kind(data[:512])
    assert kind is not None
    return read_archive(io.BytesIO(data), kind, name)


def opened(path: Path, data: bytes) -> Tree:
    """Return the file tree of an archive that is written to a file."""
    path.write_bytes(data)
    tree = open_tree(path)
    assert tree is not None
    return tree


def text(tree: Tree, path: str = URDF) -> bytes:
    """Return the content of a file in a file tree."""
    return tree.files[path].read(1000)


def refusal(data: bytes, name: str = "lab6.zip") -> str:
    """Return the one line with which an archive is refused."""
    with pytest.raises(InputError) as caught:
        tree_of(data, name)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def read_all(tree: Tree) -> None:
    """Read every file of a file tree; unreadable ones must raise InputError."""
    for file in tree.files.values():
        for first in (True, False):
            try:
                file.read(10_000, first=first)
            except InputError as error:
                assert "\n" not in str(error)


@pytest.mark.parametrize("ending", EVERY)
def test_every_kind_of_archive(ending: str, tmp_path: Path) -> None:
    """Files, sizes and folders are the same in every kind; an empty folder is kept."""
    tree = opened(tmp_path / f"lab6{ending}", MAKERS[ending]())
    assert list(tree.files) == ["my_robot/package.xml", URDF]
    assert tree.folders == {"my_robot", "my_robot/urdf", "my_robot/meshes"}
    assert text(tree) == ROBOT
    assert tree.files[URDF].size == len(ROBOT)
    assert (tree.ignored, tree.generated) == ((), ())
    assert tree_name(tmp_path / f"lab6{ending}") == "lab6"


@pytest.mark.parametrize("ending", EVERY)
def test_partial_reads(ending: str) -> None:
    """A file is read up to the requested size, any number of times, and in any order."""
    tree = tree_of(MAKERS[ending]({"a": b"0123456789", "b": b"b"}))
    assert tree.files["a"].read(4, first=True) == b"0123"
    assert tree.files["b"].read(1) == b"b"
    assert tree.files["a"].read(10) == tree.files["a"].read(99, first=True) == b"0123456789"
    with pytest.raises(InputError, match=r"a is larger than 9 bytes, the limit$"):
        tree.files["a"].read(9)


def test_small_files_are_read_once(tmp_path: Path) -> None:
    """What was read of a small file is there even if the file is gone; a larger one is read each time."""
    for name, size in (("small", 4_095), ("large", 4_096)):
        (tmp_path / name).write_bytes(bytes(size))
    files = read_folder(tmp_path).files
    assert [len(files[name].read(9_000, first=True)) for name in ("small", "large")] == [
        4_095,
        4_096,
    ]
    for name in files:
        (tmp_path / name).unlink()
    assert files["small"].read(9_000) == bytes(4_095)
    with pytest.raises(InputError, match=r"^cannot read large: No such file or directory$"):
        files["large"].read(9_000)


def test_only_a_urdfs_limit_can_be_raised(tmp_path: Path) -> None:
    """The advice to raise the limit is given only if it helps."""
    (tmp_path / "a.urdf").write_bytes(b"12345")
    (tmp_path / "a.rviz").write_bytes(b"12345")
    for tree in (
        read_folder(tmp_path),
        tree_of(make_zip({"a.urdf": b"12345", "a.rviz": b"12345"})),
    ):
        with pytest.raises(InputError, match=r"--max-size raises it"):
            tree.files["a.urdf"].read(4)
        with pytest.raises(InputError, match=r"a.rviz is larger than 4 bytes, the limit$"):
            tree.files["a.rviz"].read(4)


@pytest.mark.parametrize("ending", EVERY)
def test_a_subtree_keeps_its_archive_open(ending: str) -> None:
    """A package's file tree can be read after the whole one is deleted."""
    part = tree_of(MAKERS[ending]()).below("my_robot")
    gc.collect()
    assert part.files["urdf/my_robot.urdf"].read(1000) == ROBOT
    assert part.folders == {"urdf", "meshes"}
    assert part.name == "my_robot"


def test_an_archive_is_closed_with_its_tree() -> None:
    """A file outlives its file tree as an object, but its content cannot be read."""
    data = io.BytesIO(make_zip())
    tree = read_archive(data, "zip", "a.zip")
    file = tree.files[URDF]
    del tree
    gc.collect()
    assert data.closed
    with pytest.raises(InputError, match=r"cannot read my_robot/urdf/my_robot.urdf"):
        file.read(10)


def test_a_refused_archive_is_closed() -> None:
    """A file that cannot be read is closed at once."""
    for data, kind in ((b"PK\3\4", "zip"), (b"\x1f\x8b", "gz"), (b"Rar!", "rar")):
        file = io.BytesIO(data)
        with pytest.raises(InputError):
            read_archive(file, kind, "a")
        assert file.closed


@pytest.mark.parametrize("ending", EVERY)
def test_litter_is_ignored(ending: str) -> None:
    """Files of macOS, Windows, editors and builds are ignored; URDFs made by a build are named."""
    tree = tree_of(
        MAKERS[ending](
            {
                "__MACOSX/my_robot/._package.xml": b"",
                "my_robot/.DS_Store": b"",
                "Thumbs.db": b"",
                ".git/config": b"",
                "my_robot/.vscode/settings.json": b"",
                "my_robot/a.urdf": b"",
                "node_modules/b/b.urdf": b"",
                "build/my_robot/a.urdf": b"",
                "install/my_robot/share/my_robot/urdf/A.URDF": b"",
                "log/x.txt": b"",
                "venv/pyvenv.cfg": b"",
                "venv/a.py": b"",
                "my_env/pyvenv.cfg": b"",
                "my_env/lib/b.urdf": b"",
                "my_robot/__pycache__/a.pyc": b"",
            }
        )
    )
    assert list(tree.files) == ["my_robot/a.urdf"]
    assert tree.generated == (
        "build/my_robot/a.urdf",
        "install/my_robot/share/my_robot/urdf/A.URDF",
    )
    assert tree.ignored == ()


def test_windows_separators() -> None:
    """Zips of old Windows programs have backslashes in their names."""
    tree = tree_of(
        make_named_zip({b"my_robot\\urdf\\my_robot.urdf": ROBOT, b"my_robot\\meshes\\": b""})
    )
    assert list(tree.files) == [URDF]
    assert tree.folders == {"my_robot", "my_robot/urdf", "my_robot/meshes"}
    assert text(tree) == ROBOT


@pytest.mark.parametrize(
    ("name", "flags", "expected"),
    [
        ("Übung/ö.urdf".encode(), 0x800, "Übung/ö.urdf"),
        ("Übung/ö.urdf".encode(), 0, "Übung/ö.urdf"),
        ("Übung/ö.urdf".encode("cp437"), 0, "Übung/ö.urdf"),
        ("Übung/ö.urdf".encode("cp1252"), 0, "\u2584bung/\u00f7.urdf"),
        (b"a\nb\x1b[31m.urdf", 0, "a\\x0ab\\x1b[31m.urdf"),
        ("a\u202eb.urdf".encode(), 0x800, "a\\x202eb.urdf"),
    ],
)
def test_names_in_zips(name: bytes, flags: int, expected: str) -> None:
    """A name is decoded as well as possible, and is always printable."""
    tree = tree_of(make_named_zip({name: ROBOT}, flags))
    assert list(tree.files) == [expected]
    assert text(tree, expected) == ROBOT


def test_names_wrongly_declared_as_utf8() -> None:
    """Python refuses such a zip as a whole, which gives one line."""
    assert "cannot be read as an archive" in refusal(
        make_named_zip({"ö.urdf".encode("cp1252"): ROBOT}, 0x800)
    )


@pytest.mark.parametrize("style", [tarfile.GNU_FORMAT, tarfile.PAX_FORMAT, tarfile.USTAR_FORMAT])
def test_names_in_tars(style: int) -> None:
    """A Latin-1 name is shown with replacement characters."""
    name = "Übung/ö.urdf".encode("latin-1").decode("utf-8", "surrogateescape")
    tree = tree_of(make_tar({name: ROBOT, "ä/" + "b" * 90: b"b"}, style=style))
    assert list(tree.files) == ["ä/" + "b" * 90, "\ufffdbung/\ufffd.urdf"]
    assert text(tree, "\ufffdbung/\ufffd.urdf") == ROBOT


def test_duplicate_members() -> None:
    """Of several members with one name the last counts, as for unzip and tar."""
    assert text(tree_of(twice("a.urdf", b"old", b"new")), "a.urdf") == b"new"


@pytest.mark.parametrize("ending", EVERY)
@pytest.mark.parametrize(
    "name",
    [
        "/etc/a.urdf",
        "../a.urdf",
        "a/../../b.urdf",
        "a/..",
        "C:/a.urdf",
        "c:a.urdf",
        "..\\a.urdf",
        "\\\\host\\a",
    ],
)
def test_names_that_lead_out(ending: str, name: str) -> None:
    """A member whose name leads out is ignored and named; the others are kept."""
    tree = tree_of(MAKERS[ending]({name: b"evil", "b.urdf": ROBOT}))
    assert list(tree.files) == ["b.urdf"]
    assert tuple(map(str, tree.ignored)) == (
        f"{name!r} has a name that leads out of the archive, and was not read",
    )


def test_harmless_dots() -> None:
    """Dots that lead nowhere and repeated slashes do not count; a name that begins with a dot is hidden."""
    tree = tree_of(
        make_tar({"./a.urdf": b"a", "x/./y//b.urdf": b"b", "./": None, "...": b"c", "x/..y": b"d"})
    )
    assert list(tree.files) == ["a.urdf", "x/y/b.urdf"]


@pytest.mark.parametrize("ending", EVERY)
@pytest.mark.parametrize(
    "target", ["/etc/passwd", "../other", URDF, "nothing.urdf", "link", "", "x" * 5000]
)
def test_links_are_not_followed(ending: str, target: str) -> None:
    """A link is ignored and named, and may hide what is to be graded; nothing else is lost."""
    tree = tree_of(MAKERS[ending](FILES, [LinkMember("link", target)]))
    assert list(tree.files) == ["my_robot/package.xml", URDF]
    assert tuple(map(str, tree.unopened)) == ("'link' is a symlink, and was not followed",)
    assert "link" in tree.unseen


def test_hard_links_are_not_followed() -> None:
    """A hard link in a tar is ignored and named."""
    tree = tree_of(make_tar(FILES, [LinkMember("copy.urdf", URDF, is_hard=True)]))
    assert tuple(map(str, tree.unopened)) == ("'copy.urdf' is a symlink, and was not followed",)


@pytest.mark.parametrize("kind", [tarfile.CHRTYPE, tarfile.BLKTYPE, tarfile.FIFOTYPE])
def test_devices_in_tars(kind: bytes) -> None:
    """Devices and FIFOs are ignored and named."""

    def change(info: tarfile.TarInfo) -> None:
        info.type = kind if info.name == "device" else info.type

    tree = tree_of(make_tar({"device": b"", "a.urdf": ROBOT}, change=change))
    assert list(tree.files) == ["a.urdf"]
    assert tuple(map(str, tree.ignored)) == ("'device' is not a regular file, and was not read",)


def test_devices_in_zips() -> None:
    """A member that a zip declares as a device is ignored."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name, mode in (
            ("fifo", 0o010644),
            ("device", 0o020644),
            ("plain", 0o100644),
            ("none", 0),
            ("bits", 0o644),
        ):
            info = zipfile.ZipInfo(name)
            info.external_attr = mode << 16
            archive.writestr(info, b"a")
    tree = tree_of(data.getvalue())
    assert list(tree.files) == ["bits", "none", "plain"]
    assert [line.split()[0] for line in map(str, tree.ignored)] == ["'device'", "'fifo'"]


def test_encrypted_members() -> None:
    """A member that needs a password is ignored and named, even if it is a symlink."""
    data = set_flags(make_zip({"a.urdf": ROBOT}, [LinkMember("l", "a.urdf")]), 0x1)
    tree = tree_of(data)
    assert tree.files == {}
    assert tuple(map(str, tree.ignored)) == (
        "'a.urdf' is encrypted, and was not read",
        "'l' is encrypted, and was not read",
    )


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA, 9, 93, 98, 12345])
def test_unsupported_compressions(method: int) -> None:
    """Zip members that are not deflated are ignored and named: some methods unpack without a bound."""
    known = method in (zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)
    data = make_zip({"a.urdf": ROBOT}, compression=method if known else zipfile.ZIP_STORED)
    if not known:
        data = data.replace(
            b"PK\1\2\x14\3\x14\0\0\0\0\0", b"PK\1\2\x14\3\x14\0\0\0" + struct.pack("<H", method)
        )
    tree = tree_of(data)
    assert tree.files == {}
    assert tuple(map(str, tree.ignored)) == (
        "'a.urdf' is compressed with a method other than deflate, and was not read",
    )


@pytest.mark.parametrize(
    ("start", "kind"),
    [(b"7z\xbc\xaf\x27\x1c", "7z"), (b"Rar!\x1a\7\0", "rar"), (b"Rar!\x1a\7\1\0", "rar")],
)
def test_other_archives(start: bytes, kind: str, tmp_path: Path) -> None:
    """7z and rar are refused in one line that says what to submit."""
    path = tmp_path / f"lab6.{kind}"
    path.write_bytes(start + bytes(100))
    with pytest.raises(
        InputError,
        match=f"lab6.{kind} is a {kind} archive, which is not supported: submit a .zip or .tar.gz",
    ):
        open_tree(path)


def test_files_that_are_no_archive(tmp_path: Path) -> None:
    """The content decides; a file with only the name of an archive is refused, others are single files."""
    for name in ("a.zip", "a.tar", "a.TAR.GZ", "a.tgz", "a.rar", "a.7z"):
        (tmp_path / name).write_bytes(b"something else")
        with pytest.raises(InputError, match="is not a readable archive"):
            open_tree(tmp_path / name)
    for name, data in (
        ("a.urdf", make_zip()),
        ("a.txt", ROBOT),
        ("a", b""),
        ("a.xacro", b"PK\3\4"),
    ):
        (tmp_path / name).write_bytes(data)
        assert open_tree(tmp_path / name) is None
    (tmp_path / "upload").write_bytes(make_zip())
    tree = open_tree(tmp_path / "upload")
    assert tree is not None
    assert URDF in tree.files


def test_paths_that_cannot_be_opened(tmp_path: Path) -> None:
    """A path that is missing, is no file or has an impossible name gives one line."""
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "loop").symlink_to("loop")
    for path, words in (
        ("nothing", "does not exist"),
        ("fifo", "is not a regular file"),
        ("loop", "cannot read"),
        ("a" * 300, "cannot read"),
        ("a\0b", "cannot read|does not exist"),
    ):
        with pytest.raises(InputError, match=words):
            open_tree(tmp_path / path)


@pytest.mark.parametrize("ending", EVERY)
def test_truncated_archives(ending: str) -> None:
    """A truncated archive gives one line, or a file tree whose files can be read or say why not."""
    data = MAKERS[ending]({"a.urdf": ROBOT * 40, "b.urdf": NOISE.randbytes(700)})
    for length in range(1, len(data), 7):
        if archive_kind(data[:512][:length]) is None:
            continue
        try:
            tree = tree_of(data[:length])
        except InputError as error:
            assert "\n" not in str(error)
        else:
            read_all(tree)


def test_a_member_without_a_name() -> None:
    """A member with an empty name is ignored."""
    data = bytearray(make_zip({"a.urdf": ROBOT, "b.urdf": ROBOT}))
    central = data.index(b"PK\1\2")
    data[central + 28 : central + 34] = struct.pack(
        "<3H", 0, 0, 6
    )  # its name has become its comment
    assert list(tree_of(bytes(data)).files) == ["b.urdf"]


@pytest.mark.slow
@pytest.mark.parametrize("ending", [".zip", ".tar.gz", ".tar.bz2", ".tar.xz"])
def test_zip_bombs_by_ratio(ending: str) -> None:
    """An archive that unpacks to hundreds of times its size is refused quickly."""
    data = MAKERS[ending]({"a.urdf": bytes(60_000_000)})
    assert len(data) < 100_000
    with limited_work(20_000):
        limit = "32 MiB, the limit for an archive"
        assert refusal(data) == f"lab6.zip would unpack to more than {limit}, and was not read"


@pytest.mark.parametrize("ending", EVERY)
def test_limits_of_size(ending: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The size of an archive and of its content is limited."""
    data = MAKERS[ending]({"a": NOISE.randbytes(3000), "b": NOISE.randbytes(3000)})
    monkeypatch.setattr(limits, "MAX_ARCHIVE_SIZE", 5000)
    assert "lab6.zip is larger than 5000 bytes, the limit for an archive" in refusal(data)
    monkeypatch.undo()
    monkeypatch.setattr(limits, "MAX_UNPACKED_SIZE", 20_000)
    assert set(tree_of(data).files) == {"a", "b"}
    assert "would unpack to more than 20000 bytes, the limit" in refusal(
        MAKERS[ending]({"a": bytes(30_000)})
    )


@pytest.mark.slow
def test_a_bomb_of_overlapping_members() -> None:
    """Members that share the same bytes are refused by their number, their sizes, or when they are read."""
    body = zlib.compress(bytes(1_000_000), 9)[2:-4]
    local = (
        struct.pack(
            "<4s5H3I2H",
            b"PK\3\4",
            20,
            0,
            8,
            0,
            0,
            zlib.crc32(bytes(1_000_000)),
            len(body),
            1_000_000,
            1,
            0,
        )
        + b"a"
    )
    central = b"".join(
        struct.pack(
            "<4s6H3I5H2I",
            b"PK\1\2",
            20,
            20,
            0,
            8,
            0,
            0,
            zlib.crc32(bytes(1_000_000)),
            len(body),
            1_000_000,
            5,
            0,
            0,
            0,
            0,
            0,
            0,
        )
        + f"{n:05}".encode()
        for n in range(2000)
    )
    data = (
        local
        + body
        + central
        + struct.pack(
            "<4s4H2IH", b"PK\5\6", 0, 0, 2000, 2000, len(central), len(local) + len(body), 0
        )
    )
    with limited_work(400_000):
        assert "would unpack to more than 32 MiB" in refusal(data)


@pytest.mark.parametrize("claimed", [10, 5_000_000])
def test_wrong_sizes(claimed: int) -> None:
    """A zip member with a wrong size is never unpacked beyond it, and causes no internal error."""
    real = bytes(1_000_000)
    data = make_zip({"a.urdf": real}).replace(
        struct.pack("<I", len(real)), struct.pack("<I", claimed)
    )
    tree = tree_of(data)
    with pytest.raises(InputError), limited_work(400_000):
        tree.files["a.urdf"].read(500)
        tree.files["a.urdf"].read(20_000_000)


def test_a_central_directory_that_is_too_long() -> None:
    """A zip that declares gigabytes of names is refused before they are read."""
    data = bytes(17 * 1024 * 1024)
    end = struct.pack("<4s4H2IH", b"PK\5\6", 0, 0, 1, 1, 17 * 1024 * 1024, 0, 0)
    assert "its central directory is too long" in refusal(b"PK\3\4" + data[4:] + end)


def test_a_large_file_that_is_not_compressed() -> None:
    """The limit of the central directory does not apply to files."""
    data = make_zip({"a.pdf": bytes(17 * 1024 * 1024)}, compression=zipfile.ZIP_STORED)
    tree = tree_of(data)
    assert len(tree.files["a.pdf"].read(32 * 1024 * 1024)) == 17 * 1024 * 1024


@pytest.mark.parametrize("ending", EVERY)
def test_too_many_members(ending: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """More members than the limit are refused, even if most would be ignored."""
    monkeypatch.setattr(limits, "MAX_FILES", 200)
    names: dict[str, bytes | None] = {f".git/{n}": b"" for n in range(200)}
    assert tree_of(MAKERS[ending](names)).files == {}
    assert (
        refusal(MAKERS[ending]({**names, "a": b""}))
        == "lab6.zip contains more than 200 files: name the package or the URDF"
    )


@pytest.mark.slow
def test_too_many_folders() -> None:
    """Folders count as well, including those that only exist in the names of files."""
    names: dict[str, bytes | None] = {f"{n}/" + "a/" * 600 + "x": b"" for n in range(100)}
    with limited_work(4_000_000):
        assert "contains more than 50000 files" in refusal(make_tar(names))


def header(name: bytes, size: bytes, kind: bytes = b"0") -> bytes:
    """Return a handmade tar header."""
    start = name.ljust(100, b"\0") + b"0000644\0" * 3 + size.ljust(12, b"\0") + b"0" * 11 + b"\0"
    rest = (kind + b"\0" * 100 + b"ustar\x0000").ljust(512 - 156, b"\0")
    total = sum(start) + sum(rest) + 8 * 32
    return start + f"{total:06o}\0 ".encode() + rest


@pytest.mark.parametrize(
    "size",
    [
        b"\xff" * 12,
        b"\x80" + b"\xff" * 11,
        b"\xff" * 8 + b"\0\0\2\0",
        b"77777777777",
        b"-1",
        b"\x80" + b"\x7f" * 11,
    ],
)
def test_sizes_in_tars(size: bytes) -> None:
    """Negative sizes and sizes beyond the end give one line, not an endless loop."""
    data = (
        header(b"a.urdf", b"00000000001")
        + b"a".ljust(512, b"\0")
        + header(b"b.urdf", size)
        + bytes(2048)
    )
    with limited_work(3_000):
        try:
            read_all(tree_of(data))
        except InputError as error:
            assert "\n" not in str(error)


def test_long_names_in_tars() -> None:
    """A name of a hundred thousand characters is ignored; chains of long names end."""
    tree = tree_of(make_tar({"a" * 100_000: b"", "b.urdf": ROBOT}))
    assert list(tree.files) == ["b.urdf"]
    assert tuple(map(str, tree.ignored)) == (
        f"'{'a' * 40}...' has a name that is too long, and was not read",
    )
    names = header(b"././@LongLink", b"00000000001", b"L") + b"a".ljust(512, b"\0")
    with limited_work(300_000):
        assert "cannot be read as an archive" in refusal(names * 5000 + bytes(1024))


def test_sparse_files_in_tars() -> None:
    """A sparse file that claims a terabyte is ignored and named."""
    head = bytearray(header(b"a.urdf", b"00000000000", b"S"))
    head[386 : 386 + 24] = b"00000000000\x0000000000000\0"
    head[483:495] = b"\x80" + (2**40).to_bytes(11, "big")
    head[148:156] = b" " * 8
    head[148:156] = f"{sum(head):06o}\0 ".encode()
    tree = tree_of(bytes(head) + bytes(1024))
    assert tuple(map(str, tree.ignored)) == (
        "'a.urdf' (1099512 MB) is larger than 64 MiB, the limit for one file, and was ignored",
    )
    with pytest.raises(InputError, match="limit for one file"):
        tree.files["a.urdf"].read(10, first=True)


@pytest.mark.slow
@pytest.mark.parametrize("pack", [gzip.compress, bz2.compress, lzma.compress])
def test_compressed_bombs(pack: Callable[[bytes], bytes]) -> None:
    """A compressed file is unpacked only up to a limit, whether it contains a tar or not."""
    data = pack(bytes(40_000_000))
    with limited_work(20_000):
        assert "would unpack to more than 32 MiB" in refusal(data * 3)
        assert "cannot be read as an archive" in refusal(pack(b"no tar at all"))


@pytest.mark.slow
def test_a_large_tar_leaves_no_file(temporary: Path) -> None:
    """A tar that does not fit into memory is kept in a file without a name."""
    data = make_tar({"a.bin": NOISE.randbytes(18_000_000), "b.urdf": ROBOT}, kind="gz")
    tree = tree_of(data)
    assert list(temporary.iterdir()) == []
    assert text(tree, "b.urdf") == ROBOT


def nested(levels: int, inside: bytes) -> bytes:
    """Make nested zips."""
    for _ in range(levels):
        inside = make_zip({"inner/inner.zip": inside})
    return inside


@pytest.mark.parametrize("levels", [1, 2, 3])
def test_nested_archives(levels: int, tmp_path: Path) -> None:
    """A nested archive is opened as a folder of its name."""
    tree = opened(tmp_path / "lab6.zip", nested(levels, make_zip()))
    path = "inner/inner.zip/" * levels + URDF
    gc.collect()
    assert text(tree, path) == ROBOT
    assert "inner/inner.zip/" * levels + "my_robot/meshes" in tree.folders
    assert tree.ignored == ()


def test_archives_nested_too_deep(tmp_path: Path) -> None:
    """Beyond three levels an archive is ignored and named."""
    tree = opened(tmp_path / "lab6.zip", nested(4, make_zip()))
    assert not any(path.endswith(".urdf") for path in tree.files)
    assert str(tree.ignored[0]).endswith(
        "is an archive inside an archive, nested too deep to be opened"
    )


def test_an_archive_beside_a_package(tmp_path: Path) -> None:
    """Archives beside a package and a URDF are not opened."""
    (tmp_path / "lab6.zip").write_bytes(make_zip())
    (tmp_path / "notes.txt").write_bytes(b"")
    alone = open_tree(tmp_path)
    assert alone is not None
    assert f"lab6.zip/{URDF}" in alone.files
    assert text(alone, f"lab6.zip/{URDF}") == ROBOT
    for names in (("a.urdf",), ("package.xml",), ("a.urdf", "package.xml"), ("a.urdf", "setup.py")):
        for name in names:
            (tmp_path / name).write_bytes(ROBOT)
        beside = open_tree(tmp_path)
        assert beside is not None
        assert (f"lab6.zip/{URDF}" in beside.files) == (len(names) == 1)
        assert {"lab6.zip", "notes.txt", *names} <= set(beside.files)
        for name in names:
            (tmp_path / name).unlink()


def test_an_archive_that_cannot_be_opened(tmp_path: Path) -> None:
    """It is named and recorded, because it may contain what is missing."""
    (tmp_path / "lab6.rar").write_bytes(b"Rar!\x1a\x07")
    (tmp_path / "notes.txt").write_bytes(b"")
    tree = open_tree(tmp_path)
    assert tree is not None
    assert [file.path for file in tree.unopened] == ["lab6.rar"]
    assert "rar archive" in str(tree.ignored[0])


@pytest.mark.slow
def test_damaged_archives_in_a_folder(tmp_path: Path) -> None:
    """An archive that cannot be opened is named, and the others are opened."""
    (tmp_path / "a.zip").write_bytes(b"nothing")
    (tmp_path / "b.rar").write_bytes(b"Rar!\x1a\7\0")
    (tmp_path / "c.zip").write_bytes(make_zip()[:60])
    (tmp_path / "d.tar.gz").write_bytes(make_tar(kind="gz"))
    (tmp_path / "e.zip").write_bytes(make_zip({"a": bytes(60_000_000)}))
    (tmp_path / "f.csv.gz").write_bytes(gzip.compress(b"1,2\n"))
    tree = open_tree(tmp_path)
    assert tree is not None
    assert f"d.tar.gz/{URDF}" in tree.files
    assert [line.split()[0] for line in map(str, tree.ignored)] == [
        "'a.zip'",
        "'b.rar'",
        "'c.zip'",
        "'e.zip'",
        "'f.csv.gz'",
    ]
    assert all("\n" not in line for line in map(str, tree.ignored))


def test_many_archives(tmp_path: Path) -> None:
    """The number of opened archives, nested ones included, and their total size are limited."""
    (tmp_path / "lab6.zip").write_bytes(
        make_zip({f"{n:02}.zip": make_zip({"a.zip": make_zip({"b.txt": b""})}) for n in range(15)})
    )
    tree = open_tree(tmp_path / "lab6.zip")
    assert tree is not None
    assert sum(path.endswith("b.txt") for path in tree.files) == 10
    assert sum("there are too many archives" in line for line in map(str, tree.ignored)) == 5


@pytest.mark.slow
def test_archives_share_one_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Many small zip bombs are treated like a large one."""
    monkeypatch.setattr(limits, "MAX_UNPACKED_SIZE", 70_000_000)
    inner = make_tar({"a.bin": bytes(30_000_000)}, kind="gz")
    (tmp_path / "lab6.zip").write_bytes(
        make_zip({f"{n}.tar.gz": inner for n in range(9)}, compression=zipfile.ZIP_STORED)
    )
    with limited_work(50_000):
        tree = open_tree(tmp_path / "lab6.zip")
    assert tree is not None
    assert sum(path.endswith("a.bin") for path in tree.files) == 2
    assert len(tree.ignored) == 7


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """Make a folder with a package, and a secret beside it."""
    (tmp_path / "secret.urdf").write_bytes(b"secret")
    (tmp_path / "lab6/my_robot/urdf").mkdir(parents=True)
    (tmp_path / "lab6" / URDF).write_bytes(ROBOT)
    (tmp_path / "lab6/my_robot/meshes").mkdir()
    return tmp_path / "lab6"


def test_a_folder(home: Path) -> None:
    """Files, sizes and folders are those of the folder."""
    tree = read_folder(home)
    assert list(tree.files) == [URDF]
    assert tree.folders == {"my_robot", "my_robot/urdf", "my_robot/meshes"}
    assert (tree.name, text(tree), tree.files[URDF].size, tree.ignored) == (
        "lab6",
        ROBOT,
        len(ROBOT),
        (),
    )
    assert (tree.files[URDF].name, tree.files[URDF].suffix) == ("my_robot.urdf", ".urdf")


def test_symlinks_in_folders(home: Path) -> None:
    """No symlink is followed; each is named, and may hide what is to be graded."""
    links = {
        "a": URDF,
        "b": "my_robot",
        "c": "../secret.urdf",
        "d": "/etc",
        "e": "nothing",
        "f": "f",
    }
    for name, target in links.items():
        (home / name).symlink_to(target)
    tree = read_folder(home)
    assert list(tree.files) == [URDF]
    assert tuple(map(str, tree.unopened)) == tuple(
        f"{name!r} is a symlink, and was not followed" for name in links
    )
    assert links.keys() <= tree.unseen


def test_special_files(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """FIFOs and sockets are ignored and named, and never opened."""
    os.mkfifo(home / "fifo")
    monkeypatch.chdir(home)
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind("socket")
        tree = read_folder(home)
    assert list(tree.files) == [URDF]
    assert tuple(map(str, tree.ignored)) == tuple(
        f"{name!r} is not a regular file, and was not read" for name in ("fifo", "socket")
    )


def test_litter_in_folders(home: Path) -> None:
    """Builds, tools, virtual environments and hidden files are ignored; URDFs copied by a build are named."""
    for path in (
        ".git/config",
        "build/my_robot/b.urdf",
        "install/my_robot/share/my_robot/urdf/my_robot.urdf",
        "install/x.txt",
        "log/latest/c.urdf",
        "my_robot/.hidden.urdf",
        "my_robot/__pycache__/a.pyc",
        "mine/pyvenv.cfg",
        "mine/lib/d.urdf",
        "venv/pyvenv.cfg",
        "venv/e.urdf",
        "node_modules/f/f.urdf",
        ".DS_Store",
        "Thumbs.db",
        "my_robot/build/deep/g.urdf",
    ):
        (home / path).parent.mkdir(parents=True, exist_ok=True)
        (home / path).write_bytes(b"")
    tree = read_folder(home)
    assert list(tree.files) == [URDF]
    assert tree.ignored == ()
    assert tree.generated == (
        "build/my_robot/b.urdf",
        "install/my_robot/share/my_robot/urdf/my_robot.urdf",
        "log/latest/c.urdf",
        "my_robot/build/deep/g.urdf",
    )


def test_a_symlinked_build_folder(home: Path) -> None:
    """The target of a symlink named install is not even listed."""
    (home / "install").symlink_to("..")
    assert read_folder(home).generated == ()


def test_folders_that_cannot_be_opened(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder without permission is named, and the others are read; for the root folder the submission is refused."""
    scandir = os.scandir

    def refuse(path: "str | os.PathLike[str]") -> "os._ScandirIterator[str]":
        if Path(path).name in closed:
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        return scandir(path)

    monkeypatch.setattr(os, "scandir", refuse)
    closed = ["meshes"]
    tree = read_folder(home)
    assert list(tree.files) == [URDF]
    assert tuple(map(str, tree.ignored)) == (
        "'my_robot/meshes' is a folder that cannot be opened: Permission denied",
    )
    closed = ["lab6"]
    with pytest.raises(InputError, match=r"cannot read .*lab6: Permission denied"):
        read_folder(home)


def test_names_in_folders(home: Path) -> None:
    """Names that are undecodable or not printable are escaped, and their files read."""
    (home / os.fsdecode(b"\xfcbung")).mkdir()
    (home / os.fsdecode(b"\xfcbung/\xf6.urdf")).write_bytes(ROBOT)
    (home / "a\nb\x1b.urdf").write_bytes(ROBOT)
    tree = read_folder(home)
    assert list(tree.files) == ["a\\x0ab\\x1b.urdf", URDF, "\ufffdbung/\ufffd.urdf"]
    assert all(text(tree, path) == ROBOT for path in tree.files)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ["a", "build"])
def test_deep_folders(name: str, tmp_path: Path) -> None:
    """Folders nested deeper than a path may be long are read as far as possible."""
    handle = os.open(tmp_path, os.O_RDONLY)
    try:
        for _ in range(2200):
            os.mkdir(name, dir_fd=handle)
            deeper = os.open(name, os.O_RDONLY, dir_fd=handle)
            os.close(handle)
            handle = deeper
    finally:
        os.close(handle)
    try:
        with limited_work(40_000_000):
            tree = read_folder(tmp_path)
    finally:
        remove_deep(tmp_path, name)
    assert tree.files == {}
    assert len(tree.ignored) == (1 if name == "a" else 0)


def remove_deep(folder: Path, name: str) -> None:
    """Remove folders nested too deeply for pytest: the upper half is moved aside, level by level."""
    while (folder / name / name).is_dir():
        (folder / name / name).rename(folder / "aside")
        (folder / name).rmdir()
        (folder / "aside").rename(folder / name)


def test_too_many_files_in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder with more files than the limit is refused, wherever they are."""
    monkeypatch.setattr(limits, "MAX_FILES", 20)
    for n in range(4):
        (tmp_path / f"d{n}").mkdir()
        for m in range(4):
            (tmp_path / f"d{n}/{m}").write_bytes(b"")
    assert len(read_folder(tmp_path).files) == 16
    (tmp_path / "one_more").write_bytes(b"")
    with pytest.raises(
        InputError, match="contains more than 20 files: name the package or the URDF"
    ):
        read_folder(tmp_path)


def test_a_removed_file(home: Path) -> None:
    """A file that was removed or replaced meanwhile gives one line."""
    file: File = read_folder(home).files[URDF]
    (home / URDF).unlink()
    with pytest.raises(InputError, match=r"cannot read .*my_robot.urdf: No such file"):
        file.read(100)
    (home / URDF).mkdir()
    with pytest.raises(InputError, match=r"my_robot.urdf is not a regular file|Is a directory"):
        file.read(100)


def test_a_folder_and_its_zip_are_equal(home: Path) -> None:
    """The file trees are the same."""
    packed = tree_of(make_zip({URDF: ROBOT, "my_robot/meshes/": None}))
    plain = read_folder(home)
    assert [file[:2] for file in packed.files.values()] == [
        file[:2] for file in plain.files.values()
    ]
    assert packed.folders == plain.folders
