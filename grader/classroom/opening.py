"""Open one submission of a class folder or zip: the same submission that `grader grade` would see, and its digest."""

import os
from collections.abc import Mapping
from functools import lru_cache
from hashlib import sha256
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import IO, TYPE_CHECKING, NamedTuple

from grader.documents.evidence_files import EVIDENCE
from grader.errors import InputError, MachineError
from grader.files.class_zip import ClassZip
from grader.files.folder import file_at
from grader.files.members import ARCHIVE_ERRORS
from grader.files.names import ROBOT_ENDINGS, ignored_part, is_generated
from grader.files.opening import outer_tree, tree_name, with_inner, without_endings
from grader.files.reading import URDF_LIMIT, open_regular, read_capped, read_error, read_start
from grader.files.tree import Tree, make_tree
from grader.grading.rubric import Rubric
from grader.submission.labs import LabFolders
from grader.submission.opening import read_submission, submission_of
from grader.submission.robots import START, is_robot
from grader.submission.submission import Opening, Submission
from grader.text import printable_path

if TYPE_CHECKING:
    import hashlib

_UNSUPPORTED = "is neither a URDF nor a folder, an archive or a document"
_DOCUMENTS = (*EVIDENCE, ".docx", ".doc", ".odt", ".pages", ".ipynb", ".md", ".txt", ".rst", ".rtf")
_MAX_HASHED = 64 * 1024 * 1024  # bytes of a file that go into the digest; of a larger file its size does
_CHUNK = 1024 * 1024


class OpenedSubmission(NamedTuple):
    """A submission before it is graded: its digest, and either the bytes of a single URDF or a file tree.

    The digest is the same whether the class is a folder or a zip. `shown` is the path in messages, `max_size` the bytes
    of a URDF.
    """

    name: str
    shown: str
    digest: str
    data: bytes | None
    tree: Tree | None
    max_size: int = URDF_LIMIT

    def submission(
        self, rubric: Rubric, no_documents: str = "", arguments: Mapping[str, str] = MappingProxyType({})
    ) -> Submission:
        """Return the submission; raises InputError if it is empty.

        `no_documents` says why documents are not read; `arguments` are those of xacro.
        """
        opening = Opening(self.max_size, arguments, no_documents)
        if self.tree is None:
            return read_submission(self.data or b"", identity=self.name, path=self.shown, opening=opening)
        return submission_of(
            with_inner(self.tree, LabFolders(rubric.folders).is_lab),
            self.name,
            rubric.lab,
            opening,
            shown=self.shown,
        )


@lru_cache(maxsize=4)
def is_zip(root: str) -> bool:
    """Return whether a class is one zip."""
    return not Path(root).is_dir()


def file_stamp(path: str) -> str:
    """Return what the file system says about one file; empty if it cannot be read."""
    try:
        status = os.stat(path)  # noqa: PTH116
    except OSError:
        return ""
    return f"{status.st_ino} {status.st_size} {status.st_mtime_ns} {status.st_ctime_ns}"


def open_class_submission(
    root: str, paths: tuple[str, ...], names: tuple[str, ...], name: str, max_size: int = URDF_LIMIT
) -> OpenedSubmission:
    """Open what is at `paths` below a class folder, or in a class zip; raises InputError.

    Several files become one submission, called `name`, that contains them as `names`; so does a single document, which
    has its own name.
    """
    if len(paths) == 1 and _is_document(root, paths[0]):
        name = without_endings(PurePosixPath(paths[0]).name)
    elif len(paths) == 1:
        return _open_in_zip(root, paths[0], max_size) if is_zip(root) else _open_on_disk(root, paths[0], max_size)
    files = dict(zip(paths, names or [PurePosixPath(path).name for path in paths], strict=True))
    tree = _class_zip(root, file_stamp(root)).files(files, name) if is_zip(root) else _side_by_side(root, files, name)
    return OpenedSubmission(name, name, _digest_of_tree(name, tree, max_size), None, tree, max_size)


def _is_document(root: str, path: str) -> bool:
    """Return whether a single file may hold answers or evidence, and is no URDF with the ending .txt."""
    if not path.lower().endswith(_DOCUMENTS):
        return False
    class_zip = _class_zip(root, file_stamp(root)) if is_zip(root) else None
    if class_zip.is_folder(path) if class_zip is not None else Path(root, path).is_dir():
        return False
    with class_zip.raw(path) if class_zip is not None else _raw(root, path) as file:
        return not path.lower().endswith(".txt") or not is_robot(file.read(START))


def unreadable_digest(root: str, paths: tuple[str, ...]) -> str:
    """Return the hash of files that cannot be opened as a submission; empty if their bytes cannot be read either."""
    digest = sha256()
    try:
        for path in paths:
            digest.update(repr(path.rpartition("/")[2]).encode())  # which the reason names
            with _class_zip(root, file_stamp(root)).raw(path) if is_zip(root) else _raw(root, path) as file:
                for _ in range(_MAX_HASHED // _CHUNK):
                    digest.update(file.read(_CHUNK))
    except (InputError, MachineError, *ARCHIVE_ERRORS):
        return ""
    return digest.hexdigest()


def _raw(root: str, path: str) -> IO[bytes]:
    return os.fdopen(open_regular(Path(root, path), top=root), "rb")


def _open_on_disk(root: str, path: str, max_size: int) -> OpenedSubmission:
    last = path.rpartition("/")[2]
    if last.lower().endswith(ROBOT_ENDINGS):
        shown = printable_path(last)
        return _lone_urdf(shown, read_capped(f"{root}/{path}", max_size, shown=shown, top=root), max_size)
    place = Path(root, path)
    tree = outer_tree(place, root)
    if tree is None:
        shown = printable_path(place.name)
        if not is_robot(read_start(place, START, shown, root)):
            raise InputError(f"{shown} {_UNSUPPORTED}")
        return _lone_urdf(shown, read_capped(place, max_size, shown=shown, top=root), max_size)
    name = tree_name(place)
    digest = _digest_of_tree(name, tree, max_size) if place.is_dir() else _digest_of_file(name, place, root, max_size)
    return OpenedSubmission(name, printable_path(path), digest, None, tree, max_size)


def _open_in_zip(root: str, path: str, max_size: int) -> OpenedSubmission:
    class_zip = _class_zip(root, file_stamp(root))
    last = path.rpartition("/")[2]
    if class_zip.is_folder(path):
        tree = class_zip.folder(path)
        return OpenedSubmission(last, path, _digest_of_tree(last, tree, max_size), None, tree, max_size)
    if last.lower().endswith(ROBOT_ENDINGS):
        return _lone_urdf(last, class_zip.read(path, max_size), max_size)
    name = without_endings(last)
    digest = _digest(name, max_size)
    archive = None if last.lower().endswith(".xml") else class_zip.archive(path, digest)
    if archive is None:
        data = class_zip.read(path, max_size)
        if not is_robot(data):
            raise InputError(f"{last} {_UNSUPPORTED}")
        return _lone_urdf(last, data, max_size)
    return OpenedSubmission(name, path, digest.hexdigest(), None, archive, max_size)


def _lone_urdf(name: str, data: bytes, max_size: int) -> OpenedSubmission:
    digest = _digest(name, max_size)
    digest.update(data)
    return OpenedSubmission(name.rpartition(".")[0] or name, name, digest.hexdigest(), data, None)


@lru_cache(maxsize=2)
def _class_zip(root: str, stamp: str) -> ClassZip:
    """Return the open zip, as long as the file has the same stamp."""
    del stamp
    return ClassZip(Path(root))


def _side_by_side(root: str, names: dict[str, str], name: str) -> Tree:
    """Return files on disk, by path, as one tree with the same ignored files as a folder or archive."""
    paths = {printable_path(inner): path for path, inner in names.items()}
    ignored = {inner: part for inner in paths if (part := ignored_part(inner))}
    files = [file_at(Path(root, path), inner, root) for inner, path in paths.items() if inner not in ignored]
    generated = sorted(inner for inner in ignored if is_generated(inner))
    return make_tree(name, files, (), generated=generated, unseen=ignored.values() - ignored.keys())


def _digest(name: str, max_size: int) -> "hashlib._Hash":
    """Return a hash of the name, which is in the report, and of the limit for a URDF if it is not the default."""
    return sha256(repr(name if max_size == URDF_LIMIT else (name, max_size)).encode())


def _digest_of_file(name: str, path: Path, root: str, max_size: int) -> str:
    digest = _digest(name, max_size)
    try:
        with os.fdopen(open_regular(path, top=root), "rb") as file:
            while chunk := file.read(_CHUNK):
                digest.update(chunk)
    except OSError as error:
        raise read_error(error, printable_path(path.name)) from None
    return digest.hexdigest()


def _digest_of_tree(name: str, tree: Tree, max_size: int) -> str:
    """Return the hash of all that a submission is read from: its name, its files with their paths, the ignored files.

    Build folders are unseen on disk; in a zip they are ordinary folders if they have an entry of their own.
    """
    seed = name if max_size == URDF_LIMIT else (name, max_size)
    digest = sha256(
        repr((seed, sorted(tree.folders | tree.unseen), tuple(map(str, tree.ignored)), tree.generated)).encode()
    )
    for path, file in tree.files.items():
        digest.update(repr((path, file.size)).encode())
        try:
            digest.update(file.read(_MAX_HASHED, first=True))
        except InputError as error:
            digest.update(str(error).encode())
    return digest.hexdigest()
