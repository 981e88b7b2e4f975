"""Extract the pictures of a Word or PDF file from standard input to standard output, as the converter does the text.

Each picture has the number of its position in that text.
"""

import io
import runpy
import struct
import sys
from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any
from zlib import compress, crc32

_GREY, _RGB, _PALETTE = 0, 2, 3  # the colour types of PNG
_COLOURS = {"/DeviceGray": _GREY, "/CalGray": _GREY, 1: _GREY, "/DeviceRGB": _RGB, "/CalRGB": _RGB, 3: _RGB}
_PLAIN = {
    "/FlateDecode",
    "/LZWDecode",
    "/ASCII85Decode",
    "/ASCIIHexDecode",
    "/RunLengthDecode",
}  # filters of raw samples
_RELATIONSHIPS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_HEADER = struct.Struct(">II")  # before each picture: its number and its length
_MAX_PICTURES, _MAX_BYTES = 60, 48 * 1024 * 1024  # in one document, and of all of them
_MAX_PALETTE = 3 * 256


def main() -> int:
    """Convert one document, with the arguments and limits of the converter: no other module can be imported here."""
    converter = runpy.run_path(str(Path(__file__).with_name("converter.py")))

    def in_docx(data: bytes) -> bytes:
        return _pack(_in_docx(converter["opened"](data), converter["MARKS"]))

    def in_pdf(data: bytes) -> bytes:
        import pypdf

        return _pack(_in_pdf(pypdf.PdfReader(io.BytesIO(data)).pages[: converter["MAX_PAGES"]]))

    return int(converter["main"]({"docx": in_docx, "pdf": in_pdf}))


def unpacked(output: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield the pictures in the output, each with its number."""
    start = 0
    while start < len(output):
        number, length = _HEADER.unpack_from(output, start)
        start += _HEADER.size + length
        yield number, output[start - length : start]


def _pack(pictures: Iterator[tuple[int, bytes]]) -> bytes:
    parts: list[bytes] = []
    left = _MAX_BYTES
    for number, data in pictures:
        left -= len(data)
        if left < 0 or len(parts) >= _MAX_PICTURES:
            break
        parts.append(_HEADER.pack(number, len(data)) + data)
    return b"".join(parts)


def _in_docx(document: Any, marks: Collection[str]) -> Iterator[tuple[int, bytes]]:
    """Yield each picture with its number; a copy that Word adds to a paragraph for older versions is empty."""
    number = 0
    for block in document.iter_inner_content():
        seen: set[str] = set()
        for element in block._element.iter():  # noqa: SLF001  python-docx has no name for it
            if str(element.tag).rpartition("}")[2] not in marks:
                continue
            for name in filter(None, map(_picture_id, element.iter())):
                part = document.part.related_parts.get(name)
                if part is not None:
                    yield number, b"" if name in seen else part.blob
                seen.add(name)
            number += 1


def _picture_id(element: Any) -> str:
    """Return the id of the picture that an element of a drawing, or of an older VML one, shows; empty for others."""
    attribute = {"blip": "embed", "imagedata": "id"}.get(str(element.tag).rpartition("}")[2])
    return str(element.get(f"{{{_RELATIONSHIPS}}}{attribute}", ""))


def _in_pdf(pages: Iterable[Any]) -> Iterator[tuple[int, bytes]]:
    number = 0
    for page in pages:
        names: list[Any] = []
        with suppress(Exception):  # as in the text: a damaged page has no pictures
            names = list(page.images.keys())
        for name in names:
            with suppress(Exception):  # a damaged picture does not hide the others
                picture = _of_pdf(_image(page, name))
                if picture:
                    yield number, picture
        number += bool(names)


def _image(page: Any, name: Any) -> Any:
    """Return the image of a page with this name, or, where it is in a form, with this list of names."""
    found = page
    for part in [name] if isinstance(name, str) else name:
        found = found["/Resources"]["/XObject"][part]
    return found


def _of_pdf(image: Any) -> bytes:
    """Return a JPEG as it is in the PDF, and plain samples of grey or RGB as a PNG; empty for other kinds."""
    filters = image.get("/Filter", [])
    names = [str(name) for name in (filters if isinstance(filters, list) else [filters])]
    colours: Any = image["/ColorSpace"] if "/ColorSpace" in image else None  # noqa: SIM401  `get` follows no reference
    is_indexed = isinstance(colours, list) and colours[0] == "/Indexed"
    if _is_remapped(image, 255 if is_indexed else 1):
        return b""
    if names == ["/DCTDecode"]:
        return bytes(image._data)  # noqa: SLF001  `get_data` would decode it
    if image["/BitsPerComponent"] != 8 or not _PLAIN.issuperset(names):
        return b""
    if is_indexed:
        table = colours[3].get_object()
        palette = table.get_data() if hasattr(table, "get_data") else getattr(table, "original_bytes", b"")
        kind = _PALETTE if _colour_type(colours[1].get_object()) == _RGB and palette else None
    else:
        palette, kind = b"", _colour_type(colours)
    return _png(image["/Width"], image["/Height"], kind, palette, image.get_data()) if kind is not None else b""


def _is_remapped(image: Any, highest: int) -> bool:
    """Return whether a PDF maps the samples of an image to other values, as inverted ones (ISO 32000-1, 8.9.5.2)."""
    decode = list(image["/Decode"]) if "/Decode" in image else []
    return decode != [0, highest] * (len(decode) // 2)


def _colour_type(colours: Any) -> int | None:
    """Return the colour type of a colour space without a palette; None for other colours, such as CMYK."""
    if isinstance(colours, list):
        colours = colours[1].get_object()["/N"] if colours[0] == "/ICCBased" else colours[0]
    return _COLOURS.get(colours)


def _png(width: int, height: int, kind: int, palette: bytes, samples: bytes) -> bytes:
    """Return samples of 8 bits as a PNG; empty if there are too few."""
    row = width * (3 if kind == _RGB else 1)
    if min(width, height) < 1 or len(samples) < row * height:
        return b""
    lines = b"".join(b"\0" + samples[row * y : row * (y + 1)] for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    colours = _chunk(b"PLTE", palette[: min(len(palette) // 3 * 3, _MAX_PALETTE)]) if kind == _PALETTE else b""
    data = _chunk(b"IDAT", compress(lines, 1))
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + colours + data + _chunk(b"IEND", b"")


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", crc32(name + data))


if __name__ == "__main__":
    sys.exit(main())
