"""Pictures and PDF files that a browser shows safely.

Their type is that of their bytes, never of their names.
"""

import re
from collections.abc import Iterator
from tempfile import TemporaryFile
from typing import NamedTuple

from grader.base.errors import FileError, InputError
from grader.files.archive import read_archive
from grader.files.tree import File

MAX_BYTES = 20 * 1024 * 1024
_MAX_DOCUMENT = 32 * 1024 * 1024
# Sizes of the second header of a BMP file. The signature "BM" alone could also begin a text.
_DIB_SIZES = frozenset({12, 40, 52, 56, 64, 108, 124})


class _ImageType(NamedTuple):
    """A format that every browser shows: its name, its media type, and its file name extension."""

    name: str
    media_type: str
    ending: str


_PNG, _JPEG, _GIF, _WEBP, _BMP, PDF = (
    _ImageType("PNG", "image/png", "png"),
    _ImageType("JPEG", "image/jpeg", "jpg"),
    _ImageType("GIF", "image/gif", "gif"),
    _ImageType("WebP", "image/webp", "webp"),
    _ImageType("BMP", "image/bmp", "bmp"),
    _ImageType("PDF", "application/pdf", "pdf"),
)
_SIGNATURES = (
    (re.compile(rb"\x89PNG\r\n\x1a\n"), _PNG),
    (re.compile(rb"\xff\xd8\xff"), _JPEG),
    (re.compile(rb"GIF8[79]a"), _GIF),
    (re.compile(rb"RIFF.{4}WEBPVP8[ LX]", re.DOTALL), _WEBP),
    (re.compile(rb"BM", re.DOTALL), _BMP),
    (re.compile(rb"%PDF-"), PDF),
)
_OTHER = "it is not a PNG, JPEG, GIF, WebP or BMP picture, nor a PDF: open it yourself, with care"


class EmbeddedPicture(NamedTuple):
    """A picture or PDF of a submission: where it is, its type, and its bytes.

    `page` of a PDF is shown first.
    """

    where: str
    kind: _ImageType
    data: bytes
    page: int = 1


class NotShown(NamedTuple):
    """A file or document whose pictures are not shown, and why."""

    where: str
    reason: str

    def __str__(self) -> str:
        return f"{self.where}: {self.reason}"


def _image_type(data: bytes) -> _ImageType | None:
    """Return the format of a picture, by its signature; None for everything that is not shown."""
    kind = next((kind for signature, kind in _SIGNATURES if signature.match(data)), None)
    if kind is _BMP and int.from_bytes(data[14:18], "little") not in _DIB_SIZES:
        return None
    return kind


def read_picture(file: File) -> EmbeddedPicture | NotShown:
    """Return the picture in a file, or why it is not shown."""
    if file.size > MAX_BYTES:
        limit = f"{MAX_BYTES >> 20} MiB, the limit for a picture"
        reason = f"it is larger than {limit} ({file.size / 1e6:.0f} MB): open it yourself"
        return NotShown(file.path, reason)
    try:
        data = file.read(MAX_BYTES)
    except InputError as error:
        return NotShown(file.path, error.reason if isinstance(error, FileError) else str(error))
    kind = _image_type(data)
    if kind:
        return EmbeddedPicture(file.path, kind, data)
    return NotShown(file.path, _OTHER)


def pictures_in_word(file: File) -> Iterator[EmbeddedPicture | NotShown]:
    """Yield the pictures of a Word file in the order of their names.

    This is the order of their insertion.
    """
    try:
        stored = TemporaryFile()  # noqa: SIM115  its tree closes it
        stored.write(file.read(_MAX_DOCUMENT))
        tree = read_archive(stored, "zip", file.path)
    except InputError as error:
        yield NotShown(file.path, error.reason if isinstance(error, FileError) else str(error))
        return
    media = [one for one in tree.files.values() if one.path.startswith("word/media/")]
    for one in sorted(media, key=lambda one: (len(one.name), one.name)):
        shown = read_picture(one)
        yield shown._replace(where=f"{one.name} in {file.path}")
