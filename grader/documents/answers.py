"""Written answers: the passage of a document about a question. A person grades it."""

from collections.abc import Sequence
from typing import NamedTuple

from grader.documents.collection import Document, DocumentCollection
from grader.documents.evidence import stem
from grader.documents.labels import Label, matches, read_label
from grader.source import Location

_MAX_LINES, _MAX_TEXT = 60, 4000
_MAX_HEADING_WORDS = 6  # a passage of so few words is a heading without a text


class Passage(NamedTuple):
    """The part of a document about a question; `location` is its beginning."""

    text: str
    location: Location


class AnswerSearch(NamedTuple):
    """The result of a search for an answer: the passage, the documents that were read, and those that were not, with reasons."""

    passage: Passage | None
    read: tuple[str, ...]
    unread: tuple[str, ...]


def find_answer(documents: DocumentCollection, files: Sequence[str], places: Sequence[str]) -> AnswerSearch:
    """Search for the passage about one of `places`, such as `task 1 step 15`, in the documents whose names match `files`.

    An earlier place wins over a later one, and for the same place a passage over a heading without a text.
    """
    read, unread = documents.named(files)
    passage = _best(read, [read_label(place) for place in places])
    return AnswerSearch(passage, tuple(document.file.path for document in read), tuple(unread))


def _best(documents: list[Document], wanted: list[Label]) -> Passage | None:
    best: Passage | None = None
    rank = (len(wanted), False)  # the index of its place, and whether it is a heading only
    for document in documents:
        own = read_label(stem(document.file.name))
        for index, label in enumerate(wanted):
            if (index, False) >= rank:
                break
            spans = [(head.start, head.end) for head in document.headings if matches(label, head.label, head.task)]
            if matches(label, own):  # the file is named for the place
                spans = [(0, len(document.lines))]
            for passage in filter(None, (_cut(document, start, end) for start, end in spans)):
                found = (index, len(passage.text.split()) <= _MAX_HEADING_WORDS)
                if found < rank:
                    best, rank = passage, found
    return best


def _cut(document: Document, start: int, end: int) -> Passage | None:
    lines = document.lines
    while start < end and not lines[start].strip():
        start += 1
    kept = [line.rstrip() for line in lines[start : min(end, start + _MAX_LINES)]]
    while kept and not kept[-1]:
        kept.pop()
    text = "\n".join(kept)
    if not text.strip():
        return None
    is_cut = len(text) > _MAX_TEXT or end > start + _MAX_LINES
    return Passage(text[:_MAX_TEXT] + (" [...]" if is_cut else ""), Location(document.file.path, start + 1, 1))
