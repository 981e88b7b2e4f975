"""Written answers: the passage of a document that speaks of a question. What it is worth, a person decides."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.documents.documents import Document, Documents
from grader.documents.evidence import stem
from grader.documents.labels import Label, is_meant, read_label
from grader.source import Location

_MOST_LINES, _MOST_TEXT = 60, 4000
_MOST_WORDS_OF_HEADING = 6  # a passage of no more words is a heading with nothing below it


class Passage(NamedTuple):
    """A piece of a document that answers a question; `location` is where it begins."""

    text: str
    location: Location


class Search(NamedTuple):
    """What looking for an answer has found: the passage, the documents that were read, and what of them could not be."""

    passage: Passage | None
    read: tuple[str, ...]
    unread: tuple[str, ...]


def find_answer(documents: Documents, files: Sequence[str], places: Sequence[str]) -> Search:
    """Look for the passage about one of `places`, such as `task 1 step 15`, in the documents whose names match `files`.

    The first place that is found anywhere counts, before the others; and a passage before a heading with nothing below it.
    """
    read, unread = documents.named(files)
    return Search(
        _best(read, [read_label(place) for place in places]),
        tuple(document.file.path for document in read),
        tuple(unread),
    )


def _best(documents: list[Document], wanted: list[Label]) -> Passage | None:
    best: Passage | None = None
    worth = (len(wanted), False)  # the rank of its place, and whether it is a heading only
    for document in documents:
        own = read_label(stem(document.file.name))
        for rank, label in enumerate(wanted):
            for start, end in _spans(document, own, label):
                if (rank, False) >= worth:
                    break
                passage = _cut(document, start, end)
                if passage is None:
                    continue
                found = (rank, len(passage.text.split()) <= _MOST_WORDS_OF_HEADING)
                if found < worth:
                    best, worth = passage, found
    return best


def _spans(document: Document, own: Label, wanted: Label) -> Iterator[tuple[int, int]]:
    """The lines from a heading about what is wanted up to the next heading; a file that is named for it is one as a whole."""
    if is_meant(wanted, own):
        yield 0, len(document.lines)
        return
    for heading in document.headings:
        if is_meant(wanted, heading.label, heading.task):
            yield heading.start, heading.end


def _cut(document: Document, start: int, end: int) -> Passage | None:
    lines = document.lines
    while start < end and not lines[start].strip():
        start += 1
    kept = [line.rstrip() for line in lines[start : min(end, start + _MOST_LINES)]]
    while kept and not kept[-1]:
        kept.pop()
    text = "\n".join(kept)
    if not text.strip():
        return None
    is_cut = len(text) > _MOST_TEXT or end > start + _MOST_LINES
    return Passage(text[:_MOST_TEXT] + (" [...]" if is_cut else ""), Location(document.file.path, start + 1, 1))
