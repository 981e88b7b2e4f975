"""Whether the content of a mesh file is of the format of its ending. No mesh is loaded."""

import posixpath
import struct

from grader.base.errors import InputError, NotDecided
from grader.base.patterns import on_use
from grader.files.tree import File

LFS_POINTER = b"version https://git-lfs.github.com/spec/"
_START = 64 * 1024  # bytes that are read
_HEAD, _TRIANGLE = (
    84,
    50,
)  # bytes of a binary STL: its head, which ends in the number of triangles, and each of them
_BEGINS_WITH = {".glb": b"glTF", ".ply": b"ply"}
# The numbers of COLLADA: how many there are, and all of them.
_ARRAY = on_use(
    rb"""<float_array\b[^<>]{0,200}\bcount\s?=\s?["'](\d{1,9})["'][^<>]{0,200}>([^<]*)<"""
)


def content_fault(file: File, path: str) -> str:
    """Return what is wrong with the content of a mesh file.

    It is empty if it may be of the format that its path says.

    The path is that at which a build installs it, perhaps with another ending.

    Raises NotDecided if the file cannot be read, or is a pointer to one.
    """
    if not file.size:
        return "is empty"
    try:
        start = file.read(_START, first=True)
    except InputError as error:
        raise NotDecided(str(error), "a mesh cannot be read") from None
    if start.startswith(LFS_POINTER):
        raise NotDecided(
            "this download holds only the pointer of Git LFS, not the mesh",
            "a mesh is a Git LFS pointer",
        )
    suffix = posixpath.splitext(path)[1].lower()
    if not _is_of_format(file, start, suffix):
        return f"is no {suffix.removeprefix('.').upper()} file"
    is_plain = suffix == ".dae" and b"<!" not in start  # without comments, and CDATA
    for count, numbers in _ARRAY.findall(start) if is_plain else ():
        there = len(numbers.split())
        if int(count) > there:  # of which Assimp expects more
            return f"promises {int(count)} values in a <float_array> and has {there}"
    return ""


def _is_of_format(file: File, start: bytes, suffix: str) -> bool:
    match suffix:
        case ".stl":  # as Assimp, which RViz uses, tells the two kinds apart
            is_binary = (
                file.size >= _HEAD
                and file.size == _HEAD + _TRIANGLE * struct.unpack_from("<I", start, 80)[0]
            )
            return is_binary or start.lstrip().lower().startswith(b"solid")
        case ".dae":
            return b"<COLLADA" in start
        case ".obj":
            return b"\0" not in start
        case _:
            return start.startswith(_BEGINS_WITH.get(suffix, b""))
