"""Pictures and other evidence in a submission: found by name and described, never graded."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

from grader.documents.image_size import image_size
from grader.documents.labels import Label, matches, read_label
from grader.errors import InputError
from grader.files.tree import File, Tree

_PICTURES = frozenset({".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".heic", ".svg"})
_EVIDENCE = _PICTURES | {".pdf", ".mp4", ".mov", ".webm", ".mkv", ".avi"}
_MAX_HEADER = 256 * 1024  # bytes in which the size of a picture is found
_MAX_OPENED = 50  # files at once whose dimensions are read


@dataclass(frozen=True, slots=True)
class Exhibit:
    """One file of evidence: its size in bytes, and width and height of a picture in pixels, if they are known."""

    path: str
    size: int
    width: int | None = None
    height: int | None = None

    @property
    def words(self) -> str:
        """The file with its dimensions and size, for a message."""
        dimensions = f"{self.width} x {self.height} pixels, " if self.width else ""
        size = f"{self.size / 1e6:.1f} MB" if self.size >= 1e6 else f"{self.size / 1e3:.0f} kB"
        return f"{self.path} ({dimensions}{size if self.size >= 1000 else f'{self.size} bytes'})"


class Proof(NamedTuple):
    """A picture, video or PDF, and the task and step that its path names."""

    file: File
    label: Label


def read_proofs(tree: Tree) -> tuple[Proof, ...]:
    """Return every picture, video and PDF of a submission, with its label."""
    return tuple(Proof(file, read_label(stem(file.path))) for file in tree.files.values() if file.suffix in _EVIDENCE)


def find_evidence(proofs: Sequence[Proof], names: Sequence[str]) -> tuple[Exhibit, ...]:
    """Return the evidence whose path contains one of these names: `task 1 step 8`, or plain words such as `webcam`."""
    wanted = [read_label(name) for name in names]
    return describe([proof for proof in proofs if any(matches(label, proof.label) for label in wanted)])


def describe(proofs: Sequence[Proof]) -> tuple[Exhibit, ...]:
    """Describe files of evidence; of many files, only the first with their dimensions."""
    return tuple(_exhibit(proof.file, is_opened=index < _MAX_OPENED) for index, proof in enumerate(proofs))


def stem(path: str) -> str:
    """Return a path without its suffix."""
    folder, slash, name = path.rpartition("/")
    return folder + slash + (name.rpartition(".")[0] or name)


def _exhibit(file: File, *, is_opened: bool) -> Exhibit:
    size = None
    if is_opened and file.suffix in _PICTURES:
        with suppress(InputError):
            size = image_size(file.read(_MAX_HEADER, first=True))
    return Exhibit(file.path, file.size, *(size or (None, None)))
