"""The size of a picture is read from the header of every supported format; a damaged header has none."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.documents.image_size import image_size

_TIFF = struct.pack("<4sIHHHIHHHHIHHHHIHH", b"II*\0", 8, 3, 0x100, 3, 1, 640, 0, 0x101, 3, 1, 480, 0, 0x112, 3, 1, 6, 0)
_FRAME = b"\xff\xc0" + struct.pack(">HBHHB", 17, 8, 480, 640, 3) + bytes(9)
_EXIF = b"\xff\xe1" + struct.pack(">H", len(_TIFF) + 8) + b"Exif\0\0" + _TIFF
HEADERS = {
    "PNG": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + struct.pack(">II", 640, 480), (640, 480)),
    "GIF": (b"GIF89a" + struct.pack("<HH", 640, 480), (640, 480)),
    "BMP": (b"BM" + bytes(12) + struct.pack("<Iii", 40, 640, 480), (640, 480)),
    "BMP from top to bottom": (b"BM" + bytes(12) + struct.pack("<Iii", 40, 640, -480), (640, 480)),
    "BMP of OS/2": (b"BM" + bytes(12) + struct.pack("<IHH", 12, 640, 480), (640, 480)),
    "JPEG": (b"\xff\xd8\xff\xdb" + struct.pack(">H", 4) + b"\0\0" + _FRAME, (640, 480)),
    "JPEG turned by its EXIF data": (b"\xff\xd8" + _EXIF + _FRAME, (480, 640)),
    "TIFF turned by its orientation": (_TIFF, (480, 640)),
    "WebP, lossy": (b"RIFF\0\0\0\0WEBPVP8 " + bytes(10) + struct.pack("<HH", 640, 480), (640, 480)),
    "WebP, lossless": (b"RIFF\0\0\0\0WEBPVP8L\0\0\0\0\x2f" + struct.pack("<I", 639 | 479 << 14), (640, 480)),
    "WebP, extended": (b"RIFF\0\0\0\0WEBPVP8X" + bytes(8) + b"\x7f\x02\0\xdf\x01\0", (640, 480)),
}


@pytest.mark.parametrize("name", HEADERS)
def test_the_size_is_in_the_header(name: str) -> None:
    """Width and height equal those of a viewer; a truncated header has none."""
    header, size = HEADERS[name]
    assert image_size(header) == size
    assert image_size(header[:9]) is None


@given(start=st.sampled_from([header[:4] for header, _ in HEADERS.values()]), rest=st.binary(max_size=100))
def test_a_damaged_header_is_no_error(start: bytes, rest: bytes) -> None:
    """Any bytes after a signature give a positive size or none."""
    size = image_size(start + rest)
    assert size is None or min(size) > 0


@pytest.mark.parametrize("extension", [b"", b"!\xf9\x04\0\0\0\0\0", b"!\xfe\x03abc\x02de\0"])
@pytest.mark.parametrize("table", [b"\0\0\0", b"\x81\0\0" + bytes(12)])
def test_a_frame_that_is_larger_than_the_screen_of_a_gif_counts(extension: bytes, table: bytes) -> None:
    """Browsers enlarge the screen for the first frame, also after a colour table and extensions."""
    start = b"GIF89a\x01\0\x01\0" + table + extension + b",\x0a\0\0\0\x20\x4e\x30\x75"
    assert image_size(start) == (10 + 20_000, 30_000)
