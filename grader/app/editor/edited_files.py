"""The files of a workspace as an editor has them: those on the disk, and what is typed."""

from collections.abc import Callable
from pathlib import Path

from grader.base.errors import InputError
from grader.files.gitignore import without_git_ignored
from grader.files.limits import ignored_part
from grader.files.opening import open_tree
from grader.files.reading import URDF_LIMIT
from grader.files.tree import File, Tree, make_tree, overlaid


class EditedFiles:
    """The files of a folder, with the typed text of those that are open in the editor.

    What is on the disk is read once, until `read_again` says that it has changed.
    """

    def __init__(self, root: Path) -> None:
        self.root = root
        self._typed: dict[str, bytes] = {}
        self._on_disk: Tree | None = None

    @property
    def typed(self) -> list[str]:
        """The paths of the files that are open in the editor."""
        return [*self._typed]

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
        if self._on_disk is None:
            opened_tree = open_tree(self.root)
            if opened_tree is None:
                raise InputError(f"{self.root.name} is no folder")
            self._on_disk = _kept(without_git_ignored(opened_tree, self.root))
        on_disk, typed = self._on_disk, dict[str, bytes | None]()
        for path, data in dict(self._typed).items():
            if path in on_disk.files or not ignored_part(path):
                typed[path] = data
        return overlaid(on_disk, typed) if typed else on_disk

    def text(self, path: str) -> str:
        """Return the text of a file, as far as it can be read; empty without one."""
        if path in self._typed:
            return self._typed[path].decode("utf-8", "replace")
        data = self.tree().read(path, URDF_LIMIT)
        return (data or b"").decode("utf-8", "replace")

    def path_of(self, file: Path) -> str | None:
        """Return the path of a file in the folder; None for one outside of it."""
        try:
            path = file.relative_to(self.root)
        except ValueError:
            return None
        return path.as_posix()


def _kept(tree: Tree) -> Tree:
    """Return a tree whose files are read once each."""
    kept = [file._replace(read=_read_once(file)) for file in tree.files.values()]
    return make_tree(
        tree.name, kept, tree.folders, tree.ignored, tree.generated, tree.unseen, (tree,)
    )


def _read_once(file: File) -> Callable[..., bytes]:
    whole: bytes | None = None

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
