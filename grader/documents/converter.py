"""Convert a Word or PDF file from standard input to text on standard output, in a separate process.

Pages and pictures are marked, and headings, bold paragraphs and numbered lists of Word are written as in Markdown. A
crafted file of either format can use unlimited time or memory, so the grader stops the process after a time. The
converter limits itself as well, and ends with the process that started it, however that ends.
"""

import io
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, NamedTuple

MISSING = 3  # exit code where the package that reads the format is not installed
MAX_PAGES = 100
PAGE_BREAK = "\f"  # a line of its own before every page but the first
PICTURE = "\ufffc"  # a line of its own after the text that a picture is below, or at the end of its page
MARKS = ("drawing", "pict")  # elements of Word that contain pictures
_MAX_TEXT = 1024 * 1024
_MAX_BLOCKS = 15_000  # paragraphs and tables of a Word file; python-docx takes 0.1 ms for each
_MIN_WORDS = 2  # in a line, on average
_MAX_PLACED = 20_000  # characters of a page whose words are joined by their positions
_WEIGHT = 4.0  # of the length of texts, by which pypdf divides to get the width of a column
_MOST = 0.9  # of the characters of a page
_MAX_MEMORY = 1024 * 1024 * 1024
_MAX_UNPACKED = 64 * 1024 * 1024
_PR_SET_PDEATHSIG = 1
_POLL_INTERVAL = 0.2  # seconds between two checks whether the parent is alive


def main(readers: Mapping[str, Callable[[bytes], bytes]] | None = None) -> int:
    """Convert one document. Arguments: `docx` or `pdf`, seconds of processor time, process id of the parent."""
    kind, seconds, parent = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    end_with_parent(parent, seconds)
    _limit(seconds)
    data = sys.stdin.buffer.read()
    try:
        output = (readers or {"docx": _docx, "pdf": _pdf})[kind](data)
    except ImportError:
        return MISSING
    except Exception:  # noqa: BLE001  a damaged file can raise anything
        return 1
    sys.stdout.buffer.write(output)
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


def opened(data: bytes) -> Any:
    """Return a Word document. Raises ValueError if its unpacked size exceeds the limit."""
    import zipfile

    import docx

    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if sum(info.file_size for info in archive.infolist()) > _MAX_UNPACKED:
            raise ValueError("it unpacks to more than a text document")
    return docx.Document(io.BytesIO(data))


def _docx(data: bytes) -> bytes:
    document = opened(data)
    if len(document.element.body) > _MAX_BLOCKS:
        raise ValueError("it has more paragraphs than a text document")
    lists = _Lists(document)
    lines: list[str] = []
    for block in document.iter_inner_content():  # paragraphs and tables in their order
        before, after = _marks(_element(block))
        if hasattr(block, "rows"):
            shown = ["\t".join(cell.text for cell in row.cells) for row in block.rows]
        else:
            shown = [_markdown(block, _without_marks(block.text), lists)]
        lines += [*before, *shown, *after]
    return _encode("\n".join(lines))


def _encode(text: str) -> bytes:
    return text[:_MAX_TEXT].encode("utf-8", "replace")


def _element(block: Any) -> Any:
    """Return the XML of a paragraph or table, for what python-docx has no name for."""
    return block._element  # noqa: SLF001


def _marks(element: Any) -> tuple[list[str], list[str]]:
    """Return the page breaks that Word rendered before the text; those after its beginning, and the pictures."""
    before: list[str] = []
    after: list[str] = []
    has_text = False
    for child in element.iter():
        match str(child.tag).rpartition("}")[2]:
            case "lastRenderedPageBreak":
                (after if has_text else before).append(PAGE_BREAK)
            case name if name in MARKS:
                after.append(PICTURE)
            case "t":
                has_text = has_text or bool(child.text)
    return before, after


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


class _Level(NamedTuple):
    """A level of a numbered list: what counts its items, the first number, and the text, such as `Step %1.`."""

    key: str
    first: int
    text: str


class _Lists:
    """The numbers of the items of numbered lists, which are not part of the text of a Word file."""

    def __init__(self, document: Any) -> None:
        self._counts: dict[str, dict[int, int]] = {}
        self._levels: dict[tuple[int, int], _Level | None] = {}
        self._root: Any = None
        with suppress(Exception):  # most documents have no lists
            self._root = document.part.numbering_part.element

    def number(self, paragraph: Any) -> str:
        """Return "15. " for the fifteenth item of a numbered list; empty for other paragraphs and damaged lists."""
        with suppress(Exception):
            places = (_element(paragraph).pPr, paragraph.style.element.pPr)
            found = next(place.numPr for place in places if place is not None and place.numPr is not None)
            number, depth = found.numId.val, found.ilvl.val if found.ilvl is not None else 0
            if (number, depth) not in self._levels:
                self._levels[number, depth] = self._level(number, depth)
            level = self._levels[number, depth]
            return f"{self._number_text(level, depth)} " if level is not None else ""
        return ""

    def _number_text(self, level: _Level, depth: int) -> str:
        counts = self._counts.setdefault(level.key, {})
        counts[depth] = counts.get(depth, level.first - 1) + 1
        for deeper in [other for other in counts if other > depth]:
            del counts[deeper]
        text = level.text
        for other in range(depth + 1):
            text = text.replace(f"%{other + 1}", str(counts.get(other, 1)))
        return text

    def _level(self, number: int, depth: int) -> _Level | None:
        """Return a level of a list; None if its items have no numbers."""
        (key,) = self._root.xpath(f'w:num[@w:numId="{number}"]/w:abstractNumId/@w:val')
        level = f'w:abstractNum[@w:abstractNumId="{key}"]/w:lvl[@w:ilvl="{depth}"]'
        form, text, start = (
            next(iter(self._root.xpath(f"{level}/w:{name}/@w:val")), "") for name in ("numFmt", "lvlText", "start")
        )
        again = self._root.xpath(f'w:num[@w:numId="{number}"]/w:lvlOverride[@w:ilvl="{depth}"]/w:startOverride/@w:val')
        if form != "decimal":
            return None
        return _Level(f"{key}/{number}" if again else key, int(again[0] if again else start or 1), text)


def _pdf(data: bytes) -> bytes:
    import pypdf

    pages = pypdf.PdfReader(io.BytesIO(data)).pages
    texts = []
    for page in pages[:MAX_PAGES]:
        text = _without_marks(_page_text(page))
        with suppress(Exception):  # a damaged picture does not hide the text
            text += f"\n{PICTURE}" if page.images.keys() else ""
        texts.append(text)
    if len(pages) > MAX_PAGES:
        texts.append("")
    return _encode(f"\n{PAGE_BREAK}\n".join(texts))


def _page_text(page: Any) -> str:
    """Return the text of a page; if most lines are one word (PDFs of Google Docs), the words are joined by position."""
    text: str = page.extract_text()
    words = text.split()
    if _MIN_WORDS * len([line for line in text.split("\n") if line.strip()]) <= len(words) or len(text) > _MAX_PLACED:
        return text
    with suppress(Exception):  # of a crafted page, also MemoryError
        # Narrow columns keep every space between words that are placed one by one.
        placed = page.extract_text(
            extraction_mode="layout", layout_mode_space_vertically=False, layout_mode_scale_weight=_WEIGHT
        )
        joined = "\n".join(" ".join(line.split()) for line in placed.split("\n"))
        if len("".join(joined.split())) >= _MOST * len("".join(words)):  # it omits rotated text and forms
            return joined
    return text


if __name__ == "__main__":
    sys.exit(main())
