"""The folder or zip of a class, and each submission in it.

It is the one that `grader grade` would see, and has its digest.

Nothing is extracted.
"""

import os
from collections.abc import Sequence
from contextlib import suppress
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from grader.base.errors import InputError
from grader.base.names import last_part
from grader.base.text import printable_path
from grader.files.archive import ARCHIVE_ERRORS, error_text
from grader.files.class_source import ClassDirectory, ClassZip
from grader.files.limits import ROBOT_ENDINGS
from grader.files.opening import archive_kind, with_inner, without_endings
from grader.files.reading import URDF_LIMIT, not_there, read_error, read_start
from grader.files.tree import Tree
from grader.lab.documents.evidence import EVIDENCE
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.labs import LabFolders
from grader.lab.submission.opening import make_submission, read_submission
from grader.lab.submission.submission import DEFAULTS, Opening, Submission
from grader.ros.api import is_robot

if TYPE_CHECKING:
    import hashlib


ClassListing = ClassDirectory | ClassZip
_TEXTS = (".docx", ".doc", ".odt", ".pages", ".ipynb", ".md", ".txt", ".rst", ".rtf")
_DOCUMENTS = (*EVIDENCE, *_TEXTS)
_MAX_HASHED = (
    64 * 1024 * 1024
)  # bytes of a file that go into the digest; of a larger file its size does


def list_class(path: Path) -> ClassListing:
    """Return the listing of a class folder or zip; raises InputError if it is neither."""
    shown = printable_path(path)
    try:
        if path.is_dir():
            return ClassDirectory(path)
        exists = os.path.lexists(path)
    except OSError as error:
        raise read_error(error, shown) from None
    except ValueError as error:
        raise InputError(f"cannot read {shown}: {error}") from None
    if not exists:
        raise not_there(path)
    if archive_kind(read_start(path, 512)) != "zip":
        raise InputError(
            f"{shown} is neither a folder nor a zip: name the folder that holds the class's "
            "submissions"
            " (`grader grade` grades a single one)"
        )
    return ClassZip(path)


class OpenedSubmission(NamedTuple):
    """A submission before it is graded."""

    name: str
    shown: str  # the path in messages
    digest: str  # the same whether the class is a folder or a zip
    data: bytes | None  # of a single URDF
    tree: Tree | None  # else
    max_size: int = URDF_LIMIT  # of a URDF, in bytes

    @property
    def has_documents(self) -> bool:
        """Whether it has files whose text may be read for answers."""
        files = self.tree.files if self.tree else ()
        return any(path.lower().endswith((*_TEXTS, ".pdf")) for path in files)

    def submission(self, rubric: Rubric, opening: Opening = DEFAULTS) -> Submission:
        """Return the submission; raises InputError if it is empty."""
        opening = opening._replace(max_size=self.max_size)
        if not self.tree:
            return read_submission(
                self.data or b"",
                identity=self.name,
                path=self.shown,
                lab=rubric.lab,
                opening=opening,
            )
        return make_submission(
            with_inner(self.tree, LabFolders(rubric.folders).is_lab),
            self.name,
            rubric.lab,
            opening,
            shown=self.shown,
        )


def open_class_submission(
    root: str, paths: Sequence[str], names: Sequence[str], name: str, max_size: int = URDF_LIMIT
) -> OpenedSubmission:
    """Open what is at `paths` below a class folder, or in a class zip; raises InputError.

    Several files become one submission, called `name`, that contains them as `names`; so does a
    single document, which has its own name.
    """
    own_names = [last_part(path) for path in paths]
    source = _open(root)
    is_document = len(paths) == 1 and _is_document(source, paths[0])
    if len(paths) == 1 and not is_document:
        return _open_single(source, paths[0], max_size)
    name = without_endings(own_names[0]) if is_document else name
    return _opened_tree(
        name, name, source.files(dict(zip(paths, names or own_names, strict=True)), name), max_size
    )


def digest_of_unread(root: str, paths: Sequence[str]) -> str:
    """Return the hash of the bytes of files that are no submission.

    It is empty if they cannot be read.
    """
    digest = sha256()
    try:
        for path in paths:
            with _open(root).raw(path) as file:
                digest.update(file.read(_MAX_HASHED))
    except (InputError, *ARCHIVE_ERRORS):
        return ""
    return digest.hexdigest()


def _open(root: str) -> ClassListing:
    """Return a class folder, or a zip that stays open as long as the file is the same."""
    with suppress(OSError):
        status = os.stat(root)  # noqa: PTH116
        return _listing(
            root, (status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
        )
    return list_class(Path(root))


@lru_cache(maxsize=4)
def _listing(root: str, _stamp: Sequence[int]) -> ClassListing:
    return list_class(Path(root))


def _open_single(source: ClassListing, path: str, max_size: int) -> OpenedSubmission:
    """Open a folder, an archive, or a URDF under any name."""
    last = printable_path(last_part(path))
    shown = printable_path(path)
    if source.is_folder(path):
        return _opened_tree(last, shown, source.folder(path), max_size)
    if not last.lower().endswith((*ROBOT_ENDINGS, ".xml")):
        name = without_endings(last)
        digest = _digest(name, max_size)
        if archive := source.archive(path, digest):
            return OpenedSubmission(name, shown, digest.hexdigest(), None, archive, max_size)
    if not last.lower().endswith(ROBOT_ENDINGS) and not _is_robot(source, path):
        raise InputError(f"{last} is neither a URDF nor a folder, an archive or a document")
    data = source.read(path, max_size)
    digest = _digest(last, max_size)
    digest.update(data)
    return OpenedSubmission(last.rpartition(".")[0] or last, last, digest.hexdigest(), data, None)


def _is_document(source: ClassListing, path: str) -> bool:
    """Return whether a single file may hold answers or evidence.

    It is no URDF with the ending .txt.
    """
    is_named = path.lower().endswith(_DOCUMENTS) and not source.is_folder(path)
    return is_named and not (path.lower().endswith(".txt") and _is_robot(source, path))


def _is_robot(source: ClassListing, path: str) -> bool:
    try:
        with source.raw(path) as file:
            return is_robot(file.read)
    except ARCHIVE_ERRORS as error:
        shown = printable_path(last_part(path))
        raise InputError(f"cannot read {shown}: {error_text(error, shown)}") from None


def _digest(name: str, max_size: int) -> "hashlib._Hash":
    """Return a hash of the name, which is in the report.

    The limit for a URDF is part of it if it is not the default.
    """
    return sha256(repr(name if max_size == URDF_LIMIT else (name, max_size)).encode())


def _opened_tree(name: str, shown: str, tree: Tree, max_size: int) -> OpenedSubmission:
    """Return a submission of files, with the hash of all that it is read from.

    This is the files, the ignored files, and its name.

    Build folders are unseen on disk; in a zip they are ordinary folders if they have an entry of
    their own.
    """
    digest = _digest(name, max_size)
    digest.update(
        repr(
            (sorted(tree.folders | tree.unseen), tuple(map(str, tree.ignored)), tree.generated)
        ).encode()
    )
    for path, file in tree.files.items():
        digest.update(repr((path, file.size)).encode())
        try:
            digest.update(file.read(_MAX_HASHED, first=True))
        except InputError as error:
            digest.update(str(error).encode())
    return OpenedSubmission(name, shown, digest.hexdigest(), None, tree, max_size)
