"""The documents of a submission as lines of text, with their pages and marks for their pictures.

Each is read once, and Word and PDF files share one time limit.
"""

import os
import re
import subprocess
import sys
from bisect import bisect_right
from collections.abc import Collection, Sequence
from fnmatch import translate
from functools import lru_cache
from types import MappingProxyType

from grader.base.errors import InputError, MachineError
from grader.base.grouping import Strings, StringsByName
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.files.tree import File, Tree
from grader.lab.documents import converter
from grader.lab.documents.headings import Heading, Pattern, find_headings, stem

MAX_LINES = 2000  # of one document
CONVERTED = (".docx", ".pdf")  # whose text a separate process reads
MAX_SECONDS = 3.0  # of processor time, for all Word and PDF files of a submission
_WAITING = 10  # a converter ends after this many times its limit, also if it waits for something
_TEXT_LIMIT, _DOCUMENT_LIMIT = 1024 * 1024, 32 * 1024 * 1024  # bytes
_MAX_FILES = 40
_MAX_CONVERTED = 8
_NO_ANSWERS = {
    "CMakeLists.txt",
    "requirements.txt",
    "LICENSE.txt",
    "LICENSE.md",
    "top_level.txt",
    "SOURCES.txt",
}
# The beginning of a file without answers: of another format, or a report of the grader, which
# repeats questions and answers.
_OTHER = on_use(
    r"\s*<(?:\?xml|!--|robot|launch|package)"  # XML with the ending .txt
    # "lab6: my_robot.urdf" and "24.5 of 30 points: ...", or the grade, below it: the report as text
    # and in Markdown
    r"|(?:# )?\S+: [^\n]*\n\s*(?:\*\*)?(?:All automatic checks passed: |No mistakes found: )?"
    r"[\d.]+ (?:of|/) [\d.]+ points?\b"
    r"|::notice title=[\d.]+ / "  # the report for GitHub Actions
)


class TextDocument(Named):
    """The first lines of a document."""

    file: File
    lines: list[str]
    pages: tuple[int, ...] = ()  # the indices of the first line of each page; empty if not known
    limit: str = ""  # what was not read of a document that is too long

    def page(self, line: int) -> int | None:
        """Return the page of a line, counted from 1, if it is known."""
        return bisect_right(self.pages, line) or None

    def has_picture(self, start: int = 0, end: int | None = None) -> bool:
        """Return whether there is a picture between two lines.

        In a PDF, it may be anywhere on the pages with these lines.
        """
        if self.file.suffix == ".pdf" and end is not None:
            first = self.page(start) or 1
            last = self.page(max(start, end - 1)) or 1
            start = self.pages[first - 1]
            end = self.pages[last] if last < len(self.pages) else len(self.lines)
        return converter.PICTURE in self.lines[start:end]


class Passage(Named):
    """The part of a document below a heading."""

    text: str
    location: Location  # of its beginning
    where: str  # the location for a person
    head: Heading
    how: str = ""  # why this is the passage, unless it is headed by the task and step
    is_certain: bool = True  # False where it may belong to another question
    is_empty: bool = False  # whether it holds only the question


class _Unread(Named):
    """A document that was not read completely, and why; the path is empty for several documents."""

    path: str
    reason: str

    def __str__(self) -> str:
        return self.reason


_ReadDocument = TextDocument | _Unread | None


_FoundDocuments = tuple[list[TextDocument], list[_Unread]]  # those that are read, and the others


class DocumentCollection:
    """The documents of a submission.

    Each is read once; Word and PDF files share one budget of time.

    `converted` are the texts of Word and PDF files by path; those that are given are not read
    again.
    """

    def __init__(self, tree: Tree, converted: StringsByName = MappingProxyType({})) -> None:
        self.tree = tree
        self.converted = dict(converted)
        self._seconds = MAX_SECONDS
        self._converted = 0
        self._read_files: dict[str, _ReadDocument] = {}
        self._named: dict[Strings, _FoundDocuments] = {}
        self._headings: dict[tuple[str, frozenset[Pattern]], tuple[Heading, ...]] = {}

    def headings(
        self, document: TextDocument, patterns: Collection[Pattern] = ()
    ) -> tuple[Heading, ...]:
        """Return the headings of a document.

        `patterns` are the words of headings besides the usual ones.
        """
        key = (document.file.path, frozenset(patterns))
        if key not in self._headings:
            self._headings[key] = find_headings(
                document.lines, stem(document.file.name), sorted(key[1])
            )
        return self._headings[key]

    @property
    def read(self) -> Strings:
        """The paths of the documents that were read."""
        return tuple(
            path
            for path, read_document in self._read_files.items()
            if isinstance(read_document, TextDocument)
        )

    def named(self, patterns: Sequence[str]) -> _FoundDocuments:
        """Return the documents whose names match one of the patterns.

        Also return what of them was not read, and why.
        """
        key = tuple(patterns)
        if key not in self._named:
            self._named[key] = self._find(key)
        return self._named[key]

    def _find(self, patterns: Strings) -> _FoundDocuments:
        read = []
        unread = []
        matching = _names_like(patterns)
        files = self.tree.files.values()
        chosen = [
            file
            for file in files
            if file.name not in _NO_ANSWERS and matching.match(file.name.lower())
        ]
        for file in chosen[:_MAX_FILES]:
            document = self.document(file)
            if isinstance(document, _Unread):
                unread.append(document)
            elif document:
                read.append(document)
                if document.limit:
                    unread.append(
                        _Unread(
                            file.path,
                            f"{file.path} after {document.limit}, the limit for a document",
                        )
                    )
        if len(chosen) > _MAX_FILES:
            rest = f"{len(chosen) - _MAX_FILES} documents after the first {_MAX_FILES}, the limit"
            unread.append(_Unread("", rest))
        return read, unread

    def document(self, file: File) -> _ReadDocument:
        """Return a document, or the reason why it was not read.

        It is None for a file that contains no answers.
        """
        if file.path not in self._read_files:
            self._read_files[file.path] = self._read_document(file)
        return self._read_files[file.path]

    def _read_document(self, file: File) -> _ReadDocument:
        try:
            text = self._text(file)
        except InputError as error:
            return _Unread(file.path, str(error))
        if _OTHER.match(text):
            return None
        return _make_document(file, text)

    def _text(self, file: File) -> str:
        match file.suffix:
            case suffix if suffix in CONVERTED:
                self._converted += 1
                if self._converted > _MAX_CONVERTED:
                    limit = f"at most {_MAX_CONVERTED} Word and PDF files are"
                    raise InputError(f"{file.path} was not read: {limit}; needs manual grading")
                if file.path not in self.converted:
                    self.converted[file.path] = self._convert(file).decode("utf-8", "replace")
                return self.converted[file.path]
            case ".doc" | ".odt" | ".rtf" | ".pages" | ".ipynb" | ".pptx" | ".odp":
                raise InputError(
                    f"{file.path} has a format that is not supported: open it yourself"
                )
            case _:
                data = file.read(_TEXT_LIMIT)
        if data.startswith((b"\xff\xfe", b"\xfe\xff")):
            return data.decode("utf-16", "replace")
        try:
            return data.decode("utf-8-sig")
        except UnicodeDecodeError:
            return data.decode("cp1252", "replace")

    def _convert(self, file: File) -> bytes:
        """Return the text of a Word or PDF file.

        It comes from a separate process within the remaining time.
        """
        budget = f"the Word and PDF files take longer than {MAX_SECONDS:g} s in all"
        late = InputError(f"{file.path} was not read: {budget}; needs manual grading")
        if self._seconds <= 0:
            raise late
        data = file.read(_DOCUMENT_LIMIT)
        # -P: modules are imported neither from the current folder, which may be the student's, nor
        # from our own.
        limits = str(self._seconds), str(os.getpid())
        command = [sys.executable, "-P", str(converter.__file__), file.suffix[1:], *limits]
        began = _time_of_converters()
        try:  # an interruption ends the process as well
            code, output = self._run(command, data)
        except subprocess.TimeoutExpired:
            self._seconds = 0.0
            raise late from None
        except OSError as error:
            MachineError.check(error, file.path)
            raise InputError(
                f"{file.path} could not be read on this machine: open it yourself"
            ) from None
        finally:
            self._seconds -= _time_of_converters() - began
        if converter.is_out_of_time(code):
            self._seconds = 0.0
            raise late
        if code == converter.TOO_LARGE:
            raise InputError(
                f"{file.path} was not read: it has far more content than an answer; needs manual "
                "grading"
            )
        if code == converter.MISSING:
            raise InputError(
                f"{file.path} is read only with the grader's extra `documents`: open it yourself"
            )
        if code:
            raise InputError(f"{file.path} cannot be read; it may be damaged: open it yourself")
        return output

    def _run(self, command: list[str], data: bytes) -> tuple[int, bytes]:
        """Return the exit code and the output of a converter."""
        from tempfile import TemporaryFile  # late: few documents are converted

        with (
            TemporaryFile() as file
        ):  # not a pipe: after a timeout, `communicate` would not write the rest into it
            file.write(data)
            file.seek(0)
            done = subprocess.run(
                command,
                stdin=file,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                timeout=_WAITING * self._seconds,
                check=False,
            )
        return done.returncode, done.stdout


def _time_of_converters() -> float:
    """Return the processor time of the processes that have ended, in seconds.

    On Windows it is the time of the clock.
    """
    times = os.times()
    if sys.platform == "win32":
        return times.elapsed
    return times.children_user + times.children_system


def _make_document(file: File, text: str) -> TextDocument:
    """Return the document that a text makes."""
    # Lines as git and editors count them: `splitlines` also breaks at form feeds and separators of
    # Unicode.
    text = text.replace("\r\n", "\n").replace("\r", "\n").removesuffix("\n")
    lines = text.split("\n", MAX_LINES)
    limit = f"line {MAX_LINES}" if len(lines) > MAX_LINES else ""
    del lines[MAX_LINES:]
    if file.suffix not in CONVERTED or not (file.suffix == ".pdf" or converter.PAGE_BREAK in text):
        return TextDocument(file, lines, (), limit)
    # The converter begins every page but the first with a line that is a page break.
    breaks = [index for index, line in enumerate(lines) if line == converter.PAGE_BREAK]
    if len(breaks) >= converter.MAX_PAGES:
        limit = f"page {converter.MAX_PAGES}"
    return TextDocument(
        file, ["" if line == converter.PAGE_BREAK else line for line in lines], (0, *breaks), limit
    )


@lru_cache(maxsize=256)
def _names_like(patterns: Strings) -> re.Pattern[str]:
    """Return what matches names in lower case: translated once a rubric, not once a submission."""
    return re.compile("|".join(translate(pattern.lower()) for pattern in patterns))
