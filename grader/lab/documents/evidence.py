"""Pictures and other evidence in a submission: found by name or headings in documents, and
described, never graded.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from grader.base.text import cut
from grader.files.tree import File, Tree
from grader.lab.documents.collection import DocumentCollection, TextDocument
from grader.lab.documents.headings import Heading, Label, is_about, matches, read_label, stem

_PICTURES = frozenset(
    {".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".heic", ".svg"}
)
EVIDENCE = _PICTURES | {".pdf", ".mp4", ".mov", ".webm", ".mkv", ".avi"}
_COPY = re.compile(r"(?<=\d)\s*\(\d{1,3}\)$")  # the number of a copy: Task1_Step8 (1).png
DOCUMENTS = ("*.pdf", "*.docx")  # which may have evidence below their headings
_PRELAB = re.compile(
    r"(?<![^\W\d_])pre[\W_]?lab", re.IGNORECASE
)  # work before the lab, which has no evidence of it
_MAX_SHOWN = 60  # characters of a heading


@dataclass(frozen=True, slots=True)
class EvidenceFile:
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


class LabelledFile(NamedTuple):
    """A picture, video or PDF, and the task and step that its path names."""

    file: File
    label: Label


def read_labelled_files(tree: Tree) -> tuple[LabelledFile, ...]:
    """Return every picture, video and PDF of a submission, with its label."""
    files = (file for file in tree.files.values() if file.suffix in EVIDENCE)
    return tuple(LabelledFile(file, read_label(_COPY.sub("", stem(file.path)))) for file in files)


def as_evidence(files: Sequence[LabelledFile]) -> tuple[EvidenceFile, ...]:
    """Describe files of evidence."""
    return tuple(EvidenceFile(labelled.file.path, labelled.file.size) for labelled in files)


class FoundEvidence(NamedTuple):
    """The files of a piece of evidence, and those that may be meant, but are not certain."""

    files: tuple[EvidenceFile, ...]
    possible: tuple[EvidenceFile, ...] = ()


def find_evidence(
    files: Sequence[LabelledFile], names: Sequence[str], documents: DocumentCollection | None = None
) -> FoundEvidence:
    """Return the evidence that one of these names labels: `task 1 step 8`, or plain words such as
    `webcam`.

    Files with the label come first. Without one, headings of Word and PDF files with a picture
    below them count. Not certain are labels without a task, headings without a picture, documents
    that were not read or have pictures without headings, and everything of a pre-lab.
    """
    wanted = [read_label(name) for name in names]
    exact = [it for it in files if any(matches(label, it.label) for label in wanted)]
    if certain := [it for it in exact if not _PRELAB.search(it.file.path)]:
        return FoundEvidence(as_evidence(certain))
    headings = _headings_about(documents, wanted) if documents is not None else []
    inside = [
        (_evidence_below(document, head), _is_certain(label, document, head))
        for document, head, label in headings
    ]
    if found := [
        file for file, is_certain in inside if is_certain and not _PRELAB.search(file.path)
    ]:
        return FoundEvidence(tuple(found))
    without_task = [
        it for it in files if any(label.steps and label.steps <= it.label.steps for label in wanted)
    ]
    perhaps = [*exact, *(it for it in without_task if it.label.task is None)]
    return FoundEvidence(
        (),
        (
            *as_evidence(perhaps),
            *(it for it, _ in inside),
            *_unlisted_documents(documents, perhaps),
        ),
    )


def _unlisted_documents(
    documents: DocumentCollection | None, listed: Sequence[LabelledFile]
) -> Iterator[EvidenceFile]:
    paths = {labelled.file.path for labelled in listed}
    return (
        EvidenceFile(it.path, it.size) for it in _whole_documents(documents) if it.path not in paths
    )


def headed(
    documents: DocumentCollection, names: Sequence[str]
) -> list[tuple[TextDocument, Heading]]:
    """Return the headings of documents with the first of these labels that occurs."""
    return [
        (document, head)
        for document, head, _ in _headings_about(documents, [read_label(name) for name in names])
    ]


def _headings_about(
    documents: DocumentCollection, wanted: Sequence[Label]
) -> list[tuple[TextDocument, Heading, Label]]:
    read, _ = documents.named(DOCUMENTS)
    heads = [(document, head) for document in read for head in _step_headings(documents, document)]
    found = (
        [(document, head, label) for document, head in heads if is_about(label, head)]
        for label in wanted
    )
    return next(filter(None, found), [])


def _whole_documents(documents: DocumentCollection | None) -> list[File]:
    """Return the documents that may hold any evidence: those not read, and those with pictures
    without headings.

    A pre-lab has none.
    """
    if documents is None:
        return []
    read, unread = documents.named(DOCUMENTS)
    found = [it.file for it in read if it.has_picture() and not _names_steps(documents, it)]
    found += [documents.tree.files[it.path] for it in unread if it.path]
    return [file for file in found if not _PRELAB.search(file.path)]


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
    """Return whether a picture is below a heading that names a step in words: "18." may be a line
    of the handout.
    """
    names = read_label(head.text[:_MAX_SHOWN])
    is_named = (
        bool(names.steps) or names.task is not None or not (wanted.steps or wanted.task is not None)
    )
    return is_named and document.has_picture(head.start, head.end)


def _evidence_below(document: TextDocument, head: Heading) -> EvidenceFile:
    text = " ".join(head.text.split())
    shown = cut(text, _MAX_SHOWN)
    file = document.file
    return EvidenceFile(file.path, file.size, heading=shown, page=document.page(head.start))
