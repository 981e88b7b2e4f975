"""Width and height of a picture from its first bytes. Nothing is decoded; the library imagesize loads urllib, ssl."""

import struct

_TIFF_WIDTH, _TIFF_HEIGHT, _TIFF_ORIENTATION = 0x100, 0x101, 0x112
_MAX_TAGS = 1_000
_JPEG_NO_SIZE = {0xC4, 0xC8, 0xCC}  # tables among the markers 0xC0 to 0xCF, which else begin a frame


def image_size(start: bytes) -> tuple[int, int] | None:
    """Return width and height in pixels as a viewer shows the picture; None for other data or a damaged header."""
    try:
        width, height, orientation = _read(start)
    except (struct.error, IndexError, KeyError):
        return None
    if width <= 0 or height <= 0:
        return None
    return (height, width) if 5 <= orientation <= 8 else (width, height)  # EXIF: turned by 90 degrees


def _read(start: bytes) -> tuple[int, int, int]:
    """Return width, height and the EXIF orientation, 1 where there is none."""
    return next((read(start) for magic, read in _READERS.items() if start.startswith(magic)), (0, 0, 1))


def _png(start: bytes) -> tuple[int, int, int]:
    return (*struct.unpack_from(">II", start, 16), 1) if start[12:16] == b"IHDR" else (0, 0, 1)


def _bmp(start: bytes) -> tuple[int, int, int]:
    is_old = struct.unpack_from("<I", start, 14)[0] == 12  # OS/2
    width, height = struct.unpack_from("<HH" if is_old else "<ii", start, 18)
    return width, abs(height), 1  # negative: from top to bottom


def _tiff(start: bytes) -> tuple[int, int, int]:
    tags = _tiff_tags(start)
    return tags[_TIFF_WIDTH], tags[_TIFF_HEIGHT], tags.get(_TIFF_ORIENTATION, 1)


def _gif(start: bytes) -> tuple[int, int, int]:
    """Return the size of the screen, or of the first frame if that is larger: a viewer enlarges the screen for it."""
    width, height = struct.unpack_from("<HH", start, 6)
    try:
        left, top, wide, high = struct.unpack_from("<HHHH", start, _first_frame(start) + 1)
    except (struct.error, IndexError):  # only the screen is known
        return width, height, 1
    return max(width, left + wide), max(height, top + high), 1


def _first_frame(gif: bytes) -> int:
    """Return where the descriptor of the first frame begins: after the colour table, and extensions in blocks."""
    position = 13 + (3 << (gif[10] & 7) + 1 if gif[10] & 0x80 else 0)
    while gif[position] == ord("!"):
        position += 2
        while gif[position]:
            position += 1 + gif[position]
        position += 1
    return position


def _jpeg(start: bytes) -> tuple[int, int, int]:
    orientation, position = 1, 2
    while True:
        while start[position] == 0xFF:
            position += 1
        marker = start[position]
        length = struct.unpack_from(">H", start, position + 1)[0]
        if 0xC0 <= marker <= 0xCF and marker not in _JPEG_NO_SIZE:
            height, width = struct.unpack_from(">HH", start, position + 4)
            return width, height, orientation
        segment = start[position + 3 : position + 1 + length]
        if marker == 0xE1 and segment.startswith(b"Exif\0\0"):
            try:
                orientation = _tiff_tags(segment[6:]).get(_TIFF_ORIENTATION, 1)
            except (struct.error, IndexError):  # damaged EXIF data does not hide the size
                orientation = 1
        position += 1 + length


def _tiff_tags(data: bytes) -> dict[int, int]:
    """Return the numbers among the tags of the first directory of a TIFF file, or of EXIF data."""
    order = "<" if data.startswith(b"II") else ">"
    offset = struct.unpack_from(f"{order}I", data, 4)[0]
    tags: dict[int, int] = {}
    for index in range(min(struct.unpack_from(f"{order}H", data, offset)[0], _MAX_TAGS)):
        tag, kind = struct.unpack_from(f"{order}HH", data, offset + 2 + 12 * index)
        if kind in (3, 4):  # 16 or 32 bits
            tags[tag] = struct.unpack_from(f"{order}{'H' if kind == 3 else 'I'}", data, offset + 10 + 12 * index)[0]
    return tags


def _webp(start: bytes) -> tuple[int, int, int]:
    width, height = 0, 0
    match start[8:16]:
        case b"WEBPVP8 ":
            width, height = (side & 0x3FFF for side in struct.unpack_from("<HH", start, 26))
        case b"WEBPVP8L":
            bits = struct.unpack_from("<I", start, 21)[0]
            width, height = (bits & 0x3FFF) + 1, (bits >> 14 & 0x3FFF) + 1
        case b"WEBPVP8X":
            low_width, high_width, low_height, high_height = struct.unpack_from("<HBHB", start, 24)
            width, height = (high_width << 16 | low_width) + 1, (high_height << 16 | low_height) + 1
    return width, height, 1


_READERS = {
    b"\x89PNG\r\n\x1a\n": _png,
    b"GIF87a": _gif,
    b"GIF89a": _gif,
    b"BM": _bmp,
    b"\xff\xd8\xff": _jpeg,
    b"II*\0": _tiff,
    b"MM\0*": _tiff,
    b"RIFF": _webp,
}
