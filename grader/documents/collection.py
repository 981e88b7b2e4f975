"""The documents of a submission as lines of text: each is read once, and Word and PDF files share one budget of time."""

import os
import re
import subprocess
import sys
import time
from collections.abc import Sequence
from fnmatch import translate
from math import ceil
from typing import NamedTuple

from grader.documents import converter
from grader.documents.evidence import stem
from grader.documents.labels import Heading, find_headings
from grader.errors import InputError
from grader.files.tree import File, Tree

MAX_SECONDS = 20.0  # for all Word and PDF files of a submission
MAX_LINES = 2000  # of one document
_TEXT_LIMIT, _DOCUMENT_LIMIT = 1024 * 1024, 32 * 1024 * 1024  # bytes
_MAX_FILES, _MAX_CONVERTED = 40, 8
_NO_ANSWERS = {"CMakeLists.txt", "requirements.txt", "LICENSE.txt", "LICENSE.md", "top_level.txt", "SOURCES.txt"}
# The beginning of a file without answers: of another format, or a report of the grader, which repeats questions and answers.
_OTHER = re.compile(
    r"\s*<(?:\?xml|!--|robot|launch|package)|(?:# )?[\d.]+ / [\d.]+ points(?:  |: )|::notice title=[\d.]+ / "
)


class Document(NamedTuple):
    """The first lines of a document and the headings among them; `is_cut` is whether there are more lines."""

    file: File
    lines: list[str]
    headings: tuple[Heading, ...]
    is_cut: bool


class DocumentCollection:
    """The documents of a submission. Each is read once; Word and PDF files share one budget of time."""

    def __init__(self, tree: Tree) -> None:
        self._tree = tree
        self._seconds = MAX_SECONDS
        self._converted = 0
        self._read_files: dict[str, Document | str | None] = {}

    def named(self, patterns: Sequence[str]) -> tuple[list[Document], list[str]]:
        """Return the documents whose names match one of the patterns, and what of them was not read, and why."""
        read: list[Document] = []
        unread: list[str] = []
        wanted = re.compile("|".join(translate(pattern.lower()) for pattern in patterns))
        files = self._tree.files.values()
        chosen = [file for file in files if file.name not in _NO_ANSWERS and wanted.match(file.name.lower())]
        for file in chosen[:_MAX_FILES]:
            if file.path not in self._read_files:
                self._read_files[file.path] = self._read(file)
            document = self._read_files[file.path]
            if isinstance(document, str):
                unread.append(document)
            elif document is not None:
                read.append(document)
                if document.is_cut:
                    unread.append(f"{file.path} after line {MAX_LINES}, the limit for a document")
        if len(chosen) > _MAX_FILES:
            unread.append(f"{len(chosen) - _MAX_FILES} documents after the first {_MAX_FILES}, the limit")
        return read, unread

    def _read(self, file: File) -> Document | str | None:
        """Return a document, the reason why it was not read, or None for a file that contains no answers."""
        try:
            text = self._text(file)
        except InputError as error:
            return str(error)
        if _OTHER.match(text):
            return None
        # Lines as git and editors count them: `splitlines` also breaks at form feeds and separators of Unicode.
        text = text.replace("\r\n", "\n").replace("\r", "\n").removesuffix("\n")
        lines = text.split("\n", MAX_LINES)
        is_cut = len(lines) > MAX_LINES
        return Document(file, lines[:MAX_LINES], find_headings(lines[:MAX_LINES], stem(file.name)), is_cut)

    def _text(self, file: File) -> str:
        match file.suffix:
            case ".docx" | ".pdf":
                return self._convert(file)
            case ".doc" | ".odt" | ".rtf" | ".pages" | ".ipynb":
                raise InputError(f"{file.path} has a format that is not supported: open it yourself")
            case _:
                data = file.read(_TEXT_LIMIT)
        if data.startswith((b"\xff\xfe", b"\xfe\xff")):
            return data.decode("utf-16", "replace")
        try:
            return data.decode("utf-8-sig")
        except UnicodeDecodeError:
            return data.decode("cp1252", "replace")

    def _convert(self, file: File) -> str:
        """Return the text of a Word or PDF file, converted by a separate process within the remaining time."""
        self._converted += 1
        if self._converted > _MAX_CONVERTED:
            limit = f"at most {_MAX_CONVERTED} Word and PDF files are"
            raise InputError(f"{file.path} was not read: {limit}; needs manual grading")
        budget = f"the Word and PDF files take longer than {MAX_SECONDS:g} s in all"
        late = InputError(f"{file.path} was not read: {budget}; needs manual grading")
        if self._seconds <= 0:
            raise late
        data = file.read(_DOCUMENT_LIMIT)
        # -P: modules are imported neither from the current folder, which may be the student's, nor from our own.
        command = [
            sys.executable,
            "-P",
            converter.__file__,
            file.suffix[1:],
            str(ceil(self._seconds)),
            str(os.getpid()),
        ]
        began = time.monotonic()
        try:  # an interruption ends the process as well
            out, err = subprocess.PIPE, subprocess.DEVNULL
            done = subprocess.run(command, input=data, stdout=out, stderr=err, timeout=self._seconds, check=False)
        except subprocess.TimeoutExpired:
            raise late from None
        except OSError:
            raise InputError(f"{file.path} could not be read on this machine: open it yourself") from None
        finally:
            self._seconds -= time.monotonic() - began
        if converter.is_out_of_time(done.returncode):
            raise late
        if done.returncode == converter.MISSING:
            raise InputError(f"{file.path} is read only with the grader's extra `documents`: open it yourself")
        if done.returncode:
            raise InputError(f"{file.path} cannot be read; it may be damaged: open it yourself")
        return done.stdout.decode("utf-8", "replace")
