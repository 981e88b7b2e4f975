"""What a path leads to as a tree of files: a folder, an archive, or an archive in one of these."""

import os
import tempfile
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.files.reading import MAX_FILE_SIZE, not_there, open_regular, read_start, shown_below
from grader.files.tree import MOST_FILES, File, Tree, make_tree, too_many
from grader.text import printable_path

if TYPE_CHECKING:
    from grader.files.archive import Allowance

ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar")
_MOST_NESTED = 3
_WORTH_FINDING = ("package.xml", "setup.py")


def archive_kind(start: bytes) -> str | None:
    """What the first 512 bytes of a file say that it is: zip, tar, gz, bz2, xz, 7z, rar, or None."""
    signatures = {b"PK\x03\x04": "zip", b"PK\x05\x06": "zip", b"\x1f\x8b": "gz", b"BZh": "bz2", b"\xfd7zXZ\0": "xz"}
    signatures |= {b"7z\xbc\xaf\x27\x1c": "7z", b"Rar!": "rar"}
    for signature, kind in signatures.items():
        if start.startswith(signature):
            return kind
    return "tar" if start[257:262] == b"ustar" else None


def open_tree(path: Path) -> Tree | None:
    """The files at a path, those in its archives included; None where it is a single file that is no archive."""
    tree = outer_tree(path)
    return with_inner(tree) if tree is not None else None


def outer_tree(path: Path, top: str = "") -> Tree | None:
    """The files at a path, archives among them unopened; None where it is a single file that is no archive. Raises InputError.

    Below the folder `top` no symlink is followed.
    """
    shown = shown_below(path, top)
    try:
        is_folder = path.is_dir()
        if not is_folder and not os.path.lexists(path):
            raise InputError(f"{shown} does not exist") if top else not_there(path)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"cannot read {shown}: {reason}") from None
    if is_folder:
        from grader.files.folder import read_folder  # what a single URDF does not need is loaded late

        return read_folder(path, top)
    if path.name.lower().endswith((".urdf", ".xacro", ".xml")):
        return None
    kind = archive_kind(read_start(path, 512, top=top))
    if kind is None:
        if path.name.lower().endswith(ARCHIVES):
            raise InputError(f"{shown} is no archive that can be read, for all its name: it is damaged or empty")
        return None
    from grader.files.archive import read_archive

    return read_archive(os.fdopen(open_regular(path, top=top), "rb"), kind, shown)


def tree_name(path: Path) -> str:
    """What a submission is called: the name of its folder, or of its file without the endings."""
    try:
        is_folder = path.is_dir()
    except OSError:
        is_folder = False
    return (
        printable_path(path.resolve().name or "submission") if is_folder else printable_path(without_endings(str(path)))
    )


def with_inner(tree: Tree, allowance: "Allowance | None" = None, depth: int = 0) -> Tree:
    """The tree with what is in its archives, unless a package and a URDF stand beside them."""
    archives = [file for file in tree.files.values() if file.suffix in ARCHIVES]
    has_package = any(file.name in _WORTH_FINDING for file in tree.files.values())
    if not archives or (has_package and any(file.suffix == ".urdf" for file in tree.files.values())):
        return tree
    from grader.files.archive import Allowance

    allowance = allowance or Allowance()
    files, folders, left_out = list(tree.files.values()), set(tree.folders), list(tree.left_out)
    generated, unseen = list(tree.generated), set(tree.unseen)
    kept, unopened = [tree], list(tree.unopened)
    for archive in archives:
        try:
            inner = _inner(archive, allowance, depth)
            if len(files) + len(inner.files) > MOST_FILES:
                raise too_many(archive.path)
        except InputError as error:
            left_out.append(str(error))
            unopened.append(archive.path)
            continue
        kept.append(inner)
        start = archive.path + "/"
        files += [File(start + file.path, file.size, file.read) for file in inner.files.values()]
        folders |= {start + folder for folder in inner.folders}
        left_out += [f"{start}{each}" for each in inner.left_out]
        generated += [start + each for each in inner.generated]
        unseen |= {start + folder for folder in inner.unseen}
        unopened += [start + each for each in inner.unopened]
    return make_tree(tree.name, files, folders, left_out, generated, unseen, unopened, tuple(kept))


def _inner(archive: File, allowance: "Allowance", depth: int) -> Tree:
    """What is in an archive inside of another one, or of a folder; raises InputError."""
    from grader.files.archive import read_archive

    if depth >= _MOST_NESTED:
        raise InputError(f"{archive.path} is an archive inside of an archive, too deep to be opened")
    allowance.archives -= 1
    if allowance.archives < 0:
        raise InputError(f"{archive.path} was not opened: there are too many archives")
    kind = archive_kind(archive.read(512, first=True))
    if kind is None:
        raise InputError(f"{archive.path} is no archive that can be read, for all its name: it is damaged or empty")
    allowance.spend(archive.size, archive.path)
    stored = tempfile.TemporaryFile()  # noqa: SIM115  its tree closes it
    stored.write(archive.read(MAX_FILE_SIZE))
    return with_inner(read_archive(stored, kind, archive.path, allowance), allowance, depth + 1)


def without_endings(path: str) -> str:
    """The name of an archive without its endings: lab6.tar.gz is lab6."""
    name = PurePosixPath(path).name
    for ending in (".tar.gz", ".tar.bz2", ".tar.xz"):
        if name.lower().endswith(ending):
            return name[: -len(ending)]
    return PurePosixPath(name).stem
