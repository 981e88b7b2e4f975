"""Pictures and other evidence in a submission.

They are found by name or headings in documents, and described, never graded.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.text import cut
from grader.files.tree import File, Tree
from grader.lab.documents.collection import DocumentCollection, TextDocument
from grader.lab.documents.headings import Heading, Label, is_about, matches, read_label, stem

_PICTURES = frozenset(
    {".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".heic", ".svg"}
)
EVIDENCE = _PICTURES | {".pdf", ".mp4", ".mov", ".webm", ".mkv", ".avi"}
_COPY = on_use(r"(?<=\d)\s*\(\d{1,3}\)$")  # the number of a copy: Task1_Step8 (1).png
DOCUMENTS = ("*.pdf", "*.docx")  # which may have evidence below their headings
_PRELAB = on_use(
    r"(?<![^\W\d_])pre[\W_]?lab", re.IGNORECASE
)  # work before the lab, which has no evidence of it
_MAX_SHOWN = 60  # characters of a heading


class EvidenceFile(Named):
    """One file of evidence, and its size in bytes.

    Of evidence inside a document, `heading` is what it is below, and `page` where that is, if it is
    known.
    """

    path: str
    size: int
    heading: str = ""
    page: int | None = None

    @property
    def words(self) -> str:
        """The file with its size, or the heading and page in it, for a message."""
        if self.heading:
            return f"{self.heading}{f', page {self.page} of' if self.page else ' in'} {self.path}"
        size = f"{self.size / 1e6:.1f} MB" if self.size >= 1e6 else f"{self.size / 1e3:.0f} kB"
        return f"{self.path} ({size if self.size >= 1000 else f'{self.size} bytes'})"


_Files = tuple[EvidenceFile, ...]


class LabelledFile(Named):
    """A picture, video or PDF, and the task and step that its path names."""

    file: File
    label: Label


def read_labelled_files(tree: Tree) -> tuple[LabelledFile, ...]:
    """Return every picture, video and PDF of a submission, with its label."""
    files = (file for file in tree.files.values() if file.suffix in EVIDENCE)
    return tuple(LabelledFile(file, read_label(_COPY.sub("", stem(file.path)))) for file in files)


def as_evidence(files: Sequence[LabelledFile]) -> _Files:
    """Describe files of evidence."""
    return tuple(EvidenceFile(labelled.file.path, labelled.file.size) for labelled in files)


class FoundEvidence(NamedTuple):
    """The files of a piece of evidence, and those that may be meant, but are not certain."""

    files: _Files
    possible: _Files = ()


def find_evidence(
    files: Sequence[LabelledFile], names: Sequence[str], documents: DocumentCollection | None = None
) -> FoundEvidence:
    """Return the evidence that one of these names labels.

    A name is `task 1 step 8`, or plain words such as `webcam`.

    Files with the label come first. Without one, headings of Word and PDF files with a picture
    below them count. Not certain are labels without a task, headings without a picture, documents
    that were not read or have pictures without headings, and everything of a pre-lab.
    """
    wanted = [read_label(name) for name in names]
    labelled = []
    for file in files:
        if any(matches(label, file.label) for label in wanted):
            labelled.append(file)
    certain = [file for file in labelled if not _PRELAB.search(file.file.path)]
    if certain:
        return FoundEvidence(as_evidence(certain))
    below, pictures = _evidence_in_documents(documents, wanted)
    if pictures:
        return FoundEvidence(tuple(pictures))
    steps = [label.steps for label in wanted if label.steps]
    perhaps = labelled + [
        file
        for file in files
        if file.label.task is None and any(map(file.label.steps.issuperset, steps))
    ]
    unlisted = _unlisted_documents(documents, perhaps)
    return FoundEvidence((), (*as_evidence(perhaps), *below, *unlisted))


def _evidence_in_documents(
    documents: DocumentCollection | None, wanted: Sequence[Label]
) -> tuple[list[EvidenceFile], list[EvidenceFile]]:
    """Return what is below the headings with these labels, and the pictures among it.

    Only pictures that are certain count.
    """
    below = list[EvidenceFile]()
    pictures = list[EvidenceFile]()
    if not documents:
        return below, pictures
    for document, head, label in _headings_about(documents, wanted):
        evidence = _evidence_below(document, head)
        below.append(evidence)
        if _is_certain(label, document, head) and not _PRELAB.search(evidence.path):
            pictures.append(evidence)
    return below, pictures


def _unlisted_documents(
    documents: DocumentCollection | None, listed: Sequence[LabelledFile]
) -> Iterator[EvidenceFile]:
    paths = {labelled.file.path for labelled in listed}
    for file in _whole_documents(documents):
        if file.path not in paths:
            yield EvidenceFile(file.path, file.size)


def headed(
    documents: DocumentCollection, names: Sequence[str]
) -> list[tuple[TextDocument, Heading]]:
    """Return the headings of documents with the first of these labels that occurs."""
    headings = _headings_about(documents, map(read_label, names))
    return [(document, head) for document, head, _ in headings]


def _headings_about(
    documents: DocumentCollection, wanted: Iterable[Label]
) -> list[tuple[TextDocument, Heading, Label]]:
    read, _ = documents.named(DOCUMENTS)
    heads = [(document, head) for document in read for head in _step_headings(documents, document)]
    for label in wanted:
        fitting = [(document, head, label) for document, head in heads if is_about(label, head)]
        if fitting:
            return fitting
    return []


def _whole_documents(documents: DocumentCollection | None) -> list[File]:
    """Return the documents that may hold any evidence.

    These are those not read, and those with pictures without headings.

    A pre-lab has none.
    """
    if not documents:
        return []
    read, unread = documents.named(DOCUMENTS)
    files = [
        document.file
        for document in read
        if document.has_picture() and not _names_steps(documents, document)
    ]
    files += [documents.tree.files[document.path] for document in unread if document.path]
    return [file for file in files if not _PRELAB.search(file.path)]


def _names_steps(documents: DocumentCollection, document: TextDocument) -> bool:
    is_named = read_label(stem(document.file.path)).is_complete
    return is_named or any(head.label.steps for head in _step_headings(documents, document))


def _step_headings(documents: DocumentCollection, document: TextDocument) -> list[Heading]:
    return [
        head
        for head in documents.headings(document)
        if not (head.is_mention or head.is_item or head.pattern)
    ]


def _is_certain(wanted: Label, document: TextDocument, head: Heading) -> bool:
    """Return whether a picture is below a heading that names a step in words.

    "18." may be a line of the handout.
    """
    names = read_label(head.text[:_MAX_SHOWN])
    is_named = (
        bool(names.steps) or names.task is not None or not (wanted.steps or wanted.task is not None)
    )
    return is_named and document.has_picture(head.start, head.end)


def _evidence_below(document: TextDocument, head: Heading) -> EvidenceFile:
    shown = cut(" ".join(head.text.split()), _MAX_SHOWN)
    file = document.file
    return EvidenceFile(file.path, file.size, heading=shown, page=document.page(head.start))
