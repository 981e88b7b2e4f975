"""Convert a Word or PDF file from standard input to text on standard output, in a separate process.

Pages and pictures are marked, and headings, bold paragraphs and numbered lists of Word are written as in Markdown.
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
from typing import Any

MISSING = 3  # exit code where the package that reads the format is not installed
MAX_PAGES = 100
PAGE_BREAK = "\f"  # a line of its own before every page but the first
PICTURE = "\ufffc"  # a line of its own after the text that a picture is below, or at the end of its page
_MAX_TEXT = 1024 * 1024
_MAX_MEMORY = 1024 * 1024 * 1024
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
    sys.stdout.buffer.write(text[:_MAX_TEXT].encode("utf-8", "replace"))
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
    lists = _Lists(document)
    lines: list[str] = []
    for block in document.iter_inner_content():  # paragraphs and tables in their order
        marks = _marks(_element(block))
        if hasattr(block, "rows"):
            lines += ["\t".join(cell.text for cell in row.cells) for row in block.rows]
            lines += marks
        else:
            is_top = PAGE_BREAK in marks and not _has_text_before_break(_element(block))
            head = marks[: marks.index(PAGE_BREAK) + 1] if is_top else []
            lines += [*head, _markdown(block, _without_marks(block.text), lists), *marks[len(head) :]]
    return "\n".join(lines)


def _element(block: Any) -> Any:
    """Return the XML of a paragraph or table, for what python-docx has no name for."""
    return block._element  # noqa: SLF001


def _marks(element: Any) -> list[str]:
    """Return the breaks between pages that Word has rendered, and the pictures, in their order."""
    marks = {"lastRenderedPageBreak": PAGE_BREAK, "drawing": PICTURE, "pict": PICTURE}
    names = (str(child.tag).rpartition("}")[2] for child in element.iter())
    return [marks[name] for name in names if name in marks]


def _has_text_before_break(paragraph: Any) -> bool:
    for child in paragraph.iter():
        match str(child.tag).rpartition("}")[2]:
            case "lastRenderedPageBreak":
                return False
            case "t" if child.text:
                return True
    return False


def _without_marks(text: str) -> str:
    return text.replace(PAGE_BREAK, " ").replace(PICTURE, " ")


def _markdown(paragraph: Any, text: str, lists: "_Lists") -> str:
    """Return a paragraph with the mark of its style: a heading, an item of a numbered list, or bold."""
    if not text.strip():
        return str(text)
    style = (paragraph.style.name or "").lower().split() if paragraph.style is not None else []
    if style[:1] == ["heading"] and style[-1].isdecimal():
        return f"{'#' * min(6, int(style[-1]))} {lists.number(paragraph)}{text}"
    is_bold = all(run.bold for run in paragraph.runs if run.text.strip())
    return f"{lists.number(paragraph)}{f'**{text}**' if is_bold and paragraph.runs else text}"


class _Lists:
    """The numbers of the items of numbered lists, which are not part of the text of a Word file."""

    def __init__(self, document: Any) -> None:
        from docx.oxml.ns import qn

        self._qn = qn
        self._counts: dict[tuple[str, str], int] = {}
        self._abstract: dict[str, Any] = {}
        self._lists: dict[str, Any] = {}
        with suppress(Exception):  # most documents have no lists
            root = document.part.numbering_part.element
            self._abstract = {item.get(qn("w:abstractNumId")): item for item in root.findall(qn("w:abstractNum"))}
            self._lists = {item.get(qn("w:numId")): item for item in root.findall(qn("w:num"))}

    def number(self, paragraph: Any) -> str:
        """Return "15. " for the fifteenth item of a numbered list; empty for other paragraphs."""
        own, style = _element(paragraph).pPr, paragraph.style
        found = own.numPr if own is not None else None
        if found is None and style is not None and style.element.pPr is not None:
            found = style.element.pPr.numPr
        if found is None or found.numId is None:
            return ""
        level = str(found.ilvl.val if found.ilvl is not None else 0)
        form, start, key = self._level(str(found.numId.val), level)
        if form != "decimal":
            return ""
        count = self._counts.get((key, level), start - 1) + 1
        self._counts = {place: n for place, n in self._counts.items() if place[0] != key or place[1] < level}
        self._counts[key, level] = count
        return f"{count}. "

    def _level(self, name: str, level: str) -> tuple[str, int, str]:
        """Return the number format and the first number of a level of a list, and what counts its items."""
        qn, item = self._qn, self._lists.get(name)
        if item is None:
            return "", 1, name
        key = item.find(qn("w:abstractNumId")).get(qn("w:val"))
        levels = {it.get(qn("w:ilvl")): it for it in self._abstract[key].findall(qn("w:lvl"))}
        if level not in levels:
            return "", 1, name
        form, start = levels[level].find(qn("w:numFmt")), levels[level].find(qn("w:start"))
        first = int(start.get(qn("w:val"))) if start is not None else 1
        for override in item.findall(f"{qn('w:lvlOverride')}/{qn('w:startOverride')}"):
            first, key = int(override.get(qn("w:val"))), f"{key}/{name}"  # a list that begins anew
        return form.get(qn("w:val")) if form is not None else "decimal", first, key


def _pdf(data: bytes) -> str:
    import pypdf

    pages = pypdf.PdfReader(io.BytesIO(data)).pages
    texts = []
    for page in pages[:MAX_PAGES]:
        text = _without_marks(page.extract_text())
        with suppress(Exception):  # a damaged picture does not hide the text
            text += f"\n{PICTURE}" if page.images.keys() else ""
        texts.append(text)
    if len(pages) > MAX_PAGES:
        texts.append("")
    return f"\n{PAGE_BREAK}\n".join(texts)


if __name__ == "__main__":
    sys.exit(main())
