"""A document as lines of text, with its pages and the positions of its pictures."""

from bisect import bisect_right
from typing import NamedTuple

from grader.documents import converter
from grader.documents.headings import Heading
from grader.files.tree import File

MAX_LINES = 2000  # of one document
CONVERTED = (".docx", ".pdf")  # whose text a separate process reads


class Document(NamedTuple):
    """The first lines of a document. `pages` are the indices of the first line of each page, or empty if not known.

    `limit` says what was not read of a document that is too long.
    """

    file: File
    lines: list[str]
    pages: tuple[int, ...] = ()
    limit: str = ""

    def page(self, line: int) -> int | None:
        """Return the page of a line, counted from 1, if it is known."""
        return bisect_right(self.pages, line) or None

    def has_picture(self, heading: Heading | None = None) -> bool:
        """Return whether there is a picture, below a heading or, in a PDF, on one of its pages."""
        if heading is None:
            return converter.PICTURE in self.lines
        return bool(self.pictures(heading.start, heading.end))

    def pictures(self, start: int, end: int) -> list[int]:
        """Return the numbers of the pictures between two lines, from 0; in a PDF, of the pages with these lines."""
        if self.file.suffix == ".pdf":
            first, last = self.page(start) or 1, self.page(max(start, end - 1)) or 1
            start, end = self.pages[first - 1], (*self.pages, len(self.lines))[last]
        return [number for number, index in enumerate(self._marks) if start <= index < end]

    def picture_words(self, number: int) -> str:
        """Return the location of a picture in words."""
        page = self.page(self._marks[number])
        return f"page {page} of {self.file.path}" if page else f"picture {number + 1} in {self.file.path}"

    @property
    def _marks(self) -> list[int]:
        return [index for index, line in enumerate(self.lines) if line == converter.PICTURE]


class Unread(NamedTuple):
    """A document that was not read completely, and why; the path is empty for several documents."""

    path: str
    reason: str

    def __str__(self) -> str:
        return self.reason


def made_of(file: File, text: str) -> Document:
    """Return the document that a text makes."""
    # Lines as git and editors count them: `splitlines` also breaks at form feeds and separators of Unicode.
    text = text.replace("\r\n", "\n").replace("\r", "\n").removesuffix("\n")
    lines = text.split("\n", MAX_LINES)
    limit = f"line {MAX_LINES}" if len(lines) > MAX_LINES else ""
    del lines[MAX_LINES:]
    if file.suffix not in CONVERTED or not (file.suffix == ".pdf" or converter.PAGE_BREAK in text):
        return Document(file, lines, (), limit)
    # The converter begins every page but the first with a line that is a page break.
    breaks = [index for index, line in enumerate(lines) if line == converter.PAGE_BREAK]
    if len(breaks) >= converter.MAX_PAGES:
        limit = f"page {converter.MAX_PAGES}"
    return Document(file, ["" if line == converter.PAGE_BREAK else line for line in lines], (0, *breaks), limit)
