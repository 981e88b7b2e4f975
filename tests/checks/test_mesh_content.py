"""What the first bytes of a mesh file say of its format."""

import struct
from functools import partial

import pytest

from grader.base.errors import InputError, NotDecided
from grader.files.tree import File
from grader.ros.package.mesh_content import content_fault

pytestmark = pytest.mark.slow

BINARY = b"\0" * 80 + struct.pack("<I", 1) + b"\0" * 50


def _collada(count: int) -> bytes:
    return b"<COLLADA><float_array id='a' count='%d'>0 1 2 3 4 5</float_array></COLLADA>" % count


def file_with(name: str, data: bytes) -> File:
    """Return a file with this content."""
    return File(f"meshes/{name}", len(data), partial(_read, data))


def _read(data: bytes, limit: int, *, first: bool = False) -> bytes:
    return data[:limit] if first else data


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.stl", b"solid arm\nendsolid arm\n"),
        ("a.STL", b"  SOLID arm\n"),
        ("a.stl", BINARY),
        ("a.dae", b'<?xml version="1.0"?>\n<COLLADA version="1.4.1"/>'),
        ("a.dae", _collada(6)),
        ("a.dae", _collada(7).partition(b" 5")[0]),
        ("a.dae", _collada(6) + b"<!-- %s -->" % _collada(9)),
        ("a.dae", b"<COLLADA><float_array count='1'><![CDATA[5]]></float_array></COLLADA>"),
        ("a.obj", b"# made by hand\nv 0 0 0\n"),
        ("a.glb", b"glTF\2\0\0\0"),
        ("a.ply", b"ply\nformat ascii 1.0\n"),
        ("a.3ds", b"MM"),
        ("a", b"?"),
    ],
)
def test_a_mesh_of_its_format_has_no_fault(name: str, data: bytes) -> None:
    """STL in both forms, COLLADA, OBJ, glTF, PLY; of other formats nothing is known. The installed name counts."""
    assert content_fault(file_with("a.bin", data), f"share/arm/{name}") == ""


@pytest.mark.parametrize(
    ("name", "data", "fault"),
    [
        ("a.stl", b"", "is empty"),
        ("a.stl", BINARY[:-1], "is no STL file"),
        ("a.stl", b"<html>", "is no STL file"),
        ("a.dae", b"<html>", "is no DAE file"),
        ("a.obj", b"\0\0", "is no OBJ file"),
        ("a.glb", b"{}", "is no GLB file"),
        ("a.ply", b"obj", "is no PLY file"),
        ("a.dae", _collada(7), "promises 7 values in a <float_array> and has 6"),
    ],
)
def test_a_mesh_of_another_format_is_named(name: str, data: bytes, fault: str) -> None:
    """Also one that is empty, or cut off."""
    assert content_fault(file_with("a.bin", data), f"share/arm/{name}") == fault


def test_what_is_not_there_is_not_decided() -> None:
    """A pointer of Git LFS, and a file that cannot be read."""
    with pytest.raises(NotDecided, match="only the pointer of Git LFS"):
        content_fault(file_with("a.stl", b"version https://git-lfs.github.com/spec/v1\n"), "a.stl")

    def refuse(limit: int, *, first: bool = False) -> bytes:
        raise InputError(f"larger than {limit}, {first}")

    with pytest.raises(NotDecided, match="larger than"):
        content_fault(File("a.stl", 9, refuse), "a.stl")
