"""A zip of a whole class gives the same for each student as that student's own archive or folder."""

import io
import tempfile
import zipfile
from hashlib import sha256
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.files.archive import read_archive
from grader.files.class_source import ClassZip
from grader.files.tree import Tree
from tests.classroom.class_runs import Item, bomb, tarred

pytestmark = pytest.mark.slow

NAMES = st.lists(
    st.text(st.sampled_from("ab./\\ é"), min_size=1, max_size=12).filter(
        lambda name: not name.endswith(("/", "\\"))
    ),
    max_size=6,
    unique=True,
)


def pack(members: dict[str, bytes]) -> bytes:
    """Make a zip with these members; a name that ends in a slash is a folder."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, data in members.items():
            archive.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def bulk(target: Path, data: bytes) -> ClassZip:
    """Return an open zip."""
    (target / "class.zip").write_bytes(data)
    return ClassZip(target / "class.zip")


def contents_of(tree: Tree) -> tuple[object, ...]:
    """Return everything known of a file tree, with the contents of its files."""
    files = {path: (file.size, file.read(10**6)) for path, file in tree.files.items()}
    return files, tree.folders, tree.ignored, tree.generated, tree.unseen


@given(NAMES)
def test_a_folder_in_a_class_zip_equals_its_own_zip(names: list[str]) -> None:
    """Files, folders and refusals are the same, whatever the names."""
    members = {name: f"{number}".encode() for number, name in enumerate(names)}
    inside = {
        f"ann/{name}": data for name, data in members.items() if not name.startswith(("/", "\\"))
    }
    alone = read_archive(
        io.BytesIO(pack({name.removeprefix("ann/"): inside[name] for name in inside})), "zip", "ann"
    )
    with tempfile.TemporaryDirectory() as target:
        found = bulk(Path(target), pack({"ann/": b"", **inside, "bea/x.urdf": b"bea"})).folder(
            "ann"
        )
        files, *rest = contents_of(found)
        assert (files, rest[0]) == contents_of(alone)[:2]
        assert not any("bea" in path for path in found.files)


def test_an_archive_in_a_class_zip_equals_one_alone(tmp_path: Path) -> None:
    """A zip or a tar in the zip of the class, and a single file."""
    inner = pack(
        {"my_robot/urdf/my_robot.urdf": b"<robot/>", "my_robot/build/x.urdf": b"", "../out": b"no"}
    )
    tar = tarred([Item("my_robot/a.urdf", b"<robot/>")])
    opened = bulk(
        tmp_path,
        pack({"ann.zip": inner, "bea.tar.gz": tar, "cal.urdf": b"<robot/>", "dan.zip": b"nothing"}),
    )
    for name, data, kind in (("ann.zip", inner, "zip"), ("bea.tar.gz", tar, "gz")):
        digest = sha256()
        found = opened.archive(name, digest)
        assert found is not None
        assert contents_of(found) == contents_of(read_archive(io.BytesIO(data), kind, name))
        assert digest.digest() == sha256(data).digest()
    assert opened.archive("cal.urdf", sha256()) is None
    assert opened.read("cal.urdf", 100) == b"<robot/>"
    with pytest.raises(InputError, match="larger than 3 bytes"):
        opened.read("cal.urdf", 3)
    with pytest.raises(InputError, match=r"dan\.zip is not a readable archive"):
        opened.archive("dan.zip", sha256())
    with pytest.raises(InputError, match=r"eve\.zip is not in "):
        opened.archive("eve.zip", sha256())


def test_several_files_keep_their_names(tmp_path: Path) -> None:
    """Several files are read like a folder that contains only them."""
    opened = bulk(tmp_path, pack({"ann_1_a.urdf": b"a", "ann_2_b.txt": b"b", "bea_1_a.urdf": b"c"}))
    tree = opened.files({"ann_1_a.urdf": "a.urdf", "ann_2_b.txt": "b.txt"}, "ann")
    assert contents_of(tree)[0] == {"a.urdf": (1, b"a"), "b.txt": (1, b"b")}
    assert tree.name == "ann"


@pytest.mark.parametrize(
    "name", ["../out.urdf", "/out.urdf", "C:\\out.urdf", "ann/../../out.urdf", "..\\out.urdf"]
)
def test_names_that_lead_out_are_unassigned(name: str, tmp_path: Path) -> None:
    """No path leads to them, and the other files are read."""
    opened = bulk(tmp_path, pack({name: b"out", "ann/a.urdf": b"a"}))
    assert set(opened.folder("ann").files) == {"a.urdf"}
    for path in (name, "out.urdf", "../out.urdf"):
        with pytest.raises(InputError):
            opened.read(path, 100)


def test_an_encrypted_member_is_ignored(tmp_path: Path) -> None:
    """It is listed, and the other files of its student are read."""
    data = bytearray(pack({"ann/a.urdf": b"a", "ann/b.urdf": b"b"}))
    for signature, offset in ((b"PK\3\4", 6), (b"PK\1\2", 8)):
        data[data.index(signature) + offset] |= 1
    opened = bulk(tmp_path, bytes(data))
    tree = opened.folder("ann")
    assert set(tree.files) == {"b.urdf"}
    assert tuple(map(str, tree.ignored)) == ("'a.urdf' is encrypted, and was not read",)
    with pytest.raises(InputError, match=r"a\.urdf' is encrypted"):
        opened.read("ann/a.urdf", 100)


def test_a_zip_bomb_affects_its_student_only(tmp_path: Path) -> None:
    """A member that would unpack to more than the limit is refused before it is unpacked."""
    zeros = bytes(64 * 1024 * 1024)
    opened = bulk(
        tmp_path,
        pack({"ann/b.zip": bomb(), "bea.zip": bomb(), "cal/a.urdf": b"a", "dan/zeros.urdf": zeros}),
    )
    with pytest.raises(
        InputError, match=r"would unpack to more than [0-9]+ MiB, the limit for an archive"
    ):
        opened.archive("bea.zip", sha256())
    assert set(opened.folder("ann").files) == {"b.zip"}
    assert opened.read("cal/a.urdf", 100) == b"a"
    with pytest.raises(InputError, match="larger than"):
        opened.folder("dan").files["zeros.urdf"].read(1024 * 1024)


def test_a_broken_zip_is_one_line(tmp_path: Path) -> None:
    """A truncated zip, a file that is no zip, and a missing one each give one line."""
    whole = pack({"ann/a.urdf": b"a" * 1_000})
    for data in (whole[:-10], b"", b"text", whole[: len(whole) // 2]):
        with pytest.raises(InputError, match=r"class\.zip cannot be read as an archive"):
            bulk(tmp_path, data)
    with pytest.raises(InputError, match="cannot be read as an archive"):
        ClassZip(tmp_path / "missing.zip")


def test_a_damaged_member_affects_its_student_only(tmp_path: Path) -> None:
    """A member with a wrong checksum cannot be read; the next one can."""
    data = pack({"ann.urdf": b"a" * 5_000, "bea.urdf": b"b"})
    start = data.index(b"ann.urdf") + len("ann.urdf")
    opened = bulk(tmp_path, data[:start] + b"\xff\xff" + data[start + 2 :])
    with pytest.raises(InputError, match=r"cannot read ann\.urdf"):
        opened.read("ann.urdf", 10_000)
    assert opened.read("bea.urdf", 10) == b"b"
