"""Convert a Word or PDF file from standard input to text on standard output, in a separate process.

Pages and pictures are marked. A crafted file of either format can use unlimited time or memory, so
the grader stops the process after a time. The converter limits itself as well, and ends with the
process that started it, however that ends.
"""

import io
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

# Exit codes: where the package that reads the format is not installed, and for more than an answer.
MISSING = 3
TOO_LARGE = 4
MAX_PAGES = 100
PAGE_BREAK = "\f"  # a line of its own before every page but the first
# a line of its own after the text that a picture is below, or at the end of its page
PICTURE = "\ufffc"
_MAX_TEXT = 1024 * 1024
_MIN_WORDS = 2  # in a line, on average
_MAX_PLACED = 20_000  # characters of a page whose words are joined by their positions
_WEIGHT = 4.0  # of the length of texts, by which pypdf divides to get the width of a column
_MOST = 0.9  # of the characters of a page
_MAX_MEMORY = 200 * 1024 * 1024
_MAX_UNPACKED = 64 * 1024 * 1024
_MAX_ELEMENTS = 500_000  # of a Word file
_MAX_CONTENT = 16 * 1024 * 1024  # bytes of the pages of a PDF
_MAX_PIECES = 100_000  # texts on them
_PR_SET_PDEATHSIG = 1


def main() -> int:
    """Convert one document.

    Its arguments are `docx` or `pdf`, seconds of processor time, and the process id of the parent.
    """
    kind = sys.argv[1]
    seconds = float(sys.argv[2])
    _end_with_parent(int(sys.argv[3]), seconds)
    _limit(seconds)
    data = sys.stdin.buffer.read()
    try:
        output = _docx(data) if kind == "docx" else _pdf(data)
    except ImportError:
        return MISSING
    except (_TooLargeError, MemoryError):
        return TOO_LARGE
    except Exception:  # noqa: BLE001  a damaged file can raise anything
        return 1
    sys.stdout.buffer.write(output)
    return 0


def is_out_of_time(code: int) -> bool:
    """Return whether an exit code says that the converter ran out of processor time."""
    return code < 0 and code == -getattr(signal, "SIGPROF", 0)


def _end_with_parent(parent: int, seconds: float) -> None:
    """End this process when its parent has ended.

    On Linux the kernel does this; elsewhere it ends after so many seconds.
    """
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # it ended before the kernel call
            os._exit(1)
    else:
        end = threading.Timer(seconds, os._exit, (1,))
        end.daemon = True
        end.start()


def _limit(seconds: float) -> None:
    """Limit processor time and memory, where the system can."""
    with suppress(ImportError):
        import resource

        signal.setitimer(signal.ITIMER_PROF, seconds)
        limits = {
            resource.RLIMIT_CPU: (int(seconds) + 1, int(seconds) + 2),
            resource.RLIMIT_AS: (_MAX_MEMORY, _MAX_MEMORY),
            resource.RLIMIT_CORE: (0, 0),
        }
        for limit, values in limits.items():
            with suppress(ValueError, OSError):
                resource.setrlimit(limit, values)


class _TooLargeError(Exception):
    """A document has more content than any written answer."""


def _docx(data: bytes) -> bytes:
    """Return a line for each paragraph or row of a table.

    Lines also show pictures, and the page breaks that Word rendered.
    """
    lines = []
    text = ""
    after = []
    for name, paragraph, is_in_row in _elements(data):
        match name:
            case "t":
                text += _without_marks(paragraph)
            case "tab" | "tc":
                text += "\t"
            case "br" | "cr":
                text += "\n"
            case "lastRenderedPageBreak" if not text:
                lines.append(PAGE_BREAK)
            case "lastRenderedPageBreak" | "drawing" | "pict":
                after.append(PAGE_BREAK if name == "lastRenderedPageBreak" else PICTURE)
            case "p" | "tr" if not is_in_row:
                lines += [text.rstrip("\t"), *after]
                text = ""
                after = []
    return _encode("\n".join(lines))


def _elements(data: bytes) -> Iterator[tuple[str, str, bool]]:
    """Yield the name and text of each element of a Word file at its end.

    Each comes with whether it is in a row of a table.

    Copies that Word adds for older versions are omitted. Raises _TooLargeError.
    """
    from zipfile import ZipFile

    from lxml import etree

    around = {"tr": 0, "Fallback": 0}
    count = 0
    with ZipFile(io.BytesIO(data)) as archive:
        if sum(info.file_size for info in archive.infolist()) > _MAX_UNPACKED:
            raise _TooLargeError
        with archive.open("word/document.xml") as file:
            for event, element in etree.iterparse(
                file, ("start", "end"), resolve_entities=False, no_network=True
            ):
                count += event == "start"
                if count > _MAX_ELEMENTS:
                    raise _TooLargeError
                name = str(element.tag).rpartition("}")[2]
                if name in around:
                    around[name] += 1 if event == "start" else -1
                if event == "end" and not around["Fallback"]:
                    yield name, element.text or "", around["tr"] > 0
                if event == "end" and name in ("p", "tr"):
                    element.clear()


def _encode(text: str) -> bytes:
    return text[:_MAX_TEXT].encode("utf-8", "replace")


def _without_marks(text: str) -> str:
    return text.replace(PAGE_BREAK, " ").replace(PICTURE, " ")


def _pdf(data: bytes) -> bytes:
    import pypdf

    pages = pypdf.PdfReader(io.BytesIO(data)).pages
    texts = []
    size = pieces = 0
    for page in pages[:MAX_PAGES]:
        contents = page.get_contents()
        content = contents.get_data() if contents is not None else b""
        size += len(content)
        pieces += content.count(b"(") + content.count(b"<")
        if size > _MAX_CONTENT or pieces > _MAX_PIECES:
            raise _TooLargeError
        text = _without_marks(_page_text(page))
        with suppress(Exception):  # a damaged picture does not hide the text
            text += f"\n{PICTURE}" if page.images.keys() else ""
        texts.append(text)
    if len(pages) > MAX_PAGES:
        texts.append("")
    return _encode(f"\n{PAGE_BREAK}\n".join(texts))


def _page_text(page: Any) -> str:
    """Return the text of a page.

    If most lines are one word (PDFs of Google Docs), the words are joined by position.
    """
    text: str = page.extract_text()
    words = text.split()
    if (
        _MIN_WORDS * len([line for line in text.split("\n") if line.strip()]) <= len(words)
        or len(text) > _MAX_PLACED
    ):
        return text
    with suppress(Exception):  # of a crafted page, also MemoryError
        # Narrow columns keep every space between words that are placed one by one.
        placed = page.extract_text(
            extraction_mode="layout",
            layout_mode_space_vertically=False,
            layout_mode_scale_weight=_WEIGHT,
        )
        joined = "\n".join(" ".join(line.split()) for line in placed.split("\n"))
        if len("".join(joined.split())) >= _MOST * len(
            "".join(words)
        ):  # it omits rotated text and forms
            return joined
    return text


if __name__ == "__main__":
    sys.exit(main())
