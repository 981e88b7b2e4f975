"""The bytes of a file decide whether it is shown as a picture, and as which; everything else is named with a reason."""

import struct

import pytest

from grader.base.errors import FileError
from grader.files.tree import File
from grader.lab.documents import pictures
from grader.lab.documents.pictures import EmbeddedPicture, NotShown, read_picture

pytestmark = pytest.mark.slow

SHOWN = {
    "PNG": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR",
    "JPEG": b"\xff\xd8\xff\xe0",
    "GIF": b"GIF89a\x80\2\xe0\1",
    "WebP": b"RIFF\0\0\0\0WEBPVP8 ",
    "BMP": b"BM" + bytes(12) + (40).to_bytes(4, "little"),
}
SCRIPT = b"<script>alert(1)</script>"
NOT_SHOWN = {
    "HTML": b"<!DOCTYPE html><html>" + SCRIPT,
    "SVG": b'<svg xmlns="http://www.w3.org/2000/svg">' + SCRIPT,
    "TIFF": b"II*\0" + bytes(20),
    "HEIC": b"\0\0\0\x18ftypheic\0\0\0\0mif1heic",
    "a video": b"\0\0\0\x18ftypisom\0\0\0\0isomavc1",
    "a shell script": b"#!/bin/sh\nrm -rf ~\n",
    "text that begins like a BMP": b"BMW" + b" drives" * 20,
    "nothing": b"",
}
WHY = "it is not a PNG, JPEG, GIF, WebP or BMP picture, nor a PDF: open it yourself, with care"


def png(width: int, height: int) -> bytes:
    """Return the beginning of a PNG of this size."""
    return b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + struct.pack(">II", width, height)


def file_of(data: bytes, size: int | None = None) -> File:
    """Return a file of a submission, which may state another size than it has."""

    def read(limit: int, *, first: bool = False) -> bytes:
        if len(data) > limit and not first:
            raise FileError("screen.png", f"is larger than {limit} bytes")
        return data[:limit]

    return File("screen.png", len(data) if size is None else size, read)


@pytest.mark.parametrize("name", SHOWN)
def test_pictures_are_shown(name: str) -> None:
    """Every format of browsers has its own media type, and its bytes unchanged."""
    found = read_picture(file_of(SHOWN[name]))
    assert isinstance(found, EmbeddedPicture)
    assert found.kind.name in name
    assert found.kind.media_type == f"image/{found.kind.name.lower()}"
    assert (found.where, found.data) == ("screen.png", SHOWN[name])


@pytest.mark.parametrize("name", NOT_SHOWN)
def test_everything_else_is_not_shown(name: str) -> None:
    """The name `screen.png` makes nothing a picture; the reason says what to do."""
    assert read_picture(file_of(NOT_SHOWN[name])) == NotShown("screen.png", WHY)


def test_large_files_are_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither one that says that it is large, nor one that is larger than it says."""
    monkeypatch.setattr(pictures, "MAX_BYTES", 1024)
    why = "larger than 1024 bytes"
    assert "larger than 0 MiB, the limit for a picture" in str(read_picture(file_of(b"", 1025)))
    assert str(read_picture(file_of(png(1, 1) + bytes(1024), 1))) == f"screen.png: is {why}"
    assert isinstance(read_picture(file_of(png(1, 1))), EmbeddedPicture)


def test_a_picture_with_markup_in_it_keeps_its_type() -> None:
    """A GIF that is a script as well is served as a GIF, which a browser never runs."""
    found = read_picture(file_of(b"GIF89a" + struct.pack("<HH", 10, 10) + b"/*" + SCRIPT))
    assert isinstance(found, EmbeddedPicture)
    assert found.kind.media_type == "image/gif"
