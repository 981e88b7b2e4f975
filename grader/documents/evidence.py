"""Pictures and other evidence in a submission: found by name or headings in documents, and described, never graded."""

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

from grader.documents.collection import DocumentCollection
from grader.documents.document import Document
from grader.documents.headings import Heading
from grader.documents.image_size import image_size
from grader.documents.labels import Label, matches, read_label, stem
from grader.errors import InputError
from grader.files.tree import File, Tree
from grader.names import closest

_PICTURES = frozenset({".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".heic", ".svg"})
_EVIDENCE = _PICTURES | {".pdf", ".mp4", ".mov", ".webm", ".mkv", ".avi"}
DOCUMENTS = ("*.pdf", "*.docx")  # which may have evidence below their headings
_COPY = re.compile(r"(?<=\d)\s*\(\d{1,3}\)$")  # the number of a copy: Task1_Step8 (1).png
_PRELAB = re.compile(r"(?<![^\W\d_])pre[\W_]?lab", re.IGNORECASE)  # work before the lab, which has no evidence of it
_MAX_HEADER = 256 * 1024  # bytes in which the size of a picture is found
_MAX_OPENED = 50  # files at once whose dimensions are read
_MAX_SHOWN = 60  # characters of a heading


@dataclass(frozen=True, slots=True)
class Exhibit:
    """One file of evidence: its size in bytes, and width and height of a picture in pixels, if they are known.

    Of evidence inside a document, `heading` is what it is below, and `page` where that is, if it is known.
    """

    path: str
    size: int
    width: int | None = None
    height: int | None = None
    heading: str = ""
    page: int | None = None

    @property
    def words(self) -> str:
        """The file with its dimensions and size, or the heading and page in it, for a message."""
        if self.heading:
            return f"{self.heading}{f', page {self.page} of' if self.page else ' in'} {self.path}"
        dimensions = f"{self.width} x {self.height} pixels, " if self.width else ""
        size = f"{self.size / 1e6:.1f} MB" if self.size >= 1e6 else f"{self.size / 1e3:.0f} kB"
        return f"{self.path} ({dimensions}{size if self.size >= 1000 else f'{self.size} bytes'})"


class Proof(NamedTuple):
    """A picture, video or PDF, and the task and step that its path names: as it is written, and read loosely."""

    file: File
    label: Label
    loose: Label


class FoundEvidence(NamedTuple):
    """The files of a piece of evidence, and those that may be meant, but are not certain."""

    files: tuple[Exhibit, ...]
    possible: tuple[Exhibit, ...] = ()


def read_proofs(tree: Tree) -> tuple[Proof, ...]:
    """Return every picture, video and PDF of a submission, with its labels."""
    return tuple(_proof(file) for file in tree.files.values() if file.suffix in _EVIDENCE)


def find_evidence(
    proofs: Sequence[Proof], names: Sequence[str], documents: DocumentCollection | None = None
) -> FoundEvidence:
    """Return the evidence that one of these names labels: `task 1 step 8`, or plain words such as `webcam`.

    Files with the label come first. Without one, files count that have a misspelt label with task and step, and
    headings of Word and PDF files with a picture below them. Not certain are labels without a task, headings without a
    picture, and documents that were not read or have pictures without headings.
    """
    wanted = [read_label(name) for name in names]
    exact = [proof for proof in proofs if _is_labelled(proof, wanted)]
    if exact:
        return FoundEvidence(describe(exact))
    others = [proof for proof in proofs if not proof.label.is_complete]
    meant = [proof for proof in others if _is_misspelt(proof, wanted)]
    perhaps = [proof for proof in others if proof not in meant and _may_be_meant(proof, wanted)]
    inside = [*_below_headings(documents, wanted)]
    certain = tuple(exhibit for exhibit, is_certain in inside if is_certain)
    if meant or certain:
        return FoundEvidence((*describe(meant), *certain))
    whole = _described(_whole_documents(documents), {proof.file.path for proof in perhaps})
    return FoundEvidence((), (*describe(perhaps), *(it for it, _ in inside), *whole))


def _described(files: Iterable[File], listed: Collection[str]) -> Iterator[Exhibit]:
    return (Exhibit(file.path, file.size) for file in files if file.path not in listed)


def _is_labelled(proof: Proof, wanted: Sequence[Label]) -> bool:
    return any(matches(label, proof.label) for label in wanted)


def _is_misspelt(proof: Proof, wanted: Sequence[Label]) -> bool:
    return proof.loose.is_complete and any(matches(label, proof.loose) for label in wanted)


def find_all_evidence(
    proofs: Sequence[Proof], names: Sequence[Sequence[str]], documents: DocumentCollection | None
) -> list[FoundEvidence]:
    """Return the evidence for each of several lists of names.

    A file is perhaps meant for one of them, the first without a file, unless its headings name several or it could not
    be read. A file that names another step is perhaps meant for the nearest step of its task without a file.
    """
    found = [find_evidence(proofs, one, documents) for one in names]
    claimed = {exhibit.path for one in found for exhibit in one.files}
    unread = {it.path for it in documents.named(DOCUMENTS)[1]} if documents is not None else set()
    for index, one in enumerate(found):
        perhaps = tuple(exhibit for exhibit in one.possible if exhibit.heading or exhibit.path not in claimed - unread)
        claimed |= {exhibit.path for exhibit in perhaps}
        found[index] = FoundEvidence(one.files, perhaps)
    without = [index for index, one in enumerate(found) if not one.files]
    steps = [(label, index) for index in without for label in map(read_label, names[index]) if label.is_complete]
    for proof in proofs:
        near = _nearest(proof.loose, steps) if proof.file.path not in claimed else None
        if near is not None:
            found[near] = FoundEvidence((), (*found[near].possible, *describe([proof])))
    return found


def _nearest(wanted: Label, steps: Sequence[tuple[Label, int]]) -> int | None:
    """Return what belongs to the nearest step of the same task; None if there is none of it, or no step is wanted."""
    if not wanted.is_complete:
        return None
    distances = [(abs(min(it.steps) - min(wanted.steps)), index) for it, index in steps if it.task == wanted.task]
    return min(distances)[1] if distances else None


def describe(proofs: Sequence[Proof]) -> tuple[Exhibit, ...]:
    """Describe files of evidence; of many files, only the first with their dimensions."""
    return tuple(_exhibit(proof.file, is_opened=index < _MAX_OPENED) for index, proof in enumerate(proofs))


def _proof(file: File) -> Proof:
    name = _COPY.sub("", stem(file.path))
    label = read_label(name)
    return Proof(file, label, label if label.is_complete else read_label(name, loosely=True))


def _may_be_meant(proof: Proof, wanted: Sequence[Label]) -> bool:
    return any(_may_match(label, proof) for label in wanted)


def _may_match(wanted: Label, proof: Proof) -> bool:
    """Return whether a file may be meant: it names the step without a task, or a word that is misspelt."""
    if wanted.steps:
        return proof.loose.task is None and wanted.steps <= proof.loose.steps
    is_word = wanted.task is None and len(wanted.words) == 1
    return is_word and any(closest(word, wanted.words) for word in proof.label.words if len(word) > 3)


def headed(documents: DocumentCollection, names: Sequence[str]) -> list[tuple[Document, Heading]]:
    """Return the headings of documents with the first of these labels that occurs."""
    return [(document, head) for document, head, _ in _headed(documents, [read_label(name) for name in names])]


def _headed(documents: DocumentCollection, wanted: Sequence[Label]) -> list[tuple[Document, Heading, Label]]:
    read, _ = documents.named(DOCUMENTS)
    heads = [(document, head) for document in read for head in _step_headings(documents, document)]
    found = ([(document, head, label) for document, head in heads if _is_about(label, head)] for label in wanted)
    return next(filter(None, found), [])


def _below_headings(documents: DocumentCollection | None, wanted: Sequence[Label]) -> Iterator[tuple[Exhibit, bool]]:
    """Yield the headings of documents with the first of the labels that occurs, and whether each is certain."""
    for document, head, label in _headed(documents, wanted) if documents is not None else ():
        yield _below(document, head), _is_certain(label, document, head)


def _whole_documents(documents: DocumentCollection | None) -> Iterator[File]:
    """Yield the documents that may hold any evidence: those not read, and those with pictures without headings.

    A pre-lab has none.
    """
    if documents is not None:
        yield from (file for file in _without_headings(documents) if not _PRELAB.search(file.path))


def _without_headings(documents: DocumentCollection) -> Iterator[File]:
    read, unread = documents.named(DOCUMENTS)
    for document in read:
        has_steps = any(head.label.steps for head in _step_headings(documents, document))
        if document.has_picture() and not has_steps and not read_label(stem(document.file.path)).is_complete:
            yield document.file
    yield from (documents.tree.files[it.path] for it in unread if it.path)


def _step_headings(documents: DocumentCollection, document: Document) -> list[Heading]:
    return [head for head in documents.headings(document) if not (head.is_mention or head.is_item or head.pattern)]


def _is_certain(wanted: Label, document: Document, head: Heading) -> bool:
    """Return whether a picture is below a heading that names a step in words: "18." may be a line of the handout."""
    names = read_label(head.text[:_MAX_SHOWN])
    is_named = bool(names.steps) or names.task is not None or not (wanted.steps or wanted.task is not None)
    return is_named and document.has_picture(head)


def _is_about(wanted: Label, head: Heading) -> bool:
    if not wanted.steps and wanted.task is None:  # plain words, in a line that is marked as a heading
        return bool(head.level) and matches(wanted, read_label(head.text))
    return matches(wanted, head.label, head.task)


def _below(document: Document, head: Heading) -> Exhibit:
    text = " ".join(head.text.split())
    shown = text if len(text) <= _MAX_SHOWN else f"{text[: _MAX_SHOWN - 3]}..."
    file = document.file
    return Exhibit(file.path, file.size, heading=shown, page=document.page(head.start))


def _exhibit(file: File, *, is_opened: bool) -> Exhibit:
    size = None
    if is_opened and file.suffix in _PICTURES:
        with suppress(InputError):
            size = image_size(file.read(_MAX_HEADER, first=True))
    return Exhibit(file.path, file.size, *(size or (None, None)))
