"""Decompresses what a recorder has compressed, up to a limit.

The two libraries are those of the extra `recordings`; from Python 3.14 on, it has zstd itself.
"""

import sys
from importlib import import_module
from typing import IO, Any

from grader.base.errors import RecordingError
from grader.base.text import size_text

_BLOCK = 1024 * 1024  # bytes
_ZSTD = b"\x28\xb5\x2f\xfd"
_MODULES = {
    "zstd": "compression.zstd" if sys.version_info >= (3, 14) else "backports.zstd",
    "lz4": "lz4.frame",
}


def is_zstd(data: bytes) -> bool:
    """Return whether some bytes are compressed: no message that is not begins like this."""
    return data[:4] == _ZSTD


def unpack(method: str, data: bytes, limit: int, *, is_cut: bool = False) -> bytes:
    """Return decompressed bytes, as many as there are of a file that is cut off.

    Raises RecordingError for more than a limit, unless the rest `is_cut`, and for damage.
    """
    try:
        unpacked: bytes = _decompressor(method).decompress(data, limit + 1)
    except RecordingError:
        raise
    except Exception as error:  # noqa: BLE001  each library has kinds of errors of its own
        raise _damage(method, error) from None
    if len(unpacked) > limit and not is_cut:
        raise RecordingError(f"more than {size_text(limit)} after decompression", is_limit=True)
    return unpacked[:limit]


def unpack_file(file: IO[bytes], to: IO[bytes], limit: int) -> None:
    """Decompress a file of the format zstd into another one; raises RecordingError."""
    decompressor = _decompressor("zstd")
    total = 0
    while not decompressor.eof:
        block = file.read(_BLOCK) if decompressor.needs_input else b""
        if not block and decompressor.needs_input:
            break
        try:
            unpacked = decompressor.decompress(block, _BLOCK)
        except Exception as error:  # noqa: BLE001
            raise _damage("zstd", error) from None
        total += len(unpacked)
        if total > limit:
            raise RecordingError(f"more than {size_text(limit)} after decompression", is_limit=True)
        to.write(unpacked)
    to.seek(0)


def _damage(method: str, error: Exception) -> RecordingError:
    """Return the error for what a library does not accept."""
    if isinstance(error, MemoryError):
        return RecordingError("more memory than there is", is_limit=True)
    return RecordingError(f"damaged {method}")


def _decompressor(method: str) -> Any:
    """Return a decompressor; raises RecordingError for another method, or without the library."""
    if method not in _MODULES:
        raise RecordingError(f"chunks are compressed with {method!r}", is_limit=True)
    try:
        module = import_module(_MODULES[method])
    except ImportError:
        raise RecordingError(
            f"it is compressed with {method}: install the grader with the extra `recordings`",
            is_limit=True,
        ) from None
    name = "ZstdDecompressor" if method == "zstd" else "LZ4FrameDecompressor"
    return getattr(module, name)()
