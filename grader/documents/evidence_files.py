"""Pictures, videos and documents as evidence: their labels and sizes."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from grader.documents.labels import Label, read_label, stem
from grader.files.tree import File, Tree

_PICTURES = frozenset({".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".heic", ".svg"})
EVIDENCE = _PICTURES | {".pdf", ".mp4", ".mov", ".webm", ".mkv", ".avi"}
_COPY = re.compile(r"(?<=\d)\s*\(\d{1,3}\)$")  # the number of a copy: Task1_Step8 (1).png


@dataclass(frozen=True, slots=True)
class EvidenceFile:
    """One file of evidence, and its size in bytes.

    Of evidence inside a document, `heading` is what it is below, and `page` where that is, if it is known.
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
