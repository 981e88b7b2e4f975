"""One hand-in of a class folder or archive, opened: the same submission that `grader grade` would see, and its key."""

import os
import stat
from collections.abc import Iterator
from functools import lru_cache
from hashlib import sha256
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from grader.errors import InputError
from grader.files.class_zip import ClassZip
from grader.files.folder import file_at
from grader.files.ignore_rules import ignored_part, is_generated
from grader.files.opening import outer_tree, tree_name, with_inner, without_endings
from grader.files.reading import URDF_LIMIT, open_regular, read_capped
from grader.files.tree import Tree, make_tree
from grader.grading.rubric import Rubric
from grader.submission.submission import Submission, read_submission, submission_of
from grader.text import printable_path

if TYPE_CHECKING:
    import hashlib

_ROBOTS = (".urdf", ".xacro")
_NEITHER = "is neither a URDF nor a folder or archive"
_WHOLE = 64 * 1024 * 1024  # bytes of a file that its digest is made of; of a larger one the size is
_CHUNK = 1024 * 1024
_MOST_ENTRIES = 100_000
_SETTLED = 50_000_000  # nanoseconds in which a file system may not tell two changes apart


class Opened(NamedTuple):
    """A hand-in before it is graded: its digest, and either the bytes of a URDF on its own or all of its files.

    The digest is the same whether the class comes as a folder or as one zip.
    """

    name: str
    shown: str
    digest: str
    data: bytes | None
    tree: Tree | None
    limit: int = URDF_LIMIT  # bytes of the URDF

    def submission(self, rubric: Rubric, no_documents: str = "") -> Submission:
        """What is graded of it; raises InputError where there is nothing. `no_documents` says why none is read."""
        if self.tree is None:
            return read_submission(self.data or b"", identity=self.name, path=self.shown)
        return submission_of(
            with_inner(self.tree),
            self.name,
            wanted=rubric.urdf,
            package=rubric.package,
            limit=self.limit,
            shown=self.shown,
            no_documents=no_documents,
        )


def open_hand_in(
    root: str, paths: tuple[str, ...], names: tuple[str, ...], name: str, limit: int = URDF_LIMIT
) -> Opened:
    """What stands at `paths` below a class folder, or in a zip; raises InputError.

    Several files make one hand-in, which is called `name`, and stand in it side by side as `names`. `limit` is that of a URDF
    in bytes.
    """
    if len(paths) == 1:
        return _in_bulk(root, paths[0], limit) if is_bulk(root) else _on_disk(root, f"{root}/{paths[0]}", limit)
    given = dict(zip(paths, names or [PurePosixPath(path).name for path in paths], strict=True))
    tree = _bulk(root, _stamp(root)).files(given, name) if is_bulk(root) else _side_by_side(root, given, name)
    return Opened(name, name, _digest_of_tree(name, tree, limit), None, tree, limit)


@lru_cache(maxsize=4)
def is_bulk(root: str) -> bool:
    """Whether a class comes as one zip."""
    return not Path(root).is_dir()


def _on_disk(root: str, path: str, limit: int) -> Opened:
    last = path.rpartition("/")[2]
    if last.lower().endswith(_ROBOTS):
        shown = printable_path(last)
        data = read_capped(path, limit, shown=shown, top=root)
        return Opened(shown.rpartition(".")[0], shown, _digest_of_urdf(shown, data, limit), data, None)
    place = Path(path)
    tree = outer_tree(place, root)
    if tree is None:
        raise InputError(f"{printable_path(place.name)} {_NEITHER}")
    name = tree_name(place)
    digest = _digest_of_tree(name, tree, limit) if place.is_dir() else _digest_of_file(name, place, root, limit)
    return Opened(name, printable_path(place), digest, None, tree, limit)


def _in_bulk(root: str, path: str, limit: int) -> Opened:
    bulk = _bulk(root, _stamp(root))
    last = path.rpartition("/")[2]
    if bulk.is_folder(path):
        tree = bulk.folder(path)
        return Opened(last, path, _digest_of_tree(last, tree, limit), None, tree, limit)
    if last.lower().endswith(_ROBOTS):
        data = bulk.read(path, limit)
        return Opened(last.rpartition(".")[0], last, _digest_of_urdf(last, data, limit), data, None)
    name = without_endings(last)
    digest = _digest_of(name, limit)
    opened = None if last.lower().endswith(".xml") else bulk.archive(path, digest)
    if opened is None:
        raise InputError(f"{last} {_NEITHER}")
    return Opened(name, path, digest.hexdigest(), None, opened, limit)


@lru_cache(maxsize=2)
def _bulk(root: str, stamp: str) -> ClassZip:
    """The open zip, as long as the file stays the same."""
    del stamp
    return ClassZip(Path(root))


def _side_by_side(root: str, named: dict[str, str], name: str) -> Tree:
    """Some files on disk as one tree. What is not looked at in a folder or archive is not looked at here."""
    given = {printable_path(each): path for path, each in named.items()}
    ignored = {each: part for each in given if (part := ignored_part(each))}
    files = [file_at(Path(root, path), each, root) for each, path in given.items() if each not in ignored]
    generated = sorted(each for each in ignored if is_generated(each))
    return make_tree(name, files, (), generated=generated, unseen=ignored.values() - ignored.keys())


def _digest_of(name: str, limit: int) -> "hashlib._Hash":
    """A hash that has begun with a name, which stands in the report, and the limit for a URDF where it is not the default."""
    return sha256(repr(name if limit == URDF_LIMIT else (name, limit)).encode())


def _digest_of_urdf(name: str, data: bytes, limit: int) -> str:
    digest = _digest_of(name, limit)
    digest.update(data)
    return digest.hexdigest()


def _digest_of_file(name: str, path: Path, root: str, limit: int) -> str:
    digest = _digest_of(name, limit)
    try:
        with os.fdopen(open_regular(path, top=root), "rb") as file:
            while chunk := file.read(_CHUNK):
                digest.update(chunk)
    except OSError as error:
        raise InputError(f"cannot read {printable_path(path)}: {error.strerror}") from None
    return digest.hexdigest()


def _digest_of_tree(name: str, tree: Tree, limit: int) -> str:
    """The hash of all that a submission is read from: its name, its files with their paths, and what was left out.

    Folders of builds are unseen on disk; in a zip they are folders like others if they have an entry of their own.
    """
    seed = name if limit == URDF_LIMIT else (name, limit)
    digest = sha256(
        repr((seed, sorted(tree.folders | tree.unseen), tuple(map(str, tree.ignored)), tree.generated)).encode()
    )
    for path, file in tree.files.items():
        digest.update(repr((path, file.size)).encode())
        try:
            digest.update(file.read(_WHOLE, first=True))
        except InputError as error:
            digest.update(str(error).encode())
    return digest.hexdigest()


def fingerprint(root: str, paths: tuple[str, ...], now: int, limit: int = URDF_LIMIT) -> str:
    """What the file system says of a hand-in: as long as it says the same, the bytes are the same. Empty where nobody knows.

    `now` is the time in nanoseconds: what has changed just then may change once more unseen. With another `limit` for a URDF it
    is another one: what was too large may not be so now.
    """
    found = _fingerprint(root, paths, now)
    return f"{found} {limit}" if found and limit != URDF_LIMIT else found


def _fingerprint(root: str, paths: tuple[str, ...], now: int) -> str:
    if is_bulk(root):
        return _fingerprint_of_bulk(root, paths, now)
    digest = sha256()
    newest = 0
    try:
        if len(paths) == 1:
            status = os.lstat(f"{root}/{paths[0]}")
            if stat.S_ISREG(status.st_mode):  # what the most hand-ins of a large class are
                return _of(status) if status.st_ctime_ns < now - _SETTLED else ""
        for path in paths:
            for entry, status in _walk(f"{root}/{path}"):
                newest = max(newest, status.st_ctime_ns)
                digest.update(f"{entry}\0{_of(status)}\0".encode("utf-8", "surrogateescape"))
    except OSError:
        return ""
    return digest.hexdigest() if newest < now - _SETTLED else ""


def _fingerprint_of_bulk(root: str, paths: tuple[str, ...], now: int) -> str:
    try:
        status = os.stat(root)  # noqa: PTH116
    except OSError:
        return ""
    return f"{_of(status)} {paths}" if status.st_ctime_ns < now - _SETTLED else ""


def _walk(top: str) -> Iterator[tuple[str, os.stat_result]]:
    """Every file and folder at and below a path, symlinks as such, in the order of the alphabet; OSError where there are too many."""
    status = os.lstat(top)
    yield "", status
    if not stat.S_ISDIR(status.st_mode):
        return
    waiting = [top]
    count = 0
    while waiting:
        where = waiting.pop()
        with os.scandir(where) as found:
            entries = sorted(found, key=lambda each: each.name)
        for entry in entries:
            count += 1
            if count > _MOST_ENTRIES:
                raise OSError("too many")
            yield entry.path, entry.stat(follow_symlinks=False)
            if entry.is_dir(follow_symlinks=False):
                waiting.append(entry.path)


def _of(status: os.stat_result) -> str:
    return f"{status.st_ino} {status.st_size} {status.st_mtime_ns} {status.st_ctime_ns}"


def _stamp(path: str) -> str:
    try:
        return _of(os.stat(path))  # noqa: PTH116
    except OSError:
        return ""
