"""The files of a workspace as an editor has them: those on the disk, and what is typed."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from grader.base.errors import FileError, InputError
from grader.files.gitignore import without_git_ignored
from grader.files.limits import ignored_part
from grader.files.opening import open_tree
from grader.files.reading import URDF_LIMIT
from grader.files.tree import File, IgnoredFile, Tree, make_tree, overlaid

_TOOK_TOO_LONG = "takes too long to read, and was ignored"


class SkippedText(NamedTuple):
    """A text that takes too long to read, and that which is read instead; None to read none.

    Without `slow` it is the first text that the file has.
    """

    slow: str | None
    instead: str | None


class EditedFiles:
    """The files of a folder, with the typed text of those that are open in the editor.

    What is on the disk is read once, until `read_again` says that it has changed. Of a file with a
    skipped text another one is read until it changes, or none.
    """

    def __init__(
        self,
        root: Path,
        skipped: Mapping[str, SkippedText] | None = None,
        begin_file: Callable[[str], object] = lambda _: None,
    ) -> None:
        """Take the files of a folder.

        Args:
            root: The folder.
            skipped: The texts that take too long to read, by the paths of their files in the
                folder.
            begin_file: Called with a path before its file is read.
        """
        self.root = root
        self._skipped = dict(skipped or {})
        self._slow = {}  # the skipped texts
        for path, text in self._skipped.items():
            if text.slow is not None:
                self._slow[path] = text.slow.encode("utf-8", "surrogatepass")
        self._begin_file = begin_file
        self._typed: dict[str, bytes] = {}
        self._on_disk: Tree | None = None

    @property
    def typed(self) -> list[str]:
        """The paths of the files that are open in the editor."""
        return list(self._typed)

    def type(self, path: str, text: str) -> None:
        """Set the text of an open file, by its path in the folder."""
        self._typed[path] = text.encode("utf-8", "surrogatepass")

    def close(self, path: str) -> None:
        """Forget the text of a file: that on the disk counts again."""
        self._typed.pop(path, None)

    def read_again(self) -> None:
        """Read the files on the disk again when they are needed."""
        self._on_disk = None

    def tree(self) -> Tree:
        """Return the files as they are now. Raises InputError."""
        if not self._on_disk:
            opened_tree = open_tree(self.root)
            if not opened_tree:
                raise InputError(f"{self.root.name} is no folder")
            self._on_disk = self._keep_contents(without_git_ignored(opened_tree, self.root))
        on_disk = self._on_disk
        typed = {}
        for path, data in dict(self._typed).items():
            if path in on_disk.files or not ignored_part(path):
                typed[path] = data
        tree = self._watch(overlaid(on_disk, typed), typed) if typed else on_disk
        return self._without_skipped(tree)

    def _keep_contents(self, tree: Tree) -> Tree:
        """Return a tree whose files are read once each."""
        kept = [file._replace(read=_read_once(file)) for file in tree.files.values()]
        kept_tree = make_tree(
            tree.name, kept, tree.folders, tree.ignored, tree.generated, tree.unseen, (tree,)
        )
        return self._watch(kept_tree, kept_tree.files)

    def _watch(self, tree: Tree, paths: Iterable[str]) -> Tree:
        """Return a tree in which it is noted that one of these files is read."""

        def read(file: File, limit: int, *, first: bool = False) -> bytes:
            self._begin_file(file.path)
            return file.read(limit, first=first)

        files = dict(tree.files)
        for path in paths:
            if path in files:
                files[path] = files[path]._replace(read=partial(read, files[path]))
        return replace(tree, files=files)

    def _without_skipped(self, tree: Tree) -> Tree:
        """Return a tree without the text of the files that take too long to read."""
        for path, (_, instead) in self._skipped.items():
            data = tree.read(path, URDF_LIMIT)
            if data is None or data != self._slow.setdefault(path, data):
                continue
            if instead is not None:
                tree = overlaid(tree, {path: instead.encode("utf-8", "surrogatepass")})
            else:
                tree = _unread(tree, path)
        return tree

    def text(self, path: str) -> str:
        """Return the text of a file, as far as it can be read; empty without one."""
        if path in self._typed:
            return self._typed[path].decode("utf-8", "replace")
        data = self.tree().read(path, URDF_LIMIT)
        return (data or b"").decode("utf-8", "replace")

    def find_path(self, file: Path) -> str | None:
        """Return the path of a file in the folder; None for one outside of it."""
        try:
            path = file.relative_to(self.root)
        except ValueError:
            return None
        return path.as_posix()


def _read_once(file: File) -> Callable[..., bytes]:
    whole = None

    def read(limit: int, *, first: bool = False) -> bytes:
        nonlocal whole
        if file.size > URDF_LIMIT:
            return file.read(limit, first=first)
        if whole is None:
            whole = file.read(URDF_LIMIT)
        if first:
            return whole[:limit]
        return whole if len(whole) <= limit else file.read(limit)

    return read


def _unread(tree: Tree, path: str) -> Tree:
    """Return a tree in which a file is there, and cannot be read."""

    def refuse(limit: int, *, first: bool = False) -> bytes:
        del limit, first
        raise FileError(path, _TOOK_TOO_LONG)

    files = [*tree.files.values(), tree.files[path]._replace(read=refuse)]
    ignored = (*tree.ignored, IgnoredFile(path, _TOOK_TOO_LONG))
    return make_tree(tree.name, files, tree.folders, ignored, tree.generated, tree.unseen, (tree,))
