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
from grader.text import cut

_PICTURES = frozenset({".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".heic", ".svg"})
_EVIDENCE = _PICTURES | {".pdf", ".mp4", ".mov", ".webm", ".mkv", ".avi"}
DOCUMENTS = ("*.pdf", "*.docx")  # which may have evidence below their headings
_COPY = re.compile(r"(?<=\d)\s*\(\d{1,3}\)$")  # the number of a copy: Task1_Step8 (1).png
_PRELAB = re.compile(r"(?<![^\W\d_])pre[\W_]?lab", re.IGNORECASE)  # work before the lab, which has no evidence of it
_MAX_HEADER = 256 * 1024  # bytes in which the size of a picture is found
_MAX_OPENED = 50  # files at once whose dimensions are read
_MAX_SHOWN = 60  # characters of a heading


@dataclass(frozen=True, slots=True)
class EvidenceFile:
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


class LabelledFile(NamedTuple):
    """A picture, video or PDF, and the task and step that its path names: as it is written, and read loosely."""

    file: File
    label: Label
    loose: Label


class FoundEvidence(NamedTuple):
    """The files of a piece of evidence, and those that may be meant, but are not certain."""

    files: tuple[EvidenceFile, ...]
    possible: tuple[EvidenceFile, ...] = ()


def read_labelled_files(tree: Tree) -> tuple[LabelledFile, ...]:
    """Return every picture, video and PDF of a submission, with its labels."""
    return tuple(_labelled(file) for file in tree.files.values() if file.suffix in _EVIDENCE)


def find_evidence(
    files: Sequence[LabelledFile], names: Sequence[str], documents: DocumentCollection | None = None
) -> FoundEvidence:
    """Return the evidence that one of these names labels: `task 1 step 8`, or plain words such as `webcam`.

    Files with the label come first. Without one, files count that have a misspelt label with task and step, and
    headings of Word and PDF files with a picture below them. Not certain are labels without a task, headings without a
    picture, and documents that were not read or have pictures without headings.
    """
    wanted = [read_label(name) for name in names]
    exact = [labelled for labelled in files if _is_labelled(labelled, wanted)]
    if exact:
        return FoundEvidence(evidence_files(exact))
    others = [labelled for labelled in files if not labelled.label.is_complete]
    meant = [labelled for labelled in others if _is_misspelt(labelled, wanted)]
    perhaps = [labelled for labelled in others if labelled not in meant and _may_be_meant(labelled, wanted)]
    inside = [*_below_headings(documents, wanted)]
    certain = tuple(file for file, is_certain in inside if is_certain)
    if meant or certain:
        return FoundEvidence((*evidence_files(meant), *certain))
    whole = _described(_whole_documents(documents), {labelled.file.path for labelled in perhaps})
    return FoundEvidence((), (*evidence_files(perhaps), *(it for it, _ in inside), *whole))


def _described(files: Iterable[File], listed: Collection[str]) -> Iterator[EvidenceFile]:
    return (EvidenceFile(file.path, file.size) for file in files if file.path not in listed)


def _is_labelled(labelled: LabelledFile, wanted: Sequence[Label]) -> bool:
    return any(matches(label, labelled.label) for label in wanted)


def _is_misspelt(labelled: LabelledFile, wanted: Sequence[Label]) -> bool:
    return labelled.loose.is_complete and any(matches(label, labelled.loose) for label in wanted)


def find_all_evidence(
    files: Sequence[LabelledFile], names: Sequence[Sequence[str]], documents: DocumentCollection | None
) -> list[FoundEvidence]:
    """Return the evidence for each of several lists of names.

    A file is perhaps meant for one of them, the first without a file, unless its headings name several or it could not
    be read. A file that names another step is perhaps meant for the nearest step of its task without a file.
    """
    found = [find_evidence(files, one, documents) for one in names]
    claimed = {file.path for one in found for file in one.files}
    unread = {it.path for it in documents.named(DOCUMENTS)[1]} if documents is not None else set()
    for index, one in enumerate(found):
        perhaps = tuple(file for file in one.possible if file.heading or file.path not in claimed - unread)
        claimed |= {file.path for file in perhaps}
        found[index] = FoundEvidence(one.files, perhaps)
    without = [index for index, one in enumerate(found) if not one.files]
    steps = [(label, index) for index in without for label in map(read_label, names[index]) if label.is_complete]
    for labelled in files:
        near = _nearest(labelled.loose, steps) if labelled.file.path not in claimed else None
        if near is not None:
            found[near] = FoundEvidence((), (*found[near].possible, *evidence_files([labelled])))
    return found


def _nearest(wanted: Label, steps: Sequence[tuple[Label, int]]) -> int | None:
    """Return what belongs to the nearest step of the same task; None if there is none of it, or no step is wanted."""
    if not wanted.is_complete:
        return None
    distances = [(abs(min(it.steps) - min(wanted.steps)), index) for it, index in steps if it.task == wanted.task]
    return min(distances)[1] if distances else None


def evidence_files(files: Sequence[LabelledFile]) -> tuple[EvidenceFile, ...]:
    """Describe files of evidence; of many files, only the first with their dimensions."""
    return tuple(_evidence_file(labelled.file, is_opened=index < _MAX_OPENED) for index, labelled in enumerate(files))


def _labelled(file: File) -> LabelledFile:
    name = _COPY.sub("", stem(file.path))
    label = read_label(name)
    return LabelledFile(file, label, label if label.is_complete else read_label(name, loosely=True))


def _may_be_meant(labelled: LabelledFile, wanted: Sequence[Label]) -> bool:
    return any(_may_match(label, labelled) for label in wanted)


def _may_match(wanted: Label, labelled: LabelledFile) -> bool:
    """Return whether a file may be meant: it names the step without a task, or a word that is misspelt."""
    if wanted.steps:
        return labelled.loose.task is None and wanted.steps <= labelled.loose.steps
    is_word = wanted.task is None and len(wanted.words) == 1
    return is_word and any(closest(word, wanted.words) for word in labelled.label.words if len(word) > 3)


def headed(documents: DocumentCollection, names: Sequence[str]) -> list[tuple[Document, Heading]]:
    """Return the headings of documents with the first of these labels that occurs."""
    return [(document, head) for document, head, _ in _headed(documents, [read_label(name) for name in names])]


def _headed(documents: DocumentCollection, wanted: Sequence[Label]) -> list[tuple[Document, Heading, Label]]:
    read, _ = documents.named(DOCUMENTS)
    heads = [(document, head) for document in read for head in _step_headings(documents, document)]
    found = ([(document, head, label) for document, head in heads if _is_about(label, head)] for label in wanted)
    return next(filter(None, found), [])


def _below_headings(
    documents: DocumentCollection | None, wanted: Sequence[Label]
) -> Iterator[tuple[EvidenceFile, bool]]:
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


def _below(document: Document, head: Heading) -> EvidenceFile:
    text = " ".join(head.text.split())
    shown = cut(text, _MAX_SHOWN)
    file = document.file
    return EvidenceFile(file.path, file.size, heading=shown, page=document.page(head.start))


def _evidence_file(file: File, *, is_opened: bool) -> EvidenceFile:
    size = None
    if is_opened and file.suffix in _PICTURES:
        with suppress(InputError):
            size = image_size(file.read(_MAX_HEADER, first=True))
    return EvidenceFile(file.path, file.size, *(size or (None, None)))
