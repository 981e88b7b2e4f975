"""Written answers: the passage of a document that speaks of a question. What it is worth, a person decides."""

import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from fnmatch import fnmatch
from typing import NamedTuple

from grader.errors import InputError
from grader.robot.source import Location
from grader.submission import document_text
from grader.submission.evidence import stem
from grader.submission.labels import Label, is_meant, read_label
from grader.submission.tree import File, Tree

_TEXT_LIMIT, _DOCUMENT_LIMIT = 1024 * 1024, 32 * 1024 * 1024  # bytes
_PATIENCE = 20  # seconds for a Word or PDF file
_MOST_FILES, _MOST_DOCUMENTS = 40, 8
_MOST_LINES, _MOST_TEXT = 60, 4000
_HEADING_WORDS = 6  # a label that begins a passage stands among the first words of its line
_MARKUP = re.compile(r"^[\s#>*\-_+|`]+")
# Numbers that stand for a step: 1.15, or 15) and 15. where they are no count of a short list.
_DOTTED = re.compile(r"^\(?([1-9])\.(\d{1,2})\b[.):]?\s*")
_NUMBERED = re.compile(r"^\(?([1-9]\d)[.):]\s+")
_NO_ANSWERS = frozenset(
    {"CMakeLists.txt", "requirements.txt", "LICENSE.txt", "LICENSE.md", "top_level.txt", "SOURCES.txt"}
)
# How a file begins that holds no answers: one of another kind, or a report of the grader, which repeats questions and answers.
_OTHER = re.compile(
    r"\s*<(?:\?xml|!--|robot|launch|package)|(?:# )?[\d.]+ / [\d.]+ points(?:  |: )|::notice title=[\d.]+ / "
)


class Passage(NamedTuple):
    """A piece of a document that answers a question; `location` is where it begins."""

    text: str
    location: Location


class Search(NamedTuple):
    """What looking for an answer has found: the passage, the documents that were read, and those that could not be."""

    passage: Passage | None
    read: tuple[str, ...]
    unread: tuple[str, ...]


def find_answer(tree: Tree, files: Sequence[str], places: Sequence[str]) -> Search:
    """Look for the passage about one of `places`, such as `task 1 step 15`, in the documents whose names match `files`.

    The first place that is found anywhere counts, before the others; and a passage before a heading with nothing below it.
    """
    read: list[str] = []
    unread: list[str] = []
    wanted = [read_label(place) for place in places]
    found: list[tuple[int, Passage]] = []
    for file, lines in _documents(tree, files, unread):
        read.append(file.path)
        for rank, label in enumerate(wanted):
            found += [(rank, passage) for passage in _passages(file, lines, label)]
    best = min(found, key=lambda each: (each[0], len(each[1].text.split()) <= _HEADING_WORDS), default=None)
    return Search(best[1] if best is not None else None, tuple(read), tuple(unread))


def _documents(tree: Tree, files: Sequence[str], unread: list[str]) -> Iterator[tuple[File, list[str]]]:
    chosen = [
        file
        for file in tree.files.values()
        if file.name not in _NO_ANSWERS and any(fnmatch(file.name.lower(), pattern.lower()) for pattern in files)
    ]
    documents = 0
    for file in chosen[:_MOST_FILES]:
        documents += file.suffix in (".docx", ".pdf")
        if documents > _MOST_DOCUMENTS:
            unread.append(f"{file.path}: there are more documents than are read")
            continue
        try:
            text = _text(file)
        except InputError as error:
            unread.append(str(error))
            continue
        if not _OTHER.match(text):
            yield file, _lines(text)


def _lines(text: str) -> list[str]:
    """Lines as git and editors count them: `splitlines` also breaks at form feeds and separators of Unicode."""
    return text.replace("\r\n", "\n").replace("\r", "\n").removesuffix("\n").split("\n")


def _text(file: File) -> str:
    match file.suffix:
        case ".docx" | ".pdf":
            return _converted(file, file.suffix[1:])
        case ".doc" | ".odt" | ".rtf" | ".pages" | ".ipynb":
            raise InputError(f"{file.path} is of a kind that is not read: open it yourself")
        case _:
            data = file.read(_TEXT_LIMIT)
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", "replace")


def _converted(file: File, kind: str) -> str:
    """The text of a Word or PDF file, read by a process that is stopped if it takes too long."""
    data = file.read(_DOCUMENT_LIMIT)
    # -P: neither the current folder, which may be the student's, nor our own is where modules are looked for.
    command = [sys.executable, "-P", document_text.__file__, kind]
    try:
        done = subprocess.run(command, input=data, capture_output=True, timeout=_PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        raise InputError(f"{file.path} takes too long to read: open it yourself") from None
    except OSError:
        raise InputError(f"{file.path} could not be read on this machine: open it yourself") from None
    if done.returncode == document_text.MISSING:
        raise InputError(f"{file.path} is read only with the grader's extra `documents`: open it yourself")
    if done.returncode:
        raise InputError(f"{file.path} cannot be read; it may be damaged: open it yourself")
    return done.stdout.decode("utf-8", "replace")


def _passages(file: File, lines: list[str], wanted: Label) -> Iterator[Passage]:
    """The lines from a heading about what is wanted up to the next heading; a file that is named for it is one as a whole."""
    own = read_label(stem(file.name))
    if is_meant(wanted, own):
        yield from _cut(file, lines, 0, len(lines))
        return
    task = own.task
    for index, line in enumerate(lines):
        label = _heading(line)
        if label is None:
            continue
        task = label.task if label.task is not None else task
        if is_meant(wanted, label, task):
            is_marked = line.startswith("#")
            after = range(index + 1, len(lines))
            yield from _cut(
                file, lines, index, next((at for at in after if _ends(lines[at], is_marked=is_marked)), len(lines))
            )


def _ends(line: str, *, is_marked: bool) -> bool:
    """Whether a line is the heading of another passage, not a sentence that mentions a step.

    Below a heading that is marked as one, only such a heading ends a passage, or a line that names task and step at once.
    """
    if _heading(line) is None:
        return False
    words = _words(line)
    begins = read_label(" ".join(words[:2]))
    if is_marked:
        whole = read_label(" ".join(words[:4]))
        return line.startswith("#") or (begins.task is not None and bool(whole.steps))
    return bool(begins.steps) or begins.task is not None or len(words) <= _HEADING_WORDS


def _heading(line: str) -> Label | None:
    """The label that a line begins with, if it does."""
    label = read_label(" ".join(_words(line)[:_HEADING_WORDS]))
    return label if label.steps or label.task is not None else None


def _words(line: str) -> list[str]:
    plain = _MARKUP.sub("", line)
    plain = _DOTTED.sub(r"task \1 step \2 ", plain)
    plain = _NUMBERED.sub(r"step \1 ", plain)
    return [word for word in plain.split() if any(map(str.isalnum, word))]


def _cut(file: File, lines: list[str], start: int, end: int) -> Iterator[Passage]:
    while start < end and not lines[start].strip():
        start += 1
    kept = [line.rstrip() for line in lines[start : min(end, start + _MOST_LINES)]]
    while kept and not kept[-1]:
        kept.pop()
    text = "\n".join(kept)
    if text.strip():
        is_cut = len(text) > _MOST_TEXT or end > start + _MOST_LINES
        yield Passage(text[:_MOST_TEXT] + (" [...]" if is_cut else ""), Location(file.path, start + 1, 1))
