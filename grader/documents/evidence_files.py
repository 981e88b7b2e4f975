"""Pictures, videos and documents as evidence: their labels, dimensions and sizes."""

import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

from grader.documents.image_size import image_size
from grader.documents.labels import Label, read_label, stem
from grader.errors import InputError
from grader.files.tree import File, Tree

_PICTURES = frozenset({".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".heic", ".svg"})


EVIDENCE = _PICTURES | {".pdf", ".mp4", ".mov", ".webm", ".mkv", ".avi"}


_COPY = re.compile(r"(?<=\d)\s*\(\d{1,3}\)$")  # the number of a copy: Task1_Step8 (1).png


_MAX_HEADER = 256 * 1024  # bytes in which the size of a picture is found


_MAX_OPENED = 50  # files at once whose dimensions are read


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


def read_labelled_files(tree: Tree) -> tuple[LabelledFile, ...]:
    """Return every picture, video and PDF of a submission, with its labels."""
    return tuple(_label(file) for file in tree.files.values() if file.suffix in EVIDENCE)


def as_evidence(files: Sequence[LabelledFile]) -> tuple[EvidenceFile, ...]:
    """Describe files of evidence; of many files, only the first with their dimensions."""
    return tuple(_evidence_file(labelled.file, is_opened=index < _MAX_OPENED) for index, labelled in enumerate(files))


def _label(file: File) -> LabelledFile:
    name = _COPY.sub("", stem(file.path))
    label = read_label(name)
    return LabelledFile(file, label, label if label.is_complete else read_label(name, loosely=True))


def _evidence_file(file: File, *, is_opened: bool) -> EvidenceFile:
    size = None
    if is_opened and file.suffix in _PICTURES:
        with suppress(InputError):
            size = image_size(file.read(_MAX_HEADER, first=True))
    return EvidenceFile(file.path, file.size, *(size or (None, None)))
