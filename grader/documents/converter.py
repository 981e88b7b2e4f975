"""Convert a Word or PDF file from standard input to text on standard output, in a separate process.

A crafted file of either format can use unlimited time or memory, so the grader stops the process after a time. The converter
limits itself as well, and ends with the process that started it, however that ends.
"""

import io
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress

MISSING = 3  # exit code where the package that reads the format is not installed
MAX_TEXT = 1024 * 1024
_MAX_MEMORY = 1024 * 1024 * 1024
_MAX_PAGES = 100
_MAX_UNPACKED = 64 * 1024 * 1024
_PR_SET_PDEATHSIG = 1
_POLL_INTERVAL = 0.2  # seconds between two checks whether the parent is alive


def main() -> int:
    """Convert one document. Arguments: `docx` or `pdf`, seconds of processor time, process id of the parent."""
    kind, seconds, parent = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    end_with_parent(parent, seconds)
    _limit(seconds)
    readers: dict[str, Callable[[bytes], str]] = {"docx": _docx, "pdf": _pdf}
    data = sys.stdin.buffer.read()
    try:
        text = readers[kind](data)
    except ImportError:
        return MISSING
    except Exception:  # noqa: BLE001  a damaged file can raise anything
        return 1
    sys.stdout.buffer.write(text[:MAX_TEXT].encode("utf-8", "replace"))
    return 0


def is_out_of_time(code: int) -> bool:
    """Return whether an exit code says that the converter has reached its limit of processor time."""
    return code < 0 and code == -getattr(signal, "SIGXCPU", 0)


def end_with_parent(parent: int, seconds: int) -> None:
    """End this process when its parent has ended: by the kernel on Linux, by a thread elsewhere.

    On Windows the thread cannot see the parent: there it ends the process after so many seconds.
    """
    if not _has_death_signal():
        threading.Thread(target=_watch, args=(parent, seconds), daemon=True).start()
    if os.name != "nt" and os.getppid() != parent:  # it ended before the kernel call
        os._exit(1)


def _has_death_signal() -> bool:
    if sys.platform != "linux":
        return False
    import ctypes

    done: int = ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    return done == 0


def _watch(parent: int, seconds: int) -> None:
    end = time.monotonic() + seconds
    while (os.name == "nt" or os.getppid() == parent) and time.monotonic() < end:
        time.sleep(_POLL_INTERVAL)
    os._exit(1)


def _limit(seconds: int) -> None:
    """Limit processor time and memory, where the system can."""
    with suppress(ImportError):
        import resource

        limits = {
            resource.RLIMIT_CPU: (seconds, seconds + 1),
            resource.RLIMIT_AS: (_MAX_MEMORY, _MAX_MEMORY),
            resource.RLIMIT_CORE: (0, 0),
        }
        for limit, values in limits.items():
            with suppress(ValueError, OSError):
                resource.setrlimit(limit, values)


def _docx(data: bytes) -> str:
    import zipfile

    import docx

    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if sum(info.file_size for info in archive.infolist()) > _MAX_UNPACKED:
            raise ValueError("it unpacks to more than a text document")
    document = docx.Document(io.BytesIO(data))
    lines: list[str] = []
    for block in document.iter_inner_content():  # paragraphs and tables in their order
        if hasattr(block, "rows"):
            lines += ["\t".join(cell.text for cell in row.cells) for row in block.rows]
        else:
            lines.append(block.text)
    return "\n".join(lines)


def _pdf(data: bytes) -> str:
    import pypdf

    reader = pypdf.PdfReader(io.BytesIO(data))
    return "\n".join(page.extract_text() for page in reader.pages[:_MAX_PAGES])


if __name__ == "__main__":
    sys.exit(main())
