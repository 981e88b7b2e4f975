"""The file tree at a path: of a folder, an archive, or of these with the archives in them."""

import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path, PurePosixPath

from grader.base.errors import FileError, InputError
from grader.base.text import printable_path
from grader.files import limits
from grader.files.limits import ARCHIVES, PACKAGE_FILES, ROBOT_ENDINGS
from grader.files.reading import not_there, open_regular, read_error, read_start, shown_below
from grader.files.tree import File, IgnoredFile, Tree, make_tree, parents

NOT_AN_ARCHIVE = "is not a readable archive: it is damaged or empty"
_SIGNATURES = {
    b"PK\x03\x04": "zip",
    b"PK\x05\x06": "zip",
    b"\x1f\x8b": "gz",
    b"BZh": "bz2",
    b"\xfd7zXZ\0": "xz",
    b"7z\xbc\xaf\x27\x1c": "7z",
    b"Rar!": "rar",
}


def archive_kind(start: bytes) -> str | None:
    """Return the kind of archive that the first 512 bytes of a file show.

    It is zip, tar, gz, bz2, xz, 7z, rar, or None.
    """
    tar = "tar" if start[257:262] == b"ustar" else None
    return next(
        (kind for signature, kind in _SIGNATURES.items() if start.startswith(signature)), tar
    )


def open_tree(path: Path, is_opened: Callable[[str], bool] = lambda _: False) -> Tree | None:
    """Return the files at a path, including those in its archives.

    Returns None for a single file that is not an archive.

    `is_opened` is that of `with_inner`.
    """
    tree = outer_tree(path)
    return with_inner(tree, is_opened) if tree else None


def outer_tree(path: Path, top: str = "") -> Tree | None:
    """Return the files at a path, without opening archives in it.

    Returns None for a single file that is not an archive.

    Below the folder `top` no symlink is followed. Raises InputError.
    """
    shown = shown_below(path, top)
    try:
        is_folder = path.is_dir()
        if not is_folder:
            path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        raise InputError(f"{shown} does not exist") if top else not_there(path) from None
    except OSError as error:
        raise read_error(error, shown) from None
    except ValueError as error:
        raise InputError(f"cannot read {shown}: {error}") from None
    if is_folder:
        from grader.files.folder import read_folder  # late: a single URDF does not need it

        return read_folder(path, top)
    if path.name.lower().endswith((*ROBOT_ENDINGS, ".xml")):
        return None
    kind = archive_kind(read_start(path, 512, top=top))
    if kind is None:
        if path.name.lower().endswith(ARCHIVES):
            raise FileError(shown, NOT_AN_ARCHIVE)
        return None
    from grader.files.archive import read_archive

    return read_archive(os.fdopen(open_regular(path, top=top), "rb"), kind, shown)


def tree_name(path: Path) -> str:
    """Return the name of a submission: that of its folder, or of its file without the endings."""
    with suppress(OSError):
        if path.is_dir():
            return printable_path(path.resolve().name or "submission")
    return printable_path(without_endings(str(path)))


def with_inner(
    tree: Tree,
    is_opened: Callable[[str], bool] = lambda _: False,
    allowance: limits.Allowance | None = None,
    depth: int = 0,
) -> Tree:
    """Return the tree with what is in its archives.

    Beside a package and a URDF, only archives that contain them are opened.
    """
    archives = _archives_to_open(tree, is_opened)
    if not archives:
        return tree
    allowance = allowance or limits.Allowance()
    parts = [("", tree)]
    unopened = []
    count = len(tree.files)
    for archive in archives:
        try:
            inner = _open_inner(archive, allowance, depth)
            if count + len(inner.files) > limits.MAX_FILES:
                raise limits.files_limit_error(archive.path)
        except InputError as error:
            reason = error.reason if isinstance(error, FileError) else f"cannot be opened: {error}"
            unopened.append(IgnoredFile(archive.path, reason, is_closed=True))
        else:
            parts.append((archive.path + "/", inner))
            count += len(inner.files)
    return _combined_tree(tree.name, parts, unopened)


def _archives_to_open(tree: Tree, is_opened: Callable[[str], bool]) -> list[File]:
    """Return the archives that are opened."""
    files = tree.files.values()
    # What is in an archive of a package is not installed.
    packages = {
        file.path.removesuffix("package.xml") for file in files if file.name == "package.xml"
    }
    archives = [
        file
        for file in files
        if file.suffix in ARCHIVES
        and (is_opened(file.name) or packages.isdisjoint(f"{path}/" for path in parents(file.path)))
    ]
    has_package = any(file.name in PACKAGE_FILES for file in files)
    if has_package and any(file.suffix == ".urdf" for file in files):
        return [file for file in archives if is_opened(file.name)]
    return archives


def _combined_tree(
    name: str, parts: Sequence[tuple[str, Tree]], unopened: Sequence[IgnoredFile]
) -> Tree:
    """Return one tree of several, each with the start of its paths."""
    files = []
    ignored = []
    folders = []
    generated = []
    unseen = []
    for start, part in parts:
        files += [file._replace(path=start + file.path) for file in part.files.values()]
        ignored += [file._replace(path=start + file.path) for file in part.ignored]
        folders += [start + folder for folder in part.folders]
        generated += [start + path for path in part.generated]
        unseen += [start + folder for folder in part.unseen]
    trees = tuple(part for _, part in parts)
    ignored += unopened
    settings = parts[0][1].settings
    return make_tree(name, files, folders, ignored, generated, unseen, trees, settings)


def _open_inner(archive: File, allowance: limits.Allowance, depth: int) -> Tree:
    """Return what is in an archive inside of another one, or of a folder; raises InputError."""
    from tempfile import TemporaryFile

    from grader.files.archive import read_archive

    if depth >= limits.MAX_NESTED:
        raise FileError(
            archive.path, "is an archive inside an archive, nested too deep to be opened"
        )
    allowance.archives -= 1
    if allowance.archives < 0:
        raise FileError(archive.path, "was not opened: there are too many archives")
    kind = archive_kind(archive.read(512, first=True))
    if kind is None:
        raise FileError(archive.path, NOT_AN_ARCHIVE)
    allowance.spend(archive.path, unpacked=archive.size)
    stored = TemporaryFile()  # noqa: SIM115  its tree closes it
    stored.write(archive.read(limits.MAX_FILE_SIZE))
    return with_inner(
        read_archive(stored, kind, archive.path, allowance), allowance=allowance, depth=depth + 1
    )


def without_endings(path: str) -> str:
    """Return the name of an archive without its endings: lab6 for lab6.tar.gz."""
    name = PurePosixPath(path).name
    for ending in (".tar.gz", ".tar.bz2", ".tar.xz"):
        if name.lower().endswith(ending):
            return name[: -len(ending)]
    return PurePosixPath(name).stem
