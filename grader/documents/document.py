"""A document as lines of text, with its pages and marks for its pictures."""

from bisect import bisect_right
from typing import NamedTuple

from grader.documents import converter
from grader.documents.headings import Heading
from grader.files.tree import File
from grader.source import Location

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

    def has_picture(self, start: int = 0, end: int | None = None) -> bool:
        """Return whether there is a picture between two lines; in a PDF, on the pages with these lines."""
        if self.file.suffix == ".pdf" and end is not None:
            first, last = self.page(start) or 1, self.page(max(start, end - 1)) or 1
            start, end = self.pages[first - 1], (*self.pages, len(self.lines))[last]
        return converter.PICTURE in self.lines[start:end]


class Passage(NamedTuple):
    """The part of a document below a heading; `location` is its beginning, and `where` says it for a person.

    `how` says why this is the passage, unless it is headed by the task and step. If that is not certain, it may belong
    to another question. It is empty if it holds only the question.
    """

    text: str
    location: Location
    where: str
    head: Heading
    how: str = ""
    is_certain: bool = True
    is_empty: bool = False


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
