"""The text of a Word or PDF file from standard input, on standard output: run as a process of its own, the converter.

Both formats can be made to take for ever or all of the memory, so the grader that reads a student's file only waits so long.
The converter bounds itself as well, and ends with the process that has started it, however that ends.
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
TEXT_LIMIT = 1024 * 1024
_MEMORY_LIMIT = 1024 * 1024 * 1024
_MOST_PAGES = 100
_ZIP_LIMIT = 64 * 1024 * 1024
_PR_SET_PDEATHSIG = 1
_WATCHED = 0.2  # seconds between two looks at whether the parent still lives


def main() -> int:
    """Read one document. Arguments: `docx` or `pdf`, the seconds of processor time, the process id of the parent."""
    kind, seconds, parent = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    end_with_parent(parent, seconds)
    _limit(seconds)
    readers: dict[str, Callable[[bytes], str]] = {"docx": _docx, "pdf": _pdf}
    data = sys.stdin.buffer.read()
    try:
        text = readers[kind](data)
    except ImportError:
        return MISSING
    except Exception:  # noqa: BLE001  whatever a damaged file brings about
        return 1
    sys.stdout.buffer.write(text[:TEXT_LIMIT].encode("utf-8", "replace"))
    return 0


def is_out_of_time(code: int) -> bool:
    """Return whether an exit code says that the converter has used up its processor time."""
    return code < 0 and code == -getattr(signal, "SIGXCPU", 0)


def end_with_parent(parent: int, seconds: int) -> None:
    """End this process when its parent has ended: by the kernel on Linux, by a thread elsewhere.

    The thread sees nothing of the parent on Windows, where it only ends the process after so many seconds.
    """
    if not _has_death_signal():
        threading.Thread(target=_watch, args=(parent, seconds), daemon=True).start()
    if os.name != "nt" and os.getppid() != parent:  # it ended before the kernel was told
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
        time.sleep(_WATCHED)
    os._exit(1)


def _limit(seconds: int) -> None:
    """Bound processor time and memory, where the system can."""
    with suppress(ImportError):
        import resource

        limits = {
            resource.RLIMIT_CPU: (seconds, seconds + 1),
            resource.RLIMIT_AS: (_MEMORY_LIMIT, _MEMORY_LIMIT),
            resource.RLIMIT_CORE: (0, 0),
        }
        for limit, values in limits.items():
            with suppress(ValueError, OSError):
                resource.setrlimit(limit, values)


def _docx(data: bytes) -> str:
    import zipfile

    import docx

    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if sum(info.file_size for info in archive.infolist()) > _ZIP_LIMIT:
            raise ValueError("it unpacks to far more than a text")
    document = docx.Document(io.BytesIO(data))
    lines: list[str] = []
    for block in document.iter_inner_content():  # paragraphs and tables as they stand
        if hasattr(block, "rows"):
            lines += ["\t".join(cell.text for cell in row.cells) for row in block.rows]
        else:
            lines.append(block.text)
    return "\n".join(lines)


def _pdf(data: bytes) -> str:
    import pypdf

    reader = pypdf.PdfReader(io.BytesIO(data))
    return "\n".join(page.extract_text() for page in reader.pages[:_MOST_PAGES])


if __name__ == "__main__":
    sys.exit(main())
