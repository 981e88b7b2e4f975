"""The members of an archive, as zip and tar give them alike."""

import lzma
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import IO, Literal, NamedTuple

from grader.text import printable_path

MAX_NAME_LENGTH = 4096  # characters of a name, and of what a link points to
NOT_REGULAR = "is not a regular file, and was not read"
# What the standard library raises for archives that are damaged or hostile.
ARCHIVE_ERRORS = (
    zipfile.BadZipFile,
    tarfile.TarError,
    zlib.error,
    lzma.LZMAError,
    EOFError,
    NotImplementedError,
    RuntimeError,  # zipfile raises it for a missing password
    ValueError,
    OverflowError,
    MemoryError,
    OSError,
    LookupError,
    struct.error,
)

Opener = Callable[[], AbstractContextManager[IO[bytes]]]


class ArchiveMember(NamedTuple):
    """One entry of an archive. `reason` says why one of kind other is not read; `open` returns the content of a file.

    `target` is where a link points to: from its own folder, or, if it is a hard link, from the top.
    """

    path: str
    kind: Literal["file", "folder", "link", "other"]
    size: int
    open: Opener
    target: str = ""
    is_hard: bool = False
    reason: str = ""


def safe_path(name: str) -> str | None:
    """Return a member's name as a printable path inside the archive; empty for its root; None where it leads out."""
    plain = name.replace("\\", "/")
    if plain.startswith("/") or plain[1:2] == ":" or ".." in plain.split("/"):
        return None
    return printable_path("/".join(part for part in plain.split("/") if part not in ("", ".")))


def error_text(error: BaseException) -> str:
    """Return what an error says, fit for a message."""
    return printable_path(" ".join(str(error).split())[:200]) or type(error).__name__
