"""Write archives whose bytes depend on the files in them only."""

import gzip
import io
import tarfile
import zipfile
from collections.abc import Collection, Mapping

_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time that a zip can contain
_UNIX = 3


def make_zip(files: Mapping[str, bytes], executables: Collection[str] = ()) -> bytes:
    """Return a zip of files by their paths.

    `executables` are the paths that get permission to be run.

    It has no timestamps and a fixed order. It is not compressed, because zlib's output differs
    between its versions.
    """
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for path, data in sorted(files.items()):
            entry = zipfile.ZipInfo(path, _EPOCH)
            entry.create_system = _UNIX  # else unzip ignores the permissions
            entry.external_attr = (0o100755 if path in executables else 0o100644) << 16
            archive.writestr(entry, data)
    return buffer.getvalue()


def make_tar_gz(files: Mapping[str, bytes]) -> bytes:
    """Return a tar.gz of files by their paths, as reproducible as a zip from `make_zip`."""
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for path, data in sorted(files.items()):
            entry = tarfile.TarInfo(path)
            entry.size = len(data)
            archive.addfile(entry, io.BytesIO(data))
    return gzip.compress(buffer.getvalue(), compresslevel=0, mtime=0)
