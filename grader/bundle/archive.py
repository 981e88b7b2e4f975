"""A zip of which every byte follows from the files in it: no clock, no order of the disk, no compression.

How bytes are compressed differs between versions of zlib, and a megabyte is uploaded in a moment.
"""

import io
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass

_NO_TIME = (1980, 1, 1, 0, 0, 0)  # the earliest that a zip can hold
_UNIX = 3


@dataclass(frozen=True, slots=True)
class Member:
    """A file of an archive: its bytes, and whether it can be run."""

    data: bytes
    is_program: bool = False


def zip_of(members: Mapping[str, Member]) -> bytes:
    """The bytes of a zip with these files, by their paths in it."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for path, member in sorted(members.items()):
            entry = zipfile.ZipInfo(path, _NO_TIME)
            entry.create_system = _UNIX  # else its permissions are not looked at
            entry.external_attr = (0o100755 if member.is_program else 0o100644) << 16
            archive.writestr(entry, member.data)
    return buffer.getvalue()
